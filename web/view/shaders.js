// Shared by the page (web/src) and `singe view` (web/view): GLSL after program/preview. How paper, embers and flames look is
// translated from its C (look.js); here are what that calls, light, ground and film.
import { FLAME, LOOK, PAPER } from "./look.js";
import { FLAME_NOISE } from "./tables.js";

/** Four smooth noises from -1 to 1, lattice size 1, by one look into a texture of random corners, so many a side, repeated. */
const noise = (map, side) => /* glsl */ `
precision highp float;
precision highp sampler3D;
uniform sampler3D ${map};
vec4 noise4(vec3 p) {
    vec3 i = floor(p), f = p - i;
    f = f * f * (3.0 - 2.0 * f);
    return texture(${map}, (i + f + 0.5) / ${side}.0) * 2.0 - 1.0;
}
float stepf(float a, float b, float x) { return smoothstep(a, b, x); }
float noise3(vec3 p, float seed) { return noise4(p + seed * vec3(7.31, 3.17, 5.73)).r; }
vec3 float3_add(vec3 a, vec3 b) { return a + b; }
vec3 float3_sub(vec3 a, vec3 b) { return a - b; }
vec3 float3_mul(vec3 a, vec3 b) { return a * b; }
vec3 float3_scale(vec3 a, float b) { return a * b; }
vec3 float3_mad(vec3 a, vec3 b, float s) { return a + b * s; }
vec3 float3_unit_or(vec3 a, vec3 b) { return dot(a, a) > 1e-30 ? normalize(a) : b; }
`;

export const NOISE = noise("noiseMap", 32);

/** Blackbodies: row 0 from 780 K to 2100 K as embers, row 1 flames from their coolest to their hottest. */
export const GLOW = /* glsl */ `
uniform sampler2D glowMap;
vec3 blackbody_glow(float kelvin) { return texture(glowMap, vec2((kelvin - 780.0) / 1320.0, 0.25)).rgb; }
vec3 flame_colour(float hot) { return texture(glowMap, vec2(hot, 0.75)).rgb; }
`;

/** The mean of 12 looks around s into a shadow map, of the four farthest where they agree. */
export const SHADOW = /* glsl */ `
precision highp sampler2DShadow;
uniform sampler2DShadow shadowMap;
const vec2 DISC[12] = vec2[12](vec2(0.96, -0.19), vec2(-0.84, 0.07), vec2(0.51, 0.77), vec2(-0.61, -0.75), vec2(0.19, -0.89), vec2(-0.20, 0.62),
    vec2(-0.33, -0.41), vec2(-0.70, 0.46), vec2(0.47, -0.48), vec2(0.44, 0.02), vec2(0.12, 0.21), vec2(0.75, 0.39));
float lightSeen(vec3 s, float wide) {
    float angle = 6.2832 * fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.0671, 0.00584)))), c = wide * cos(angle), si = wide * sin(angle), sum = 0.0;
    for (int k = 0; k < 12; k++) {
        if (k == 4 && (sum < 0.001 || sum > 3.999)) return 0.25 * sum;
        sum += texture(shadowMap, vec3(s.xy + mat2(c, si, -si, c) * DISC[k], s.z));
    }
    return sum / 12.0;
}
`;

/** The lamp with its shadow, the fire's lights, and a little of the night. */
export const LAMP = /* glsl */ `${SHADOW}
uniform vec3 lampAt, lampAhead, lampColour, nightColour;
uniform mat4 lampView;
uniform vec4 fireLights[6]; // position and strength
uniform vec3 fireColour;
uniform vec3 eye;

float lampSeen(vec3 p) {
    vec4 q = lampView * vec4(p, 1.0);
    vec3 s = q.xyz / q.w * 0.5 + 0.5;
    if (any(lessThan(s.xy, vec2(0.0))) || any(greaterThan(s.xy, vec2(1.0)))) return 1.0;
    return lightSeen(s - vec3(0.0, 0.0, 0.0006), 0.0042);
}

/** What a surface sends to v: light on a side with this normal, and that on its back times what comes through, and highlights, Blinn and Phong. */
vec3 shaded(vec3 albedo, vec3 through, float gloss, float power, vec3 p, vec3 n, vec3 v, float seen) {
    vec3 to = lampAt - p, sum = nightColour * (0.6 + 0.4 * n.z), matte = vec3(0.0);
    float d2 = dot(to, to), shiny = 0.0;
    vec3 l = to * inversesqrt(d2), h = l + v;
    float lamp = seen * smoothstep(0.62, 0.97, dot(-l, lampAhead)) / d2, facing = dot(n, l), mid = max(dot(n, h), 0.0);
    sum += lampColour * (lamp * (max(facing, 0.0) + through * max(-facing, 0.0)));
    vec3 high = lampColour * (lamp * pow(mid * mid / dot(h, h), 0.5 * power));
    for (int k = 0; k < 6; k++) {
        vec3 f = fireLights[k].xyz - p;
        float near = inversesqrt(dot(f, f) + 0.0012), w = fireLights[k].w * near * near, side = dot(n, f) * near;
        matte += w * (max(side, 0.0) + 0.12 + through * max(-side, 0.0));
        h = f * near + v;
        mid = max(dot(n, h), 0.0);
        if (mid > 0.0) shiny += w * pow(mid * mid / dot(h, h), 0.5 * power);
    }
    return albedo * (sum + fireColour * matte) + gloss * (high + fireColour * shiny);
}

/** What is seen in a mirror: the night. */
vec3 mirrored(vec3 d) { return nightColour * (0.6 + 0.4 * d.z); }
`;

export const PAPER_VERTEX = /* glsl */ `
in vec3 position, normal, rest;
in vec2 uv;
in vec3 leaf;
in vec4 heat, look;
uniform mat4 viewProjection;
out vec3 vPosition, vNormal, vRest;
out vec2 vUv;
out vec3 vLeaf;
out vec4 vHeat, vLook;
void main() {
    vPosition = position;
    vNormal = normal;
    vRest = rest;
    vUv = uv;
    vHeat = heat;
    vLook = look;
    vLeaf = leaf;
    gl_Position = viewProjection * vec4(position, 1.0);
}`;

/** The sheet in this light: GLSL with lampSeen, shaded and mirrored. With SHADOW defined, only where it is. */
export const paper = (light) => /* glsl */ `${NOISE}${GLOW}${light}
in vec3 vPosition, vNormal, vRest;
in vec2 vUv;
in vec3 vLeaf;
in vec4 vHeat, vLook;
uniform sampler2D printMap, backMap;
uniform float time, transmittance, dyed; // dyed: of cloth, 1; with a picture of its own on its back 0.5; of paper 0
uniform vec3 tint;
out vec4 colour;
struct Point { vec3 position, normal, view, albedo, glow, through; float footprint, transmission, gloss, shininess, mirror; };
float seconds() { return time; }
/** Lines, where the preview has walls between cells: they take 27 looks. */
float noise_walls(vec3 p, float seed) {
    vec4 n = abs(noise4(0.6 * p + seed * vec3(7.31, 3.17, 5.73)));
    return 0.8 * min(n.g, n.b);
}
${PAPER}
void main() {
    // at a border, a pixel's middle may lie outside the triangle, where fields go on beyond what they can be
    vec4 heat = max(vHeat, 0.0), look = max(vLook, 0.0);
    float rim = min(look.z, 1.0), spacing = max(vLeaf.x, 0.0), edge = mix(0.006, (1.0 - rim) * spacing, min(3.0 * rim, 1.0)); // beyond a triangle it is unknown
    PaperState state = PaperState(vRest, heat.x, heat.y, min(look.x, 1.0), heat.z, look.y, vLeaf.z, rim, spacing, heat.w, max(vLeaf.y, 0.0), look.w, 0.0, edge);
    Point point = Point(vPosition, normalize(vNormal), normalize(eye - vPosition), vec3(0.0), vec3(0.0), vec3(0.0), max(length(dFdx(vPosition)), length(dFdy(vPosition))), transmittance, 0.015, 14.0, 0.0);
#ifdef SHADOW
    if (state.burn > PAPER_WHOLE && is_hole(state, shade_paper_bend(state, point.footprint), point.footprint)) discard;
    colour = vec4(0.0);
#else
    bool burnt = state.burn > 0.0 || max(state.peak, state.temperature) > 294.0;
    Bent bent;
    if (burnt) bent = shade_paper_bend(state, point.footprint);
    if (state.burn > PAPER_WHOLE && is_hole(state, bent, point.footprint)) discard;
    if (dot(point.normal, point.view) < 0.0) point.normal = -point.normal;

    vec2 right = dFdx(vUv), up = dFdy(vUv);
    bool back = right.x * up.y < right.y * up.x; // where pictures are mirrored; that on the back runs to the left
    vec3 print = texture(printMap, vUv, -0.7).rgb, other = dyed == 1.0 ? print : texture(backMap, vec2(1.0 - vUv.x, vUv.y), -0.7).rgb;
    float flocks = flocks_of(state, point);
    print = dyed > 0.0 ? (back ? other : print) : print_seen(back ? other : print, back ? print : other, point);
    vec3 fresh = vec3(0.86, 0.852, 0.832) * tint * print * (1.0 + 0.02 * flocks);
    point.albedo = fresh;
    if (burnt) {
        float scorch = scorch_amount(state, bent, point.footprint), ink = ink_kept(bent) * stepf(0.3, 0.75, 1.0 - clamp(dot(fresh, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0));
        point.transmission *= 1.0 - stepf(0.1, 0.7, scorch);
        char_shade(bent, scorch_colour(scorch) * mix(fresh, vec3(0.80), stepf(0.6, 1.0, scorch)), ink, point);
        ash_shade(state, bent, ink, point);
        ember_shade(state, bent, point);
    }

    float seen = lampSeen(vPosition + 0.0008 * point.normal);
    vec3 c = shaded(point.albedo, point.transmission * point.through, point.gloss, point.shininess, vPosition, point.normal, point.view, seen) + point.glow;
    colour = vec4(c + light_mirrored(point) * mirrored(reflect(-point.view, point.normal)), 1.0);
#endif
}`;

export const PLAIN_VERTEX = /* glsl */ `
in vec3 position, normal;
uniform mat4 modelMatrix, viewProjection;
out vec3 vPosition, vNormal, vLocal;
void main() {
    vLocal = position;
    vec4 p = modelMatrix * vec4(position, 1.0);
    vPosition = p.xyz;
    vNormal = mat3(modelMatrix) * normal;
    gl_Position = viewProjection * p;
}`;

/** Planks after shade_wood.c, each with its own trunk's rings; `fade` is GLSL that changes c. */
export const table = (light, colour, fade) => /* glsl */ `${NOISE}${light}
in vec3 vPosition, vNormal;
out vec4 colour;
uniform highp sampler2DArray sliceMap;
float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }
/** noise4 half-way between its corners in z, four such in a layer: half of the looks that it takes. */
vec4 noise2(float x, float y, float layer) {
    vec2 p = vec2(x, y), i = floor(p), f = p - i;
    return texture(sliceMap, vec3((i + f * f * (3.0 - 2.0 * f) + 0.5) / 32.0, layer)) * 2.0 - 1.0;
}
float visible(float wide, float size) { return clamp(1.5 - 0.9 * size / wide, 0.0, 1.0); }
float dashes(float u, float v, float wide, float often, float size) {
    float even = 0.18 * often, shown = visible(1.3 * wide, size), row = floor(v / wide);
    if (shown <= 0.0) return even;
    float at = u / (11.0 * wide) + 7.0 * hash(vec2(row, 3.0));
    vec2 cell = vec2(mod(floor(at), 997.0), row);
    if (hash(cell) >= often) return (1.0 - shown) * even;
    float w = mix(0.12, 0.3, hash(cell + 0.1)), reach = mix(0.15, 0.48, hash(cell + 0.2));
    float x = (fract(at) - mix(reach, 1.0 - reach, hash(cell + 0.3))) / reach, y = fract(v / wide) - mix(w, 1.0 - w, hash(cell + 0.4));
    float soft = max(0.4 * w, 0.6 * size / wide), dark = mix(0.5, 1.0, hash(cell + 0.5));
    return mix(even, dark * step(abs(x), 1.0) * stepf(-soft, soft, w * sqrt(max(1.0 - x * x, 0.0)) - abs(y)), shown);
}
void main() {
    vec3 p = vPosition, view = normalize(eye - p);
    float size = max(length(dFdx(p)), length(dFdy(p)));
    float row = floor(p.y / 0.118), across = fract(p.y / 0.118), shift = hash(vec2(row, 7.0));
    float column = floor(p.x / 1.3 + shift), along = fract(p.x / 1.3 + shift) * 1.3;
    float tone = hash(vec2(row, column)), hue = hash(vec2(row + 0.3, column + 0.7));
    float edge = min(min(across, 1.0 - across) * 0.118, min(along, 1.3 - along));
    if (edge < 0.01 + size) edge += 0.0002 * noise2(p.x * 60.0, p.y * 60.0, 3.0).r;
    float u = along + 60.0 * hash(vec2(row + 0.5, column)), v0 = (across - 0.5) * 0.118, v = v0;

    float depth = 0.016 + 0.09 * tone + (hue > 0.5 ? 1.0 : -1.0) * (0.035 + 0.07 * tone) * (along - 0.6), knot = 9.0;
    for (float k = 0.0; k < 3.0; k++) {
        vec2 key = vec2(row + 0.1 * k, column);
        if (hash(key + 0.01) > 0.4) continue;
        float r = 0.0025 + 0.011 * hash(key + 0.02) * hash(key + 0.03), x = (along - 1.3 * (k + hash(key + 0.04)) / 3.0) / r;
        float y = (v0 - 0.106 * (hash(key + 0.05) - 0.5)) / r + 0.4 * (hash(key + 0.06) - 0.5) * x;
        float far = 0.16 * x * x + y * y, room = max(1.0 - far / 60.0, 0.0), near = room * room * visible(2.0 * r, size);
        if (near <= 0.0) continue;
        v -= r * y * near * min(1.0 / max(far, 1e-6), 1.0);
        depth -= 3.2 * r * near * exp(-far / 7.0);
        knot = min(knot, sqrt(mix(0.35, 0.9, hash(key + 0.07)) * x * x + y * y) + 0.22 * noise2(1.3 * x, 1.3 * y, 2.0).g);
    }

    float bend = 0.011 * noise2(u * 2.3, v * 9.0, 0.0).r + 0.003 * noise2(u * 9.0, v * 30.0, 0.0).g;
    float aside = v + 0.09 * (hue - 0.5) + bend, radius = length(vec2(aside, depth)), wide = 0.0034 + 0.003 * hue;
    float year = radius / wide + 0.35 * noise2(u * 1.3, radius * 60.0, 0.0).b + 1.1 * noise2(u * 0.01, radius * 85.0, 2.0).g + 0.3 * noise2(u * 17.0, v * 70.0, 0.0).a, y = p.y + v - v0, fibre = 0.0;
    vec3 fine = vec3(visible(0.002, size), visible(0.001, size), visible(0.0005, size));
    if (fine.x > 0.0) year += 0.1 * fine.x * noise2(u * 40.0, v * 330.0, 1.0).r;
    if (fine.x > 0.0) fibre += 0.5 * fine.x * noise2(u * 31.0, y * 500.0, 0.0).a;
    if (fine.y > 0.0) fibre += 0.45 * fine.y * noise2(u * 62.0, y * 1000.0, 1.0).r;
    if (fine.z > 0.0) fibre += 0.4 * fine.z * noise2(u * 125.0, y * 2000.0, 1.0).b;
    float within = fract(year), slope = max(abs(aside) / radius, 0.12), fall = clamp(1.2 * size * slope / wide, 0.03, 0.4), sharp = visible(0.0035 / max(slope, 0.3), 2.0 * size);
    float late = stepf(0.25, 1.0 - fall, within) * (1.0 - stepf(1.0 - fall, 1.0, within)), strength = 0.35 + 0.65 * hash(vec2(floor(year), tone));
    late = mix(0.33, late, sharp) * mix(0.65, strength, sharp);

    float pores = max(0.9 * dashes(u, y, 0.00075, 0.9 * mix(0.3, 1.0 - stepf(0.05, 0.5, within), sharp), size), 0.7 * dashes(u, y + 0.7, 0.0004, 0.4, size));
    float blotch = noise2(u * 3.1, v * 14.0, 1.0).b, wear = noise2(p.x * 5.0, p.y * 5.0, 1.0).a, inside = 1.0 - stepf(0.9, 1.05, knot), core = 0.0;
    if (inside > 0.0) core = 0.18 * noise2(6.0 * knot, u, 2.0).r;
    float value = 1.19 + 0.46 * (tone - 0.5) - 0.66 * late + 0.24 * fibre + 0.10 * blotch + 0.05 * wear;
    value *= 1.0 - 0.64 * pores;
    value *= mix(1.0 - 0.3 * (1.0 - stepf(0.9, 2.5, knot)), 0.5 + core, inside) * (1.0 - 0.4 * (1.0 - stepf(0.02, 0.2, abs(knot - 1.0))));
    float soft = max(0.0008, 0.7 * size), joint = 1.0 - stepf(0.0003, soft + 0.0003, edge);
    value *= (1.0 - 0.86 * joint * min(1.0, 0.0016 / size)) * (1.0 - 0.2 * (1.0 - stepf(0.0005, 0.009, edge)));

    float red = clamp(0.45 * late + 0.5 * (hue - 0.4) + 0.3 * inside, -0.25, 0.55);
    vec3 albedo = ${colour} * vec3(1.0 + 0.22 * red, 1.0 - 0.10 * red, 1.0 - 0.42 * red) * max(value, 0.04);
    vec3 n = normalize(vec3(0.004 * wear, 0.012 * (blotch + fibre), 1.0));
    float polish = (0.46 - 0.16 * late + 0.20 * wear + 0.16 * fibre) * (1.0 - 0.8 * joint) * (1.0 - 0.6 * pores), open = lampSeen(p + vec3(0.0, 0.0, 0.0006));
    vec3 c = shaded(albedo, vec3(0.0), 0.10 * polish, 26.0, p, n, view, open);
    ${fade}
    colour = vec4(c, 1.0);
}`;

/** What a shape sends that glows: shape_glow of shade_metal.c. p: from its middle, 3.5 at its side. */
export const SHAPE_GLOW = /* glsl */ `
vec3 shape_glow(vec3 p, vec3 n, vec3 view, float kelvin) {
    vec3 aslant = vec3(0.8 * p.x + 0.6 * p.y, 0.64 * p.y - 0.48 * p.x + 0.6 * p.z, 0.8 * p.z + 0.36 * p.x - 0.48 * p.y);
    float middle = noise4(1.4 * aslant).r, lies = middle + 0.45 * noise4(3.7 * aslant).b + 0.25 * noise4(8.0 * p).a;
    float facing = clamp(dot(n, view), 0.0, 1.0), aside = 1.0 - facing, even = kelvin * (1.0 + 0.02 * noise4(0.45 * p).g + 0.008 * middle);
    even += float(${LOOK.SHAPE_MIDDLE}) * facing * facing - float(${LOOK.SHAPE_LIMB}) * aside * sqrt(aside) + float(${LOOK.SHAPE_BELOW}) * min(n.z, 0.2);
    return blackbody_glow(even - float(${LOOK.SCALE_COOLER}) * stepf(0.46, 0.62, lies)) * float(${LOOK.SHAPE_GAIN}) * (0.45 + 0.55 * facing);
}
`;

export const solid = (light) => /* glsl */ `${NOISE}${GLOW}${SHAPE_GLOW}${light}
in vec3 vPosition, vNormal, vLocal;
uniform vec3 albedo;
uniform float gloss, kelvin;
out vec4 colour;
void main() {
    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    float seen = lampSeen(vPosition + 0.0015 * n), grain = 1.0 + 0.12 * noise4(vPosition * vec3(900.0, 900.0, 900.0)).r;
    colour = vec4(shaded(albedo * grain, vec3(0.0), gloss, 40.0, vPosition, n, view, seen), 1.0);
    if (kelvin > 800.0) colour.rgb += shape_glow(3.5 * vLocal, n, view, kelvin);
}`;

/** Sparks and flakes (airborne.js), four corners each: a spark is a streak at least some pixels wide, a flake a plate. */
export const AIRBORNE_VERTEX = /* glsl */ `
in vec3 position, from, to, across, what; // position: the corner
uniform mat4 viewProjection;
uniform vec2 resolution;
out vec3 vPosition, vNormal, vWhat;
out vec2 vAt;
out float vLong;
void main() {
    vec2 corner = position.xy;
    vAt = corner;
    vWhat = what;
    vLong = 0.0;
    if (what.x == 0.0) {
        vPosition = from + corner.x * to + corner.y * across;
        vNormal = cross(to, across);
        gl_Position = viewProjection * vec4(vPosition, 1.0);
        return;
    }
    vec4 p = viewProjection * vec4(from, 1.0), q = viewProjection * vec4(to, 1.0);
    vec2 along = (q.xy / q.w - p.xy / p.w) * resolution * 0.5;
    float size = length(along), seen = what.x * resolution.y / p.w, wide = max(1.15 * resolution.y / 720.0, 1.0); // px
    vec2 d = size > 0.01 ? along / size : vec2(1.0, 0.0);
    vLong = size / (2.0 * wide);
    vAt = vec2(corner.x * (1.0 + vLong), corner.y);
    seen = max(seen, 0.6 * wide);
    vWhat.z *= 0.785 * seen * seen / (wide * (2.0 * wide + size)); // its light goes over the streak
    vPosition = corner.x < 0.0 ? from : to;
    vNormal = vec3(0.0, 0.0, 1.0);
    gl_Position = corner.x < 0.0 ? p : q;
    gl_Position.xy += (corner.x * d + corner.y * vec2(-d.y, d.x)) * 2.0 * wide / resolution * gl_Position.w;
}`;

/** Drawn with blending ONE, ONE_MINUS_SRC_ALPHA: a spark only adds light. */
export const airborne = (light) => /* glsl */ `${NOISE}${GLOW}${light}
in vec3 vPosition, vNormal, vWhat;
in vec2 vAt;
in float vLong;
out vec4 colour;
void main() {
    if (vWhat.x > 0.0) {
        vec2 d = vec2(max(abs(vAt.x) - vLong, 0.0), vAt.y);
        float inside = max(1.0 - dot(d, d), 0.0) * mix(0.3, 1.25, stepf(-1.0, 0.7, vAt.x / (1.0 + vLong))); // its end is younger light
        colour = vec4(blackbody_glow(vWhat.y) * 3.4 * vWhat.z * inside * inside, 0.0);
        return;
    }
    vec2 seed = vWhat.yz * vec2(0.37, 71.0);
    float inside = 0.80 + 0.34 * noise4(vec3(1.6 * vAt, seed.y)).r + 0.15 * noise4(vec3(5.0 * vAt, seed.y)).g - length(vAt);
    if (inside < 0.0) discard;
    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    if (dot(n, view) < 0.0) n = -n;
    float rim = 1.0 - stepf(0.0, 0.28, inside), pale = clamp(vWhat.z + 0.25 * rim + 0.3 * noise4(vec3(2.3 * vAt, seed.y)).b, 0.0, 1.0);
    vec3 albedo = mix(vec3(0.014), vec3(0.30, 0.30, 0.29), pale * pale);
    vec3 glow = blackbody_glow(vWhat.y) * 1.6 * stepf(800.0, 950.0, vWhat.y) * stepf(-0.1, 0.5, noise4(vec3(4.0 * vAt, seed.y)).a);
    colour = vec4(shaded(albedo, vec3(0.25), 0.0, 1.0, vPosition, n, view, lampSeen(vPosition)) + glow, 0.96) * vec4(vec3(0.96), 1.0);
}`;

export const FULL_VERTEX = /* glsl */ `
in vec3 position;
out vec2 at;
void main() {
    at = position.xy * 0.5 + 0.5;
    gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

/** Marches through flame and smoke, as fire_march.c does. Light, and in alpha what is left of what lies behind. */
export const FIRE = /* glsl */ `${noise("flameNoiseMap", FLAME_NOISE)}${GLOW}
in vec2 at;
uniform sampler3D fireMap;
uniform sampler2D depthMap;
uniform mat4 inverse_;
uniform vec3 eye, low, high, origin, span, match_, fireDaylight;
uniform float time, matchOn, fireScale; // fireScale: of flames, 1 over cells of 8 to 10 mm (fire.h)
uniform vec4 fireLights[6];
out vec4 colour;
#define fireMoment time
${FLAME}
struct Gas { float flame, height, smoke, slope; };
/** Of the gas: flame, height above the paper (m), smoke (1/m), gradient of flame (1/m). */
Gas gas(vec3 p) {
    vec4 c = texture(fireMap, (p - origin) / span) * vec4(FLAME_MOST, FLAME_END * fireScale, 20.0, FLAME_MOST * float(textureSize(fireMap, 0).x) / span.x);
    return Gas(c.x, c.y, c.z, c.w);
}
Noise noise_at(vec3 q) { vec4 n = noise4(q); return Noise(n.x, n.y, n.z, n.w); }
FireCell cell_at(vec3 p) {
    Gas c = gas(p);
    float glow = 0.0;
    for (int k = 0; k < 6 && c.smoke > 0.0; k++) { vec3 f = fireLights[k].xyz - p; glow += 0.25 * fireLights[k].w / (dot(f, f) + 0.003); }
    return FireCell(c.flame, c.flame * c.height, c.smoke, glow);
}
FirePoint fire_at_point(vec3 p, float height, float blur) {
    FirePoint point = FirePoint(vec3(0.0), vec3(0.0), FIRE_OUTSIDE, 0.0, 0.0, 0.0);
    float sway[2], passed = eddies_passed(height / fireScale, p.z / fireScale, time / sqrt(fireScale)), root = sqrt(fireScale);
    fire_sway(p, height, sway);
    p += vec3(sway[0], sway[1], 0.0);
    Noise wide = eddies(p, passed, fireScale * EDDY_WIDE, 1.0);
    p += vec3(wide.a, wide.b, 0.0) * fireScale * 0.7 * FIRE_WARP_WIDE;
    Noise fine = eddies(p, passed, root * EDDY_FINE, FINE_OFTEN * root);
    Gas c = gas(p + vec3(fine.a, fine.b, 0.0) * root * 0.7 * FIRE_WARP_FINE);
    if (c.flame > 0.02) shade_flame(c.flame, p, height, passed, c.slope, wide, fine, blur, point);
    return point;
}

/** The flame of a match: a drop around its head, dark at the wood, blue at its foot. */
vec3 matchFlame(vec3 p) {
    vec3 q = p - match_;
    float h = q.z / 0.030;
    if (h < -0.25 || h > 1.1) return vec3(0.0);
    vec4 sway = noise4(vec3(q.z * 30.0 - 3.0 * time, 2.0 * time, 4.5));
    q.xy += 0.0022 * max(h, 0.0) * sway.rg;
    float width = 0.0052 * sqrt(max(h + 0.25, 0.0)) * (1.0 - stepf(0.15, 1.05, h) * 0.98), r = length(q.xy) / max(width, 1e-5);
    float body = 1.0 - stepf(0.55, 1.0, r);
    return body * (flame_colour(clamp(0.95 - 0.5 * stepf(0.3, 1.0, h), 0.0, 1.0)) * 90.0 * stepf(-0.1, 0.35, h) + vec3(0.3, 0.6, 1.6) * 6.0 * (1.0 - stepf(-0.1, 0.2, h)));
}

void main() {
    float z = texture(depthMap, at).r;
    vec4 back = inverse_ * vec4(at * 2.0 - 1.0, z * 2.0 - 1.0, 1.0);
    vec3 far = back.xyz / back.w, ray = far - eye;
    float reach = length(ray);
    ray /= reach;

    vec3 a = (low - eye) / ray, b = (high - eye) / ray, near_ = min(a, b), far_ = max(a, b);
    float t = max(max(max(near_.x, near_.y), near_.z), 0.0), end = min(min(min(far_.x, far_.y), far_.z), reach);
    vec3 light = vec3(0.0);
    float blur = FIRE_SOFT * length(dFdx(ray)) * 0.5, clear = 1.0, jitter = fract(0.5 * mod(gl_FragCoord.x + gl_FragCoord.y - 1.0, 2.0) + 0.25 * mod(gl_FragCoord.y - 0.5, 2.0) + 0.618 * fract(time * 7.0));
    if (t < end) {
        float short_ = max((end - t) / 180.0, 0.0016), pace = 2.0 * short_;
        FirePoint here = FirePoint(vec3(0.0), vec3(0.0), FIRE_OUTSIDE, 0.0, 0.0, 0.0), there;
        t += short_ * jitter;
        float until = t;
        Smoke last, next = fire_smoke_at(eye + ray * t);
        Matter smoke;
        for (int i = 0; i < 180 && t < end && clear > 0.02; i++) {
            vec3 p = eye + ray * t;
            Gas c = gas(p);
            there = FirePoint(vec3(0.0), vec3(0.0), FIRE_OUTSIDE, 0.0, 0.0, 0.0);
            if (c.flame > 0.004 || c.height > 0.0) there = fire_at_point(p, c.height, blur * t);
            if (t >= until) {
                until = t + SMOKE_STEP;
                last = next;
                next = fire_smoke_at(eye + ray * until);
                smoke = fire_smoke_between(last, next, blur / FIRE_SOFT * t);
            }
            Matter j = smoke;
            fire_between(here, there, pace, j);
            here = there;
            float depth = j.dense * pace, kept = exp(-depth);
            light += j.light * clear * pace * (depth > 1e-3 ? (1.0 - kept) / depth : 1.0);
            clear *= kept;
            pace = there.depth > -2.0 * short_ ? short_ : 2.0 * short_;
            t += pace;
        }
    }
    if (matchOn > 0.5) {
        float middle = dot(match_ + vec3(0.0, 0.0, 0.014) - eye, ray);
        if (length(eye + ray * middle - match_ - vec3(0.0, 0.0, 0.014)) < 0.03)
            for (int i = 0; i < 28; i++) {
                float s = middle - 0.022 + 0.044 * (float(i) + jitter) / 28.0;
                if (s < reach) light += matchFlame(eye + ray * s) * 0.044 / 28.0 * clear;
            }
    }
    colour = vec4(light, clear);
}`;

/** Fire in front of the scene: the mean of a few looks, as its steps begin at random. */
const FIRE_SEEN = /* glsl */ `
precision highp float;
in vec2 at;
uniform sampler2D sceneMap, fireMap2;
vec4 fireSeen(float apart) {
    vec2 d = apart / vec2(textureSize(fireMap2, 0));
    return 0.25 * (texture(fireMap2, at + d) + texture(fireMap2, at - d) + texture(fireMap2, at + vec2(d.x, -d.y)) + texture(fireMap2, at + vec2(-d.x, d.y)));
}
`;

/** What is overexposed, smaller. */
export const BRIGHT = /* glsl */ `${FIRE_SEEN}
uniform vec2 pixel;
uniform float exposure;
out vec4 colour;
void main() {
    vec3 sum = vec3(0.0);
    vec4 fire = fireSeen(1.0);
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            vec3 c = min((texture(sceneMap, at + (vec2(i, j) * 2.0 - 1.0) * pixel).rgb * fire.a + fire.rgb) * exposure, vec3(16.0));
            float peak = max(c.r, max(c.g, c.b));
            sum += c * max(peak - 1.1, 0.0) / max(peak, 1e-6);
        }
    colour = vec4(sum * 0.25, 1.0);
}`;

export const BLUR = /* glsl */ `
precision highp float;
in vec2 at;
uniform sampler2D map;
uniform vec2 along;
uniform float sigma; // in pixels
out vec4 colour;
void main() {
    vec3 sum = texture(map, at).rgb;
    float weight = 1.0, radius = min(ceil(2.5 * sigma), 100.0);
    for (float k = 1.0; k <= radius; k += 1.0) {
        float w = exp(-0.5 * k * k / (sigma * sigma));
        sum += w * (texture(map, at + along * k).rgb + texture(map, at - along * k).rgb);
        weight += 2.0 * w;
    }
    colour = vec4(sum / weight, 1.0);
}`;

/** The halo and the film's curve (film.c). */
export const FILM = /* glsl */ `${FIRE_SEEN}
uniform sampler2D halo, glare, haze;
uniform float exposure, vignette;
uniform vec2 resolution;
out vec4 colour;
float curve(float x) {
    float f = x * (1.0 - 0.4 * exp(-x / 0.06));
    float over = max(f - 0.6, 0.0) / 0.4;
    f = f < 0.6 ? f : 0.6 + 0.4 * (1.0 - pow(1.0 + over / 0.75, -0.75));
    return f <= 0.0031308 ? 12.92 * f : 1.055 * pow(f, 1.0 / 2.4) - 0.055;
}
void main() {
    vec4 fire = fireSeen(0.5);
    vec3 c = (texture(sceneMap, at).rgb * fire.a + fire.rgb) * exposure;
    c += 0.14 * texture(halo, at).rgb + 0.10 * texture(glare, at).rgb + 0.06 * texture(haze, at).rgb;
    vec2 d = (at - 0.5) * vec2(resolution.x / resolution.y, 1.0);
    c *= 1.0 - vignette * smoothstep(0.35, 1.05, length(d));
    float over = max(max(c.r, max(c.g, c.b)) - 1.0, 0.0), leak = 0.02 + 0.14 * over * over / (over * over + 9.0);
    c = mix(c, vec3((c.r + c.g + c.b) / 3.0), leak);
    float dither = fract(52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584)))) - 0.5;
    colour = vec4(curve(c.r), curve(c.g), curve(c.b), 1.0) + dither / 255.0;
}`;

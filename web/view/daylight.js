// GLSL of the scene's own light, and of what stands in it: sheets, ground, wall and shapes.
import { LOOK } from "./look.js";
import * as glsl from "./shaders.js";

export const LIGHTS = 16; // lamps at most

/** The scene's sun, sky and lamps, after program/preview/lighting.c and lamps.c: what LAMP is for the page. */
export const DAY = /* glsl */ `${glsl.SHADOW}
uniform vec3 sunTo, sunLight, eye, ambient[9];
uniform mat4 lampView;
uniform float soft;
uniform vec4 lampPlace[${LIGHTS}], lampStrength[${LIGHTS}];
uniform int lampCount;
float lampSeen(vec3 p) {
    vec4 q = lampView * vec4(p, 1.0);
    vec3 s = q.xyz * 0.5 + 0.5;
    if (any(lessThan(s, vec3(0.0))) || any(greaterThan(s, vec3(1.0)))) return 1.0;
    return lightSeen(s - vec3(0.0, 0.0, 0.0015), soft);
}
vec3 skyLight(vec3 n) {
    vec3 sum = 0.282095 * ambient[0] + 0.488603 * (n.y * ambient[1] + n.z * ambient[2] + n.x * ambient[3]);
    sum += 1.092548 * (n.x * n.y * ambient[4] + n.y * n.z * ambient[5] + n.x * n.z * ambient[7]);
    sum += 0.315392 * (3.0 * n.z * n.z - 1.0) * ambient[6] + 0.546274 * (n.x * n.x - n.y * n.y) * ambient[8];
    return max(sum, vec3(0.0));
}
vec3 mirrored(vec3 d) { return skyLight(d); }
vec3 shaded(vec3 albedo, vec3 through, float gloss, float power, vec3 p, vec3 n, vec3 v, float seen) {
    float facing = dot(n, sunTo);
    vec3 sum = sunLight * seen * (max(facing, 0.0) + through * max(-facing, 0.0)), high = vec3(0.0);
    sum += skyLight(n);
    bool thin = through.g > 0.0;
    if (thin) sum += through * skyLight(-n);
    if (gloss > 0.0) high = sunLight * seen * pow(max(dot(n, normalize(sunTo + v)), 0.0), power) + 0.4 * skyLight(reflect(-v, n));
    // lamps set bit by bit on sheets (lamps.c), and at once on what lies below them, in place of the shadow that these cast
    for (int k = 0; k < lampCount; k++) {
        vec3 f = lampPlace[k].xyz - p, light = lampStrength[k].rgb;
        float r2 = dot(f, f), d2 = r2 + lampPlace[k].w, c = dot(n, f) * inversesqrt(d2);
        float wrap = min(float(${LOOK.LAMP_WRAP}) + sqrt(lampPlace[k].w / d2), float(${LOOK.LAMP_WRAP_MOST}));
        float up = clamp((c + wrap) / (2.0 * wrap), 0.0, 1.0), before = thin ? wrap * up * up + max(c - wrap, 0.0) : max(c, 0.0);
        sum += light * ((before + max(-through * c - before, 0.0)) / d2);
        if (gloss > 0.0) high += light * (pow(max(dot(n, normalize(f * inversesqrt(r2) + v)), 0.0), power) / d2);
    }
    return albedo * sum + gloss * high;
}
`;

export const SHEET_VERTEX = /* glsl */ `
in vec3 position, normal, rest;
in vec2 uv;
in vec4 heat, look, more;
in float gap;
uniform mat4 viewProjection;
out vec3 vPosition, vNormal, vRest;
out vec2 vUv;
out vec3 vLeaf;
out vec4 vHeat, vLook, vMore;
void main() {
    vPosition = position;
    vNormal = normal;
    vRest = rest;
    vUv = uv;
    vHeat = heat * vec4(5000.0, 5000.0, 64.0, 0.0);
    vHeat.w = more.y > 0.75 ? vHeat.z : 0.0;
    vLook = look * vec4(1.0, 400.0, 1.0, 655.35);
    vLeaf = vec3(more.w * 0.0655, more.y > 0.25 && more.y < 0.75 ? vHeat.z : 0.0, heat.w * 1.2e5);
    vMore = vec4(more.xy, more.z * 4.0 - 1.0, gap);
    gl_Position = viewProjection * vec4(position, 1.0);
}`;

const FADE = "float far = distance(eye, p) / reach; c = mix(background, c, exp(-far * far * far));";
export const GROUND_WOOD = glsl.table(DAY, "groundColour", FADE).replace("out vec4 colour;", "out vec4 colour;\nuniform vec3 groundColour, background;\nuniform float reach;");
export const GROUND_PLAIN = /* glsl */ `${glsl.NOISE}${DAY}
in vec3 vPosition, vNormal;
out vec4 colour;
uniform vec3 groundColour, background;
uniform float reach, stone;
void main() {
    vec3 p = vPosition, view = normalize(eye - p), n = vec3(0.0, 0.0, 1.0), tone = vec3(1.0);
    if (stone > 0.5) { // after shade_ground.c, without its gravel and pits
        vec2 q = mat2(0.921, 0.389, -0.389, 0.921) * p.xy, side = ${LOOK.SLAB} * (0.5 - abs(fract(q / ${LOOK.SLAB} + vec2(0.31, 0.72)) - 0.5));
        float size = max(length(dFdx(p)), length(dFdy(p))), wide = noise4(vec3(q * 2.3, 0.5)).r, cloud = noise4(vec3(q.x * 7.0 + wide, q.y * 7.0, 2.5)).g, patches = noise4(vec3(q * 26.0, 3.5)).b;
        vec2 rough = noise4(vec3(q * 110.0, 4.5)).ra * clamp(1.5 - size / 0.010, 0.0, 1.0), grain = noise4(vec3(q * 625.0, 5.5)).gb * clamp(1.5 - size / 0.0018, 0.0, 1.0);
        float edge = min(side.x, side.y) - 0.0022 - 0.0016 * max(noise4(vec3(q * 70.0, 6.5)).r, 0.0), soft = max(0.0008, 0.6 * size);
        float joint = (1.0 - smoothstep(-soft, soft, edge)) * min(1.0, 0.0045 / size), bend = 0.03 * noise4(vec3(q * 9.0, 7.5)).r;
        float crack = smoothstep(0.1, 0.5, noise4(vec3(q * 3.0, 9.5)).g) * min(1.0, 0.001 / size) * (1.0 - smoothstep(0.001, 0.004 + 2.5 * size, abs(noise4(vec3((q + bend) * vec2(4.5, 2.6), 8.5)).b)));
        float value = 0.93 + 0.16 * wide + 0.15 * cloud + 0.09 * patches + 0.07 * rough.x + 0.08 * grain.x, warm = 0.5 * cloud - 0.3 * patches;
        tone = vec3(1.03 + 0.05 * warm, 1.0, 0.95 - 0.06 * warm) * max(value * (1.0 - 0.8 * joint) * (1.0 - 0.45 * crack), 0.03);
        n = normalize(vec3(0.03 * (rough + grain), 1.0));
    }
    float seen = lampSeen(p + vec3(0.0, 0.0, 0.0006));
    vec3 c = shaded(groundColour * tone, vec3(0.0), stone > 0.5 ? 0.04 : 0.008, 26.0, p, n, view, seen);
    ${FADE}
    colour = vec4(c, 1.0);
}`;

/** After shade_wall.c. */
export const WALL = /* glsl */ `${glsl.NOISE}${DAY}
in vec3 vPosition;
out vec4 colour;
uniform vec3 wallColour, wallAlong, background;
uniform float reach, bricks, floorHeight;
float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }
void main() {
    vec3 p = vPosition, view = normalize(eye - p), face = vec3(wallAlong.y, -wallAlong.x, 0.0), albedo = wallColour;
    if (dot(view, face) <= 0.0) discard;
    vec2 at = vec2(dot(p, wallAlong), p.z), tilt = vec2(0.0);
    float cloud = noise4(vec3(at * 6.0, 3.5)).r, sweep = noise4(vec3(at * 11.0, 4.5)).g, grain = noise4(vec3(at * 250.0, 5.5)).b;
    if (bricks > 0.5) {
        float row = floor(at.y / 0.075), shift = at.x / 0.225 + 0.5 * mod(row, 2.0), soft = 0.0012 + 0.6 * fwidth(at.y);
        vec2 from = vec2(fract(shift) * 0.225, at.y - row * 0.075), side = min(from, vec2(0.225, 0.075) - from);
        float tone = hash(vec2(row, floor(shift))), edge = min(side.x, side.y) - 0.005 + 0.002 * noise4(vec3(at * 130.0, 6.5)).r, isFace = smoothstep(-soft, soft, edge);
        float hue = hash(vec2(row + 0.5, floor(shift))) - 0.5;
        vec3 clay = vec3(0.56 + 0.14 * hue, 0.31 + 0.05 * hue, 0.22) * (0.94 + 0.55 * tone + 0.20 * cloud + 0.12 * grain);
        albedo *= mix(vec3(0.62, 0.59, 0.53) * (1.0 - (from.y > 0.0375 ? 0.1 : 0.45) * smoothstep(-0.006, 0.0, edge) * (1.0 - isFace)), clay, isFace);
        tilt = 0.04 * vec2(grain, sweep);
    } else if (bricks > -0.5) {
        albedo *= 0.94 + 0.08 * cloud + 0.05 * sweep + 0.05 * grain;
        tilt = 0.03 * vec2(sweep, grain);
    }
    albedo *= 1.0 - 0.5 * exp(-max(p.z - floorHeight, 0.0) / 0.03);
    vec3 c = shaded(albedo, vec3(0.0), 0.0, 1.0, p, normalize(face + tilt.x * wallAlong + vec3(0.0, 0.0, tilt.y)), view, lampSeen(p + 0.0006 * face));
    ${FADE}
    colour = vec4(c, 1.0);
}`;

export const SHAPE = /* glsl */ `${glsl.NOISE}${glsl.GLOW}${glsl.SHAPE_GLOW}${DAY}
in vec3 vPosition, vNormal, vLocal;
uniform vec3 albedo, grain; // grain: what makes vLocal 3.5 at its side
uniform float kelvin;
out vec4 colour;
void main() {
    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    if (dot(n, view) < 0.0) n = -n;
    float seen = lampSeen(vPosition + 0.0015 * n), hot = kelvin > 800.0 ? 1.0 : 0.0;
    vec3 glow = hot * shape_glow(grain * vLocal, n, view, kelvin);
    colour = vec4(shaded(albedo * (1.0 - 0.55 * hot), vec3(0.0), 0.06, 40.0, vPosition, n, view, seen) + glow, 1.0);
}`;

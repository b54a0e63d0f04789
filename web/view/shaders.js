// Shared by the page (web/src) and `singe view` (web/view): GLSL after program/preview: the same noise, scorch, char, ash, ember and flame, as far as a frame's time allows.

/** Four smooth noises from -1 to 1, lattice size 1, by one look into a texture of random corners. */
export const NOISE = /* glsl */ `
precision highp float;
precision highp sampler3D;
uniform sampler3D noiseMap; // 32 corners a side, repeated
vec4 noise4(vec3 p) {
    vec3 i = floor(p), f = p - i;
    f = f * f * (3.0 - 2.0 * f);
    return texture(noiseMap, (i + f + 0.5) / 32.0) * 2.0 - 1.0;
}
float stepf(float a, float b, float x) { return smoothstep(a, b, x); }
`;

/** Blackbodies: row 0 from 800 K to 2100 K as embers, row 1 flames from their coolest to their hottest. */
export const GLOW = /* glsl */ `
uniform sampler2D glowMap;
vec3 emberColour(float kelvin) { return texture(glowMap, vec2((kelvin - 800.0) / 1300.0, 0.25)).rgb; }
vec3 flameColour(float hot) { return texture(glowMap, vec2(hot, 0.75)).rgb; }
`;

/** The lamp with its shadow, the fire's lights, and a little of the night. */
export const LAMP = /* glsl */ `
precision highp sampler2DShadow;
uniform vec3 lampAt, lampTo, lampColour, nightColour;
uniform mat4 lampView;
uniform sampler2DShadow shadowMap;
uniform vec4 fireLights[6]; // position and strength
uniform vec3 fireColour;
uniform vec3 eye;

const vec2 DISC[12] = vec2[12](vec2(-0.33, -0.41), vec2(-0.84, 0.07), vec2(-0.70, 0.46), vec2(-0.20, 0.62), vec2(0.96, -0.19),
    vec2(0.47, -0.48), vec2(0.51, 0.77), vec2(0.19, -0.89), vec2(0.44, 0.02), vec2(0.12, 0.21), vec2(-0.61, -0.75), vec2(0.75, 0.39));

float lampSeen(vec3 p) {
    vec4 q = lampView * vec4(p, 1.0);
    vec3 s = q.xyz / q.w * 0.5 + 0.5;
    if (any(lessThan(s.xy, vec2(0.0))) || any(greaterThan(s.xy, vec2(1.0)))) return 1.0;
    float angle = 6.2832 * fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.0671, 0.00584)))), c = cos(angle), si = sin(angle), sum = 0.0;
    for (int k = 0; k < 12; k++) {
        vec2 d = mat2(c, si, -si, c) * DISC[k];
        sum += texture(shadowMap, vec3(s.xy + d * 0.0042, s.z - 0.0006));
    }
    return sum / 12.0;
}

/** Light on a side with this normal, and that on its back times what comes through. */
vec3 lit(vec3 p, vec3 n, float through, float seen) {
    vec3 to = lampAt - p;
    float d2 = dot(to, to);
    vec3 l = to * inversesqrt(d2);
    float cone = smoothstep(0.62, 0.97, dot(-l, normalize(lampTo - lampAt)));
    float facing = dot(n, l);
    vec3 sum = lampColour * (cone * seen / d2) * (max(facing, 0.0) + through * max(-facing, 0.0));
    for (int k = 0; k < 6; k++) {
        vec3 f = fireLights[k].xyz - p;
        float r2 = dot(f, f) + 0.0012, side = dot(n, f) * inversesqrt(r2);
        sum += fireColour * (fireLights[k].w / r2) * (max(side, 0.0) + 0.12 + through * max(-side, 0.0));
    }
    return sum + nightColour * (0.6 + 0.4 * n.z);
}

/** Their highlights, Blinn and Phong. */
vec3 shine(vec3 p, vec3 n, vec3 v, float power, float seen) {
    vec3 to = lampAt - p, l = normalize(to);
    float cone = smoothstep(0.62, 0.97, dot(-l, normalize(lampTo - lampAt)));
    vec3 sum = lampColour * (cone * seen / dot(to, to)) * pow(max(dot(n, normalize(l + v)), 0.0), power);
    for (int k = 0; k < 6; k++) {
        vec3 f = fireLights[k].xyz - p;
        sum += fireColour * (fireLights[k].w / (dot(f, f) + 0.0012)) * pow(max(dot(n, normalize(normalize(f) + v)), 0.0), power);
    }
    return sum;
}
`;

export const PAPER_VERTEX = /* glsl */ `
in vec3 position, normal, rest;
in vec2 uv;
in vec4 heat, look;
uniform mat4 viewProjection;
out vec3 vPosition, vNormal, vRest;
out vec2 vUv;
out vec4 vHeat, vLook;
void main() {
    vPosition = position;
    vNormal = normal;
    vRest = rest;
    vUv = uv;
    vHeat = heat;
    vLook = look;
    gl_Position = viewProjection * vec4(position, 1.0);
}`;

/** The sheet in this light: GLSL with lampSeen, lit and shine. */
export const paper = (light) => /* glsl */ `${NOISE}${GLOW}${light}
in vec3 vPosition, vNormal, vRest;
in vec2 vUv;
in vec4 vHeat, vLook;
uniform sampler2D printMap;
uniform float time, shadow; // shadow: 1 while the lamp's map is drawn
uniform float transmittance;
uniform vec3 tint;
out vec4 colour;

const float EMBER_BURN = 0.74, EMBER_WIDTH = 0.00042, EMBER_GAIN = 3.4, EMBER_HOT = 1180.0, EMBER_MOST = 6.0;

/** Hotter embers shine on as orange: a film of ash covers them. */
vec3 ember(float kelvin) {
    float above = max(kelvin - EMBER_HOT, 0.0);
    return emberColour(kelvin - above + above * 160.0 / (above + 160.0)) * EMBER_GAIN;
}

vec3 scorchColour(float s) {
    const vec4 stop[8] = vec4[8](vec4(0.0, 1.0, 1.0, 1.0), vec4(0.09, 0.975, 0.93, 0.81), vec4(0.21, 0.84, 0.68, 0.44), vec4(0.57, 0.53, 0.34, 0.165),
        vec4(0.68, 0.32, 0.165, 0.068), vec4(0.77, 0.14, 0.062, 0.026), vec4(0.86, 0.056, 0.030, 0.018), vec4(1.0, 0.020, 0.016, 0.014));
    vec3 c = stop[0].yzw;
    for (int i = 1; i < 8; i++) c = mix(c, stop[i].yzw, clamp((s - stop[i - 1].x) / (stop[i].x - stop[i - 1].x), 0.0, 1.0));
    return c;
}

float ridge(float n, float width) { return 1.0 - stepf(0.0, width, abs(n)); }

void main() {
    float size = max(length(dFdx(vPosition)), length(dFdy(vPosition)));
    vec3 r = vRest, p = vec3(0.7654 * r.x - 0.5321 * r.y + 0.3622 * r.z, 0.6133 * r.x + 0.7718 * r.y - 0.1673 * r.z,
        -0.1905 * r.x + 0.3481 * r.y + 0.9179 * r.z);
    // at a border, a pixel's middle may lie outside the triangle, where fields go on beyond what they can be
    vec4 heat = max(vHeat, 0.0), look = max(vLook, 0.0);
    float temperature = heat.x, peakSoFar = heat.y, rate = heat.z, glowing = heat.w;
    float burnt = min(look.x, 1.0), gradient = min(look.y, 400.0), rim = min(look.z, 1.0), age = look.w;

    // the fields at the picture's scale: ragged isolines
    float coarse = noise4(p * 250.0).r;
    float medium = noise4(p * 769.0 + 0.37).g * clamp(1.6 - size * 615.0, 0.0, 1.0);
    float fine = noise4(p * 2222.0 + 0.71).b * clamp(1.6 - size * 1777.0, 0.0, 1.0);
    float delta = 1.5e-3 * coarse + 0.7e-3 * medium + 0.22e-3 * fine, inside = stepf(0.15, 0.5, burnt);
    float burn = burnt + gradient * delta + inside * (0.03 * coarse + 0.05 * medium + 0.03 * fine);

    // burnt borders crumble, and ash wears
    float bite = 0.40 + 0.38 * medium + 0.20 * fine + 0.28 * coarse;
    float open = stepf(0.35, 0.65, burnt);
    if (open > 0.0 && rim > 1.0 - open * clamp(bite, 0.0, 0.85)) discard;
    float ash = stepf(0.78, 0.94, burn + 0.06 * coarse) * (1.0 - 0.75 * stepf(760.0, 1000.0, temperature));
    vec4 wear = noise4(p * 385.0 + 3.1);
    float lace = wear.r + 0.25 * fine - 0.45 * coarse;
    if (burn > 0.7 && ash * stepf(0.72, 0.95, lace) > 0.5) discard;
    if (shadow > 0.5) { colour = vec4(0.0); return; }

    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    if (dot(n, view) < 0.0) n = -n;

    // fresh paper, browned by the peak of its heat and by what has burnt
    vec3 fresh = vec3(0.86, 0.852, 0.832) * tint * texture(printMap, vUv, -0.7).rgb * (1.0 + 0.018 * noise4(p * 417.0).a);
    float jitter = (0.17 * coarse + 0.08 * medium + 0.025 * fine) * (1.0 - 0.6 * inside);
    float peak = peakSoFar + 0.25 * (peakSoFar - 293.0) * jitter * stepf(310.0, 350.0, peakSoFar), above = peak - 293.0;
    above *= max(1.0 + 0.8 * noise4(p * 111.0).a + 0.35 * coarse, 0.3); // the browned band's border runs in tongues
    float byHeat = above > 55.0 ? 0.76 * min(log(above / 55.0) / log(360.0 / 55.0), 1.0) : 0.0;
    float scorch = 1.0 - (1.0 - byHeat) * exp(-7.5 * max(burn, 0.0));
    float ink = stepf(0.3, 0.75, 1.0 - clamp(dot(fresh, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0));
    vec3 albedo = scorchColour(scorch) * mix(fresh, vec3(0.80), stepf(0.6, 1.0, scorch));
    float through = transmittance * (1.0 - stepf(0.1, 0.7, scorch)), gloss = 0.015, power = 14.0;

    // char, with the print as a dull grey, shining of tar
    float black = stepf(0.12, 0.46, burn);
    if (black > 0.0) {
        float value = 1.0 + 0.35 * medium + 0.3 * fine + 0.35 * coarse;
        vec3 soot = mix(vec3(0.034, 0.020, 0.012), vec3(0.0125, 0.0125, 0.0132), stepf(0.22, 0.62, burn));
        float craze = ridge(noise4(p * 476.0 + 1.7).a, 0.08);
        vec3 charred = soot * value * (1.0 - 0.6 * craze) + ink * vec3(0.052, 0.052, 0.055);
        albedo = mix(albedo, charred, black);
        gloss = mix(gloss, 0.055 * clamp(0.75 + 0.5 * coarse - 0.5 * ink, 0.2, 1.2), black);
        vec3 bump = vec3(noise4(p * 278.0 + 5.3).rgb) * 0.30 * black + noise4(p * 1111.0).rgb * 0.10 * black * clamp(1.6 - size * 900.0, 0.0, 1.0);
        n = normalize(n + bump - n * dot(n, bump));
    }

    // ash: sooty at first, paler with age, palest at veins and rims
    if (ash > 0.01) {
        float cloud = noise4(p * 71.0).g + 0.5 * coarse + 0.2 * medium, pale = stepf(1.0, 13.0, age + 4.0 * cloud);
        vec4 creases = noise4(p * 118.0 + vec3(medium, coarse, fine) * 0.13);
        float vein = max(ridge(creases.r, 0.10), 0.55 * ridge(noise4(p * 294.0).b, 0.13));
        float value = mix(0.040, 0.34, pale) + (0.010 + 0.07 * pale) * cloud + (0.02 + 0.06 * pale) * vein + 0.006 * fine;
        value += (0.03 + 0.07 * pale) * max(stepf(0.25, 0.6, lace), stepf(0.35, 0.95, rim + 0.25 * fine));
        vec3 tone = mix(vec3(0.98, 0.99, 1.03), vec3(1.02, 1.0, 0.965), pale);
        albedo = mix(albedo, tone * clamp(value + (0.05 + 0.19 * pale) * ink, 0.02, 0.64), ash); // ink leaves more ash than fibres
        gloss *= 1.0 - 0.8 * ash;
        through = mix(through, 0.28, ash);
    }

    // embers: a line where char turns to ash, leaves of char that glow, sparks behind
    vec3 glow = vec3(0.0);
    if (burnt > 0.2 && temperature > 420.0) {
        float slow = noise4(p * 21.0 + time * vec3(0.8, -0.5, -1.7)).g, quick = noise4(p * 55.0 - vec3(0.0, 0.0, 7.0 * time)).r;
        float air = clamp(1.0 + 0.42 * slow + 0.22 * quick, 0.3, 1.7);
        float crawl = noise4(p * 190.0 + time * vec3(0.5, -0.35, 0.8)).b, patches = noise4(p * 62.0 + time * vec3(-0.12, 0.2, 0.15)).a;
        float life = stepf(-0.22, 0.62, 0.75 * crawl + 0.5 * patches + 0.35 * medium + 0.2 * fine) * min(air, 1.2);
        float alight = rate / (rate + 0.12), distance_ = (burn - EMBER_BURN) / max(gradient, 20.0);
        float width = max(EMBER_WIDTH * (0.42 + 0.66 * life), 0.55 * size), x = abs(distance_) / width;
        float profile = distance_ > 0.0 ? 0.72 * exp(-0.5 * x * x) + 0.28 * exp(-0.8 * x) : exp(-x * x);
        float kelvin = temperature + 110.0 + 210.0 * (life - 0.6) + 60.0 * fine - (distance_ > 0.0 ? 45.0 * min(x, 3.0) : 0.0);
        float strength = alight * profile * (0.05 + 0.95 * life * life) * (0.85 + 0.4 * fine) * air;
        strength += 0.10 * alight * life * exp(-0.05 * x * x) * ridge(noise4(p * 625.0).g, 0.10);
        glow = ember(kelvin) * max(strength, 0.0);
        float leaf = glowing / (glowing + 0.12);
        glow += ember(temperature + 110.0 + 130.0 * (life - 0.5) + 70.0 * fine + 40.0 * medium) * leaf * (0.15 + 0.85 * life) * air;
        float warm = stepf(420.0, 640.0, temperature) * stepf(0.76, 0.86, burn) * stepf(0.10, 0.55, noise4(p * 85.0).r + 0.3 * medium);
        float late = (age - 3.2) * 0.28 - (noise4(p * 240.0).a + 0.5 * medium + 0.25 * fine);
        glow += emberColour(1035.0 + 50.0 * fine) * 1.5 * warm * air * exp(-70.0 * late * late);
        glow /= 1.0 + max(glow.r, max(glow.g, glow.b)) / EMBER_MOST;
    }

    float seen = lampSeen(vPosition + 0.0008 * n);
    vec3 c = albedo * lit(vPosition, n, through, seen) + gloss * shine(vPosition, n, view, power, seen) + glow;
    colour = vec4(c, 1.0);
}`;

export const PLAIN_VERTEX = /* glsl */ `
in vec3 position, normal;
uniform mat4 modelMatrix, viewProjection;
out vec3 vPosition, vNormal;
void main() {
    vec4 p = modelMatrix * vec4(position, 1.0);
    vPosition = p.xyz;
    vNormal = mat3(modelMatrix) * normal;
    gl_Position = viewProjection * p;
}`;

/** Planks after shade_ground.c, each with its own trunk's rings; `fade` is GLSL that changes c. */
export const table = (light, colour, fade) => /* glsl */ `${NOISE}${light}
in vec3 vPosition, vNormal;
out vec4 colour;
float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }
float noise2(float x, float y, float z) { return noise4(vec3(x, y, z)).r; }
void main() {
    vec3 p = vPosition, view = normalize(eye - p);
    float size = max(length(dFdx(p)), length(dFdy(p)));
    float row = floor(p.y / 0.118), across = fract(p.y / 0.118), shift = hash(vec2(row, 7.0));
    float column = floor(p.x / 1.3 + shift), along = fract(p.x / 1.3 + shift);
    float tone = hash(vec2(row, column)), hue = hash(vec2(row + 0.3, column + 0.7));
    float edge = min(min(across, 1.0 - across) * 0.118, min(along, 1.0 - along) * 1.3);
    float u = along * 1.3 + 60.0 * hash(vec2(row + 0.5, column)), v = (across - 0.5) * 0.118;

    float bend = 0.011 * noise2(u * 2.3, v * 9.0, 0.5) + 0.0022 * noise2(u * 9.0, v * 40.0, 1.5);
    float aside = v + 0.09 * (hue - 0.5) + bend, depth = 0.012 + 0.09 * tone + 0.05 * (along * 1.3 - 0.6);
    float radius = sqrt(aside * aside + depth * depth), year = radius / (0.0034 + 0.0018 * hue) + 0.35 * noise2(u * 1.3, radius * 60.0, 2.5);
    float within = fract(year), strength = 0.45 + 0.55 * hash(vec2(floor(year), tone));
    float late = stepf(0.25, 0.9, within) * (1.0 - stepf(0.9, 1.0, within));
    float sharp = clamp(1.5 - 0.9 * size / (0.0035 / max(abs(aside) / radius, 0.12)), 0.0, 1.0);
    late = mix(0.33, late, sharp) * strength;

    float y = p.y + 0.4 * bend;
    float fibre = noise2(u * 9.0, y * 520.0, 3.5) * clamp(1.5 - 0.9 * size / 0.0022, 0.0, 1.0)
        + 0.8 * noise2(u * 14.0, y * 1100.0, 4.5) * clamp(1.5 - 0.9 * size / 0.001, 0.0, 1.0);
    float pores = noise2(u * 75.0, y * 1700.0, 5.5) * clamp(1.5 - 0.9 * size / 0.0008, 0.0, 1.0);
    float blotch = noise2(u * 3.1, v * 14.0, 6.5), wear = noise2(p.x * 5.0, p.y * 5.0, 7.5);
    float value = 1.10 + 0.34 * (tone - 0.5) - 0.50 * late + 0.055 * fibre + 0.10 * blotch + 0.05 * wear;
    value *= 1.0 - 0.38 * stepf(0.25, 0.7, pores);
    float soft = max(0.0009, 0.7 * size), joint = 1.0 - stepf(0.0002, soft + 0.0002, edge);
    value *= 1.0 - 0.8 * joint * min(1.0, 0.0016 / size);

    float red = clamp(0.35 * late + 0.5 * (hue - 0.5), -0.3, 0.5);
    vec3 albedo = ${colour} * vec3(1.0 + 0.22 * red, 1.0 - 0.10 * red, 1.0 - 0.42 * red) * max(value, 0.04);
    vec3 n = normalize(vec3(0.004 * wear, 0.012 * (blotch + fibre), 1.0));
    float polish = (0.42 - 0.18 * late + 0.10 * wear) * (1.0 - 0.8 * joint), seen = lampSeen(p + vec3(0.0, 0.0, 0.0006));
    vec3 c = albedo * lit(p, n, 0.0, seen) + 0.10 * polish * shine(p, n, view, 26.0, seen);
    ${fade}
    colour = vec4(c, 1.0);
}`;

export const solid = (light) => /* glsl */ `${NOISE}${light}
in vec3 vPosition, vNormal;
uniform vec3 albedo, emission;
uniform float gloss;
out vec4 colour;
void main() {
    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    float seen = lampSeen(vPosition + 0.0015 * n), grain = 1.0 + 0.12 * noise4(vPosition * vec3(900.0, 900.0, 900.0)).r;
    colour = vec4(albedo * grain * lit(vPosition, n, 0.0, seen) + gloss * shine(vPosition, n, view, 40.0, seen) + emission, 1.0);
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
        colour = vec4(emberColour(vWhat.y) * 3.4 * vWhat.z * inside * inside, 0.0);
        return;
    }
    vec2 seed = vWhat.yz * vec2(0.37, 71.0);
    float inside = 0.80 + 0.34 * noise4(vec3(1.6 * vAt, seed.y)).r + 0.15 * noise4(vec3(5.0 * vAt, seed.y)).g - length(vAt);
    if (inside < 0.0) discard;
    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    if (dot(n, view) < 0.0) n = -n;
    float rim = 1.0 - stepf(0.0, 0.28, inside), pale = clamp(vWhat.z + 0.25 * rim + 0.3 * noise4(vec3(2.3 * vAt, seed.y)).b, 0.0, 1.0);
    vec3 albedo = mix(vec3(0.014), vec3(0.30, 0.30, 0.29), pale * pale);
    vec3 glow = emberColour(vWhat.y) * 1.6 * stepf(800.0, 950.0, vWhat.y) * stepf(-0.1, 0.5, noise4(vec3(4.0 * vAt, seed.y)).a);
    colour = vec4(albedo * lit(vPosition, n, 0.25, lampSeen(vPosition)) + glow, 0.96) * vec4(vec3(0.96), 1.0);
}`;

export const FULL_VERTEX = /* glsl */ `
in vec3 position;
out vec2 at;
void main() {
    at = position.xy * 0.5 + 0.5;
    gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

/**
 * Marches through flame and smoke (fire_shade.c, fire_march.c): flames are thin shells of soot, and a step takes its
 * mean from the depths of both its ends. Light, and in alpha what is left of what lies behind.
 */
export const FIRE = /* glsl */ `${NOISE}${GLOW}
in vec2 at;
uniform sampler3D fireMap;
uniform sampler2D depthMap;
uniform mat4 inverse_;
uniform vec3 eye, low, high, origin, span, match_, lampColour, lampAt;
uniform float time, matchOn, paperHeight;
uniform vec4 fireLights[6];
uniform vec3 fireColour;
out vec4 colour;

const float BASE_SPEED = 0.14, BUOYANCY = 3.0, EDDY_RATE = 8.0, EDDY_WIDE = 0.014, EDDY_FINE = 0.006, FLAME_HEIGHT = 0.08, FLAME_END = 0.3, FLAME_SEEN = 0.15;
const float SOOT_DENSE = 42.0, SOOT_OPAQUE = 14.0, BLUE_DENSE = 0.9, BLUE_ENDS = 0.005, SHELL_RISE = 0.0005, SHELL = 0.0018, EDGE = 0.42, TAPER = 0.55;
const float STAND_OFF = 0.0006, SOOT_BEGINS = 0.0038, SOOT_FULL = 0.0105, OUTSIDE = -0.006;

float passed(float height) {
    float speed = sqrt(BASE_SPEED * BASE_SPEED + 2.0 * BUOYANCY * max(height, 0.0));
    return EDDY_RATE * (time - (speed - BASE_SPEED) / BUOYANCY) - min(height, 0.0) * EDDY_RATE / BASE_SPEED;
}
vec4 eddies(vec3 p, float gone, float width, float often) {
    vec2 q = mat2(0.829, 0.559, -0.559, 0.829) * p.xy / width;
    return noise4(vec3(q.x + 0.21 * gone, q.y + 0.17 * gone, -often * gone));
}
/** flame, height above the paper times flame (m), smoke (1/m), gradient of flame (1/m) */
vec4 gas(vec3 p) { return texture(fireMap, (p - origin) / span) * vec4(1.0, FLAME_END, 20.0, float(textureSize(fireMap, 0).x) / span.x); }

/** light of soot and root, 1/m; depth inside the edge, m; light there; its integral from the edge; extinction, 1/m */
struct Point { vec3 soot, root; float depth, profile, shell, opaque; };

Point flame(vec4 c, vec4 wide, vec4 fine) {
    Point point = Point(vec3(0.0), vec3(0.0), OUTSIDE, 0.0, 0.0, 0.0);
    if (c.r <= 0.02) return point;
    float rise = max(c.g / c.r, 0.0), torn = stepf(0.0, 0.02, rise), tall = rise / FLAME_HEIGHT;
    float coarse = 0.075 + 0.425 * torn, small = 0.025 + 0.225 * torn;
    float edge = c.r + coarse * (0.6 - 2.4 * abs(wide.b)) + small * (0.4 - 2.0 * abs(fine.b)) - EDGE - TAPER * (1.0 - exp(-tall)) - 0.1 * (1.0 - torn);
    edge = min(edge, 2.0 * (c.r - FLAME_SEEN));
    float noisy = 2.0 * (coarse / EDDY_WIDE + small / EDDY_FINE);
    point.depth = max(edge * inversesqrt(c.a * c.a + 0.4 * noisy * noisy + 1.0), OUTSIDE);

    float tip = stepf(0.35, 1.4, tall), fill = mix(0.02, 0.12, tip), outer = clamp(point.depth, 0.0, SHELL_RISE), inner = max(point.depth - SHELL_RISE, 0.0);
    float fading = (1.0 - fill) * exp(-inner / SHELL);
    point.profile = outer / SHELL_RISE * (fill + fading);
    point.shell = 0.5 * outer * outer / SHELL_RISE + fill * inner + SHELL * (1.0 - fill - fading);

    float soot = stepf(SOOT_BEGINS, SOOT_FULL, rise + 0.001 * fine.a);
    float hot = 0.39 + 0.42 * stepf(0.0, 0.7, edge) - 0.2 * tip + 0.25 * wide.a + 0.15 * fine.r;
    soot *= soot;
    float root = stepf(STAND_OFF, 3.0 * STAND_OFF, rise) * (1.0 - soot) * (1.0 - stepf(BLUE_ENDS / 3.0, BLUE_ENDS, rise));
    root *= stepf(0.0, 2.0 * SHELL, point.depth); // its outline is no ring
    soot *= 0.3 + 1.2 * stepf(-0.5, 0.5, 0.7 * wide.a + 0.6 * fine.r);
    point.opaque = SOOT_OPAQUE * soot;
    point.soot = flameColour(clamp(hot, 0.0, 1.0)) * SOOT_DENSE * soot;
    point.root = vec3(0.12, 0.42, 1.25) * BLUE_DENSE * root;
    return point;
}

/** The mean light of a step between two points, per metre, and its extinction. */
vec4 between(Point a, Point b, float step_) {
    if (max(a.depth, b.depth) <= 0.0) return vec4(0.0);
    float apart = abs(b.depth - a.depth), part = 0.5 * (a.profile + b.profile);
    if (apart > 5e-5) part = min(abs(b.shell - a.shell) / min(apart, step_), 1.0);
    float end = a.depth > b.depth ? (b.depth <= 0.0 ? 0.0 : 0.5) : (a.depth > 0.0 ? 0.5 : 1.0); // of the end inside
    return part * vec4(mix(a.soot, b.soot, end) + mix(a.root, b.root, end), mix(a.opaque, b.opaque, end));
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
    return body * (flameColour(clamp(0.95 - 0.5 * stepf(0.3, 1.0, h), 0.0, 1.0)) * 90.0 * stepf(-0.1, 0.35, h) + vec3(0.3, 0.6, 1.6) * 6.0 * (1.0 - stepf(-0.1, 0.2, h)));
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
    float clear = 1.0, jitter = fract(52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584)) + 0.618 * fract(time * 7.0)));
    if (t < end) {
        float short_ = max((end - t) / 140.0, 0.0022), pace = 2.0 * short_;
        Point here = Point(vec3(0.0), vec3(0.0), OUTSIDE, 0.0, 0.0, 0.0);
        t += pace * jitter;
        for (int i = 0; i < 140 && t < end && clear > 0.02; i++) {
            vec3 p = eye + ray * t;
            vec4 c = gas(p), j = vec4(0.0);
            Point there = Point(vec3(0.0), vec3(0.0), OUTSIDE, 0.0, 0.0, 0.0);
            if (c.r > 0.004 || c.b > 0.1) {
                float gone = passed(c.r > 0.004 ? c.g / c.r : p.z - paperHeight);
                vec4 wide = eddies(p, gone, EDDY_WIDE, 1.0);
                vec3 q = p + vec3(wide.rg, 0.0) * 0.0039;
                vec4 fine = eddies(q, gone, EDDY_FINE, 1.6);
                c = gas(q + vec3(fine.rg, 0.0) * 0.0013);
                there = flame(c, wide, fine);
                float smoke = max(c.b * (1.0 + 0.9 * wide.a), 0.0);
                if (smoke > 0.0) {
                    vec3 lamp = lampColour * 0.10 / max(dot(lampAt - p, lampAt - p), 0.02), glow = vec3(0.0);
                    for (int k = 0; k < 6; k++) { vec3 f = fireLights[k].xyz - p; glow += fireColour * fireLights[k].w / (dot(f, f) + 0.003); }
                    j += vec4(0.05 * smoke * (lamp + 0.35 * min(glow, vec3(1.5))), smoke);
                }
            }
            j += between(here, there, pace);
            here = there;
            float depth = j.a * pace, kept = exp(-depth);
            light += j.rgb * clear * pace * (depth > 1e-3 ? (1.0 - kept) / depth : 1.0);
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

/** Fire in front of the scene. */
export const MERGE = /* glsl */ `
precision highp float;
in vec2 at;
uniform sampler2D sceneMap, fireMap2;
out vec4 colour;
void main() {
    vec2 d = 0.75 / vec2(textureSize(fireMap2, 0)); // the mean of a few: steps of the fire begin at random
    vec4 f = 0.25 * (texture(fireMap2, at + d) + texture(fireMap2, at - d) + texture(fireMap2, at + vec2(d.x, -d.y)) + texture(fireMap2, at + vec2(-d.x, d.y)));
    colour = vec4(texture(sceneMap, at).rgb * f.a + f.rgb, 1.0);
}`;

/** What is overexposed, smaller. */
export const BRIGHT = /* glsl */ `
precision highp float;
in vec2 at;
uniform sampler2D map;
uniform vec2 pixel;
uniform float exposure;
out vec4 colour;
void main() {
    vec3 sum = vec3(0.0);
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            vec3 c = min(texture(map, at + (vec2(i, j) * 2.0 - 1.0) * pixel).rgb * exposure, vec3(16.0));
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
    float weight = 1.0, radius = min(ceil(2.5 * sigma), 40.0);
    for (float k = 1.0; k <= radius; k += 1.0) {
        float w = exp(-0.5 * k * k / (sigma * sigma));
        sum += w * (texture(map, at + along * k).rgb + texture(map, at - along * k).rgb);
        weight += 2.0 * w;
    }
    colour = vec4(sum / weight, 1.0);
}`;

/** The halo and the film's curve (film.c). */
export const FILM = /* glsl */ `
precision highp float;
in vec2 at;
uniform sampler2D map, halo, glare;
uniform float exposure, vignette;
uniform vec2 resolution;
out vec4 colour;
float curve(float x) {
    float f = x * (1.0 - 0.4 * exp(-x / 0.06));
    float over = max(f - 0.6, 0.0) / 0.4;
    f = f < 0.6 ? f : 0.6 + 0.4 * over / (1.0 + over);
    return f <= 0.0031308 ? 12.92 * f : 1.055 * pow(f, 1.0 / 2.4) - 0.055;
}
void main() {
    vec3 c = texture(map, at).rgb * exposure + 0.14 * texture(halo, at).rgb + 0.10 * texture(glare, at).rgb;
    vec2 d = (at - 0.5) * vec2(resolution.x / resolution.y, 1.0);
    c *= 1.0 - vignette * smoothstep(0.35, 1.05, length(d));
    float over = max(max(c.r, max(c.g, c.b)) - 1.0, 0.0), leak = 0.03 + 0.16 * over * over / (over * over + 9.0);
    c = mix(c, vec3((c.r + c.g + c.b) / 3.0), leak);
    float dither = fract(52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584)))) - 0.5;
    colour = vec4(curve(c.r), curve(c.g), curve(c.b), 1.0) + dither / 255.0;
}`;

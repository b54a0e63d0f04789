// Draws a frame by WebGL 2: ground, sheets and shapes in the scene's light, then fire, a lens's halo and the film's curve,
// with the shaders of the page; or one field of the sheets by colour.
import { Flying } from "./flying.js";
import { refineGas } from "./gas.js";
import { LOOK } from "./look.js";
import * as glsl from "./shaders.js";
import { glowBytes, noiseBytes, sliceBytes } from "./tables.js";
import { gapsOf, REACH } from "./contact.js";
import { FIELDS, VERTEX_BYTES } from "./frame.js";
import { add, apply, cross, dot, invert, length, lookAt, multiply, orthographic, perspective, placed, unit } from "./math.js";
import { COLOURS, placesOf } from "./strands.js";

const SHADOW = 2048, LIGHTS = 16, GAP = FIELDS.length, TABLE = 1024; // the attribute of contact; texels of a row of a table

/** The scene's sun, sky and lamps, after program/preview/lighting.c and lamps.c: what LAMP is for the page. */
const DAY = /* glsl */ `${glsl.SHADOW}
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
const vec3 THROUGH = vec3(1.18, 0.98, 0.70); // scattered often, light is warmer
vec3 shaded(vec3 albedo, float through, float gloss, float power, vec3 p, vec3 n, vec3 v, float seen) {
    float facing = dot(n, sunTo);
    vec3 sum = sunLight * seen * (max(facing, 0.0) + through * THROUGH * max(-facing, 0.0)), high = vec3(0.0);
    sum += skyLight(n);
    if (through > 0.0) sum += through * THROUGH * skyLight(-n);
    if (gloss > 0.0) high = sunLight * seen * pow(max(dot(n, normalize(sunTo + v)), 0.0), power) + 0.4 * skyLight(reflect(-v, n));
    // sheets are wrapped, as flames have an extent; what lies below them is not, in place of the shadow that sheets cast
    float wrap = through > 0.0 ? 0.2 : 0.0;
    for (int k = 0; k < lampCount; k++) {
        vec3 f = lampPlace[k].xyz - p, light = lampStrength[k].rgb;
        float r2 = dot(f, f), d2 = r2 + lampPlace[k].w, c = dot(n, f) * inversesqrt(d2);
        float before = max((c + wrap) / (1.0 + wrap), 0.0);
        sum += light * ((before + THROUGH * max(-through * c - before, 0.0)) / d2);
        if (gloss > 0.0) high += light * (pow(max(dot(n, normalize(f * inversesqrt(r2) + v)), 0.0), power) / d2);
    }
    return albedo * sum + gloss * high;
}
`;

const SHEET_VERTEX = /* glsl */ `
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
const GROUND_WOOD = glsl.table(DAY, "groundColour", FADE).replace("out vec4 colour;", "out vec4 colour;\nuniform vec3 groundColour, background;\nuniform float reach;");
const GROUND_PLAIN = /* glsl */ `${glsl.NOISE}${DAY}
in vec3 vPosition, vNormal;
out vec4 colour;
uniform vec3 groundColour, background;
uniform float reach, stone;
void main() {
    vec3 p = vPosition, view = normalize(eye - p);
    float cloud = noise4(p * 7.0).r, patches = noise4(p * 26.0).g, rough = noise4(p * 110.0).b, value = 1.0;
    vec3 n = vec3(0.0, 0.0, 1.0);
    if (stone > 0.5) {
        float line = abs(noise4(vec3((p.x + 0.03 * cloud) * 7.5 + 3.0, p.y * 2.6, 0.5)).r);
        value = 0.95 + 0.30 * cloud + 0.22 * patches + 0.13 * rough + 1.1 * (1.0 - smoothstep(0.004, 0.025, line)) * smoothstep(-0.45, 0.25, patches);
        n = normalize(vec3(0.02 * patches, 0.02 * rough, 1.0));
    }
    float seen = lampSeen(p + vec3(0.0, 0.0, 0.0006));
    vec3 c = shaded(groundColour * max(value, 0.1), 0.0, stone > 0.5 ? 0.04 : 0.008, 26.0, p, n, view, seen);
    ${FADE}
    colour = vec4(c, 1.0);
}`;

/** After shade_wall.c. */
const WALL = /* glsl */ `${glsl.NOISE}${DAY}
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
    vec3 c = shaded(albedo, 0.0, 0.0, 1.0, p, normalize(face + tilt.x * wallAlong + vec3(0.0, 0.0, tilt.y)), view, lampSeen(p + 0.0006 * face));
    ${FADE}
    colour = vec4(c, 1.0);
}`;

const SHAPE = /* glsl */ `${glsl.NOISE}${glsl.GLOW}${DAY}
in vec3 vPosition, vNormal;
uniform vec3 albedo;
uniform float kelvin;
out vec4 colour;
void main() {
    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    if (dot(n, view) < 0.0) n = -n;
    float seen = lampSeen(vPosition + 0.0015 * n), hot = kelvin > 800.0 ? 1.0 : 0.0, scale = noise4(vPosition * 120.0).r;
    vec3 glow = hot * blackbody_glow(kelvin + 60.0 * scale) * 3.0 * (0.6 + 0.4 * dot(n, view));
    colour = vec4(shaded(albedo * (1.0 - 0.55 * hot), 0.0, 0.06, 40.0, vPosition, n, view, seen) + glow, 1.0);
}`;

/** One field by colour, shaded a little so that folds are seen. */
const FIELD = /* glsl */ `precision highp float;
in vec3 vPosition, vNormal;
in vec4 vHeat, vLook, vMore;
uniform vec3 eye, range; // range: which, and the ends
uniform sampler2D colours;
out vec4 colour;
void main() {
    float value = range.x < 0.5 ? vHeat.x : range.x < 1.5 ? vLook.x : range.x < 2.5 ? vMore.z : vMore.w, t = clamp((value - range.y) / (range.z - range.y), 0.0, 1.0);
    vec3 n = normalize(vNormal), view = normalize(eye - vPosition);
    float shade = 0.58 + 0.42 * abs(dot(n, view)) + 0.10 * n.x;
    colour = vec4(texture(colours, vec2(t, 0.5)).rgb * shade, 1.0);
}`;
const FIELD_GROUND = /* glsl */ `precision highp float;
in vec3 vPosition;
uniform vec3 eye;
uniform float reach;
out vec4 colour;
void main() {
    vec2 g = vPosition.xy / 0.05, w = fwidth(g), d = abs(fract(g - 0.5) - 0.5) / max(w, 1e-4);
    float line = (1.0 - min(min(d.x, d.y), 1.0)) * clamp(1.5 - 3.0 * max(w.x, w.y), 0.0, 1.0), far = distance(eye, vPosition) / reach;
    colour = vec4(mix(vec3(0.062, 0.056, 0.052), vec3(0.075, 0.068, 0.062) + 0.07 * line, exp(-4.0 * far * far)), 1.0);
}`;
/** A spring as a bar of some pixels, a little in front of the sheet. An end is a vertex, or the mean of a cell's corners. */
const STRAND_VERTEX = /* glsl */ `
precision highp usampler2D;
in uvec2 ends;
uniform sampler2D places;
uniform usampler2D cellMap;
uniform int vertexCount;
uniform mat4 viewProjection;
uniform vec3 eye;
uniform vec2 resolution;
uniform float thick; // pixels
vec4 place(int k) { return texelFetch(places, ivec2(k % ${TABLE}, k / ${TABLE}), 0); }
vec4 end(int k) {
    if (k < vertexCount) return place(k);
    k -= vertexCount;
    uvec4 corner = texelFetch(cellMap, ivec2(k % ${TABLE}, k / ${TABLE}), 0);
    vec4 a = place(int(corner.x)), b = place(int(corner.y)), c = place(int(corner.z)), d = place(int(corner.w));
    return vec4(0.25 * (a.xyz + b.xyz + c.xyz + d.xyz), min(min(a.w, b.w), min(c.w, d.w)));
}
void main() {
    vec4 a = end(int(ends.x)), b = end(int(ends.y));
    vec4 p = viewProjection * vec4(mix(a.xyz, eye, 0.003), 1.0), q = viewProjection * vec4(mix(b.xyz, eye, 0.003), 1.0);
    if (min(a.w, b.w) < 0.5 || min(p.w, q.w) <= 0.0) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; } // outside
    vec2 along = (q.xy / q.w - p.xy / p.w) * resolution * 0.5;
    float size = length(along), wide = clamp(0.16 * size, 0.4, thick);
    vec2 across = vec2(-along.y, along.x) / max(size, 1e-6);
    gl_Position = gl_VertexID < 2 ? p : q;
    gl_Position.xy += ((gl_VertexID & 1) == 0 ? wide : -wide) * across * gl_Position.w / resolution;
}`;
const STRAND = /* glsl */ `precision highp float;
uniform vec3 tint;
out vec4 colour;
void main() { colour = vec4(tint, 1.0); }`;
/** The gas in a plane: the share that burns by colour, smoke in grey, a border around the cells. */
const SLICE = /* glsl */ `precision highp float;
precision highp sampler3D;
in vec3 vPosition;
uniform sampler3D fireMap;
uniform sampler2D colours;
uniform vec3 origin, span;
out vec4 colour;
void main() {
    vec3 at = (vPosition - origin) / span, off = abs(at - 0.5), wide = fwidth(at);
    if (any(greaterThan(off, vec3(0.5)))) discard;
    vec4 c = texture(fireMap, at);
    float burning = smoothstep(0.01, 0.12, c.r), grey = 0.85 * (1.0 - exp(-2.5 * c.b)), rim = any(greaterThan(off, 0.5 - 1.5 * wide)) ? 0.5 : 0.0;
    vec3 smoke = vec3(0.42, 0.40, 0.39);
    colour = vec4(mix(smoke, texture(colours, vec2(c.r, 0.5)).rgb, burning), max(max(burning, grey), max(rim, 0.10)));
}`;
const COPY = /* glsl */ `precision highp float;
in vec2 at;
uniform sampler2D map;
out vec4 colour;
void main() { colour = texture(map, at); }`;

// ---- fields and their colours

const hex = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
export const LAYERS = {
    temperature: { index: 0, low: 293, high: 1293, unit: "°C", show: (k) => `${Math.round(k - 273.15)}`, stops: ["#15102b", "#43146e", "#8a2580", "#d8456c", "#fb8861", "#fec488", "#fcfdbf"] },
    char: { index: 1, low: 0, high: 1, unit: "burnt", show: (x) => `${Math.round(100 * x)} %`, stops: ["#f0e6d6", "#d9a860", "#8a5222", "#2c1a12", "#1b1918", "#55524f", "#b9b4ab"] },
    strain: { index: 2, low: -0.15, high: 0.15, unit: "stretch", show: (x) => `${x > 0 ? "+" : ""}${Math.round(100 * x)} %`, stops: ["#2a5da8", "#5b8fc7", "#a9c6dd", "#ece6da", "#eab48a", "#d6703f", "#a8321f"] },
};
LAYERS.gas = { index: 1, low: 0, high: 1, unit: "burning", show: (x) => (x === 0.5 ? "of the gas burns" : `${Math.round(100 * x)} %`), stops: ["#2b1512", "#7c1d10", "#d9480f", "#ff922b", "#ffd43b", "#fff3bf"] };
LAYERS.contact = { index: 3, low: 0, high: 1, show: (x) => `${1000 * REACH * (1 - x)} mm`, stops: ["#2b2622", "#31485a", "#3f7f8c", "#74b79a", "#e6d27a", "#fff6d8"] };
LAYERS.strands = { index: 1, low: 0, high: 1, stops: ["#1d1917", "#1d1917"], names: COLOURS };
export function cssGradient(layer) {
    const { stops, names } = LAYERS[layer], parts = names ? names.map(([colour], i) => `${colour} ${(100 * i) / names.length}% ${(100 * (i + 1)) / names.length}%`) : stops;
    return `linear-gradient(90deg, ${parts.join(", ")})`;
}
/** What stands under a layer's colours. */
export function legendOf(layer) {
    const { low, high, unit, show, names } = LAYERS[layer];
    return names ? names.map(([, name]) => name) : [low, (low + high) / 2, high].map((value) => show(value) + (unit === "°C" ? " °C" : ""));
}
function ramp({ stops }) {
    const bytes = new Uint8Array(1024), colours = stops.map(hex);
    for (let i = 0; i < 256; i++) {
        const x = (i / 255) * (colours.length - 1), k = Math.min(Math.floor(x), colours.length - 2);
        for (let c = 0; c < 3; c++) bytes[4 * i + c] = colours[k][c] + (x - k) * (colours[k + 1][c] - colours[k][c]);
        bytes[4 * i + 3] = 255;
    }
    return bytes;
}

/** Spheres, boxes and capsules as triangles: positions, then normals. */
function sphere(squeeze = 0) {
    const p = [], index = [], rows = 24, columns = 40;
    for (let r = 0; r <= rows; r++)
        for (let c = 0; c <= columns; c++) {
            const a = (Math.PI * r) / rows, b = (2 * Math.PI * c) / columns, n = [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)];
            p.push(n[0], n[1], n[2] + squeeze * (r * 2 < rows ? 1 : -1), ...n);
        }
    for (let r = 0; r < rows; r++)
        for (let c = 0; c < columns; c++) {
            const a = r * (columns + 1) + c, b = a + columns + 1;
            index.push(a, b, a + 1, a + 1, b, b + 1);
        }
    return [p, index];
}
function box() {
    const p = [], index = [];
    for (let axis = 0; axis < 3; axis++)
        for (const side of [-1, 1]) {
            const first = p.length / 6;
            for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
                const at = [0, 0, 0], n = [0, 0, 0];
                at[axis] = n[axis] = side;
                at[(axis + 1) % 3] = u;
                at[(axis + 2) % 3] = v;
                p.push(...at, ...n);
            }
            index.push(first, first + 1, first + 2, first, first + 2, first + 3);
        }
    return [p, index];
}

export class Stage {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas) {
        const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, preserveDrawingBuffer: true, powerPreference: "high-performance" });
        if (!gl || !gl.getExtension("EXT_color_buffer_float")) throw new Error("This view needs WebGL 2 with floating-point pictures, which this browser or its card does not have.");
        gl.getExtension("OES_texture_float_linear");
        this.gl = gl;
        this.canvas = canvas;
        this.layer = "paper";
        this.slice = 0.5;
        this.fire = true;
        this.programs = {
            wood: this.program(glsl.PLAIN_VERTEX, GROUND_WOOD), plain: this.program(glsl.PLAIN_VERTEX, GROUND_PLAIN), wall: this.program(glsl.PLAIN_VERTEX, WALL), shape: this.program(glsl.PLAIN_VERTEX, SHAPE),
            paper: this.program(SHEET_VERTEX, glsl.paper(DAY)), caster: this.program(SHEET_VERTEX, `#define SHADOW\n${glsl.paper(DAY)}`), field: this.program(SHEET_VERTEX, FIELD), slice: this.program(glsl.PLAIN_VERTEX, SLICE), grid: this.program(glsl.PLAIN_VERTEX, FIELD_GROUND),
            strand: this.program(STRAND_VERTEX, STRAND), flying: this.program(glsl.AIRBORNE_VERTEX, glsl.airborne(DAY)), fire: this.program(glsl.FULL_VERTEX, glsl.FIRE), bright: this.program(glsl.FULL_VERTEX, glsl.BRIGHT),
            blur: this.program(glsl.FULL_VERTEX, glsl.BLUR), film: this.program(glsl.FULL_VERTEX, glsl.FILM), copy: this.program(glsl.FULL_VERTEX, COPY),
        };
        const { side, bytes } = noiseBytes(), glow = glowBytes();
        this.noise = this.texture3d(side, side, side, bytes, gl.REPEAT);
        this.slices = this.texture3d(side, side, 4, sliceBytes().bytes, gl.REPEAT, gl.TEXTURE_2D_ARRAY);
        this.glow = this.texture2d(glow.width, 2, gl.RGBA16F, gl.RGBA, gl.FLOAT, glow.values);
        this.ramps = Object.fromEntries(Object.entries(LAYERS).map(([name, layer]) => [name, this.texture2d(256, 1, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, ramp(layer))]));
        this.white = this.texture2d(1, 1, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array([255, 255, 255, 255]));
        this.quad = this.mesh([-1, -1, 0, 0, 0, 1, 1, -1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, -1, 1, 0, 0, 0, 1], [0, 1, 2, 0, 2, 3]);
        this.kinds = { 1: this.mesh(...sphere()), 2: this.mesh(...box()) };
        this.flying = new Flying(this, this.programs.flying);
        this.solids = new Map();
        this.pictures = [];
        this.sheets = { array: gl.createVertexArray(), vertices: gl.createBuffer(), triangles: gl.createBuffer(), gaps: gl.createBuffer(), runs: [] };
        this.targets = {};
        this.shadowMap = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, this.shadowMap);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW, SHADOW);
        for (const [name, value] of [["TEXTURE_MIN_FILTER", gl.LINEAR], ["TEXTURE_MAG_FILTER", gl.LINEAR], ["TEXTURE_COMPARE_MODE", gl.COMPARE_REF_TO_TEXTURE], ["TEXTURE_COMPARE_FUNC", gl.LEQUAL]])
            gl.texParameteri(gl.TEXTURE_2D, gl[name], value);
        this.shadowFrame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadowMap, 0);
        this.resize(canvas.width, canvas.height);
    }

    // ---- what WebGL needs

    program(vertex, fragment) {
        const { gl } = this, program = gl.createProgram();
        for (const [kind, text] of [[gl.VERTEX_SHADER, `precision highp float;\n${vertex}`], [gl.FRAGMENT_SHADER, fragment]]) {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, `#version 300 es\n${text}`);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
        }
        FIELDS.forEach(([name], i) => gl.bindAttribLocation(program, i, name));
        gl.bindAttribLocation(program, GAP, "gap");
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program));
        const uniforms = new Map();
        for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
            const { name, type } = gl.getActiveUniform(program, i);
            uniforms.set(name.replace("[0]", ""), [gl.getUniformLocation(program, name), type]);
        }
        return { program, uniforms };
    }

    use({ program, uniforms }, values) {
        const { gl } = this;
        let unit_ = 0;
        gl.useProgram(program);
        for (const [name, [place, type]] of uniforms) {
            const value = values[name];
            if (value === undefined) throw new Error(`no value of ${name}`);
            switch (type) {
            case gl.FLOAT: gl.uniform1f(place, value); break;
            case gl.INT: gl.uniform1i(place, value); break;
            case gl.FLOAT_VEC2: gl.uniform2fv(place, value); break;
            case gl.FLOAT_VEC3: gl.uniform3fv(place, value); break;
            case gl.FLOAT_VEC4: gl.uniform4fv(place, value); break;
            case gl.FLOAT_MAT4: gl.uniformMatrix4fv(place, false, value); break;
            default:
                gl.activeTexture(gl.TEXTURE0 + unit_);
                gl.bindTexture(type === gl.SAMPLER_3D ? gl.TEXTURE_3D : type === gl.SAMPLER_2D_ARRAY ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, value);
                gl.uniform1i(place, unit_++);
            }
        }
    }

    texture2d(width, height, inner, format, type, data, mip = false) {
        const { gl } = this, texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, type, data);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, mip ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, mip ? gl.REPEAT : gl.CLAMP_TO_EDGE);
        if (mip) {
            gl.generateMipmap(gl.TEXTURE_2D);
            const sharp = gl.getExtension("EXT_texture_filter_anisotropic");
            if (sharp) gl.texParameterf(gl.TEXTURE_2D, sharp.TEXTURE_MAX_ANISOTROPY_EXT, 8);
        }
        return texture;
    }

    texture3d(x, y, z, bytes, wrap, kind = this.gl.TEXTURE_3D) {
        const { gl } = this, texture = gl.createTexture();
        gl.bindTexture(kind, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.texImage3D(kind, 0, gl.RGBA, x, y, z, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(kind, name, gl.LINEAR);
        for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(kind, name, wrap);
        return texture;
    }

    /** Positions and normals by turns. */
    mesh(values, triangles) {
        const { gl } = this, array = gl.createVertexArray();
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
        for (const i of [0, 1]) {
            gl.enableVertexAttribArray(i);
            gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 24, 12 * i);
        }
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(triangles), gl.STATIC_DRAW);
        gl.bindVertexArray(null);
        return { array, count: triangles.length };
    }

    target(name, width, height) {
        const { gl } = this, old = this.targets[name];
        if (old) { gl.deleteTexture(old.texture); gl.deleteFramebuffer(old.frame); }
        const texture = this.texture2d(width, height, gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, null), frame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
        this.targets[name] = { texture, frame, width, height };
    }

    resize(width, height) {
        const { gl } = this, w = Math.max(width, 2), h = Math.max(height, 2), half = Math.ceil(w / 2), quarter = Math.ceil(w / 4);
        this.canvas.width = w;
        this.canvas.height = h;
        this.target("scene", w, h);
        this.target("fire", half, Math.ceil(h / 2));
        for (const name of ["bright", "across", "halo", "glare"]) this.target(name, quarter, Math.ceil(h / 4));
        for (const old of [this.colourBuffer, this.depthBuffer]) if (old) gl.deleteRenderbuffer(old);
        for (const old of [this.many, this.depthFrame]) if (old) gl.deleteFramebuffer(old);
        if (this.depth) gl.deleteTexture(this.depth);
        const samples = Math.min(4, gl.getParameter(gl.MAX_SAMPLES));
        this.colourBuffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.colourBuffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, gl.RGBA16F, w, h);
        this.depthBuffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.depthBuffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, gl.DEPTH_COMPONENT24, w, h);
        this.many = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, this.colourBuffer);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.depthBuffer);
        this.depth = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, this.depth);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, w, h);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
        this.depthFrame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.depthFrame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    }

    // ---- a run and its frames

    /** @param room what the server says of light, ground and sheets */
    setRoom(room, pictures) {
        const { gl } = this;
        for (const { texture } of this.pictures) if (texture !== this.white) gl.deleteTexture(texture);
        for (const { array } of this.solids.values()) gl.deleteVertexArray(array);
        this.solids.clear();
        this.room = room;
        this.frame = null;
        this.cells = null;
        this.pictures = room.sheets.map((sheet, i) => ({
            ...sheet, texture: pictures[i] ? this.texture2d(pictures[i].width, pictures[i].height, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, pictures[i].rgba, true) : this.white,
        }));
    }

    show(frame) {
        const { gl, sheets } = this;
        this.frame = frame;
        gl.bindVertexArray(sheets.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, sheets.vertices);
        gl.bufferData(gl.ARRAY_BUFFER, frame.vertices, gl.STREAM_DRAW);
        FIELDS.forEach(([name, size, type, at], i) => {
            gl.enableVertexAttribArray(i);
            gl.vertexAttribPointer(i, size, gl[type], type !== "FLOAT" && name !== "sheet", VERTEX_BYTES, at);
        });
        gl.disableVertexAttribArray(GAP);
        sheets.contactOf = null;
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, sheets.triangles);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, frame.triangles, gl.STREAM_DRAW);
        gl.bindVertexArray(null);

        // the triangles of each sheet follow each other
        sheets.runs = [];
        const { triangles, vertices } = frame, sheetOf = (t) => vertices[VERTEX_BYTES * triangles[t] + 15];
        for (let t = 0, last = -1; t < triangles.length; t += 3) {
            const sheet = sheetOf(t);
            if (sheet !== last) sheets.runs.push({ sheet, first: t, count: 0 });
            sheets.runs[sheets.runs.length - 1].count += 3;
            last = sheet;
        }
        if (this.gas) gl.deleteTexture(this.gas);
        const gas = frame.gas && refineGas(frame.gas.size, frame.gas.cells);
        this.gas = gas && this.texture3d(...gas.size, gas.cells, gl.CLAMP_TO_EDGE);
    }

    /** The matrix of a camera {eye, target, up, fov}, which sees the whole of the scene's picture. */
    matrices({ eye, target, up, fov }) {
        const aspect = this.canvas.width / this.canvas.height, wanted = this.room ? this.room.width / this.room.height : aspect;
        const angle = aspect < wanted ? 2 * Math.atan((Math.tan(fov / 2) * wanted) / aspect) : fov, far = length(add(eye, target, -1));
        const frame = this.frame, spread = frame ? length(add(frame.high, frame.low, -1)) : 1;
        return multiply(perspective(angle, aspect, Math.max(0.004 * far, 1e-4), 40 * far + 4 * spread), lookAt(eye, target, up));
    }

    sunView() {
        const { frame, room } = this;
        let low = frame.low, high = frame.high;
        for (const { position, half, radius, height, kind } of frame.shapes) {
            const r = kind === 2 ? length(half) : kind === 1 || kind === 3 ? radius + height / 2 : 0;
            low = low.map((x, c) => Math.min(x, position[c] - r));
            high = high.map((x, c) => Math.max(x, position[c] + r));
        }
        const middle = add(low, high).map((x) => x / 2), size = length(add(high, low, -1)) + 0.02;
        const up = Math.abs(room.towards[2]) > 0.95 ? [0, 1, 0] : [0, 0, 1];
        return { matrix: multiply(orthographic(1.1 * size, 1.1 * size, 0, 4 * size), lookAt(add(middle, room.towards, 2 * size), middle, up)), size: 1.1 * size };
    }

    draw(camera) {
        const { gl, frame, room } = this;
        if (!frame || !room) return;
        const matrix = this.matrices(camera), sun = this.sunView(), paper = this.layer === "paper", reach = 9 * length(add(room.eye, room.target, -1));
        const places = new Float32Array(4 * LIGHTS), strengths = new Float32Array(4 * LIGHTS);
        for (let k = 0; k < frame.lightCount; k++) {
            places.set(frame.lights.subarray(8 * k, 8 * k + 4), 4 * k);
            strengths.set(frame.lights.subarray(8 * k + 4, 8 * k + 7), 4 * k);
        }
        const soft = Math.min(Math.max((Math.tan(room.sun_angle) * 0.10) / sun.size, 1.2 / SHADOW), 0.02);
        const shared = {
            viewProjection: matrix, eye: camera.eye, noiseMap: this.noise, sliceMap: this.slices, glowMap: this.glow, time: frame.time % 1000, sunTo: room.towards, sunLight: room.sun,
            ambient: room.ambient, lampView: sun.matrix, shadowMap: this.shadowMap, soft, lampPlace: places, lampStrength: strengths, lampCount: frame.lightCount,
            groundColour: room.ground_colour, background: room.background, reach, stone: room.ground === 1 ? 1 : 0,
        };

        if (this.layer === "contact") this.findContact();
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
        gl.enable(gl.DEPTH_TEST);
        if (paper && this.shadowOf !== frame) { // a turned view has the same shadows
            this.shadowOf = frame;
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
            gl.viewport(0, 0, SHADOW, SHADOW);
            gl.clear(gl.DEPTH_BUFFER_BIT);
            const cast = { ...shared, viewProjection: sun.matrix, shadowMap: null };
            this.drawSheets("caster", cast);
            this.drawShapes(cast);
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
        gl.viewport(0, 0, this.canvas.width, this.canvas.height);
        const back = paper ? room.background : [0.062, 0.056, 0.052];
        gl.clearColor(back[0], back[1], back[2], 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        if (this.layer === "strands") gl.enable(gl.POLYGON_OFFSET_FILL); // the springs stand out of the sheet
        gl.polygonOffset(4, 4);
        this.drawSheets(paper ? "paper" : "field", shared);
        gl.disable(gl.POLYGON_OFFSET_FILL);
        this.drawShapes(shared);
        if (room.ground_height !== null) {
            const s = 3 * reach;
            this.use(this.programs[!paper ? "grid" : room.ground === 0 ? "wood" : "plain"], { ...shared, modelMatrix: placed([camera.target[0], camera.target[1], room.ground_height - 1e-4], [0, 0, 0, 1], [s, s, 1]) });
            this.drawMesh(this.quad);
        }
        if (room.wall_distance !== null && paper) this.drawWall({ ...shared, reach }, 3 * reach);

        if (paper && this.fire) this.flying.draw(this, shared);
        if (this.layer === "gas" && frame.gas) this.drawSlice(camera, matrix);
        if (this.layer === "strands" && this.cells) this.drawStrands(camera, matrix);

        const { scene } = this.targets;
        const copy = (to, bits) => {
            gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.many);
            gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
            gl.blitFramebuffer(0, 0, scene.width, scene.height, 0, 0, scene.width, scene.height, bits, gl.NEAREST);
        };
        copy(scene.frame, gl.COLOR_BUFFER_BIT);
        gl.disable(gl.DEPTH_TEST);
        if (!paper) {
            this.pass("copy", null, { map: scene.texture });
            return;
        }
        copy(this.depthFrame, gl.DEPTH_BUFFER_BIT);
        this.drawFire(camera, matrix, shared);
        const { fire, bright, across, halo, glare } = this.targets, seen = { sceneMap: scene.texture, fireMap2: fire.texture, exposure: room.exposure };
        this.pass("bright", bright, { ...seen, pixel: [1 / scene.width, 1 / scene.height] });
        for (const [to, sigma] of [[halo, 0.005], [glare, 0.022]]) {
            const wide = Math.max((sigma * scene.height) / 4, 0.5);
            this.pass("blur", across, { map: bright.texture, along: [1 / bright.width, 0], sigma: wide });
            this.pass("blur", to, { map: across.texture, along: [0, 1 / bright.height], sigma: wide });
        }
        this.pass("film", null, { ...seen, halo: halo.texture, glare: glare.texture, vignette: 0, resolution: [scene.width, scene.height] });
    }

    /** An upright plane across the look, `this.slice` of the way through the gas. */
    drawSlice({ eye, target, up }, viewProjection) {
        const { gl } = this, { size, cell, corner } = this.frame.gas, span = size.map((n) => n * cell), middle = add(corner, span, 0.5);
        const level = (v) => unit(add(v, up, -dot(v, up))), ahead = level(add(target, eye, -1)), right = cross(ahead, up);
        const reach = (axis) => axis.reduce((sum, a, c) => sum + 0.5 * span[c] * Math.abs(a), 0);
        const centre = add(middle, ahead, (2 * this.slice - 1) * reach(ahead)), columns = [[right, reach(right)], [up, reach(up)], [ahead, 1]];
        gl.enable(gl.BLEND);
        gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
        gl.depthMask(false);
        const modelMatrix = Float32Array.from([...columns.flatMap(([axis, s]) => [...axis.map((a) => a * s), 0]), ...centre, 1]);
        this.use(this.programs.slice, { viewProjection, modelMatrix, fireMap: this.gas, colours: this.ramps.gas, origin: corner, span });
        this.drawMesh(this.quad);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }

    /** @param cells of readCells: the sheets at rest */
    setCells(cells) {
        const { gl } = this, table = (inner, format, type, values) => {
            const rows = Math.max(Math.ceil(values.length / 4 / TABLE), 1), whole = new values.constructor(4 * TABLE * rows);
            whole.set(values);
            const texture = this.texture2d(TABLE, rows, inner, format, type, whole);
            for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
            return texture;
        };
        const bars = cells.ends.map((ends) => {
            const array = gl.createVertexArray(), place = gl.getAttribLocation(this.programs.strand.program, "ends");
            gl.bindVertexArray(array);
            gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
            gl.bufferData(gl.ARRAY_BUFFER, ends, gl.STATIC_DRAW);
            gl.enableVertexAttribArray(place);
            gl.vertexAttribIPointer(place, 2, gl.UNSIGNED_INT, 8, 0);
            gl.vertexAttribDivisor(place, 1);
            gl.bindVertexArray(null);
            return { array, count: ends.length / 2 };
        });
        this.cells = { cells, bars, map: table(gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, cells.cells), table };
    }

    drawStrands(camera, viewProjection) {
        const { gl, cells: { cells, bars, map, table }, canvas } = this, places = table(gl.RGBA32F, gl.RGBA, gl.FLOAT, placesOf(cells, this.frame));
        bars.forEach(({ array, count }, colour) => {
            const tint = hex(COLOURS[colour][0]).map((part) => part / 255);
            this.use(this.programs.strand, {
                places, cellMap: map, vertexCount: cells.vertexCount, viewProjection, eye: camera.eye, resolution: [canvas.width, canvas.height], thick: (1.7 * canvas.width) / canvas.clientWidth, tint,
            });
            gl.bindVertexArray(array);
            gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
        });
        gl.bindVertexArray(null);
        gl.deleteTexture(places);
    }

    /** Gives the card how near the frame's vertices come to something. */
    findContact() {
        const { gl, frame, room, sheets } = this;
        if (sheets.contactOf === frame) return;
        sheets.contactOf = frame;
        const solids = frame.shapes.flatMap((shape, i) => {
            const solid = this.solids.get(this.solidKey(i)), pose = placed(shape.position, shape.rotation, [1, 1, 1]);
            if (!shape.solid || !solid) return [];
            const positions = new Float32Array(solid.points.length);
            for (let k = 0; k < positions.length; k += 3) positions.set(apply(pose, solid.points.subarray(k, k + 3)), k);
            return [{ positions, triangles: solid.triangles }];
        });
        gl.bindVertexArray(sheets.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, sheets.gaps);
        frame.gaps ??= gapsOf(frame, room.ground_height, solids);
        gl.bufferData(gl.ARRAY_BUFFER, frame.gaps, gl.STREAM_DRAW);
        gl.enableVertexAttribArray(GAP);
        gl.vertexAttribPointer(GAP, 1, gl.UNSIGNED_BYTE, true, 1, 0);
        gl.bindVertexArray(null);
    }

    drawSheets(program, shared) {
        const { gl, sheets } = this, layer = LAYERS[this.layer === "gas" ? "char" : this.layer];
        for (const { sheet, first, count } of sheets.runs) {
            const look = this.pictures[sheet] ?? { texture: this.white, colour: [1, 1, 1], transmittance: 0.19 };
            const more = program !== "field" ? { printMap: look.texture, tint: look.colour, transmittance: look.transmittance }
                : { colours: this.ramps[this.layer === "gas" ? "char" : this.layer], range: [layer.index, layer.low, layer.high] };
            this.use(this.programs[program], { ...shared, ...more });
            gl.bindVertexArray(sheets.array);
            gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * first);
        }
    }

    drawShapes(shared) {
        const capsule = (shape) => {
            const key = `capsule ${shape.height / shape.radius}`;
            if (!this.solids.has(key)) this.solids.set(key, this.mesh(...sphere(shape.height / 2 / shape.radius)));
            return this.solids.get(key);
        };
        this.frame.shapes.forEach((shape, i) => {
            const mesh = shape.kind === 3 ? capsule(shape) : shape.solid ? this.solids.get(this.solidKey(i)) : this.kinds[shape.kind];
            if (!mesh) return;
            const size = shape.kind === 2 ? shape.half : shape.kind === 1 || shape.kind === 3 ? [shape.radius, shape.radius, shape.radius] : [1, 1, 1];
            const turn = shape.kind === 1 ? [0, 0, 0, 1] : shape.rotation;
            this.use(this.programs.shape, { ...shared, modelMatrix: placed(shape.position, turn, size), albedo: shape.colour, kelvin: this.layer === "paper" ? shape.temperature : 0 });
            this.drawMesh(mesh);
        });
    }

    solidKey(i) { return this.frame.shapes[i].solid === 2 ? `${this.frame.time} ${i}` : `${i}`; }

    /** The triangles of a shape that is a mesh, with flat normals where edges are sharp. */
    addSolid(i, buffer) {
        this.shadowOf = null;
        const [vertices, triangles] = new Uint32Array(buffer, 0, 2), p = new Float32Array(buffer, 8, 3 * vertices), index = new Uint32Array(buffer, 8 + 12 * vertices, 3 * triangles);
        const at = (k) => [p[3 * k], p[3 * k + 1], p[3 * k + 2]], sums = new Float32Array(3 * vertices), flat = [];
        for (let t = 0; t < index.length; t += 3) {
            const a = at(index[t]), n = cross(add(at(index[t + 1]), a, -1), add(at(index[t + 2]), a, -1));
            flat.push(n);
            for (let k = 0; k < 3; k++) for (let c = 0; c < 3; c++) sums[3 * index[t + k] + c] += n[c];
        }
        const values = [];
        for (let t = 0; t < index.length; t++) {
            const v = index[t], face = unit(flat[Math.floor(t / 3)]), smooth = unit([sums[3 * v], sums[3 * v + 1], sums[3 * v + 2]]);
            values.push(...at(v), ...(dot(face, smooth) > 0.75 ? smooth : face));
        }
        this.solids.set(this.solidKey(i), { ...this.mesh(values, Uint32Array.from({ length: index.length }, (_, k) => k)), points: p, triangles: index });
    }

    /** The wall behind the scene, `size` m from its middle to its sides. */
    drawWall(shared, size) {
        const { room } = this, turn = room.wall_turn, along = [Math.cos(turn), Math.sin(turn), 0], away = [-along[1], along[0], 0];
        const middle = dot(room.target, along), half = [Math.sin(turn / 2) * Math.SQRT1_2, Math.cos(turn / 2) * Math.SQRT1_2];
        const place = [0, 1, 2].map((k) => room.wall_distance * away[k] + middle * along[k] + (k === 2 ? room.target[2] : 0));
        const modelMatrix = placed(place, [half[1], half[0], half[0], half[1]], [size, size, 1]); // upright, then turned
        this.use(this.programs.wall, {
            ...shared, modelMatrix, wallColour: room.wall_colour, wallAlong: along, bricks: [0, 1, -1][room.wall],
            floorHeight: room.ground_height ?? -1e4,
        });
        this.drawMesh(this.quad);
    }

    drawMesh({ array, count }) {
        this.gl.bindVertexArray(array);
        this.gl.drawElements(this.gl.TRIANGLES, count, this.gl.UNSIGNED_INT, 0);
    }

    drawFire(camera, matrix, shared) {
        const { gl, frame, room } = this, { gas } = frame, { fire } = this.targets;
        if (!gas || !this.fire) {
            gl.bindFramebuffer(gl.FRAMEBUFFER, fire.frame);
            gl.clearColor(0, 0, 0, 1);
            gl.clear(gl.COLOR_BUFFER_BIT);
            return;
        }
        const span = gas.size.map((n) => n * gas.cell), lights = new Float32Array(24), ahead = unit(add(camera.target, camera.eye, -1));
        for (let k = 0; k < Math.min(6, frame.lightCount); k++) {
            const l = frame.lights.subarray(8 * k, 8 * k + 8);
            lights.set([l[0], l[1], l[2], l[4]], 4 * k);
        }
        // as fire_light_smoke has it
        const behind = 0.28 + 0.3 * Math.max(dot(room.towards, ahead), 0) ** 2;
        const daylight = room.sun.map((x, c) => behind * x + 0.282095 * room.ambient[c] + 0.630784 * room.ambient[18 + c]);
        this.pass("fire", fire, {
            ...shared, fireMap: this.gas, depthMap: this.depth, inverse_: invert(matrix), low: gas.corner, high: add(gas.corner, span), origin: gas.corner, span,
            match_: [0, 0, 0], matchOn: 0, fireScale: Math.min(Math.max(gas.cell / LOOK.FIRE_SCALE_CELL, 1), 3), fireLights: lights, fireDaylight: daylight,
        });
    }

    pass(program, to, values) {
        const { gl } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, to ? to.frame : null);
        gl.viewport(0, 0, to ? to.width : this.canvas.width, to ? to.height : this.canvas.height);
        this.use(this.programs[program], values);
        this.drawMesh(this.quad);
    }

    /** Where a point is on the canvas, in its own pixels, or null behind the camera. */
    project(camera, p) {
        const m = this.matrices(camera), w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
        if (w <= 0) return null;
        const q = apply(m, p);
        return [(q[0] * 0.5 + 0.5) * this.canvas.clientWidth, (0.5 - q[1] * 0.5) * this.canvas.clientHeight];
    }

    ray(camera, x, y) {
        const back = invert(this.matrices(camera)), at = [(2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight];
        return { origin: camera.eye, direction: unit(add(apply(back, [at[0], at[1], 0.5]), camera.eye, -1)) };
    }
}

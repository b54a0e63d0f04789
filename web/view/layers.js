// The layers: fields of the sheets by colour, springs and gas, their GLSL, and what stands under their colours.
import { REACH } from "./contact.js";
import { LOOK } from "./look.js";
import { COLOURS } from "./strands.js";

export const TABLE = 1024; // texels of a row of a table

/** One field by colour, shaded a little so that folds are seen. */
export const FIELD = /* glsl */ `precision highp float;
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
export const FIELD_GROUND = /* glsl */ `precision highp float;
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
export const STRAND_VERTEX = /* glsl */ `
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
export const STRAND = /* glsl */ `precision highp float;
uniform vec3 tint;
out vec4 colour;
void main() { colour = vec4(tint, 1.0); }`;
/** The gas in a plane: the share that burns by colour, smoke in grey, a border around the cells. */
export const SLICE = /* glsl */ `precision highp float;
precision highp sampler3D;
in vec3 vPosition;
uniform sampler3D fireMap;
uniform sampler2D colours;
uniform vec3 origin, span;
out vec4 colour;
void main() {
    vec3 at = (vPosition - origin) / span, off = abs(at - 0.5), wide = fwidth(at);
    if (any(greaterThan(off, vec3(0.5)))) discard;
    vec4 c = texture(fireMap, at) * vec4(${LOOK.FLAME_MOST.toFixed(1)}, vec3(1.0));
    float burning = smoothstep(0.01, 0.12, c.r), grey = 0.85 * (1.0 - exp(-2.5 * c.b)), rim = any(greaterThan(off, 0.5 - 1.5 * wide)) ? 0.5 : 0.0;
    vec3 smoke = vec3(0.42, 0.40, 0.39);
    colour = vec4(mix(smoke, texture(colours, vec2(c.r, 0.5)).rgb, burning), max(max(burning, grey), max(rim, 0.10)));
}`;

export const hex = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
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
export function ramp({ stops }) {
    const bytes = new Uint8Array(1024), colours = stops.map(hex);
    for (let i = 0; i < 256; i++) {
        const x = (i / 255) * (colours.length - 1), k = Math.min(Math.floor(x), colours.length - 2);
        for (let c = 0; c < 3; c++) bytes[4 * i + c] = colours[k][c] + (x - k) * (colours[k + 1][c] - colours[k][c]);
        bytes[4 * i + 3] = 255;
    }
    return bytes;
}

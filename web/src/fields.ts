// From the library's surface to what the shaders read: the fields of program/preview/mesh_in.c.
import type { Surface } from "singe";
import { airborneOf } from "../view/airborne.js";
import { LOOK } from "../view/look.js";

/** Interleaved, FLOATS for each vertex; the shaders' attributes in this order. */
export const ATTRIBUTES = [
    ["position", 3], ["normal", 3], ["rest", 3], ["uv", 2], ["heat", 4], ["look", 4], ["leaf", 3],
] as const;
export const FLOATS = 22;

export interface Mesh { vertices: Float32Array; triangles: Uint32Array; burning: number }

const clamp = (x: number, low: number, high: number) => (x < low ? low : x > high ? high : x);
const step = (a: number, b: number, x: number) => {
    const t = clamp((x - a) / (b - a), 0, 1);
    return t * t * (3 - 2 * t);
};

/**
 * heat: temperature, its peak (K), burn rate and the part of it that is char glowing (1/s); look: burnt share as it looks, its gradient
 * (1/m), nearness of a border, age (s of fire); leaf: size of the triangles around (m), the rate of char that feeds a flame,
 * and the gradient of the peak (K/m). Gradients are area-weighted means of the triangles', a border is
 * where the angles around a vertex fall short of a full turn.
 */
export function meshOf(surface: Surface, time: number, pace: number): Mesh {
    const count = surface.vertex_count, out = new Float32Array(FLOATS * count), { triangles } = surface;
    const slope = new Float32Array(6 * count), area = new Float32Array(count), angle = new Float32Array(count), around = new Float32Array(count);
    let burning = 0;
    for (let i = 0; i < count; i++) {
        const at = FLOATS * i, mass = surface.mass[i]!, charred = clamp(surface.char_fraction[i]!, 0, 1), ash = clamp(surface.ash_fraction[i]!, 0, 1);
        const fuel = clamp(mass - charred - ash, 0, 1), rate = Math.max(surface.burn_rate[i]!, 0);
        let burn = clamp(surface.burn[i]!, 0, 1);
        if (charred > 0) {
            const q = charred / (charred + 2 * ash);
            burn += (LOOK.CHAR_LEAF * (1 - fuel) - burn) * q;
        }
        for (let c = 0; c < 3; c++) {
            out[at + c] = surface.position[3 * i + c]!;
            out[at + 3 + c] = surface.normal[3 * i + c]!;
            out[at + 6 + c] = surface.rest_position[3 * i + c]!;
        }
        out[at + 9] = surface.uv[2 * i]!;
        out[at + 10] = surface.uv[2 * i + 1]!;
        out[at + 11] = surface.temperature[i]!;
        out[at + 12] = Math.max(surface.temperature_peak[i]!, surface.temperature[i]!);
        out[at + 13] = rate;
        out[at + 14] = fuel > 0.01 ? 0 : rate;
        out[at + 15] = burn;
        const ignited = surface.time_ignited[i]!;
        out[at + 18] = ignited >= 0 ? (time - ignited) * pace : burn > 0 ? 60 : 0;
        out[at + 20] = charred > 0 && fuel > 0.01 ? rate : 0;
        if (rate > 0.02) burning++;
    }

    // of 20,000 triangles a frame, so without arrays
    for (let t = 0; t < triangles.length; t += 3) {
        const a = triangles[t]!, b = triangles[t + 1]!, c = triangles[t + 2]!, pa = FLOATS * a, pb = FLOATS * b, pc = FLOATS * c;
        const ex = out[pb + 6]! - out[pa + 6]!, ey = out[pb + 7]! - out[pa + 7]!, ez = out[pb + 8]! - out[pa + 8]!;
        const fx = out[pc + 6]! - out[pa + 6]!, fy = out[pc + 7]! - out[pa + 7]!, fz = out[pc + 8]! - out[pa + 8]!;
        const nx = ey * fz - ez * fy, ny = ez * fx - ex * fz, nz = ex * fy - ey * fx, n2 = nx * nx + ny * ny + nz * nz;
        if (!(n2 > 1e-24)) continue;
        const n = Math.sqrt(n2), half = 0.5 * n, w = half / n2;
        const burn1 = w * (out[pb + 15]! - out[pa + 15]!), burn2 = w * (out[pc + 15]! - out[pa + 15]!);
        const peak1 = w * (out[pb + 12]! - out[pa + 12]!), peak2 = w * (out[pc + 12]! - out[pa + 12]!);
        // rotated by a quarter in the triangle's plane
        const ax = fy * nz - fz * ny, ay = fz * nx - fx * nz, az = fx * ny - fy * nx, bx = ny * ez - nz * ey, by = nz * ex - nx * ez, bz = nx * ey - ny * ex;
        const gx = burn1 * ax + burn2 * bx, gy = burn1 * ay + burn2 * by, gz = burn1 * az + burn2 * bz;
        const hx = peak1 * ax + peak2 * bx, hy = peak1 * ay + peak2 * by, hz = peak1 * az + peak2 * bz;
        const aa = ex * ex + ey * ey + ez * ez, cc = fx * fx + fy * fy + fz * fz, ac = ex * fx + ey * fy + ez * fz;
        for (let k = 0; k < 3; k++) {
            const v = k === 0 ? a : k === 1 ? b : c, g = 6 * v;
            slope[g]! += gx;
            slope[g + 1]! += gy;
            slope[g + 2]! += gz;
            slope[g + 3]! += hx;
            slope[g + 4]! += hy;
            slope[g + 5]! += hz;
            area[v]! += half;
            angle[v]! += Math.atan2(n, k === 0 ? ac : k === 1 ? aa - ac : cc - ac); // of the corner
            around[v]! += 1;
        }
    }
    for (let i = 0; i < count; i++) {
        const size = area[i]!;
        const long = (g: number) => Math.sqrt(slope[g]! ** 2 + slope[g + 1]! ** 2 + slope[g + 2]! ** 2);
        out[FLOATS * i + 16] = size > 0 ? long(6 * i) / size : 0;
        out[FLOATS * i + 21] = size > 0 ? long(6 * i + 3) / size : 0;
        out[FLOATS * i + 19] = size > 0 ? Math.sqrt((2 * size) / around[i]!) : 0; // a triangle of area A has edges of about sqrt(2 A)
        out[FLOATS * i + 17] = 1 - step(1.6 * Math.PI, 1.95 * Math.PI, angle[i]!);
    }
    return { vertices: out, triangles: triangles.slice(), burning };
}

/** Of a vertex, what airborne.js asks for, in its order. */
const AIRBORNE = [0, 1, 2, 6, 7, 8, 11, 13, 14, 15, 16, 20];

/** Sparks and flakes in the air. */
export const airborneAt = ({ vertices, triangles }: Mesh, time: number): Float32Array =>
    airborneOf(triangles, (vertex: number, field: number) => vertices[FLOATS * vertex + AIRBORNE[field]!]!, time);

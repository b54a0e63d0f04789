// From the library's surface and gas to what the shaders read: the fields of program/preview/mesh_in.c and fire.c.
import type { Gas, Surface } from "singe";
import { airborneOf } from "../view/airborne.js";
import { flameScale, refineGas, spreadHeight } from "../view/gas.js";
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

// ---- the fire

const FLAME_LOW = LOOK.FLAME_LOW, FLAME_END = LOOK.FLAME_END, FLAME_RANGE = Math.log(LOOK.FLAME_HIGH / FLAME_LOW);
const EXTINCTION = 8700; // m2/kg of soot
const LIGHTS = 6;

export interface Fire {
    size: [number, number, number]; origin: [number, number, number]; cell: number;
    /** of flames, 1 over cells of 8 to 10 mm (fire.h) */
    scale: number;
    /** four bytes a cell: flame, height in FLAME_END times scale, smoke in 20 1/m, the gradient of flame once it is refined */
    cells: Uint8Array;
    /** box of what is not empty, m; null if nothing is */
    bounds: { low: [number, number, number]; high: [number, number, number] } | null;
}

/** x, y, z and strength of each light. */
export type Lights = Float32Array;

export function fireOf(gas: Gas, surface: Surface): Fire {
    const [nx, ny, nz] = gas.size, count = nx * ny * nz, flame = new Float32Array(count), rise = new Float32Array(count);
    const thin = Math.max(gas.cell / LOOK.FLAME_THICK, 1), scale = flameScale(gas.cell);
    const rootRate = new Float32Array(count), rootHeight = new Float32Array(count), cells = new Uint8Array(4 * count);
    const index = (x: number, y: number, z: number) => x + nx * (y + ny * z);

    for (let i = 0; i < surface.vertex_count; i++) {
        const rate = surface.burn_rate[i]!;
        if (rate < 0.02 || surface.mass[i]! - surface.char_fraction[i]! - surface.ash_fraction[i]! < 0.01) continue;
        const [x, y, z] = [0, 1, 2].map((c) => Math.floor((surface.position[3 * i + c]! - gas.origin[c]!) / gas.cell)) as [number, number, number];
        if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) continue;
        rootRate[index(x, y, z)]! += rate;
        rootHeight[index(x, y, z)]! += rate * surface.position[3 * i + 2]!;
    }

    // height times flame, layer by layer: where the gas came from, at (x - vx/vz, y - vy/vz) below; over paper mostly its
    // own height. Up a hanging sheet gas that has burnt for a while passes what begins to.
    const fading = gas.cell / (FLAME_RANGE * Math.sqrt(gas.cell / (2 * 9.81))); // m/s: what flames lose as they rise by a cell
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const below = (of: Float32Array, x: number, y: number, z: number): number => {
        const ix = Math.floor(x), iy = Math.floor(y), fx = x - ix, fy = y - iy;
        const one = (u: number, v: number) => (u < 0 || v < 0 || u >= nx || v >= ny ? 0 : of[index(u, v, z)]!);
        return (one(ix, iy) * (1 - fx) + one(ix + 1, iy) * fx) * (1 - fy) + (one(ix, iy + 1) * (1 - fx) + one(ix + 1, iy + 1) * fx) * fy;
    };
    // where the layer below has flames: none comes from elsewhere, as it goes aside by a cell at most
    let fromX = nx, toX = -1, fromY = ny, toY = -1;
    for (let z = 0, i = 0; z < nz; z++) {
        const [lowX, highX, lowY, highY] = [fromX - 2, toX + 2, fromY - 2, toY + 2];
        [fromX, toX, fromY, toY] = [nx, -1, ny, -1];
        for (let y = 0; y < ny; y++)
            for (let x = 0; x < nx; x++, i++) {
                const power = thin * gas.flame[i]!, smoke = Math.max(gas.smoke[i]!, 0) * EXTINCTION, up = Math.max(gas.velocity[3 * i + 2]!, 0.1);
                const atX = x - clamp(gas.velocity[3 * i]! / up, -1, 1), atY = y - clamp(gas.velocity[3 * i + 1]! / up, -1, 1);
                const near = x >= lowX && x <= highX && y >= lowY && y <= highY, fed = near ? below(flame, atX, atY, z - 1) : 0;
                let f = Math.max(power > FLAME_LOW ? Math.min(Math.log(power / FLAME_LOW) / FLAME_RANGE, 1) : 0, fed - fading / up), r = 0;
                if (f > 0) {
                    const above = z + 1 < nz ? i + nx * ny : i, root = rootRate[i]! > 0 ? i : above;
                    if (fed > 0) r = Math.min((2 * fed) / f, 1) * (below(rise, atX, atY, z - 1) / fed + gas.cell);
                    if (rootRate[root]! > 0) {
                        const height = Math.max(gas.origin[2] + (z + 0.5) * gas.cell - rootHeight[root]! / rootRate[root]!, -gas.cell);
                        r = height + (r - height) * (fed > 0 ? LOOK.FIRE_PASSING : 0);
                    }
                    flame[i] = f;
                    rise[i] = f * r;
                    fromX = Math.min(fromX, x);
                    toX = Math.max(toX, x);
                    fromY = Math.min(fromY, y);
                    toY = Math.max(toY, y);
                    f *= 1 - step(0.6 * FLAME_END, FLAME_END, r / scale);
                }
                cells[4 * i] = 255 * f;
                cells[4 * i + 1] = 255 * clamp(r / (FLAME_END * scale), 0, 1);
                cells[4 * i + 2] = clamp((255 * smoke) / 20, 0, 255);
                if (f > LOOK.FLAME_SEEN || smoke > 0.15) {
                    const at = [x, y, z];
                    for (let c = 0; c < 3; c++) {
                        low[c] = Math.min(low[c]!, at[c]!);
                        high[c] = Math.max(high[c]!, at[c]! + 1);
                    }
                }
            }
    }
    spreadHeight(gas.size, cells, 1 + Math.floor((scale * LOOK.FIRE_SWAY) / gas.cell), (255 * gas.cell) / (FLAME_END * scale));
    const place = (at: number[], more: number) => at.map((x, c) => gas.origin[c]! + (x + more) * gas.cell) as [number, number, number];
    return { size: gas.size, origin: gas.origin, cell: gas.cell, scale, cells, bounds: low[0]! < high[0]! ? { low: place(low, -1), high: place(high, 1) } : null };
}

/** Smaller cells, as the shader reads them. */
export function refined(fire: Fire): Fire {
    const { size, cells } = refineGas(fire.size, fire.cells);
    return { ...fire, size, cells, cell: (fire.cell * fire.size[0]) / size[0] };
}

/** The light of flames, or without gas that of what burns, gathered into the strongest cells of a coarse grid. */
export function lightsOf(fire: Fire | null, mesh: Mesh): Lights {
    const clusters = new Map<number, [number, number, number, number]>();
    const add = (x: number, y: number, z: number, weight: number) => {
        const key = Math.floor(x / 0.06 + 500) * 1e6 + Math.floor(y / 0.06 + 500) * 1e3 + Math.floor(z / 0.09 + 500);
        const sum = clusters.get(key) ?? [0, 0, 0, 0];
        sum[0] += weight * x;
        sum[1] += weight * y;
        sum[2] += weight * z;
        sum[3] += weight;
        clusters.set(key, sum);
    };
    if (fire?.bounds) {
        const [nx, ny, nz] = fire.size, volume = (fire.cell / 0.0087) ** 3;
        for (let z = 0, i = 0; z < nz; z++)
            for (let y = 0; y < ny; y++)
                for (let x = 0; x < nx; x++, i++) {
                    const f = fire.cells[4 * i]! / 255;
                    if (f < LOOK.FLAME_SEEN) continue;
                    const burns = 1 / (1 + 40 * Math.exp(-FLAME_RANGE * f)); // q / (q + 40 FLAME_LOW)
                    add(fire.origin[0] + (x + 0.5) * fire.cell, fire.origin[1] + (y + 0.5) * fire.cell, fire.origin[2] + (z + 0.5) * fire.cell, burns * volume);
                }
    } else {
        for (let i = 0; i < mesh.vertices.length; i += FLOATS) {
            const rate = mesh.vertices[i + 13]!;
            if (rate > 0.05) add(mesh.vertices[i]!, mesh.vertices[i + 1]!, mesh.vertices[i + 2]! + 0.02, 0.05 * Math.min(rate, 2));
        }
    }
    const sorted = [...clusters.values()].sort((a, b) => b[3] - a[3]), total = sorted.reduce((sum, one) => sum + one[3], 0);
    const kept = sorted.slice(0, LIGHTS), part = kept.reduce((sum, one) => sum + one[3], 0), out = new Float32Array(4 * LIGHTS);
    kept.forEach(([x, y, z, weight], i) => out.set([x / weight, y / weight, z / weight, (weight * total) / part], 4 * i));
    return out;
}

// From the library's gas to what the shaders read: the fields of program/preview/fire.c, and the light that flames cast.
import type { Gas, Surface } from "singe";
import { flameScale, refineGas, spreadHeight } from "../view/gas.js";
import { LOOK } from "../view/look.js";
import { fed } from "./feed.js";
import { FLOATS, type Mesh } from "./fields.js";

const FLAME_LOW = LOOK.FLAME_LOW, FLAME_END = LOOK.FLAME_END, FLAME_RANGE = Math.log(LOOK.FLAME_HIGH / FLAME_LOW);
const EXTINCTION = 8700; // m2/kg of soot
const LIGHTS = 6;

export interface Fire {
    size: [number, number, number]; origin: [number, number, number]; cell: number;
    /** of flames, 1 over cells of 8 to 10 mm (fire.h) */
    scale: number;
    /** four bytes a cell: flame in FLAME_MOST, height in FLAME_END times scale, smoke in 20 1/m, the gradient of flame once it is refined */
    cells: Uint8Array;
    /** what burns in each cell, whatever eddies do, until the next fire is made; none once it is refined */
    burns: Float32Array;
    /** how far aside of flames that stand on what burns, m (fire_feet.c), as long */
    apart: Float32Array;
    /** box of what is not empty, m; null if nothing is */
    bounds: { low: [number, number, number]; high: [number, number, number] } | null;
}

/** x, y, z and strength of each light. */
export type Lights = Float32Array;

const clamp = (x: number, low: number, high: number) => (x < low ? low : x > high ? high : x);
const step = (a: number, b: number, x: number) => {
    const t = clamp((x - a) / (b - a), 0, 1);
    return t * t * (3 - 2 * t);
};

const kept = new Map<string, Float32Array>();

/** Zeros, in the same room each time. */
function zeros(name: string, count: number): Float32Array {
    const room = kept.get(name), numbers = room?.length === count ? room.fill(0) : new Float32Array(count);
    kept.set(name, numbers);
    return numbers;
}

/** The rate at which paper burns around each cell, and the mean place times that, in cells; what is nearer counts more. */
function rootsOf(gas: Gas, surface: Surface): Float32Array {
    const { size, cell, origin } = gas, [nx, ny, nz] = size, roots = zeros("roots", 4 * nx * ny * nz), burning = new Map<number, number[]>();
    for (let i = 0; i < surface.vertex_count; i++) {
        const rate = surface.burn_rate[i]!;
        if (rate < 0.02 || surface.mass[i]! - surface.char_fraction[i]! - surface.ash_fraction[i]! < 0.01) continue;
        const at = [0, 1, 2].map((c) => (surface.position[3 * i + c]! - origin[c]!) / cell - 0.5), key = at.reduce((sum, x) => 4096 * sum + clamp(Math.round(x), -9, 4000) + 9, 0);
        const sum = burning.get(key) ?? [0, 0, 0, 0];
        burning.set(key, [sum[0]! + rate, ...at.map((x, c) => sum[c + 1]! + rate * x)]);
    }
    for (const [rate, ...sum] of burning.values()) { // what is in one cell is at one place
        const [gx, gy, gz] = sum.map((x) => x / rate!) as [number, number, number], reach = LOOK.ROOT_REACH, each = 1 / (reach * reach);
        const [low, high] = [[gx, gy, gz].map((x) => Math.max(Math.ceil(x - reach), 0)), [gx, gy, gz].map((x, c) => Math.min(Math.floor(x + reach), size[c]! - 1))];
        for (let z = low[2]!; z <= high[2]!; z++)
            for (let y = low[1]!; y <= high[1]!; y++)
                for (let x = low[0]!; x <= high[0]!; x++) {
                    const near = 1 - each * ((x - gx) * (x - gx) + (y - gy) * (y - gy) + (z - gz) * (z - gz)), near2 = near * near, near4 = near2 * near2;
                    if (near < 0.05) continue;
                    const weight = rate! * near4 * near4 * near4 * near4, at = 4 * (x + nx * (y + ny * z));
                    roots[at]! += weight;
                    roots[at + 1]! += weight * gx;
                    roots[at + 2]! += weight * gy;
                    roots[at + 3]! += weight * gz;
                }
    }
    return roots;
}

/** How far each cell is aside of flames that stand on what burns and follow the gas, m; and the flames of what burns itself (fire_feet.c). */
function feetOf({ size, cell, origin, velocity }: Gas, surface: Surface, power: Float32Array, scale: number): Float32Array {
    const [nx, ny, nz] = size, apart = zeros("apart", nx * ny * nz).fill(LOOK.NOWHERE), risen = zeros("risen", apart.length);
    const reach = LOOK.NOWHERE / cell, burning = new Map<number, number[]>();
    for (let i = 0; i < surface.vertex_count; i++) {
        const rate = surface.burn_rate[i]!;
        if (rate < LOOK.FLAMES_FROM || surface.mass[i]! - surface.char_fraction[i]! - surface.ash_fraction[i]! < 0.01) continue;
        const at = [0, 1, 2].map((c) => (surface.position[3 * i + c]! - origin[c]!) / cell - 0.5), key = at.reduce((sum, x) => 8192 * sum + clamp(Math.round(2 * x), -9, 8000) + 9, 0);
        if (rate > (burning.get(key)?.[0] ?? 0)) burning.set(key, [rate, ...at]); // in half a cell one stands for all
    }
    if (!burning.size) return apart.fill(0);
    for (const [rate, gx, gy, gz] of burning.values() as Iterable<[number, number, number, number]>) {
        const own = LOOK.RIM_FLAME * step(LOOK.RIM_LOW, LOOK.RIM_HIGH, rate), toX = Math.min(Math.floor(gx + reach), nx - 1), toY = Math.min(Math.floor(gy + reach), ny - 1);
        for (let z = Math.max(Math.ceil(gz) - 2, 0); z <= Math.min(Math.floor(gz + 1), nz - 1); z++)
            for (let y = Math.max(Math.ceil(gy - reach), 0); y <= toY; y++)
                for (let x = Math.max(Math.ceil(gx - reach), 0); x <= toX; x++) {
                    const i = x + nx * (y + ny * z), aside = (x - gx) * (x - gx) + (y - gy) * (y - gy), up = z - gz;
                    apart[i] = Math.min(apart[i]!, cell * (Math.sqrt(aside) - (up > 0 ? LOOK.LEAN * up : LOOK.LEAN_BELOW * Math.min(up + LOOK.BELOW_FREE, 0))));
                    if (aside > LOOK.RIM_REACH * LOOK.RIM_REACH || z + 2 >= nz) continue;
                    const over = up > 0 ? LOOK.RIM_UP * up : LOOK.RIM_BELOW * up, above = Math.max(power[i + nx * ny]!, power[i + 2 * nx * ny]!);
                    power[i] = Math.max(power[i]!, Math.min(above, own * (1 - Math.sqrt(aside + over * over) / LOOK.RIM_REACH)));
                }
    }
    // upwards with the gas
    for (let z = 1, i = nx * ny; z < nz; z++)
        for (let y = 0; y < ny; y++)
            for (let x = 0; x < nx; x++, i++) {
                const up = Math.max(velocity[3 * i + 2]!, 0.1);
                const fromX = clamp(x - clamp(velocity[3 * i]! / up, -1, 1), 0, nx - 1), fromY = clamp(y - clamp(velocity[3 * i + 1]! / up, -1, 1), 0, ny - 1);
                const ix = Math.min(Math.floor(fromX), nx - 2), iy = Math.min(Math.floor(fromY), ny - 2), fx = fromX - ix, fy = fromY - iy, under = ix + nx * (iy + ny * (z - 1));
                const from = (apart[under]! * (1 - fx) + apart[under + 1]! * fx) * (1 - fy) + (apart[under + nx]! * (1 - fx) + apart[under + nx + 1]! * fx) * fy;
                const height = cell + risen[under + (fx > 0.5 ? 1 : 0) + (fy > 0.5 ? nx : 0)]!;
                const s = from - cell * (LOOK.LEAN + (LOOK.LEAN_HIGH - LOOK.LEAN) * step(LOOK.LEAN_BEGINS, LOOK.LEAN_ENDS, height / Math.sqrt(scale)));
                if (from > LOOK.FAR || s > apart[i]!) continue;
                apart[i] = s;
                risen[i] = height;
            }
    return apart;
}

/** Near paper the gas is too rich to burn: flames that begin a few cells above what burns come down to it. */
function comeDown([nx, ny, nz]: Fire["size"], roots: Float32Array, power: Float32Array): void {
    for (let z = nz - 2; z >= 0; z--)
        for (let y = 0, i = nx * ny * z; y < ny; y++)
            for (let x = 0; x < nx; x++, i++) {
                const root = roots[4 * i]!, above = power[i + nx * ny]! - LOOK.ROOT_FALLS;
                if (!(root > 0) || above <= power[i]!) continue;
                const dx = x - roots[4 * i + 1]! / root, dy = y - roots[4 * i + 2]! / root, aside = Math.sqrt(dx * dx + dy * dy);
                if (aside <= LOOK.ROOT_OVER && z - roots[4 * i + 3]! / root >= -1) power[i] = above;
            }
}

/** A flame grows wider as it rises and mixes with the air beside it: mix_cells of fire.c. */
function mix([nx, ny, nz]: Fire["size"], flame: Float32Array, rise: Float32Array, scale: number): void {
    const row = nx, last = flame.length - row, mixedFlame = zeros("mixed flame", flame.length), mixedRise = zeros("mixed rise", flame.length);
    const share = (i: number) => step(LOOK.MIX_BEGINS * scale, LOOK.MIX_FULL * scale, rise[i]! / flame[i]!), beside = [-1, 1, -row, row];
    mixedFlame.set(flame); // its sides stay
    mixedRise.set(rise);
    for (let pass = 0; pass < LOOK.MIX_PASSES; pass++) {
        for (let z = 0; z < nz; z++)
            for (let y = 1; y < ny - 1; y++)
                for (let x = 1, i = x + nx * (y + ny * z); x < nx - 1; x++, i++) {
                    const f = flame[i]!, r = rise[i]!;
                    if (f + flame[i - 1]! + flame[i + 1]! + flame[i - row]! + flame[i + row]! <= 0) continue;
                    let sumFlame = f, sumRise = r;
                    for (let k = 0; k < 4; k++) {
                        const there = i + beside[k]!, other = flame[there]!, more = other > f ? there : i;
                        if (flame[more]! <= 0) continue;
                        const part = LOOK.MIX_SHARE * share(more);
                        sumFlame += part * (other - f);
                        sumRise += part * (rise[there]! - r);
                    }
                    mixedFlame[i] = sumFlame;
                    mixedRise[i] = sumRise;
                }
        flame.set(mixedFlame);
        rise.set(mixedRise);
    }
    for (let i = row; i < last; i++) {
        if (flame[i]! <= 0) continue;
        const fed = 1 + LOOK.MIX_FEEDS * Math.max(LOOK.MIX_BURNT - flame[i]!, 0) * share(i);
        flame[i]! *= fed;
        rise[i]! *= fed;
    }
}

export function fireOf(gas: Gas, surface: Surface, time: number): Fire {
    const [nx, ny, nz] = gas.size, count = nx * ny * nz, flame = zeros("flame", count), rise = zeros("rise", count), power = zeros("power", count);
    const thin = Math.max(gas.cell / LOOK.FLAME_THICK, 1), scale = flameScale(gas.cell), roots = rootsOf(gas, surface);
    const cells = new Uint8Array(4 * count), burns = zeros("burns", count), known = new Uint8Array(count), index = (x: number, y: number, z: number) => x + nx * (y + ny * z);
    for (let i = 0; i < count; i++) power[i] = thin * gas.flame[i]! > FLAME_LOW ? Math.min(Math.log((thin * gas.flame[i]!) / FLAME_LOW) / FLAME_RANGE, 1) : 0;
    const apart = feetOf(gas, surface, power, scale);
    comeDown(gas.size, roots, power);

    // height times flame, layer by layer: where the gas came from, at (x - vx/vz, y - vy/vz) below; over paper mostly its
    // own height. Up a hanging sheet gas that has burnt for a while passes what begins to.
    const fading = gas.cell / (FLAME_RANGE * Math.sqrt(gas.cell / (2 * 9.81))); // m/s: what flames lose as they rise by a cell
    const below = (of: Float32Array, x: number, y: number, z: number): number => {
        const ix = Math.floor(x), iy = Math.floor(y), fx = x - ix, fy = y - iy;
        const one = (u: number, v: number) => (u < 0 || v < 0 || u >= nx || v >= ny || z < 0 ? 0 : of[index(u, v, z)]!);
        return (one(ix, iy) * (1 - fx) + one(ix + 1, iy) * fx) * (1 - fy) + (one(ix, iy + 1) * (1 - fx) + one(ix + 1, iy + 1) * fx) * fy;
    };
    // where the layer below has flames: none comes from elsewhere, as it goes aside by a cell at most
    let fromX = nx, toX = -1, fromY = ny, toY = -1;
    for (let z = 0, i = 0; z < nz; z++) {
        const [lowX, highX, lowY, highY] = [fromX - 2, toX + 2, fromY - 2, toY + 2];
        [fromX, toX, fromY, toY] = [nx, -1, ny, -1];
        const left = step(0, LOOK.SMOKE_LEAVES, (nz - z) / nz);
        for (let y = 0; y < ny; y++)
            for (let x = 0; x < nx; x++, i++) {
                const up = Math.max(gas.velocity[3 * i + 2]!, 0.1), root = roots[4 * i]!;
                const atX = x - clamp(gas.velocity[3 * i]! / up, -1, 1), atY = y - clamp(gas.velocity[3 * i + 1]! / up, -1, 1);
                const passes = x >= lowX && x <= highX && y >= lowY && y <= highY ? below(flame, atX, atY, z - 1) : 0;
                let height = 0, near = 0, f = power[i]!, r = 0;
                if (root > 0) {
                    const dx = x - roots[4 * i + 1]! / root, dy = y - roots[4 * i + 2]! / root, aside = Math.sqrt(dx * dx + dy * dy), over = z - roots[4 * i + 3]! / root;
                    height = r = gas.cell * (over - LOOK.ROOT_LEAN * Math.max(aside - LOOK.ROOT_WIDE, 0));
                    near = Math.max(1 - Math.sqrt(aside * aside + over * over), 0);
                    // below what burns, too, or flames would fade towards it
                    if (passes <= 0 && Math.abs(height) < gas.cell && z + 1 < nz) f = Math.max(f, power[i + nx * ny]!);
                }
                f = Math.max(f, passes - fading / up);
                if (f > 0) {
                    r = passes > 0 ? Math.min((2 * passes) / f, 1) * (below(rise, atX, atY, z - 1) / passes + gas.cell) : 0;
                    if (root > 0) r = height + (r - height) * Math.min(passes / f, 1) * (1 - (1 - LOOK.FIRE_PASSING) * near);
                    flame[i] = f;
                    rise[i] = f * r;
                    fromX = Math.min(fromX, x);
                    toX = Math.max(toX, x);
                    fromY = Math.min(fromY, y);
                    toY = Math.max(toY, y);
                }
                known[i] = root > 0 ? 1 : 0;
                cells[4 * i + 1] = 255 * clamp(r / (FLAME_END * scale), 0, 1);
                cells[4 * i + 2] = clamp((255 * left * Math.max(gas.smoke[i]!, 0) * EXTINCTION) / 20, 0, 255);
            }
    }

    // above their max height flames are too thin to be seen
    for (let i = 0; i < count; i++) {
        if (flame[i]! <= 0) continue;
        const left = 1 - step(0.6 * FLAME_END, FLAME_END, rise[i]! / flame[i]! / scale);
        flame[i]! *= left;
        rise[i]! *= left;
    }
    mix(gas.size, flame, rise, scale);
    for (let i = 0; i < count; i++) {
        const f = (burns[i] = flame[i]!);
        if (f <= 0.5 * LOOK.FLAME_SEEN) continue;
        known[i] = 1;
        cells[4 * i + 1] = 255 * clamp(rise[i]! / f / (FLAME_END * scale), 0, 1);
    }
    spreadHeight(gas.size, cells, known, 1 + Math.floor((scale * LOOK.FIRE_SWAY) / gas.cell), (255 * gas.cell) / (FLAME_END * scale));
    const fire = { size: gas.size, origin: gas.origin, cell: gas.cell, scale, cells, burns, apart };
    return { ...fire, bounds: feed(fire, (i) => rise[i]! / flame[i]!, time % 1000) };
}

/** What eddies add and take, by the height of each flame. Returns the box of what is seen. */
function feed({ size, origin, cell, scale, cells, burns, apart }: Omit<Fire, "bounds">, height: (i: number) => number, time: number): Fire["bounds"] {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let z = 0, i = 0; z < size[2]; z++)
        for (let y = 0; y < size[1]; y++)
            for (let x = 0; x < size[0]; x++, i++) {
                let f = burns[i]!;
                if (f > 0) {
                    f = fed(origin[0] + (x + 0.5) * cell, origin[1] + (y + 0.5) * cell, origin[2] + (z + 0.5) * cell, height(i), f, time, scale);
                    f = Math.max(f - LOOK.LEAN_FALLS * Math.max(apart[i]! / cell - LOOK.LEAN_FOOT, 0), 0);
                    cells[4 * i] = Math.min((255 / LOOK.FLAME_MOST) * f, 255);
                }
                if (f <= LOOK.FLAME_SEEN && cells[4 * i + 2]! < 2) continue;
                for (let c = 0; c < 3; c++) {
                    const at = c === 0 ? x : c === 1 ? y : z;
                    low[c] = Math.min(low[c]!, at);
                    high[c] = Math.max(high[c]!, at + 1);
                }
            }
    const aside = 1 + Math.floor((scale * LOOK.FIRE_SWAY) / cell); // eddies move flames there
    const place = (at: number[], more: number) => at.map((x, c) => origin[c]! + (x + (c < 2 ? more * aside : more)) * cell) as [number, number, number];
    return low[0]! < high[0]! ? { low: place(low, -1), high: place(high, 1) } : null;
}

/** Smaller cells, as the shader reads them. */
export function refined(fire: Fire): Fire {
    const { size, cells } = refineGas(fire.size, fire.cells);
    return { ...fire, size, cells, burns: new Float32Array(0), cell: (fire.cell * fire.size[0]) / size[0] };
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
                    const f = fire.burns[i]!;
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

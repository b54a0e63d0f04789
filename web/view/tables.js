// Tables that the shaders look into, shared by the page (web/src) and `singe view`.
import { LOOK } from "./look.js";
import { hash } from "./math.js";

/** Random corners of a cube, four bytes each, the same on every page. */
export function noiseBytes() {
    const side = 32, bytes = new Uint8Array(4 * side ** 3);
    let state = 0x9e3779b9;
    for (let i = 0; i < bytes.length; i++) {
        state ^= state << 13;
        state ^= state >>> 17;
        state ^= state << 5;
        bytes[i] = state >>> 24;
    }
    return { side, bytes };
}

/** Of the first byte of these, means of corners that follow each other in z, from 0 to 16, four in a layer. */
export function sliceBytes() {
    const { side, bytes } = noiseBytes(), slice = side * side, means = new Uint8Array(16 * slice);
    for (let i = 0; i < means.length; i++) {
        const z = Math.floor(i / slice), at = i % slice, mean = (bytes[4 * i] + bytes[4 * (i + slice)]) / 2;
        means[4 * (slice * (z >> 2) + at) + (z & 3)] = Math.round(mean);
    }
    return { side, bytes: means };
}

export const FLAME_NOISE = 16; // FIRE_NOISE of fire.h

/** The noise of flames and smoke, FLAME_NOISE corners a side: the very numbers that the preview has (fire.c), four each. */
export function flameNoise() {
    const side = FLAME_NOISE, values = new Float32Array(4 * side ** 3);
    const corner = (x, y, z, c, size) => hash(4 * (x % side + side * (y % side + side * (z % side))) + c + 1 + (size - 1) * 65536) / 2 ** 31 - 1;
    const mix = (a, b, f) => a + (b - a) * f;
    const hills = (x, y, z, size) => { // of the third number
        const low = size / 2, u = (x % size) / size, v = (y % size) / size, w = (z % low) / low, i = x - (x % size), j = y - (y % size), k = z - (z % low);
        const row = (y, z) => mix(corner(i, y, z, 2, size), corner(i + size, y, z, 2, size), u), layer = (z) => mix(row(j, z), row(j + size, z), v);
        return mix(layer(k), layer(k + low), w);
    };
    for (let z = 0, at = 0; z < side; z++)
        for (let y = 0; y < side; y++)
            for (let x = 0; x < side; x++, at += 4) {
                for (let c = 0; c < 4; c++) values[at + c] = corner(x, y, z, c, 1);
                const sum = values[at + 2] + LOOK.NOISE_LARGER * (hills(x, y, z, 2) + LOOK.NOISE_LARGER * hills(x, y, z, 4));
                values[at + 2] = Math.min(Math.max(LOOK.NOISE_SIZES * sum, -1), 1);
            }
    return values;
}
export const flameNoiseBytes = () => ({ side: FLAME_NOISE, bytes: Uint8Array.from(flameNoise(), (x) => Math.round(127.5 * (x + 1))) });

/** Planck's law by the eye's three curves (blackbody.c), linear Rec. 709 as a camera balanced for 3400 K sees it. */
function blackbody(kelvin) {
    const lobe = (x, centre, left, right) => Math.exp(-0.5 * ((x - centre) * (x < centre ? left : right)) ** 2);
    const xyz = (t) => {
        const sum = [0, 0, 0];
        for (let nm = 380; nm <= 780; nm += 5) {
            const power = (nm * 1e-3) ** -5 / (Math.exp(1.438777e-2 / (nm * 1e-9 * t)) - 1);
            sum[0] += power * (0.362 * lobe(nm, 442, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) - 0.065 * lobe(nm, 501.1, 0.049, 0.0382));
            sum[1] += power * (0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322));
            sum[2] += power * (1.217 * lobe(nm, 437, 0.0845, 0.0278) + 0.681 * lobe(nm, 459, 0.0385, 0.0725));
        }
        return sum;
    };
    const [X, Y, Z] = xyz(kelvin), reference = xyz(1200)[1], x = X / Y, z = Z / Y;
    const fade = Math.min(Math.max((kelvin - 780) / 120, 0), 1), strength = (Y / reference) ** 0.55 * fade * fade * (3 - 2 * fade);
    const seen = [2.9717 * x - 1.8473 - 0.4908 * z, -1.0277 * x + 2.0626 + 0.0127 * z, 0.1167 * x - 0.3019 + 2.3811 * z].map((c) => Math.max(c, 0));
    return seen.map((c) => (c * strength) / (0.2126 * seen[0] + 0.7152 * seen[1] + 0.0722 * seen[2]));
}

/** Row 0: embers from 780 K to 2100 K; row 1: flames from their coolest to their hottest. Four values each. */
export function glowBytes() {
    const width = 128, values = new Float32Array(8 * width);
    for (let i = 0; i < width; i++) {
        const u = i / (width - 1), ember = blackbody(780 + 1320 * u), flame = blackbody(LOOK.FLAME_COOL + (LOOK.FLAME_HOT - LOOK.FLAME_COOL) * u);
        const bright = (LOOK.FLAME_DIM + (LOOK.FLAME_BRIGHT - LOOK.FLAME_DIM) * u ** 3) / (0.2126 * flame[0] + 0.7152 * flame[1] + 0.0722 * flame[2]);
        [ember, flame.map((c) => c * bright)].forEach((colour, row) => values.set(colour, 4 * (row * width + i)));
    }
    return { width, values };
}

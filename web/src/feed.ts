// What eddies add to flames and take from them, in the cells of the gas: fire_feed of program/preview/fire_shade.c.
import { FLAME_NOISE, flameNoise } from "../view/tables.js";
import { LOOK } from "../view/look.js";

const NOISE = flameNoise(), LAST = FLAME_NOISE - 1;
const smooth = (f: number) => f * f * (3 - 2 * f);
const stepTo = (b: number, x: number) => smooth(Math.min(Math.max(x / b, 0), 1));

/** The noise's numbers a, c and d of the last look. */
let a = 0, c = 0, d = 0;

/** Looks at eddies `across` m wide. */
function look(x: number, y: number, passed: number, across: number, often: number): void {
    const u = (0.829 * x - 0.559 * y) / across + 0.21 * passed, v = (0.559 * x + 0.829 * y) / across + 0.17 * passed, w = -often * passed;
    const i = Math.floor(u), j = Math.floor(v), k = Math.floor(w), f = smooth(u - i), g = smooth(v - j), h = smooth(w - k);
    a = c = d = 0;
    for (let m = 0; m < 8; m++) {
        const right = m & 1, back = (m >> 1) & 1, up = m >> 2, weight = (right ? f : 1 - f) * (back ? g : 1 - g) * (up ? h : 1 - h);
        const at = 4 * (((i + right) & LAST) + FLAME_NOISE * (((j + back) & LAST) + FLAME_NOISE * ((k + up) & LAST)));
        a += weight * NOISE[at]!;
        c += weight * NOISE[at + 2]!;
        d += weight * NOISE[at + 3]!;
    }
}

/** A flame at (x, y, z), `height` above what burns, as eddies leave it at a time. */
export function fed(x: number, y: number, z: number, height: number, flame: number, time: number, scale: number): number {
    const moment = time / Math.sqrt(scale), wide = scale * LOOK.GROUP_WIDE;
    look(x, y, LOOK.GROUP_RATE * moment - (0.5 * z) / wide, wide, 1);
    const group = Math.min(Math.max(0.4 + 2 * a, -1), 1);
    look(x, y, LOOK.EDDY_RATE * (moment - z / (scale * LOOK.RISE_MOST)), scale * LOOK.LICK_WIDE, 0.9);
    const high = height / scale, tall = Math.max(high, 0) / LOOK.FLAME_HEIGHT;
    const more = LOOK.LICK * c * stepTo(LOOK.LICK_FULL, high) + LOOK.GROUP * group * stepTo(0.02, high);
    const crease = Math.max(0.7 - 2.4 * Math.abs(a), -0.7), ends = 2 ** (-LOOK.UNLIKE * d - LOOK.GROUP_UNLIKE * group);
    const joined = LOOK.JOIN * crease * stepTo(LOOK.JOIN_FULL - LOOK.JOIN_BEGINS, high - LOOK.JOIN_BEGINS) + LOOK.TAPER * (Math.exp(-tall * ends) - Math.exp(-tall));
    return Math.max(flame * (1 + more) + joined * Math.min(flame / LOOK.FED_WHOLLY, 1), 0);
}

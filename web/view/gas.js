// The gas's cells, made ready for the shader that marches through them (FIRE in shaders.js).

import { LOOK } from "./look.js";

const REFINED_MOST = 160_000; // cells; more stay as they are, to save the card's memory

/**
 * Halves the cells by Chaikin's rule, 3/4 of the nearer and 1/4 of the farther along each axis: looked up linearly they
 * then follow the quadratic B-spline of the cells (fire_shade.c) closely, and no cell is seen. The fourth byte of each
 * becomes the length of the flame's gradient per cell.
 * @param {number[]} size @param {Uint8Array} cells four bytes each: flame in FLAME_MOST, height, smoke, unused
 * @returns {{size: [number, number, number], cells: Uint8Array<ArrayBuffer>}}
 */
export function refineGas(size, cells) {
    let [x, y, z] = size, values = cells;
    if (x * y * z <= REFINED_MOST) {
        values = halve(values, x, 1, y * z);
        x *= 2;
        values = halve(values, y, x, z);
        y *= 2;
        values = halve(values, z, x * y, 1);
        z *= 2;
    } else {
        values = values.slice();
    }
    const rows = x * y, times = x / size[0], [low, high] = boxOf(size, cells, 4, 1).map((corner) => corner.map((at) => at * times));
    for (let k = Math.max(low[2], 1); k < Math.min(high[2], z - 1); k++)
        for (let j = Math.max(low[1], 1); j < Math.min(high[1], y - 1); j++)
            for (let i = Math.max(low[0], 1), at = 4 * (i + x * j + rows * k); i < Math.min(high[0], x - 1); i++, at += 4) {
                const a = values[at + 4] - values[at - 4], b = values[at + 4 * x] - values[at - 4 * x], c = values[at + 4 * rows] - values[at - 4 * rows];
                if (a || b || c) values[at + 3] = Math.min(0.5 * Math.sqrt(a * a + b * b + c * c), 255);
            }
    return { size: [x, y, z], cells: values };
}

/** How large flames over such cells are, 1 over those of 8 to 10 mm: `preview_set_gas` of fire.c. @param {number} cell m */
export function flameScale(cell) {
    const fine = Math.max(cell / LOOK.FIRE_FINE_CELL, 0.4);
    return fine < 1 ? fine : Math.min(Math.max(cell / LOOK.FIRE_SCALE_CELL, 1), 3);
}

/** The corners of the box of cells of which the first of `each` numbers is not 0, and `more` cells around. */
function boxOf([x, y, z], numbers, each, more) {
    const low = [x, y, z], high = [0, 0, 0];
    for (let k = 0, at = 0; k < z; k++)
        for (let j = 0; j < y; j++)
            for (let i = 0; i < x; i++, at += each) {
                if (!numbers[at]) continue;
                if (i < low[0]) low[0] = i;
                if (i >= high[0]) high[0] = i + 1;
                if (j < low[1]) low[1] = j;
                if (j >= high[1]) high[1] = j + 1;
                if (k < low[2]) low[2] = k;
                high[2] = k + 1;
            }
    return [low.map((at) => Math.max(at - more, 0)), high.map((at, c) => Math.min(at + more, [x, y, z][c]))];
}

/** Gives cells around `known` ones, where those are 1, a height, the mean of their neighbours', as far as eddies reach: `sway_cells` of fire.c. */
export function spreadHeight([x, y, z], cells, known, reach, cell) {
    const rows = x * y, near = [1, -1, x, -x, rows, -rows], over = [0, 0, 0, 0, -cell, cell], [low, high] = boxOf([x, y, z], known, 1, reach);
    for (let far = 1; far <= reach; far++)
        for (let k = Math.max(low[2], 1); k < Math.min(high[2], z - 1); k++)
            for (let j = Math.max(low[1], 1); j < Math.min(high[1], y - 1); j++)
                for (let at = Math.max(low[0], 1), i = at + x * j + rows * k; at < Math.min(high[0], x - 1); at++, i++) {
                    if (known[i] || !(known[i + 1] | known[i - 1] | known[i + x] | known[i - x] | known[i + rows] | known[i - rows])) continue;
                    let sum = 0, count = 0;
                    for (let n = 0; n < 6; n++) {
                        const there = i + near[n];
                        if (!known[there] || known[there] > far) continue;
                        sum += cells[4 * there + 1] + over[n];
                        count++;
                    }
                    if (!count) continue;
                    cells[4 * i + 1] = Math.min(Math.max(sum / count, 0), 255);
                    known[i] = far + 1;
                }
}

/** Twice the cells along one axis, along which there are `count`, `stride` apart, in each of `blocks`. */
function halve(from, count, stride, blocks) {
    const to = new Uint8Array(2 * from.length), run = 4 * stride;
    for (let block = 0; block < blocks; block++)
        for (let i = 0; i < count; i++) {
            const here = (block * count + i) * run, before = i ? here - run : here, after = i + 1 < count ? here + run : here, out = 2 * here;
            for (let k = 0; k < run; k++) {
                const near = 3 * from[here + k] + 2;
                to[out + k] = (near + from[before + k]) >> 2;
                to[out + run + k] = (near + from[after + k]) >> 2;
            }
        }
    return to;
}

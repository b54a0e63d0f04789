// The gas's cells, made ready for the shader that marches through them (FIRE in shaders.js).

import { LOOK } from "./look.js";

const REFINED_MOST = 160_000; // cells; more stay as they are, to save the card's memory

/**
 * Halves the cells by Chaikin's rule, 3/4 of the nearer and 1/4 of the farther along each axis: looked up linearly they
 * then follow the quadratic B-spline of the cells (fire_shade.c) closely, and no cell is seen. The fourth byte of each
 * becomes the length of the flame's gradient per cell.
 * @param {number[]} size @param {Uint8Array} cells four bytes each: flame, height, smoke, unused
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
    const rows = x * y;
    for (let k = 1, first = 1 + x + rows; k < z - 1; k++, first += rows)
        for (let j = 1, i = first + (j - 1) * x; j < y - 1; j++, i += x)
            for (let at = 4 * i, end = 4 * (i + x - 2); at < end; at += 4) {
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

/** Gives cells around flames a height, the mean of their neighbours', as far as eddies reach: `sway_cells` of fire.c. */
export function spreadHeight([x, y, z], cells, reach, cell) {
    const rows = x * y, near = [[1, 0], [-1, 0], [x, 0], [-x, 0], [rows, -cell], [-rows, cell]], known = new Uint8Array(rows * z);
    for (let i = 0; i < known.length; i++) known[i] = cells[4 * i] > 19 ? 1 : 0; // half of FLAME_SEEN
    for (let far = 1; far <= reach; far++)
        for (let i = rows; i < known.length - rows; i++) {
            if (known[i] || !(known[i + 1] | known[i - 1] | known[i + x] | known[i - x] | known[i + rows] | known[i - rows])) continue;
            let sum = 0, count = 0;
            for (const [over, above] of near) {
                if (!known[i + over] || known[i + over] > far) continue;
                sum += cells[4 * (i + over) + 1] + above;
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

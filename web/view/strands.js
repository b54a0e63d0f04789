// The springs of the sheets by colour (docs/glossary.md), between vertices as they are in a frame. A cell's centre is the
// mean of its corners.

/** Colours in the order of the letters B, R, G, Y; what they join. */
export const COLOURS = [["#6096ff", "sides"], ["#ec5446", "to centres"], ["#56c878", "centres"], ["#f0c850", "across"]];

/**
 * @param {ArrayBuffer} buffer counts of vertices and cells; positions at rest [vertices][3], corners [cells][4]
 * @returns rest positions, corners of cells, and of each colour the ends of its springs: a vertex, or a cell behind them
 */
export function readCells(buffer) {
    const [vertexCount, cellCount] = new Uint32Array(buffer, 0, 2), rest = new Uint32Array(buffer, 8, 3 * vertexCount), cells = new Uint32Array(buffer, 8 + 12 * vertexCount, 4 * cellCount);
    const ends = [[], [], [], []], sides = new Map();
    for (let c = 0; c < cellCount; c++)
        for (let k = 0; k < 4; k++) {
            const a = cells[4 * c + k], b = cells[4 * c + ((k + 1) & 3)], side = Math.min(a, b) * vertexCount + Math.max(a, b), other = sides.get(side);
            ends[1].push(vertexCount + c, a);
            if (k < 2) ends[3].push(a, cells[4 * c + k + 2]);
            if (other === undefined) {
                sides.set(side, c);
                ends[0].push(a, b);
            } else ends[2].push(vertexCount + other, vertexCount + c);
        }
    return { vertexCount, cellCount, rest, cells, ends: ends.map((list) => Uint32Array.from(list)) };
}

/** Where the vertices are in a frame: x, y, z, and 1, or 0 where one is gone or a tear has made two of it. */
export function placesOf({ vertexCount, rest }, frame) {
    if (!vertexCount) return new Float32Array(0);
    // vertices of cells by the bits of their rest position
    const mask = (1 << Math.ceil(Math.log2(2 * vertexCount + 2))) - 1, table = new Int32Array(mask + 1).fill(-1), places = new Float32Array(4 * vertexCount);
    const hash = (x, y, z) => { const h = Math.imul(x, 0x9e3779b1) ^ Math.imul(y, 0x85ebca6b) ^ Math.imul(z, 0xc2b2ae35); return (h ^ (h >>> 15)) & mask; };
    for (let i = 0; i < vertexCount; i++) {
        let at = hash(rest[3 * i], rest[3 * i + 1], rest[3 * i + 2]);
        while (table[at] >= 0) at = (at + 1) & mask;
        table[at] = i;
    }
    const torn = new Uint8Array(vertexCount), { words, reals } = frame;
    for (let i = 0; i < frame.vertexCount; i++) {
        const r = 16 * i + 4, x = words[r], y = words[r + 1], z = words[r + 2];
        for (let at = hash(x, y, z); table[at] >= 0; at = (at + 1) & mask) {
            const v = table[at];
            if (rest[3 * v] !== x || rest[3 * v + 1] !== y || rest[3 * v + 2] !== z) continue;
            if (places[4 * v + 3] && [0, 1, 2].some((c) => places[4 * v + c] !== reals[16 * i + c])) torn[v] = 1;
            for (let c = 0; c < 3; c++) places[4 * v + c] = reals[16 * i + c];
            places[4 * v + 3] = 1;
        }
    }
    for (let v = 0; v < vertexCount; v++) if (torn[v]) places[4 * v + 3] = 0;
    return places;
}

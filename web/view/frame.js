// Reads a frame as program/preview/pack.c writes it. Nothing is copied: arrays are views of what arrived.

const MAGIC = 0x31465653, HEAD = 592, VERTEX = 64, SHAPE = 72;

/** Offsets of a vertex's fields, and how the card reads them. */
export const VERTEX_BYTES = VERTEX;
export const FIELDS = [
    ["position", 3, "FLOAT", 0], ["normal", 3, "BYTE", 12], ["sheet", 1, "BYTE", 15], ["rest", 3, "FLOAT", 16], ["uv", 2, "FLOAT", 28],
    ["heat", 4, "UNSIGNED_SHORT", 36], ["look", 4, "UNSIGNED_SHORT", 44], ["more", 4, "UNSIGNED_SHORT", 52],
];

/** @param {ArrayBuffer} buffer */
export function readFrame(buffer) {
    const head = new Uint32Array(buffer, 0, HEAD / 4), real = new Float32Array(buffer, 0, HEAD / 4);
    const [magic, vertexCount, triangleCount, shapeCount, lightCount, x, y, z] = head;
    if (magic !== MAGIC) throw new Error("this is not a frame of singe view");
    let at = HEAD;
    const take = (size) => { const from = at; at += size; return from; };
    const vertices = take(VERTEX * vertexCount), shapes = take(SHAPE * shapeCount), triangles = take(12 * triangleCount), cells = take(4 * x * y * z);
    if (at !== buffer.byteLength) throw new Error("a frame of singe view is incomplete");
    const words = new DataView(buffer);
    return {
        buffer, vertexCount, triangleCount, time: real[8], low: [...real.subarray(13, 16)], high: [...real.subarray(16, 19)],
        vertices: new Uint8Array(buffer, vertices, VERTEX * vertexCount), words: new Uint32Array(buffer, vertices, 16 * vertexCount),
        reals: new Float32Array(buffer, vertices, 16 * vertexCount), shorts: new Uint16Array(buffer, vertices, 32 * vertexCount),
        triangles: new Uint32Array(buffer, triangles, 3 * triangleCount),
        lights: new Float32Array(buffer, 80, 8 * lightCount), lightCount,
        gas: x * y * z ? { size: [x, y, z], cell: real[9], corner: [...real.subarray(10, 13)], cells: new Uint8Array(buffer, cells, 4 * x * y * z) } : null,
        shapes: Array.from({ length: shapeCount }, (_, i) => {
            const r = (k) => words.getFloat32(shapes + SHAPE * i + 4 * k, true);
            return {
                kind: words.getInt32(shapes + SHAPE * i, true), position: [r(1), r(2), r(3)], rotation: [r(4), r(5), r(6), r(7)], half: [r(8), r(9), r(10)],
                radius: r(11), height: r(12), colour: [r(13), r(14), r(15)], temperature: r(16), solid: words.getInt32(shapes + SHAPE * i + 68, true),
            };
        }),
    };
}

/** Temperature (K), mass, burnt share and stretch of a vertex. */
export function vertexValues(frame, i) {
    const s = frame.shorts, at = 32 * i;
    return { temperature: (s[at + 18] / 65535) * 5000, mass: s[at + 26] / 65535, burnt: s[at + 22] / 65535, stretch: (s[at + 28] / 65535) * 4 - 1 };
}
export const sourceOf = (frame, i) => frame.words[16 * i + 15] | 0;
export const positionOf = (frame, i) => [frame.reals[16 * i], frame.reals[16 * i + 1], frame.reals[16 * i + 2]];

/** The nearest vertex of the input where a ray meets the sheets, or null. */
export function pick(frame, origin, direction) {
    const { triangles, reals } = frame, [ox, oy, oz] = origin, [dx, dy, dz] = direction;
    let best = Infinity, found = -1;
    for (let t = 0; t < triangles.length; t += 3) {
        const a = 16 * triangles[t], b = 16 * triangles[t + 1], c = 16 * triangles[t + 2], ax = reals[a], ay = reals[a + 1], az = reals[a + 2];
        const ux = reals[b] - ax, uy = reals[b + 1] - ay, uz = reals[b + 2] - az, vx = reals[c] - ax, vy = reals[c + 1] - ay, vz = reals[c + 2] - az;
        const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx, det = ux * px + uy * py + uz * pz;
        if (Math.abs(det) < 1e-20) continue;
        const sx = ox - ax, sy = oy - ay, sz = oz - az, u = (sx * px + sy * py + sz * pz) / det;
        if (u < 0 || u > 1) continue;
        const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux, v = (dx * qx + dy * qy + dz * qz) / det;
        if (v < 0 || u + v > 1) continue;
        const far = (vx * qx + vy * qy + vz * qz) / det;
        if (far > 0 && far < best) { best = far; found = t; }
    }
    if (found < 0) return null;
    const at = origin.map((o, c) => o + best * direction[c]);
    let vertex = -1, least = Infinity;
    for (let i = 0; i < frame.vertexCount; i++) {
        if (sourceOf(frame, i) < 0) continue;
        const d = (reals[16 * i] - at[0]) ** 2 + (reals[16 * i + 1] - at[1]) ** 2 + (reals[16 * i + 2] - at[2]) ** 2;
        if (d < least) { least = d; vertex = i; }
    }
    return vertex < 0 ? null : { vertex, source: sourceOf(frame, vertex), at };
}

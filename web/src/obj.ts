// Reads a Wavefront OBJ: vertices, uv and faces; all else in the file is passed over.
import type { Shape } from "./messages.js";

const VERTICES_MOST = 60_000;
const SIDE = 0.25; // m, of the longest side as it is burnt

/** Lies flat if it is flat, in the middle of the table. Throws what is wrong, with its line. */
export function readObj(text: string): Shape {
    const positions: number[] = [], uvs: number[] = [], corners: number[] = [], sizes: number[] = [], uvOf = new Map<number, number>();
    text.split(/\r?\n/).forEach((line, i) => {
        const [word, ...rest] = line.trim().split(/\s+/), where = `line ${i + 1}`;
        if (word === "v") {
            const numbers = rest.slice(0, 3).map(Number);
            if (numbers.length < 3 || !numbers.every(Number.isFinite)) throw new Error(`${where}: a vertex has three numbers`);
            positions.push(...numbers);
            if (positions.length > 3 * VERTICES_MOST) throw new Error(`the mesh has more than ${VERTICES_MOST} vertices`);
        } else if (word === "vt") {
            uvs.push(Number(rest[0]) || 0, Number(rest[1]) || 0);
        } else if (word === "f") {
            if (rest.length < 3) throw new Error(`${where}: a face has three corners or more`);
            for (const corner of rest) {
                const [v, t] = corner.split("/").map(Number), count = positions.length / 3, index = v! > 0 ? v! - 1 : count + v!;
                if (!Number.isInteger(v) || index < 0 || index >= count) throw new Error(`${where}: there is no vertex ${corner}`);
                corners.push(index);
                if (t) uvOf.set(index, t > 0 ? t - 1 : uvs.length / 2 + t);
            }
            sizes.push(rest.length);
        }
    });
    if (!sizes.length) throw new Error("there are no faces in the file");

    const low = [0, 1, 2].map((c) => Infinity), high = [-Infinity, -Infinity, -Infinity];
    positions.forEach((x, i) => {
        low[i % 3] = Math.min(low[i % 3]!, x);
        high[i % 3] = Math.max(high[i % 3]!, x);
    });
    const span = [0, 1, 2].map((c) => high[c]! - low[c]!), scale = SIDE / Math.max(...span, 1e-9), up = uprightAxis(span);
    const placed = new Float32Array(positions.length);
    for (let i = 0; i < positions.length; i += 3) {
        const q = [0, 1, 2].map((c) => (positions[i + c]! - (low[c]! + high[c]!) / 2) * scale);
        const [x, y, z] = up === 1 ? [q[0]!, -q[2]!, q[1]!] : up === 0 ? [q[1]!, q[2]!, q[0]!] : [q[0]!, q[1]!, q[2]!];
        placed.set([x, y, z + (span[up]! * scale) / 2], i);
    }
    const uv = uvOf.size ? new Float32Array((2 * positions.length) / 3) : null;
    if (uv) for (const [vertex, t] of uvOf) uv.set([uvs[2 * t] ?? 0, uvs[2 * t + 1] ?? 0], 2 * vertex);
    return { positions: placed, corners: new Uint32Array(corners), sizes: new Uint32Array(sizes), uv };
}

/** A flat mesh lies on the table; otherwise y is up, as in most files. */
function uprightAxis(span: number[]): number {
    const least = span.indexOf(Math.min(...span));
    return span[least]! < 0.05 * Math.max(...span) ? least : 1;
}

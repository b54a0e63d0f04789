// A mesh of a file as it is burnt: scaled, in the middle of the table.
import type { FileFaces } from "singe";

const VERTICES_MOST = 60_000;
const SIDE = 0.25; // m, of the longest side as it is burnt

/** Lies flat if it is flat; otherwise y is up, or z in STL. */
export function placed({ positions, ...faces }: FileFaces, name: string): FileFaces {
    if (positions.length > 3 * VERTICES_MOST) throw new Error(`${name}: ${positions.length / 3} vertices; at most ${VERTICES_MOST} burn here`);
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    positions.forEach((x, i) => {
        low[i % 3] = Math.min(low[i % 3]!, x);
        high[i % 3] = Math.max(high[i % 3]!, x);
    });
    const span = [0, 1, 2].map((c) => high[c]! - low[c]!), scale = SIDE / Math.max(...span, 1e-9), up = uprightAxis(span, name);
    const moved = new Float32Array(positions.length);
    for (let i = 0; i < positions.length; i += 3) {
        const q = [0, 1, 2].map((c) => (positions[i + c]! - (low[c]! + high[c]!) / 2) * scale);
        const [x, y, z] = up === 1 ? [q[0]!, -q[2]!, q[1]!] : up === 0 ? [q[1]!, q[2]!, q[0]!] : [q[0]!, q[1]!, q[2]!];
        moved.set([x, y, z + (span[up]! * scale) / 2], i);
    }
    return { positions: moved, ...faces };
}

function uprightAxis(span: number[], name: string): number {
    const least = span.indexOf(Math.min(...span));
    return span[least]! < 0.05 * Math.max(...span) ? least : /\.stl$/i.test(name) ? 2 : 1;
}

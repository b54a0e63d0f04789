// How near a sheet comes to what it may touch, for each vertex of a frame: another sheet, another part of its own, a
// shape, the ground. Triangles lie in a grid of boxes, and a vertex looks into those within reach.
//
// A part of its own sheet counts where it is more than NEIGHBOUR away at rest: char that has shrunk is still a neighbour.
import { apply, invert, placed } from "./math.js";
import { VERTEX_BYTES } from "./frame.js";

/** m: what is farther away is not looked for */
export const REACH = 0.004;
const NEIGHBOUR = 2 * REACH, WORDS = VERTEX_BYTES / 4, REST = 4; // a vertex's rest position in its words

/** The distance of a shape from a point in its own axes, m, by the kind of the collider. */
const SHAPES = {
    1: ({ radius }, p) => Math.hypot(...p) - radius,
    2: ({ half }, p) => Math.hypot(...p.map((x, c) => Math.max(Math.abs(x) - half[c], 0))),
    3: ({ radius, height }, [x, y, z]) => Math.hypot(x, y, Math.max(Math.abs(z) - height / 2, 0)) - radius,
};

/** The squared distance of a point from the triangle of the points i, j and k. */
export function squaredDistance(x, y, z, p, i, j, k) {
    const ux = p[j] - p[i], uy = p[j + 1] - p[i + 1], uz = p[j + 2] - p[i + 2], vx = p[k] - p[i], vy = p[k + 1] - p[i + 1], vz = p[k + 2] - p[i + 2];
    const wx = x - p[i], wy = y - p[i + 1], wz = z - p[i + 2];
    const uu = ux * ux + uy * uy + uz * uz, uv = ux * vx + uy * vy + uz * vz, vv = vx * vx + vy * vy + vz * vz;
    const uw = ux * wx + uy * wy + uz * wz, vw = vx * wx + vy * wy + vz * wz, ww = wx * wx + wy * wy + wz * wz, area = uu * vv - uv * uv;
    const s = vv * uw - uv * vw, t = uu * vw - uv * uw;
    if (area > 0 && s >= 0 && t >= 0 && s + t <= area) return Math.max(ww - (s * uw + t * vw) / area, 0);
    // else the nearest point lies on a side: of direction d from a corner that is w away, by d.d, d.w and w.w
    const side = (dd, dw, far) => { const a = dd > 0 ? Math.min(Math.max(dw / dd, 0), 1) : 0; return far + a * (a * dd - 2 * dw); };
    const opposite = side(uu + vv - 2 * uv, vw - uw - uv + uu, ww - 2 * uw + uu);
    return Math.max(Math.min(side(uu, uw, ww), side(vv, vw, ww), opposite), 0);
}

/** Triangles by the boxes that they reach into: those of box b are list[begin[b]] to list[begin[b + 1]]. */
class Grid {
    constructor(points, triangles, side) {
        this.side = side;
        this.mask = (1 << Math.min(Math.max(Math.ceil(Math.log2(triangles.length + 1)), 4), 22)) - 1;
        const begin = new Uint32Array(this.mask + 3), low = [0, 0, 0], high = [0, 0, 0];
        const visit = (act) => {
            for (let t = 0; t < triangles.length; t += 3) {
                for (let c = 0; c < 3; c++) {
                    const a = points[triangles[t] + c], b = points[triangles[t + 1] + c], d = points[triangles[t + 2] + c];
                    low[c] = Math.floor(Math.min(a, b, d) / side);
                    high[c] = Math.floor(Math.max(a, b, d) / side);
                }
                this.each(low, high, (box) => act(box, t));
            }
        };
        visit((box) => { begin[box + 2]++; });
        for (let b = 2; b < begin.length; b++) begin[b] += begin[b - 1];
        this.list = new Uint32Array(begin[begin.length - 1]);
        visit((box, t) => { this.list[begin[box + 1]++] = t; });
        this.begin = begin;
    }

    /** Boxes have numbers by a hash: two of them may share one. */
    each(low, high, act) {
        for (let z = low[2]; z <= high[2]; z++)
            for (let y = low[1]; y <= high[1]; y++)
                for (let x = low[0]; x <= high[0]; x++) act((Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & this.mask);
    }
}

/**
 * @param frame of readFrame
 * @param {number | null} ground its height, m
 * @param solids the shapes that are meshes, in the world: {positions, triangles}
 * @returns {Uint8Array} of each vertex: 255 where it touches, 0 where nothing is within REACH
 */
export function gapsOf(frame, ground, solids = []) {
    const { reals, vertices, vertexCount } = frame, lengths = [3 * vertexCount, ...solids.map(({ positions }) => positions.length)];
    const points = new Float32Array(lengths.reduce((a, b) => a + b)), triangles = new Uint32Array(frame.triangles.length + solids.reduce((sum, { triangles: list }) => sum + list.length, 0));
    for (let i = 0; i < vertexCount; i++) for (let c = 0; c < 3; c++) points[3 * i + c] = reals[WORDS * i + c];
    frame.triangles.forEach((vertex, k) => { triangles[k] = 3 * vertex; });
    let base = 3 * vertexCount, corner = frame.triangles.length;
    for (const { positions, triangles: list } of solids) {
        points.set(positions, base);
        for (const vertex of list) triangles[corner++] = base + 3 * vertex;
        base += positions.length;
    }

    const sheetOf = (i) => vertices[VERTEX_BYTES * i + 15], restOf = (k) => (k / 3) * WORDS + REST; // of the point at k
    const neighbours = (i, t) => {
        if (triangles[t] >= 3 * vertexCount || sheetOf(triangles[t] / 3) !== sheetOf(i)) return false;
        const at = WORDS * i + REST;
        return squaredDistance(reals[at], reals[at + 1], reals[at + 2], reals, restOf(triangles[t]), restOf(triangles[t + 1]), restOf(triangles[t + 2])) < NEIGHBOUR ** 2;
    };
    const shapes = frame.shapes.filter(({ kind }) => SHAPES[kind]).map((shape) => [shape, invert(placed(shape.position, shape.rotation, [1, 1, 1]))]);
    const grid = new Grid(points, triangles, 2 * REACH), seen = new Int32Array(triangles.length / 3).fill(-1), gaps = new Uint8Array(vertexCount);
    for (let i = 0; i < vertexCount; i++) {
        const p = [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
        let least = REACH ** 2;
        grid.each(p.map((x) => Math.floor((x - REACH) / grid.side)), p.map((x) => Math.floor((x + REACH) / grid.side)), (box) => {
            for (let k = grid.begin[box]; k < grid.begin[box + 1]; k++) {
                const t = grid.list[k];
                if (seen[t / 3] === i) continue; // it lies in several boxes
                seen[t / 3] = i;
                const gap = squaredDistance(p[0], p[1], p[2], points, triangles[t], triangles[t + 1], triangles[t + 2]);
                if (gap < least && !neighbours(i, t)) least = gap;
            }
        });
        let gap = Math.sqrt(least);
        if (ground !== null) gap = Math.min(gap, Math.max(p[2] - ground, 0));
        for (const [shape, inverse] of shapes) gap = Math.min(gap, Math.max(SHAPES[shape.kind](shape, apply(inverse, p)), 0));
        gaps[i] = Math.round(255 * (1 - Math.min(gap / REACH, 1)));
    }
    return gaps;
}

// Shapes as triangles: positions and normals by turns, then the corners.

/** A sphere, or where it is squeezed apart, a capsule. */
export function sphere(squeeze = 0) {
    const p = [], index = [], rows = 24, columns = 40;
    for (let r = 0; r <= rows; r++)
        for (let c = 0; c <= columns; c++) {
            const a = (Math.PI * r) / rows, b = (2 * Math.PI * c) / columns, n = [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)];
            p.push(n[0], n[1], n[2] + squeeze * (r * 2 < rows ? 1 : -1), ...n);
        }
    for (let r = 0; r < rows; r++)
        for (let c = 0; c < columns; c++) {
            const a = r * (columns + 1) + c, b = a + columns + 1;
            index.push(a, b, a + 1, a + 1, b, b + 1);
        }
    return [p, index];
}
export function box() {
    const p = [], index = [];
    for (let axis = 0; axis < 3; axis++)
        for (const side of [-1, 1]) {
            const first = p.length / 6;
            for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
                const at = [0, 0, 0], n = [0, 0, 0];
                at[axis] = n[axis] = side;
                at[(axis + 1) % 3] = u;
                at[(axis + 2) % 3] = v;
                p.push(...at, ...n);
            }
            index.push(first, first + 1, first + 2, first, first + 2, first + 3);
        }
    return [p, index];
}

// Vectors and 4 x 4 matrices by columns, as WebGL reads them.
export const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => { const n = length(a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; };

export function multiply(a, b) {
    const out = new Float32Array(16);
    for (let c = 0; c < 4; c++)
        for (let r = 0; r < 4; r++)
            for (let k = 0; k < 4; k++) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    return out;
}

export function perspective(fov, aspect, near, far) {
    const f = 1 / Math.tan(fov / 2), d = near - far;
    return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / d, -1, 0, 0, (2 * far * near) / d, 0]);
}

export function orthographic(width, height, near, far) {
    const d = near - far;
    return new Float32Array([2 / width, 0, 0, 0, 0, 2 / height, 0, 0, 0, 0, 2 / d, 0, 0, 0, (far + near) / d, 1]);
}

export function lookAt(eye, target, up) {
    const z = unit(add(eye, target, -1)), x = unit(cross(up, z)), y = cross(z, x);
    return new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, eye), -dot(y, eye), -dot(z, eye), 1]);
}

/** A position, a quaternion (x, y, z, w) and a scale along each axis. */
export function placed(p, q, s) {
    const [x, y, z, w] = q;
    return new Float32Array([
        s[0] * (1 - 2 * (y * y + z * z)), s[0] * 2 * (x * y + w * z), s[0] * 2 * (x * z - w * y), 0,
        s[1] * 2 * (x * y - w * z), s[1] * (1 - 2 * (x * x + z * z)), s[1] * 2 * (y * z + w * x), 0,
        s[2] * 2 * (x * z + w * y), s[2] * 2 * (y * z - w * x), s[2] * (1 - 2 * (x * x + y * y)), 0, p[0], p[1], p[2], 1,
    ]);
}

export function invert(m) {
    const out = new Float32Array(16), a = Array.from({ length: 4 }, (_, r) => Array.from({ length: 8 }, (_, c) => (c < 4 ? m[4 * c + r] : +(c - 4 === r))));
    for (let i = 0; i < 4; i++) {
        let best = i;
        for (let r = i; r < 4; r++) if (Math.abs(a[r][i]) > Math.abs(a[best][i])) best = r;
        [a[i], a[best]] = [a[best], a[i]];
        const p = a[i][i] || 1e-30;
        for (let c = 0; c < 8; c++) a[i][c] /= p;
        for (let r = 0; r < 4; r++) {
            const f = a[r][i];
            for (let c = 0; r !== i && c < 8; c++) a[r][c] -= f * a[i][c];
        }
    }
    for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++) out[4 * c + r] = a[r][4 + c];
    return out;
}

export function apply(m, p) {
    const w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
    return [0, 1, 2].map((r) => (m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]) / w);
}

/** As hash_u32 of noise.h. */
export function hash(x) {
    x = Math.imul(x ^ (x >>> 16), 0x7feb352d);
    x = Math.imul(x ^ (x >>> 15), 0x846ca68b);
    return (x ^ (x >>> 16)) >>> 0;
}

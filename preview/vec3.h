// Three floats: what a renderer needs of vectors.
#ifndef PREVIEW_VEC3_H
#define PREVIEW_VEC3_H

#include <math.h>
#include <stdbool.h>

typedef struct V3 { float x, y, z; } V3;

static inline V3 v3(float x, float y, float z) { return (V3){x, y, z}; }
static inline V3 v3_load(const float *p) { return (V3){p[0], p[1], p[2]}; }
static inline V3 v3_add(V3 a, V3 b) { return (V3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline V3 v3_sub(V3 a, V3 b) { return (V3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline V3 v3_mul(V3 a, V3 b) { return (V3){a.x * b.x, a.y * b.y, a.z * b.z}; }
static inline V3 v3_scale(V3 a, float s) { return (V3){a.x * s, a.y * s, a.z * s}; }
/// a + b s
static inline V3 v3_mad(V3 a, V3 b, float s) { return (V3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s}; }
static inline V3 v3_mix(V3 a, V3 b, float s) { return v3_mad(a, v3_sub(b, a), s); }
/// (1 - u - v) a + u b + v c
static inline V3 v3_blend(const float *a, const float *b, const float *c, float u, float v) {
    float w = 1 - u - v;
    return v3(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1], w * a[2] + u * b[2] + v * c[2]);
}
static inline float v3_dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline V3 v3_cross(V3 a, V3 b) {
    return (V3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float v3_length(V3 a) { return sqrtf(v3_dot(a, a)); }
/// The unit vector along a, or `otherwise` when a has no direction.
static inline V3 v3_unit(V3 a, V3 otherwise) {
    float l2 = v3_dot(a, a);
    return l2 > 1e-30f && l2 < 1e30f ? v3_scale(a, 1 / sqrtf(l2)) : otherwise;
}
static inline bool v3_finite(V3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
/// Linear Rec. 709 luminance.
static inline float v3_luminance(V3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// Two unit vectors that make a right-handed frame with the unit vector n (Duff et al. 2017,
/// "Building an orthonormal basis, revisited").
static inline void v3_frame(V3 n, V3 *a, V3 *b) {
    float sign = n.z >= 0 ? 1.0f : -1.0f, p = -1 / (sign + n.z), q = n.x * n.y * p;
    *a = v3(1 + sign * n.x * n.x * p, sign * q, -sign * n.x);
    *b = v3(q, sign + n.y * n.y * p, -n.y);
}

/// Rotates by the unit quaternion q = (x, y, z, w), or back for sign = -1.
static inline V3 v3_rotate(const float q[4], V3 v, float sign) {
    V3 u = v3_scale(v3_load(q), sign), t = v3_scale(v3_cross(u, v), 2);
    return v3_add(v3_mad(v, t, q[3]), v3_cross(u, t));
}

// one instruction each where fminf and fmaxf are calls; b where either is NaN
static inline float minf(float a, float b) { return a < b ? a : b; }
static inline float maxf(float a, float b) { return a > b ? a : b; }
static inline float clampf(float x, float low, float high) { return x < low ? low : x > high ? high : x; }
static inline float mixf(float a, float b, float s) { return a + (b - a) * s; }
/// 0 below a, 1 above b, the cubic 3x^2 - 2x^3 between.
static inline float stepf(float a, float b, float x) {
    float s = clampf((x - a) / (b - a), 0, 1);
    return s * s * (3 - 2 * s);
}

#endif

// Three floats, and the quaternions of poses.
#ifndef COMMON_FLOAT3_H
#define COMMON_FLOAT3_H

#include <math.h>

typedef struct Vec { float x, y, z; } Vec;

static inline Vec vec(float x, float y, float z) { return (Vec){x, y, z}; }
static inline Vec vec_load(const float *p) { return (Vec){p[0], p[1], p[2]}; }
static inline void vec_store(float *p, Vec a) { p[0] = a.x, p[1] = a.y, p[2] = a.z; }
static inline Vec vec_add(Vec a, Vec b) { return (Vec){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Vec vec_sub(Vec a, Vec b) { return (Vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Vec vec_scale(Vec a, float s) { return (Vec){a.x * s, a.y * s, a.z * s}; }
static inline Vec vec_mad(Vec a, Vec b, float s) { return (Vec){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s}; }
static inline float vec_dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Vec vec_cross(Vec a, Vec b) {
    return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float vec_length(Vec a) { return sqrtf(vec_dot(a, a)); }
/// The unit vector along a, or zero for zero.
static inline Vec vec_unit(Vec a) { float l = vec_length(a); return l > 0 ? vec_scale(a, 1 / l) : a; }

/// Rotates by the unit quaternion q = (x, y, z, w): v + 2 q × (q × v + w v).
static inline Vec quat_rotate(const float q[4], Vec v) {
    Vec u = {q[0], q[1], q[2]};
    Vec t = vec_scale(vec_cross(u, v), 2);
    return vec_add(vec_mad(v, t, q[3]), vec_cross(u, t));
}
/// Rotates back, by the conjugate.
static inline Vec quat_unrotate(const float q[4], Vec v) {
    float c[4] = {-q[0], -q[1], -q[2], q[3]};
    return quat_rotate(c, v);
}

#endif

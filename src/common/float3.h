// Three floats, three doubles, and the quaternions of poses.
#pragma once

#include <math.h>
#include <stdbool.h>

typedef struct Float3 {
    float x, y, z;
} Float3;

static inline Float3 float3(float x, float y, float z) { return (Float3){x, y, z}; }
static inline Float3 float3_load(const float *p) { return (Float3){p[0], p[1], p[2]}; }
static inline void float3_store(float *p, Float3 a) {
    p[0] = a.x;
    p[1] = a.y;
    p[2] = a.z;
}
static inline Float3 float3_add(Float3 a, Float3 b) { return (Float3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Float3 float3_sub(Float3 a, Float3 b) { return (Float3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Float3 float3_scale(Float3 a, float s) { return (Float3){a.x * s, a.y * s, a.z * s}; }
static inline Float3 float3_mad(Float3 a, Float3 b, float s) {
    return (Float3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
static inline float float3_dot(Float3 a, Float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Float3 float3_cross(Float3 a, Float3 b) {
    return (Float3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float float3_length(Float3 a) { return sqrtf(float3_dot(a, a)); }
/// The unit vector along a, or zero for zero.
static inline Float3 float3_unit(Float3 a) {
    float l = float3_length(a);
    return l > 0 ? float3_scale(a, 1 / l) : a;
}

/// Rotates by the unit quaternion q = (x, y, z, w): v + 2 q × (q × v + w v).
static inline Float3 quat_rotate(const float q[4], Float3 v) {
    Float3 u = {q[0], q[1], q[2]};
    Float3 t = float3_scale(float3_cross(u, v), 2);
    return float3_add(float3_mad(v, t, q[3]), float3_cross(u, t));
}
/// Rotates back, by the conjugate.
static inline Float3 quat_unrotate(const float q[4], Float3 v) {
    float c[4] = {-q[0], -q[1], -q[2], q[3]};
    return quat_rotate(c, v);
}
/// The unit quaternion that turns the axes x, y and z to these, which are unit, at right angles and right-handed.
static inline void quat_of_axes(Float3 x, Float3 y, Float3 z, float q[4]) {
    // four multiples of it, of which the longest is the most exact (Shepperd 1978)
    const float all[4][4] = {{1 + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y},
                             {x.y + y.x, 1 - x.x + y.y - z.z, y.z + z.y, z.x - x.z},
                             {z.x + x.z, y.z + z.y, 1 - x.x - y.y + z.z, x.y - y.x},
                             {y.z - z.y, z.x - x.z, x.y - y.x, 1 + x.x + y.y + z.z}};
    int longest = 0;
    for (int k = 1; k < 4; k++)
        if (all[k][k] > all[longest][longest]) longest = k;

    const float length = 2 * sqrtf(all[longest][longest]);
    for (int k = 0; k < 4; k++) q[k] = all[longest][k] / length;
}

// Geometry that must not round as floats do, over arrays of three doubles.

static inline double dot3(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline void sub3(const double *a, const double *b, double *out) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}
static inline void cross3(const double *a, const double *b, double *out) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}
/// The distance of two points of floats.
static inline double distance_of(const float *a, const float *b) {
    const double x = (double)a[0] - (double)b[0], y = (double)a[1] - (double)b[1], z = (double)a[2] - (double)b[2];
    return sqrt(x * x + y * y + z * z);
}
/// Twice the area of a triangle of three points of floats, along its normal.
static inline void area3(const float *a, const float *b, const float *c, double *out) {
    double p[3], q[3];
    for (int k = 0; k < 3; k++) {
        p[k] = (double)b[k] - (double)a[k];
        q[k] = (double)c[k] - (double)a[k];
    }
    cross3(p, q, out);
}
/// Scales to length 1; false if the length is 0 or not a number.
static inline bool unit3(double *a) {
    const double length = sqrt(dot3(a, a));
    if (!(length > 0)) return false;
    for (int k = 0; k < 3; k++) a[k] /= length;
    return true;
}

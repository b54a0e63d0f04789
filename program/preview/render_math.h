// Vectors, colours and numbers in the renderer, on common/float3.h.
#pragma once

#include "common/curves.h"
#include "common/float3.h"

#include <string.h>

#define PI_F 3.14159265f

static inline Float3 float3_mul(Float3 a, Float3 b) { return (Float3){a.x * b.x, a.y * b.y, a.z * b.z}; }
static inline Float3 float3_mix(Float3 a, Float3 b, float s) { return float3_mad(a, float3_sub(b, a), s); }

/// (1 - u - v) a + u b + v c
static inline Float3 float3_blend(const float *a, const float *b, const float *c, float u, float v) {
    float w = 1 - u - v;
    return float3(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1], w * a[2] + u * b[2] + v * c[2]);
}

/// The unit vector along a, or `otherwise` if a has no direction.
static inline Float3 float3_unit_or(Float3 a, Float3 otherwise) {
    float l2 = float3_dot(a, a);
    return l2 > 1e-30f && l2 < 1e30f ? float3_scale(a, 1 / sqrtf(l2)) : otherwise;
}

/// Linear Rec. 709 luminance.
static inline float float3_luminance(Float3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// Two unit vectors that form a right-handed frame with the unit vector n (Duff et al. 2017, "Building an orthonormal
/// basis, revisited").
static inline void float3_frame(Float3 n, Float3 *a, Float3 *b) {
    float sign = n.z >= 0 ? 1.0f : -1.0f, p = -1 / (sign + n.z), q = n.x * n.y * p;
    *a = float3(1 + sign * n.x * n.x * p, sign * q, -sign * n.x);
    *b = float3(q, sign + n.y * n.y * p, -n.y);
}

/// A linear value, 0 to 1, as sRGB encodes it (IEC 61966-2-1).
static inline float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

/// Four numbers that are computed together.
typedef float Four __attribute__((vector_size(16)));

static inline Four four_load(const float *p) {
    Four four;
    memcpy(&four, p, sizeof four);
    return four;
}

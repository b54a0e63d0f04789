// Four floats at once: the arithmetic of gcc's and clang's vector types, which every processor has some form of.
#ifndef COMMON_FLOAT4_H
#define COMMON_FLOAT4_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

typedef float Quad __attribute__((vector_size(16)));
typedef int32_t QuadMask __attribute__((vector_size(16))); ///< -1 where it holds, 0 elsewhere

static inline Quad quad_load(const float *p) { Quad a; memcpy(&a, p, sizeof a); return a; }
static inline void quad_store(float *p, Quad a) { memcpy(p, &a, sizeof a); }
static inline QuadMask quad_load_ints(const int32_t *p) { QuadMask a; memcpy(&a, p, sizeof a); return a; }
static inline Quad quad_all(float a) { return (Quad){a, a, a, a}; }
static inline Quad quad_select(QuadMask mask, Quad yes, Quad no) {
    return (Quad)((mask & (QuadMask)yes) | (~mask & (QuadMask)no));
}
#ifdef __SSE2__ // compilers do not see one instruction in a comparison and a choice
static inline Quad quad_min(Quad a, Quad b) { return (Quad)_mm_min_ps((__m128)a, (__m128)b); }
static inline Quad quad_max(Quad a, Quad b) { return (Quad)_mm_max_ps((__m128)a, (__m128)b); }
static inline Quad quad_sqrt(Quad a) { return (Quad)_mm_sqrt_ps((__m128)a); }
/// Bit k is set where the mask holds in number k.
static inline unsigned quad_bits(QuadMask mask) { return (unsigned)_mm_movemask_ps((__m128)mask); }
#else
static inline Quad quad_min(Quad a, Quad b) { return quad_select(a < b, a, b); }
static inline Quad quad_max(Quad a, Quad b) { return quad_select(a > b, a, b); }
static inline Quad quad_sqrt(Quad a) { for (int k = 0; k < 4; k++) a[k] = sqrtf(a[k]); return a; }
static inline unsigned quad_bits(QuadMask mask) {
    return (unsigned)((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
}
#endif

#ifdef __clang__
#define QUAD_SHUFFLE(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define QUAD_SHUFFLE(a, b, i, j, k, l) __builtin_shuffle(a, b, (QuadMask){i, j, k, l})
#endif

/// The fourth number made 0, or something else.
static inline Quad quad_flat(Quad a) { return (Quad)((QuadMask)a & (QuadMask){-1, -1, -1, 0}); }
static inline Quad quad_with(Quad a, float fourth) {
    return quad_select((QuadMask){-1, -1, -1, 0}, a, quad_all(fourth));
}

/// Of the first three numbers; the fourth of the product is 0.
static inline Quad quad_cross(Quad a, Quad b) {
    Quad turned = a * QUAD_SHUFFLE(b, b, 1, 2, 0, 3) - QUAD_SHUFFLE(a, a, 1, 2, 0, 3) * b;
    return QUAD_SHUFFLE(turned, turned, 1, 2, 0, 3);
}
static inline float quad_dot(Quad a, Quad b) {
    Quad c = a * b;
    return c[0] + c[1] + c[2];
}

/// Four rows become four columns.
static inline void quad_transpose(Quad q[4]) {
    Quad xy01 = QUAD_SHUFFLE(q[0], q[1], 0, 4, 1, 5), zw01 = QUAD_SHUFFLE(q[0], q[1], 2, 6, 3, 7);
    Quad xy23 = QUAD_SHUFFLE(q[2], q[3], 0, 4, 1, 5), zw23 = QUAD_SHUFFLE(q[2], q[3], 2, 6, 3, 7);
    q[0] = QUAD_SHUFFLE(xy01, xy23, 0, 1, 4, 5), q[1] = QUAD_SHUFFLE(xy01, xy23, 2, 3, 6, 7);
    q[2] = QUAD_SHUFFLE(zw01, zw23, 0, 1, 4, 5), q[3] = QUAD_SHUFFLE(zw01, zw23, 2, 3, 6, 7);
}

#endif

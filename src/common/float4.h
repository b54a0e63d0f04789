// Four floats at once: the arithmetic of gcc's and clang's vector types, which compile for every processor.
#pragma once

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

typedef float Float4 __attribute__((vector_size(16)));
typedef int32_t Float4Mask __attribute__((vector_size(16))); ///< -1 where true, 0 elsewhere

static inline Float4 float4_load(const float *p) {
    Float4 a;
    memcpy(&a, p, sizeof a);
    return a;
}
static inline void float4_store(float *p, Float4 a) { memcpy(p, &a, sizeof a); }
static inline Float4Mask float4_load_ints(const int32_t *p) {
    Float4Mask a;
    memcpy(&a, p, sizeof a);
    return a;
}
static inline Float4 float4_gather(const float *from, const uint32_t at[4]) {
    return (Float4){from[at[0]], from[at[1]], from[at[2]], from[at[3]]};
}
static inline Float4 float4_all(float a) { return (Float4){a, a, a, a}; }
static inline Float4 float4_select(Float4Mask mask, Float4 yes, Float4 no) {
    return (Float4)((mask & (Float4Mask)yes) | (~mask & (Float4Mask)no));
}
#ifdef __SSE2__ // compilers do not turn a comparison and a selection into one instruction
static inline Float4 float4_min(Float4 a, Float4 b) { return (Float4)_mm_min_ps((__m128)a, (__m128)b); }
static inline Float4 float4_max(Float4 a, Float4 b) { return (Float4)_mm_max_ps((__m128)a, (__m128)b); }
static inline Float4 float4_sqrt(Float4 a) { return (Float4)_mm_sqrt_ps((__m128)a); }
static inline bool float4_any(Float4Mask mask) { return _mm_movemask_ps((__m128)mask) != 0; }
/// Bit k is set if the mask is true in lane k.
static inline unsigned float4_bits(Float4Mask mask) { return (unsigned)_mm_movemask_ps((__m128)mask); }
#elif defined(__wasm_simd128__) // "pseudo-minimum": b where a < b is false, as above
static inline Float4 float4_min(Float4 a, Float4 b) { return (Float4)wasm_f32x4_pmin((v128_t)b, (v128_t)a); }
static inline Float4 float4_max(Float4 a, Float4 b) { return (Float4)wasm_f32x4_pmax((v128_t)b, (v128_t)a); }
static inline Float4 float4_sqrt(Float4 a) { return (Float4)wasm_f32x4_sqrt((v128_t)a); }
static inline bool float4_any(Float4Mask mask) { return wasm_v128_any_true((v128_t)mask); }
static inline unsigned float4_bits(Float4Mask mask) { return (unsigned)wasm_i32x4_bitmask((v128_t)mask); }
#else
static inline Float4 float4_min(Float4 a, Float4 b) { return float4_select(a < b, a, b); }
static inline Float4 float4_max(Float4 a, Float4 b) { return float4_select(a > b, a, b); }
#ifdef __aarch64__
static inline Float4 float4_sqrt(Float4 a) { return (Float4)vsqrtq_f32((float32x4_t)a); }
static inline bool float4_any(Float4Mask mask) { return vmaxvq_u32((uint32x4_t)mask) != 0; }
#else
static inline Float4 float4_sqrt(Float4 a) {
    for (int k = 0; k < 4; k++) a[k] = sqrtf(a[k]);
    return a;
}
static inline bool float4_any(Float4Mask mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }
#endif
static inline unsigned float4_bits(Float4Mask mask) {
    return (unsigned)((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
}
#endif

#ifdef __clang__
#define FLOAT4_SHUFFLE(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define FLOAT4_SHUFFLE(a, b, i, j, k, l) __builtin_shuffle(a, b, (Float4Mask){i, j, k, l})
#endif

/// Sets the fourth number to 0, or to `fourth`.
static inline Float4 float4_flat(Float4 a) { return (Float4)((Float4Mask)a & (Float4Mask){-1, -1, -1, 0}); }
static inline Float4 float4_with(Float4 a, float fourth) {
    return float4_select((Float4Mask){-1, -1, -1, 0}, a, float4_all(fourth));
}

/// Products of the first three numbers; the fourth of the cross product is 0.
static inline Float4 float4_cross(Float4 a, Float4 b) {
    Float4 turned = a * FLOAT4_SHUFFLE(b, b, 1, 2, 0, 3) - FLOAT4_SHUFFLE(a, a, 1, 2, 0, 3) * b;
    return FLOAT4_SHUFFLE(turned, turned, 1, 2, 0, 3);
}
static inline float float4_dot(Float4 a, Float4 b) {
    Float4 c = a * b;
    return c[0] + c[1] + c[2];
}

/// Four rows become four columns.
static inline void float4_transpose(Float4 q[4]) {
    Float4 xy01 = FLOAT4_SHUFFLE(q[0], q[1], 0, 4, 1, 5), zw01 = FLOAT4_SHUFFLE(q[0], q[1], 2, 6, 3, 7);
    Float4 xy23 = FLOAT4_SHUFFLE(q[2], q[3], 0, 4, 1, 5), zw23 = FLOAT4_SHUFFLE(q[2], q[3], 2, 6, 3, 7);
    q[0] = FLOAT4_SHUFFLE(xy01, xy23, 0, 1, 4, 5);
    q[1] = FLOAT4_SHUFFLE(xy01, xy23, 2, 3, 6, 7);
    q[2] = FLOAT4_SHUFFLE(zw01, zw23, 0, 1, 4, 5);
    q[3] = FLOAT4_SHUFFLE(zw01, zw23, 2, 3, 6, 7);
}

// As many floats at once as the instruction set of the file that includes it has, or four on every processor.
#pragma once

#include "common/float4.h"

#if defined(__AVX512DQ__) // x86-64-v4
#include <immintrin.h>
enum { WIDTH = 16 };
typedef float Wide __attribute__((vector_size(64)));
typedef int32_t WideMask __attribute__((vector_size(64))); ///< -1 where true, 0 elsewhere; or whole numbers

static inline Wide wide_min(Wide a, Wide b) { return (Wide)_mm512_min_ps((__m512)a, (__m512)b); }
static inline Wide wide_max(Wide a, Wide b) { return (Wide)_mm512_max_ps((__m512)a, (__m512)b); }
static inline Wide wide_sqrt(Wide a) { return (Wide)_mm512_sqrt_ps((__m512)a); }
static inline unsigned wide_bits(WideMask mask) { return _mm512_movepi32_mask((__m512i)mask); }
#elif defined(__AVX2__) // x86-64-v3
#include <immintrin.h>
enum { WIDTH = 8 };
typedef float Wide __attribute__((vector_size(32)));
typedef int32_t WideMask __attribute__((vector_size(32)));

static inline Wide wide_min(Wide a, Wide b) { return (Wide)_mm256_min_ps((__m256)a, (__m256)b); }
static inline Wide wide_max(Wide a, Wide b) { return (Wide)_mm256_max_ps((__m256)a, (__m256)b); }
static inline Wide wide_sqrt(Wide a) { return (Wide)_mm256_sqrt_ps((__m256)a); }
static inline unsigned wide_bits(WideMask mask) { return (unsigned)_mm256_movemask_ps((__m256)mask); }
#else
enum { WIDTH = 4 };
typedef Float4 Wide;
typedef Float4Mask WideMask;

static inline Wide wide_min(Wide a, Wide b) { return float4_min(a, b); }
static inline Wide wide_max(Wide a, Wide b) { return float4_max(a, b); }
static inline Wide wide_sqrt(Wide a) { return float4_sqrt(a); }
static inline unsigned wide_bits(WideMask mask) { return float4_bits(mask); }
#endif

typedef struct Wide3 {
    Wide x, y, z;
} Wide3;

static inline Wide wide_all(float a) { return a - (Wide){0}; }

static inline Wide wide_load(const float *p) {
    Wide a;
    memcpy(&a, p, sizeof a);
    return a;
}

static inline void wide_store(float *p, Wide a) { memcpy(p, &a, sizeof a); }

static inline Wide wide_select(WideMask mask, Wide yes, Wide no) {
    return (Wide)((mask & (WideMask)yes) | (~mask & (WideMask)no));
}

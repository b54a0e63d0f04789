// Packets of rays, sixteen at a time, for x86-64-v4 (AVX-512).
#ifdef __AVX512DQ__
#include <immintrin.h>
#include <stdint.h>

enum { WIDTH = 16 };
typedef float Wide __attribute__((vector_size(64)));
typedef int32_t WideMask __attribute__((vector_size(64)));

static inline Wide wide_min(Wide a, Wide b) { return (Wide)_mm512_min_ps((__m512)a, (__m512)b); }
static inline Wide wide_max(Wide a, Wide b) { return (Wide)_mm512_max_ps((__m512)a, (__m512)b); }
static inline unsigned wide_bits(WideMask mask) { return _mm512_movepi32_mask((__m512i)mask); }

#define BVH_WALK bvh_walk_v4
#include "preview/bvh_kernel.h"
#endif

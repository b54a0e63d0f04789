// Packets of rays, eight at a time, for x86-64-v3 (AVX2).
#ifdef __AVX2__
#include <immintrin.h>
#include <stdint.h>

enum { WIDTH = 8 };
typedef float Wide __attribute__((vector_size(32)));
typedef int32_t WideMask __attribute__((vector_size(32)));

static inline Wide wide_min(Wide a, Wide b) { return (Wide)_mm256_min_ps((__m256)a, (__m256)b); }
static inline Wide wide_max(Wide a, Wide b) { return (Wide)_mm256_max_ps((__m256)a, (__m256)b); }
static inline unsigned wide_bits(WideMask mask) { return (unsigned)_mm256_movemask_ps((__m256)mask); }

#define BVH_WALK bvh_walk_v3
#include "preview/bvh_kernel.h"
#endif

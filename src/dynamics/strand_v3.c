// Strands eight at a time, for x86-64-v3 (AVX2).
#ifdef __AVX2__
#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 8 };
typedef float Lanes __attribute__((vector_size(32)));
typedef struct Node {
    Lanes x, y, z, w;
} Node;

static inline Lanes lanes_all(float a) { return (Lanes)_mm256_set1_ps(a); }
static inline Lanes lanes_load(const float *p) { return (Lanes)_mm256_loadu_ps(p); }
static inline void lanes_store(float *p, Lanes a) { _mm256_storeu_ps(p, (__m256)a); }
static inline Lanes lanes_sqrt(Lanes a) { return (Lanes)_mm256_sqrt_ps((__m256)a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return (Lanes)_mm256_max_ps((__m256)a, (__m256)b); }
static inline Lanes lanes_where_positive(Lanes a, Lanes yes, Lanes no) {
    __m256 positive = _mm256_cmp_ps((__m256)a, _mm256_setzero_ps(), _CMP_GT_OQ);
    return (Lanes)_mm256_blendv_ps((__m256)no, (__m256)yes, positive);
}

/// The quadruples of lanes i and i + 4.
static inline __m256 lanes_quads(const float *position, const uint32_t *node, int i) {
    __m256 quads = _mm256_castps128_ps256(_mm_loadu_ps(position + node[i]));
    return _mm256_insertf128_ps(quads, _mm_loadu_ps(position + node[i + 4]), 1);
}

static inline Node lanes_gather(const float *position, const uint32_t *node) {
    __m256 q0 = lanes_quads(position, node, 0), q1 = lanes_quads(position, node, 1);
    __m256 q2 = lanes_quads(position, node, 2), q3 = lanes_quads(position, node, 3);
    __m256 xy01 = _mm256_unpacklo_ps(q0, q1), zw01 = _mm256_unpackhi_ps(q0, q1);
    __m256 xy23 = _mm256_unpacklo_ps(q2, q3), zw23 = _mm256_unpackhi_ps(q2, q3);
    return (Node){(Lanes)_mm256_shuffle_ps(xy01, xy23, 0x44), (Lanes)_mm256_shuffle_ps(xy01, xy23, 0xEE),
                  (Lanes)_mm256_shuffle_ps(zw01, zw23, 0x44), (Lanes)_mm256_shuffle_ps(zw01, zw23, 0xEE)};
}

static inline void lanes_add(float *x, __m128 delta) { _mm_storeu_ps(x, _mm_add_ps(_mm_loadu_ps(x), delta)); }

static inline void lanes_add_quads(float *position, const uint32_t *node, int i, __m256 quads) {
    lanes_add(position + node[i], _mm256_castps256_ps128(quads));
    lanes_add(position + node[i + 4], _mm256_extractf128_ps(quads, 1));
}

static inline void lanes_move(float *position, const uint32_t *node, Lanes dx, Lanes dy, Lanes dz) {
    __m256 zero = _mm256_setzero_ps();
    __m256 xy01 = _mm256_unpacklo_ps((__m256)dx, (__m256)dy), xy23 = _mm256_unpackhi_ps((__m256)dx, (__m256)dy);
    __m256 z01 = _mm256_unpacklo_ps((__m256)dz, zero), z23 = _mm256_unpackhi_ps((__m256)dz, zero);
    lanes_add_quads(position, node, 0, _mm256_shuffle_ps(xy01, z01, 0x44));
    lanes_add_quads(position, node, 1, _mm256_shuffle_ps(xy01, z01, 0xEE));
    lanes_add_quads(position, node, 2, _mm256_shuffle_ps(xy23, z23, 0x44));
    lanes_add_quads(position, node, 3, _mm256_shuffle_ps(xy23, z23, 0xEE));
}

#define STRAND_SOLVE strand_solve_v3
#include "dynamics/strand_kernel.h"
#endif

// Strands sixteen at a time, for x86-64-v4 (AVX-512).
#ifdef __AVX512F__
#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 16 };
typedef float Lanes __attribute__((vector_size(64)));
typedef struct Node {
    Lanes x, y, z, w;
} Node;

static inline Lanes lanes_all(float a) { return (Lanes)_mm512_set1_ps(a); }
static inline Lanes lanes_load(const float *p) { return (Lanes)_mm512_loadu_ps(p); }
static inline void lanes_store(float *p, Lanes a) { _mm512_storeu_ps(p, (__m512)a); }
static inline Lanes lanes_sqrt(Lanes a) { return (Lanes)_mm512_sqrt_ps((__m512)a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return (Lanes)_mm512_max_ps((__m512)a, (__m512)b); }
static inline Lanes lanes_where_positive(Lanes a, Lanes yes, Lanes no) {
    __mmask16 positive = _mm512_cmp_ps_mask((__m512)a, _mm512_setzero_ps(), _CMP_GT_OQ);
    return (Lanes)_mm512_mask_blend_ps(positive, (__m512)no, (__m512)yes);
}

/// The quadruples of lanes i, i + 4, i + 8 and i + 12.
static inline __m512 lanes_quads(const float *position, const uint32_t *node, int i) {
    __m512 quads = _mm512_castps128_ps512(_mm_loadu_ps(position + node[i]));
    quads = _mm512_insertf32x4(quads, _mm_loadu_ps(position + node[i + 4]), 1);
    quads = _mm512_insertf32x4(quads, _mm_loadu_ps(position + node[i + 8]), 2);
    return _mm512_insertf32x4(quads, _mm_loadu_ps(position + node[i + 12]), 3);
}

static inline Node lanes_gather(const float *position, const uint32_t *node) {
    __m512 q0 = lanes_quads(position, node, 0), q1 = lanes_quads(position, node, 1);
    __m512 q2 = lanes_quads(position, node, 2), q3 = lanes_quads(position, node, 3);
    __m512 xy01 = _mm512_unpacklo_ps(q0, q1), zw01 = _mm512_unpackhi_ps(q0, q1);
    __m512 xy23 = _mm512_unpacklo_ps(q2, q3), zw23 = _mm512_unpackhi_ps(q2, q3);
    return (Node){(Lanes)_mm512_shuffle_ps(xy01, xy23, 0x44), (Lanes)_mm512_shuffle_ps(xy01, xy23, 0xEE),
                  (Lanes)_mm512_shuffle_ps(zw01, zw23, 0x44), (Lanes)_mm512_shuffle_ps(zw01, zw23, 0xEE)};
}

static inline void lanes_add(float *x, __m128 delta) { _mm_storeu_ps(x, _mm_add_ps(_mm_loadu_ps(x), delta)); }

/// Adds the quadruples of lanes i, i + 4, i + 8 and i + 12.
static inline void lanes_add_quads(float *position, const uint32_t *node, int i, __m512 quads) {
    lanes_add(position + node[i], _mm512_castps512_ps128(quads));
    lanes_add(position + node[i + 4], _mm512_extractf32x4_ps(quads, 1));
    lanes_add(position + node[i + 8], _mm512_extractf32x4_ps(quads, 2));
    lanes_add(position + node[i + 12], _mm512_extractf32x4_ps(quads, 3));
}

static inline void lanes_move(float *position, const uint32_t *node, Lanes dx, Lanes dy, Lanes dz) {
    __m512 zero = _mm512_setzero_ps();
    __m512 xy01 = _mm512_unpacklo_ps((__m512)dx, (__m512)dy), xy23 = _mm512_unpackhi_ps((__m512)dx, (__m512)dy);
    __m512 z01 = _mm512_unpacklo_ps((__m512)dz, zero), z23 = _mm512_unpackhi_ps((__m512)dz, zero);
    lanes_add_quads(position, node, 0, _mm512_shuffle_ps(xy01, z01, 0x44));
    lanes_add_quads(position, node, 1, _mm512_shuffle_ps(xy01, z01, 0xEE));
    lanes_add_quads(position, node, 2, _mm512_shuffle_ps(xy23, z23, 0x44));
    lanes_add_quads(position, node, 3, _mm512_shuffle_ps(xy23, z23, 0xEE));
}

#define STRAND_SOLVE strand_solve_v4
#include "dynamics/strand_kernel.h"
#endif

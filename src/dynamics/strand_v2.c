// Strands four at a time, for x86-64-v2 (SSE 4.2).
#ifdef __SSE4_2__
#include <nmmintrin.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 4 };
typedef float Lanes __attribute__((vector_size(16)));
typedef struct Node {
    Lanes x, y, z, w;
} Node;

static inline Lanes lanes_all(float a) { return (Lanes)_mm_set1_ps(a); }
static inline Lanes lanes_load(const float *p) { return (Lanes)_mm_loadu_ps(p); }
static inline void lanes_store(float *p, Lanes a) { _mm_storeu_ps(p, (__m128)a); }
static inline Lanes lanes_sqrt(Lanes a) { return (Lanes)_mm_sqrt_ps((__m128)a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return (Lanes)_mm_max_ps((__m128)a, (__m128)b); }
static inline Lanes lanes_where_positive(Lanes a, Lanes yes, Lanes no) {
    return (Lanes)_mm_blendv_ps((__m128)no, (__m128)yes, _mm_cmpgt_ps((__m128)a, _mm_setzero_ps()));
}

static inline Node lanes_gather(const float *position, const uint32_t *node) {
    __m128 q0 = _mm_loadu_ps(position + node[0]), q1 = _mm_loadu_ps(position + node[1]);
    __m128 q2 = _mm_loadu_ps(position + node[2]), q3 = _mm_loadu_ps(position + node[3]);
    __m128 xy01 = _mm_unpacklo_ps(q0, q1), zw01 = _mm_unpackhi_ps(q0, q1);
    __m128 xy23 = _mm_unpacklo_ps(q2, q3), zw23 = _mm_unpackhi_ps(q2, q3);
    return (Node){(Lanes)_mm_shuffle_ps(xy01, xy23, 0x44), (Lanes)_mm_shuffle_ps(xy01, xy23, 0xEE),
                  (Lanes)_mm_shuffle_ps(zw01, zw23, 0x44), (Lanes)_mm_shuffle_ps(zw01, zw23, 0xEE)};
}

static inline void lanes_add(float *x, __m128 delta) { _mm_storeu_ps(x, _mm_add_ps(_mm_loadu_ps(x), delta)); }

static inline void lanes_move(float *position, const uint32_t *node, Lanes dx, Lanes dy, Lanes dz) {
    __m128 zero = _mm_setzero_ps();
    __m128 xy01 = _mm_unpacklo_ps((__m128)dx, (__m128)dy), xy23 = _mm_unpackhi_ps((__m128)dx, (__m128)dy);
    __m128 z01 = _mm_unpacklo_ps((__m128)dz, zero), z23 = _mm_unpackhi_ps((__m128)dz, zero);
    lanes_add(position + node[0], _mm_shuffle_ps(xy01, z01, 0x44));
    lanes_add(position + node[1], _mm_shuffle_ps(xy01, z01, 0xEE));
    lanes_add(position + node[2], _mm_shuffle_ps(xy23, z23, 0x44));
    lanes_add(position + node[3], _mm_shuffle_ps(xy23, z23, 0xEE));
}

#define STRAND_SOLVE strand_solve_v2
#include "dynamics/strand_kernel.h"
#endif

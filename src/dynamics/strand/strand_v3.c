// Strands and attachments eight at a time, for x86-64-v3 (AVX2).
#ifdef __AVX2__
#include <immintrin.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 8 };
typedef float Lanes __attribute__((vector_size(32)));
typedef struct LaneNode {
    Lanes x, y, z, w;
} LaneNode;
/// Quadruples of a particle each: [e] those of lanes e and e + 4.
typedef struct Float4s {
    __m256 at[4];
} Float4s;

static inline Lanes lanes_all(float a) { return (Lanes)_mm256_set1_ps(a); }
static inline Lanes lanes_load(const float *p) { return (Lanes)_mm256_loadu_ps(p); }
static inline void lanes_store(float *p, Lanes a) { _mm256_storeu_ps(p, (__m256)a); }
static inline Lanes lanes_sqrt(Lanes a) { return (Lanes)_mm256_sqrt_ps((__m256)a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return (Lanes)_mm256_max_ps((__m256)a, (__m256)b); }
static inline bool lanes_any_less(Lanes a, Lanes b) {
    return _mm256_movemask_ps(_mm256_cmp_ps((__m256)a, (__m256)b, _CMP_LT_OQ)) != 0;
}
static inline Lanes lanes_where_less(Lanes a, Lanes b, Lanes yes, Lanes no) {
    return (Lanes)_mm256_blendv_ps((__m256)no, (__m256)yes, _mm256_cmp_ps((__m256)a, (__m256)b, _CMP_LT_OQ));
}

static inline Float4s float4s_load_contiguous(const float *x, size_t stride) {
    return (Float4s){{_mm256_loadu_ps(x), _mm256_loadu_ps(x + stride), _mm256_loadu_ps(x + 2 * stride),
                      _mm256_loadu_ps(x + 3 * stride)}};
}

static inline void float4s_store_contiguous(float *x, size_t stride, const Float4s *float4s) {
    for (size_t e = 0; e < 4; e++) _mm256_storeu_ps(x + e * stride, float4s->at[e]);
}

static inline Float4s float4s_gather(const float *position, const uint32_t *node) {
    Float4s float4s;
    for (int e = 0; e < 4; e++) {
        __m256 q = _mm256_castps128_ps256(_mm_loadu_ps(position + node[e]));
        float4s.at[e] = _mm256_insertf128_ps(q, _mm_loadu_ps(position + node[e + 4]), 1);
    }

    return float4s;
}

static inline void float4s_scatter(float *position, const uint32_t *node, const Float4s *float4s) {
    for (int e = 0; e < 4; e++) {
        _mm_storeu_ps(position + node[e], _mm256_castps256_ps128(float4s->at[e]));
        _mm_storeu_ps(position + node[e + 4], _mm256_extractf128_ps(float4s->at[e], 1));
    }
}

static inline LaneNode float4s_node(const Float4s *float4s) {
    const __m256 *q = float4s->at;
    __m256 xy01 = _mm256_unpacklo_ps(q[0], q[1]), zw01 = _mm256_unpackhi_ps(q[0], q[1]);
    __m256 xy23 = _mm256_unpacklo_ps(q[2], q[3]), zw23 = _mm256_unpackhi_ps(q[2], q[3]);
    return (LaneNode){(Lanes)_mm256_shuffle_ps(xy01, xy23, 0x44), (Lanes)_mm256_shuffle_ps(xy01, xy23, 0xEE),
                      (Lanes)_mm256_shuffle_ps(zw01, zw23, 0x44), (Lanes)_mm256_shuffle_ps(zw01, zw23, 0xEE)};
}

static inline Float4s float4s_add(const Float4s *a, const Float4s *b) {
    return (Float4s){{a->at[0] + b->at[0], a->at[1] + b->at[1], a->at[2] + b->at[2], a->at[3] + b->at[3]}};
}

static inline Float4s float4s_sub(const Float4s *a, const Float4s *b) {
    return (Float4s){{a->at[0] - b->at[0], a->at[1] - b->at[1], a->at[2] - b->at[2], a->at[3] - b->at[3]}};
}

#define FLOAT4_CORRECTION(e) \
    _mm256_mul_ps(_mm256_sub_ps(b->at[e], a->at[e]), _mm256_permute_ps((__m256)factor, (e)*0x55))
static inline Float4s float4s_correction(const Float4s *a, const Float4s *b, Lanes factor) {
    return (Float4s){{FLOAT4_CORRECTION(0), FLOAT4_CORRECTION(1), FLOAT4_CORRECTION(2), FLOAT4_CORRECTION(3)}};
}

static inline void float4s_move(Float4s *x, const Float4s *forth, const Float4s *back) {
    for (int e = 0; e < 4; e++) {
        __m256 w = _mm256_permute_ps(x->at[e], 0xFF), correction = _mm256_sub_ps(forth->at[e], back->at[e]);
        x->at[e] = _mm256_blend_ps(_mm256_add_ps(x->at[e], _mm256_mul_ps(w, correction)), x->at[e], 0x88);
    }
}

/// x += (x - anchor) factor.
static inline void float4s_pull(Float4s *x, const float *anchor, Lanes factor) {
    __m256 a = _mm256_setr_ps(anchor[0], anchor[1], anchor[2], 0, anchor[0], anchor[1], anchor[2], 0);
    Float4s from = {{a, a, a, a}}, displacement = float4s_correction(&from, x, factor);
    for (int e = 0; e < 4; e++) x->at[e] = _mm256_blend_ps(_mm256_add_ps(x->at[e], displacement.at[e]), x->at[e], 0x88);
}

// Quadruples of a particle each, two in a vector.

static inline Lanes lanes_quadruple(const float p[4]) { return (Lanes)_mm256_broadcast_ps((const __m128 *)p); }
static inline Lanes lanes_fourths(Lanes a) { return (Lanes)_mm256_permute_ps((__m256)a, 0xFF); }
/// Sums of each quadruple's first three numbers.
static inline Lanes lanes_sums(Lanes a) {
    return (Lanes)_mm256_permute_ps((__m256)a, 0) + (Lanes)_mm256_permute_ps((__m256)a, 0x55) +
           (Lanes)_mm256_permute_ps((__m256)a, 0xAA);
}
static inline Lanes lanes_abs(Lanes a) { return (Lanes)_mm256_andnot_ps(_mm256_set1_ps(-0.0f), (__m256)a); }
static inline Lanes lanes_with_fourth(Lanes a, Lanes fourth) {
    return (Lanes)_mm256_blend_ps((__m256)a, (__m256)fourth, 0x88);
}

#define ATTACH_HOLD attach_hold_v3
#define STRAND_SOLVE strand_solve_v3
#define STRAND_BEND strand_bend_v3
#define STRAND_NARROWER strand_solve_v2
#define BEND_NARROWER strand_bend_v2
#define LANES_SPREAD(a, e) (Lanes) _mm256_permute_ps((__m256)(a), (e)*0x55)
#define FLOAT4S_SET(float4s, e, value) (float4s).at[e] = (__m256)(value)
#define SMOOTH_GROUP smooth_group_v3
#define SMOOTH_NARROWER smooth_group_four
#define HEIGHT_RANGE height_range_v3
#define HEIGHT_NARROWER height_range_four
#define PLANE_RANGE plane_range_v3
#define PLANE_NARROWER plane_range_four
#define MOVE_RANGE move_range_v3
#define UNIT_RANGE unit_range_v3
#define UNIT_NARROWER unit_range_four
#define MOVE_NARROWER move_range_four
#include "dynamics/attach_kernel.h"
#include "dynamics/strand/strand_kernel.h"
#include "dynamics/curvature_kernel.h"
#include "dynamics/height_kernel.h"
#include "dynamics/plane_kernel.h"
#include "dynamics/move_kernel.h"
#include "dynamics/smooth_kernel.h"
#endif

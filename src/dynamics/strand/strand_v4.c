// Strands and attachments sixteen at a time, for x86-64-v4 (AVX-512).
#ifdef __AVX512F__
#include <immintrin.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 16 };
typedef float Lanes __attribute__((vector_size(64)));
typedef struct LaneNode {
    Lanes x, y, z, w;
} LaneNode;
/// Quadruples of a particle each: [e] those of lanes e, e + 4, e + 8 and e + 12.
typedef struct Float4s {
    __m512 at[4];
} Float4s;

static inline Lanes lanes_all(float a) { return (Lanes)_mm512_set1_ps(a); }
static inline Lanes lanes_load(const float *p) { return (Lanes)_mm512_loadu_ps(p); }
static inline void lanes_store(float *p, Lanes a) { _mm512_storeu_ps(p, (__m512)a); }
static inline Lanes lanes_sqrt(Lanes a) { return (Lanes)_mm512_sqrt_ps((__m512)a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return (Lanes)_mm512_max_ps((__m512)a, (__m512)b); }
static inline bool lanes_any_less(Lanes a, Lanes b) {
    return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ) != 0;
}
static inline Lanes lanes_where_less(Lanes a, Lanes b, Lanes yes, Lanes no) {
    __mmask16 less = _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
    return (Lanes)_mm512_mask_blend_ps(less, (__m512)no, (__m512)yes);
}

static inline Float4s float4s_load_contiguous(const float *x, size_t stride) {
    return (Float4s){{_mm512_loadu_ps(x), _mm512_loadu_ps(x + stride), _mm512_loadu_ps(x + 2 * stride),
                      _mm512_loadu_ps(x + 3 * stride)}};
}

static inline void float4s_store_contiguous(float *x, size_t stride, const Float4s *float4s) {
    for (size_t e = 0; e < 4; e++) _mm512_storeu_ps(x + e * stride, float4s->at[e]);
}

static inline Float4s float4s_gather(const float *position, const uint32_t *node) {
    Float4s float4s;
    for (int e = 0; e < 4; e++) {
        __m512 q = _mm512_castps128_ps512(_mm_loadu_ps(position + node[e]));
        q = _mm512_insertf32x4(q, _mm_loadu_ps(position + node[e + 4]), 1);
        q = _mm512_insertf32x4(q, _mm_loadu_ps(position + node[e + 8]), 2);
        float4s.at[e] = _mm512_insertf32x4(q, _mm_loadu_ps(position + node[e + 12]), 3);
    }

    return float4s;
}

static inline void float4s_scatter(float *position, const uint32_t *node, const Float4s *float4s) {
    for (int e = 0; e < 4; e++) {
        _mm_storeu_ps(position + node[e], _mm512_castps512_ps128(float4s->at[e]));
        _mm_storeu_ps(position + node[e + 4], _mm512_extractf32x4_ps(float4s->at[e], 1));
        _mm_storeu_ps(position + node[e + 8], _mm512_extractf32x4_ps(float4s->at[e], 2));
        _mm_storeu_ps(position + node[e + 12], _mm512_extractf32x4_ps(float4s->at[e], 3));
    }
}

static inline LaneNode float4s_node(const Float4s *float4s) {
    const __m512 *q = float4s->at;
    __m512 xy01 = _mm512_unpacklo_ps(q[0], q[1]), zw01 = _mm512_unpackhi_ps(q[0], q[1]);
    __m512 xy23 = _mm512_unpacklo_ps(q[2], q[3]), zw23 = _mm512_unpackhi_ps(q[2], q[3]);
    return (LaneNode){(Lanes)_mm512_shuffle_ps(xy01, xy23, 0x44), (Lanes)_mm512_shuffle_ps(xy01, xy23, 0xEE),
                      (Lanes)_mm512_shuffle_ps(zw01, zw23, 0x44), (Lanes)_mm512_shuffle_ps(zw01, zw23, 0xEE)};
}

static inline Float4s float4s_add(const Float4s *a, const Float4s *b) {
    return (Float4s){{a->at[0] + b->at[0], a->at[1] + b->at[1], a->at[2] + b->at[2], a->at[3] + b->at[3]}};
}

static inline Float4s float4s_sub(const Float4s *a, const Float4s *b) {
    return (Float4s){{a->at[0] - b->at[0], a->at[1] - b->at[1], a->at[2] - b->at[2], a->at[3] - b->at[3]}};
}

#define FLOAT4_CORRECTION(e) \
    _mm512_mul_ps(_mm512_sub_ps(b->at[e], a->at[e]), _mm512_permute_ps((__m512)factor, (e)*0x55))
static inline Float4s float4s_correction(const Float4s *a, const Float4s *b, Lanes factor) {
    return (Float4s){{FLOAT4_CORRECTION(0), FLOAT4_CORRECTION(1), FLOAT4_CORRECTION(2), FLOAT4_CORRECTION(3)}};
}

static inline void float4s_move(Float4s *x, const Float4s *forth, const Float4s *back) {
    for (int e = 0; e < 4; e++) {
        __m512 w = _mm512_permute_ps(x->at[e], 0xFF), correction = _mm512_sub_ps(forth->at[e], back->at[e]);
        x->at[e] = _mm512_add_ps(x->at[e], _mm512_maskz_mul_ps(0x7777, w, correction));
    }
}

/// x += (x - anchor) factor.
static inline void float4s_pull(Float4s *x, const float *anchor, Lanes factor) {
    __m512 a = _mm512_broadcast_f32x4(_mm_setr_ps(anchor[0], anchor[1], anchor[2], 0));
    Float4s from = {{a, a, a, a}}, displacement = float4s_correction(&from, x, factor);
    for (int e = 0; e < 4; e++) x->at[e] = _mm512_mask_add_ps(x->at[e], 0x7777, x->at[e], displacement.at[e]);
}

// Quadruples of a particle each, four in a vector.

static inline Lanes lanes_quadruple(const float p[4]) { return (Lanes)_mm512_broadcast_f32x4(_mm_loadu_ps(p)); }
static inline Lanes lanes_fourths(Lanes a) { return (Lanes)_mm512_permute_ps((__m512)a, 0xFF); }
/// Sums of each quadruple's first three numbers.
static inline Lanes lanes_sums(Lanes a) {
    return (Lanes)_mm512_permute_ps((__m512)a, 0) + (Lanes)_mm512_permute_ps((__m512)a, 0x55) +
           (Lanes)_mm512_permute_ps((__m512)a, 0xAA);
}
static inline Lanes lanes_abs(Lanes a) { return (Lanes)_mm512_abs_ps((__m512)a); }
static inline Lanes lanes_with_fourth(Lanes a, Lanes fourth) {
    return (Lanes)_mm512_mask_blend_ps(0x8888, (__m512)a, (__m512)fourth);
}

#define ATTACH_HOLD attach_hold_v4
#define STRAND_SOLVE strand_solve_v4
#define STRAND_BEND strand_bend_v4
#define STRAND_NARROWER strand_solve_v3
#define BEND_NARROWER strand_bend_v3
#define LANES_SPREAD(a, e) (Lanes) _mm512_permute_ps((__m512)(a), (e)*0x55)
#define FLOAT4S_SET(float4s, e, value) (float4s).at[e] = (__m512)(value)
#define SMOOTH_GROUP smooth_group_v4
#define SMOOTH_NARROWER smooth_group_v3
#define HEIGHT_RANGE height_range_v4
#define HEIGHT_NARROWER height_range_v3
#define PLANE_RANGE plane_range_v4
#define PLANE_NARROWER plane_range_v3
#define MOVE_RANGE move_range_v4
#define UNIT_RANGE unit_range_v4
#define UNIT_NARROWER unit_range_v3
#define MOVE_NARROWER move_range_v3
#include "dynamics/attach_kernel.h"
#include "dynamics/strand/strand_kernel.h"
#include "dynamics/curvature_kernel.h"
#include "dynamics/height_kernel.h"
#include "dynamics/plane_kernel.h"
#include "dynamics/move_kernel.h"
#include "dynamics/smooth_kernel.h"
#endif

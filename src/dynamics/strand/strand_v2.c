// Strands and attachments four at a time, for x86-64-v2 (SSE 4.2).
#ifdef __SSE4_2__
#include <nmmintrin.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 4 };
typedef float Lanes __attribute__((vector_size(16)));
typedef struct LaneNode {
    Lanes x, y, z, w;
} LaneNode;
/// Quadruples of a particle each, a lane each.
typedef struct Float4s {
    __m128 at[4];
} Float4s;

static inline Lanes lanes_all(float a) { return (Lanes)_mm_set1_ps(a); }
static inline Lanes lanes_load(const float *p) { return (Lanes)_mm_loadu_ps(p); }
static inline void lanes_store(float *p, Lanes a) { _mm_storeu_ps(p, (__m128)a); }
static inline Lanes lanes_sqrt(Lanes a) { return (Lanes)_mm_sqrt_ps((__m128)a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return (Lanes)_mm_max_ps((__m128)a, (__m128)b); }
static inline bool lanes_any_less(Lanes a, Lanes b) { return _mm_movemask_ps(_mm_cmplt_ps((__m128)a, (__m128)b)) != 0; }
static inline Lanes lanes_where_less(Lanes a, Lanes b, Lanes yes, Lanes no) {
    return (Lanes)_mm_blendv_ps((__m128)no, (__m128)yes, _mm_cmplt_ps((__m128)a, (__m128)b));
}

static inline Float4s float4s_load_contiguous(const float *x, size_t stride) {
    return (Float4s){
        {_mm_loadu_ps(x), _mm_loadu_ps(x + stride), _mm_loadu_ps(x + 2 * stride), _mm_loadu_ps(x + 3 * stride)}};
}

static inline void float4s_store_contiguous(float *x, size_t stride, const Float4s *float4s) {
    for (size_t e = 0; e < 4; e++) _mm_storeu_ps(x + e * stride, float4s->at[e]);
}

static inline Float4s float4s_gather(const float *position, const uint32_t *node) {
    return (Float4s){{_mm_loadu_ps(position + node[0]), _mm_loadu_ps(position + node[1]),
                      _mm_loadu_ps(position + node[2]), _mm_loadu_ps(position + node[3])}};
}

static inline void float4s_scatter(float *position, const uint32_t *node, const Float4s *float4s) {
    for (int e = 0; e < 4; e++) _mm_storeu_ps(position + node[e], float4s->at[e]);
}

static inline LaneNode float4s_node(const Float4s *float4s) {
    const __m128 *q = float4s->at;
    __m128 xy01 = _mm_unpacklo_ps(q[0], q[1]), zw01 = _mm_unpackhi_ps(q[0], q[1]);
    __m128 xy23 = _mm_unpacklo_ps(q[2], q[3]), zw23 = _mm_unpackhi_ps(q[2], q[3]);
    return (LaneNode){(Lanes)_mm_shuffle_ps(xy01, xy23, 0x44), (Lanes)_mm_shuffle_ps(xy01, xy23, 0xEE),
                      (Lanes)_mm_shuffle_ps(zw01, zw23, 0x44), (Lanes)_mm_shuffle_ps(zw01, zw23, 0xEE)};
}

#define FLOAT4_CORRECTION(e) \
    _mm_mul_ps(_mm_sub_ps(b->at[e], a->at[e]), _mm_shuffle_ps((__m128)factor, (__m128)factor, (e)*0x55))
static inline Float4s float4s_correction(const Float4s *a, const Float4s *b, Lanes factor) {
    return (Float4s){{FLOAT4_CORRECTION(0), FLOAT4_CORRECTION(1), FLOAT4_CORRECTION(2), FLOAT4_CORRECTION(3)}};
}

static inline void float4s_move(Float4s *x, const Float4s *forth, const Float4s *back) {
    for (int e = 0; e < 4; e++) {
        __m128 w = _mm_shuffle_ps(x->at[e], x->at[e], 0xFF), correction = _mm_sub_ps(forth->at[e], back->at[e]);
        x->at[e] = _mm_blend_ps(_mm_add_ps(x->at[e], _mm_mul_ps(w, correction)), x->at[e], 8);
    }
}

/// x += (x - anchor) factor.
static inline void float4s_pull(Float4s *x, const float *anchor, Lanes factor) {
    __m128 a = _mm_setr_ps(anchor[0], anchor[1], anchor[2], 0);
    Float4s from = {{a, a, a, a}}, displacement = float4s_correction(&from, x, factor);
    for (int e = 0; e < 4; e++) x->at[e] = _mm_blend_ps(_mm_add_ps(x->at[e], displacement.at[e]), x->at[e], 8);
}

#define ATTACH_HOLD attach_hold_v2
#define STRAND_SOLVE strand_solve_v2
#define STRAND_BEND strand_bend_v2
#include "dynamics/attach_kernel.h"
#include "dynamics/strand/strand_kernel.h"
#include "dynamics/curvature_kernel.h"
#endif

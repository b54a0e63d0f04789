// Strands and attachments four at a time, by the vector arithmetic of gcc and clang. Any processor with registers of four
// floats can run this. The file that includes it names the three kernels: ATTACH_HOLD, STRAND_SOLVE and STRAND_BEND.
#include "common/float4.h"

#include <stdbool.h>
#include <stddef.h>

enum { LANES = 4 };
typedef Float4 Lanes;
typedef struct LaneNode {
    Lanes x, y, z, w;
} LaneNode;
/// Quadruples of a particle each, a lane each.
typedef struct Float4s {
    Float4 at[4];
} Float4s;

static inline Lanes lanes_all(float a) { return float4_all(a); }
static inline Lanes lanes_load(const float *p) { return float4_load(p); }
static inline void lanes_store(float *p, Lanes a) { float4_store(p, a); }
static inline Lanes lanes_sqrt(Lanes a) { return float4_sqrt(a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return float4_max(a, b); }
static inline bool lanes_any_less(Lanes a, Lanes b) { return float4_any(a < b); }
static inline Lanes lanes_where_less(Lanes a, Lanes b, Lanes yes, Lanes no) { return float4_select(a < b, yes, no); }

static inline Float4s float4s_load_contiguous(const float *x, size_t stride) {
    return (Float4s){
        {float4_load(x), float4_load(x + stride), float4_load(x + 2 * stride), float4_load(x + 3 * stride)}};
}

static inline void float4s_store_contiguous(float *x, size_t stride, const Float4s *float4s) {
    for (size_t e = 0; e < 4; e++) float4_store(x + e * stride, float4s->at[e]);
}

static inline Float4s float4s_gather(const float *position, const uint32_t *node) {
    return (Float4s){{float4_load(position + node[0]), float4_load(position + node[1]), float4_load(position + node[2]),
                      float4_load(position + node[3])}};
}

static inline void float4s_scatter(float *position, const uint32_t *node, const Float4s *float4s) {
    for (int e = 0; e < 4; e++) float4_store(position + node[e], float4s->at[e]);
}

static inline LaneNode float4s_node(const Float4s *float4s) {
    Float4 q[4] = {float4s->at[0], float4s->at[1], float4s->at[2], float4s->at[3]};
    float4_transpose(q);
    return (LaneNode){q[0], q[1], q[2], q[3]};
}

static inline Float4s float4s_add(const Float4s *a, const Float4s *b) {
    return (Float4s){{a->at[0] + b->at[0], a->at[1] + b->at[1], a->at[2] + b->at[2], a->at[3] + b->at[3]}};
}

static inline Float4s float4s_sub(const Float4s *a, const Float4s *b) {
    return (Float4s){{a->at[0] - b->at[0], a->at[1] - b->at[1], a->at[2] - b->at[2], a->at[3] - b->at[3]}};
}

static inline Float4s float4s_correction(const Float4s *a, const Float4s *b, Lanes factor) {
    Float4s correction;
    for (int e = 0; e < 4; e++) correction.at[e] = (b->at[e] - a->at[e]) * float4_all(factor[e]);
    return correction;
}

/// Adds to the first three numbers; the fourth stays.
static inline Float4 float4_add_position(Float4 x, Float4 displacement) {
    return FLOAT4_SHUFFLE(x + displacement, x, 0, 1, 2, 7);
}

static inline void float4s_move(Float4s *x, const Float4s *forth, const Float4s *back) {
    for (int e = 0; e < 4; e++)
        x->at[e] = float4_add_position(x->at[e], float4_all(x->at[e][3]) * (forth->at[e] - back->at[e]));
}

/// x += (x - anchor) factor.
static inline void float4s_pull(Float4s *x, const float *anchor, Lanes factor) {
    Float4 a = {anchor[0], anchor[1], anchor[2], 0};
    Float4s from = {{a, a, a, a}}, displacement = float4s_correction(&from, x, factor);
    for (int e = 0; e < 4; e++) x->at[e] = float4_add_position(x->at[e], displacement.at[e]);
}

#ifdef STRAND_SOLVE
#include "dynamics/attach_kernel.h"
#include "dynamics/strand/strand_kernel.h"
#include "dynamics/curvature_kernel.h"
#endif

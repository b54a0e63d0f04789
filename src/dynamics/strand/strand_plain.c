// Strands and attachments one at a time, for processors without a kernel of their own.
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 1 };
typedef float Lanes;
typedef struct LaneNode {
    Lanes x, y, z, w;
} LaneNode;
typedef LaneNode Float4s;

static inline Lanes lanes_all(float a) { return a; }
static inline Lanes lanes_load(const float *p) { return *p; }
static inline void lanes_store(float *p, Lanes a) { *p = a; }
static inline Lanes lanes_sqrt(Lanes a) { return sqrtf(a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return a > b ? a : b; }
static inline bool lanes_any_less(Lanes a, Lanes b) { return a < b; }
static inline Lanes lanes_where_less(Lanes a, Lanes b, Lanes yes, Lanes no) { return a < b ? yes : no; }

static inline Float4s float4s_load_contiguous(const float *x, size_t stride) {
    (void)stride;
    return (Float4s){x[0], x[1], x[2], x[3]};
}

static inline void float4s_store_contiguous(float *x, size_t stride, const Float4s *float4s) {
    (void)stride;
    x[0] = float4s->x;
    x[1] = float4s->y;
    x[2] = float4s->z;
}

static inline Float4s float4s_gather(const float *position, const uint32_t *node) {
    return float4s_load_contiguous(position + *node, 0);
}

static inline void float4s_scatter(float *position, const uint32_t *node, const Float4s *float4s) {
    float4s_store_contiguous(position + *node, 0, float4s);
}

static inline LaneNode float4s_node(const Float4s *float4s) { return *float4s; }

static inline Float4s float4s_add(const Float4s *a, const Float4s *b) {
    return (Float4s){a->x + b->x, a->y + b->y, a->z + b->z, 0};
}

static inline Float4s float4s_sub(const Float4s *a, const Float4s *b) {
    return (Float4s){a->x - b->x, a->y - b->y, a->z - b->z, 0};
}

static inline Float4s float4s_correction(const Float4s *a, const Float4s *b, Lanes factor) {
    return (Float4s){(b->x - a->x) * factor, (b->y - a->y) * factor, (b->z - a->z) * factor, 0};
}

static inline void float4s_move(Float4s *x, const Float4s *forth, const Float4s *back) {
    x->x += x->w * (forth->x - back->x);
    x->y += x->w * (forth->y - back->y);
    x->z += x->w * (forth->z - back->z);
}

/// x += (x - anchor) factor.
static inline void float4s_pull(Float4s *x, const float *anchor, Lanes factor) {
    x->x += (x->x - anchor[0]) * factor;
    x->y += (x->y - anchor[1]) * factor;
    x->z += (x->z - anchor[2]) * factor;
}

#define ATTACH_HOLD attach_hold_plain
#define STRAND_SOLVE strand_solve_plain
#define STRAND_BEND strand_bend_plain
#include "dynamics/attach_kernel.h"
#include "dynamics/strand/strand_kernel.h"
#include "dynamics/curvature_kernel.h"

// Strands and attachments one at a time, for processors without a kernel of their own.
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 1 };
typedef float Lanes;
typedef struct Node {
    Lanes x, y, z, w;
} Node;
typedef Node Quads;

static inline Lanes lanes_all(float a) { return a; }
static inline Lanes lanes_load(const float *p) { return *p; }
static inline void lanes_store(float *p, Lanes a) { *p = a; }
static inline Lanes lanes_sqrt(Lanes a) { return sqrtf(a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return a > b ? a : b; }
static inline bool lanes_any_less(Lanes a, Lanes b) { return a < b; }
static inline Lanes lanes_where_less(Lanes a, Lanes b, Lanes yes, Lanes no) { return a < b ? yes : no; }

static inline Quads quads_beside(const float *x, size_t stride) {
    (void)stride;
    return (Quads){x[0], x[1], x[2], x[3]};
}

static inline void quads_put_beside(float *x, size_t stride, const Quads *quads) {
    (void)stride;
    x[0] = quads->x, x[1] = quads->y, x[2] = quads->z;
}

static inline Quads quads_apart(const float *position, const uint32_t *node) {
    return quads_beside(position + *node, 0);
}

static inline void quads_put_apart(float *position, const uint32_t *node, const Quads *quads) {
    quads_put_beside(position + *node, 0, quads);
}

static inline Node quads_node(const Quads *quads) { return *quads; }

static inline Quads quads_push(const Quads *a, const Quads *b, Lanes factor) {
    return (Quads){(b->x - a->x) * factor, (b->y - a->y) * factor, (b->z - a->z) * factor, 0};
}

static inline void quads_move(Quads *x, const Quads *forth, const Quads *back) {
    x->x += x->w * (forth->x - back->x);
    x->y += x->w * (forth->y - back->y);
    x->z += x->w * (forth->z - back->z);
}

/// x += (x - anchor) factor.
static inline void quads_pull(Quads *x, const float *anchor, Lanes factor) {
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

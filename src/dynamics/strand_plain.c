// Strands one at a time, for processors without a kernel of their own.
#include <math.h>
#include <stddef.h>
#include <stdint.h>

enum { LANES = 1 };
typedef float Lanes;
typedef struct Node {
    Lanes x, y, z, w;
} Node;

static inline Lanes lanes_all(float a) { return a; }
static inline Lanes lanes_load(const float *p) { return *p; }
static inline void lanes_store(float *p, Lanes a) { *p = a; }
static inline Lanes lanes_sqrt(Lanes a) { return sqrtf(a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return a > b ? a : b; }
static inline Lanes lanes_where_positive(Lanes a, Lanes yes, Lanes no) { return a > 0 ? yes : no; }

static inline Node lanes_gather(const float *position, const uint32_t *node) {
    const float *x = position + *node;
    return (Node){x[0], x[1], x[2], x[3]};
}

static inline void lanes_move(float *position, const uint32_t *node, Lanes dx, Lanes dy, Lanes dz) {
    float *x = position + *node;
    x[0] += dx, x[1] += dy, x[2] += dz;
}

#define STRAND_SOLVE strand_solve_plain
#include "dynamics/strand_kernel.h"

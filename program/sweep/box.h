// Axis-aligned boxes.
#ifndef SWEEP_BOX_H
#define SWEEP_BOX_H

#include <math.h>
#include <stdbool.h>

typedef struct Box {
    double min[3], max[3]; ///< m; an empty box has min above max
} Box;

static inline Box box_empty(void) {
    return (Box){{(double)INFINITY, (double)INFINITY, (double)INFINITY},
                 {-(double)INFINITY, -(double)INFINITY, -(double)INFINITY}};
}

static inline bool box_is_empty(const Box *box) { return !(box->min[0] <= box->max[0]); }

/// Extends the box by the cube around `position` (m) with half side `around` (m).
static inline void box_add(Box *box, const float position[3], const double around[3]) {
    for (int k = 0; k < 3; k++) {
        box->min[k] = fmin(box->min[k], (double)position[k] - around[k]);
        box->max[k] = fmax(box->max[k], (double)position[k] + around[k]);
    }
}

static inline Box box_union(const Box *a, const Box *b) {
    Box both;
    for (int k = 0; k < 3; k++) both.min[k] = fmin(a->min[k], b->min[k]), both.max[k] = fmax(a->max[k], b->max[k]);
    return both;
}

/// Distance, m; 0 if they overlap, INFINITY if one is empty.
static inline double box_gap(const Box *a, const Box *b) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double gap = fmax(0, fmax(a->min[k] - b->max[k], b->min[k] - a->max[k]));
        sum += gap * gap;
    }
    return sqrt(sum);
}

/// m; 0 for an empty box.
static inline double box_diagonal(const Box *box) {
    double sum = 0;
    for (int k = 0; k < 3 && !box_is_empty(box); k++) sum += (box->max[k] - box->min[k]) * (box->max[k] - box->min[k]);
    return sqrt(sum);
}

#endif

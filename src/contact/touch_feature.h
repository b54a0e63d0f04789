// Which features of two cells are near each other.
#ifndef CONTACT_TOUCH_FEATURE_H
#define CONTACT_TOUCH_FEATURE_H

#include "contact/touch_plan.h"

/// A cell's nodes about an origin, and all that follows from them.
typedef struct TouchCell {
    Quad node[5];        ///< fourth numbers are 0
    FourVectors corner;  ///< 0 to 3
    FourVectors turned;  ///< 1, 2, 3, 0
    uint32_t owned;      ///< bit i: node i is this cell's, the middle too; bit 8 + i: edge i
    TouchBoxes boxes;
} TouchCell;

/// Two features and their nearest points.
typedef struct TouchNear {
    Quad apart;         ///< m, from the point of b to that of a
    float distance;     ///< m
    float u, v;         ///< weights of the triangle's second and third node, or shares of the edges of a and b
    uint8_t kind, first, second; ///< as in a TouchPair
    bool faces;         ///< a node over the triangle, not beside it; edges that cross each other, not near their ends
} TouchNear;

/// Room for all of two cells.
enum { TOUCH_NEAR = 104 };

void touch_cell_place(const TouchPlan *plan, const Shell *shell, uint32_t cell, const float (*x)[4], Quad origin,
                      TouchCell *out);

/// How far apart two cells are at least, by the slabs that they lie in; negative where slabs do not tell.
float touch_cells_apart(const TouchCell *a, const TouchCell *b);

/// Finds nodes and triangles, and edges if they count, that share no node and are nearer than `far`; each is counted by
/// the cell that owns it. *nearest is their least distance, or `far`.
int touch_features(const Shell *shell, const TouchPair *pair, TouchCell *a, TouchCell *b, float far, bool edges,
                   TouchNear *near, float *nearest);

#endif

// Which features of two cells are near each other.
#ifndef COLLISION_NARROW_PHASE_H
#define COLLISION_NARROW_PHASE_H

#include "collision/collision_plan.h"

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
} TouchNear;

/// Room for all of two cells.
enum { TOUCH_NEAR = 104 };

void touch_cell_place(const TouchPlan *plan, const Shell *shell, uint32_t cell, const float (*x)[4], Quad origin,
                      TouchCell *out);

/// How far apart two cells are at least, by the boxes around them.
float touch_boxes_apart(const TouchCell *a, const TouchCell *b);

/// The same by the slabs that they lie in; negative where slabs do not tell.
float touch_cells_apart(const TouchCell *a, const TouchCell *b);

/// m by which touch_features may tell more than there is between a feature of the cell and another: its numbers are
/// float. Next to nothing, but for slivers.
float touch_doubt(const TouchCell *cell);

/// How far features are looked for.
typedef struct TouchFar {
    float measured; ///< m, to tell the least distance; see touch_doubt
    float listed;   ///< m, at most as far: of a node over a triangle, or edges that cross each other
    float beside;   ///< m, at most as far: of a node beside a triangle
    bool edges;     ///< they count
} TouchFar;

/// Lists nodes and triangles, and edges, that share no node and are near; each is counted by the cell that owns it.
/// *nearest is the least distance of all, or far->measured. Returns how many are listed, TOUCH_NEAR at most.
int touch_features(const Shell *shell, const TouchPair *pair, TouchCell *a, TouchCell *b, const TouchFar *far,
                   TouchNear *near, float *nearest);

#endif

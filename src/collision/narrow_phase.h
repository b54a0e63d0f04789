// The features of two cells in proximity.
#pragma once

#include "collision/collision_plan.h"

/// A cell's nodes about an origin, and values that follow from them.
typedef struct NarrowCell {
    Float4 node[5];     ///< fourth components are 0
    FourVectors corner; ///< 0 to 3
    FourVectors turned; ///< 1, 2, 3, 0
    Float4 low, high;   ///< of the nodes
    uint32_t owned;     ///< bit i: the cell owns node i, the centroid included; bit 8 + i: edge i

    // set when they are needed
    bool has_slab, has_triangles;
    FourVectors normal;        ///< four times, across the diagonals
    float slab_low, slab_high; ///< of the corners along `normal`
    float length;              ///< of it, or 0
    FourBoxes triangles;       ///< boxes around them
} NarrowCell;

/// Two features and their nearest points.
typedef struct NearFeatures {
    Float4 separation;           ///< m, from the point of b to that of a
    float distance;              ///< m
    float u, v;                  ///< weights of the triangle's second and third node, or shares of the edges of a and b
    uint8_t kind, first, second; ///< as in a CollisionPair
} NearFeatures;

/// Max features of two cells.
enum { NARROW_MAX = 104 };

void narrow_cell_set(const CollisionPlan *plan, const Shell *shell, uint32_t cell, const float (*x)[4], Float4 origin,
                     NarrowCell *out);

/// Lower bound of the distance of two cells, by the boxes around them.
float narrow_boxes_distance(const NarrowCell *a, const NarrowCell *b);

/// Lower bound by the slabs that they lie in; negative if slabs give no bound.
float narrow_slabs_distance(NarrowCell *a, NarrowCell *b);

/// m by which narrow_features may overestimate a distance of a feature of the cell, as it computes in float. Negligible
/// except for slivers.
float narrow_error_bound(const NarrowCell *cell);

/// Search distances of features.
typedef struct FeatureRange {
    float measured; ///< m, for the smallest distance; see narrow_error_bound
    float listed;   ///< m, max distance of a node over a triangle, or of edges that cross each other
    float adjacent; ///< m, max distance of a node beside a triangle
    bool edges;     ///< edges count
} FeatureRange;

/// Lists nodes and triangles, and edges, that share no node and are near; each is counted by the cell that owns it.
/// *nearest is the smallest distance of all, or far->measured. Returns how many are listed, at most NARROW_MAX.
int narrow_features(const Shell *shell, const CollisionPair *pair, NarrowCell *a, NarrowCell *b,
                    const FeatureRange *far, NearFeatures *near, float *nearest);

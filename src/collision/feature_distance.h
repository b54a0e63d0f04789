// Nearest points of features, and times of impact of moving features.
#pragma once

#include "collision/narrow_lanes.h"

#include <stdbool.h>

/// The vector from the triangle's nearest point to p; the point's weights of a, b, c. Regions of the triangle as in
/// Ericson, Real-time collision detection (2005), 5.1.5. The fourth components must be 0.
Float4 feature_from_triangle(Float4 p, Float4 a, Float4 b, Float4 c, float weight[3]);

/// The vector from the nearest point of segment c-d to that of a-b, at c + t (d - c) and a + s (b - a) (Ericson 5.1.9).
Float4 feature_from_segment(Float4 a, Float4 b, Float4 c, Float4 d, float *s, float *t);

/// Up to four points of each of two bodies, at the start of their displacements and at the end.
typedef struct FeatureHulls {
    FourVectors a[2], b[2];
} FeatureHulls;

/// Whether planes across `normal`, of any length, keep the convex hulls of the two bodies more than `margin` apart all
/// the way.
bool feature_is_apart_along(const FeatureHulls *hulls, Float4 normal, float margin);

/// Whether a plane of one orientation keeps the convex hulls of the two bodies more than `margin` apart all the way.
/// False if a few trials find none. Tries *normal first, if it is not NULL, and stores that of the plane it finds.
bool feature_is_apart(const FeatureHulls *hulls, float margin, Float4 *normal);

/// Four points and their displacements: a node and a triangle, or two edges.
typedef struct FeatureSweep {
    Float4 position[4], displacement[4];
    bool edges;
    Float4 *normal; ///< of a plane that has kept others of the two bodies apart, or NULL; replaced by what is found
} FeatureSweep;

/// The share of its displacement, 0 to 1, that is free before the two are about as near as `gap`, or 2 if all is.
/// Features that are as near at the start must not be nearer at the end, but for `noise`. Additive conservative
/// advancement (Li, Kaufman and Jiang, Codimensional incremental potential contact, 2021): no step is longer than the
/// distance over the fastest approach or, if that is too slow, than planes between the two allow.
float feature_sweep(const FeatureSweep *sweep, float gap, float noise);

/// Mean normal of a cell's triangles, given its nodes, with the largest deviation as fourth; 2 more if, seen along it,
/// a corner has no angle of 30 to 115 degrees; and 8 if there is no mean.
Float4 feature_normals(const Float4 node[5]);

/// Chords between unit normals: about 70 degrees, for a cell not folded onto itself; 35 and 20 degrees.
#define FEATURE_CONE 1.15f
#define FEATURE_CONE_SIDE 0.6f
#define FEATURE_CONE_CORNER 0.35f

/// Whether all normals of two cells in shape lie within a cone.
static inline bool feature_is_within(Float4 a, Float4 b, float cone) {
    Float4 off = a - b;
    float left = cone - a[3] - b[3];
    return left > 0 && float4_dot(off, off) < left * left;
}

/// Whether a plane through the corners that two cells share, bits of `shared`, has the other corners of a on one side,
/// and those of b on the other, at least `margin` away from it; *normal points to a's. Then the cells share nothing
/// else. The fourth components must be 0.
bool feature_is_separated(const Float4 a[4], const Float4 b[4], const unsigned shared[2], float margin, Float4 *normal);

// Nearest points of features, and when moving features meet.
#ifndef COLLISION_FEATURE_DISTANCE_H
#define COLLISION_FEATURE_DISTANCE_H

#include "common/float4.h"

#include <stdbool.h>

/// From the triangle's nearest point to p; its weights of a, b, c. Regions of the triangle as in Ericson, Real-time
/// collision detection (2005), 5.1.5. The fourth numbers must be 0.
Quad touch_from_triangle(Quad p, Quad a, Quad b, Quad c, float weight[3]);

/// From the nearest point of segment c-d to that of a-b, which are at c + t (d - c) and a + s (b - a) (Ericson 5.1.9).
Quad touch_from_segment(Quad a, Quad b, Quad c, Quad d, float *s, float *t);

/// Four points and their ways: a node and a triangle, or two edges.
typedef struct TouchSweep {
    Quad place[4], way[4];
    bool edges;
} TouchSweep;

/// The share of its way, 0 to 1, that is free before the two are about as near as `gap`, or 2 where all is. What is
/// as near from the start must end as far apart, but for `noise`. Additive conservative advancement (Li, Kaufman and
/// Jiang, Codimensional incremental potential contact, 2021): no step is longer than the distance over the fastest
/// approach; or, where that does not get on, than planes between the two allow.
float touch_sweep(const TouchSweep *sweep, float gap, float noise);

/// Mean normal of a cell's triangles, given its nodes, with the largest deviation as fourth; 2 more where, seen along
/// it, a corner has no angle of 30 to 115 degrees; and 8 where there is no mean.
Quad touch_normals(const Quad node[5]);

/// Chords between unit normals: of what is not folded onto itself, about 70 degrees; 35 and 20 degrees.
#define TOUCH_CONE 1.15f
#define TOUCH_CONE_SIDE 0.6f
#define TOUCH_CONE_CORNER 0.35f

/// Whether all normals of two cells in shape lie within a cone.
static inline bool touch_is_within(Quad a, Quad b, float cone) {
    Quad off = a - b;
    float left = cone - a[3] - b[3];
    return left > 0 && quad_dot(off, off) < left * left;
}

/// Whether a plane through the corners that two cells share, bits of `shared`, has the other corners of a on one side,
/// and those of b on the other, at least `margin` away from it; *normal points to a's. Then the cells share no more.
/// The fourth numbers must be 0.
bool touch_is_parted(const Quad a[4], const Quad b[4], const unsigned shared[2], float margin, Quad *normal);

#endif

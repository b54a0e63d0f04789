// Nearest points of features, and when moving features meet.
#ifndef CONTACT_TOUCH_NEAR_H
#define CONTACT_TOUCH_NEAR_H

#include "base/quad.h"

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
/// approach.
float touch_sweep(const TouchSweep *sweep, float gap, float noise);

/// Mean normal of a cell's triangles, given its nodes, with the largest deviation as fourth; 4 where one has none, or
/// the cell is out of shape.
Quad touch_normals(const Quad node[5]);

/// Whether all normals of two cells, or of one, lie within a cone: then they are not folded onto each other.
bool touch_is_unfolded(Quad a, Quad b, bool same);

/// Whether segment p-q passes through triangle a, b, c.
bool touch_pierces(Quad p, Quad q, Quad a, Quad b, Quad c);

#endif

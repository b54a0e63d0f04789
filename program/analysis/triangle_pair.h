// Whether two triangles cross, decided exactly.
#ifndef ANALYSIS_TRIANGLE_PAIR_H
#define ANALYSIS_TRIANGLE_PAIR_H

#include <stdbool.h>

typedef const float *Corners[3]; ///< three points of three finite coordinates, not on a line

/// Whether the interiors of the two, without edges and corners, have a point in common. So triangles that only touch do
/// not cross, be it at a corner or along an edge, shared or not; triangles in one plane cross if they overlap in an
/// area. *touch: whether an edge of one lies in the plane of the other, so that they may still cross there (hinges.h).
bool triangles_cross(const Corners a, const Corners b, bool *touch);

#endif

// Whether two triangles go through each other, decided exactly.
#ifndef ANALYSIS_TRIANGLE_PAIR_H
#define ANALYSIS_TRIANGLE_PAIR_H

#include <stdbool.h>

typedef const float *Corners[3]; ///< three points of three finite coordinates, not on a line

/// Whether the insides of the two, which are the triangles without their edges and corners, have a point in common. So
/// what only touches does not count, be it at a corner or along an edge, shared or not; what lies in one plane counts
/// where it overlaps with an area. *touch: whether an edge of one lies in the plane of the other, so that there may be
/// more to it (hinges.h).
bool triangles_cross(const Corners a, const Corners b, bool *touch);

#endif

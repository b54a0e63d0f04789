// The point of a triangle that is closest to a given point.
#pragma once

#include "common/float3.h"

/// The squared distance from p to a triangle, and the weights of its corners at the closest point: inside, on an edge
/// or at a corner. A triangle without area consists of its edges.
double closest_on_triangle(const double p[3], const double corner[3][3], double weight[3]);

// Points nearest on triangles, and rotations, which in scenes are about the world's fixed x, then y, then z axis:
// R = Rz Ry Rx.
#pragma once

#include "common/float3.h"

/// A row-major 3 × 3 matrix from angles in radians.
void rotation_matrix(const float angles[3], double matrix[9]);

/// The unit quaternion x, y, z, w of the same rotation.
void rotation_quaternion(const float angles[3], float quaternion[4]);

/// The squared distance from p to a triangle, and the weights of its corners at the closest point: inside, on an edge
/// or at a corner. A triangle without area consists of its edges.
double closest_on_triangle(const double p[3], const double corner[3][3], double weight[3]);

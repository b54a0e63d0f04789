// Boxes, points nearest on triangles, and rotations, which in scenes are about the world's fixed x, then y, then z axis:
// R = Rz Ry Rx.
#pragma once

#include "common/float3.h"

#include <stdint.h>

/// A box around points, m.
typedef struct Box {
    double low[3], high[3];
} Box;

#define BOX_EMPTY ((Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})

void box_add(Box *box, const double low[3], const double high[3]);

/// Adds `count` points of three numbers.
void box_add_points(Box *box, const float *points, uint32_t count);

double box_diagonal(const Box *box);

/// A row-major 3 × 3 matrix from angles in radians.
void rotation_matrix(const float angles[3], double matrix[9]);

/// The unit quaternion x, y, z, w of the same rotation.
void rotation_quaternion(const float angles[3], float quaternion[4]);

/// The squared distance from p to a triangle, and the weights of its corners at the closest point: inside, on an edge
/// or at a corner. A triangle without area consists of its edges.
double closest_on_triangle(const double p[3], const double corner[3][3], double weight[3]);

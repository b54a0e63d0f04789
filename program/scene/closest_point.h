// The point of a triangle that is closest to a given point.
#ifndef SCENE_CLOSEST_POINT_H
#define SCENE_CLOSEST_POINT_H

static inline double closest_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The squared distance from p to a triangle, and the weights of its corners at the closest point: inside, on an edge
/// or at a corner. A triangle without area consists of its edges.
double closest_on_triangle(const double p[3], const double corner[3][3], double weight[3]);

#endif

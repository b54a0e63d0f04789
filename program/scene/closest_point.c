#include "scene/closest_point.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/// The fraction of the segment from a to b that is closest to p.
static double along(const double p[3], const double a[3], const double b[3]) {
    double side[3], to[3];
    for (int k = 0; k < 3; k++) side[k] = b[k] - a[k], to[k] = p[k] - a[k];
    const double length = closest_dot(side, side);
    return length > 0 ? fmin(fmax(closest_dot(to, side) / length, 0), 1) : 0;
}

static double distance2(const double p[3], const double corner[3][3], const double weight[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d = weight[0] * corner[0][k] + weight[1] * corner[1][k] + weight[2] * corner[2][k] - p[k];
        sum += d * d;
    }
    return sum;
}

/// Weights of p's projection onto the plane of a triangle. False if it lies outside, or the triangle has no area.
static bool closest_inside(const double p[3], const double corner[3][3], double weight[3]) {
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++)
        u[k] = corner[1][k] - corner[0][k], v[k] = corner[2][k] - corner[0][k], w[k] = p[k] - corner[0][k];
    const double uu = closest_dot(u, u), uv = closest_dot(u, v), vv = closest_dot(v, v), wu = closest_dot(w, u),
                 wv = closest_dot(w, v);
    const double area = uu * vv - uv * uv;
    if (!(area > 1e-12 * uu * vv)) return false;
    weight[1] = (vv * wu - uv * wv) / area, weight[2] = (uu * wv - uv * wu) / area;
    weight[0] = 1 - weight[1] - weight[2];
    return weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0;
}

double closest_on_triangle(const double p[3], const double corner[3][3], double weight[3]) {
    if (closest_inside(p, corner, weight)) return distance2(p, corner, weight);
    double best = INFINITY;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const double t = along(p, corner[i], corner[j]);
        double side[3] = {0};
        side[i] = 1 - t;
        side[j] = t;
        const double gap = distance2(p, corner, side);
        if (gap < best) best = gap, memcpy(weight, side, sizeof side);
    }
    return best;
}

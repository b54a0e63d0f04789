// With half angles a, b, c about x, y, z the quaternion of R = Rz Ry Rx is q = qz qy qx:
//   x = sa cb cc - ca sb sc      y = ca sb cc + sa cb sc
//   z = ca cb sc - sa sb cc      w = ca cb cc + sa sb sc
#include "scene/space.h"

#include <string.h>

void box_add(Box *box, const double low[3], const double high[3]) {
    for (int i = 0; i < 3; i++) {
        box->low[i] = fmin(box->low[i], low[i]);
        box->high[i] = fmax(box->high[i], high[i]);
    }
}

void box_add_points(Box *box, const float *points, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        const float *p = points + 3 * (size_t)k;
        const double point[3] = {(double)p[0], (double)p[1], (double)p[2]};
        box_add(box, point, point);
    }
}

double box_diagonal(const Box *box) {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += (box->high[i] - box->low[i]) * (box->high[i] - box->low[i]);
    return sqrt(sum);
}

void rotation_quaternion(const float angles[3], float quaternion[4]) {
    double s[3], c[3];
    for (int i = 0; i < 3; i++) {
        s[i] = sin((double)angles[i] / 2);
        c[i] = cos((double)angles[i] / 2);
    }

    quaternion[0] = (float)(s[0] * c[1] * c[2] - c[0] * s[1] * s[2]);
    quaternion[1] = (float)(c[0] * s[1] * c[2] + s[0] * c[1] * s[2]);
    quaternion[2] = (float)(c[0] * c[1] * s[2] - s[0] * s[1] * c[2]);
    quaternion[3] = (float)(c[0] * c[1] * c[2] + s[0] * s[1] * s[2]);
}

void rotation_matrix(const float angles[3], double matrix[9]) {
    double s[3], c[3];
    for (int i = 0; i < 3; i++) {
        s[i] = sin((double)angles[i]);
        c[i] = cos((double)angles[i]);
    }

    matrix[0] = c[2] * c[1];
    matrix[1] = c[2] * s[1] * s[0] - s[2] * c[0];
    matrix[2] = c[2] * s[1] * c[0] + s[2] * s[0];
    matrix[3] = s[2] * c[1];
    matrix[4] = s[2] * s[1] * s[0] + c[2] * c[0];
    matrix[5] = s[2] * s[1] * c[0] - c[2] * s[0];
    matrix[6] = -s[1];
    matrix[7] = c[1] * s[0];
    matrix[8] = c[1] * c[0];
}

// ----

static double distance2(const double p[3], const double corner[3][3], const double weight[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d = weight[0] * corner[0][k] + weight[1] * corner[1][k] + weight[2] * corner[2][k] - p[k];
        sum += d * d;
    }
    return sum;
}

double closest_on_triangle(const double p[3], const double corner[3][3], double weight[3]) {
    // p's projection onto the plane, if the triangle has an area and the projection lies inside
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = corner[1][k] - corner[0][k];
        v[k] = corner[2][k] - corner[0][k];
        w[k] = p[k] - corner[0][k];
    }

    const double uu = dot3(u, u), uv = dot3(u, v), vv = dot3(v, v), wu = dot3(w, u), wv = dot3(w, v);
    const double area = uu * vv - uv * uv;

    if (area > 1e-12 * uu * vv) {
        weight[1] = (vv * wu - uv * wv) / area;
        weight[2] = (uu * wv - uv * wu) / area;
        weight[0] = 1 - weight[1] - weight[2];
        if (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0) return distance2(p, corner, weight);
    }

    // else the closest point of a side
    double best = INFINITY;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        double side[3], to[3], share[3] = {0};
        for (int k = 0; k < 3; k++) {
            side[k] = corner[j][k] - corner[i][k];
            to[k] = p[k] - corner[i][k];
        }

        const double length = dot3(side, side);
        const double t = length > 0 ? fmin(fmax(dot3(to, side) / length, 0), 1) : 0;
        share[i] = 1 - t;
        share[j] = t;
        const double gap = distance2(p, corner, share);
        if (gap < best) {
            best = gap;
            memcpy(weight, share, sizeof share);
        }
    }

    return best;
}

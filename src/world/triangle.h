// The nearest point of a triangle to a point, and the feature it lies on (Ericson, Real-Time Collision Detection,
// 5.1.5), in double precision: rounding must not change the side of a point near a surface.
#pragma once

#include "common/float3.h"

/// Corners are 0 to 2; edge k runs from corner k to the next.
typedef enum TriangleFeature {
    TRIANGLE_CORNER = 0, ///< + corner
    TRIANGLE_EDGE = 3,   ///< + edge
    TRIANGLE_FACE = 6,
} TriangleFeature;

typedef struct TriangleClosest {
    double square;  ///< of the distance
    double away[3]; ///< from the foot to the point
    double s, t;    ///< weights of the second and third corner at the foot
    int feature;
} TriangleClosest;

static inline void triangle_less(Float3 b, Float3 a, double out[3]) {
    out[0] = (double)b.x - (double)a.x;
    out[1] = (double)b.y - (double)a.y;
    out[2] = (double)b.z - (double)a.z;
}

/// The foot a + s ab + t ac.
static inline TriangleClosest triangle_closest_at(const double pa[3], const double ab[3], const double ac[3], double s,
                                                  double t, int feature) {
    TriangleClosest foot = {.feature = feature, .s = s, .t = t};
    for (int i = 0; i < 3; i++) foot.away[i] = pa[i] - s * ab[i] - t * ac[i];
    foot.square = dot3(foot.away, foot.away);
    return foot;
}

static inline TriangleClosest triangle_closest(Float3 p, Float3 a, Float3 b, Float3 c) {
    double ab[3], ac[3], pa[3];
    triangle_less(b, a, ab);
    triangle_less(c, a, ac);
    triangle_less(p, a, pa);

    const double bb = dot3(ab, ab), cc = dot3(ac, ac), bc = dot3(ab, ac);
    const double d1 = dot3(ab, pa), d2 = dot3(ac, pa);
    if (d1 <= 0 && d2 <= 0) return triangle_closest_at(pa, ab, ac, 0, 0, TRIANGLE_CORNER + 0);

    const double d3 = d1 - bb, d4 = d2 - bc; // of the point seen from b
    if (d3 >= 0 && d4 <= d3) return triangle_closest_at(pa, ab, ac, 1, 0, TRIANGLE_CORNER + 1);

    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return triangle_closest_at(pa, ab, ac, d1 / (d1 - d3), 0, TRIANGLE_EDGE + 0);

    const double d5 = d1 - bc, d6 = d2 - cc; // from c
    if (d6 >= 0 && d5 <= d6) return triangle_closest_at(pa, ab, ac, 0, 1, TRIANGLE_CORNER + 2);

    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return triangle_closest_at(pa, ab, ac, 0, d2 / (d2 - d6), TRIANGLE_EDGE + 2);

    const double va = d3 * d6 - d5 * d4, along = d4 - d3, back = d5 - d6;
    if (va <= 0 && along >= 0 && back >= 0) {
        double t = along / (along + back);
        return triangle_closest_at(pa, ab, ac, 1 - t, t, TRIANGLE_EDGE + 1);
    }

    const double sum = 1 / (va + vb + vc);
    return triangle_closest_at(pa, ab, ac, vb * sum, vc * sum, TRIANGLE_FACE);
}

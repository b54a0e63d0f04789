#include "common/real.h"
#include "collision/feature_distance.h"

// In float, the nearest point of a triangle 200 times as long as it is high is off by a two-thousandth of its length:
// then a node that passes through it seems to pass by. So weights are computed in double.

static double feature_dot(Float4 a, Float4 b) {
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

static void set_weights(float w[3], double b, double c) {
    w[0] = (float)(1 - b - c);
    w[1] = (float)b;
    w[2] = (float)c;
}

Float4 feature_from_triangle(Float4 p, Float4 a, Float4 b, Float4 c, float w[3]) {
    Float4 ab = b - a, ac = c - a, ap = p - a;
    double d1 = feature_dot(ab, ap), d2 = feature_dot(ac, ap), both = feature_dot(ab, ac);

    // not from p - b and p - c, whose rounding would not match
    double d3 = d1 - feature_dot(ab, ab), d4 = d2 - both, d5 = d1 - both, d6 = d2 - feature_dot(ac, ac);
    double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (d1 <= 0 && d2 <= 0) set_weights(w, 0, 0);
    else if (d3 >= 0 && d4 <= d3) set_weights(w, 1, 0);
    else if (d6 >= 0 && d5 <= d6) set_weights(w, 0, 1);
    else if (vc <= 0 && d1 >= 0 && d3 <= 0) set_weights(w, d1 / (d1 - d3), 0);
    else if (vb <= 0 && d2 >= 0 && d6 <= 0) set_weights(w, 0, d2 / (d2 - d6));
    else if (va <= 0 && d4 >= d3 && d5 >= d6)
        set_weights(w, (d5 - d6) / ((d4 - d3) + (d5 - d6)), (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    else set_weights(w, vb / (va + vb + vc), vc / (va + vb + vc));

    // a triangle without area has no weights in its interior: then its first corner is used
    if (!(w[0] + w[1] + w[2] > 0.5f)) set_weights(w, 0, 0);
    return p - (w[0] * a + w[1] * b + w[2] * c);
}

// ---- cells that are connected
//
// Two cells that share a side or a corner do not cross if
//
//   a plane through the shared corners has the other corners of the two cells on different sides
//   (feature_is_separated), or, which is cheaper and true nearly everywhere,
//
//   all their triangles' normals lie within a cone, and all corners have angles of at most 115 degrees (Volino and
//   Magnenat-Thalmann, Efficient self-collision detection, 1994, with the contour condition replaced by one on angles).
//
// Proof: seen along the first cell's mean normal n, all triangles of both have the same orientation, so that each cell
// is a star about its centroid, and its corners' angles, which are at most 115 degrees seen along its own normal, are
// less than 2 atan(tan 57.5 / cos c) plus 2 c tan c, c half the cone. At 35 degrees that is below 135: both are convex,
// on either side of the line through a shared side. At 20 degrees it is below 120: three cells around a corner, two of
// which share a side each with the third, take less than a full turn, and convex ones stay within their angles.

Float4 feature_normals(const Float4 node[5]) {
    const Float4 none = {0, 0, 0, 8};
    FourVectors corner = four_minus(four_of(node), four_all(node[4]));
    FourVectors normal = four_cross(corner, four_turned(corner));
    Float4 length = float4_sqrt(four_dot(normal, normal));
    if (float4_bits(length > 0) != 15) return none;

    Float4 inverse = 1 / length;
    normal = (FourVectors){normal.x * inverse, normal.y * inverse, normal.z * inverse};
    Float4 mean = {float4_sum(normal.x), float4_sum(normal.y), float4_sum(normal.z), 0};
    float size = sqrtf(float4_dot(mean, mean));
    if (!(size > 0)) return none;

    mean = mean / size;
    FourVectors along = four_all(mean), off = four_minus(normal, along);
    float spread = sqrtf(float4_largest(four_dot(off, off)));

    // whether the cell's corners have angles of 30 to 115 degrees, seen along the mean
    FourVectors next = four_minus(four_turned(corner), corner);
    next = four_along(next, -four_dot(next, along), along);
    FourVectors last = {-FLOAT4_SHUFFLE(next.x, next.x, 3, 0, 1, 2), -FLOAT4_SHUFFLE(next.y, next.y, 3, 0, 1, 2),
                        -FLOAT4_SHUFFLE(next.z, next.z, 3, 0, 1, 2)};
    Float4 dot = four_dot(next, last), square = four_dot(next, next) * four_dot(last, last);
    Float4 max = float4_select(dot > 0, float4_all(0.75f), float4_all(0.1786f)) * square;
    bool in_shape = float4_bits((four_dot(four_cross(next, last), along) > 0) & (dot * dot <= max)) == 15;
    return float4_with(mean, in_shape ? spread : 2 + spread);
}

/// Whether the corners that are not shared lie beyond the plane.
static bool is_beyond(const Float4 corner[4], unsigned shared, Float4 origin, Float4 normal, float margin) {
    float min = margin * sqrtf(float4_dot(normal, normal));
    for (int i = 0; i < 4; i++)
        if (!(shared >> i & 1) && !(float4_dot(corner[i] - origin, normal) > min)) return false;
    return true;
}

bool feature_is_separated(const Float4 a[4], const Float4 b[4], const unsigned shared[2], float margin,
                          Float4 *normal) {
    Float4 first = {0}, last = {0};
    int count = 0;
    for (int i = 0; i < 4; i++)
        if (shared[0] >> i & 1) {
            if (count++ == 0) first = a[i];
            last = a[i];
        }
    if (count < 1 || count > 2) return false;

    Float4 away = ((a[0] + a[1]) + (a[2] + a[3])) - ((b[0] + b[1]) + (b[2] + b[3])), side = last - first;
    float square = float4_dot(side, side);
    if (count == 2 && square > 0) away -= float4_dot(away, side) / square * side;
    *normal = away;
    return is_beyond(a, shared[0], first, away, margin) && is_beyond(b, shared[1], first, -away, margin);
}

static double feature_clamp01(double a) { return a > 0 ? (a < 1 ? a : 1) : 0; }

Float4 feature_from_segment(Float4 a, Float4 b, Float4 c, Float4 d, float *s, float *t) {
    Float4 u = b - a, v = d - c, r = a - c;
    double uu = feature_dot(u, u), vv = feature_dot(v, v), vr = feature_dot(v, r), ur = feature_dot(u, r),
           uv = feature_dot(u, v);
    double determinant = uu * vv - uv * uv;
    double along = determinant > 1e-13 * uu * vv ? feature_clamp01((uv * vr - ur * vv) / determinant) : 0;
    double other = vv > 0 ? (uv * along + vr) / vv : 0;
    if (!(other >= 0 && other <= 1)) {
        other = feature_clamp01(other);
        along = uu > 0 ? feature_clamp01((other * uv - ur) / uu) : 0;
    }

    *s = (float)along;
    *t = (float)other;
    return (a + *s * u) - (c + *t * v);
}

// ---- trajectories that a plane keeps apart
//
// Along a unit vector n the difference of any point of a and any of b changes linearly. So if all differences are more
// than `margin` at both ends, the bodies are farther apart than that all the way. Such an n is the direction of the
// point nearest to 0 in the hull of all differences at both ends. Gilbert's algorithm (1966) nears that point: from a
// point v of the hull it goes to the one nearest to 0 between v and the difference that reaches farthest against v.

bool feature_is_apart_along(const FeatureHulls *hulls, Float4 normal, float margin) {
    const FourVectors n = four_all(normal);
    Float4 reach[2]; // from b to a along n, and from a to b
    for (int t = 0; t < 2; t++) {
        const Float4 a = four_dot(hulls->a[t], n), b = four_dot(hulls->b[t], n);
        const float above = float4_smallest(a) - float4_largest(b), below = float4_smallest(b) - float4_largest(a);
        reach[t] = (Float4){above, below};
    }

    const Float4 least = float4_min(reach[0], reach[1]);
    const float most = least[0] > least[1] ? least[0] : least[1];
    return most > 0 && most < INFINITY && most * most > margin * margin * float4_dot(normal, normal);
}

bool feature_is_apart(const FeatureHulls *hulls, float margin, Float4 *normal) {
    enum { TRIALS = 4 };
    Float4 v = {0};
    if (normal && feature_is_apart_along(hulls, *normal, margin)) return true;

    for (int trial = 0; trial <= TRIALS; trial++) {
        float reach = INFINITY, square = trial ? float4_dot(v, v) : 0;
        Float4 farthest[2];
        for (int t = 0; t < 2; t++) {
            // at first, the means of both ends
            if (trial == 0) {
                FourVectors off = four_minus(hulls->a[t], hulls->b[t]);
                farthest[t] = 0.25f * (Float4){float4_sum(off.x), float4_sum(off.y), float4_sum(off.z), 0};
                continue;
            }

            Float4 a = four_dot(hulls->a[t], four_all(v)), b = four_dot(hulls->b[t], four_all(v));
            float low = float4_smallest(a), high = float4_largest(b);
            if (!(low - high < reach)) continue;
            reach = low - high;
            farthest[0] = four_lane(hulls->a[t], __builtin_ctz(float4_bits(a == low) | 8)) -
                          four_lane(hulls->b[t], __builtin_ctz(float4_bits(b == high) | 8));
        }

        if (trial) {
            if (reach > 0 && reach < INFINITY && reach * reach > margin * margin * square) {
                if (normal) *normal = v;
                return true;
            }
            if (!(square > margin * margin)) return false;
            farthest[1] = v;
        }

        Float4 along = farthest[1] - farthest[0];
        float length = float4_dot(along, along), share = length > 0 ? -float4_dot(farthest[0], along) / length : 0;
        v = farthest[0] + (share < 0 ? 0 : share > 1 ? 1 : share) * along;
    }

    return false;
}

static Float4 sweep_separation(const FeatureSweep *sweep, float time, Float4 x[4]) {
    float weight[3], s, t;
    for (int i = 0; i < 4; i++) x[i] = sweep->position[i] + time * sweep->displacement[i];
    return sweep->edges ? feature_from_segment(x[0], x[1], x[2], x[3], &s, &t)
                        : feature_from_triangle(x[0], x[1], x[2], x[3], weight);
}

static float sweep_distance(const FeatureSweep *sweep, float time) {
    Float4 x[4], separation = sweep_separation(sweep, time, x);
    return sqrtf(float4_dot(separation, separation));
}

/// Whether the features end no nearer than where the advancement below would stop, shown by a plane.
static bool sweep_is_apart(const FeatureSweep *sweep, float margin) {
    FeatureHulls hulls;
    for (int t = 0; t < 2; t++) {
        Float4 x[4];
        for (int i = 0; i < 4; i++) x[i] = t ? sweep->position[i] + sweep->displacement[i] : sweep->position[i];

        FourVectors all = four_of(x);
        if (sweep->edges) {
            hulls.a[t] =
                (FourVectors){FLOAT4_SHUFFLE(all.x, all.x, 0, 1, 0, 1), FLOAT4_SHUFFLE(all.y, all.y, 0, 1, 0, 1),
                              FLOAT4_SHUFFLE(all.z, all.z, 0, 1, 0, 1)};
            hulls.b[t] =
                (FourVectors){FLOAT4_SHUFFLE(all.x, all.x, 2, 3, 2, 3), FLOAT4_SHUFFLE(all.y, all.y, 2, 3, 2, 3),
                              FLOAT4_SHUFFLE(all.z, all.z, 2, 3, 2, 3)};
        } else {
            hulls.a[t] = four_all(x[0]);
            hulls.b[t] =
                (FourVectors){FLOAT4_SHUFFLE(all.x, all.x, 1, 2, 3, 3), FLOAT4_SHUFFLE(all.y, all.y, 1, 2, 3, 3),
                              FLOAT4_SHUFFLE(all.z, all.z, 1, 2, 3, 3)};
        }
    }

    // a plane along both, as the step begins, is what keeps layers apart
    const Float4 *p = sweep->position;
    const Float4 across =
        sweep->edges ? float4_cross(p[1] - p[0], p[3] - p[2]) : float4_cross(p[2] - p[1], p[3] - p[1]);
    if (!feature_is_apart_along(&hulls, across, margin)) return feature_is_apart(&hulls, margin, sweep->normal);
    if (sweep->normal) *sweep->normal = across;
    return true;
}

float feature_sweep(const FeatureSweep *sweep, float gap, float noise) {
    enum { ROUNDS = 64, SIMPLE_ROUNDS = 12 };

    // max speed at which the two approach each other: their longest displacements, without the mean of all
    Float4 mean =
        0.25f * ((sweep->displacement[0] + sweep->displacement[1]) + (sweep->displacement[2] + sweep->displacement[3]));
    float length[4];
    for (int i = 0; i < 4; i++)
        length[i] = sqrtf(float4_dot(sweep->displacement[i] - mean, sweep->displacement[i] - mean));

    float late = float_max(length[2], length[3]);
    float approach = sweep->edges ? float_max(length[0], length[1]) + late : length[0] + float_max(length[1], late);
    if (sweep_is_apart(sweep, 2 * gap + noise)) return 2;

    float distance = sweep_distance(sweep, 0), time = 0;
    bool close = distance <= 2 * gap; // then the distance may only grow
    if (close && sweep_distance(sweep, 1) < distance - noise) return 0;

    // impacts separate features by more than `stop`, however far they have moved
    float keep = close ? 0.5f * distance : gap, stop = keep + 0.1f * float_min(distance - keep, 10 * gap);
    if (approach < distance - keep) return 2;

    for (int round = 0; round < ROUNDS; round++) {
        float next = time + 0.9f * (distance - keep) / approach;

        // features that slide past each other, fast for their distance, make small steps only. Then two planes
        // across the shortest segment between the two, each moving with the nearest of its points, tell from `time` on
        // how long these keep them `keep` apart
        if (round >= SIMPLE_ROUNDS) {
            Float4 x[4], normal = sweep_separation(sweep, time, x);
            int own = sweep->edges ? 2 : 1;
            float longest = 2, height[4], speed[4];
            normal = normal / sqrtf(float4_dot(normal, normal));

            for (int i = 0; i < 4; i++) {
                height[i] = float4_dot(x[i] - x[0], normal);
                speed[i] = float4_dot(sweep->displacement[i], normal);
            }

            for (int i = 0; i < own; i++)
                for (int j = own; j < 4; j++) {
                    float left = height[i] - height[j] - keep, nearing = speed[j] - speed[i];
                    if (!(left > 0)) longest = 0;
                    else if (nearing > 0) longest = float_min(longest, left / nearing);
                }
            next = float_max(next, time + 0.9f * longest);
        }

        if (next > 1) return 2;

        distance = sweep_distance(sweep, next);
        if (!(distance > stop)) return time;
        time = next;
    }

    return time;
}

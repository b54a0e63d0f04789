// The conductances of one cell along its sides and diagonals: its weights in the `surface` operator.
//
//   energy of the cell   sum over its six springs e of c_e (T_j - T_i)^2/2
//   exact for linear T   sum of c_e p_e p_e' = A 1                                             (1)
//
// p   m   the spring, in the plane of the cell
// A   m2  the cell's area in that plane
// c       conductance over a
//
// Linear elements on two triangles satisfy (1), and a linear T is steady. c = cot/2 of the angle opposite to each side
// (MacNeal 1949; Pinkall & Polthier 1993). Of the two ways to split the cell, the one whose diagonal has a nonnegative
// weight is taken (Delaunay's; on rectangles both are the same, and the diagonal vanishes).
//
// The weight of a side opposite to an obtuse angle is still negative. Usually that of the cell across the side
// compensates for it, and nothing is done. Otherwise these weights c1 are mixed with positive ones c2 that satisfy (1),
// if positive weights can,
//
//   c = c1 + s (c2 - c1),   with the smallest s for which no side, with the cell across it, is negative
//
// which keeps (1); the smaller s, the closer a linear T is to steady. So every conductance is 0 or more, and the matrix
// is an M-matrix: T never leaves its range. Ablation removes whole springs, so it stays one. A tear separates the two
// cells of a side; each then lacks the other's weight, and is mixed again.
//
// c2: with k = c p^2 and z = (cos, sin) of twice the angle of p, (1) is a balance of directions,
//
//   sum of k = 2 A,   sum of k z = 0
//
// and of all solutions that of max entropy is taken, in which all springs have a part: k is proportional to
// exp(lambda z), lambda by Newton's method. If all springs of a cell run within a quarter turn (inclined needles), no
// positive k balances. lambda, limited to a length of 5, then favours the springs that are farthest apart. The cell
// conducts (1 + r) times k along and (1 - r) across, with r the residual of the balance; with 2 A/sqrt(1 - r^2) as the
// sum of k, one is too large by the factor by which the other is too small. So a front is faster along such cells and
// slower across, and stops nowhere.
#include <float.h>
#include <math.h>

#include "common/float3.h"
#include "common/real.h"
#include "heat/heat_plan.h"

enum { SIDES = 4, SPRINGS = 6, ITERATIONS = 50, STEEPEST = 5 };

/// The cotangent of the angle at a, or 0 where there is no angle.
static double weights_cot(Float3 a, Float3 b, Float3 c) {
    Float3 u = float3_sub(b, a), v = float3_sub(c, a);
    double area = float3_length(float3_cross(u, v));
    return area > 0 ? float3_dot(u, v) / area : 0;
}

/// Linear elements on triangles (a, b, c) and (a, c, d), a = split; sides are numbered by their first corner.
static void weights_linear(const Float3 x[4], int split, double share, double w[SPRINGS]) {
    int a = split, b = split + 1, c = split + 2, d = (split + 3) % 4;
    double half = share / 2;
    w[a] += half * weights_cot(x[c], x[a], x[b]);
    w[b] += half * weights_cot(x[a], x[b], x[c]);
    w[c] += half * weights_cot(x[a], x[c], x[d]);
    w[d] += half * weights_cot(x[c], x[d], x[a]);
    w[SIDES + split] += half * (weights_cot(x[b], x[c], x[a]) + weights_cot(x[d], x[a], x[c]));
}

bool heat_cell_linear(const Float3 x[4], double w[6]) {
    double each[2][SPRINGS] = {{0}, {0}}, largest = 0;
    for (int k = 0; k < SPRINGS; k++) w[k] = 0;

    // a split is good if both triangles have an area, and none is inverted (arrow-shaped cells, three collinear corners)
    Float3 normal = float3_unit(float3_cross(float3_sub(x[2], x[0]), float3_sub(x[3], x[1])));
    double min[2], total = 0;
    for (int split = 0; split < 2; split++) {
        int a = split, b = split + 1, c = split + 2, d = (split + 3) % 4;
        double one = float3_dot(float3_cross(float3_sub(x[b], x[a]), float3_sub(x[c], x[a])), normal);
        double two = float3_dot(float3_cross(float3_sub(x[c], x[a]), float3_sub(x[d], x[a])), normal);
        min[split] = double_min(one, two);
        total = double_max(total, one + two);
    }

    bool good[2] = {min[0] > 1e-3 * total, min[1] > 1e-3 * total};
    if (!good[0] && !good[1]) return false;

    // of two good splits the one whose diagonal has the larger weight
    for (int split = 0; split < 2; split++) {
        if (good[split]) weights_linear(x, split, 1, each[split]);
        for (int k = 0; k < SIDES; k++) largest = double_max(largest, fabs(each[split][k]));
    }

    double one = each[0][SIDES], two = each[1][SIDES + 1];

    // the rounding error of a right angle needs no entry in the matrix
    bool square = good[0] && good[1] && double_max(fabs(one), fabs(two)) <= 6e-5 * largest;
    if (good[0] && good[1] && !square) good[one < two ? 0 : 1] = false;
    for (int split = 0; split < 2; split++)
        if (good[split]) weights_linear(x, split, square ? 0.5 : 1, w);
    if (square) w[SIDES] = w[SIDES + 1] = 0;
    return true;
}

/// A spring in the plane of the cell.
typedef struct WeightSpring {
    double square; ///< p^2; 0: normal to the plane
    double z[2];
} WeightSpring;

/// The cell's springs and twice its area, in its plane.
static double weights_plane(const Float3 x[4], WeightSpring springs[SPRINGS]) {
    double p[SPRINGS][3], normal[3], across[3];
    for (int k = 0; k < SPRINGS; k++) {
        Float3 a = x[k % 4], b = k < SIDES ? x[(k + 1) % 4] : x[k - SIDES + 2];
        p[k][0] = (double)b.x - (double)a.x;
        p[k][1] = (double)b.y - (double)a.y;
        p[k][2] = (double)b.z - (double)a.z;
    }

    const double *d = p[SIDES], *e = p[SIDES + 1];
    for (int k = 0; k < 3; k++) normal[k] = d[(k + 1) % 3] * e[(k + 2) % 3] - d[(k + 2) % 3] * e[(k + 1) % 3];
    double area = sqrt(dot3(normal, normal)), length = sqrt(dot3(d, d));
    if (!(area > 0)) return 0;

    for (int k = 0; k < 3; k++)
        across[k] = (normal[(k + 1) % 3] * d[(k + 2) % 3] - normal[(k + 2) % 3] * d[(k + 1) % 3]) / (area * length);

    for (int k = 0; k < SPRINGS; k++) {
        double u = dot3(p[k], d) / length, v = dot3(p[k], across), square = u * u + v * v;
        springs[k] = (WeightSpring){square, {0, 0}};
        if (square > 0) {
            springs[k].z[0] = (u * u - v * v) / square;
            springs[k].z[1] = 2 * u * v / square;
        }
    }

    return area;
}

/// k of a given lambda, with a sum of 1; the mean of z with these weights, and its derivatives by lambda.
static void weights_mean(const WeightSpring s[SPRINGS], const double lambda[2], double k[SPRINGS], double mean[2],
                         double slope[3]) {
    double total = 0;
    mean[0] = mean[1] = slope[0] = slope[1] = slope[2] = 0;
    for (int e = 0; e < SPRINGS; e++) {
        k[e] = s[e].square > 0 ? real_exp(lambda[0] * s[e].z[0] + lambda[1] * s[e].z[1]) : 0;
        total += k[e];
    }

    for (int e = 0; e < SPRINGS; e++) {
        k[e] /= total;
        mean[0] += k[e] * s[e].z[0];
        mean[1] += k[e] * s[e].z[1];
        slope[0] += k[e] * s[e].z[0] * s[e].z[0];
        slope[1] += k[e] * s[e].z[0] * s[e].z[1];
        slope[2] += k[e] * s[e].z[1] * s[e].z[1];
    }

    slope[0] -= mean[0] * mean[0];
    slope[1] -= mean[0] * mean[1];
    slope[2] -= mean[1] * mean[1];
}

/// The rounding error of a a, with `square` its rounded value (Dekker).
static double weights_rest(double a, double square) {
    // two halves of a, of 26 bits each, whose products are exact (Veltkamp)
    double b = a * 134217729; // 2^27 + 1
    double high = b - (b - a), low = a - high;
    return ((high * high - square) + 2 * high * low) + low * low;
}

/// sqrt(u u + v v), correctly rounded but for few in a million: the same with every C library, unlike hypot. For
/// numbers whose squares neither overflow nor underflow.
static double weights_length(double u, double v) {
    double uu = u * u, vv = v * v, length = sqrt(uu + vv);
    if (!(length > 1e-140 && length < 1e140)) return length;
    double square = length * length, big = double_max(uu, vv), small = double_min(uu, vv);
    double miss =
        ((square - big) - small) + (weights_rest(length, square) - (weights_rest(u, uu) + weights_rest(v, vv)));
    return length - miss / (2 * length);
}

void heat_cell_weights(const Float3 x[4], const double across[4], double w[6]) {
    double positive[SPRINGS] = {0}, k[SPRINGS], mix = 0;
    bool linear = heat_cell_linear(x, w);

    // c2 of (1), or the closest to it
    WeightSpring springs[SPRINGS] = {{0}};
    double twice = weights_plane(x, springs), even = 1;

    // those of max entropy, with a sum of 1; even is sqrt(1 - r^2)
    if (twice > 0) {
        double lambda[2] = {0}, mean[2], slope[3], moved = 1;
        weights_mean(springs, lambda, k, mean, slope);

        for (int n = 0; n < ITERATIONS && moved > 1e-9 && weights_length(mean[0], mean[1]) > 1e-12; n++) {
            double before[2] = {lambda[0], lambda[1]};

            // Newton step, of length 1 at most: the mean is the gradient of a convex function of lambda
            double a = slope[0] + 1e-9, b = slope[1], c = slope[2] + 1e-9, determinant = a * c - b * b;
            double u = (b * mean[1] - c * mean[0]) / determinant, v = (b * mean[0] - a * mean[1]) / determinant;
            double shorter = double_max(weights_length(u, v), 1);
            lambda[0] += u / shorter;
            lambda[1] += v / shorter;

            double steep = double_max(weights_length(lambda[0], lambda[1]) / STEEPEST, 1);
            lambda[0] /= steep;
            lambda[1] /= steep;
            moved = weights_length(lambda[0] - before[0], lambda[1] - before[1]);
            weights_mean(springs, lambda, k, mean, slope);
        }

        even = sqrt(double_max(1 - mean[0] * mean[0] - mean[1] * mean[1], DBL_EPSILON));
    }

    for (int e = 0; e < SPRINGS; e++)
        if (twice > 0 && springs[e].square > 0) positive[e] = twice * k[e] / (even * springs[e].square);

    // the smallest s for which no weight is negative
    for (int e = 0; e < SPRINGS && linear; e++) {
        double min = e < SIDES ? double_min(-across[e], 0) : 0;
        if (w[e] < min) mix = double_max(mix, (min - w[e]) / (positive[e] - w[e]));
    }

    mix = linear ? double_min(mix, 1) : 1;
    for (int e = 0; e < SPRINGS; e++) {
        w[e] += mix * (positive[e] - w[e]);
        if (e >= SIDES) w[e] = double_max(w[e], 0);
    }
}

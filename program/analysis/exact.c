// Orientation of points with float coordinates (J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast
// robust geometric predicates, Discrete Comput. Geom. 18, 1997):
//
//            | a_x - d_x  a_y - d_y  a_z - d_z |
//   orient3  | b_x - d_x  b_y - d_y  b_z - d_z |      orient2  | a_x - c_x  a_y - c_y |
//            | c_x - d_x  c_y - d_y  c_z - d_z |               | b_x - c_x  b_y - c_y |
//
// First in double: the sign is right where the value exceeds (7 + 56 e) e, or (3 + 16 e) e in the plane, times the same
// sum with all products positive (its permanent), e = 2^-53. Else the determinant is multiplied out: 24 products of
// three coordinates, or 6 of two. A product of two floats is a double exactly (24 + 24 bits of 53); cut into halves of
// 26 bits it gives two exact doubles with a third. These are added up as an expansion, a sum of doubles that do not
// overlap, in which the largest part has the sign of the whole (Shewchuk's Grow-Expansion, theorem 10). The same serves
// for the differences themselves, with 6 products, if they are exact and have no more than 26 bits: points close
// together. Floats lie between 2^-149 and 2^128, so nothing under- or overflows.
#include "analysis/exact.h"

#include <math.h>
#include <stdbool.h>

enum { PARTS = 48 };
static const double rounding = 0x1p-53;

typedef struct Expansion {
    int count;
    double parts[PARTS]; ///< ascending in magnitude, none 0
} Expansion;

static void exact_add(Expansion *sum, double term) {
    int kept = 0;
    for (int i = 0; i < sum->count; i++) {
        const double part = sum->parts[i], whole = term + part;
        const double of_part = whole - term, of_term = whole - of_part;
        const double lost = (term - of_term) + (part - of_part);
        if (lost != 0) sum->parts[kept++] = lost;
        term = whole;
    }

    if (term != 0) sum->parts[kept++] = term;
    sum->count = kept;
}

static int sign_of(double value) { return (value > 0) - (value < 0); }

static int expansion_sign(const Expansion *sum) { return sum->count ? sign_of(sum->parts[sum->count - 1]) : 0; }

/// The upper 26 bits of a double (Veltkamp's splitting).
static double high_half(double x) {
    const double spread = 0x8000001p0 * x; // 2^27 + 1
    return spread - (spread - x);
}

/// Adds p q r, of at most 26 bits each.
static void add_product(Expansion *sum, double p, double q, double r) {
    const double pq = p * q, high = high_half(pq);
    exact_add(sum, high * r);
    exact_add(sum, (pq - high) * r);
}

/// Adds sign |a b c| of coordinates of at most 26 bits.
static void add_determinant(Expansion *sum, double sign, const double a[3], const double b[3], const double c[3]) {
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        add_product(sum, sign * a[k], b[l], c[m]);
        add_product(sum, -sign * a[k], b[m], c[l]);
    }
}

/// Whether p = a - d is exact, and of at most 26 bits.
static bool is_short(const float a[3], const float d[3], const double p[3]) {
    for (int k = 0; k < 3; k++) {
        const double high = high_half(p[k]), of_d = (double)a[k] - p[k];
        if (high != p[k] || of_d != (double)d[k] || p[k] + of_d != (double)a[k]) return false;
    }
    return true;
}

int exact_orient3(const float a[3], const float b[3], const float c[3], const float d[3]) {
    double p[3], q[3], r[3], value = 0, permanent = 0;
    for (int k = 0; k < 3; k++) {
        p[k] = (double)a[k] - (double)d[k];
        q[k] = (double)b[k] - (double)d[k];
        r[k] = (double)c[k] - (double)d[k];
    }

    for (int k = 0; k < 3; k++) {
        const double one = q[(k + 1) % 3] * r[(k + 2) % 3], other = q[(k + 2) % 3] * r[(k + 1) % 3];
        value += p[k] * (one - other);
        permanent += fabs(p[k]) * (fabs(one) + fabs(other));
    }

    // a rounded difference is 0 only if the exact one is, and then its products are 0, too
    if (permanent == 0) return 0;
    if (fabs(value) > (7 + 56 * rounding) * rounding * permanent) return sign_of(value);

    // the differences from d if they are short, else the determinant of the four points with a column of ones
    Expansion sum = {0};
    if (is_short(a, d, p) && is_short(b, d, q) && is_short(c, d, r)) {
        add_determinant(&sum, 1, p, q, r);
        return expansion_sign(&sum);
    }

    const float *const points[4] = {a, b, c, d};
    double at[4][3];
    for (int i = 0; i < 12; i++) at[i / 3][i % 3] = (double)points[i / 3][i % 3];
    add_determinant(&sum, 1, at[0], at[1], at[2]);
    add_determinant(&sum, -1, at[0], at[1], at[3]);
    add_determinant(&sum, 1, at[0], at[2], at[3]);
    add_determinant(&sum, -1, at[1], at[2], at[3]);
    return expansion_sign(&sum);
}

int exact_orient2(const float a[3], const float b[3], const float c[3], int x, int y) {
    const double one = ((double)a[x] - (double)c[x]) * ((double)b[y] - (double)c[y]);
    const double other = ((double)a[y] - (double)c[y]) * ((double)b[x] - (double)c[x]);
    const double permanent = fabs(one) + fabs(other), value = one - other;

    if (permanent == 0) return 0;
    if (fabs(value) > (3 + 16 * rounding) * rounding * permanent) return sign_of(value);

    Expansion sum = {0};
    const float *const pairs[3][2] = {{a, b}, {b, c}, {c, a}};
    for (int i = 0; i < 3; i++) {
        exact_add(&sum, (double)pairs[i][0][x] * (double)pairs[i][1][y]);
        exact_add(&sum, -(double)pairs[i][0][y] * (double)pairs[i][1][x]);
    }

    return expansion_sign(&sum);
}

int exact_collinear(const float a[3], const float b[3], const float c[3]) {
    return !exact_orient2(a, b, c, 0, 1) && !exact_orient2(a, b, c, 1, 2) && !exact_orient2(a, b, c, 2, 0);
}

// Triangle against triangle by signs alone (P. Guigue, O. Devillers, Fast and robust triangle-triangle overlap test
// using orientation predicates, J. Graphics Tools 8, 2003), here of open triangles.
//
// Each must have corners strictly on both sides of the other's plane. Then each meets the line of the two planes in an
// open interval. With p the corner that is alone on its side, and that side made positive by flipping the other
// triangle, these intervals overlap if
//
//   orient3(p1, q1, p2, q2) < 0   and   orient3(p1, r1, r2, p2) < 0
//
// Two triangles in one plane overlap with an area unless the line of one of their six edges has the other triangle on
// its outer side.
#include "analysis/triangle_pair.h"

#include "analysis/exact.h"

#include <stddef.h>

/// Signs of the corners of `b` against the plane of `a`.
static void sides(const Corners a, const Corners b, int sign[3]) {
    for (int k = 0; k < 3; k++) sign[k] = exact_orient3(a[0], a[1], a[2], b[k]);
}

static bool is_edge_in_plane(const int sign[3]) { return (sign[0] == 0) + (sign[1] == 0) + (sign[2] == 0) > 1; }

static bool on_both_sides(const int sign[3]) {
    bool above = false, below = false;
    for (int k = 0; k < 3; k++) above |= sign[k] > 0, below |= sign[k] < 0;
    return above && below;
}

/// A corner that is alone on its side; there is one.
static int lonely(const int sign[3]) {
    for (int k = 0; k < 2; k++)
        if (sign[k] && sign[(k + 1) % 3] != sign[k] && sign[(k + 2) % 3] != sign[k]) return k;
    return 2;
}

static void swap(Corners a, int i, int j) {
    const float *kept = a[i];
    a[i] = a[j], a[j] = kept;
}

static bool intervals_overlap(const Corners a, const int sign_a[3], const Corners b, const int sign_b[3]) {
    const int i = lonely(sign_a), j = lonely(sign_b);
    Corners s = {a[i], a[(i + 1) % 3], a[(i + 2) % 3]}, t = {b[j], b[(j + 1) % 3], b[(j + 2) % 3]};
    if (sign_a[i] < 0) swap(t, 1, 2);
    if (sign_b[j] < 0) swap(s, 1, 2);
    return exact_orient3(s[0], s[1], t[0], t[1]) < 0 && exact_orient3(s[0], s[2], t[2], t[0]) < 0;
}

/// Whether an edge of `a` has all of `b` on its outer side, or on its line; `turn` is the orientation of `a`.
static bool edge_parts(const Corners a, int turn, const Corners b, int x, int y) {
    for (int i = 0; i < 3; i++) {
        int outside = 0;
        for (int k = 0; k < 3; k++) outside += turn * exact_orient2(a[i], a[(i + 1) % 3], b[k], x, y) <= 0;
        if (outside == 3) return true;
    }
    return false;
}

static bool overlap_in_plane(const Corners a, const Corners b) {
    for (int x = 0; x < 3; x++) {
        const int y = (x + 1) % 3, turn = exact_orient2(a[0], a[1], a[2], x, y);
        if (!turn) continue; // seen edge-on
        const int other = exact_orient2(b[0], b[1], b[2], x, y);
        return !edge_parts(a, turn, b, x, y) && !edge_parts(b, other, a, x, y);
    }
    return false;
}

bool triangles_cross(const Corners a, const Corners b, bool *touch) {
    int of_a[3], of_b[3];
    sides(a, b, of_b);
    *touch = is_edge_in_plane(of_b);
    if (!of_b[0] && !of_b[1] && !of_b[2]) return overlap_in_plane(a, b);
    if (!on_both_sides(of_b)) return false;
    sides(b, a, of_a);
    *touch |= is_edge_in_plane(of_a);
    return on_both_sides(of_a) && intervals_overlap(a, of_a, b, of_b);
}

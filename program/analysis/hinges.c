// An edge pq between triangles with the third corners a and b crosses
//
//   a triangle t in whose plane it lies: if it runs through t's interior, with a and b on opposite sides of t;
//   an edge of t on the same line, between t and u: if they have a length in common, and the half-planes of a and b
//   around the line separate those of t and u.
//
// Together with interiors that meet, these are all cases in which two surfaces cross along a line.
#include "analysis/hinges.h"

#include <stdlib.h>

#include "analysis/exact.h"
#include "analysis/triangle_pair.h"

#define NONE UINT32_MAX

typedef struct Hinges {
    const float (*position)[3];
    const uint32_t (*triangles)[3];
    uint32_t count;
    uint32_t (*across)[3]; ///< the other triangle at the edge that begins at a corner; NONE if there is none or several
    uint8_t (*far)[3];     ///< its corner that is not on the edge
} Hinges;

static void corners_of(const Hinges *hinges, uint32_t triangle, Corners corners) {
    for (int k = 0; k < 3; k++) corners[k] = hinges->position[hinges->triangles[triangle][k]];
}

// ---- the triangle across an edge

typedef struct Side {
    const float *at[2]; ///< the edge's ends in ascending order of their positions
    uint32_t ends[2];   ///< their vertices
    uint32_t triangle;
    uint8_t corner; ///< of the triangle, where the edge begins
} Side;

static int compare_points(const float a[3], const float b[3]) {
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int compare_positions(const Side *a, const Side *b) {
    const int first = compare_points(a->at[0], b->at[0]);
    return first ? first : compare_points(a->at[1], b->at[1]);
}

static bool is_same_edge(const Side *a, const Side *b) { return a->ends[0] == b->ends[0] && a->ends[1] == b->ends[1]; }

static int side_by_position(const void *a, const void *b) {
    const Side *x = a, *y = b;
    const int position = compare_positions(x, y);
    if (position) return position;
    for (int k = 0; k < 2; k++)
        if (x->ends[k] != y->ends[k]) return x->ends[k] < y->ends[k] ? -1 : 1;
    return (x->triangle > y->triangle) - (x->triangle < y->triangle);
}

static Side side_of(const Hinges *hinges, uint32_t triangle, uint8_t corner) {
    const uint32_t from = hinges->triangles[triangle][corner], to = hinges->triangles[triangle][(corner + 1) % 3];
    const float *p = hinges->position[from], *q = hinges->position[to];
    if (compare_points(p, q) < 0) return (Side){{p, q}, {from, to}, triangle, corner};
    return (Side){{q, p}, {to, from}, triangle, corner};
}

static void hinges_join(Hinges *hinges, const Side *a, const Side *b) {
    hinges->across[a->triangle][a->corner] = b->triangle;
    hinges->across[b->triangle][b->corner] = a->triangle;
    hinges->far[a->triangle][a->corner] = (uint8_t)((b->corner + 2) % 3);
    hinges->far[b->triangle][b->corner] = (uint8_t)((a->corner + 2) % 3);
}

/// Joins the triangles of edges at the same position: two with the same vertices, then two without such a partner, as
/// at a seam.
static void join_at(Hinges *hinges, const Side *sides, size_t count) {
    const Side *alone[2];
    size_t loose = 0;
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && is_same_edge(&sides[i], &sides[end]);) end++;
        if (end - i == 2) hinges_join(hinges, &sides[i], &sides[i + 1]);
        if (end - i == 1 && loose++ < 2) alone[loose - 1] = &sides[i];
    }
    if (loose == 2) hinges_join(hinges, alone[0], alone[1]);
}

static bool join_all(Hinges *hinges) {
    const size_t count = 3 * (size_t)hinges->count;
    Side *sides = malloc(count * sizeof *sides);
    if (!sides) return false;
    for (uint32_t t = 0; t < hinges->count; t++)
        for (uint8_t k = 0; k < 3; k++) sides[3 * (size_t)t + k] = side_of(hinges, t, k), hinges->across[t][k] = NONE;
    qsort(sides, count, sizeof *sides, side_by_position);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && compare_positions(&sides[i], &sides[end]) == 0;) end++;
        join_at(hinges, &sides[i], end - i);
    }
    free(sides);
    return true;
}

// ---- an edge and a triangle

/// Whether the segment p q, which lies in t's plane, has points in t's interior.
static bool runs_inside(const float *p, const float *q, const Corners t) {
    int x = 0, turn = 0;
    for (; x < 3 && !turn; x++) turn = exact_orient2(t[0], t[1], t[2], x, (x + 1) % 3);
    const int y = x-- % 3;
    int left = 0, right = 0;
    for (int k = 0; k < 3; k++) {
        const float *from = t[k], *to = t[(k + 1) % 3];
        if (turn * exact_orient2(from, to, p, x, y) <= 0 && turn * exact_orient2(from, to, q, x, y) <= 0) return false;
        const int side = exact_orient2(p, q, from, x, y);
        left += side > 0;
        right += side < 0;
    }
    return left && right;
}

static bool goes_through(const float *p, const float *q, const float *a, const float *b, const Corners t) {
    const int of_a = exact_orient3(t[0], t[1], t[2], a), of_b = exact_orient3(t[0], t[1], t[2], b);
    return of_a * of_b < 0 && !exact_orient3(t[0], t[1], t[2], p) && !exact_orient3(t[0], t[1], t[2], q) &&
           runs_inside(p, q, t);
}

// ---- an edge and an edge

/// Whether two segments lie on one line and overlap in a length.
static bool share_length(const float *p, const float *q, const float *r, const float *s) {
    if (!exact_collinear(p, q, r) || !exact_collinear(p, q, s)) return false;
    const int k = p[0] != q[0] ? 0 : p[1] != q[1] ? 1 : 2;
    const float low = p[k] < q[k] ? p[k] : q[k], high = p[k] < q[k] ? q[k] : p[k];
    const float min = r[k] < s[k] ? r[k] : s[k], max = r[k] < s[k] ? s[k] : r[k];
    return low < max && min < high;
}

/// Whether the rotation about p q from a to b passes c strictly in between.
static bool is_between(const float *p, const float *q, const float *a, const float *b, const float *c) {
    const int ab = exact_orient3(p, q, a, b), ac = exact_orient3(p, q, a, c), cb = exact_orient3(p, q, c, b);
    if (ab > 0) return ac > 0 && cb > 0;
    if (ab < 0) return ac > 0 || cb > 0;
    return ac > 0;
}

/// Whether a and b, in one plane with p q, lie on the same side of it.
static bool is_folded(const float *p, const float *q, const float *a, const float *b) {
    for (int x = 0; x < 3; x++)
        if (exact_orient2(p, q, a, x, (x + 1) % 3) * exact_orient2(p, q, b, x, (x + 1) % 3) > 0)
            return exact_orient3(p, q, a, b) == 0;
    return false;
}

static bool parts(const float *p, const float *q, const float *a, const float *b, const float *t, const float *u) {
    if (exact_orient3(p, q, a, b) == 0 && is_folded(p, q, a, b)) return false;
    return (is_between(p, q, a, b, t) && is_between(p, q, b, a, u)) ||
           (is_between(p, q, a, b, u) && is_between(p, q, b, a, t));
}

// ---- pairs

/// Whether the two triangles at this corner's edge of `one` cross `two`, in its interior or, with `edges`, at its
/// edges.
static bool crosses_at(const Hinges *hinges, uint32_t one, int corner, uint32_t two, bool edges) {
    const uint32_t other = hinges->across[one][corner];
    if (other == NONE || other == two || other < one) return false;
    Corners a, t;
    corners_of(hinges, one, a);
    corners_of(hinges, two, t);
    const float *p = a[corner], *q = a[(corner + 1) % 3], *third = a[(corner + 2) % 3];
    const float *b = hinges->position[hinges->triangles[other][hinges->far[one][corner]]];
    if (goes_through(p, q, third, b, t)) return true;
    for (int k = 0; edges && k < 3; k++) {
        const uint32_t next = hinges->across[two][k];
        if (next == NONE || next == one || next == other || next < two) continue;
        const float *u = hinges->position[hinges->triangles[next][hinges->far[two][k]]];
        if (share_length(p, q, t[k], t[(k + 1) % 3]) && parts(p, q, third, b, t[(k + 2) % 3], u)) return true;
    }
    return false;
}

static bool pair_crosses(const Hinges *hinges, uint32_t one, uint32_t two) {
    for (int k = 0; k < 3; k++)
        if (crosses_at(hinges, one, k, two, true) || crosses_at(hinges, two, k, one, false)) return true;
    return false;
}

bool hinges_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t triangle_count,
                 uint32_t (*pairs)[2], size_t *count) {
    if (*count == 0) return true;
    Hinges hinges = {.position = position, .triangles = triangles, .count = triangle_count};
    hinges.across = malloc(triangle_count * sizeof *hinges.across);
    hinges.far = calloc(triangle_count, sizeof *hinges.far);
    const bool good = hinges.across && hinges.far && join_all(&hinges);
    size_t kept = 0;
    for (size_t i = 0; good && i < *count; i++) {
        const uint32_t a = pairs[i][0], b = pairs[i][1];
        if (pair_crosses(&hinges, a, b)) {
            pairs[kept][0] = a;
            pairs[kept++][1] = b;
        }
    }
    *count = kept;
    free(hinges.across);
    free(hinges.far);
    return good;
}

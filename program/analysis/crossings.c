// Crossing triangles: the exact test of two, the cases in which they only touch, and the tree that finds near ones.
#include "analysis/crossings.h"
#include "common/order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/exact.h"

// ---- two triangles
//
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

/// Signs of the corners of `b` against the plane of `a`.
static void sides(const Corners a, const Corners b, int sign[3]) {
    for (int k = 0; k < 3; k++) sign[k] = exact_orient3(a[0], a[1], a[2], b[k]);
}

static bool is_edge_in_plane(const int sign[3]) { return (sign[0] == 0) + (sign[1] == 0) + (sign[2] == 0) > 1; }

static bool on_both_sides(const int sign[3]) {
    bool above = false, below = false;
    for (int k = 0; k < 3; k++) {
        above |= sign[k] > 0;
        below |= sign[k] < 0;
    }
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
    a[i] = a[j];
    a[j] = kept;
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

bool triangles_cross(const Corners a, const Corners b, bool *touch) {
    int of_a[3], of_b[3];
    sides(a, b, of_b);
    *touch = is_edge_in_plane(of_b);
    if (!of_b[0] && !of_b[1] && !of_b[2]) { // in one plane
        int x = 0, turn = 0;
        for (; x < 3 && !turn; x++) turn = exact_orient2(a[0], a[1], a[2], x, (x + 1) % 3); // 0: seen edge-on
        const int y = x-- % 3, other = exact_orient2(b[0], b[1], b[2], x, y);
        return turn && !edge_parts(a, turn, b, x, y) && !edge_parts(b, other, a, x, y);
    }

    if (!on_both_sides(of_b)) return false;
    sides(b, a, of_a);
    *touch |= is_edge_in_plane(of_a);
    if (!on_both_sides(of_a)) return false;

    // whether the intervals on the line of the two planes overlap
    const int i = lonely(of_a), j = lonely(of_b);
    Corners s = {a[i], a[(i + 1) % 3], a[(i + 2) % 3]}, t = {b[j], b[(j + 1) % 3], b[(j + 2) % 3]};
    if (of_a[i] < 0) swap(t, 1, 2);
    if (of_b[j] < 0) swap(s, 1, 2);
    return exact_orient3(s[0], s[1], t[0], t[1]) < 0 && exact_orient3(s[0], s[2], t[2], t[0]) < 0;
}

// ---- triangles that touch
//
// An edge pq between triangles with the third corners a and b crosses
//
//   a triangle t in whose plane it lies: if it runs through t's interior, with a and b on opposite sides of t;
//   an edge of t on the same line, between t and u: if they have a length in common, and the half-planes of a and b
//   around the line separate those of t and u.
//
// Together with interiors that meet, these are all cases in which two surfaces cross along a line.

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

static int side_by_position(const void *a, const void *b) {
    const Side *x = a, *y = b;
    const int position = compare_positions(x, y);
    if (position) return position;
    for (int k = 0; k < 2; k++)
        if (x->ends[k] != y->ends[k]) return x->ends[k] < y->ends[k] ? -1 : 1;
    return (x->triangle > y->triangle) - (x->triangle < y->triangle);
}

static void hinges_join(Hinges *hinges, const Side *a, const Side *b) {
    hinges->across[a->triangle][a->corner] = b->triangle;
    hinges->across[b->triangle][b->corner] = a->triangle;
    hinges->far[a->triangle][a->corner] = (uint8_t)((b->corner + 2) % 3);
    hinges->far[b->triangle][b->corner] = (uint8_t)((a->corner + 2) % 3);
}

/// Finds the triangle across each edge. False when out of memory.
static bool join_all(Hinges *hinges) {
    const size_t count = 3 * (size_t)hinges->count;
    Side *sides = malloc(count * sizeof *sides);
    if (!sides) return false;

    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = hinges->triangles[i / 3], from = t[i % 3], to = t[(i + 1) % 3];
        const float *p = hinges->position[from], *q = hinges->position[to];
        const bool up = compare_points(p, q) < 0;
        sides[i] =
            (Side){{up ? p : q, up ? q : p}, {up ? from : to, up ? to : from}, (uint32_t)(i / 3), (uint8_t)(i % 3)};
        hinges->across[i / 3][i % 3] = NONE;
    }

    qsort(sides, count, sizeof *sides, side_by_position);

    // of the edges at one position: two with the same vertices, then two without such a partner, as at a seam
    for (size_t first = 0, last; first < count; first = last) {
        const Side *alone[2];
        size_t loose = 0;
        for (last = first + 1; last < count && compare_positions(&sides[first], &sides[last]) == 0;) last++;
        for (size_t i = first, end; i < last; i = end) {
            const uint32_t *ends = sides[i].ends;
            for (end = i + 1; end < last && sides[end].ends[0] == ends[0] && sides[end].ends[1] == ends[1];) end++;
            if (end - i == 2) hinges_join(hinges, &sides[i], &sides[i + 1]);
            if (end - i == 1 && loose++ < 2) alone[loose - 1] = &sides[i];
        }

        if (loose == 2) hinges_join(hinges, alone[0], alone[1]);
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

/// Whether the half-planes of a and b around p q separate those of t and u.
static bool parts(const float *p, const float *q, const float *a, const float *b, const float *t, const float *u) {
    if (exact_orient3(p, q, a, b) == 0)
        for (int x = 0; x < 3; x++) // a and b on the same side: folded
            if (exact_orient2(p, q, a, x, (x + 1) % 3) * exact_orient2(p, q, b, x, (x + 1) % 3) > 0) return false;
    return (is_between(p, q, a, b, t) && is_between(p, q, b, a, u)) ||
           (is_between(p, q, a, b, u) && is_between(p, q, b, a, t));
}

// ---- touching pairs

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
    const int of_a = exact_orient3(t[0], t[1], t[2], third), of_b = exact_orient3(t[0], t[1], t[2], b);
    if (of_a * of_b < 0 && !exact_orient3(t[0], t[1], t[2], p) && !exact_orient3(t[0], t[1], t[2], q) &&
        runs_inside(p, q, t))
        return true;

    for (int k = 0; edges && k < 3; k++) {
        const uint32_t next = hinges->across[two][k];
        if (next == NONE || next == one || next == other || next < two) continue;
        const float *u = hinges->position[hinges->triangles[next][hinges->far[two][k]]];
        if (share_length(p, q, t[k], t[(k + 1) % 3]) && parts(p, q, third, b, t[(k + 2) % 3], u)) return true;
    }

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
        bool cross = false;
        for (int k = 0; k < 3 && !cross; k++)
            cross = crosses_at(&hinges, a, k, b, true) || crosses_at(&hinges, b, k, a, false);
        if (!cross) continue;
        pairs[kept][0] = a;
        pairs[kept++][1] = b;
    }

    *count = kept;
    free(hinges.across);
    free(hinges.far);
    return good;
}

// ---- the tree
//
// Broad phase: a tree of boxes over the triangles in the order of their centres along a Morton curve. Node k has the
// children 2k + 1 and 2k + 2; the leaves, a power of two of them, are the tree's last level and have equal shares of
// the triangles. Pairs of nodes whose boxes overlap are split until they are leaves: linear in the triangles and the
// pairs that are close, however they are layered.

enum { LEAF = 4, MORTON_BITS = 21 };

typedef struct Box {
    float low[3], high[3];
} Box;

typedef struct Placed {
    uint64_t position; ///< along the curve
    uint32_t triangle;
} Placed;

typedef struct BoxTree {
    const float (*position)[3];
    const uint32_t (*triangles)[3];
    uint32_t count, leaves; ///< leaves: a power of two
    Placed *order;          ///< [count]
    Box *boxes;             ///< [count] of order's triangles
    Box *nodes;             ///< [2 * leaves - 1]
    CrossingList touching;  ///< pairs that hinges_find is to decide
} BoxTree;

static void box_empty(Box *box) {
    for (int k = 0; k < 3; k++) {
        box->low[k] = INFINITY;
        box->high[k] = -INFINITY;
    }
}

static void box_add(Box *box, const float low[3], const float high[3]) {
    for (int k = 0; k < 3; k++) {
        if (low[k] < box->low[k]) box->low[k] = low[k];
        if (high[k] > box->high[k]) box->high[k] = high[k];
    }
}

static bool boxes_meet(const Box *a, const Box *b) {
    for (int k = 0; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return false;
    return true;
}

static Box triangle_box(const BoxTree *tree, uint32_t triangle) {
    Box box;
    box_empty(&box);
    for (int k = 0; k < 3; k++) {
        const float *corner = tree->position[tree->triangles[triangle][k]];
        box_add(&box, corner, corner);
    }
    return box;
}

/// Spreads the low 21 bits to every third bit.
static uint64_t crossings_spread(uint64_t bits) {
    bits = (bits | bits << 32) & 0x001f00000000ffffu;
    bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
    bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
    return (bits | bits << 2) & 0x1249249249249249u;
}

static int box_by_position(const void *a, const void *b) {
    const Placed *x = a, *y = b;
    if (x->position != y->position) return x->position < y->position ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static uint32_t leaf_begin(const BoxTree *tree, uint32_t leaf) {
    return (uint32_t)((uint64_t)leaf * tree->count / tree->leaves);
}

static bool tree_make(BoxTree *tree) {
    tree->leaves = 1;
    while ((uint64_t)tree->leaves * LEAF < tree->count) tree->leaves *= 2;
    tree->order = malloc(tree->count * sizeof *tree->order);
    tree->boxes = malloc(tree->count * sizeof *tree->boxes);
    tree->nodes = malloc((2 * (size_t)tree->leaves - 1) * sizeof *tree->nodes);
    if (!tree->order || !tree->boxes || !tree->nodes) return false;

    // the triangles in the order of their centres along the curve
    Box all;
    box_empty(&all);
    for (uint32_t t = 0; t < tree->count; t++) {
        Box box = triangle_box(tree, t);
        box_add(&all, box.low, box.high);
    }

    double side = 0;
    for (int k = 0; k < 3; k++) {
        double length = (double)all.high[k] - (double)all.low[k];
        if (length > side) side = length;
    }

    const double scale = side > 0 ? ((1 << MORTON_BITS) - 1) / side : 0;
    for (uint32_t t = 0; t < tree->count; t++) {
        Box box = triangle_box(tree, t);
        uint64_t position = 0;
        for (int k = 0; k < 3; k++) {
            double centre = 0.5 * ((double)box.low[k] + (double)box.high[k]);
            position |= crossings_spread((uint64_t)((centre - (double)all.low[k]) * scale)) << k;
        }

        tree->order[t] = (Placed){position, t};
    }

    qsort(tree->order, tree->count, sizeof *tree->order, box_by_position);

    // the boxes from the leaves to the root
    const uint32_t first_leaf = tree->leaves - 1;
    for (uint32_t i = 0; i < tree->count; i++) tree->boxes[i] = triangle_box(tree, tree->order[i].triangle);
    for (uint32_t leaf = 0; leaf < tree->leaves; leaf++) {
        Box *node = &tree->nodes[first_leaf + leaf];
        box_empty(node);
        for (uint32_t i = leaf_begin(tree, leaf); i < leaf_begin(tree, leaf + 1); i++)
            box_add(node, tree->boxes[i].low, tree->boxes[i].high);
    }

    for (uint32_t n = first_leaf; n-- > 0;) {
        tree->nodes[n] = tree->nodes[2 * n + 1];
        box_add(&tree->nodes[n], tree->nodes[2 * n + 2].low, tree->nodes[2 * n + 2].high);
    }

    return true;
}

// ---- pairs

static bool list_add(CrossingList *list, uint32_t a, uint32_t b) {
    if (list->count == list->capacity) {
        size_t capacity = list->capacity ? 2 * list->capacity : 64;
        void *pairs = realloc(list->pairs, capacity * sizeof *list->pairs);
        if (!pairs) return false;
        list->pairs = pairs;
        list->capacity = capacity;
    }

    list->pairs[list->count][0] = a < b ? a : b;
    list->pairs[list->count++][1] = a < b ? b : a;
    return true;
}

/// Tests the pairs of two leaves, or within one, whose boxes meet.
static bool test_leaves(BoxTree *tree, uint32_t a, uint32_t b, CrossingList *list) {
    const float(*position)[3] = tree->position;
    for (uint32_t i = leaf_begin(tree, a); i < leaf_begin(tree, a + 1); i++)
        for (uint32_t j = a == b ? i + 1 : leaf_begin(tree, b); j < leaf_begin(tree, b + 1); j++) {
            if (!boxes_meet(&tree->boxes[i], &tree->boxes[j])) continue;
            const uint32_t one = tree->order[i].triangle, other = tree->order[j].triangle;
            const uint32_t *s = tree->triangles[one], *t = tree->triangles[other];
            const Corners first = {position[s[0]], position[s[1]], position[s[2]]};
            const Corners second = {position[t[0]], position[t[1]], position[t[2]]};
            bool touch;
            list->tested++;
            if (triangles_cross(first, second, &touch)) {
                if (!list_add(list, one, other)) return false;
                continue;
            }

            int shared = 0; // triangles that share an edge have nothing else in common
            for (int k = 0; k < 9; k++) shared += s[k / 3] == t[k % 3];
            if (touch && shared < 2 && !list_add(&tree->touching, one, other)) return false;
        }
    return true;
}

/// Tests the pairs of triangles whose boxes meet. Both nodes are always of the same level, so the stack holds three pairs per level besides the current one.
static bool tree_pairs(BoxTree *tree, CrossingList *list) {
    uint32_t stack[4 * 33][2] = {{0, 0}};
    for (int depth = 1; depth > 0;) {
        const uint32_t a = stack[--depth][0], b = stack[depth][1];
        if (!boxes_meet(&tree->nodes[a], &tree->nodes[b])) continue;
        if (a >= tree->leaves - 1) {
            if (!test_leaves(tree, a - (tree->leaves - 1), b - (tree->leaves - 1), list)) return false;
            continue;
        }
        for (uint32_t i = 1; i <= 2; i++)
            for (uint32_t j = a == b ? i : 1; j <= 2; j++, depth++) {
                stack[depth][0] = 2 * a + i;
                stack[depth][1] = 2 * b + j;
            }
    }

    return true;
}

bool crossings_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t count, CrossingList *list) {
    *list = (CrossingList){0};
    if (count == 0) return true;
    BoxTree tree = {.position = position, .triangles = triangles, .count = count};
    CrossingList *touching = &tree.touching;
    bool good = tree_make(&tree) && tree_pairs(&tree, list) &&
                hinges_find(position, triangles, count, touching->pairs, &touching->count);
    for (size_t i = 0; i < touching->count && good; i++)
        good = list_add(list, touching->pairs[i][0], touching->pairs[i][1]);
    if (list->count) qsort(list->pairs, list->count, sizeof *list->pairs, order_by_two);
    crossings_free(touching);
    free(tree.order);
    free(tree.boxes);
    free(tree.nodes);
    return good;
}

void crossings_free(CrossingList *list) {
    free(list->pairs);
    *list = (CrossingList){0};
}

bool crossings_count(const SingeSurface *surface, uint64_t *pairs, float at[3]) {
    const float(*p)[3] = (const float(*)[3])surface->position;
    uint32_t(*sound)[3] = malloc(((size_t)surface->triangle_count + 1) * sizeof *sound), count = 0;
    CrossingList list = {0};

    if (!sound) return false;

    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *v = surface->triangles[t];
        if (!exact_collinear(p[v[0]], p[v[1]], p[v[2]])) memcpy(sound[count++], v, sizeof *sound);
    }

    const bool good = crossings_find(p, (const uint32_t(*)[3])sound, count, &list);
    *pairs = list.count;
    if (good && list.count) memcpy(at, p[sound[list.pairs[0][0]][0]], 3 * sizeof *at);
    crossings_free(&list);
    free(sound);
    return good;
}

// Broad phase: a tree of boxes over the triangles in the order of their centres along a Morton curve. Node k has the
// children 2k + 1 and 2k + 2; the leaves, a power of two of them, are the tree's last level and have equal shares of
// the triangles. Pairs of nodes whose boxes overlap are split until they are leaves: linear in the triangles and the
// pairs that are close, however they are layered.
#include "analysis/crossings.h"

#include <math.h>
#include <stdlib.h>

#include "analysis/hinges.h"
#include "analysis/triangle_pair.h"

enum { LEAF = 4, MORTON_BITS = 21 };

typedef struct Box {
    float low[3], high[3];
} Box;

typedef struct Placed {
    uint64_t position; ///< along the curve
    uint32_t triangle;
} Placed;

typedef struct Tree {
    const float (*position)[3];
    const uint32_t (*triangles)[3];
    uint32_t count, leaves; ///< leaves: a power of two
    Placed *order;          ///< [count]
    Box *boxes;             ///< [count] of order's triangles
    Box *nodes;             ///< [2 * leaves - 1]
    CrossingList touching;  ///< pairs that hinges.h is to decide
} Tree;

static void box_empty(Box *box) {
    for (int k = 0; k < 3; k++) box->low[k] = INFINITY, box->high[k] = -INFINITY;
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

static Box triangle_box(const Tree *tree, uint32_t triangle) {
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

static uint64_t morton_position(const Box *box, const Box *all, double scale) {
    uint64_t position = 0;
    for (int k = 0; k < 3; k++) {
        double centre = 0.5 * ((double)box->low[k] + (double)box->high[k]);
        position |= crossings_spread((uint64_t)((centre - (double)all->low[k]) * scale)) << k;
    }
    return position;
}

static int box_by_position(const void *a, const void *b) {
    const Placed *x = a, *y = b;
    if (x->position != y->position) return x->position < y->position ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static void put_in_order(Tree *tree) {
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
        tree->order[t] = (Placed){morton_position(&box, &all, scale), t};
    }
    qsort(tree->order, tree->count, sizeof *tree->order, box_by_position);
}

static uint32_t leaf_begin(const Tree *tree, uint32_t leaf) {
    return (uint32_t)((uint64_t)leaf * tree->count / tree->leaves);
}

static void fill_boxes(Tree *tree) {
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
}

static bool tree_make(Tree *tree) {
    tree->leaves = 1;
    while ((uint64_t)tree->leaves * LEAF < tree->count) tree->leaves *= 2;
    tree->order = malloc(tree->count * sizeof *tree->order);
    tree->boxes = malloc(tree->count * sizeof *tree->boxes);
    tree->nodes = malloc((2 * (size_t)tree->leaves - 1) * sizeof *tree->nodes);
    if (!tree->order || !tree->boxes || !tree->nodes) return false;
    put_in_order(tree);
    fill_boxes(tree);
    return true;
}

static void tree_free(Tree *tree) {
    crossings_free(&tree->touching);
    free(tree->order);
    free(tree->boxes);
    free(tree->nodes);
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

/// Whether two triangles share an edge: then they have nothing else in common.
static bool are_neighbours(const uint32_t *s, const uint32_t *t) {
    int same = 0;
    for (int i = 0; i < 9; i++) same += s[i / 3] == t[i % 3];
    return same > 1;
}

static bool test_pair(Tree *tree, uint32_t a, uint32_t b, CrossingList *list) {
    const uint32_t *s = tree->triangles[a], *t = tree->triangles[b];
    const Corners first = {tree->position[s[0]], tree->position[s[1]], tree->position[s[2]]};
    const Corners second = {tree->position[t[0]], tree->position[t[1]], tree->position[t[2]]};
    list->tested++;
    bool touch;
    if (triangles_cross(first, second, &touch)) return list_add(list, a, b);
    return !touch || are_neighbours(s, t) || list_add(&tree->touching, a, b);
}

/// All pairs of two leaves, or within one.
static bool test_leaves(Tree *tree, uint32_t a, uint32_t b, CrossingList *list) {
    for (uint32_t i = leaf_begin(tree, a); i < leaf_begin(tree, a + 1); i++)
        for (uint32_t j = a == b ? i + 1 : leaf_begin(tree, b); j < leaf_begin(tree, b + 1); j++)
            if (boxes_meet(&tree->boxes[i], &tree->boxes[j]) &&
                !test_pair(tree, tree->order[i].triangle, tree->order[j].triangle, list))
                return false;
    return true;
}

/// Both nodes are always of the same level, so the stack holds three pairs per level besides the current one.
static bool tree_pairs(Tree *tree, CrossingList *list) {
    uint32_t stack[4 * 33][2] = {{0, 0}};
    for (int depth = 1; depth > 0;) {
        const uint32_t a = stack[--depth][0], b = stack[depth][1];
        if (!boxes_meet(&tree->nodes[a], &tree->nodes[b])) continue;
        if (a >= tree->leaves - 1) {
            if (!test_leaves(tree, a - (tree->leaves - 1), b - (tree->leaves - 1), list)) return false;
            continue;
        }
        for (uint32_t i = 1; i <= 2; i++)
            for (uint32_t j = a == b ? i : 1; j <= 2; j++, depth++)
                stack[depth][0] = 2 * a + i, stack[depth][1] = 2 * b + j;
    }
    return true;
}

/// Adds the touching pairs that cross nevertheless.
static bool add_hinges(Tree *tree, CrossingList *list) {
    CrossingList *touching = &tree->touching;
    if (!hinges_find(tree->position, tree->triangles, tree->count, touching->pairs, &touching->count)) return false;
    for (size_t i = 0; i < touching->count; i++)
        if (!list_add(list, touching->pairs[i][0], touching->pairs[i][1])) return false;
    return true;
}

static int by_numbers(const void *a, const void *b) {
    const uint32_t *x = a, *y = b;
    const int k = x[0] == y[0];
    return (x[k] > y[k]) - (x[k] < y[k]);
}

bool crossings_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t count, CrossingList *list) {
    *list = (CrossingList){0};
    if (count == 0) return true;
    Tree tree = {.position = position, .triangles = triangles, .count = count};
    const bool good = tree_make(&tree) && tree_pairs(&tree, list) && add_hinges(&tree, list);
    if (list->count) qsort(list->pairs, list->count, sizeof *list->pairs, by_numbers);
    tree_free(&tree);
    return good;
}

void crossings_free(CrossingList *list) {
    free(list->pairs);
    *list = (CrossingList){0};
}

// Cuts polygons into triangles that cover exactly their area.
//
// A polygon is projected along its normal, the mean of its vertex products (Newell), onto the plane of two axes. It may
// touch itself: a hole is connected by a bridge, a side that the ring follows twice, and corners may share a vertex. If
// all triangles have the winding of the polygon, they cover each point as often as the polygon winds around it. The
// triangles are also checked for overlaps, so the points inside are covered once and all others never. A polygon that
// cannot be cut like this crosses itself.
//
// Small polygons are cut so that the smallest angle is largest, by parts of the ring (Klincsek, 1980). From large ones
// the best corner is cut off (Meisters' ears, 1975) until they are small.
#include "mesh/polygon.h"

#include "common/real.h"
#include "common/order.h"

#include <stdlib.h>
#include <string.h>

#define DEGREES (180 / 3.14159265358979323846)

/// Factor on the worth of a triangle with a diagonal between vertices that already have a side.
static const double taken_worth = 1e-3;
/// Max fold, in degrees, of a quad that crosses itself only in its projection along the mean of its normals.
static const double fold_max = 150;

bool polygon_begin(PolygonCut *cut, Work *work, const Faces *faces) {
    uint32_t max = 3;
    for (uint32_t f = 0; f < faces->count; f++)
        if (faces->first[f + 1] - faces->first[f] > max) max = faces->first[f + 1] - faces->first[f];
    max *= POLYGON_GROWTH;
    *cut = (PolygonCut){.work = work, .faces = faces, .capacity = max};
    cut->at = work_new(work, max, sizeof *cut->at);
    cut->ring = work_new(work, max, sizeof *cut->ring);
    cut->worth = work_new(work, max, sizeof *cut->worth);
    cut->triangle = work_new(work, max, sizeof *cut->triangle);

    return !work->no_memory;
}

// ---- projection along the normal

static const double *position_of(const PolygonCut *cut, uint32_t half) {
    return cut->work->position[cut->faces->corner[half]];
}

void polygon_normal(const PolygonCut *cut, const uint32_t *ring, uint32_t n, double normal[3]) {
    const double *o = position_of(cut, ring[0]);
    normal[0] = normal[1] = normal[2] = 0;
    for (uint32_t i = 1; i + 1 < n; i++) {
        double a[3], b[3], m[3];
        sub3(position_of(cut, ring[i]), o, a);
        sub3(position_of(cut, ring[i + 1]), o, b);
        cross3(a, b, m);
        for (int k = 0; k < 3; k++) normal[k] += m[k];
    }
}

/// Positions without the normal's largest axis, oriented so that the polygon runs counter-clockwise. Their differences
/// are those in the file.
static void project(PolygonCut *cut, const uint32_t *ring, uint32_t n, const double normal[3]) {
    int axis = fabs(normal[1]) > fabs(normal[0]) ? 1 : 0;
    if (fabs(normal[2]) > fabs(normal[axis])) axis = 2;
    const int u = (axis + (normal[axis] < 0 ? 2 : 1)) % 3, v = (axis + (normal[axis] < 0 ? 1 : 2)) % 3;
    for (uint32_t i = 0; i < n; i++) {
        const double *p = position_of(cut, ring[i]);
        cut->at[i][0] = p[u];
        cut->at[i][1] = p[v];
    }
}

/// Twice the area of a triangle, negative if it is clockwise.
static double turn2(const double *a, const double *b, const double *c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether all sides of a ring are visible from the mean of its corners and wind around it once.
static bool is_star(double (*at)[2], uint32_t n) {
    double centroid[2] = {0, 0};
    uint32_t rounds = 0; // a ring that winds twice crosses the centroid's height upwards twice

    for (uint32_t i = 0; i < n; i++)
        for (int k = 0; k < 2; k++) centroid[k] += at[i][k] / n;
    for (uint32_t i = 0; i < n; i++) {
        const double *a = at[i], *b = at[(i + 1) % n];
        if (!(turn2(centroid, a, b) > 0)) return false;
        rounds += a[1] < centroid[1] && b[1] >= centroid[1];
    }

    return rounds == 1;
}

bool polygon_is_star(PolygonCut *cut, const uint32_t *ring, uint32_t n) {
    double normal[3], centroid[2] = {0, 0}, quad[4][2];
    polygon_normal(cut, ring, n, normal);
    project(cut, ring, n, normal);
    bool star = is_star(cut->at, n);

    // the quads into which the polygon would be split (to_quads.c)
    for (uint32_t i = 0; i < n; i++)
        for (int k = 0; k < 2; k++) centroid[k] += cut->at[i][k] / n;
    for (uint32_t i = 0; i < n && star; i++) {
        for (int k = 0; k < 2; k++) {
            quad[0][k] = cut->at[i][k];
            quad[1][k] = 0.5 * (cut->at[i][k] + cut->at[(i + 1) % n][k]);
            quad[2][k] = centroid[k];
            quad[3][k] = 0.5 * (cut->at[i][k] + cut->at[(i + n - 1) % n][k]);
        }
        star = is_star(quad, 4);
    }

    return star;
}

// ---- worth of a triangle

static double angle_at(const PolygonCut *cut, uint32_t a, uint32_t b, uint32_t c) {
    double p[3], q[3];
    sub3(position_of(cut, a), position_of(cut, b), p);
    sub3(position_of(cut, c), position_of(cut, b), q);
    double square = dot3(p, p) * dot3(q, q);
    return square > 0 ? DEGREES * acos(double_max(-1, double_min(1, dot3(p, q) / sqrt(square)))) : 0;
}

/// A triangle's smallest angle, in degrees; negative if it is flipped or has no area. Corners are indices of the ring.
static double worth_of(const PolygonCut *cut, uint32_t i, uint32_t k, uint32_t j) {
    const uint32_t a = cut->ring[i], b = cut->ring[k], c = cut->ring[j];
    double min = double_min(angle_at(cut, a, b, c), double_min(angle_at(cut, b, c, a), angle_at(cut, c, a, b)));
    return turn2(cut->at[i], cut->at[k], cut->at[j]) > 0 ? min : -1 - min;
}

/// Factor on the worth of a triangle with a diagonal between corners a and b of the ring: small if the two vertices are
/// one, or some face has a side between them.
static double worth_by_diagonal(PolygonCut *cut, uint32_t a, uint32_t b) {
    const Faces *faces = cut->faces;
    const uint32_t v = faces->corner[cut->ring[a]], w = faces->corner[cut->ring[b]];
    if (v == w) return taken_worth;
    if (!cut->order) cut->order = work_sorted_edges(cut->work);
    if (!cut->order) return 1;

    const uint32_t ends[2] = {v < w ? v : w, v < w ? w : v};
    uint32_t from = 0, to = faces->corner_count;
    while (from < to) {
        uint32_t at = (from + to) / 2, p = faces->corner[cut->order[at]];
        uint32_t q = faces->corner[faces_next(faces, cut->work->face, cut->order[at])];
        uint32_t low = p < q ? p : q, high = p < q ? q : p;
        if (low == ends[0] && high == ends[1]) return taken_worth;
        if (low < ends[0] || (low == ends[0] && high < ends[1])) from = at + 1;
        else to = at;
    }

    return 1;
}

static void add_triangle(PolygonCut *cut, uint32_t i, uint32_t k, uint32_t j) {
    uint32_t *triangle = cut->triangle[cut->count++];
    triangle[0] = cut->ring[i];
    triangle[1] = cut->ring[k];
    triangle[2] = cut->ring[j];
}

// ---- large polygons

/// Whether `p` lies between the directions from `a` to `b` and to `c`, which are less than half a turn apart.
static bool in_wedge(const double *a, const double *b, const double *c, const double *p) {
    return turn2(a, b, p) > 0 && turn2(a, p, c) > 0;
}

/// How well corner k of the ring can be cut off; negative if it cannot, because another corner lies in that ear, or the
/// ring enters the ear from a corner at the same position as one of the ear's.
static double ear_worth(PolygonCut *cut, uint32_t n, uint32_t k) {
    const uint32_t a = (k + n - 1) % n, c = (k + 1) % n;
    const double *const ear[3] = {cut->at[a], cut->at[k], cut->at[c]};
    double worth = worth_of(cut, a, k, c), low[2], high[2];
    for (int axis = 0; axis < 2; axis++) {
        low[axis] = double_min(ear[0][axis], double_min(ear[1][axis], ear[2][axis]));
        high[axis] = double_max(ear[0][axis], double_max(ear[1][axis], ear[2][axis]));
    }

    for (uint32_t i = 0; i < n && worth >= 0; i++) {
        const double *p = cut->at[i], *before = cut->at[(i + n - 1) % n], *after = cut->at[(i + 1) % n];
        if (p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1]) continue;
        if (i == a || i == k || i == c) continue;

        int same = 0;
        while (same < 3 && !(p[0] == ear[same][0] && p[1] == ear[same][1])) same++;
        const double *o = ear[same % 3], *q = ear[(same + 1) % 3], *r = ear[(same + 2) % 3];
        const bool enters = same < 3 ? in_wedge(o, q, r, before) || in_wedge(o, q, r, after)
                                     : turn2(o, q, p) >= 0 && turn2(q, r, p) >= 0 && turn2(r, o, p) >= 0;
        if (enters) worth = -1;
    }

    return worth >= 0 ? worth * worth_by_diagonal(cut, a, c) : worth;
}

// ---- small polygons

enum { BEST_CUT_MAX = 40 };

/// Adds the triangles whose worst one is best. False if some are flipped.
static bool cut_best(PolygonCut *cut, uint32_t n) {
    double worst[BEST_CUT_MAX][BEST_CUT_MAX];
    uint8_t apex[BEST_CUT_MAX][BEST_CUT_MAX], stack[2 * BEST_CUT_MAX][2];
    for (uint32_t span = 1; span < n; span++)
        for (uint32_t i = 0; i + span < n; i++) {
            uint32_t j = i + span;
            worst[i][j] = span == 1 ? 180 : -1e9;
            for (uint32_t k = i + 1; k < j; k++) {
                double value = double_min(worth_of(cut, i, k, j), double_min(worst[i][k], worst[k][j]));
                if (value > worst[i][j]) {
                    worst[i][j] = value;
                    apex[i][j] = (uint8_t)k;
                }
            }
            if (span > 1 && span + 1 < n && worst[i][j] > 0) worst[i][j] *= worth_by_diagonal(cut, i, j);
        }
    if (worst[0][n - 1] < 0) return false;

    uint32_t depth = 1;
    stack[0][0] = 0;
    stack[0][1] = (uint8_t)(n - 1);
    while (depth) {
        uint32_t i = stack[--depth][0], j = stack[depth][1];
        if (j - i < 2) continue;
        uint32_t k = apex[i][j];
        add_triangle(cut, i, k, j);
        stack[depth][0] = (uint8_t)i;
        stack[depth++][1] = (uint8_t)k;
        stack[depth][0] = (uint8_t)k;
        stack[depth++][1] = (uint8_t)j;
    }

    return true;
}

bool polygon_cut(PolygonCut *cut, const uint32_t *ring, uint32_t n) {
    double normal[3];
    polygon_normal(cut, ring, n, normal);
    project(cut, ring, n, normal);
    memcpy(cut->ring, ring, n * sizeof *ring);

    // ears, until few enough corners are left for the best cut
    uint32_t left = n;
    enum { LOOKS_MAX = 16 }; // an ear may come free when another is gone
    for (uint32_t looks = 0; looks < LOOKS_MAX && left > BEST_CUT_MAX; looks++) {
        for (uint32_t k = 0; k < left; k++) cut->worth[k] = ear_worth(cut, left, k);
        while (left > BEST_CUT_MAX) {
            uint32_t best = 0;
            for (uint32_t k = 1; k < left; k++)
                if (cut->worth[k] > cut->worth[best]) best = k;
            if (cut->worth[best] < 0) break;

            const uint32_t after = left - 1 - best;
            add_triangle(cut, (best + left - 1) % left, best, (best + 1) % left);
            memmove(cut->ring + best, cut->ring + best + 1, after * sizeof *cut->ring);
            memmove(cut->at + best, cut->at + best + 1, after * sizeof *cut->at);
            memmove(cut->worth + best, cut->worth + best + 1, after * sizeof *cut->worth);
            left--;

            const uint32_t beside[2] = {(best + left - 1) % left, best % left};
            for (int i = 0; i < 2; i++) cut->worth[beside[i]] = ear_worth(cut, left, beside[i]);
        }
    }

    if (left > BEST_CUT_MAX) return false;
    if (cut_best(cut, left)) return true;
    if (n != 4) return false;

    // a quad that is too bent for its normal to be useful is cut along the diagonal at which it is folded less
    double best = fold_max;
    uint32_t start = 4;
    for (uint32_t s = 0; s < 2; s++) {
        const uint32_t a[3] = {cut->ring[s], cut->ring[s + 1], cut->ring[s + 2]};
        const uint32_t b[3] = {cut->ring[s], cut->ring[s + 2], cut->ring[(s + 3) % 4]};
        double p[3], q[3];
        polygon_normal(cut, a, 3, p);
        polygon_normal(cut, b, 3, q);

        double square = dot3(p, p) * dot3(q, q);
        double fold = square > 0 ? DEGREES * acos(double_max(-1, double_min(1, dot3(p, q) / sqrt(square)))) : 180;
        if (fold < best) {
            best = fold;
            start = s;
        }
    }

    if (start > 1) return false;
    add_triangle(cut, start, start + 1, start + 2);
    add_triangle(cut, start, start + 2, (start + 3) % 4);
    return true;
}

// ---- overlapping triangles

typedef struct Seen {
    double low, high; ///< along the first axis
    double at[3][2];
} Seen;

/// Whether the second triangle lies beyond a side of the first, or on it.
static bool lies_beyond(const Seen *a, const Seen *b, double rounding) {
    for (int k = 0; k < 3; k++) {
        const double *p = a->at[k], *q = a->at[(k + 1) % 3];
        if (turn2(p, q, b->at[0]) <= rounding && turn2(p, q, b->at[1]) <= rounding && turn2(p, q, b->at[2]) <= rounding)
            return true;
    }
    return false;
}

bool polygon_overlaps(PolygonCut *cut, const double normal[3]) {
    Seen *seen = malloc((cut->count ? cut->count : 1) * sizeof *seen);
    double low = INFINITY, high = -INFINITY;
    cut->work->no_memory = cut->work->no_memory || !seen;
    if (!seen) return false;

    for (uint32_t t = 0; t < cut->count; t++) {
        Seen *own = &seen[t];
        project(cut, cut->triangle[t], 3, normal);
        const bool turned = turn2(cut->at[0], cut->at[1], cut->at[2]) < 0;
        for (int k = 0; k < 3; k++) memcpy(own->at[k], cut->at[turned ? 2 - k : k], sizeof own->at[k]);
        own->low = double_min(own->at[0][0], double_min(own->at[1][0], own->at[2][0]));
        own->high = double_max(own->at[0][0], double_max(own->at[1][0], own->at[2][0]));
        low = double_min(low, own->low);
        high = double_max(high, own->high);
    }

    const double rounding = 1e-7 * (high - low) * (high - low);
    bool overlaps = false;

    qsort(seen, cut->count, sizeof *seen, order_by_double);
    for (uint32_t i = 0; i < cut->count && !overlaps; i++)
        for (uint32_t k = i + 1; k < cut->count && seen[k].low < seen[i].high && !overlaps; k++)
            overlaps = !lies_beyond(&seen[i], &seen[k], rounding) && !lies_beyond(&seen[k], &seen[i], rounding);
    free(seen);
    return overlaps;
}

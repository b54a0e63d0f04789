// Nearest points of all features of two cells: a node against the four triangles of the other at once, an edge against
// its four sides and against the four lines to its centroid. The regions are those of Ericson, Real-time collision
// detection (2005), 5.1.5 and 5.1.9, as in feature_distance.c, but chosen by masks.
#include "collision/narrow_phase.h"

#include <math.h>

static inline Float4 narrow_clamp01(Float4 a) { return float4_min(float4_max(a, float4_all(0)), float4_all(1)); }

/// Four pairs of points: the vector from the second to the first, its squared length, and their positions on the
/// features.
typedef struct FourNear {
    FourVectors separation;
    Float4 square, u, v;
    Float4Mask faces;
} FourNear;

/// Point p and triangles a b c: u, v are the weights of b and c.
static FourNear from_triangles(FourVectors p, FourVectors a, FourVectors b, FourVectors c) {
    FourVectors ab = four_minus(b, a), ac = four_minus(c, a);
    FourVectors ap = four_minus(p, a), bp = four_minus(p, b), cp = four_minus(p, c);
    Float4 d1 = four_dot(ab, ap), d2 = four_dot(ac, ap), d3 = four_dot(ab, bp), d4 = four_dot(ac, bp);
    Float4 d5 = four_dot(ab, cp), d6 = four_dot(ac, cp), zero = {0}, one = float4_all(1);
    Float4 vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    Float4 sum = va + vb + vc, e43 = d4 - d3, e56 = d5 - d6;
    FourNear out;
    out.faces = (va > 0) & (vb > 0) & (vc > 0);
    Float4 u = vb / sum, v = vc / sum;

    // regions later in this list come before the others
    Float4Mask on_bc = (va <= 0) & (e43 >= 0) & (e56 >= 0), on_ac = (vb <= 0) & (d2 >= 0) & (d6 <= 0);
    Float4Mask on_ab = (vc <= 0) & (d1 >= 0) & (d3 <= 0);
    Float4 w = e43 / (e43 + e56);
    u = float4_select(on_bc, one - w, u);

    v = float4_select(on_bc, w, v);
    u = float4_select(on_ac, zero, u);
    v = float4_select(on_ac, d2 / (d2 - d6), v);
    u = float4_select(on_ab, d1 / (d1 - d3), u);
    v = float4_select(on_ab, zero, v);

    Float4Mask at_a = (d1 <= 0) & (d2 <= 0), at_b = (d3 >= 0) & (d4 <= d3), at_c = (d6 >= 0) & (d5 <= d6);
    u = float4_select(at_c, zero, u);
    v = float4_select(at_c, one, v);
    u = float4_select(at_b, one, u);
    v = float4_select(at_b, zero, v);

    // a triangle without area has no weights in its interior: then its first corner is used
    at_a |= ~((u > -0.5f) & (v > -0.5f) & (u + v < 2));
    out.u = float4_select(at_a, zero, u);
    out.v = float4_select(at_a, zero, v);
    out.separation = four_along(four_along(ap, -out.u, ab), -out.v, ac);
    out.square = four_dot(out.separation, out.separation);
    return out;
}

/// Segment a b and segments c d: u is along the one, v along the others.
static FourNear from_segments(FourVectors a, FourVectors b, FourVectors c, FourVectors d) {
    FourVectors along = four_minus(b, a), others = four_minus(d, c), r = four_minus(a, c);
    Float4 uu = four_dot(along, along), vv = four_dot(others, others), uv = four_dot(along, others);
    Float4 ur = four_dot(along, r), vr = four_dot(others, r), zero = {0}, one = float4_all(1);
    Float4 determinant = uu * vv - uv * uv;
    Float4 s = narrow_clamp01((uv * vr - ur * vv) / determinant);
    s = float4_select(determinant > 4e-7f * uu * vv, s, zero);
    Float4 t = float4_select(vv > 0, (uv * s + vr) / vv, zero);
    Float4Mask out_of_range = ~((t >= 0) & (t <= 1));

    t = narrow_clamp01(t);
    Float4 mended = float4_select(uu > 0, narrow_clamp01((t * uv - ur) / uu), zero);
    s = float4_select(out_of_range, mended, s);
    FourNear out = {.u = s, .v = t};
    out.separation = four_along(four_along(r, s, along), -t, others);
    out.square = four_dot(out.separation, out.separation);

    // if an end is the nearest point, that node's triangles find it too; and nearly parallel edges, less than 10
    // degrees apart, would make ridges of a flat sheet
    out.faces = (s > 0) & (s < one) & (t > 0) & (t < one) & (uv * uv < 0.97f * uu * vv);
    return out;
}

// ---- cells

void narrow_cell_set(const CollisionPlan *plan, const Shell *shell, uint32_t cell, const float (*x)[4], Float4 origin,
                     NarrowCell *out) {
    collision_nodes(shell->cells[cell], x, origin, out->node);
    out->corner = four_of(out->node);
    out->turned = four_turned(out->corner);
    const Float4 *p = out->node; // the centroid lies between
    out->low = float4_min(float4_min(p[0], p[1]), float4_min(p[2], p[3]));
    out->high = float4_max(float4_max(p[0], p[1]), float4_max(p[2], p[3]));
    uint32_t owned = plan->owned[cell];
    out->owned = (owned & 15) | 16 | (owned >> 4) << 8 | 15u << 12;
    out->has_slab = out->has_triangles = false;
}

float narrow_boxes_distance(const NarrowCell *a, const NarrowCell *b) {
    Float4 gap = float4_max(float4_max(b->low - a->high, a->low - b->high), float4_all(0));
    return sqrtf(float4_dot(gap, gap));
}

/// As narrow_slabs_distance, for the planes through a's diagonals only.
static float separation_along(NarrowCell *a, const NarrowCell *b) {
    if (!a->has_slab) {
        a->has_slab = true;
        Float4 normal = float4_cross(a->node[2] - a->node[0], a->node[3] - a->node[1]);
        float square = float4_dot(normal, normal);
        a->length = square > 0 ? sqrtf(square) : 0;
        a->normal = four_all(normal);
        Float4 along = four_dot(a->normal, a->corner); // the centroid lies between
        a->slab_low = float4_smallest(along);
        a->slab_high = float4_largest(along);
    }

    if (!(a->length > 0)) return -1;
    Float4 along = four_dot(a->normal, b->corner);
    float above = a->slab_low - float4_largest(along), below = float4_smallest(along) - a->slab_high;
    return (above > below ? above : below) / a->length;
}

float narrow_slabs_distance(NarrowCell *a, NarrowCell *b) {
    float one = separation_along(a, b), two = separation_along(b, a);
    return one > two ? one : two;
}

// Rounding by eps moves a triangle's nearest point along its longest side l by about l eps (l^2 / 2 area)^2: four
// products of lengths over the square of the area. Edges are taken for parallel below 6e-4 rad, with an error of half
// of that.
float narrow_error_bound(const NarrowCell *cell) {
    const float eps = 6e-8f, parallel = 3e-4f;
    FourVectors arm = four_minus(cell->corner, four_all(cell->node[4]));
    FourVectors normal = four_cross(arm, four_turned(arm));
    float square = 4 * float4_largest(four_dot(arm, arm)), area = float4_smallest(four_dot(normal, normal));
    float slim = area > 0 ? square * square / area : INFINITY;
    return sqrtf(square) * (eps * slim + parallel);
}

// ---- all features

typedef struct Search {
    NearFeatures *near;
    int count;
    float far;               ///< m, search distance
    Float4 square;           ///< smallest so far of each of the four
    Float4 listed, adjacent; ///< squares of those of a FeatureRange; adjacent is -1 for edges
} Search;

/// Lists those of four that are near enough; only those in `meet` count.
static void narrow_note(Search *search, const FourNear *four, unsigned meet, int kind, int first, int second,
                        float sign) {
    const Float4Mask bits = {1, 2, 4, 8};
    Float4Mask counts = (bits & (int32_t)meet) != 0;
    search->square = float4_select(counts, float4_min(four->square, search->square), search->square);
    meet &=
        float4_bits((four->square <= search->listed) &
                    (four->faces | (four->square <= (kind == COLLISION_EDGES ? float4_all(-1) : search->adjacent))));

    for (; meet; meet &= meet - 1) {
        int k = __builtin_ctz(meet);
        search->near[search->count++] = (NearFeatures){
            .separation = sign * (Float4){four->separation.x[k], four->separation.y[k], four->separation.z[k], 0},
            .distance = sqrtf(four->square[k]),
            .u = four->u[k],
            .v = four->v[k],
            .kind = (uint8_t)kind,
            .first = (uint8_t)first,
            .second = (uint8_t)(second + k)};
    }
}

/// Bits of the nodes that are in the box from `low` to `high`.
static inline unsigned nodes_within(const NarrowCell *cell, Float4 low, Float4 high) {
    const FourVectors *p = &cell->corner;
    Float4Mask in = (p->x >= float4_all(low[0])) & (p->x <= float4_all(high[0]));
    in &= (p->y >= float4_all(low[1])) & (p->y <= float4_all(high[1]));
    in &= (p->z >= float4_all(low[2])) & (p->z <= float4_all(high[2]));
    Float4Mask centroid = (cell->node[4] >= low) & (cell->node[4] <= high);
    return float4_bits(in) | (unsigned)((float4_bits(centroid) & 7) == 7) << 4;
}

/// Nodes that p owns against triangles of q; bits of same[i] are the corners of q that are corner i of p.
static void find_nodes(Search *search, const NarrowCell *p, NarrowCell *q, const unsigned same[4], int kind) {
    unsigned near = nodes_within(p, q->low - search->far, q->high + search->far) & p->owned;
    if (!near) return;

    if (!q->has_triangles) q->triangles = narrow_triangles(q->corner, q->corner, q->node[4], q->node[4]);
    q->has_triangles = true;
    FourVectors centroid = four_all(q->node[4]);
    for (; near; near &= near - 1) {
        const int i = __builtin_ctz(near);
        unsigned meet = four_meet(&q->triangles, p->node[i] - search->far, p->node[i] + search->far);
        if (i < 4) meet &= ~narrow_around(same[i]);
        if (!meet) continue;

        FourNear four = from_triangles(four_all(p->node[i]), q->corner, q->turned, centroid);
        narrow_note(search, &four, meet, kind, i, 0, kind == COLLISION_NODE_OF_B ? -1 : 1);
    }
}

int narrow_features(const Shell *shell, const CollisionPair *pair, NarrowCell *a, NarrowCell *b,
                    const FeatureRange *far, NearFeatures *near, float *nearest) {
    const uint32_t *p = shell->cells[pair->a], *q = shell->cells[pair->b];
    unsigned of_b[4], of_a[4];
    collision_same(p, q, of_b);
    collision_same(q, p, of_a);

    Search search = {.near = near,
                     .far = far->measured,
                     .square = float4_all(far->measured * far->measured),
                     .listed = float4_all(far->listed * far->listed),
                     .adjacent = float4_all(far->adjacent * far->adjacent)};

    find_nodes(&search, a, b, of_b, COLLISION_NODE_OF_A);
    find_nodes(&search, b, a, of_a, COLLISION_NODE_OF_B);

    *nearest = sqrtf(float4_smallest(search.square));
    if (!far->edges) return search.count;

    // edges that a owns against edges of b
    FourVectors centroid = four_all(b->node[4]);
    const FourBoxes sides_of_b = narrow_sides(b->corner, b->corner);
    const FourBoxes spokes_of_b = narrow_spokes(b->corner, b->corner, b->node[4], b->node[4]);
    for (int i = 0; i < 8; i++) {
        if (!(a->owned >> (8 + i) & 1)) continue;

        const uint8_t *k = collision_edge[i];
        unsigned corners = of_b[k[0]] | (k[1] < 4 ? of_b[k[1]] : 0);
        Float4 start = a->node[k[0]], end = a->node[k[1]];
        Float4 low = float4_min(start, end) - search.far, high = float4_max(start, end) + search.far;
        unsigned sides = four_meet(&sides_of_b, low, high) & b->owned >> 8 & ~narrow_around(corners);
        unsigned spokes = four_meet(&spokes_of_b, low, high) & ~corners;

        if (sides) {
            FourNear four = from_segments(four_all(start), four_all(end), b->corner, b->turned);
            narrow_note(&search, &four, sides, COLLISION_EDGES, i, 0, 1);
        }

        if (spokes) {
            FourNear four = from_segments(four_all(start), four_all(end), b->corner, centroid);
            narrow_note(&search, &four, spokes, COLLISION_EDGES, i, 4, 1);
        }
    }

    *nearest = sqrtf(float4_smallest(search.square));
    return search.count;
}

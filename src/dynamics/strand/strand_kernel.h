// The projection of one group of strands, with one strand per lane. One file per instruction set defines LANES, the
// vector type Lanes, Float4s (a particle of every lane: its position and its inverse mass), LaneNode (the same, with x of
// all lanes contiguous, then y) and the operations on them, and includes this. Every operation rounds according to IEEE
// 754 and lanes never mix, so all instruction sets give the same bytes.
//
// Constraint of a spring of target length l between nodes a and b, row-normalised, d = x_b - x_a,
// u = d/|d|: eq 10 over the length of its gradient (eq 11) is
//
//   C = (|d|^2 - l^2) / (2 |d|)
//
// Eq 16 and 19 with masses, w = 1/m: (J M^-1 J^T + S) lambda = W C, x_a += w_a u lambda, x_b -= w_b u lambda, with
// S = c/h^2 + (r/2 + y max(C/|d| - g, 0)) (w_a + w_b), the compliance c, the regularisation r, y = STRAND_YIELD and
// g = STRAND_COMPLIANT. The last term is for constraints that cannot be satisfied, of a strand pulled beyond its length
// between two pins. There lambda would grow to C/r, but a substep can only take a pull w lambda of about |d|; beyond
// that it throws nodes that are slightly out of line from side to side. With y it stays below |d|/y. Springs within a
// hundredth of their length are not affected.
//
// Every row is multiplied by its |d|. With the unknown mu = lambda/|d| this needs neither square roots nor unit
// vectors. Let D = |d|^2 and E = |d| C = (D - l^2)/2. Along a chain, spring k shares node k with spring k - 1, so the
// matrix is tridiagonal:
//
//   diagonal     (w_k + w_(k+1)) ((1 + r/2) D + y max(E - g D, 0)) + (c/h^2) D
//   off-diagonal -w_k (d_(k-1) . d_k)
//   right side   W E
//
// and x_a += w_a d mu, x_b -= w_b d mu. The Thomas algorithm solves it. A ring adds one corner entry, handled by the
// Sherman-Morrison formula. Chains of constraints solved in linear time: Bender and Bayer, VRIPHYS 2008; fast
// projection: Goldenthal et al. 2007. Springs that are gone have weight 0 and decouple the chain.
#include "dynamics/strand/strand_lanes.h"

#include <math.h>

/// g above; y is in strand_lanes.h.
#define STRAND_COMPLIANT 0.01f

/// A spring of every lane: d, W E, the diagonal.
typedef struct Row {
    Lanes dx, dy, dz, right, diagonal;
} Row;

/// Values of a row that are kept between elimination and substitution.
enum { KEEP_RIGHT, KEEP_FACTOR, KEEP_CYCLIC };

typedef struct Group {
    float *position;
    const uint32_t *node, *contiguous;
    const float *target, *weight, *compliance; ///< compliance: NULL where it is the same everywhere
    uint32_t rows;
    size_t stride;                  ///< floats from one quadruple to the next where particles are contiguous
    float *keep, *first_contiguous; ///< first_contiguous: `position` seen from this part's first lane
    float *pull;                    ///< sums of mu, or NULL
    Lanes softness, inverse_h2;     ///< 1 + r/2, 1/h^2
    Lanes stiff;                    ///< c/h^2 where c is the same everywhere
} Group;

static inline float *keep_at(const Group *group, uint32_t row, int what) {
    return group->keep + ((size_t)row * STRAND_KEEP + (size_t)what) * LANES;
}

static inline Float4s group_float4s(const Group *group, uint32_t k) {
    uint32_t first = group->contiguous[k];
    if (first != STRAND_GATHERED) return float4s_load_contiguous(group->first_contiguous + first, group->stride);
    return float4s_gather(group->position, group->node + (size_t)k * STRAND_LANES);
}

static inline void group_put(const Group *group, uint32_t k, const Float4s *float4s) {
    uint32_t first = group->contiguous[k];
    if (first != STRAND_GATHERED) float4s_store_contiguous(group->first_contiguous + first, group->stride, float4s);
    else float4s_scatter(group->position, group->node + (size_t)k * STRAND_LANES, float4s);
}

static inline LaneNode group_node(const Group *group, uint32_t k) {
    Float4s float4s = group_float4s(group, k);
    return float4s_node(&float4s);
}

static inline Row group_row(const Group *restrict group, uint32_t k, const LaneNode *a, const LaneNode *b) {
    size_t slot = (size_t)k * STRAND_LANES;
    Lanes target = lanes_load(group->target + slot), weight = lanes_load(group->weight + slot);
    Lanes dx = b->x - a->x, dy = b->y - a->y, dz = b->z - a->z;
    Lanes square = dx * dx + dy * dy + dz * dz;
    Lanes e = square - target; // twice E, as `weight` is half of W
    // a spring crushed below sqrt(2) - 1 of its length has hardly a direction: its row asks for at most C = -l
    if (__builtin_expect(lanes_any_less(e + square, lanes_all(0)), 0)) { // shorter than l/sqrt(2)
        Lanes crushed = target * lanes_all(0.17157288f);
        e = lanes_where_less(square, crushed, lanes_all(-2) * lanes_sqrt(target) * lanes_sqrt(square), e);
    }
    Lanes beyond = lanes_max(e - square * lanes_all(2 * STRAND_COMPLIANT), lanes_all(0));
    Lanes pull = group->softness * square + beyond * lanes_all(0.5f * STRAND_YIELD);
    Lanes stiff = group->stiff;
    if (group->compliance) stiff = lanes_load(group->compliance + slot) * group->inverse_h2;
    return (Row){dx, dy, dz, weight * e, (a->w + b->w) * pull + stiff * square};
}

/// Smallest pivot: both ends pinned gives an empty row, whose lambda moves nothing.
static inline Lanes group_pivot(Lanes pivot) { return lanes_max(pivot, lanes_all(1e-20f)); }

/// Forward: eliminates row after row. Keeps the coefficient of the next row, with its sign turned:
/// mu_k = right_k + factor_(k+1) mu_(k+1).
static inline void chains_eliminate(const Group *group) {
    Lanes zero = lanes_all(0), endless = lanes_all(INFINITY);
    Lanes before_x = zero, before_y = zero, before_z = zero, inverse = zero, right = zero;
    LaneNode a = group_node(group, 0);
    for (uint32_t k = 0; k < group->rows; k++) {
        LaneNode b = group_node(group, k + 1);
        Row row = group_row(group, k, &a, &b);
        // a spring that is gone is infinitely stiff: its mu is 0, whatever its neighbours do
        Lanes weight = lanes_load(group->weight + (size_t)k * STRAND_LANES);
        row.diagonal = lanes_where_less(zero, weight, row.diagonal, endless);
        Lanes lower = a.w * (before_x * row.dx + before_y * row.dy + before_z * row.dz);
        Lanes factor = lower * inverse;
        inverse = lanes_all(1) / group_pivot(row.diagonal - factor * lower);
        right = (row.right + lower * right) * inverse;
        lanes_store(keep_at(group, k, KEEP_RIGHT), right);
        lanes_store(keep_at(group, k, KEEP_FACTOR), factor);
        before_x = row.dx;
        before_y = row.dy;
        before_z = row.dz;
        a = b;
    }
}

/// Adds a row's mu to the sums of its springs.
static inline void group_pull(const Group *group, uint32_t k, Lanes mu) {
    float *pull = group->pull + (size_t)k * STRAND_LANES;
    lanes_store(pull, lanes_load(pull) + mu);
}

/// Back: substitutes, and moves each node once both its springs are known.
static inline void chains_substitute(const Group *group, const bool pulls) {
    Lanes mu = lanes_all(0), factor = mu;
    Float4s b = group_float4s(group, group->rows), after = float4s_correction(&b, &b, mu);
    for (uint32_t k = group->rows; k-- > 0;) {
        mu = lanes_load(keep_at(group, k, KEEP_RIGHT)) + factor * mu;
        factor = lanes_load(keep_at(group, k, KEEP_FACTOR));
        if (pulls) group_pull(group, k, mu);
        Float4s a = group_float4s(group, k), correction = float4s_correction(&a, &b, mu);
        float4s_move(&b, &after, &correction);
        group_put(group, k + 1, &b);
        b = a;
        after = correction;
    }
    Float4s none = float4s_correction(&b, &b, lanes_all(0));
    float4s_move(&b, &after, &none);
    group_put(group, 0, &b);
}

/// A row of a ring: a spring that is gone has the equation mu = 0.
static inline Row ring_row(const Group *group, uint32_t k, const LaneNode *a, const LaneNode *b) {
    Row row = group_row(group, k, a, b);
    Lanes weight = lanes_load(group->weight + (size_t)k * STRAND_LANES), zero = lanes_all(0);
    row.dx = lanes_where_less(zero, weight, row.dx, zero);
    row.dy = lanes_where_less(zero, weight, row.dy, zero);
    row.dz = lanes_where_less(zero, weight, row.dz, zero);
    row.diagonal = lanes_where_less(zero, weight, row.diagonal, lanes_all(1));
    return row;
}

/// Where a ring's two ends meet. The corner entry couples the last spring with the first at the closing node:
/// A = T + p q^T with p = (g, 0.., corner), q = (1, 0.., corner/g) and g = -diagonal of the first row.
typedef struct Corner {
    Lanes entry, g, ratio;
} Corner;

static inline Corner rings_corner(const Group *group) {
    uint32_t end = group->rows - 1;
    LaneNode a = group_node(group, 0), second = group_node(group, 1), last = group_node(group, end);
    Row first = ring_row(group, 0, &a, &second), row = ring_row(group, end, &last, &a);
    Lanes entry = -a.w * (first.dx * row.dx + first.dy * row.dy + first.dz * row.dz);
    Lanes g = -group_pivot(first.diagonal);
    return (Corner){entry, g, entry / g};
}

static inline void rings_eliminate(const Group *group, const Corner *corner) {
    uint32_t end = group->rows - 1;
    Lanes zero = lanes_all(0), before_x = zero, before_y = zero, before_z = zero;
    Lanes inverse = zero, right = zero, cyclic = zero;
    LaneNode a = group_node(group, 0);
    for (uint32_t k = 0; k <= end; k++) {
        LaneNode b = group_node(group, k + 1);
        Row row = ring_row(group, k, &a, &b);
        if (k == 0) row.diagonal = -corner->g - corner->g;
        if (k == end) row.diagonal = row.diagonal - corner->entry * corner->ratio;
        Lanes lower = a.w * (before_x * row.dx + before_y * row.dy + before_z * row.dz);
        Lanes factor = lower * inverse, p = k == 0 ? corner->g : k == end ? corner->entry : zero;
        inverse = lanes_all(1) / group_pivot(row.diagonal - factor * lower);
        right = (row.right + lower * right) * inverse;
        cyclic = (p + lower * cyclic) * inverse;
        lanes_store(keep_at(group, k, KEEP_RIGHT), right);
        lanes_store(keep_at(group, k, KEEP_FACTOR), factor);
        lanes_store(keep_at(group, k, KEEP_CYCLIC), cyclic);
        before_x = row.dx;
        before_y = row.dy;
        before_z = row.dz;
        a = b;
    }
}

/// Substitutes both right sides; then mu_k = right_k - scale cyclic_k with the scale that it returns.
static inline Lanes rings_substitute(const Group *group, const Corner *corner) {
    uint32_t end = group->rows - 1;
    Lanes right = lanes_all(0), cyclic = right, factor = right, right_end = right, cyclic_end = right;
    for (uint32_t k = group->rows; k-- > 0;) {
        right = lanes_load(keep_at(group, k, KEEP_RIGHT)) + factor * right;
        cyclic = lanes_load(keep_at(group, k, KEEP_CYCLIC)) + factor * cyclic;
        lanes_store(keep_at(group, k, KEEP_RIGHT), right);
        lanes_store(keep_at(group, k, KEEP_CYCLIC), cyclic);
        factor = lanes_load(keep_at(group, k, KEEP_FACTOR));
        if (k == end) {
            right_end = right;
            cyclic_end = cyclic;
        }
    }
    return (right + corner->ratio * right_end) / (lanes_all(1) + cyclic + corner->ratio * cyclic_end);
}

static inline Lanes ring_mu(const Group *group, uint32_t k, Lanes scale) {
    return lanes_load(keep_at(group, k, KEEP_RIGHT)) - scale * lanes_load(keep_at(group, k, KEEP_CYCLIC));
}

static inline void rings_move(const Group *group, Lanes scale, const bool pulls) {
    uint32_t end = group->rows - 1;
    Float4s start = group_float4s(group, 0), a = start, last = group_float4s(group, end);
    Float4s before = float4s_correction(&last, &start, ring_mu(group, end, scale));
    for (uint32_t k = 0; k <= end; k++) {
        Float4s b = k == end ? start : group_float4s(group, k + 1);
        Lanes mu = ring_mu(group, k, scale);
        if (pulls) group_pull(group, k, mu);
        Float4s correction = float4s_correction(&a, &b, mu);
        float4s_move(&a, &correction, &before);
        group_put(group, k, &a);
        a = b;
        before = correction;
    }
}

static inline void group_solve(const Group *part, bool ring) {
    const Group local = *part, *group = &local; // of its own, so that stores cannot change it
    if (ring) {
        Corner corner = rings_corner(group);
        rings_eliminate(group, &corner);
        rings_move(group, rings_substitute(group, &corner), group->pull != NULL);
    } else {
        chains_eliminate(group);
        if (group->pull) chains_substitute(group, true); // a loop of its own: the other one pays nothing
        else chains_substitute(group, false);
    }
}

void STRAND_SOLVE(const StrandJob *job, uint32_t index, float *keep) {
    const StrandSet *set = job->set;
    const StrandGroup *part = &set->groups[index];
#ifdef STRAND_NARROWER
    if (part->width < LANES) {
        STRAND_NARROWER(job, index, keep);
        return;
    }
#endif
    for (uint32_t lane = 0; lane < part->width; lane += LANES) {
        size_t slot = (size_t)part->row * STRAND_LANES + lane;
        Group group = {.position = job->position,
                       .node = set->node + slot,
                       .contiguous = set->contiguous + part->row,
                       .target = set->target + slot,
                       .weight = set->weight + slot,
                       .compliance = set->compliance_all < 0 ? set->compliance + slot : NULL,
                       .rows = part->rows,
                       .pull = set->pull ? set->pull + slot : NULL,
                       .stride = part->width,
                       .keep = keep,
                       .first_contiguous = job->position + 4 * strand_column(part->width, lane),
                       .softness = lanes_all(1 + 0.5f * job->regularisation),
                       .inverse_h2 = lanes_all(job->inverse_h2),
                       .stiff = lanes_all(set->compliance_all * job->inverse_h2)};
        group_solve(&group, part->ring);
    }
}

// The projection of one group of strands, a strand a lane. Included by a file per instruction set, which has
// defined LANES, the vector type Lanes, Node (a node of every lane: where it is, and its inverse mass) and the
// operations on them (lanes_...). Every operation rounds as IEEE 754
// says and lanes never mix, so that all instruction sets give the same bytes.
//
// Constraint of a spring of target length l between nodes a and b, row-normalised, d = x_b - x_a,
// u = d/|d|: eq 10 over the length of its gradient (eq 11) is
//
//   C = (|d|^2 - l^2) / (2 |d|)
//
// Eq 16 and 19 with masses, w = 1/m: (J M^-1 J^T + S) lambda = W C, x_a += w_a u lambda, x_b -= w_b u lambda.
// Along a chain, spring k shares node k with spring k - 1, so the matrix is tridiagonal:
//
//   diagonal     w_k + w_(k+1) + S_k,  S = c/h^2 + (r/2 + y max(C_k, 0)/|d|) (w_k + w_(k+1))
//   off-diagonal -w_k (u_(k-1) . u_k)
//
// with the compliance c, the regularisation r and y = STRAND_YIELD. The last is for what cannot be satisfied, a
// strand pulled longer than it is between two pins: there lambda would grow to C/r, while a substep can take a pull
// of w lambda of about |d| only, beyond which it throws what is not quite in line from side to side. With y it stays
// near |d|/y; a spring within a thousandth of its length hardly knows of it.
//
// and the Thomas algorithm solves it. A ring adds one corner entry, taken in by the Sherman-Morrison formula.
// Chains of constraints solved in linear time: Bender and Bayer, VRIPHYS 2008; fast projection: Goldenthal et
// al. 2007. Springs that are gone have weight 0 and decouple the chain.
#include "dynamics/strand.h"


/// A spring of every lane: direction, constraint, diagonal.
typedef struct Row {
    Lanes ux, uy, uz, constraint, diagonal;
} Row;

/// y above.
#define STRAND_YIELD 0.1f

/// What is kept of a row between elimination and substitution.
enum { KEEP_UX, KEEP_UY, KEEP_UZ, KEEP_W, KEEP_RIGHT, KEEP_FACTOR, KEEP_CYCLIC };

typedef struct Group {
    float *position;
    const uint32_t *node;
    const float *length, *weight, *compliance;
    uint32_t rows;
    float *keep;
    Lanes softness, inverse_h2; ///< 1 + r/2, 1/h^2
} Group;

static inline float *keep_at(const Group *group, uint32_t row, int what) {
    return group->keep + ((size_t)row * STRAND_KEEP + (size_t)what) * LANES;
}

static inline const uint32_t *group_node(const Group *group, uint32_t k) {
    return group->node + (size_t)k * STRAND_LANES;
}

static inline Row group_row(const Group *restrict group, uint32_t k, const Node *a, const Node *b) {
    size_t slot = (size_t)k * STRAND_LANES;
    Lanes l = lanes_load(group->length + slot), weight = lanes_load(group->weight + slot);
    Lanes compliance = lanes_load(group->compliance + slot);
    Lanes dx = b->x - a->x, dy = b->y - a->y, dz = b->z - a->z;
    Lanes distance = lanes_sqrt(dx * dx + dy * dy + dz * dz);
    Lanes inverse = lanes_all(1) / lanes_max(distance, lanes_all(1e-12f));
    // a spring crushed below .41 of its length has hardly a direction: limit what its row asks for
    Lanes constraint = lanes_max((distance - l * l * inverse) * lanes_all(0.5f), -l);
    Lanes masses = a->w + b->w;
    Lanes stretch = lanes_max(constraint * inverse, lanes_all(0));
    Lanes diagonal = masses * (group->softness + stretch * lanes_all(STRAND_YIELD)) + compliance * group->inverse_h2;
    inverse = lanes_where_positive(weight, inverse, lanes_all(0));
    return (Row){dx * inverse, dy * inverse, dz * inverse, weight * constraint,
                 lanes_where_positive(weight, diagonal, lanes_all(1))};
}

/// Smallest pivot: both ends pinned gives an empty row, whose lambda moves nothing.
static inline Lanes group_pivot(Lanes pivot) { return lanes_max(pivot, lanes_all(1e-20f)); }

static inline void group_keep(const Group *group, uint32_t k, const Row *row, Lanes w) {
    lanes_store(keep_at(group, k, KEEP_UX), row->ux);
    lanes_store(keep_at(group, k, KEEP_UY), row->uy);
    lanes_store(keep_at(group, k, KEEP_UZ), row->uz);
    lanes_store(keep_at(group, k, KEEP_W), w);
}

static inline void group_solve_chains(const Group *part) {
    const Group local = *part, *group = &local; // of its own, so that stores cannot change it
    float *position = group->position;
    Node a = lanes_gather(position, group_node(group, 0));
    Lanes start_w = a.w, zero = lanes_all(0);
    Lanes before_x = zero, before_y = zero, before_z = zero, inverse_before = zero, right_before = zero;
    // forward: eliminate row after row
    for (uint32_t k = 0; k < group->rows; k++) {
        Node b = lanes_gather(position, group_node(group, k + 1));
        Row row = group_row(group, k, &a, &b);
        Lanes lower = -a.w * (before_x * row.ux + before_y * row.uy + before_z * row.uz);
        Lanes factor = lower * inverse_before; // lambda_(k-1) = right_(k-1) - factor_k lambda_k
        inverse_before = lanes_all(1) / group_pivot(row.diagonal - factor * lower);
        right_before = (row.constraint - lower * right_before) * inverse_before;
        group_keep(group, k, &row, b.w);
        lanes_store(keep_at(group, k, KEEP_RIGHT), right_before);
        lanes_store(keep_at(group, k, KEEP_FACTOR), factor);
        before_x = row.ux, before_y = row.uy, before_z = row.uz;
        a = b;
    }
    // back: substitute, and move each node once both its springs are known
    Lanes after_x = zero, after_y = zero, after_z = zero, lambda = zero, factor_after = zero;
    for (uint32_t k = group->rows; k-- > 0;) {
        lambda = lanes_load(keep_at(group, k, KEEP_RIGHT)) - factor_after * lambda;
        factor_after = lanes_load(keep_at(group, k, KEEP_FACTOR));
        Lanes push_x = lanes_load(keep_at(group, k, KEEP_UX)) * lambda;
        Lanes push_y = lanes_load(keep_at(group, k, KEEP_UY)) * lambda;
        Lanes push_z = lanes_load(keep_at(group, k, KEEP_UZ)) * lambda;
        Lanes w = lanes_load(keep_at(group, k, KEEP_W));
        lanes_move(position, group_node(group, k + 1), w * (after_x - push_x), w * (after_y - push_y),
                   w * (after_z - push_z));
        after_x = push_x, after_y = push_y, after_z = push_z;
    }
    lanes_move(position, group_node(group, 0), start_w * after_x, start_w * after_y, start_w * after_z);
}

/// Rings of one length. The corner entry couples the last spring with the first at the closing node:
/// A = T + p q^T with p = (g, 0.., corner), q = (1, 0.., corner/g) and g = -diagonal of the first row.
static inline void group_solve_rings(const Group *group) {
    float *position = group->position;
    uint32_t end = group->rows - 1;
    Lanes zero = lanes_all(0), one = lanes_all(1);
    Node a = lanes_gather(position, group_node(group, 0)), second = lanes_gather(position, group_node(group, 1));
    Node last = lanes_gather(position, group_node(group, end));
    Row row_first = group_row(group, 0, &a, &second), row_end = group_row(group, end, &last, &a);
    Lanes corner = -a.w * (row_first.ux * row_end.ux + row_first.uy * row_end.uy + row_first.uz * row_end.uz);
    Lanes g = -group_pivot(row_first.diagonal), ratio = corner / g, start_w = a.w;
    Lanes before_x = zero, before_y = zero, before_z = zero;
    Lanes inverse_before = zero, right_before = zero, cyclic_before = zero;
    for (uint32_t k = 0; k <= end; k++) {
        Node b = lanes_gather(position, group_node(group, k + 1));
        Row row = group_row(group, k, &a, &b);
        if (k == 0) row.diagonal = -g - g;
        if (k == end) row.diagonal = row.diagonal - corner * ratio;
        Lanes lower = -a.w * (before_x * row.ux + before_y * row.uy + before_z * row.uz);
        Lanes factor = lower * inverse_before, cyclic = k == 0 ? g : k == end ? corner : zero;
        inverse_before = one / group_pivot(row.diagonal - factor * lower);
        right_before = (row.constraint - lower * right_before) * inverse_before;
        cyclic_before = (cyclic - lower * cyclic_before) * inverse_before;
        group_keep(group, k, &row, a.w);
        lanes_store(keep_at(group, k, KEEP_RIGHT), right_before);
        lanes_store(keep_at(group, k, KEEP_FACTOR), factor);
        lanes_store(keep_at(group, k, KEEP_CYCLIC), cyclic_before);
        before_x = row.ux, before_y = row.uy, before_z = row.uz;
        a = b;
    }
    Lanes right = zero, cyclic = zero, right_end = zero, cyclic_end = zero, factor_after = zero;
    for (uint32_t k = group->rows; k-- > 0;) {
        right = lanes_load(keep_at(group, k, KEEP_RIGHT)) - factor_after * right;
        cyclic = lanes_load(keep_at(group, k, KEEP_CYCLIC)) - factor_after * cyclic;
        lanes_store(keep_at(group, k, KEEP_RIGHT), right);
        lanes_store(keep_at(group, k, KEEP_CYCLIC), cyclic);
        factor_after = lanes_load(keep_at(group, k, KEEP_FACTOR));
        if (k == end) right_end = right, cyclic_end = cyclic;
    }
    Lanes scale = (right + ratio * right_end) / (one + cyclic + ratio * cyclic_end);
    Lanes lambda = right_end - scale * cyclic_end;
    before_x = lanes_load(keep_at(group, end, KEEP_UX)) * lambda;
    before_y = lanes_load(keep_at(group, end, KEEP_UY)) * lambda;
    before_z = lanes_load(keep_at(group, end, KEEP_UZ)) * lambda;
    for (uint32_t k = 0; k <= end; k++) {
        lambda = lanes_load(keep_at(group, k, KEEP_RIGHT)) - scale * lanes_load(keep_at(group, k, KEEP_CYCLIC));
        Lanes push_x = lanes_load(keep_at(group, k, KEEP_UX)) * lambda;
        Lanes push_y = lanes_load(keep_at(group, k, KEEP_UY)) * lambda;
        Lanes push_z = lanes_load(keep_at(group, k, KEEP_UZ)) * lambda;
        Lanes w = k == 0 ? start_w : lanes_load(keep_at(group, k, KEEP_W));
        lanes_move(position, group_node(group, k), w * (push_x - before_x), w * (push_y - before_y),
                   w * (push_z - before_z));
        before_x = push_x, before_y = push_y, before_z = push_z;
    }
}

void STRAND_SOLVE(const StrandJob *job, uint32_t index, float *keep) {
    const StrandSet *set = job->set;
    const StrandGroup *part = &set->groups[index];
    for (uint32_t lane = 0; lane < part->lane_count; lane += LANES) {
        size_t slot = (size_t)part->row * STRAND_LANES + lane;
        Group group = {job->position,
                       set->node + slot,
                       set->length + slot,
                       set->weight + slot,
                       set->compliance + slot,
                       part->rows,
                       keep,
                       lanes_all(1 + 0.5f * job->regularisation),
                       lanes_all(job->inverse_h2)};
        if (part->ring)
            group_solve_rings(&group);
        else
            group_solve_chains(&group);
    }
}

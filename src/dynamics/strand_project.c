// Projection of one strand: a chain of springs solved exactly for one Newton step.
//
// Constraint of a spring of target length l between nodes a and b, row-normalised, d = x_b - x_a,
// u = d/|d|: eq 10 over the length of its gradient (eq 11) is
//
//   C = (|d|^2 - l^2) / (2 |d|)
//
// Eq 16 and 19 with masses, w = 1/m: (J M^-1 J^T + S) lambda = W C, x_a += w_a u lambda, x_b -= w_b u lambda.
// Along a chain, spring k shares node k with spring k - 1, so the matrix is tridiagonal:
//
//   diagonal     w_k + w_(k+1) + S_k,  S = c/h^2 + r (w_k + w_(k+1))/2   c compliance, r regularisation
//   off-diagonal -w_k (u_(k-1) . u_k)
//
// and the Thomas algorithm solves it. A ring adds one corner entry, taken in by the Sherman-Morrison
// formula. Chains of constraints solved in linear time: Bender and Bayer, VRIPHYS 2008; fast
// projection: Goldenthal et al. 2007. Springs that are gone have weight 0 and decouple the chain.
#include "dynamics/plan.h"

typedef struct Project {
    DynamicsPlan *plan;
    const SpringSet *set;
    const float *length;   ///< m, targets
    const float *weight;
    float (*position)[4];
    const float *compliance; ///< m/N
    float regularisation;
    float inverse_h2;
    uint32_t first_strand;
} Project;

/// A spring's row: direction, constraint and diagonal.
typedef struct Row {
    Vec u;
    float constraint, diagonal;
} Row;

static inline Row strand_row(const Project *job, uint32_t k, float wa, float wb) {
    const uint32_t *ends = job->set->ends[k];
    if (job->weight[k] <= 0) return (Row){{0, 0, 0}, 0, 1};
    Vec d = vec_sub(vec_load(job->position[ends[1]]), vec_load(job->position[ends[0]]));
    float l = job->length[k], square = vec_dot(d, d), distance = sqrtf(square);
    // a spring crushed below half its length has hardly a direction: limit what its row asks for
    float inverse = 1 / fmaxf(distance, 1e-12f), divisor = 2 * fmaxf(distance, 0.5f * l);
    return (Row){vec_scale(d, inverse), job->weight[k] * (square - l * l) / divisor,
                 (wa + wb) * (1 + 0.5f * job->regularisation) + job->compliance[k] * job->inverse_h2};
}

static inline void strand_move(float *x, Vec push, float w) {
    x[0] += w * push.x, x[1] += w * push.y, x[2] += w * push.z;
}

/// Smallest pivot: both ends pinned gives an empty row.
static inline float strand_pivot(float pivot) { return pivot > 1e-20f ? pivot : 1; }

static void strand_solve_chain(const Project *job, uint32_t first, uint32_t last) {
    DynamicsPlan *plan = job->plan;
    const float *w = plan->inverse_mass;
    // forward: eliminate row after row
    Vec u_before = {0, 0, 0};
    float inverse_before = 0, right_before = 0;
    for (uint32_t k = first; k < last; k++) {
        const uint32_t *ends = job->set->ends[k];
        float wa = w[ends[0]], wb = w[ends[1]];
        Row row = strand_row(job, k, wa, wb);
        float lower = -wa * vec_dot(u_before, row.u);
        float factor = lower * inverse_before;
        float pivot = strand_pivot(row.diagonal - factor * lower);
        plan->upper[k] = factor; // lambda_(k-1) = right_(k-1) - factor_k lambda_k
        inverse_before = 1 / pivot;
        right_before = (row.constraint - lower * right_before) * inverse_before;
        vec_store(plan->direction[k], row.u);
        plan->direction[k][3] = right_before;
        u_before = row.u;
    }
    // back: substitute, and move each node once both its springs are known
    Vec push_after = {0, 0, 0};
    float lambda = 0, factor_after = 0;
    for (uint32_t k = last; k-- > first;) {
        const uint32_t *ends = job->set->ends[k];
        lambda = plan->direction[k][3] - factor_after * lambda;
        factor_after = plan->upper[k];
        Vec push = vec_scale(vec_load(plan->direction[k]), lambda);
        strand_move(job->position[ends[1]], vec_sub(push_after, push), w[ends[1]]);
        push_after = push;
    }
    uint32_t start = job->set->ends[first][0];
    strand_move(job->position[start], push_after, w[start]);
}

static void strand_solve_ring(const Project *job, uint32_t first, uint32_t last) {
    DynamicsPlan *plan = job->plan;
    const float *w = plan->inverse_mass;
    const uint32_t(*ends)[2] = (const uint32_t(*)[2])job->set->ends;
    uint32_t end = last - 1;
    // the corner entry couples the last spring with the first at the closing node
    Row row_first = strand_row(job, first, w[ends[first][0]], w[ends[first][1]]);
    Row row_end = strand_row(job, end, w[ends[end][0]], w[ends[end][1]]);
    float corner = -w[ends[first][0]] * vec_dot(row_first.u, row_end.u);
    if (corner == 0) { // the closing node is pinned, or a spring beside it is gone: no ring any more
        strand_solve_chain(job, first, last);
        return;
    }
    // A = T + p q^T with p = (g, 0.., corner), q = (1, 0.., corner/g) and g = -diagonal of the first row
    float g = -row_first.diagonal;
    Vec u_before = {0, 0, 0};
    float inverse_before = 0, right_before = 0, cyclic_before = 0;
    for (uint32_t k = first; k < last; k++) {
        float wa = w[ends[k][0]], wb = w[ends[k][1]];
        Row row = strand_row(job, k, wa, wb);
        if (k == first) row.diagonal -= g;
        if (k == end) row.diagonal -= corner * corner / g;
        float lower = k == first ? 0 : -wa * vec_dot(u_before, row.u);
        float factor = lower * inverse_before;
        float pivot = strand_pivot(row.diagonal - factor * lower);
        float cyclic = k == first ? g : k == end ? corner : 0;
        plan->upper[k] = factor;
        inverse_before = 1 / pivot;
        right_before = (row.constraint - lower * right_before) * inverse_before;
        cyclic_before = (cyclic - lower * cyclic_before) * inverse_before;
        vec_store(plan->direction[k], row.u);
        plan->direction[k][3] = right_before;
        plan->cyclic[k] = cyclic_before;
        u_before = row.u;
    }
    float lambda = 0, z = 0, factor_after = 0;
    for (uint32_t k = last; k-- > first;) {
        lambda = plan->direction[k][3] -= factor_after * lambda;
        z = plan->cyclic[k] -= factor_after * z;
        factor_after = plan->upper[k];
    }
    float ratio = corner / g;
    float scale = (plan->direction[first][3] + ratio * plan->direction[end][3]) /
                  (1 + plan->cyclic[first] + ratio * plan->cyclic[end]);
    Vec push_before = vec_scale(vec_load(plan->direction[end]), plan->direction[end][3] - scale * plan->cyclic[end]);
    for (uint32_t k = first; k < last; k++) {
        Vec push = vec_scale(vec_load(plan->direction[k]), plan->direction[k][3] - scale * plan->cyclic[k]);
        strand_move(job->position[ends[k][0]], vec_sub(push, push_before), w[ends[k][0]]);
        push_before = push;
    }
}

static void strand_range(void *task, int begin, int end) {
    const Project *job = task;
    for (int i = begin; i < end; i++) {
        uint32_t s = job->first_strand + (uint32_t)i;
        uint32_t first = job->set->strand_first[s], last = job->set->strand_first[s + 1];
        if (job->set->strand_ring[s])
            strand_solve_ring(job, first, last);
        else
            strand_solve_chain(job, first, last);
    }
}

uint64_t strand_project(DynamicsPlan *plan, const Shell *shell, const BurnState *burn, SingeColour colour, Pool *pool,
                        float h, DynamicsState *dynamics) {
    const SpringSet *set = &shell->springs[colour];
    Project job = {plan, set, burn->spring_length[colour], plan->weight[colour], dynamics->position,
                   plan->compliance[colour], plan->settings.solver.regularisation[colour], 1 / (h * h), 0};
    for (uint32_t f = 0; f < set->family_count; f++) {
        job.first_strand = set->family_first[f];
        uint32_t strands = set->family_first[f + 1] - job.first_strand;
        pool_for(pool, (int)strands, dynamics_strand_grain(set, f), strand_range, &job);
    }
    return set->strand_count;
}

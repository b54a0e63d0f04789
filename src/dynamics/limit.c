// No edge of a mesh that does not stretch ends a step far longer than it should be. Strands are projected once a substep:
// what meets at vertices where no strand runs on, among cells far smaller than their neighbours or in threads of char that
// something heavy hangs on, may be left several times as long. After the substeps blue and yellow springs longer than
// LIMIT_MOST times their targets l are shortened one by one,
//
//   C = |d| - LIMIT_MOST l > 0,   u = d/|d|,   lambda = C/(w_a + w_b),   x_a += w_a lambda u,   x_b -= w_b lambda u
//
// and what still draws them out is taken from the velocities, without bounce: v_a += w_a mu u, v_b -= w_b mu u with
// mu = max((v_b - v_a) . u, 0)/(w_a + w_b). Both keep linear and angular momentum. Rounds go over the blocks of springs in
// which a count has found some; nearly all steps end with that count.
#include "base/quad.h"
#include "dynamics/plan.h"

/// Times its target length. A square cell of inextensible sides that collapses has a diagonal of 1.41.
#define LIMIT_MOST 1.5f
enum { LIMIT_ROUNDS = 12 };

typedef struct Limit {
    const SpringSet *set;
    const uint8_t *flags;
    const float *length; ///< m, targets
    Field compliance;    ///< of blue springs
    DynamicsState *dynamics;
} Limit;

static bool limit_is_over(const Limit *job, uint32_t k) {
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    const uint32_t *ends = job->set->ends[k];
    Quad way = quad_load(x[ends[1]]) - quad_load(x[ends[0]]);
    float most = LIMIT_MOST * job->length[k];
    return (job->flags[k] & SINGE_ALIVE) && quad_dot(way, way) > most * most * 1.0001f && x[ends[0]][3] + x[ends[1]][3] > 0 &&
           field_at(job->compliance, ends[0]) + field_at(job->compliance, ends[1]) == 0;
}

static double limit_count(void *task, int begin, int end) {
    double over = 0;
    for (int k = begin; k < end; k++) over += limit_is_over(task, (uint32_t)k);
    return over;
}

static void limit_spring(const Limit *job, uint32_t k) {
    float(*x)[4] = job->dynamics->position, (*v)[4] = job->dynamics->velocity;
    const uint32_t a = job->set->ends[k][0], b = job->set->ends[k][1];
    float wa = x[a][3], wb = x[b][3];
    Quad way = quad_load(x[b]) - quad_load(x[a]), relative = quad_load(v[b]) - quad_load(v[a]);
    way[3] = 0;
    float length = sqrtf(quad_dot(way, way)), opens = quad_dot(relative, way) / length;
    Quad unit = way / length, shift = (length - LIMIT_MOST * job->length[k]) / (wa + wb) * unit;
    Quad slow = (opens > 0 ? opens : 0) / (wa + wb) * unit;
    quad_store(x[a], quad_load(x[a]) + wa * shift);
    quad_store(x[b], quad_load(x[b]) - wb * shift);
    quad_store(v[a], quad_load(v[a]) + wa * slow);
    quad_store(v[b], quad_load(v[b]) - wb * slow);
}

/// The blocks of springs with a count above 0, one after another.
static void limit_blocks(const Limit *job, const double *over) {
    for (uint32_t k = 0; k < job->set->count; k++) {
        if (k % POOL_BLOCK == 0 && over[k / POOL_BLOCK] == 0) {
            k += POOL_BLOCK - 1;
            continue;
        }
        if (limit_is_over(job, k)) limit_spring(job, k);
    }
}

void dynamics_limit(DynamicsPlan *plan, const Shell *shell, const State *state, Pool *pool, DynamicsState *dynamics) {
    const SingeColour colours[] = {SINGE_YELLOW, SINGE_BLUE};
    if (plan->paper) return;
    for (int round = 0; round < LIMIT_ROUNDS; round++) {
        double found = 0;
        for (int i = 0; i < 2; i++) {
            const SingeColour colour = colours[i];
            Limit job = {&shell->springs[colour], state->ablate.spring_flags[colour], state->burn.spring_length[colour],
                         shell->matter.compliance[SINGE_BLUE], dynamics};
            double over = pool_sum(pool, (int)job.set->count, limit_count, &job, plan->partial);
            if (over > 0) limit_blocks(&job, plan->partial);
            found += over;
        }
        if (found == 0) return;
    }
}

// No cell of a mesh that does not stretch ends a step far larger than it should be. Strands are projected once a
// substep: springs at vertices where no strand continues, among cells far smaller than their neighbours, or in threads
// of char that carry something heavy, may be left several times as long. So after the substeps sides and diagonals
// (blue and yellow springs) longer than LIMIT_SIDE or LIMIT_DIAGONAL times their targets l, here s l, are shortened one
// by one:
//
//   C = |d| - s l > 0,   u = d/|d|,   lambda = C/(w_a + w_b),   x_a += w_a lambda u,   x_b -= w_b lambda u
//
// and the velocity that still stretches them is removed, without bounce: v_a += w_a mu u, v_b -= w_b mu u with
// mu = max((v_b - v_a) . u, 0)/(w_a + w_b). Both conserve linear and angular momentum. A count finds the blocks with
// springs to shorten; sweeps go over those, and then they are counted again. Nearly all steps end with the first count.
//
// This is done in every step. CCD comes after it and takes displacements back towards the start of the step: a spring
// that was too long then would be so again.
//
// Where a spring has burnt, a load on its cell may pull it open: if it were held, it would stretch intact cells next to
// it.
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"

#include <math.h>

/// Times the target length. A square cell of inextensible sides that collapses has a diagonal of 1.41.
#define LIMIT_SIDE 1.25f
#define LIMIT_DIAGONAL 1.45f
/// Max counts, and max sweeps over the blocks that each count has found.
enum { LIMIT_ROUNDS = 16, LIMIT_SWEEPS = 4 };

typedef struct Limit {
    const Shell *shell;
    const StateInput *state;
    DynamicsState *dynamics;
    const AttachSpread *spread;
    uint32_t sides, first_diagonal, end; ///< springs are numbered: sides from 0, diagonals from the begin of a block
} Limit;

/// Springs of one colour.
typedef struct LimitRange {
    SingeColour colour;
    uint32_t first, end;
} LimitRange;

static Float4 limit_displacement(const Limit *job, SingeColour colour, uint32_t spring) {
    const uint32_t *ends = job->shell->springs[colour].ends[spring];
    return float4_load(job->dynamics->position[ends[1]]) - float4_load(job->dynamics->position[ends[0]]);
}

static float limit_factor(SingeColour colour) { return colour == SINGE_BLUE ? LIMIT_SIDE : LIMIT_DIAGONAL; }

/// Bit k: whether spring first + k, of four, is too long, by more than rounding.
static inline unsigned limit_four(const Limit *job, SingeColour colour, uint32_t first) {
    Float4 max = limit_factor(colour) * float4_load(job->state->burn->spring_length[colour] + first), displacement[4];
    for (uint32_t k = 0; k < 4; k++) displacement[k] = limit_displacement(job, colour, first + k);
    float4_transpose(displacement);
    return float4_bits(displacement[0] * displacement[0] + displacement[1] * displacement[1] +
                           displacement[2] * displacement[2] >
                       max * max * 1.0001f);
}

/// Whether a spring that is too long may be shortened: it is not gone nor in a mesh that may stretch, its ends are not
/// both held, and the sheet is not held farther apart than it reaches.
static bool limit_holds(const Limit *job, SingeColour colour, uint32_t spring) {
    const uint32_t *ends = job->shell->springs[colour].ends[spring];
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    const Field compliance = job->shell->matter.compliance[SINGE_BLUE];
    return job->state->ablate->spring_flags[colour][spring] & SINGE_ALIVE && x[ends[0]][3] + x[ends[1]][3] > 0 &&
           field_at(compliance, ends[0]) + field_at(compliance, ends[1]) == 0 &&
           !job->spread[job->shell->matter.sheet[ends[0]]].tight;
}

static bool limit_is_over(const Limit *job, SingeColour colour, uint32_t spring) {
    Float4 displacement = limit_displacement(job, colour, spring);
    float max = limit_factor(colour) * job->state->burn->spring_length[colour][spring];
    return float4_dot(displacement, displacement) > max * max * 1.0001f && limit_holds(job, colour, spring);
}

/// The springs of a colour with numbers from begin on, in one block of POOL_BLOCK.
static LimitRange limit_range(const Limit *job, uint32_t begin, uint32_t end) {
    if (begin >= job->first_diagonal)
        return (LimitRange){SINGE_YELLOW, begin - job->first_diagonal, end - job->first_diagonal};
    return (LimitRange){SINGE_BLUE, begin, end < job->sides ? end : job->sides};
}

/// Number of springs to shorten in a block.
static double limit_count(void *task, int begin, int end) {
    const Limit *job = task;
    const LimitRange range = limit_range(job, (uint32_t)begin, (uint32_t)end);
    double over = 0;
    uint32_t s = range.first;
    for (; s + 4 <= range.end; s += 4)
        for (unsigned some = limit_four(job, range.colour, s); some; some &= some - 1)
            over += limit_holds(job, range.colour, s + (uint32_t)__builtin_ctz(some));
    for (; s < range.end; s++) over += limit_is_over(job, range.colour, s);
    return over;
}

bool dynamics_limit(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                    DynamicsState *dynamics) {
    float(*x)[4] = dynamics->position, (*v)[4] = dynamics->velocity;
    Limit job = {.shell = shell, .state = state, .dynamics = dynamics, .spread = plan->attachments.spread};
    job.sides = shell->springs[SINGE_BLUE].count - shell->edge_spare_count + shell->edge_spare_used;
    job.first_diagonal = (uint32_t)pool_blocks((int)job.sides) * POOL_BLOCK;
    job.end = job.first_diagonal + shell->springs[SINGE_YELLOW].count;

    for (int round = 0; round < LIMIT_ROUNDS; round++) {
        if (pool_sum(pool, (int)job.end, limit_count, &job, plan->partial) == 0) return round > 0;

        // shorten springs that are too long, one after another, in blocks that have any
        bool some = true;
        for (int sweep = 0; sweep < LIMIT_SWEEPS && some; sweep++) {
            some = false;
            for (uint32_t block = 0; block < job.end; block += POOL_BLOCK) {
                if (plan->partial[block / POOL_BLOCK] == 0) continue;

                const uint32_t end = job.end - block < POOL_BLOCK ? job.end : block + POOL_BLOCK;
                const LimitRange range = limit_range(&job, block, end);
                for (uint32_t s = range.first; s < range.end; s++) {
                    if (!limit_is_over(&job, range.colour, s)) continue;
                    const uint32_t *ends = job.shell->springs[range.colour].ends[s], a = ends[0], b = ends[1];
                    const float max = limit_factor(range.colour) * job.state->burn->spring_length[range.colour][s];
                    float wa = x[a][3], wb = x[b][3];
                    Float4 displacement = limit_displacement(&job, range.colour, s);
                    Float4 relative = float4_load(v[b]) - float4_load(v[a]);
                    displacement[3] = 0;
                    float length = sqrtf(float4_dot(displacement, displacement));
                    float opens = float4_dot(relative, displacement) / length;
                    Float4 unit = displacement / length, shift = (length - max) / (wa + wb) * unit;
                    Float4 slow = (opens > 0 ? opens : 0) / (wa + wb) * unit;
                    float4_store(x[a], float4_load(x[a]) + wa * shift);
                    float4_store(x[b], float4_load(x[b]) - wb * shift);
                    float4_store(v[a], float4_load(v[a]) + wa * slow);
                    float4_store(v[b], float4_load(v[b]) - wb * slow);
                    some = true;
                }
            }
        }
    }

    return true;
}

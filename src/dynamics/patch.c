// Springs that tears have taken out of their strands. A strand is a chain in a lane, each node shared by two springs: a
// spring that gets another end by a split is removed from its lane (weight 0) and continues here, and so do the springs
// that a tear makes for its second edge. They are projected one by one, in order, after the strands of their colour:
// the constraint is that of strand_kernel.h on a chain of one spring,
//
//   mu = W E/((w_a + w_b) ((1 + r/2) D + y max(E - g D, 0)) + (c/h^2) D),   x_a += w_a d mu,  x_b -= w_b d mu
//
// The force f of a spring, from which line forces come, by the sums of mu = lambda/|d| over the projections of a step:
//
//   pull = f/|d| l/L = (sum mu) l/(L substeps h^2)    [N/m], target length l, length at rest L
#include "dynamics/dynamics_plan.h"

#include "common/float4.h"
#include "common/real.h"
#include "dynamics/stiffness.h"

#include <math.h>
#include <string.h>

bool patches_create(Memory *memory, const Shell *shell, Patches *patches) {
    patches->capacity = 8 * shell->spare_count; // as split.h allows
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        uint32_t springs = shell->spare_count > 0 ? shell->springs[colour].count : 0;
        if (!NEW(memory, patches->items[colour], patches->capacity) || !NEW(memory, patches->pull[colour], springs))
            return false;
    }

    return true;
}

void patches_free(Memory *memory, const Shell *shell, Patches *patches) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        uint32_t springs = shell->spare_count > 0 ? shell->springs[colour].count : 0;
        FREE(memory, patches->items[colour], patches->capacity);
        FREE(memory, patches->pull[colour], springs);
    }
}

static void patch_push(Patches *patches, SingeColour colour, uint32_t spring, float compliance) {
    if (patches->count[colour] == patches->capacity) return; // split_is_possible prevents it
    patches->items[colour][patches->count[colour]++] = (Patch){.spring = spring, .compliance = compliance};
}

bool patch_follow(DynamicsPlan *plan, const Shell *shell) {
    Patches *patches = &plan->patches;
    if (shell->spare_count == 0) return false;

    // a step that was undone may have dropped springs that are alive again
    if (patches->split_count == shell->split_count && plan->written) return false;

    patches->split_count = shell->split_count;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        const StrandSet *set = &plan->strands.sets[colour];
        patches->count[colour] = 0;
        for (uint32_t s = 0; s < springs->strand_count; s++) {
            size_t slot = set->strand_slot[s];
            for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, slot += STRAND_LANES)
                if (!patch_is_in_strand(plan, shell, (SingeColour)colour, k, slot)) {
                    patch_push(patches, (SingeColour)colour, k, set->compliance[slot]);
                    set->groups[set->strand_group[s]].apart = true;
                }
        }
    }

    // second edges of tears
    const SpringSet *blue = &shell->springs[SINGE_BLUE];
    uint32_t first = blue->count - shell->edge_spare_count;
    const StrandSet *set = &plan->strands.sets[SINGE_BLUE];

    for (uint32_t k = 0; k < shell->edge_spare_used; k++) {
        // the compliance of the spring that it comes from, whose strand bisection finds
        const uint32_t origin = shell->edge_origin[k];
        uint32_t low = 0, high = blue->strand_count;
        while (high - low > 1) {
            uint32_t middle = low + (high - low) / 2;
            if (blue->strand_first[middle] <= origin) low = middle;
            else high = middle;
        }

        size_t slot = set->strand_slot[low] + (size_t)(origin - blue->strand_first[low]) * STRAND_LANES;
        patch_push(patches, SINGE_BLUE, first + k, set->compliance[slot]);
    }

    return true;
}

void patch_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT && shell->spare_count > 0; colour++) {
        StrandSet *set = &plan->strands.sets[colour];
        if (set->pull) memset(set->pull, 0, (size_t)set->row_count * STRAND_LANES * sizeof *set->pull);
        uint32_t left = 0;
        for (uint32_t k = 0; k < plan->patches.count[colour]; k++) {
            Patch *patch = &plan->patches.items[colour][left];
            *patch = plan->patches.items[colour][k];
            plan->patches.pull[colour][patch->spring] = 0;
            if (!(state->ablate->spring_flags[colour][patch->spring] & SINGE_ALIVE)) continue; // gone for good
            const uint32_t *ends = shell->springs[colour].ends[patch->spring];
            patch->a = ends[0];
            patch->b = ends[1];
            patch->pull = 0;
            patch->length = state->burn->spring_length[colour][patch->spring];
            patch->weight = dynamics_weight(shell->matter.weight[colour], plan->soft, patch->a, patch->b);
            left++;
        }

        plan->patches.count[colour] = left;
    }
}

void patch_project(DynamicsPlan *plan, SingeColour colour, const StrandJob *job) {
    const float softness = 1 + 0.5f * job->regularisation;
    for (uint32_t k = 0; k < plan->patches.count[colour]; k++) {
        Patch *patch = &plan->patches.items[colour][k];
        Float4 a = float4_load(job->position + 4 * (size_t)patch->a),
               b = float4_load(job->position + 4 * (size_t)patch->b), d = b - a;
        float weights = a[3] + b[3], target = patch->length * patch->length;
        if (!(patch->weight > 0 && weights > 0)) continue;

        float square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], e = (square - target) * 0.5f;
        if (square < target * 0.17157288f) e = -patch->length * sqrtf(square); // crushed, as in strand_kernel.h
        float beyond = float_max(e - square * 0.01f, 0);
        float stiff = patch->compliance * job->inverse_h2;
        float diagonal = weights * (softness * square + beyond * STRAND_YIELD) + stiff * square;
        float mu = patch->weight * e / float_max(diagonal, 1e-20f);
        patch->pull += mu;
        d[3] = 0;
        float4_store(job->position + 4 * (size_t)patch->a, a + a[3] * mu * d);
        float4_store(job->position + 4 * (size_t)patch->b, b - b[3] * mu * d);
    }
}

typedef struct Gather {
    DynamicsPlan *plan;
    const Shell *shell;
    SingeColour colour;
    float scale;
} Gather;

/// A spring held at both ends has a row without a diagonal, whose mu is meaningless.
static void gather_strands(void *task, int begin, int end) {
    const Gather *job = task;
    const SpringSet *springs = &job->shell->springs[job->colour];
    const StrandSet *set = &job->plan->strands.sets[job->colour];
    const float *inverse_mass = job->plan->inverse_mass, *rest = springs->rest;
    float *pull = job->plan->patches.pull[job->colour];
    const bool held = job->plan->held;

    for (int s = begin; s < end; s++) {
        size_t slot = set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, slot += STRAND_LANES) {
            bool moves = !held || inverse_mass[springs->ends[k][0]] + inverse_mass[springs->ends[k][1]] > 0;
            pull[k] =
                moves && set->weight[slot] > 0 ? set->pull[slot] * job->scale * sqrtf(set->target[slot]) / rest[k] : 0;
        }
    }
}

void patch_gather(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h) {
    const SingeSolverDef *solver = &plan->settings.solver;
    Gather job = {plan, shell, SINGE_RED, 1 / ((float)solver->substeps * h * h * stiffness_given(solver))};
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        job.colour = (SingeColour)colour;
        const SpringSet *springs = &shell->springs[colour];
        int grain = 1 + (int)((uint64_t)POOL_BLOCK * springs->strand_count / (springs->count + 1));
        pool_for(pool, (int)springs->strand_count, grain, gather_strands, &job);
        for (uint32_t k = 0; k < plan->patches.count[colour]; k++) {
            const Patch *patch = &plan->patches.items[colour][k];
            plan->patches.pull[colour][patch->spring] =
                patch->pull * job.scale * patch->length / springs->rest[patch->spring];
        }
    }
}

// Projection of one colour: the groups of a family side by side, family after family. Families follow each other as
// in block Gauss-Seidel; groups of a family share no particle, so that their order and the number of threads do not
// matter.
#include "common/assertion.h"
#include "common/thread.h"
#include "dynamics/stiffness.h"
#include "dynamics/dynamics_plan.h"

#include <stdatomic.h>

/// Floats that one solve needs: STRAND_KEEP for each row and lane.
static size_t keep_floats(const Strands *strands) {
    return ((size_t)strands->longest * STRAND_KEEP + 1) * STRAND_LANES;
}

/// Operations of a row of the chain's solve and bytes it moves, counted in strand_kernel.h. The bytes: node, length,
/// weight, compliance and position forward; node, position twice back. Rows whose particles are contiguous do without
/// the nodes.
enum { STRAND_FLOPS = 51, STRAND_BYTES = 4 * 4 + 16 + 4 + 2 * 16 };

static void strands_comply(const Shell *shell, SingeColour colour, float h, float regularisation, StrandSet *set) {
    SINGE_ASSERT((unsigned)colour < SINGE_COLOUR_COUNT);
    SINGE_ASSERT(h > 0);
    const SpringSet *springs = &shell->springs[colour];
    Stiffness stiffness;
    stiffness_begin(shell, colour, h, regularisation, &stiffness);
    set->compliance_all = 0;
    for (uint32_t s = 0; s < set->strand_count; s++) {
        float *slot = set->compliance + set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, slot += STRAND_LANES) {
            *slot = stiffness_compliance(&stiffness, k);
            if (s == 0 && k == 0) set->compliance_all = *slot;
            if (*slot != set->compliance_all) set->compliance_all = -1;
        }
    }
}

bool strands_create(Memory *memory, const Shell *shell, const SingeSolverDef *solver, float h, int room_count,
                    StrandSolve *solve, Strands *strands) {
    SINGE_ASSERT(h > 0);
    *strands = (Strands){.solve = solve, .room_count = room_count};
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        StrandSet *set = &strands->sets[colour];
        bool pulls = shell->spare_count > 0;
        if (!strand_set_create(memory, &shell->springs[colour], shell->particle_count, pulls, set)) return false;
        strands_comply(shell, (SingeColour)colour, h, solver->regularisation[colour], set);
        if (strands->longest < set->longest) strands->longest = set->longest;
    }
    return NEW(memory, strands->keep, keep_floats(strands) * (size_t)room_count) != NULL;
}

void strands_free(Memory *memory, Strands *strands) {
    FREE(memory, strands->keep, keep_floats(strands) * (size_t)strands->room_count);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) strand_set_free(memory, &strands->sets[colour]);
    *strands = (Strands){0};
}

typedef struct Project {
    StrandJob job;
    Strands *strands;
    uint32_t first_group;
} Project;

/// Takes a room of the scratch for this thread, a bit of `taken`. A host's scheduler may run more threads than there
/// are rooms; they wait.
static int strands_enter(Strands *strands) {
    for (;; thread_yield())
        for (int room = 0; room < strands->room_count; room++) {
            uint64_t bit = (uint64_t)1 << room;
            if (!(atomic_fetch_or(&strands->taken, bit) & bit)) return room;
        }
}

static void strands_range(void *task, int begin, int end) {
    Project *project = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    Strands *strands = project->strands;
    int room = strands_enter(strands);
    float *keep = strands->keep + keep_floats(strands) * (size_t)room;
    keep += (64 - (uintptr_t)keep % 64) % 64 / sizeof *keep;
    for (int i = begin; i < end; i++) strands->solve(&project->job, project->first_group + (uint32_t)i, keep);
    atomic_fetch_and(&strands->taken, ~((uint64_t)1 << room));
}

void strand_project(DynamicsPlan *plan, SingeColour colour, Pool *pool, float h, DynamicsState *dynamics,
                    DynamicsCounters *counters) {
    SINGE_ASSERT((unsigned)colour < SINGE_COLOUR_COUNT);
    SINGE_ASSERT(h > 0);
    Strands *strands = &plan->strands;
    const StrandSet *set = &strands->sets[colour];
    Project project = {
        {set, dynamics->position[0], plan->settings.solver.regularisation[colour], 1 / (h * h)}, strands, 0};
    for (uint32_t f = 0; f < set->family_count; f++) {
        project.first_group = set->family_first[f];
        pool_for(pool, (int)(set->family_first[f + 1] - project.first_group), 1, strands_range, &project);
    }
    patch_project(plan, colour, 1 / (h * h), dynamics);
    counters->strands += set->strand_count;
    counters->springs += plan->spring_count[colour];
    counters->flops += (double)STRAND_FLOPS * plan->spring_count[colour];
    counters->bytes += (double)STRAND_BYTES * plan->spring_count[colour];
}

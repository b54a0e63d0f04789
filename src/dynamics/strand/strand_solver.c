// The solver of strands: each substep projects the colours in turn, and a colour's springs along their strands.
//
// Families of a colour follow each other as in block Gauss-Seidel; the groups of a family go side by side and share no
// particle, so that their order and the number of threads do not matter.
#include "common/clock.h"
#include "common/thread.h"
#include "dynamics/dynamics_plan.h"
#include "dynamics/stiffness.h"

#include <stdatomic.h>
#include <string.h>

/// Operations of a row of the chain's solve and bytes it moves, counted in strand_kernel.h. The bytes: node, target,
/// weight, compliance and position forward; node, position twice back. Rows whose particles are contiguous do without
/// the nodes.
enum { STRAND_FLOPS = 49, STRAND_BYTES = 4 * 4 + 16 + 4 + 2 * 16 };

/// Floats that one solve needs: STRAND_KEEP for each row and lane.
static size_t keep_floats(const Strands *strands) {
    return ((size_t)strands->longest * STRAND_KEEP + 1) * STRAND_LANES;
}

/// Compliances of a set's springs, and whether they are all the same.
static void set_stiffness(const SpringSet *springs, Stiffness *stiffness, StrandSet *set) {
    set->compliance_all = 0;
    for (uint32_t s = 0; s < set->strand_count; s++) {
        float *slot = set->compliance + set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, slot += STRAND_LANES) {
            *slot = stiffness_compliance(stiffness, k);
            if (s == 0 && k == 0) set->compliance_all = *slot;
            if (*slot != set->compliance_all) set->compliance_all = -1;
        }
    }
}

static bool strands_create(Memory *memory, const Shell *shell, DynamicsPlan *plan) {
    const SingeSolverDef *solver = &plan->settings.solver;
    const float h = plan->settings.time_step / (float)solver->substeps;
    Strands *strands = &plan->strands;
    *strands = (Strands){.solve = plan->kernels->solve, .room_count = plan->settings.thread_count};

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        StrandSet *set = &strands->sets[colour];
        if (!strand_set_create(memory, springs, shell->particle_count, shell->spare_count > 0, set)) return false;
        if (strands->longest < set->longest) strands->longest = set->longest;

        Stiffness stiffness;
        stiffness_begin(shell, (SingeColour)colour, h, solver, &stiffness);
        set_stiffness(springs, &stiffness, set);
    }

    // between centres, in two directions more
    if (solver->isotropic) {
        Stiffness stiffness;
        if (!NEW(memory, plan->braces, 1) || !braces_create(memory, shell, plan->braces)) return false;
        stiffness_begin(shell, SINGE_GREEN, h, solver, &stiffness);
        stiffness.braces = plan->braces->springs.ends;
        set_stiffness(&plan->braces->springs, &stiffness, &plan->braces->set);
        if (strands->longest < plan->braces->set.longest) strands->longest = plan->braces->set.longest;
    }

    if (!NEW(memory, strands->keep, keep_floats(strands) * (size_t)strands->room_count)) return false;
    if (!curvature_create(memory, shell, solver->isotropic, strands)) return false;
    if (!shell->creases) return true;
    if (!NEW(memory, plan->hinges, shell->springs[SINGE_GREEN].count)) return false;

    creases_measure(shell, plan->hinges);
    return true;
}

static void strands_release(Memory *memory, const Shell *shell, DynamicsPlan *plan) {
    Strands *strands = &plan->strands;
    FREE(memory, strands->keep, keep_floats(strands) * (size_t)strands->room_count);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) strand_set_free(memory, &strands->sets[colour]);
    FREE(memory, plan->hinges, shell->springs[SINGE_GREEN].count);
    if (plan->braces) braces_free(memory, plan->braces);
    FREE(memory, plan->braces, 1);
}

// ---- a step's weights and lengths

typedef struct Prepare {
    DynamicsPlan *plan;
    const Shell *shell;
    const StateInput *state;
    const DynamicsState *dynamics;
    SingeColour colour;
    bool all; ///< whatever has changed
} Prepare;

/// The springs of run r that are in strands end here.
static uint32_t run_end(const SpringSet *springs, uint32_t r) {
    uint32_t all = springs->strand_first[springs->strand_count];
    return (r + 1) * PREPARE_RUN < all ? (r + 1) * PREPARE_RUN : all;
}

/// Whether a run has, or had, a crease; `crease` begins at the run.
static inline bool run_creased(const StrandSet *set, uint32_t r, const float *crease, uint32_t count) {
    bool creased = set->creased[r];
    for (uint32_t k = 0; crease && k < count; k++) creased |= crease[k] != 0;
    return creased;
}

/// Weights and lengths of runs into the lanes; a crease changes lengths of green springs.
static void prepare_runs(void *task, int begin, int end) {
    const Prepare *job = task;
    const SpringSet *springs = &job->shell->springs[job->colour];
    StrandSet *set = &job->plan->strands.sets[job->colour];
    const uint8_t *flags = job->state->ablate->spring_flags[job->colour];
    const float *target = job->state->burn->spring_length[job->colour];
    const Field material = job->shell->matter.weight[job->colour];
    const float *soft = job->plan->soft;
    const float *crease = job->colour == SINGE_GREEN && job->plan->hinges ? job->dynamics->crease : NULL;
    const bool torn = job->shell->split_count > 0;
    const uint32_t *strand_first = springs->strand_first, *strand_slot = set->strand_slot;
    const uint32_t(*ends)[2] = (const uint32_t(*)[2])springs->ends;
    float *to_weight = set->weight, *to_target = set->target;
    uint8_t *seen = (uint8_t *)set->seen; // nobody marks any more

    for (uint32_t r = (uint32_t)begin; r < (uint32_t)end; r++) {
        const uint32_t first = r * PREPARE_RUN, last = run_end(springs, r), count = last - first;
        if (count == 0) continue;
        const bool all = job->all || run_creased(set, r, crease ? crease + first : NULL, count);
        if (!all && (count == PREPARE_RUN ? memcmp(flags + first, seen + first, PREPARE_RUN)
                                          : memcmp(flags + first, seen + first, count)) == 0)
            continue;

        set->stale[r] = 1;
        set->creased[r] = 0;
        uint32_t s = set->run_strand[r];
        for (uint32_t k = first; k < last; k++) {
            if (!all && seen[k] == flags[k]) continue;
            seen[k] = PREPARE_STALE;
            while (k >= strand_first[s + 1]) s++;
            const size_t slot = strand_slot[s] + (size_t)(k - strand_first[s]) * STRAND_LANES;
            uint32_t a = ends[k][0], b = ends[k][1];
            bool here = flags[k] & SINGE_ALIVE;
            if (torn) here = here && patch_is_in_strand(job->plan, job->shell, job->colour, k, slot);
            to_weight[slot] = here ? 0.5f * dynamics_weight(material, soft, a, b) : 0;
            to_target[slot] = target[k] * target[k];
            if (!crease || crease[k] == 0) continue;
            const float length = target[k] * crease_factor(job->plan, job->shell, job->state, job->dynamics, k);
            to_target[slot] = length * length;
            set->creased[r] = 1;
        }
    }
}

/// Limits of curvature, once all weights are there: those of a run's first spring also follow from the run before.
static void prepare_limits(void *task, int begin, int end) {
    const Prepare *job = task;
    const SpringSet *springs = &job->shell->springs[job->colour];
    StrandSet *set = &job->plan->strands.sets[job->colour];

    for (uint32_t r = (uint32_t)begin; r < (uint32_t)end; r++) {
        const uint32_t first = r * PREPARE_RUN;
        uint32_t last = run_end(springs, r);
        const bool stale = set->rings || set->stale[r], before = r > 0 && set->stale[r - 1];
        if (first == last || !(stale || before)) continue;
        if (!stale) last = first + 1;
        uint32_t s = set->run_strand[r];
        for (uint32_t k = first; k < last; s++) {
            const uint32_t to = springs->strand_first[s + 1] < last ? springs->strand_first[s + 1] : last;
            curvature_prepare(job->shell, job->state, job->colour, s, k, to, set);
            k = to;
        }
    }
}

static void strands_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                            const DynamicsState *dynamics) {
    Prepare job = {plan, shell, state, dynamics, SINGE_RED, false};
    bool torn = patch_follow(plan, shell);

    // otherwise the values of an earlier step are still right, but for the springs of what burns (prepare.c)
    job.all = !plan->written || torn;
    if (plan->braces && (job.all || plan->creased || state->burn->mass_burnt > 0))
        braces_prepare(plan->braces, plan, shell, state, pool, dynamics);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        job.colour = (SingeColour)colour;
        StrandSet *set = &plan->strands.sets[colour];
        const SpringSet *springs = &shell->springs[colour];
        pool_for(pool, (int)set->run_count, POOL_BLOCK / PREPARE_RUN, prepare_runs, &job);
        if (set->bend_limit) pool_for(pool, (int)set->run_count, POOL_BLOCK / PREPARE_RUN, prepare_limits, &job);

        // what has been prepared is no longer stale
        uint8_t *stale = set->stale;
        while ((stale = memchr(stale, 1, set->run_count - (size_t)(stale - set->stale)))) {
            const uint32_t r = (uint32_t)(stale - set->stale), first = r * PREPARE_RUN;
            memcpy((uint8_t *)set->seen + first, state->ablate->spring_flags[colour] + first,
                   run_end(springs, r) - first);
            *stale++ = 0;
        }
    }

    patch_prepare(plan, shell, state);
}

// ---- a substep

/// A thread that shares a family fetches half of its particles, or more, from the caches of the threads that had the
/// strands across. Two or three threads take longer for that than one alone for a family of fewer springs than this; but
/// for a substep's first one, if it lies along the particles' numbers, where each thread has what it has moved.
enum { SHARED_SPRINGS = 65536, SHARING_THREADS = 4 };

void strand_families(const StrandSet *set, bool opens, Pool *pool, SingeTaskFn *run, void *context,
                     uint32_t *first_group) {
    for (uint32_t f = 0; f < set->family_count; f++) {
        const uint32_t first = set->family_first[f], last = set->family_first[f + 1];
        const uint32_t springs = first < last ? (set->groups[last - 1].row - set->groups[first].row) * STRAND_LANES : 0;
        const bool along = opens && f == 0 && springs > 0 && set->contiguous[set->groups[first].row] == STRAND_GATHERED;
        const bool alone = springs < SHARED_SPRINGS && pool_threads(pool) < SHARING_THREADS && !along;
        *first_group = first;
        pool_for(pool, (int)(last - first), alone ? (int)(last - first) : 1, run, context);
    }
}

typedef struct Project {
    StrandJob job;
    Strands *strands;
    uint32_t first_group;
} Project;

static void project_range(void *task, int begin, int end) {
    Project *project = task;
    Strands *strands = project->strands;

    // take a room of the scratch for this thread, a bit of `taken`. A host's scheduler may run more threads than there
    // are rooms; they wait
    int room = 0;
    while (atomic_fetch_or(&strands->taken, (uint64_t)1 << room) & (uint64_t)1 << room)
        if (++room == strands->room_count) {
            room = 0;
            thread_yield();
        }

    float *keep = strands->keep + keep_floats(strands) * (size_t)room;
    keep += (64 - (uintptr_t)keep % 64) % 64 / sizeof *keep;
    for (int i = begin; i < end; i++) strands->solve(&project->job, project->first_group + (uint32_t)i, keep);
    atomic_fetch_and(&strands->taken, ~((uint64_t)1 << room));
}

/// One of `count` projections of a colour, among which its compliance is divided. In sheets that tear, so is the
/// regularisation: a constraint that cannot be satisfied, such as a straight edge between two pins, is pulled in each
/// projection, and its line force would grow with their number.
static void strands_project_colour(DynamicsPlan *plan, SingeColour colour, Pool *pool, float h, int count,
                                   DynamicsState *dynamics, DynamicsCounters *counters) {
    Strands *strands = &plan->strands;
    const StrandSet *set = &strands->sets[colour], *braces = NULL;
    const int shares = plan->patches.capacity > 0 ? count : 1;
    const float given = strands->started ? 1 - plan->settings.solver.start : 1; // of forces; the start has the rest
    Project project = {.job = {.position = dynamics->position[0],
                               .regularisation = plan->settings.solver.regularisation[colour] * (float)shares,
                               .inverse_h2 = (float)count / (h * h * given)},
                       .strands = strands};
    if (colour == SINGE_GREEN && plan->braces) braces = &plan->braces->set;
    for (const StrandSet *next = set; next; next = next == set ? braces : NULL) {
        project.job.set = next;
        strand_families(next, strands->opens, pool, project_range, &project, &project.first_group);
    }

    patch_project(plan, colour, &project.job);
    counters->strands += set->strand_count;
    counters->springs += plan->spring_count[colour];
    counters->flops += (double)STRAND_FLOPS * plan->spring_count[colour];
    counters->bytes += (double)STRAND_BYTES * plan->spring_count[colour];
}

void strand_project(DynamicsPlan *plan, SingeColour colour, Pool *pool, float h, DynamicsState *dynamics,
                    DynamicsCounters *counters) {
    strands_project_colour(plan, colour, pool, h, 1, dynamics, counters);
}

/// A projection of all colours: the attachments come first, for the load, and before the last colour, which is satisfied
/// best: so it repairs what they disturb.
static SingeResult strands_project(DynamicsPlan *plan, const Substep *substep) {
    const SingeSolverDef *solver = &plan->settings.solver;
    const Shell *shell = substep->shell;
    const AblateState *ablate = substep->state->ablate;
    Pool *pool = substep->pool;
    DynamicsState *dynamics = substep->dynamics;
    const float h = substep->h;

    // Times that the last colour is projected after the others, as its families pull each other's strands off their lengths:
    // twice halves the strain, for a tenth of a substep's work. Where one vertex carries a sheet, two edges have its load,
    // and take longest.
    enum { TWICE = 2, HUNG_BY_ONE = 5 };
    int times = TWICE;
    for (uint32_t s = 0; s < shell->sheet_count && solver->attachments; s++) {
        const uint32_t *source = plan->attachments.source[s];
        if (source[0] != SHELL_NONE && source[1] == SHELL_NONE) times = HUNG_BY_ONE;
    }

    for (int projection = 0; projection < solver->projections; projection++)
        for (int i = 0; i < SINGE_COLOUR_COUNT; i++) {
            const bool last = i == SINGE_COLOUR_COUNT - 1,
                       again = i == 0 && projection > 0; // the first: with prediction
            if (solver->attachments && (again || last))
                attach_project(&plan->attachments, shell, plan->kernels->hold, pool, dynamics);
            if (last) curvature_project(plan, pool, dynamics);
            double start = clock_seconds();
            const int count = last && projection + 1 == solver->projections ? times : 1;
            plan->strands.opens = i == 0 && projection == 0;
            for (int k = 0; k < count; k++)
                strands_project_colour(plan, solver->order[i], pool, h, count, dynamics, substep->counters);
            substep->counters->seconds += clock_seconds() - start;
        }
    height_project(plan, shell, ablate, pool, dynamics);

    if (dynamics_keeps_start(plan, substep->collider_count)) dynamics_keep_start(plan, pool, dynamics);

    // what contact has strained in a turn, sides give to the layers behind before the next
    const float(*predicted)[4] = (const float(*)[4])plan->predicted;
    const int turns = plan->collision ? repulsion_turns(plan->collision) : 0;
    for (int turn = 0; turn < turns; turn++) {
        if (turn > 0) strand_project(plan, SINGE_BLUE, pool, h, dynamics, substep->counters);
        const bool last = turn + 1 == turns;
        if (!plan->kernels->push(plan->collision, shell, pool, predicted, h, last, dynamics)) break;
    }

    contact_centroids(plan, shell, ablate, substep->collider_count, pool, h, dynamics);
    return SINGE_OK;
}

const Solver strand_solver = {.create = strands_create,
                              .release = strands_release,
                              .prepare = strands_prepare,
                              .project = strands_project,
                              .gather = patch_gather,
                              .limit = dynamics_limit,
                              .leaves_closing = true,
                              .takes_parts = true};

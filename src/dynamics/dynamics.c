// A step of the shell's motion: substeps of prediction, projection, layer order and contact (eq 8 to 15, 18).
//
// One projection of every colour a substep instead of several a step: the same cost and a smaller
// error (Macklin et al., Small steps in physics simulation, 2019).
#include "common/assertion.h"
#include "common/clock.h"
#include "dynamics/stiffness.h"
#include "dynamics/paper_solver.h"
#include "dynamics/dynamics_plan.h"

#include <string.h>

/// Max number of blocks of a sum: over the particles, or the springs of two colours.
static int plan_partials(const Shell *shell) {
    int particles = pool_blocks((int)shell->particle_count), springs = 0;
    for (int i = 0; i < SINGE_COLOUR_COUNT; i++) {
        int blocks = pool_blocks((int)shell->springs[i].count);
        springs = springs > blocks ? springs : blocks;
    }
    return particles > 2 * springs ? particles : 2 * springs;
}

static bool plan_allocate(DynamicsPlan *plan, const Shell *shell, Memory *memory) {
    bool ok = NEW(memory, plan->inverse_mass, plan->particle_count) && NEW(memory, plan->drag, plan->particle_count) &&
              NEW(memory, plan->normal, plan->particle_count) && NEW(memory, plan->air, plan->particle_count) &&
              NEW(memory, plan->predicted, plan->particle_count) && NEW(memory, plan->soft, plan->particle_count) &&
              NEW(memory, plan->cell_normal, plan->cell_count) &&
              NEW(memory, plan->height_wait, height_wait_count(shell)) &&
              NEW(memory, plan->colliders, plan->collider_capacity) && NEW(memory, plan->partial, plan_partials(shell));
    if (ok && shell->creases && plan->settings.solver.method == SINGE_SOLVER_STRAND) {
        ok = NEW(memory, plan->hinges, shell->springs[SINGE_GREEN].count);
        if (ok) creases_measure(shell, plan->hinges);
    }
    return ok;
}

bool dynamics_runs_here(SingeInstructions instructions) { return kernels_choose(instructions) != NULL; }
SingeInstructions dynamics_instructions(SingeInstructions asked) { return kernels_choose(asked)->instructions; }

SingeResult dynamics_plan_create(Memory *memory, const Shell *shell, const DynamicsSettings *settings,
                                 DynamicsPlan **out) {
    *out = NULL;
    DynamicsPlan *plan = memory_new(memory, 1, sizeof *plan);
    if (!plan) return SINGE_ERROR_MEMORY;

    // settings, and sizes that follow from the shell
    plan->settings = *settings;
    SingeSolverDef *solver = &plan->settings.solver;
    if (solver->substeps == 0)
        solver->substeps = stiffness_substeps(shell, settings->time_step, solver->regularisation[SINGE_RED]);
    float h_sub = settings->time_step / (float)solver->substeps;
    plan->particle_count = shell->particle_count;
    plan->cell_count = shell->cell_count;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        plan->spring_count[colour] = shell_strand_springs(shell, colour);

    // the solver's parts
    plan->kernels = kernels_choose(settings->instructions);
    if (!plan_allocate(plan, shell, memory) ||
        !strands_create(memory, shell, solver, h_sub, settings->thread_count, plan->kernels->solve, &plan->strands) ||
        !curvature_create(memory, shell, &plan->strands) || !patches_create(memory, shell, &plan->patches) ||
        !attach_create(memory, shell, &plan->attachments) ||
        (settings->contact.enabled &&
         collision_plan_create(memory, shell, &settings->contact, settings->time_step, &plan->collision)) ||
        (paper_needed(settings->solver.method) && paper_create(memory, shell, settings, &plan->paper))) {
        dynamics_plan_free(memory, shell, plan);
        return SINGE_ERROR_MEMORY;
    }
    *out = plan;
    return SINGE_OK;
}

int dynamics_plan_substeps(const DynamicsPlan *plan) { return plan->settings.solver.substeps; }

void dynamics_plan_free(Memory *memory, const Shell *shell, DynamicsPlan *plan) {
    if (!plan) return;
    paper_free(memory, plan->paper);
    collision_plan_free(memory, plan->collision);
    FREE(memory, plan->inverse_mass, plan->particle_count);
    FREE(memory, plan->drag, plan->particle_count);
    FREE(memory, plan->normal, plan->particle_count);
    FREE(memory, plan->air, plan->particle_count);
    FREE(memory, plan->predicted, plan->particle_count);
    FREE(memory, plan->soft, plan->particle_count);
    FREE(memory, plan->cell_normal, plan->cell_count);
    FREE(memory, plan->height_wait, height_wait_count(shell));
    FREE(memory, plan->colliders, plan->collider_capacity);
    FREE(memory, plan->partial, plan_partials(shell));
    FREE(memory, plan->hinges, shell->springs[SINGE_GREEN].count);
    strands_free(memory, &plan->strands);
    patches_free(memory, shell, &plan->patches);
    attach_free(memory, shell, &plan->attachments);
    FREE(memory, plan, 1);
}

void dynamics_plan_hold(DynamicsPlan *plan, const Shell *shell, const State *state) {
    if (plan->settings.solver.attachments) attach_update(&plan->attachments, shell, STATE_INPUT(state), true);
}

const float *dynamics_pull(const DynamicsPlan *plan, SingeColour colour) { return plan->patches.pull[colour]; }

float dynamics_stretch(const DynamicsPlan *plan, uint32_t sheet) {
    return plan->settings.solver.attachments ? attach_stretched(&plan->attachments.spread[sheet]) : 1;
}

void dynamics_plan_torn(DynamicsPlan *plan, uint32_t vertex, uint32_t spare) {
    attach_split(&plan->attachments, vertex, spare);
    if (plan->collision) collision_plan_forget(plan->collision); // cells that shared a corner may now be in contact
}

void dynamics_plan_set_gravity(DynamicsPlan *plan, const float gravity[3]) {
    memcpy(plan->settings.gravity, gravity, sizeof plan->settings.gravity);
}

void dynamics_plan_velocity_changed(DynamicsPlan *plan) {
    if (plan->collision) collision_plan_forget(plan->collision); // its boxes are for the old velocities
}

SingeResult dynamics_plan_stream(Memory *memory, DynamicsPlan *plan, const Shell *shell, const State *state,
                                 Stream *stream) {
    attach_stream(&plan->attachments, shell, stream);
    return plan->collision ? collision_plan_stream(memory, plan->collision, shell, state->ablate.cell_flags, stream)
                           : SINGE_OK;
}

CollisionCounters dynamics_plan_contacts(const DynamicsPlan *plan) {
    return plan->collision ? collision_counters(plan->collision) : (CollisionCounters){0};
}

const char *dynamics_plan_validate(const DynamicsPlan *plan) {
    if (atomic_load(&plan->strands.taken) != 0) return "no thread has scratch of the strands between steps";
    return plan->collision ? collision_validate(plan->collision) : NULL;
}

void dynamics_plan_clearance(const DynamicsPlan *plan, const Shell *shell, const State *state, float *room) {
    for (uint32_t v = 0; v < shell->vertex_count; v++) room[v] = INFINITY;
    if (plan->collision) collision_clearance(plan->collision, shell, STATE_INPUT(state), room);
}

bool dynamics_plan_reserve(Memory *memory, DynamicsPlan *plan, uint32_t collider_capacity) {
    if (collider_capacity <= plan->collider_capacity) return true;
    if (!memory_grow(memory, &plan->colliders, plan->collider_capacity, collider_capacity, sizeof *plan->colliders))
        return false;
    plan->collider_capacity = collider_capacity;
    return true;
}

/// The colliders in use, with their poses at the ends of a substep.
static uint32_t dynamics_pose_colliders(DynamicsPlan *plan, const ColliderList *list, double before, double after) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const Collider *collider = &list->items[i];
        if (collider->generation == 0) continue;
        plan->colliders[count++] = contact_collider(collider, before, after);
    }
    return count;
}

/// Counts particles that are not finite or farther than 10 km from the origin. 1e18 m/s: squares are finite.
static double dynamics_count_lost(void *task, int begin, int end) {
    const DynamicsState *dynamics = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    double lost = 0;
    for (int i = begin; i < end; i++) {
        const float *x = dynamics->position[i], *v = dynamics->velocity[i];
        lost += !(fabsf(x[0]) < 1e4f && fabsf(x[1]) < 1e4f && fabsf(x[2]) < 1e4f) ||
                !(fabsf(v[0]) < 1e18f && fabsf(v[1]) < 1e18f && fabsf(v[2]) < 1e18f);
    }
    return lost;
}

static SingeResult dynamics_check(DynamicsPlan *plan, Pool *pool, DynamicsState *dynamics, SingeError *error) {
    if (pool_sum(pool, (int)plan->particle_count, dynamics_count_lost, dynamics, plan->partial) == 0) return SINGE_OK;
    int i = 0;
    while (dynamics_count_lost(dynamics, i, i + 1) == 0) i++;
    return error_set(
        error, SINGE_ERROR_DIVERGED, "dynamics", i,
        "particle %d has no finite position within 10 km, or velocity; a smaller time_step or more substeps may help",
        i);
}

/// One projection of all colours. The attachments come first, for the load, and before the last colour, which is
/// satisfied best: so it repairs what they disturb.
static void dynamics_project(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h, bool attached,
                             DynamicsState *dynamics, DynamicsCounters *counters) {
    SINGE_ASSERT(h > 0);
    const SingeSolverDef *solver = &plan->settings.solver;
    for (int i = 0; i < SINGE_COLOUR_COUNT; i++) {
        if (solver->attachments && ((i == 0 && !attached) || i == SINGE_COLOUR_COUNT - 1))
            attach_project(&plan->attachments, shell, plan->kernels->hold, pool, dynamics);
        if (i == SINGE_COLOUR_COUNT - 1) curvature_project(plan, pool, dynamics);
        double start = clock_seconds();
        strand_project(plan, solver->order[i], pool, h, dynamics, counters);
        counters->seconds += clock_seconds() - start;
    }
}

/// Alternates limits and CCD: what CCD has stopped may be too far from what it has not.
static SingeResult dynamics_close(Memory *memory, DynamicsPlan *plan, const StepContext *context,
                                  DynamicsState *dynamics) {
    enum { TURNS = 8 };
    const Shell *shell = context->shell;
    const StateInput *state = &context->state;
    for (int turn = 0; turn < TURNS; turn++) {
        bool limited = dynamics_limit(plan, shell, state, context->pool, dynamics);
        if (!plan->collision || (turn > 0 && !limited)) break;
        uint64_t stops = collision_counters(plan->collision).stops;
        TRY(ccd_apply(memory, plan->collision, shell, state, context->pool, context->h, dynamics));
        if (collision_counters(plan->collision).stops == stops) break;
    }
    return SINGE_OK;
}

static SingeResult dynamics_contact_result(SingeResult result, SingeError *error) {
    return result ? error_set(error, result, "contact", -1, "out of memory for what is near each other") : SINGE_OK;
}

SingeResult dynamics_step(Memory *memory, DynamicsPlan *plan, const StepContext *context, DynamicsState *dynamics,
                          DynamicsCounters *counters) {
    const SingeSolverDef *solver = &plan->settings.solver;
    const Shell *shell = context->shell;
    const StateInput *state = &context->state;
    const AblateState *ablate = state->ablate;
    Pool *pool = context->pool;
    SingeError *error = context->error;
    float h = context->h, h_sub = h / (float)solver->substeps;

    // what stays the same during the step
    dynamics_prepare(plan, shell, state, context->wind, pool, dynamics);
    if (plan->paper) paper_prepare(plan, shell, state, pool);
    if (plan->collision)
        TRY(dynamics_contact_result(collision_open(memory, plan->collision, shell, state, pool, dynamics), error));

    // each pass closes a substep and opens the next: one pass more than substeps
    Between between = {.opens = true};
    double before = state->time;
    for (int substep = 0; substep <= solver->substeps; substep++) {
        double after = state->time + (double)h * (substep + 1) / solver->substeps;
        between.opens = substep < solver->substeps;
        between.attaches = between.opens && solver->attachments && !plan->paper;

        // velocities of the last substep, prediction of the next; held particles are at its end before the others start
        if (between.opens) dynamics_move_pins(plan, context->pins, ablate, after, h_sub, dynamics);
        counters->contacts += dynamics_move(plan, shell, pool, h_sub, &between, dynamics);
        if (!between.opens) break;
        uint32_t collider_count = dynamics_pose_colliders(plan, context->colliders, before, after);
        before = after;

        // projection and contact
        if (plan->paper) {
            TRY(paper_project(plan, shell, ablate, collider_count, pool, h_sub, dynamics, counters, error));
            continue;
        }
        for (int projection = 0; projection < solver->projections; projection++)
            dynamics_project(plan, shell, pool, h_sub, projection == 0, dynamics, counters);
        height_project(plan, shell, ablate, pool, dynamics);
        if (plan->collision) repulsion_apply(plan->collision, (const float(*)[4])plan->predicted, h_sub, dynamics);
        contact_centroids(plan, shell, ablate, collider_count, pool, h_sub, dynamics);
        between.closes = true;
        between.collider_count = collider_count;
    }

    // forces for the tears; limits and CCD
    if (shell->spare_count > 0) patch_gather(plan, shell, pool, h_sub);
    TRY(dynamics_check(plan, pool, dynamics, error));
    TRY(dynamics_contact_result(dynamics_close(memory, plan, context, dynamics), error));

    // once a step: internal friction, order of the layers, creases, attachments
    dynamics_smooth(plan, shell, ablate, pool, h, dynamics);
    dynamics_order(plan, shell, ablate, pool, dynamics);
    plan->strands_written = true;
    dynamics_crease(plan, shell, state, pool, h, dynamics);
    TRY(dynamics_check(plan, pool, dynamics, error));
    StateInput done = *state;
    done.dynamics = dynamics; // nothing writes it from here on
    if (solver->attachments) attach_update(&plan->attachments, shell, &done, false);
    return SINGE_OK;
}

// A step of the shell's motion: substeps of prediction, projection, layer order and contact (eq 8 to 15, 18).
//
// One projection of every colour a substep instead of several a step: the same cost and a smaller
// error (Macklin et al., Small steps in physics simulation, 2019).
#include "common/assertion.h"
#include "common/float4.h"
#include "dynamics/stiffness.h"
#include "dynamics/dynamics_plan.h"

#include <string.h>

#define SOLVER(method, solver) [method] = &(solver),
static const Solver *const solvers[] = {SOLVERS(SOLVER)};

/// Max number of blocks of a sum: over the particles, or the springs of two colours.
static int plan_partials(const Shell *shell) {
    int particles = pool_blocks((int)shell->particle_count), springs = 0;
    for (int i = 0; i < SINGE_COLOUR_COUNT; i++) {
        int blocks = pool_blocks((int)shell->springs[i].count);
        springs = springs > blocks ? springs : blocks;
    }

    return particles > 2 * springs ? particles : 2 * springs;
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
    else if (settings->plume) {
        const int carrying = stiffness_carrying(shell, settings->time_step);
        if (carrying > 2 * solver->substeps) solver->substeps = carrying; // fewer by less than that stretch, and hold
    }
    plan->particle_count = shell->particle_count;
    plan->cell_count = shell->cell_count;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        plan->spring_count[colour] = shell_strand_springs(shell, colour);

    // arrays, and what the solver needs
    plan->kernels = kernels_choose(settings->instructions);
    plan->solver = solvers[solver->method];
    const bool done =
        NEW(memory, plan->inverse_mass, plan->particle_count) && NEW(memory, plan->normal, plan->particle_count) &&
        NEW(memory, plan->air, plan->particle_count + 4) && NEW(memory, plan->predicted, plan->particle_count) &&
        (solver->start == 0 ||
         (NEW(memory, plan->start, plan->particle_count) && NEW(memory, plan->given, plan->particle_count))) &&
        NEW(memory, plan->soft, plan->particle_count) && NEW(memory, plan->height_wait, height_wait_count(shell)) &&
        NEW(memory, plan->colliders, plan->collider_capacity) && NEW(memory, plan->partial, plan_partials(shell)) &&
        (!plan->solver->create || plan->solver->create(memory, shell, plan)) &&
        patches_create(memory, shell, &plan->patches) && attach_create(memory, shell, &plan->attachments) &&
        smooth_create(memory, shell, plan) && plates_create(memory, plan) &&
        (!settings->contact.enabled ||
         !collision_plan_create(memory, shell, &settings->contact, settings->time_step, &plan->collision));
    if (!done) {
        dynamics_plan_free(memory, shell, plan);
        return SINGE_ERROR_MEMORY;
    }

    plan->cell_normal = plan->predicted + shell->vertex_count;
    *out = plan;
    return SINGE_OK;
}

int dynamics_plan_substeps(const DynamicsPlan *plan) { return plan->settings.solver.substeps; }

void dynamics_plan_free(Memory *memory, const Shell *shell, DynamicsPlan *plan) {
    if (!plan) return;
    if (plan->solver->release) plan->solver->release(memory, shell, plan);
    collision_plan_free(memory, plan->collision);
    FREE(memory, plan->inverse_mass, plan->particle_count);
    FREE(memory, plan->normal, plan->particle_count);
    FREE(memory, plan->air, plan->particle_count + 4);
    FREE(memory, plan->predicted, plan->particle_count);
    if (plan->start) FREE(memory, plan->start, plan->particle_count);
    if (plan->given) FREE(memory, plan->given, plan->particle_count);
    FREE(memory, plan->soft, plan->particle_count);
    FREE(memory, plan->height_wait, height_wait_count(shell));
    FREE(memory, plan->colliders, plan->collider_capacity);
    FREE(memory, plan->partial, plan_partials(shell));
    plates_free(memory, plan);
    FREE(memory, plan->reach[0], shell->springs[SINGE_BLUE].strand_count);
    FREE(memory, plan->reach[1], shell->springs[SINGE_GREEN].strand_count);
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

/// Not 0 if a particle is not finite or farther than 10 km from the origin. 1e18 m/s: squares are finite.
static double dynamics_count_lost(void *task, int begin, int end) {
    const DynamicsState *dynamics = task;
    Float4Mask here = {-1, -1, -1, -1};
    for (int i = begin; i < end; i++) {
        const Float4 x = float4_load(dynamics->position[i]), v = float4_load(dynamics->velocity[i]);
        here &= (x < 1e4f) & (x > -1e4f) & (v < 1e18f) & (v > -1e18f);
    }

    return (float4_bits(here) & 7) != 7; // the fourth is no coordinate
}

static SingeResult dynamics_check(DynamicsPlan *plan, Pool *pool, DynamicsState *dynamics, SingeError *error) {
    if (pool_sum(pool, (int)plan->particle_count, dynamics_count_lost, dynamics, plan->partial) == 0) return SINGE_OK;
    int i = 0;
    while (dynamics_count_lost(dynamics, i, i + 1) == 0) i++;
    return error_set(
        error, SINGE_ERROR_DIVERGED, "dynamics", i,
        "particle %d has left 10 km, or its position or velocity is not finite; a smaller time_step or more substeps may help",
        i);
}

static SingeResult dynamics_contact_result(SingeResult result, Pool *pool, SingeError *error) {
    if (result == SINGE_ERROR_CANCELLED) return pool_check_cancelled(pool, "contact", error);
    return result ? error_set(error, result, "contact", -1, "out of memory for the list of contacts") : SINGE_OK;
}

/// A part of a step, of context->h seconds from context->state.time on.
static SingeResult dynamics_part(Memory *memory, DynamicsPlan *plan, const StepContext *context, bool first,
                                 DynamicsState *dynamics, DynamicsCounters *counters) {
    enum { TURNS = 8 };
    const SingeSolverDef *solver = &plan->settings.solver;
    const Shell *shell = context->shell;
    const StateInput *state = &context->state;
    const AblateState *ablate = state->ablate;
    Pool *pool = context->pool;
    SingeError *error = context->error;
    float h = context->h;

    // what stays the same during the part
    dynamics_prepare(plan, shell, state, context->wind, context->sources, pool, dynamics);
    dynamics_fly(plan, shell, ablate, state->time, h, dynamics);
    if (plan->collision)
        TRY(dynamics_contact_result(
            plan->kernels->open(memory, plan->collision, shell, state, pool, h, first, dynamics), pool, error));

    // each pass closes a substep and opens the next: one pass more than substeps
    Substep part = {shell, state, pool, 0, h / (float)solver->substeps, dynamics, counters, error};
    Between between = {.opens = true};
    double before = state->time;

    for (int substep = 0; substep <= solver->substeps; substep++) {
        plan->strands.started = plan->start && substep > 0;
        double after = state->time + (double)h * (substep + 1) / solver->substeps;
        between.opens = substep < solver->substeps;
        between.attaches = between.opens && solver->attachments && plan->solver->leaves_closing;

        // velocities of the last substep, prediction of the next; held particles are at its end before the others start
        if (between.opens) dynamics_move_pins(plan, context->pins, ablate, after, part.h, dynamics);
        counters->contacts += dynamics_move(plan, shell, pool, part.h, &between, dynamics);
        TRY(pool_check_cancelled(pool, "dynamics", error));
        if (!between.opens) break;

        // the colliders in use, with their poses at both ends of the substep
        part.collider_count = 0;
        for (uint32_t i = 0; i < context->colliders->count; i++) {
            const Collider *collider = &context->colliders->items[i];
            if (collider->generation == 0) continue;
            SINGE_ASSERT(part.collider_count < plan->collider_capacity);
            plan->colliders[part.collider_count++] = contact_collider(collider, before, after);
        }

        before = after;

        // projection
        TRY(plan->solver->project(plan, &part));
        between.closes = plan->solver->leaves_closing;
        between.collider_count = between.closes ? part.collider_count : 0;
    }

    // forces for the tears
    if (shell->spare_count > 0 && plan->solver->gather) plan->solver->gather(plan, shell, pool, part.h);
    if (plan->collision) TRY(dynamics_check(plan, pool, dynamics, error));

    // limits and CCD alternate: what CCD has stopped may be too far from what it has not. Where that takes much work, CCD
    // has the last word
    for (int turn = 0; turn < TURNS; turn++) {
        bool limited = plan->solver->limit && plan->solver->limit(plan, shell, state, pool, dynamics);
        if (!plan->collision || (turn > 0 && !limited)) break;
        const uint64_t stops = collision_counters(plan->collision).stops;
        TRY(dynamics_contact_result(plan->kernels->stop(memory, plan->collision, shell, state, pool, h, dynamics), pool,
                                    error));
        if (collision_counters(plan->collision).stops == stops || ccd_is_busy(plan->collision)) break;
    }

    // internal friction, order of the layers, creases
    dynamics_smooth(plan, shell, ablate, pool, h, dynamics);
    dynamics_order(plan, shell, ablate, pool, dynamics);
    plan->written = true;
    dynamics_crease(plan, shell, state, pool, h, dynamics);
    return dynamics_check(plan, pool, dynamics, error);
}

static SingeResult dynamics_parts(Memory *memory, DynamicsPlan *plan, const StepContext *context,
                                  DynamicsState *dynamics, DynamicsCounters *counters) {
    const StateInput *state = &context->state;
    const bool parts = plan->collision && plan->solver->takes_parts;
    const int count = parts ? collision_parts(plan->collision) : 1;
    StepContext part = *context;
    part.h = context->h / (float)count;
    for (int k = 0; k < count; k++) {
        const uint64_t halts = plan->collision ? collision_counters(plan->collision).halts : 0;
        part.state.time = state->time + (double)context->h * k / count;
        TRY(dynamics_part(memory, plan, &part, k == 0, dynamics, counters));
        if (count > 1 && collision_counters(plan->collision).halts > halts) break; // the rest of the step, too
    }
    return SINGE_OK;
}

SingeResult dynamics_step(Memory *memory, DynamicsPlan *plan, const StepContext *context, DynamicsState *dynamics,
                          DynamicsCounters *counters) {
    if (plan->collision) collision_plan_keep(plan->collision);
    const SingeResult result = dynamics_parts(memory, plan, context, dynamics, counters);
    if (result) {
        if (plan->collision) collision_plan_restore(memory, plan->collision, context->shell);
        return result;
    }

    StateInput done = context->state;
    done.dynamics = dynamics; // nothing writes it from here on
    if (plan->settings.solver.attachments) attach_update(&plan->attachments, context->shell, &done, false);
    return SINGE_OK;
}

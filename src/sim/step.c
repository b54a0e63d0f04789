// The step, in the order of the paper's section 4, and after it the gas.
#include "common/assertion.h"
#include "common/clock.h"
#include "shell/shell_validate.h"
#include "sim/calls.h"

#include <string.h>

/// Adds the time since *start to a stage and starts the next.
static void step_lap(SingeSim *sim, SingeStage stage, double *start) {
    double now = clock_seconds();
    sim->timers.seconds[stage] += now - *start;
    *start = now;
}

/// Tears, and updates after them.
static void step_tear(SingeSim *sim, StepContext context) {
    State *state = &sim->state;
    bool short_of_spares = false;
    const float *pull[SINGE_COLOUR_COUNT];
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        pull[colour] = dynamics_pull(sim->dynamics, (SingeColour)colour);
    for (uint32_t s = 0; s < sim->shell.sheet_count; s++)
        tear_stretched(sim->tear, s, dynamics_stretch(sim->dynamics, s));

    uint32_t tears = tear_step(sim->tear, &sim->shell, state, pull, sim->pool, context.h, &short_of_spares);
    if (short_of_spares) sim_log_short_of_spares(sim);
    if (tears == 0) return;

    // copy what is stored for a vertex outside the State to its new half
    for (uint32_t k = state->tear.split_count - tears; k < state->tear.split_count; k++) {
        const uint32_t vertex = state->tear.splits[k].vertex, spare = state->tear.splits[k].spare;
        dynamics_plan_torn(sim->dynamics, vertex, spare);
        if (sim->gas) gas_plan_torn(sim->gas, vertex, spare);
        for (uint32_t i = 0; i < sim->sources.count; i++)
            if (sim->sources.items[i].texture)
                sim->sources.items[i].texture[spare] = sim->sources.items[i].texture[vertex];
    }

    context.state.ablate = NULL;
    ablate_torn(sim->ablate, &context, &state->ablate);
}

StepContext sim_context(SingeSim *sim, const SingeView *view) {
    return (StepContext){.shell = &sim->shell,
                         .state = state_input(&sim->state),
                         .pins = &sim->pins,
                         .colliders = &sim->colliders,
                         .sources = &sim->sources,
                         .wind = &sim->def.wind,
                         .view = view,
                         .heard = sim_recorder(sim) ? recorder_hear : NULL,
                         .hearer = sim_recorder(sim),
                         .pool = sim->pool,
                         .events = &sim->events,
                         .error = &sim->error,
                         .h = sim->def.time_step,
                         .pace = sim->def.pace,
                         .ambient_temperature = sim->def.ambient_temperature};
}

/// Stores the counters of the stages.
static void step_note(SingeSim *sim, const HeatCounters *heat, const DynamicsCounters *dynamics) {
    SingeTimers *timers = &sim->timers;
    timers->heat_iterations += heat->iterations;
    timers->strands_projected += dynamics->strands;
    timers->contacts += dynamics->contacts;
    timers->projection_seconds += dynamics->seconds;
    timers->springs_projected += dynamics->springs;
    timers->projection_iterations += dynamics->iterations;
    timers->projection_flops += dynamics->flops;
    timers->projection_bytes += dynamics->bytes;

    // contacts
    CollisionCounters found = dynamics_plan_contacts(sim->dynamics);
    timers->contact_searches = found.searches;
    timers->contact_pairs = found.pairs;
    timers->contact_repulsions = found.repulsions;
    timers->contact_stops = found.stops;
    timers->contact_unresolved = found.unresolved;
    timers->contact_dropped = found.dropped;
    timers->contact_halts = found.halts;
    timers->contact_rounds = found.rounds;
    timers->contact_looks = found.looks;
    timers->contact_find_seconds = found.find_seconds;
    timers->contact_push_seconds = found.push_seconds;
    timers->contact_stop_seconds = found.stop_seconds;
    timers->contact_seconds = found.find_seconds + found.push_seconds + found.stop_seconds;
    sim_log_contacts(sim, &found);
}

/// A stage's context lacks the part of the State that the stage writes.
static SingeResult step_stages(SingeSim *sim) {
    const SingeView view = singe_sim_view(sim);
    const StepContext all = sim_context(sim, &view);
    State *state = &sim->state;
    HeatCounters heat = {0};
    DynamicsCounters dynamics = {0};
    double start = clock_seconds();
    sim->events.count = 0;

    // 1. temperatures from sources, combustion, losses and conduction (eq 1 to 3)
    StepContext context = all;
    context.state.heat = NULL;
    TRY(heat_step(sim->heat, &context, &state->heat, &heat));
    if (heat.unconverged) sim_log_unconverged(sim);
    step_lap(sim, SINGE_STAGE_HEAT, &start);

    // 2. masses of particles above the ignition point, and target lengths (eq 4 to 6)
    context = all;
    context.state.burn = NULL;
    TRY(burn_step(&context, sim->thickening, sim->partial, &sim->air, &state->burn));
    step_lap(sim, SINGE_STAGE_BURN, &start);

    // 3. burnt springs and particles are removed (eq 7)
    context = all;
    context.state.ablate = NULL;
    ablate_step(sim->ablate, &context, &state->ablate);
    step_lap(sim, SINGE_STAGE_ABLATE, &start);

    // 4. positions and velocities (eq 8 to 19)
    context = all;
    context.state.dynamics = NULL;
    TRY(dynamics_step(&sim->memory, sim->dynamics, &context, &state->dynamics, &dynamics));
    step_lap(sim, SINGE_STAGE_DYNAMICS, &start);

    // a frame ended where this step began: surfaces have the displacement since. Nothing can fail from here on
    if (state->step % (uint64_t)sim->def.velocity_steps == 0) state_remember(&sim->shell, state, sim->backup);

    // 5. tears by too large forces; this cannot fail, so no step that tore has to be undone
    if (sim->tear) step_tear(sim, all);
    step_lap(sim, SINGE_STAGE_ABLATE, &start);

    // 6. the gas above the fire; its effect on the sheets begins with the next step
    context = all;
    context.state.gas = NULL;
    if (sim->gas) gas_step(sim->gas, &context, &state->gas);
    step_lap(sim, SINGE_STAGE_GAS, &start);

    step_note(sim, &heat, &dynamics);
    return SINGE_OK;
}

enum { BACKUP_PART = 32768 };

/// Copies parts of the State's basic arena into the backup.
static void step_copy(void *task, int begin, int end) {
    SingeSim *sim = task;
    const size_t size = sim->state.basic_size, first = (size_t)begin * BACKUP_PART, last = (size_t)end * BACKUP_PART;
    memcpy((char *)sim->backup + first, (char *)sim->state.arena + first, (last < size ? last : size) - first);
}

SingeResult sim_step(SingeSim *sim) {
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "step", -1, "singe_sim_commit must come before the first step");

    // colliders where the step begins
    for (uint32_t i = 0; i < sim->colliders.count; i++)
        if (sim->colliders.items[i].generation) collider_at(&sim->colliders.items[i], sim->state.time);
    if (sim->state.step == 0) sim_find_buried(sim);

    pool_set_cancel(sim->pool, sim->def.cancel);

    // a copy for rollback
    State before = sim->state;
    SingeTimers timers = sim->timers;
    pool_for(sim->pool, (int)(sim->state.basic_size / BACKUP_PART) + 1, 1, step_copy, sim);

    // the stages; if one fails, everything is as before
    SingeResult result = step_stages(sim);
    if (result) {
        sim->state = before;
        sim->timers = timers;
        memcpy(sim->state.arena, sim->backup, sim->state.basic_size);
        burn_restore_lengths(&sim->shell, &sim->state.ablate, &sim->state.burn);
        sim->events.count = 0;
        return result;
    }

    // the time of the next step
    sim->state.step++;
    sim->state.time = (double)sim->state.step * (double)sim->def.time_step;
    sim->timers.steps++;
    sim_end_pins(sim);
    if (sim_recorder(sim)) recorder_state(sim_recorder(sim), &sim->shell, &sim->state);

    // with assertions: checks everything that a step may have changed
    shell_assert(&sim->shell, &sim->state);
    SINGE_ASSERT(dynamics_plan_validate(sim->dynamics) == NULL);
    return SINGE_OK;
}

SingeResult call_step(SingeSim *sim) {
    sim->gathers = false;
    return sim_step(sim);
}

// The step, in the order of the paper's section 4, and after it the gas.
#include "common/clock.h"
#include "sim/sim_internal.h"

#include <string.h>


/// Adds the time since *start to a stage and starts the next.
static void step_lap(SingeSim *sim, SingeStage stage, double *start) {
    double now = clock_seconds();
    sim->timers.seconds[stage] += now - *start;
    *start = now;
}

static void step_note_contacts(SingeSim *sim) {
    CollisionCounters found = dynamics_plan_contacts(sim->dynamics);
    SingeTimers *timers = &sim->timers;
    timers->contact_seconds = found.seconds;
    timers->contact_searches = found.searches;
    timers->contact_pairs = found.pairs;
    timers->contact_repulsions = found.repulsions;
    timers->contact_stops = found.stops;
    timers->contact_unresolved = found.unresolved;
    timers->contact_dropped = found.dropped;
    sim_log_contacts(sim, &found);
}

/// What is kept for a vertex beside the State, for its new half.
static void step_share(SingeSim *sim, uint32_t vertex, uint32_t spare) {
    dynamics_plan_torn(sim->dynamics, &sim->shell, &sim->state, vertex, spare);
    if (sim->gas) gas_plan_torn(sim->gas, vertex, spare);
    for (uint32_t i = 0; i < sim->sources.count; i++)
        if (sim->sources.items[i].texture)
            sim->sources.items[i].texture[spare] = sim->sources.items[i].texture[vertex];
}

/// Tears, and what follows from them.
static void step_tear(SingeSim *sim, float h) {
    State *state = &sim->state;
    bool short_of_spares = false;
    const float *pull[SINGE_COLOUR_COUNT];
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        pull[colour] = dynamics_pull(sim->dynamics, (SingeColour)colour);
    for (uint32_t s = 0; s < sim->shell.sheet_count; s++)
        tear_stretched(sim->tear, s, dynamics_stretch(sim->dynamics, s));
    uint32_t tears = tear_step(sim->tear, &sim->shell, state, pull, sim->pool, h, &short_of_spares);
    if (short_of_spares) sim_log_short_of_spares(sim);
    if (tears == 0) return;
    for (uint32_t k = state->tear.split_count - tears; k < state->tear.split_count; k++)
        step_share(sim, state->tear.splits[k].vertex, state->tear.splits[k].spare);
    ablate_torn(sim->ablate, &sim->shell, state, sim->def.ambient_temperature, &state->ablate, &sim->events);
}

static SingeResult step_stages(SingeSim *sim) {
    const Shell *shell = &sim->shell;
    const SingeSimDef *def = &sim->def;
    const SingeView view = singe_sim_view(sim);
    State *state = &sim->state;
    SingeError *error = &sim->error;
    float h = def->time_step;
    double start = clock_seconds();
    sim->events.count = 0;

    // 1. temperatures from sources, combustion, losses and conduction (eq 1 to 3)
    HeatCounters heat = {0};
    TRY(heat_step(sim->heat, shell, state, &sim->sources, &sim->colliders, &view, sim->pool, h, &state->heat, &heat,
                  error));
    if (heat.unconverged) sim_log_unconverged(sim);
    step_lap(sim, SINGE_STAGE_HEAT, &start);

    // 2. masses of what is above the ignition point, and target lengths (eq 4 to 6)
    TRY(burn_step(shell, state, sim->pool, h, def->pace, sim->thickening, sim->partial, &state->burn, &sim->events,
                  error));
    step_lap(sim, SINGE_STAGE_BURN, &start);

    // 3. burnt springs and particles go (eq 7)
    TRY(ablate_step(sim->ablate, shell, state, sim->pool, def->ambient_temperature, &state->ablate, &sim->events,
                    error));
    step_lap(sim, SINGE_STAGE_ABLATE, &start);

    // 4. positions and velocities (eq 8 to 19)
    DynamicsCounters counters = {0};
    TRY(dynamics_step(sim->dynamics, shell, state, &sim->pins, &sim->colliders, &def->wind, sim->pool, h,
                      &state->dynamics, &counters, error));
    step_lap(sim, SINGE_STAGE_DYNAMICS, &start);

    // 5. what was pulled at too hard has torn; as it cannot fail, no step has to be undone that tore
    if (sim->tear) step_tear(sim, h);
    step_lap(sim, SINGE_STAGE_ABLATE, &start);

    // 6. the gas above what burns; what it does to the sheets is felt from the next step on
    if (sim->gas) gas_step(sim->gas, shell, state, &sim->colliders, &def->wind, sim->pool, &state->gas);
    step_lap(sim, SINGE_STAGE_GAS, &start);

    sim->timers.heat_iterations += heat.iterations;
    sim->timers.strands_projected += counters.strands;
    sim->timers.contacts += counters.contacts;
    sim->timers.projection_seconds += counters.seconds;
    sim->timers.springs_projected += counters.springs;
    sim->timers.projection_iterations += counters.iterations;
    sim->timers.projection_flops += counters.flops;
    sim->timers.projection_bytes += counters.bytes;
    step_note_contacts(sim);
    return SINGE_OK;
}

SingeResult singe_sim_step(SingeSim *sim) {
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "step", -1, "singe_sim_commit comes before the first step");
    if (sim->state.step == 0) sim_find_buried(sim);
    State before = sim->state;
    SingeTimers timers = sim->timers;
    memcpy(sim->backup, sim->state.arena, sim->state.basic_size);
    SingeResult result = step_stages(sim);
    if (result) {
        sim->state = before;
        sim->timers = timers;
        memcpy(sim->state.arena, sim->backup, sim->state.basic_size);
        burn_restore_lengths(&sim->shell, &sim->state, &sim->state.burn);
        sim->events.count = 0;
        return result;
    }
    sim->state.step++;
    sim->state.time = (double)sim->state.step * (double)sim->def.time_step;
    sim->timers.steps++;
    return SINGE_OK;
}

#include "sim/snapshot_check.h"

#include <string.h>

// ---- objects

bool snapshot_generations_fit(const SingeSim *sim) {
    uint32_t max = 0;
    for (uint32_t i = 0; i < sim->sources.count; i++)
        if (max < sim->sources.items[i].generation) max = sim->sources.items[i].generation;
    for (uint32_t i = 0; i < sim->colliders.count; i++)
        if (max < sim->colliders.items[i].generation) max = sim->colliders.items[i].generation;
    for (uint32_t i = 0; i < sim->pins.count; i++)
        if (max < sim->pins.items[i].generation) max = sim->pins.items[i].generation;
    return max < sim->next_generation;
}

static bool position_fits(const float *x) { return isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]); }

bool snapshot_pin_fits(const Shell *shell, const Pin *pin) {
    for (uint32_t k = 0; k < pin->count; k++) {
        if (pin->particles[k] >= shell->particle_count || !position_fits(pin->anchors[k])) return false;
        if (k > 0 && pin->particles[k] <= pin->particles[k - 1]) return false;
    }
    return true;
}

bool snapshot_motion_fits(const Motion *motion) {
    if (!isfinite(motion->start) || !isfinite(motion->end) || motion->end < motion->start) return false;
    for (uint32_t i = 0; i < motion->count; i++)
        if (!position_fits(motion->from[i]) || !position_fits(motion->to[i])) return false;
    return true;
}

bool snapshot_remainder_fits(const SingeSim *sim) {
    const double h = (double)sim->def.time_step;
    return isfinite(sim->remainder) && sim->remainder != 0 && fabs(sim->remainder) <= 1e6 + h;
}

// ---- state

static bool double_within(double x, double low, double high) { return x >= low && x <= high; }

/// A possible time of an event: -1 for never.
static bool moment_fits(float moment, double now) {
    return moment == -1 || double_within((double)moment, 0, (float)now);
}

/// Every particle is held by as many pins as its count tells.
static bool pins_fit(SingeSim *sim) {
    uint8_t *held = sim->state.dynamics.pinned;
    bool fits = true;
    for (uint32_t i = 0; i < sim->pins.count; i++)
        for (uint32_t k = 0; k < sim->pins.items[i].count; k++) {
            uint8_t *count = &held[sim->pins.items[i].particles[k]];
            fits = fits && *count > 0;
            *count = (uint8_t)(*count - 1);
        }

    for (uint32_t i = 0; i < sim->shell.particle_count; i++) fits = fits && held[i] == 0;
    for (uint32_t i = 0; i < sim->pins.count; i++)
        for (uint32_t k = 0; k < sim->pins.items[i].count; k++) held[sim->pins.items[i].particles[k]]++;
    for (uint32_t i = 0; i < sim->shell.particle_count; i++)
        fits = fits && (held[i] > 0) == !!(sim->state.ablate.particle_flags[i] & SINGE_PINNED);
    return fits;
}

bool snapshot_state_fits(SingeSim *sim) {
    State *state = &sim->state;
    const Shell *shell = &sim->shell;

    // sums
    const double sums[] = {state->heat.heat_in,    state->heat.heat_lost,      state->heat.heat_of_combustion,
                           state->burn.mass_burnt, state->ablate.heat_removed, state->ablate.mass_removed,
                           sim->heat_start};
    for (size_t k = 0; k < sizeof sums / sizeof *sums; k++)
        if (!isfinite(sums[k])) return false;
    if (!(state->burn.mass_burnt >= 0 && state->ablate.mass_removed >= 0 &&
          state->time == (double)state->step * (double)sim->def.time_step))
        return false;

    // heat and burning
    for (uint32_t i = 0; i < shell->particle_count; i++) {
        float temperature = state->heat.temperature[i], peak = state->heat.temperature_peak[i];
        if (state->heat.water && !(state->heat.water[i] >= 0 && state->heat.water[i] <= HEAT_WATER_MAX)) return false;
        if (!(temperature >= 0 && isfinite(temperature) && peak >= 0 && isfinite(peak))) return false;
        if (!double_within((double)state->burn.mass[i], 0, 1)) return false;
        if (!double_within((double)state->burn.fuel[i], 0, 1)) return false;
        if (!(state->burn.release[i] >= 0 && isfinite(state->burn.release[i]))) return false;
        if (!(state->burn.burn_rate[i] >= 0 && isfinite(state->burn.burn_rate[i]))) return false;
        if (!moment_fits(state->burn.time_ignited[i], state->time)) return false;
        if (!moment_fits(state->burn.time_burnt[i], state->time)) return false;
    }

    // dynamics
    const DynamicsState *dynamics = &state->dynamics;
    if (!double_within(dynamics->earlier_time, 0, state->time)) return false;
    for (uint32_t v = 0; v < shell->vertex_count; v++)
        if (!position_fits(dynamics->earlier[v])) return false;

    for (uint32_t i = 0; i < shell->particle_count; i++) {
        const float *x = dynamics->position[i], *v = dynamics->velocity[i];
        if (!position_fits(x) || !position_fits(v) || !(x[3] >= 0 && isfinite(x[3])) || !isfinite(v[3])) return false;
    }

    for (uint32_t s = 0; dynamics->bend && s < shell->springs[SINGE_GREEN].count; s++)
        if (!isfinite(dynamics->bend[s]) || !isfinite(dynamics->crease[s])) return false;
    for (size_t k = 0; shell->spare_count && k < 6 * (size_t)shell->cell_count; k++)
        if (!isfinite(state->tear.line_force[k / 6][k % 6])) return false;

    // pins and pieces, then lengths, which follow
    if (!pins_fit(sim)) return false;
    if (!ablate_fits(sim->ablate, shell, &state->ablate)) return false;
    burn_restore_lengths(shell, &state->ablate, &state->burn);
    memset(state->dynamics.position + shell->particle_count, 0,
           shell_nowhere_count(shell) * sizeof *state->dynamics.position);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t s = 0; s < shell->springs[colour].count; s++)
            if (!isfinite(state->burn.spring_length[colour][s])) return false;

    return true;
}

// Statistics of the present state. Sums are in double and in order of particle, so that they do not depend on the
// number of threads.
//
// Enthalpy H = sum over the remaining particles of C (T - T_amb), C the heat capacity of the unburnt particle (eq 1
// adds heat to T without regard to the mass left). Removed particles take their enthalpy along; that counts as lost.
// Ledger: heat_in + heat_of_combustion - heat_lost = H - H_start.
#include "common/real.h"
#include "sim/sim_internal.h"

#include <math.h>

double sim_enthalpy(const SingeSim *sim) {
    const Matter *matter = &sim->shell.matter;
    double sum = 0;
    for (uint32_t i = 0; i < sim->shell.particle_count; i++)
        if (sim->state.ablate.particle_flags[i] & SINGE_ALIVE)
            sum += (double)matter->capacity[i] *
                   ((double)sim->state.heat.temperature[i] - (double)sim->def.ambient_temperature);
    return sum;
}

/// The k-th smallest of n values, which are reordered (Hoare's selection).
static float stats_select(float *values, size_t n, size_t k) {
    size_t low = 0, high = n - 1;
    while (low < high) {
        float pivot = values[low + (high - low) / 2];
        size_t i = low, j = high;
        while (i <= j) {
            while (values[i] < pivot) i++;
            while (values[j] > pivot) j--;
            if (i > j) break;
            float swap = values[i];
            values[i++] = values[j];
            values[j] = swap;
            if (j-- == 0) break;
        }

        if (k <= j && j != SIZE_MAX) high = j;
        else if (k >= i) low = i;
        else break;
    }

    return values[k];
}

/// Strain of the mesh's edges: |length/target - 1| of blue springs that are drawn, wholly or in part. Springs between
/// two held particles are left out: nothing in the step can change them.
static void stats_strain(const SingeSim *sim, SingeStats *stats) {
    const SpringSet *blue = &sim->shell.springs[SINGE_BLUE];
    size_t n = 0;
    double sum = 0;
    for (uint32_t k = 0; k < blue->count; k++) {
        if (!(sim->state.ablate.spring_flags[SINGE_BLUE][k] & SINGE_ALIVE)) continue;
        if (sim->state.dynamics.pinned[blue->ends[k][0]] && sim->state.dynamics.pinned[blue->ends[k][1]]) continue;
        if (ablate_level(&sim->shell, &sim->state, blue->ends[k][0]) < 0 &&
            ablate_level(&sim->shell, &sim->state, blue->ends[k][1]) < 0)
            continue;

        // strain of a drawn edge
        Float3 d = float3_sub(float3_load(sim->state.dynamics.position[blue->ends[k][1]]),
                              float3_load(sim->state.dynamics.position[blue->ends[k][0]]));
        float strain = fabsf(float3_length(d) / sim->state.burn.spring_length[SINGE_BLUE][k] - 1);
        sum += (double)strain;
        if ((double)strain > stats->strain_max) stats->strain_max = (double)strain;
        sim->sample[n++] = strain;
    }

    // mean and percentile
    if (n == 0) return;
    stats->strain_mean = sum / (double)n;
    stats->strain_p99 = (double)stats_select(sim->sample, n, (size_t)(0.99 * (double)(n - 1)));
}

/// A front that passes at speed v ignites points a distance d apart d/v after each other.
static double stats_front_speed(const SingeSim *sim) {
    size_t n = 0;
    for (uint32_t c = 0; c < sim->shell.cell_count; c++) {
        const uint32_t *corner = sim->shell.cells[c];
        float time[4];
        bool ignited = true;
        for (int i = 0; i < 4; i++) ignited &= (time[i] = sim->state.burn.time_ignited[corner[i]]) >= 0;
        if (!ignited) continue;

        // |grad t|^2, s2/m2, at the centre of a cell, of a time that is bilinear over its rest shape
        Float3 p[4];
        for (int i = 0; i < 4; i++) p[i] = float3_load(sim->shell.rest_position[corner[i]]);
        Float3 a = float3_scale(float3_sub(float3_add(p[1], p[2]), float3_add(p[0], p[3])), 0.5f);
        Float3 b = float3_scale(float3_sub(float3_add(p[2], p[3]), float3_add(p[0], p[1])), 0.5f);
        float ta = 0.5f * (time[1] + time[2] - time[0] - time[3]), tb = 0.5f * (time[2] + time[3] - time[0] - time[1]);
        float aa = float3_dot(a, a), ab = float3_dot(a, b), bb = float3_dot(b, b), area2 = aa * bb - ab * ab;
        float slope2 = area2 > 0 ? (bb * ta * ta - 2 * ab * ta * tb + aa * tb * tb) / area2 : 0;
        if (slope2 > 0) sim->sample[n++] = 1 / (sqrtf(slope2) * sim->def.pace);
    }

    return n ? (double)stats_select(sim->sample, n, n / 2) : 0;
}

/// How well the fire has kept to the arrival maps.
static void stats_arrival(const SingeSim *sim, SingeStats *stats) {
    const float *ignited = sim->state.burn.time_ignited;
    const uint8_t *flags = sim->state.ablate.particle_flags;
    size_t n = 0;
    for (uint32_t k = 0; k < sim->sources.count; k++) {
        const Source *source = &sim->sources.items[k];
        if (!source_is_lit(source, sim->state.time) || source->def.kind != SINGE_SOURCE_ARRIVAL) continue;

        for (uint32_t i = 0; i < sim->shell.particle_count; i++) {
            if (source->texture[i] == SOURCE_UNMAPPED || (ignited[i] < 0 && !(flags[i] & SINGE_ALIVE))) continue;
            const double due = source_arrival(source, i), h = (double)sim->def.time_step;
            if (ignited[i] < 0) stats->arrival_missed += due + 1.5 * h < sim->state.time;
            else if (isinf(due)) stats->arrival_missed++;
            else if (n < sim->shell.springs[SINGE_BLUE].count) sim->sample[n++] = (float)fabs((double)ignited[i] - due);
        }
    }
    if (n) stats->arrival_error = (double)stats_select(sim->sample, n, (size_t)(0.95 * (double)(n - 1)));
}

/// Cells with the centre on the wrong side. A cell of no area has no side.
static uint32_t stats_inverted(const SingeSim *sim) {
    const float(*x)[4] = (const float(*)[4])sim->state.dynamics.position;
    uint32_t inverted = 0;
    for (uint32_t c = 0; c < sim->shell.cell_count; c++) {
        if (!(sim->state.ablate.cell_flags[c] & SINGE_ALIVE)) continue;
        const uint32_t *corner = sim->shell.cells[c];
        Float3 p[4], mean = {0, 0, 0};
        for (int i = 0; i < 4; i++) p[i] = float3_load(x[corner[i]]), mean = float3_mad(mean, p[i], 0.25f);
        Float3 normal = float3_cross(float3_sub(p[2], p[0]), float3_sub(p[3], p[1]));
        float above = float3_dot(normal, float3_sub(float3_load(x[shell_centre(&sim->shell, c)]), mean));
        inverted += !(above > 0) && !(float3_dot(normal, normal) == 0);
    }

    return inverted;
}

static void stats_ledgers(const SingeSim *sim, SingeStats *stats) {
    const State *state = &sim->state;
    stats->mass_burnt = state->burn.mass_burnt;
    stats->mass_removed = state->ablate.mass_removed;
    stats->burnt_fraction =
        stats->mass_initial > 0 ? (stats->mass_burnt + stats->mass_removed) / stats->mass_initial : 0;
    double missing = stats->mass_initial - stats->mass - stats->mass_burnt - stats->mass_removed;
    stats->mass_ledger_error = stats->mass_initial > 0 ? fabs(missing) / stats->mass_initial : 0;

    stats->heat_in = state->heat.heat_in;
    stats->heat_of_combustion = state->heat.heat_of_combustion;
    stats->heat_lost = state->heat.heat_lost + state->ablate.heat_removed;
    stats->heat_stored = sim_enthalpy(sim) - sim->heat_start;
    double max = double_max(double_max(fabs(stats->heat_in), fabs(stats->heat_of_combustion)),
                            double_max(fabs(stats->heat_lost), fabs(stats->heat_stored)));
    double error = stats->heat_in + stats->heat_of_combustion - stats->heat_lost - stats->heat_stored;
    stats->ledger_error = max > 0 ? fabs(error) / max : 0;
    stats->ledgers_close = stats->ledger_error <= SINGE_LEDGER_BOUND && stats->mass_ledger_error <= SINGE_LEDGER_BOUND;
}

static double stats_square(Float3 v) { return (double)float3_dot(v, v); }

void singe_sim_read_stats(const SingeSim *sim, SingeStats *out, size_t struct_size) {
    const Shell *shell = &sim->shell;
    const State *state = &sim->state;
    const Matter *matter = &shell->matter;
    SingeStats stats = {.time = state->time, .pieces = state->ablate.piece_count};
    if (!sim->committed) {
        sim_write_result(out, struct_size, &stats, sizeof stats);
        return;
    }

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t k = 0; k < shell->springs[colour].count; k++)
            stats.springs += state->ablate.spring_flags[colour][k] & SINGE_ALIVE;
    for (uint32_t c = 0; c < shell->cell_count; c++) stats.cells += state->ablate.cell_flags[c] & SINGE_ALIVE;

    // particles. The energy of weight is 0 where a particle was at rest: mass that leaves there takes none along
    double square = 0, moving = 0, energy = 0;
    for (uint32_t i = 0; i < sim->shell.particle_count; i++) {
        stats.mass_initial += (double)matter->mass[i];
        const float *first = shell->sheets[matter->sheet[i]].velocity;
        energy += 0.5 * (double)matter->mass[i] * stats_square(float3_load(first));
        if (!(state->ablate.particle_flags[i] & SINGE_ALIVE)) continue;

        stats.particles++;
        stats.mass += (double)matter->mass[i] * (double)state->burn.mass[i];
        if (state->heat.water) stats.water += (double)matter->mass[i] * (double)state->heat.water[i];
        stats.temperature_max = float_max(stats.temperature_max, state->heat.temperature[i]);

        const double mass = (double)matter->mass[i] * (double)state->burn.mass[i],
                     speed2 = stats_square(float3_load(state->dynamics.velocity[i]));
        stats.energy_kinetic += 0.5 * mass * speed2;
        for (int k = 0; k < 3; k++) {
            const double up = (double)state->dynamics.position[i][k] - (double)shell->rest_position[i][k];
            stats.energy_gravity -= mass * (double)sim->def.gravity[k] * up;
        }

        if (state->burn.time_ignited[i] >= 0 || state->dynamics.pinned[i]) continue;
        square += speed2;
        moving++;
    }

    stats.speed_rms_unburnt = moving > 0 ? sqrt(square / moving) : 0;
    stats.energy_elastic = dynamics_elastic_energy(sim->dynamics, shell, state);
    stats.energy_lost = energy - stats.energy_kinetic - stats.energy_elastic - stats.energy_gravity;

    // what is summed over the run or the springs
    stats_ledgers(sim, &stats);
    stats_strain(sim, &stats);
    stats.inverted_cells = stats_inverted(sim);
    stats.intersecting_cells = dynamics_plan_contacts(sim->dynamics).intersecting;
    stats.tears = state->tear.split_count;
    stats.front_speed = stats_front_speed(sim);
    stats_arrival(sim, &stats);
    stats.pace = sim->def.pace;
    for (uint32_t s = 0; s < shell->sheet_count; s++)
        stats.thickening = float_max(stats.thickening, sim->thickening[s]);
    sim_write_result(out, struct_size, &stats, sizeof stats);
}

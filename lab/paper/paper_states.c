#include "paper/paper_states.h"

#include "bench/hung_sheet.h"

#include <math.h>
#include <stdlib.h>

const char *const paper_state_names[PAPER_STATE_COUNT] = {[PAPER_SWING] = "swing", [PAPER_SHRINK] = "shrink"};

static const float grammage = 0.1f; // kg/m2

static SingeResult state_build(SingeSim *sim, PaperState state, int n) {
    SingeSheetId sheet;
    SingeSheetDef def = singe_default_sheet();
    def.material.grammage = singe_param(grammage);
    def.material.reference_grammage = 0; // rates are those of eq 4
    def.material.thickness = singe_param(1e-3f);
    def.material.drag = def.material.damping = singe_param(0);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) def.material.compliance[c] = singe_param(0); // eq 16 has none

    if (state == PAPER_SHRINK) {
        // burns at one rate, down to 0.8 of its mass in half a second; lengths follow the mass, and nothing is removed
        const float rate = 4e-3f; // 1/(K s), at 100 K above ignition
        def.material.temperature = singe_param(600);
        def.material.ignition_temperature = singe_param(500);
        def.material.mass_rate = singe_param(rate);
        def.material.rate_ceiling = singe_param(1e6f);
        def.material.air_supply = singe_param(INFINITY);
        def.material.ash_exponent = singe_param(0);
        def.material.heat_share = singe_param(0);
        def.material.mass_min = singe_param(0.8f);
        def.material.mass_loss = singe_param(0.1f);
        def.material.char_yield = singe_param(0);
        def.material.ash_density = singe_param(1);
        def.material.char_weight = singe_param(1);
        def.material.shrink_front = def.material.shrink_back = def.material.fibre_shrink = singe_param(1);
        def.material.convection = def.material.emissivity = singe_param(0);
        def.material.thickening = 1;
    }

    SingeResult result = sheet_add(sim, &def, n, 1, false, &sheet);
    if (!result) result = singe_sim_commit(sim);
    if (result || state != PAPER_SWING) return result;

    SingePinDef pin = singe_default_pin();
    const uint32_t corners[] = {0, (uint32_t)n};
    SingePinId id;

    pin.sheet = sheet;
    pin.vertex_count = 2;
    pin.vertices = corners;
    return singe_sim_add_pin(sim, &pin, &id);
}

SingeResult paper_sim(PaperState state, int cells, const SingeSolverDef *solver, int threads, SingeSim **sim,
                      SingeError *error) {
    SingeSimDef def = singe_default_sim();
    def.solver = *solver;
    def.time_step = PAPER_TIME_STEP;
    def.thread_count = threads;
    def.air_density = 0;
    if (state == PAPER_SHRINK) def.gravity[2] = 0;

    TRY(singe_sim_create(&def, sim, error));
    SingeResult result = state_build(*sim, state, cells);
    return result ? bench_give_up(sim, result, error) : SINGE_OK;
}

SingeResult paper_network(const SingeSim *sim, PaperState state, bool one_set, double regularisation, int cap,
                          SingeNetwork **network, SingeError *error) {
    SingeView view = singe_sim_view(sim);
    SingeNetworkDef def = singe_default_network();
    uint32_t springs = 0;

    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) springs += view.spring_count[c];
    double *positions = malloc(3 * view.particle_count * sizeof *positions);
    double *inverse_masses = malloc(view.particle_count * sizeof *inverse_masses);
    double *lengths = malloc(springs * sizeof *lengths);
    uint32_t(*ends)[2] = malloc(springs * sizeof *ends), *sets = malloc(springs * sizeof *sets);
    SingeResult result = SINGE_ERROR_MEMORY;

    *network = NULL;
    if (positions && inverse_masses && lengths && ends && sets) {
        // the particles' positions and masses after eq 8 and 9
        double h = (double)PAPER_TIME_STEP, g = state == PAPER_SWING ? -9.81 : 0;
        for (uint32_t i = 0; i < view.particle_count; i++) {
            bool held = view.particle_flags[i] & SINGE_PINNED;
            inverse_masses[i] = held ? 0 : 2 / ((double)grammage * (double)view.area[i] * (double)view.mass[i]);
            for (int c = 0; c < 3; c++) {
                double v = held ? 0 : (double)view.velocity[i][c] + (c == 2 ? h * g : 0);
                positions[3 * i + (uint32_t)c] = (double)view.position[i][c] + h * v;
            }
        }

        for (uint32_t c = 0, k = 0; c < SINGE_COLOUR_COUNT; c++)
            for (uint32_t i = 0; i < view.spring_count[c]; i++, k++) {
                ends[k][0] = view.springs[c][i][0];
                ends[k][1] = view.springs[c][i][1];
                lengths[k] = (double)view.spring_length[c][i];
                sets[k] = one_set ? 0 : c;
            }

        def.particle_count = view.particle_count;
        def.positions = positions;
        def.inverse_masses = inverse_masses;
        def.spring_count = springs;
        def.ends = ends[0];
        def.lengths = lengths;
        def.set_count = one_set ? 1 : SINGE_COLOUR_COUNT;
        def.sets = sets;
        def.regularisation = regularisation;
        if (one_set || cap > 0) def.iterations = one_set ? (int)springs : cap;
        result = singe_network_create(&def, network, error);
    } else {
        *error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1};
    }

    free(positions), free(inverse_masses), free(lengths), free(ends), free(sets);
    return result;
}

double paper_errors(const SingeNetwork *network, uint32_t sets, double *errors) {
    double sum = 0;
    for (uint32_t s = 0; s < sets; s++) sum += errors[s] = singe_network_errors(network, s, NULL);
    return sum;
}

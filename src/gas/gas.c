// One step of the gas:
//
//   carry    lightness, fuel, smoke and momentum move with the flow (advect.c)
//   feed     the gas that left the sheets since the last step enters as fuel (gas_sheets.c)
//   burn     fuel burns as air mixes with it; it heats and makes smoke (flame.c)
//   meet     sheets are heated, and cool the gas; their air is reported to the dynamics (gas_sheets.c)
//   force    buoyancy, swirl (force.c)
//   project  a pressure makes the flow's divergence that of the expansion, past sheets and colliders (project.c)
#include "common/assertion.h"
#include "gas/gas_plan.h"

#include <string.h>

#include "world/wind.h"

/// If all cells are below these, the gas is at rest: a kelvin, and invisible smoke.
static const float REST_LIGHTNESS = 3e-3f, REST_FUEL = 100, REST_SMOKE = 2e-6f;

void gas_planes(const GasPass *pass, const GasGrid *grid, SingeTaskFn *run) {
    // a range for a thread has at least about a thousand cells
    int plane = grid->n[0] * grid->n[1], grain = 1 + 1024 / (plane + 1);
    pool_for(pass->pool, grid->n[2], grain, run, (void *)(uintptr_t)pass);
}

/// Records for each plane whether any gas in it is not at rest.
static void gas_look(void *context, int begin, int end) {
    const GasPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    const GasGrid *grid = &pass->plan->grid;
    for (int k = begin; k < end; k++) {
        const float *L = pass->to->field[GAS_LIGHTNESS], *fuel = pass->to->field[GAS_FUEL],
                    *smoke = pass->to->field[GAS_SMOKE];
        int left = 0;
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            for (int i = 0; i < grid->n[0]; i++)
                left |= (L[c + (size_t)i] > REST_LIGHTNESS) | (fuel[c + (size_t)i] > REST_FUEL) |
                        (smoke[c + (size_t)i] > REST_SMOKE);
        }
        pass->plan->hot[k] = left;
    }
}

static bool gas_is_over(GasPass *pass) {
    int left = 0;
    gas_planes(pass, &pass->plan->grid, gas_look);
    for (int k = 0; k < pass->plan->grid.n[2]; k++) left |= pass->plan->hot[k];
    return !left;
}

/// Sets a turn to rest; its fuel stays.
static void gas_calm(const GasPlan *plan, GasTurn *turn) {
    for (int f = 0; f < GAS_FIELDS; f++) memset(turn->field[f], 0, plan->grid.cells * sizeof(float));
    memset(turn->conductance, 0, plan->particles * sizeof(float));
    memset(turn->air, 0, plan->particles * sizeof *turn->air);
}

static void gas_turn_over(const GasPlan *plan, GasPass *pass, GasState *gas) {
    gas->turn = !gas->turn;
    const GasTurn *turn = &plan->turn[gas->turn];
    gas->conductance = turn->conductance;
    gas->temperature = turn->temperature;
    gas->fuel = turn->fuel;
    gas->air = (const float(*)[4])turn->air;
    gas->warm = false;
    for (uint32_t i = 0; i < plan->particles && !gas->warm; i++) gas->warm = turn->conductance[i] > 0;
    pass->from = turn;
    pass->to = (GasTurn *)(uintptr_t)&plan->turn[!gas->turn];
    gas->steps++;
}

static void gas_part(GasPass *pass) {
    gas_advect(pass);
    gas_feed(pass);
    gas_burn(pass);
    gas_meet(pass);
    gas_force(pass);
    gas_project(pass);
}

void gas_step(GasPlan *plan, const StepContext *context, GasState *gas) {
    const StateInput *state = &context->state;
    if ((state->step + 1) % plan->every != 0) return;
    GasPass pass = {.plan = plan,
                    .shell = context->shell,
                    .state = state,
                    .colliders = context->colliders,
                    .pool = context->pool,
                    .from = &plan->turn[gas->turn],
                    .to = &plan->turn[!gas->turn],
                    .dt = plan->dt};
    pass.fire = plan->dt * (float)plan->parts * plan->settings.pace;

    // nothing burns and nothing moves: no step
    if (!gas_fed(&pass) && !gas->awake) return;

    // wind, normals of the sheets, faces that they block
    Float3 centre = float3_load(plan->origin);
    for (int d = 0; d < 3; d++) (&centre.x)[d] += 0.5f * plan->cell * (float)plan->grid.n[d];
    float3_store(pass.wind, wind_velocity(context->wind, centre, state->time));
    gas_normals(&pass);
    gas_blocked(&pass);

    // parts of the step
    gas->awake = true;
    for (int part = 0; part < plan->parts; part++) {
        gas_part(&pass);
        if (part + 1 == plan->parts && gas_is_over(&pass)) {
            gas_calm(plan, pass.to);
            gas->awake = false;
        }
        gas_turn_over(plan, &pass, gas);
    }
    gas_show(&pass, pass.from);
}

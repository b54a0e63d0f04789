// One step of the gas:
//
//   carry    lightness, fuel, smoke and momentum move with the flow (advect.c)
//   feed     the gas that left the sheets since the last step enters as fuel (gas_sheets.c)
//   burn     fuel burns as air mixes with it; it heats and makes smoke (flame.c)
//   meet     sheets are heated, and cool the gas; their air is reported to the dynamics (gas_sheets.c)
//   force    buoyancy, and the unrest of the air (force.c)
//   project  a pressure makes the flow's divergence that of the expansion, past sheets and colliders (project.c)
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

/// Whether any gas is left at the end of a step. If not, it comes to rest; fuel that the sheets still hold stays.
static bool gas_is_left(const GasPass *pass) {
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    GasTurn *to = pass->to;
    int left = 0;

    gas_planes(pass, grid, gas_look);
    for (int k = 0; k < grid->n[2]; k++) left |= plan->hot[k];
    if (left) return true;

    for (int f = 0; f < GAS_FIELDS; f++) memset(to->field[f], 0, grid->cells * sizeof(float));
    memset(to->conductance, 0, plan->particles * sizeof(float));
    memset(to->air, 0, plan->particles * sizeof *to->air);
    return false;
}

void gas_step(GasPlan *plan, const StepContext *context, GasState *gas) {
    const StateInput *state = &context->state;
    const GasGrid *grid = &plan->grid;

    if ((state->step + 1) % plan->every != 0) return;

    GasPass pass = {.plan = plan,
                    .shell = context->shell,
                    .state = state,
                    .colliders = context->colliders,
                    .sources = context->sources,
                    .pool = context->pool,
                    .from = &plan->turn[gas->turn],
                    .to = &plan->turn[!gas->turn],
                    .dt = plan->dt};
    pass.fire = plan->dt * (float)plan->parts * plan->settings.pace;

    // the state points at the current set of fields, also after a step that was rolled back
    SINGE_ASSERT(gas->conductance == pass.from->conductance && gas->fuel == pass.from->fuel);

    // nothing burns and nothing moves: no step
    if (!gas_fed(&pass) && !gas->awake) return;

    // wind, normals of the sheets, faces that they block
    Float3 centre = float3_load(plan->origin);
    for (int d = 0; d < 3; d++) (&centre.x)[d] += 0.5f * plan->cell * (float)grid->n[d];
    float3_store(pass.wind, wind_velocity(context->wind, centre, state->time));
    gas_normals(&pass);
    gas_blocked(&pass);

    for (int part = 0; part < plan->parts; part++) {
        gas_advect(&pass);
        gas_feed(&pass);
        gas_burn(&pass);
        gas_meet(&pass);
        gas_force(&pass);
        gas_project(&pass);

        gas->awake = part + 1 < plan->parts || gas_is_left(&pass);

        // the new set of fields becomes the current one
        gas->turn = !gas->turn;
        gas_plan_expose(plan, gas);
        gas->warm = false;
        for (uint32_t i = 0; i < plan->particles && !gas->warm; i++) gas->warm = gas->conductance[i] > 0;
        pass.from = &plan->turn[gas->turn];
        pass.to = &plan->turn[!gas->turn];
        gas->steps++;
    }

    gas_show(&pass, pass.from);
}

// The view for readers: the cells without their ghosts, in the units of SingeGas.

typedef struct Show {
    const GasPass *pass;
    const GasTurn *turn;
} Show;

static void show_planes(void *context, int begin, int end) {
    const Show *show = context;
    const GasPlan *plan = show->pass->plan;
    const GasGrid *grid = &plan->grid;

    float *const *field = show->turn->field, ambient = plan->settings.ambient_temperature;
    const float *wind = show->pass->wind;
    size_t at = (size_t)begin * (size_t)grid->n[0] * (size_t)grid->n[1];

    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            for (int i = 0; i < grid->n[0]; i++, c++, at++) {
                plan->view[0][at] = ambient / (1 - field[GAS_LIGHTNESS][c]);
                plan->view[1][at] = field[GAS_SMOKE][c];
                plan->view[2][at] = field[GAS_FLAME][c];
                for (int d = 0; d < 3; d++) plan->view_velocity[at][d] = field[GAS_VELOCITY + d][c] + wind[d];
            }
        }
}

void gas_show(GasPass *pass, const GasTurn *turn) {
    Show show = {pass, turn};
    pool_for(pass->pool, pass->plan->grid.n[2], 4, show_planes, &show);
}

SingeGas gas_view(const GasPlan *plan) {
    const int *n = plan->grid.n;
    return (SingeGas){.size = {(uint32_t)n[0], (uint32_t)n[1], (uint32_t)n[2]},
                      .origin = {plan->origin[0], plan->origin[1], plan->origin[2]},
                      .cell = plan->cell,
                      .temperature = plan->view[0],
                      .smoke = plan->view[1],
                      .flame = plan->view[2],
                      .velocity = (const float(*)[3])plan->view_velocity};
}

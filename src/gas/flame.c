// Fuel burns as air mixes with it. Where the gas is as hot as a flame, all of its air is used up:
//
//   dE/dt = -(E/tau) (1 - L/L_f)+,   dL/dt = -dE/dt/GAS_HEAT
//
// E fuel J/m3, tau the time in which air and fuel mix, L_f = 1 - Ta/T_f of the hottest flame. L never exceeds L_f. So
// fuel that enters hot gas burns further up, where it has met cooler air: flames stand above their fuel. Smoke grows
// with the burnt fuel, and thins in the time in which it spreads finer than the grid.
#include "gas/gas_plan.h"

static const float FLAME_TIME = 0.01f, SMOKE_TIME = 4;
static const float FLAME_FUEL_HEAT = 13e6f; ///< J/kg for the smoke: of the gas of paper and cotton
static const float FLAME_FUEL_MIN = 1, FLAME_LIGHTNESS_MIN = 1e-4f, FLAME_SMOKE_MIN = 1e-7f;

static void flame_planes(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const SingeGasDef *def = &plan->settings.def;
    float max = 1 - plan->settings.ambient_temperature / GAS_HOTTEST;
    max = max > 0.01f ? max : 0.01f;
    float rate = pass->dt / FLAME_TIME, thin = 1 / (1 + pass->dt / SMOKE_TIME);
    float shown = 1 / (pass->dt * (1 - def->radiated));
    float sooty = def->soot / (FLAME_FUEL_HEAT * (1 - def->radiated));
    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            float *restrict L = pass->to->field[GAS_LIGHTNESS] + c, *restrict fuel = pass->to->field[GAS_FUEL] + c;
            float *restrict smoke = pass->to->field[GAS_SMOKE] + c, *restrict flame = pass->to->field[GAS_FLAME] + c;
            float *restrict expansion = plan->expansion + c;
            for (int i = 0; i < grid->n[0]; i++) {
                float air = 1 - L[i] / max;
                air = air > 0 ? air : 0;
                float step = rate * air, burnt = fuel[i] * step / (1 + step), room = (max - L[i]) * GAS_HEAT;
                room = room > 0 ? room : 0;
                burnt = burnt < room ? burnt : room;
                fuel[i] -= burnt;
                L[i] += burnt / GAS_HEAT;
                expansion[i] = burnt / GAS_HEAT;
                flame[i] = burnt * shown;
                smoke[i] = (smoke[i] + burnt * sooty) * thin;

                // flush small values to 0: denormal numbers are slow
                fuel[i] = fuel[i] > FLAME_FUEL_MIN ? fuel[i] : 0;
                L[i] = L[i] > FLAME_LIGHTNESS_MIN ? L[i] < GAS_LIGHTEST ? L[i] : GAS_LIGHTEST : 0;
                smoke[i] = smoke[i] > FLAME_SMOKE_MIN ? smoke[i] : 0;
            }
        }
}

void gas_burn(GasPass *pass) { gas_planes(pass, &pass->plan->grid, flame_planes); }

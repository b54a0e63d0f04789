// Buoyancy, of gas that is lighter than the air about it by (rho_a - rho)/rho = L/(1 - L):
//
//   du/dt = -g L/(1 - L)
//
// and the unrest that the air of a room has and cells do not resolve: a horizontal noise, in proportion to the
// buoyancy, that makes flames lick and plumes sway:
//
//   du/dt = FORCE_UNREST |g| L/(1 - L) (2 noise(x/size, t/time) - 1)
//
// Air that sources move carries the gas along within FORCE_CELLS cells of its own way:
//
//   du/dt = |v|/(FORCE_CELLS cell) (v - u)
#include "gas/gas_plan.h"

#include "common/random.h"
#include "common/real.h"
#include "world/air.h"

static const float FORCE_UNREST = 0.6f, FORCE_SIZE = 0.02f, FORCE_TIME = 0.08f; ///< -, m, s
static const float FORCE_LIGHT = 0.02f;                                         ///< L above which there is any

static void force_planes(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    Float3 g = float3_load(plan->settings.gravity), up = float3_unit(g);
    float step = plan->cell / FORCE_SIZE;

    // time runs along its own diagonal, as for the wind's gusts
    float t = (float)(pass->state->time / (double)FORCE_TIME);

    for (int d = 0; d < 3; d++) {
        float lift = -plan->settings.gravity[d] * pass->dt, along = d == 0 ? up.x : d == 1 ? up.y : up.z;
        float unrest = FORCE_UNREST * float3_length(g) * (1 - fabsf(along)) * pass->dt;
        for (int k = begin; k < end; k++)
            for (int j = 0; j < grid->n[1]; j++) {
                size_t c = gas_at(grid, 0, j, k);
                const float *restrict L = pass->to->field[GAS_LIGHTNESS] + c;
                float *restrict u = pass->to->field[GAS_VELOCITY + d] + c;
                for (int i = 0; lift != 0 && i < grid->n[0]; i++) u[i] += lift * L[i] / (1 - L[i]);
                for (int i = 0; unrest > 0 && i < grid->n[0]; i++) {
                    if (!(L[i] > FORCE_LIGHT)) continue;
                    float noise = random_noise((float)i * step + 0.3f * t, (float)j * step + 0.4f * t,
                                               (float)k * step + t, (uint32_t)d);
                    u[i] += unrest * L[i] / (1 - L[i]) * (2 * noise - 1);
                }
            }
    }
}

static const float FORCE_CELLS = 3;

static void air_planes(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const Float3 origin = float3_load(plan->origin);
    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++)
            for (int i = 0; i < grid->n[0]; i++) {
                const size_t c = gas_at(grid, i, j, k);
                const Float3 at = {(float)i + 0.5f, (float)j + 0.5f, (float)k + 0.5f};
                const Float3 v = air_velocity(pass->sources, float3_mad(origin, at, plan->cell), pass->state->time);
                const float rate = float3_length(v) / (FORCE_CELLS * plan->cell);
                const float share = -real_expm1f(-rate * pass->dt), to[3] = {v.x, v.y, v.z};
                for (int d = 0; d < 3 && !plan->solid[c]; d++) {
                    float *u = &pass->to->field[GAS_VELOCITY + d][c];
                    *u += share * (to[d] - *u);
                }
            }
}

void gas_force(GasPass *pass) {
    gas_planes(pass, &pass->plan->grid, force_planes);
    if (air_of(pass->sources, pass->state->time)) gas_planes(pass, &pass->plan->grid, air_planes);
}

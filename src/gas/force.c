// Buoyancy, of gas that is lighter than the air about it by (rho_a - rho)/rho = L/(1 - L):
//
//   du/dt = -g L/(1 - L)
#include "gas/plan.h"

static void force_planes(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    for (int d = 0; d < 3; d++) {
        float lift = -plan->settings.gravity[d] * pass->dt;
        for (int k = begin; k < end && lift != 0; k++)
            for (int j = 0; j < grid->n[1]; j++) {
                size_t c = gas_at(grid, 0, j, k);
                const float *restrict L = pass->to->field[GAS_LIGHTNESS] + c;
                float *restrict u = pass->to->field[GAS_VELOCITY + d] + c;
                for (int i = 0; i < grid->n[0]; i++) u[i] += lift * L[i] / (1 - L[i]);
            }
    }
}

void gas_force(GasPass *pass) { gas_planes(pass, &pass->plan->grid, force_planes); }

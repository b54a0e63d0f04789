// The view for readers: the cells without their ghosts, in the units of SingeGas.
#include "common/assertion.h"
#include "gas/gas_plan.h"

typedef struct Show {
    const GasPass *pass;
    const GasTurn *turn;
} Show;

static void show_planes(void *context, int begin, int end) {
    const Show *show = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
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

// The loops over cells of advect.c, which has the formulas. One file per instruction set defines SWEEP_ROWS, the name
// of its function, and includes this. Every operation rounds according to IEEE 754, so all give the same bytes.
#include "gas/advect_axis.h"

/// Fluxes through the lower faces of `count` cells in a row from c on.
static void sweep_faces(const Sweep *sweep, size_t c, int count, float *restrict flux) {
    const GasPass *pass = sweep->pass;
    const size_t beyond = pass->plan->grid.stride[sweep->axis];
    const float *restrict through = pass->from->field[GAS_THROUGH + sweep->axis] + c;
    const float *restrict open = pass->plan->open[sweep->axis] + c;
    const float wind = pass->wind[sweep->axis], courant = pass->courant;
    const float *restrict mixing = pass->plan->mixing + c, *restrict below = mixing - beyond;
    const float *restrict q = sweep->from + c, *restrict low = q - beyond, *restrict lowest = low - beyond,
                          *restrict high = q + beyond;
    for (int i = 0; i < count; i++) {
        float displacement = (through[i] + wind) * courant, size = fabsf(displacement);
        float q0 = lowest[i], q1 = low[i], q2 = q[i], q3 = high[i]; // read before selection: this vectorises
        float b = q2 - q1, before = q1 - q0, behind = q3 - q2, a = displacement > 0 ? before : behind;
        float up = displacement > 0 ? q1 : q2, side = displacement > 0 ? 1.f : -1.f;
        float centre = 0.25f * fabsf(a + b), min = fabsf(a) < fabsf(b) ? fabsf(a) : fabsf(b);
        float slope = a * b > 0 ? centre < min ? centre : min : 0, turn = b > 0 ? side : -side;
        flux[i] = displacement * (up + turn * (1 - size) * slope) - (mixing[i] + below[i]) * open[i] * b;
    }
}

/// New values of a row from the fluxes through its faces.
static void sweep_update(const Sweep *sweep, size_t c, int count, const float *restrict lower,
                         const float *restrict upper) {
    const GasPass *pass = sweep->pass;
    const float *restrict from = sweep->from + c, *restrict start = sweep->start + c;
    const float *restrict u = pass->from->field[GAS_THROUGH + sweep->axis] + c;
    const float *restrict v = u + pass->plan->grid.stride[sweep->axis];
    float *restrict to = sweep->to + c, courant = pass->courant;
    for (int i = 0; i < count; i++) to[i] = from[i] - (upper[i] - lower[i]) + start[i] * courant * (v[i] - u[i]);
}

void SWEEP_ROWS(const Sweep *sweep, int task, int first, int count) {
    const GasGrid *grid = &sweep->pass->plan->grid;
    const GasBox *box = sweep->box;
    int other = sweep->across == 1 ? 2 : 1, at[3] = {first, 0, 0};
    float flux[2][SWEEP_RUN + 1];
    at[sweep->across] = task;
    for (int r = box->low[other]; r < box->high[other]; r++) {
        at[other] = r;
        size_t c = gas_at(grid, at[0], at[1], at[2]);
        if (sweep->axis == 0) {
            sweep_faces(sweep, c, count + 1, flux[0]);
            sweep_update(sweep, c, count, flux[0], flux[0] + 1);
        } else {
            if (r == box->low[other]) sweep_faces(sweep, c, count, flux[r % 2]);
            sweep_faces(sweep, c + grid->stride[sweep->axis], count, flux[(r + 1) % 2]);
            sweep_update(sweep, c, count, flux[r % 2], flux[(r + 1) % 2]);
        }

        // subtract q0 sum(c_upper - c_lower)
        if (sweep->last) {
            const GasPass *pass = sweep->pass;
            const float *restrict start = sweep->start + c;
            const size_t *s = pass->plan->grid.stride;
            const float *restrict x = pass->from->field[GAS_THROUGH] + c, *restrict x1 = x + 1;
            const float *restrict y = pass->from->field[GAS_THROUGH + 1] + c, *restrict y1 = y + s[1];
            const float *restrict z = pass->from->field[GAS_THROUGH + 2] + c, *restrict z1 = z + s[2];
            float *restrict to = sweep->to + c, courant = pass->courant;
            for (int i = 0; i < count; i++) {
                float spread = (x1[i] - x[i]) + (y1[i] - y[i]) + (z1[i] - z[i]);
                to[i] -= start[i] * courant * spread;
            }
        }
    }
}

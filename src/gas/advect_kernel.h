// The loops over cells of advect.c, which has the formulas. One file per instruction set defines SWEEP_ROWS, the name
// of its function, and includes this. Every operation rounds according to IEEE 754, so all give the same bytes.
#include "gas/advect_axis.h"

/// Fluxes through the lower faces of `count` cells in a row from c on, and of some more, so that no lane is left over.
static void sweep_faces(const Sweep *sweep, size_t c, int count, float *restrict flux) {
    count = (count + SWEEP_LANES - 1) / SWEEP_LANES * SWEEP_LANES;
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

/// The columns from `first` on of a row that may change. A cell stays +0, to the last bit, where the two before it along
/// the axis and the two after it are +0 as well.
static inline GasRange sweep_range(const Sweep *sweep, int j, int k, int first, int count) {
    const GasGrid *grid = &sweep->pass->plan->grid;
    const size_t row = gas_row(grid, j, k), beyond = sweep->beyond;
    GasRange range = sweep->busy[row];
    for (int d = 0; d < 2 * GAS_GHOSTS + 1; d++) {
        const GasRange *other = &sweep->busy[row - GAS_GHOSTS * beyond + (size_t)d * beyond];
        range.low = other->low < range.low ? other->low : range.low;
        range.high = other->high > range.high ? other->high : range.high;
    }
    range.low -= beyond ? 0 : GAS_GHOSTS;
    range.high += beyond ? 0 : GAS_GHOSTS;
    sweep->busy_after[row] = range;

    if (range.low < first) range.low = first;
    if (range.low < range.high) range.high += (range.low - range.high) & (SWEEP_LANES - 1); // few lanes are left over
    if (range.high > first + count) range.high = first + count;
    return range;
}

void SWEEP_ROWS(const Sweep *sweep, int task, int first, int columns) {
    const GasGrid *grid = &sweep->pass->plan->grid;
    const GasBox *box = sweep->box;
    int other = sweep->across == 1 ? 2 : 1, at[3] = {0, 0, 0};
    float room[2][SWEEP_RUN + 2 * SWEEP_LANES];
    at[sweep->across] = task;
    at[other] = box->low[other];
    GasRange range, next = sweep_range(sweep, at[1], at[2], first, columns);
    for (int r = box->low[other]; r < box->high[other]; r++) {
        range = next;
        at[other] = r + 1;
        if (r + 1 < box->high[other]) next = sweep_range(sweep, at[1], at[2], first, columns);
        at[other] = r;

        // the upper faces are the next row's lower ones
        const int low = next.low < range.low ? next.low : range.low;
        const int high = next.high > range.high ? next.high : range.high;
        float *lower = room[r % 2], *upper = room[(r + 1) % 2]; // of column `first`
        if (sweep->axis > 0 && low < high)
            sweep_faces(sweep, gas_at(grid, low, at[1], at[2]) + grid->stride[sweep->axis], high - low,
                        upper + (low - first));

        const int count = range.high - range.low;
        if (count <= 0) continue;
        const size_t c = gas_at(grid, range.low, at[1], at[2]);
        lower += range.low - first;
        if (sweep->axis == 0) {
            sweep_faces(sweep, c, count + 1, lower);
            sweep_update(sweep, c, count, lower, lower + 1);
        } else {
            if (r == box->low[other]) sweep_faces(sweep, c, count, lower);
            sweep_update(sweep, c, count, lower, upper + (range.low - first));
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

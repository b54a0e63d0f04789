// The flow carries what the gas has. Of a density q
//
//   dq/dt + div(u q) = 0,   q' = q - sum over faces of (F_upper - F_lower)
//   F = c (q_up + (1 - |c|)/2 phi(a, b)),   c = u dt/cell
//
// with q_up of the cell that the flow comes from, a and b the differences on its two sides and phi = 2 a b/(a + b)
// where they agree in sign, else 0 (van Leer 1974): of second order where q is smooth, and no new extremes. What leaves
// a cell enters the next to the last bit, so that heat, fuel and smoke are lost only over the border. Momentum is
// carried per volume: u' = u - sum(F_upper - F_lower) + u sum(c_upper - c_lower).
//
// The way of a step is cut so that no cell gives away more than it has.
#include "gas/plan.h"

enum { ADVECT_RUN = 128, ADVECT_PARTS_MOST = 8 };
static const float ADVECT_COURANT = 0.8f;
static const float ADVECT_MIXING = 2e-4f; ///< m2/s, of hot air: 1.9e-4 at 1100 K
static const float ADVECT_MIX_MOST = 0.1f; ///< more would not be stable

/// Fluxes through `count` faces in a row; q is the first face's upper cell, `beyond` the way to the next cell across.
static void advect_faces(const GasPass *pass, const float *restrict q, int d, size_t c, int count,
                         float *restrict flux) {
    const size_t beyond = pass->plan->grid.stride[d];
    const float *restrict through = pass->from->field[GAS_THROUGH + d] + c, *restrict open = pass->plan->open[d] + c;
    const float wind = pass->wind[d], courant = pass->courant, mix = pass->mix;
    q += c;
    const float *restrict low = q - beyond, *restrict lowest = low - beyond, *restrict high = q + beyond;
    for (int i = 0; i < count; i++) {
        float way = (through[i] + wind) * courant, size = fabsf(way);
        float q0 = lowest[i], q1 = low[i], q2 = q[i], q3 = high[i]; // read before they are chosen from: this vectorises
        float b = q2 - q1, before = q1 - q0, behind = q3 - q2, a = way > 0 ? before : behind;
        float from = way > 0 ? q1 : q2, side = way > 0 ? 1.f : -1.f;
        float both = a * b, sum = a + b;
        both = both > 0 ? both : 0, sum = both > 0 ? sum : 1;
        flux[i] = way * (from + side * (1 - size) * both / sum) - mix * open[i] * b;
    }
}

typedef struct AdvectRows {
    float x[ADVECT_RUN + 1], y[2][ADVECT_RUN], z[2][ADVECT_RUN];
} AdvectRows;

/// Field `f` of rows j of plane k, in columns [first, first + count).
static void advect_columns(const GasPass *pass, int f, int k, int first, int count) {
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const float *q = pass->source[f], *const *through = (const float *const *)&pass->from->field[GAS_THROUGH];
    float steady = f >= GAS_VELOCITY ? pass->courant : 0;
    size_t y = grid->stride[1], z = grid->stride[2], c = gas_at(grid, first, 0, k);
    AdvectRows rows;
    advect_faces(pass, q, 1, c, count, rows.y[0]);
    for (int j = 0; j < grid->n[1]; j++, c += y) {
        float *restrict lower = rows.y[j % 2], *restrict upper = rows.y[(j + 1) % 2], *restrict out = pass->target[f] + c;
        const float *restrict x0 = through[0] + c, *restrict y0 = through[1] + c, *restrict z0 = through[2] + c;
        const float *restrict y1 = y0 + y, *restrict z1 = z0 + z, *restrict here = q + c;
        advect_faces(pass, q, 0, c, count + 1, rows.x);
        advect_faces(pass, q, 1, c + y, count, upper);
        advect_faces(pass, q, 2, c, count, rows.z[0]);
        advect_faces(pass, q, 2, c + z, count, rows.z[1]);
        for (int i = 0; i < count; i++) {
            float gone = (rows.x[i + 1] - rows.x[i]) + (upper[i] - lower[i]) + (rows.z[1][i] - rows.z[0][i]);
            float spread = (x0[i + 1] - x0[i]) + (y1[i] - y0[i]) + (z1[i] - z0[i]);
            out[i] = here[i] - gone + here[i] * steady * spread;
        }
    }
}

static void advect_planes(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasGrid *grid = &pass->plan->grid;
    for (int f = 0; f < GAS_CARRIED; f++)
        for (int k = begin; k < end; k++)
            for (int first = 0; first < grid->n[0]; first += ADVECT_RUN) {
                int count = grid->n[0] - first;
                advect_columns(pass, f, k, first, count < ADVECT_RUN ? count : ADVECT_RUN);
            }
}

/// The largest sum of a cell's speeds, m/s, of each plane.
static void advect_fastest(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasGrid *grid = &pass->plan->grid;
    const float *const *through = (const float *const *)&pass->from->field[GAS_THROUGH];
    for (int k = begin; k < end; k++) {
        float most = 0;
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            for (int i = 0; i < grid->n[0]; i++) {
                float sum = 0;
                for (int d = 0; d < 3; d++) {
                    float a = fabsf(through[d][c + (size_t)i] + pass->wind[d]);
                    float b = fabsf(through[d][c + (size_t)i + grid->stride[d]] + pass->wind[d]);
                    sum += a > b ? a : b;
                }
                most = sum > most ? sum : most;
            }
        }
        pass->plan->partial[k] = (double)most;
    }
}

void gas_advect(GasPass *pass) {
    GasPlan *plan = pass->plan;
    double fastest = 0;
    gas_planes(pass, &plan->grid, advect_fastest);
    for (int k = 0; k < plan->grid.n[2]; k++) fastest = plan->partial[k] > fastest ? plan->partial[k] : fastest;
    float way = (float)fastest * pass->dt / (plan->cell * ADVECT_COURANT);
    int parts = way > 1 ? way < ADVECT_PARTS_MOST ? (int)ceilf(way) : ADVECT_PARTS_MOST : 1;
    // a wind so strong that it blows everything away in a few steps may do so more slowly
    float slower = way > ADVECT_PARTS_MOST ? ADVECT_PARTS_MOST / way : 1;
    pass->courant = slower * pass->dt / (plan->cell * (float)parts);
    pass->mix = ADVECT_MIXING * pass->dt / (plan->cell * plan->cell * (float)parts);
    if (pass->mix > ADVECT_MIX_MOST) pass->mix = ADVECT_MIX_MOST;
    pass->source = pass->from->field;
    for (int part = 0; part < parts; part++) {
        bool last_but_even = (parts - part) % 2 == 0;
        pass->target = last_but_even ? plan->spare : pass->to->field;
        gas_planes(pass, &plan->grid, advect_planes);
        pass->source = pass->target;
    }
}

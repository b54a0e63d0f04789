// Advection: the flow carries the fields of the gas. For a density q
//
//   dq/dt + div(u q) = 0
//
// axis after axis: along each, with c = u dt/cell of the lower and upper face and q0 the values before the first axis,
//
//   q <- q - (F_upper - F_lower) + q0 (c_upper - c_lower)
//   F = c (q_up + (1 - |c|)/2 phi(a, b)) - open D dt/cell^2 b
//
// with q_up of the upstream cell, b the difference across the face, a that across the next face upstream and phi the
// least of |a + b|/2, 2 |a| and 2 |b|, signed, where they agree in sign, else 0 (van Leer 1977): of second order where
// q is smooth, and without new extremes. The last term keeps uniform fields uniform in between (Weymouth & Yue 2010);
// after the last axis, q0 sum(c_upper - c_lower) is subtracted again: so what leaves a cell enters the next to the last
// bit. Velocities are carried as momentum, (1 - L) u.
//
// D is the mixing of hot air by itself, and of eddies smaller than the cells by the shear of the resolved flow
// (Smagorinsky 1963): D = D_0 + (C cell)^2 |grad u|.
//
// The displacement of a step is divided so that along no axis it passes more than a cell at once.
#include "common/real.h"
#include "gas/advect_axis.h"

#include <limits.h>
#include <string.h>

enum { ADVECT_PARTS_MAX = 8 };
static const float ADVECT_COURANT = 0.9f;
static const float ADVECT_CALM = 0.2f, ADVECT_LIGHT = 0.02f; ///< m/s and L above which momentum is carried
static const float ADVECT_MIXING = 2e-4f;                    ///< m2/s, of hot air: 1.9e-4 at 1100 K
static const float ADVECT_EDDY = 0.2f;                       ///< C
static const float ADVECT_MIX_MAX = 0.1f;                    ///< twice this must be stable along one axis

static void advect_tasks(void *context, int begin, int end) {
    const Sweep *sweep = context;
    const GasBox *box = sweep->box;
    for (int task = box->low[sweep->across] + begin; task < box->low[sweep->across] + end; task++)
        for (int first = box->low[0]; first < box->high[0]; first += SWEEP_RUN) {
            int count = box->high[0] - first;
            sweep->rows(sweep, task, first, count < SWEEP_RUN ? count : SWEEP_RUN);
        }
}

static inline uint32_t advect_bits(float q) {
    uint32_t bits;
    memcpy(&bits, &q, sizeof bits);
    return bits;
}

/// Carries one field over the displacement of a step. Outside the box it does not change.
static void advect_field(GasPass *pass, int f, const GasBox *box, int parts) {
    GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const float *start = f < GAS_VELOCITY ? pass->from->field[f] : plan->spare[2];
    float *end[2], *between = plan->spare[1];
    end[(parts - 1) % 2] = pass->to->field[f];
    end[parts % 2] = plan->spare[0];
    memcpy(pass->to->field[f], start, grid->cells * sizeof(float));
    if (box->high[0] <= box->low[0]) return;

    // the sweeps read the box and the cells around it, in each row from the first that is not +0 to the last
    const int left = box->low[0] - GAS_GHOSTS, right = box->high[0] + GAS_GHOSTS;
    for (int k = box->low[2] - GAS_GHOSTS; k < box->high[2] + GAS_GHOSTS; k++)
        for (int j = box->low[1] - GAS_GHOSTS; j < box->high[1] + GAS_GHOSTS; j++) {
            const size_t c = gas_at(grid, 0, j, k);
            const float *q = start + c;
            uint32_t any = 0;
            for (int i = left; i < right; i++) any |= advect_bits(q[i]);
            GasRange range = {any ? left : INT_MAX / 2, any ? right : INT_MIN / 2};
            while (any && !advect_bits(q[range.low])) range.low++;
            while (any && !advect_bits(q[range.high - 1])) range.high--;
            for (int s = 0; s < 2; s++) {
                plan->row_busy[s][gas_row(grid, j, k)] = range;
                memcpy(plan->spare[s] + c + left, q + left, (size_t)(right - left) * sizeof(float));
            }
        }

    // three sweeps a part, one per axis
    int turn = 0;
    for (int part = 0; part < parts; part++) {
        float *here = end[part % 2];
        const float *from[3] = {start, here, between};
        float *to[3] = {here, between, here};
        for (int s = 0; s < 3; s++) {
            int axis = part % 2 ? 2 - s : s; // so that no axis is always the first
            Sweep sweep = {.pass = pass,
                           .box = box,
                           .from = from[s],
                           .to = to[s],
                           .start = start,
                           .busy = plan->row_busy[turn],
                           .busy_after = plan->row_busy[!turn],
                           .beyond = axis ? grid->stride[axis] / grid->stride[1] : 0,
                           .axis = axis,
                           .across = axis == 2 ? 1 : 2,
                           .last = s == 2,
                           .rows = plan->rows};
            pool_for(pass->pool, box->high[sweep.across] - box->low[sweep.across], 1, advect_tasks, &sweep);
            turn = !turn;
        }

        start = here;
    }
}

static void advect_look(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasGrid *grid = &pass->plan->grid;

    for (int k = begin; k < end; k++) {
        GasBox *box = pass->plan->plane_busy[k];
        float max = 0;
        for (int b = 0; b < GAS_BOXES; b++) box[b] = GAS_NO_BOX;

        // boxes around the moving gas in this plane, and its max speed
        for (int j = 0; j < grid->n[1]; j++)
            for (int first = 0; first < grid->n[0]; first += SWEEP_RUN) {
                int count = grid->n[0] - first, busy[GAS_BOXES][2];
                count = count < SWEEP_RUN ? count : SWEEP_RUN;
                const size_t c = gas_at(grid, first, j, k);
                const float *const *through = (const float *const *)&pass->from->field[GAS_THROUGH];
                const float *L = pass->from->field[GAS_LIGHTNESS] + c, *fuel = pass->from->field[GAS_FUEL] + c;
                const float *smoke = pass->from->field[GAS_SMOKE] + c;
                float speed[SWEEP_RUN];

                for (int i = 0; i < count; i++) speed[i] = 0;
                for (int b = 0; b < GAS_BOXES; b++) {
                    busy[b][0] = INT_MAX;
                    busy[b][1] = -1;
                }

                // max speed through the cells' faces
                for (int d = 0; d < 3; d++) {
                    const float *restrict lower = through[d] + c, *restrict upper = lower + grid->stride[d];
                    float wind = pass->wind[d];
                    for (int i = 0; i < count; i++) {
                        float a = fabsf(lower[i] + wind), b = fabsf(upper[i] + wind);
                        float both = a > b ? a : b;
                        speed[i] = both > speed[i] ? both : speed[i];
                    }
                }

                // ranges of cells that have something to carry
                float calm = ADVECT_CALM;
                for (int d = 0; d < 3; d++) calm = float_max(calm, fabsf(pass->wind[d]) + ADVECT_CALM);
                for (int i = 0; i < count; i++) {
                    const bool something[GAS_BOXES] = {L[i] > 0, fuel[i] > 0, smoke[i] > 0,
                                                       speed[i] > calm || L[i] > ADVECT_LIGHT};
                    max = speed[i] > max ? speed[i] : max;
                    for (int b = 0; b < GAS_BOXES; b++)
                        if (something[b]) {
                            busy[b][0] = i < busy[b][0] ? i : busy[b][0];
                            busy[b][1] = i;
                        }
                }

                for (int b = 0; b < GAS_BOXES; b++)
                    if (busy[b][1] >= 0)
                        gas_box_add(&box[b],
                                    (GasBox){{first + busy[b][0], j, k}, {first + busy[b][1] + 1, j + 1, k + 1}});
            }
        pass->plan->partial[k] = (double)max;
    }
}

/// Half the share of a difference that mixes through a face: D dt/cell^2/2.
static void advect_mixing(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const float *const *u = (const float *const *)&pass->from->field[GAS_VELOCITY];
    float still = 0.5f * ADVECT_MIXING * pass->courant / plan->cell;
    float eddy = 0.5f * ADVECT_EDDY * ADVECT_EDDY * pass->courant * 0.5f;
    still = still < ADVECT_MIX_MAX ? still : ADVECT_MIX_MAX;
    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            float *restrict mixing = plan->mixing + c;
            for (int i = 0; i < grid->n[0]; i++) mixing[i] = 0;

            // squared differences of the velocity
            for (int d = 0; d < 3; d++)
                for (int e = 0; e < 3; e++) {
                    const float *restrict a = u[d] + c - grid->stride[e], *restrict b = u[d] + c + grid->stride[e];
                    for (int i = 0; i < grid->n[0]; i++) mixing[i] += (b[i] - a[i]) * (b[i] - a[i]);
                }

            // mixing coefficient of still air plus that of eddies
            for (int i = 0; i < grid->n[0]; i++) {
                float mix = still + eddy * sqrtf(mixing[i]);
                mixing[i] = mix < ADVECT_MIX_MAX ? mix : ADVECT_MIX_MAX;
            }
        }
}

/// Converts a velocity field of the pass to the momentum (1 - L) u.
static void advect_to_momentum(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasGrid *grid = &pass->plan->grid;

    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            const float *restrict L = pass->from->field[GAS_LIGHTNESS] + c;
            const float *restrict u = pass->from->field[pass->field] + c;
            float *restrict momentum = pass->plan->spare[2] + c;
            for (int i = 0; i < grid->n[0]; i++) momentum[i] = (1 - L[i]) * u[i];
        }
}

static void advect_to_velocity(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasGrid *grid = &pass->plan->grid;

    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            const float *restrict L = pass->to->field[GAS_LIGHTNESS] + c;
            float *restrict u = pass->to->field[pass->field] + c;
            for (int i = 0; i < grid->n[0]; i++) u[i] /= L[i] < GAS_LIGHTEST ? 1 - L[i] : 1 - GAS_LIGHTEST;
        }
}

void gas_advect(GasPass *pass) {
    GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    double fastest = 0;

    gas_planes(pass, grid, advect_look);
    for (int k = 0; k < grid->n[2]; k++) fastest = plan->partial[k] > fastest ? plan->partial[k] : fastest;

    // parts of the displacement; a wind so strong that it blows everything away in a few steps is slowed
    float displacement = (float)fastest * pass->dt / (plan->cell * ADVECT_COURANT);
    int parts = displacement > 1 ? displacement < ADVECT_PARTS_MAX ? (int)ceilf(displacement) : ADVECT_PARTS_MAX : 1;
    float slower = displacement > ADVECT_PARTS_MAX ? ADVECT_PARTS_MAX / displacement : 1;
    pass->courant = slower * pass->dt / (plan->cell * (float)parts);

    // boxes outside which nothing is carried: for heat, for fuel, for smoke, and for momentum, of which still air has
    // little; in a part nothing moves farther than a cell
    for (int b = 0; b < GAS_BOXES; b++) {
        GasBox *box = &pass->busy[b];
        *box = GAS_NO_BOX;
        for (int k = 0; k < grid->n[2]; k++) gas_box_add(box, plan->plane_busy[k][b]);
        if (box->high[0] <= box->low[0]) continue;
        for (int d = 0; d < 3; d++) {
            int low = box->low[d] - parts - 1, high = box->high[d] + parts + 1;
            box->low[d] = low > 0 ? low : 0;
            box->high[d] = high < grid->n[d] ? high : grid->n[d];
        }
    }

    gas_planes(pass, grid, advect_mixing);
    for (int f = 0; f < GAS_CARRIED; f++) {
        pass->field = f;
        if (f >= GAS_VELOCITY) gas_planes(pass, grid, advect_to_momentum);
        advect_field(pass, f, &pass->busy[f < GAS_VELOCITY ? f : GAS_VELOCITY], parts);
        if (f >= GAS_VELOCITY) gas_planes(pass, grid, advect_to_velocity);
    }
}

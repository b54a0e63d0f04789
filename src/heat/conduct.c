// Implicit diffusion, eq 2 by the theta method:
//
//   D T = D T* - dt L (T* + theta (T - T*)),   (L T)_i = sum c_ij (T_i - T_j)
//
// theta = 1/2 is Crank and Nicolson's, of second order in dt. It makes no new extremes while dt sum c_ij <= 2 D_i for
// all i; for longer steps theta is what does not, 1 - D_i/(dt sum c_ij), which tends to backward Euler's 1 (Hundsdorfer
// & Verwer 2003, I.7.3). The umbrellas have 1, as the paper.
//
// D, c  capacities and conductances of operator.c
// T*    K  temperature after sources, combustion and losses
// dt    s  of fire
//
// Solved for the correction e = T - T*, (D + theta dt L) e = -dt L T*, by conjugate gradients with the diagonal as
// preconditioner (Hestenes & Stiefel 1952): floats, sums in double by fixed blocks. Temperature differences are formed
// before summation, so that the size of absolute temperatures costs no digits. Stops when the residual, in the norm of
// the inverse diagonal, is below `tolerance` times that of D (T* - T_amb), or after 200 iterations; then the step is
// counted as unconverged. Nothing flows between sheets, so that the equations of each may be scaled: with several they
// are, by the norm of its own right-hand side. So a sheet is as exact beside a hot and heavy one as alone.
//
// The new temperature is then T = T* - dt D^-1 L (T* + theta e). The flow from i to j is minus that from j to i to the last
// bit, so sum D T is conserved whatever the tolerance. An increment below a float's last digit would be lost, always in
// the same direction; rounding up or down at random, with the probability of the digits cut off, loses nothing on
// average. The random numbers depend only on particle and step.
//
// If the residual is too large for that, and T would leave the range of T*, bound.c ends the step instead.
//
// The umbrella conserves sum D T, not the heat sum C T. The difference, sum C_i dt (L T)_i / D_i, is heat that the
// operator itself makes or destroys; it is counted as heat in, so that the ledger is correct for eq 3.
#include <math.h>
#include <string.h>

#include "common/random.h"
#include "common/real.h"
#include "heat/heat_plan.h"

enum { CONDUCT_ITERATIONS = 200 };

/// One number per row of a slice, in the vectors of gcc and clang, which compile for every processor.
typedef float HeatLanes __attribute__((vector_size(HEAT_ROWS * sizeof(float))));

static inline HeatLanes conduct_load(const float *x) {
    HeatLanes lanes;
    memcpy(&lanes, x, sizeof lanes);
    return lanes;
}

/// sum c_ij (x_j - x_i) of the rows i, i + 1 .. of a slice.
static inline HeatLanes conduct_inflow(const HeatMatrix *matrix, const float *x, uint32_t i) {
    const float *value = matrix->value + matrix->first[i / HEAT_ROWS];
    const float *end = matrix->value + matrix->first[i / HEAT_ROWS + 1];
    const uint32_t *column = matrix->column + matrix->first[i / HEAT_ROWS];
    HeatLanes sum = {0}, here = conduct_load(x + i);

    for (; value < end; value += HEAT_ROWS, column += HEAT_ROWS) {
        HeatLanes there = {x[column[0]], x[column[1]], x[column[2]], x[column[3]]};
        sum += conduct_load(value) * (there - here);
    }

    return sum;
}

/// The end of the slice that begins at particle i, in a group that ends at `last`.
static inline uint32_t conduct_slice_end(uint32_t i, uint32_t last) {
    return last - i < HEAT_ROWS ? last : i + HEAT_ROWS;
}

static inline double conduct_weight(const HeatPass *pass, uint32_t i) {
    return pass->plan->weight[pass->shell->matter.sheet[i]];
}

/// Residual and norm of the right-hand side at the start, and the range of T*.
static void conduct_start(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    float ambient = plan->settings.ambient_temperature;

    for (int block = begin; block < end; block++) {
        double residual = 0, whole = 0;
        float min = INFINITY, max = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            plan->rest.awake[0][g] = heat_rest_reaches(&plan->rest, plan->rest.warm, g);
            if (!plan->rest.awake[0][g]) continue;

            uint32_t last = heat_group_last(plan, g), next;
            for (uint32_t i = g * HEAT_GROUP; i < last; i = next) {
                next = conduct_slice_end(i, last);
                HeatLanes inflow = conduct_inflow(&plan->matrix, plan->star, i);
                for (uint32_t row = 0; i < next; i++, row++) {
                    float r = plan->residual[i] = pass->dt * inflow[row];
                    float star = plan->star[i], b = plan->measure[i] * (star - ambient);
                    float inverse = plan->matrix.inverse[i];
                    plan->correction[i] = plan->search[i] = 0;
                    residual += (double)r * r * inverse;
                    whole += (double)b * b * inverse;
                    min = plan->alive[i] && star < min ? star : min;
                    max = plan->alive[i] && star > max ? star : max;
                }
            }
        }

        plan->partial[block][0] = residual;
        plan->partial[block][1] = whole;
        plan->partial[block][2] = (double)min;
        plan->partial[block][3] = (double)max;
    }
}

/// The new search direction. It reaches one ring of groups farther than the one before.
static void conduct_direction(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    const uint8_t *before = plan->rest.awake[!pass->turn];
    uint8_t *awake = plan->rest.awake[pass->turn];

    float *restrict search = plan->search, *restrict residual = plan->residual, *restrict correction = plan->correction;
    const float *restrict inverse = plan->matrix.inverse;

    for (uint32_t g = heat_group_first(begin); g < heat_group_end(plan, end - 1); g++) {
        awake[g] = heat_rest_reaches(&plan->rest, before, g);
        uint32_t first = g * HEAT_GROUP, last = heat_group_last(plan, g);
        if (before[g])
            for (uint32_t i = first; i < last; i++) search[i] = residual[i] * inverse[i] + pass->direction * search[i];
        else if (awake[g])
            for (uint32_t i = first; i < last; i++) residual[i] = correction[i] = search[i] = 0;
    }
}

/// The matrix times the search direction, and the curvature along it.
static void conduct_product(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    const float theta_dt = pass->theta * pass->dt;

    for (int block = begin; block < end; block++) {
        double sum = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;

            uint32_t last = heat_group_last(plan, g), next;
            for (uint32_t i = g * HEAT_GROUP; i < last; i = next) {
                next = conduct_slice_end(i, last);
                HeatLanes inflow = conduct_inflow(&plan->matrix, plan->search, i);
                for (uint32_t row = 0; i < next; i++, row++) {
                    plan->product[i] = plan->measure[i] * plan->search[i] - theta_dt * inflow[row];
                    sum += conduct_weight(pass, i) * plan->product[i] * plan->search[i];
                }
            }
        }

        plan->partial[block][0] = sum;
    }
}

/// A step along the search direction, and the new residual.
static void conduct_advance(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;

    for (int block = begin; block < end; block++) {
        double sum = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;
            for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++) {
                plan->correction[i] += pass->step_length * plan->search[i];
                float r = plan->residual[i] -= pass->step_length * plan->product[i];
                sum += conduct_weight(pass, i) * r * r * plan->matrix.inverse[i];
            }
        }

        plan->partial[block][0] = sum;
    }
}

/// Weighs several sheets by the norms of their right-hand sides. Returns the residual of all at the start.
static double conduct_weigh(const HeatPass *pass) {
    HeatPlan *plan = pass->plan;
    const uint16_t *sheet = pass->shell->matter.sheet;
    const float ambient = plan->settings.ambient_temperature;
    double residual = 0;
    for (uint32_t s = 0; s < plan->sheets; s++) plan->weight[s] = 0;

    for (uint32_t g = 0; g < plan->rest.groups; g++)
        for (uint32_t i = g * HEAT_GROUP; plan->rest.awake[0][g] && i < heat_group_last(plan, g); i++) {
            const double b = (double)(plan->measure[i] * (plan->star[i] - ambient));
            plan->weight[sheet[i]] += b * b * (double)plan->matrix.inverse[i];
        }

    for (uint32_t s = 0; s < plan->sheets; s++) plan->weight[s] = plan->weight[s] > 1e-300 ? 1 / plan->weight[s] : 0;
    for (uint32_t g = 0; g < plan->rest.groups; g++)
        for (uint32_t i = g * HEAT_GROUP; plan->rest.awake[0][g] && i < heat_group_last(plan, g); i++)
            residual += conduct_weight(pass, i) * plan->residual[i] * plan->residual[i] * plan->matrix.inverse[i];
    return residual;
}

static void conduct_settle(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    for (uint32_t g = heat_group_first(begin); g < heat_group_end(plan, end - 1); g++) {
        if (!plan->rest.awake[pass->turn][g]) continue;
        for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++)
            plan->star[i] += pass->theta * plan->correction[i];
    }
}

/// The new temperatures, the heat that the umbrella made, and whether all are within the range of T*.
static void conduct_finish(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    const float *temperature = pass->heat->temperature;
    const Matter *matter = &pass->shell->matter;
    uint32_t low = (uint32_t)pass->state->step, high = (uint32_t)(pass->state->step >> 32);

    // never at 0 K, however large the slack is: a much hotter sheet may give the range
    double min = double_max((double)pass->min - pass->slack, 0.5 * (double)pass->min),
           max = (double)pass->max + pass->slack;
    bool makes = false; // some sheet's operator makes heat
    for (uint32_t s = 0; s < pass->shell->sheet_count; s++)
        makes |= pass->shell->sheets[s].material.heat_operator != SINGE_HEAT_SURFACE;

    for (int block = begin; block < end; block++) {
        double made = 0;
        bool within = true;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;

            HeatLanes inflow = {0};
            for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++) {
                if (i % HEAT_ROWS == 0) inflow = conduct_inflow(&plan->matrix, plan->star, i);
                plan->next[i] = temperature[i];
                bool changes = inflow[i % HEAT_ROWS] != 0 || plan->delta[i] != 0;
                if (!changes || !plan->alive[i]) continue;

                // rounded at random
                double rise = (double)pass->dt * inflow[i % HEAT_ROWS] / plan->measure[i];
                double change = plan->delta[i] + rise;
                if (change != 0)
                    plan->next[i] = heat_round(temperature[i] + change, random_hash(i, low, high, HEAT_SEED));
                within &= (double)plan->next[i] >= min && (double)plan->next[i] <= max;
                if (makes && pass->shell->sheets[matter->sheet[i]].material.heat_operator != SINGE_HEAT_SURFACE)
                    made += matter->capacity[i] * rise;
            }
        }

        plan->partial[block][0] = made;
        plan->partial[block][1] = !within;
    }
}

SingeResult heat_conduct(HeatPass *pass, HeatCounters *counters, double *made, SingeError *error) {
    HeatPlan *plan = pass->plan;
    heat_blocks(pass, conduct_start);
    double residual = heat_sum(plan, 0), whole = heat_sum(plan, 1), tolerance = plan->settings.tolerance;
    plan->weight[0] = 1;

    // range of T*; a value that is not finite fails the step
    double min = INFINITY, max = 0;
    for (int block = 0; block < plan->blocks; block++) {
        min = double_min(min, plan->partial[block][2]);
        max = double_max(max, plan->partial[block][3]);
    }

    if (!(min > 0 && max < INFINITY) || !isfinite(residual + whole)) {
        for (uint32_t i = 0; i < plan->particles; i++)
            if (plan->alive[i] && !(plan->star[i] > 0 && plan->star[i] < INFINITY))
                return error_set(error, SINGE_ERROR_DIVERGED, "heat", i,
                                 "the temperature of particle %u is not a positive finite number", i);
    }

    pass->min = (float)min;
    pass->max = (float)max;
    pass->slack = tolerance * double_max(max - min, 0) + 1e-6 * max; // the tolerance, and rounding

    // conjugate gradients for the correction
    if (plan->sheets > 1) {
        residual = conduct_weigh(pass);
        whole = 1;
    }

    double enough = tolerance * tolerance * whole;
    pass->direction = 0;
    pass->turn = 0;
    for (int k = 0; k < CONDUCT_ITERATIONS && residual > enough && !pool_cancelled(pass->pool); k++) {
        pass->turn = !pass->turn;
        heat_blocks(pass, conduct_direction);
        heat_blocks(pass, conduct_product);
        double curvature = heat_sum(plan, 0);
        if (!(curvature > 0)) break;

        pass->step_length = (float)(residual / curvature);
        heat_blocks(pass, conduct_advance);
        double before = residual;
        residual = heat_sum(plan, 0);
        pass->direction = (float)(residual / before);
        counters->iterations++;
    }

    // the new temperatures; bound.c makes them if one has left the range
    bool within = true;
    heat_blocks(pass, conduct_settle);
    heat_blocks(pass, conduct_finish);
    for (int block = 0; block < plan->blocks; block++) within &= plan->partial[block][1] == 0;
    *made = within ? heat_sum(plan, 0) : heat_bound(pass);
    counters->unconverged += !(residual <= enough);
    counters->bounded += !within;
    return SINGE_OK;
}

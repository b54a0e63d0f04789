// Implicit diffusion, eq 2 by backward Euler:
//
//   (D + dt L) T = D T*,   (L T)_i = sum c_ij (T_i - T_j)
//
// D, c  capacities and conductances of operator.c
// T*    K  temperature after sources, combustion and losses
// dt    s  of fire
//
// Solved for the correction e = T - T*, (D + dt L) e = -dt L T*, by conjugate gradients with the diagonal as
// preconditioner (Hestenes & Stiefel 1952): floats, sums in double by fixed blocks. Temperature differences are formed
// before summation, so that the size of absolute temperatures costs no digits. Stops when the residual, in the norm of
// the inverse diagonal, is below `tolerance` times that of D (T* - T_amb), or after 200 iterations; then the step is
// counted as unconverged.
//
// The new temperature is then T = T* - dt D^-1 L (T* + e). The flow from i to j is minus that from j to i to the last
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

#include "common/assertion.h"
#include "common/random.h"
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

static void conduct_start_group(const HeatPass *pass, uint32_t group, double sums[4]) {
    HeatPlan *plan = pass->plan;
    float ambient = plan->settings.ambient_temperature, min = INFINITY, max = 0;
    double residual = sums[0], whole = sums[1];
    uint32_t last = heat_group_last(plan, group), next;
    for (uint32_t i = group * HEAT_GROUP; i < last; i = next) {
        next = conduct_slice_end(i, last);
        HeatLanes inflow = conduct_inflow(&plan->matrix, plan->star, i);

        // residual of the start, norm of the right-hand side, range of T*
        for (uint32_t row = 0; i < next; i++, row++) {
            float r = plan->residual[i] = pass->dt * inflow[row];
            float star = plan->star[i], b = plan->measure[i] * (star - ambient), inverse = plan->matrix.inverse[i];
            plan->correction[i] = plan->search[i] = 0;
            residual += (double)r * r * inverse;
            whole += (double)b * b * inverse;
            min = plan->alive[i] && star < min ? star : min;
            max = plan->alive[i] && star > max ? star : max;
        }
    }
    sums[0] = residual;
    sums[1] = whole;
    sums[2] = fmin(sums[2], (double)min), sums[3] = fmax(sums[3], (double)max);
}

/// Residual, right-hand side, and the range of T*.
static void conduct_start(void *context, int begin, int end) {
    const HeatPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    HeatPlan *plan = pass->plan;
    for (int block = begin; block < end; block++) {
        double *sums = plan->partial[block];
        sums[0] = sums[1] = 0;
        sums[2] = INFINITY;
        sums[3] = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            plan->rest.awake[0][g] = heat_rest_reaches(&plan->rest, plan->rest.warm, g);
            if (!plan->rest.awake[0][g]) continue;
            conduct_start_group(pass, g, sums);
        }
    }
}

/// The new search direction. It reaches one ring of groups farther than the one before.
static void conduct_direction(void *context, int begin, int end) {
    const HeatPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
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

static void conduct_product_group(const HeatPass *pass, uint32_t group, double *sum) {
    HeatPlan *plan = pass->plan;
    uint32_t last = heat_group_last(plan, group), next;
    for (uint32_t i = group * HEAT_GROUP; i < last; i = next) {
        next = conduct_slice_end(i, last);
        HeatLanes inflow = conduct_inflow(&plan->matrix, plan->search, i);
        for (uint32_t row = 0; i < next; i++, row++) {
            plan->product[i] = plan->measure[i] * plan->search[i] - pass->dt * inflow[row];
            *sum += (double)plan->product[i] * plan->search[i];
        }
    }
}

static void conduct_product(void *context, int begin, int end) {
    const HeatPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    HeatPlan *plan = pass->plan;
    for (int block = begin; block < end; block++) {
        double sum = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;
            conduct_product_group(pass, g, &sum);
        }
        plan->partial[block][0] = sum;
    }
}

static void conduct_advance(void *context, int begin, int end) {
    const HeatPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    HeatPlan *plan = pass->plan;
    for (int block = begin; block < end; block++) {
        double sum = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;
            for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++) {
                plan->correction[i] += pass->step_length * plan->search[i];
                float r = plan->residual[i] -= pass->step_length * plan->product[i];
                sum += (double)r * r * plan->matrix.inverse[i];
            }
        }
        plan->partial[block][0] = sum;
    }
}

static void conduct_settle(void *context, int begin, int end) {
    const HeatPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    HeatPlan *plan = pass->plan;
    for (uint32_t g = heat_group_first(begin); g < heat_group_end(plan, end - 1); g++) {
        if (!plan->rest.awake[pass->turn][g]) continue;
        for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++) plan->star[i] += plan->correction[i];
    }
}

/// The new temperatures of a group; adds the heat made there, and returns whether all are within the range of T*.
static bool conduct_finish_group(const HeatPass *pass, uint32_t group, double *made) {
    HeatPlan *plan = pass->plan;
    const float *temperature = pass->heat->temperature;
    const Matter *matter = &pass->shell->matter;
    uint32_t low = (uint32_t)pass->state->step, high = (uint32_t)(pass->state->step >> 32);
    bool within = true;
    double min = (double)pass->min - pass->slack, max = (double)pass->max + pass->slack;
    HeatLanes inflow = {0};
    for (uint32_t i = group * HEAT_GROUP; i < heat_group_last(plan, group); i++) {
        if (i % HEAT_ROWS == 0) inflow = conduct_inflow(&plan->matrix, plan->star, i);
        plan->next[i] = temperature[i];
        bool changes = inflow[i % HEAT_ROWS] != 0 || plan->delta[i] != 0;
        if (!changes || !plan->alive[i]) continue;

        // T of the new step, rounded at random; whether it is within the range
        double rise = (double)pass->dt * inflow[i % HEAT_ROWS] / plan->measure[i];
        double change = plan->delta[i] + rise;
        if (change != 0) plan->next[i] = heat_round(temperature[i] + change, random_hash(i, low, high, HEAT_SEED));
        within &= (double)plan->next[i] >= min && (double)plan->next[i] <= max;
        if (pass->shell->sheets[matter->sheet[i]].material.heat_operator == SINGE_HEAT_UMBRELLA)
            *made += matter->capacity[i] * rise;
    }
    return within;
}

static void conduct_finish(void *context, int begin, int end) {
    const HeatPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    HeatPlan *plan = pass->plan;
    for (int block = begin; block < end; block++) {
        double made = 0;
        bool within = true;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;
            within &= conduct_finish_group(pass, g, &made);
        }
        plan->partial[block][0] = made;
        plan->partial[block][1] = !within;
    }
}

/// Conjugate gradients for the correction. Returns whether they reached the tolerance.
static bool conduct_solve(HeatPass *pass, double residual, double enough, HeatCounters *counters) {
    HeatPlan *plan = pass->plan;
    for (int k = 0; k < CONDUCT_ITERATIONS && residual > enough; k++) {
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
    return residual <= enough;
}

/// The first particle whose T* is not a positive finite number, or -1.
static int64_t conduct_fault(const HeatPlan *plan) {
    for (uint32_t i = 0; i < plan->particles; i++)
        if (plan->alive[i] && !(plan->star[i] > 0 && plan->star[i] < INFINITY)) return i;
    return -1;
}

SingeResult heat_conduct(HeatPass *pass, HeatCounters *counters, double *made, SingeError *error) {
    HeatPlan *plan = pass->plan;
    heat_blocks(pass, conduct_start);
    double residual = heat_sum(plan, 0), whole = heat_sum(plan, 1), tolerance = plan->settings.tolerance;

    // range of T*; a value that is not finite fails the step
    double min = INFINITY, max = 0;
    for (int block = 0; block < plan->blocks; block++)
        min = fmin(min, plan->partial[block][2]), max = fmax(max, plan->partial[block][3]);
    if (!(min > 0 && max < INFINITY) || !isfinite(residual + whole)) {
        int64_t fault = conduct_fault(plan);
        if (fault >= 0)
            return error_set(error, SINGE_ERROR_DIVERGED, "heat", fault,
                             "the temperature of particle %lld is not a positive finite number", (long long)fault);
    }

    // solve, then check that no temperature has left the range
    pass->min = (float)min;
    pass->max = (float)max;
    pass->slack = tolerance * fmax(max - min, 0) + 1e-6 * max; // the tolerance, and rounding
    pass->direction = 0;
    pass->turn = 0;
    bool converged = conduct_solve(pass, residual, tolerance * tolerance * whole, counters), within = true;
    heat_blocks(pass, conduct_settle);
    heat_blocks(pass, conduct_finish);
    for (int block = 0; block < plan->blocks; block++) within &= plan->partial[block][1] == 0;
    *made = within ? heat_sum(plan, 0) : heat_bound(pass);
    counters->unconverged += !converged;
    counters->bounded += !within;
    return SINGE_OK;
}

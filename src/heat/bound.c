// Bounds of conduction: T stays in the range of T*, whatever the solver's residual.
//
// With the theta of conduct.c the exact T lies between the min and the max of T*. conduct.c adds the solver's
// residual r as r/D, to conserve heat. This is negligible unless a step is very long for a particle, dt sum c_ij >> D:
// then the last digit of a float is already too much. In that case the step ends as follows.
//
//   x_j = the solver's T_j, limited to the range
//   T_i = T*_i + dt sum c_ij (x_j - T*_i)/(D_i + dt sum c_ij)        a mean of numbers within the range
//
// The heat that is then missing or in excess, as small as the residual, is distributed over all conducting particles:
// each moves towards the upper or the lower end of the range by the same fraction of its distance. So T stays in the
// range, and heat is conserved. For the umbrella, which does not conserve heat, it is counted as made.
#include <math.h>

#include "common/random.h"
#include "common/real.h"
#include "heat/heat_plan.h"

static double bound_within(const HeatPass *pass, double T) {
    return T > (double)pass->min ? double_min(T, (double)pass->max) : (double)pass->min;
}

static bool bound_of_surface(const HeatPass *pass, uint32_t i) {
    uint32_t sheet = pass->shell->matter.sheet[i];
    return pass->shell->sheets[sheet].material.heat_operator == SINGE_HEAT_SURFACE;
}

/// T* of a particle, K.
static double bound_star(const HeatPass *pass, uint32_t i) {
    return bound_within(pass, (double)pass->heat->temperature[i] + (double)pass->plan->delta[i]);
}

/// T of every conducting particle, and the heat that is then missing, by block.
static void bound_means(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    const HeatMatrix *matrix = &plan->matrix;
    const float *capacity = pass->shell->matter.capacity;

    for (int block = begin; block < end; block++) {
        double lacking = 0, above = 0, below = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;

            for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++) {
                if (!plan->alive[i]) continue;

                // the mean with the neighbours
                double star = bound_star(pass, i), inflow = 0, sum = 0, dt = (double)pass->dt;
                for (uint32_t k = 0; k < heat_row_width(matrix, i); k++) {
                    uint32_t entry = heat_entry(matrix, i, k);
                    double conductance = (double)matrix->value[entry];
                    inflow += conductance * (bound_within(pass, (double)plan->star[matrix->column[entry]]) - star);
                    sum += conductance;
                }

                double all = (double)plan->measure[i] + dt * sum;
                plan->next[i] = (float)(all > 0 ? bound_within(pass, star + dt * inflow / all) : star);
                if (!bound_of_surface(pass, i)) continue;

                // missing heat, and the room above and below
                lacking += (double)capacity[i] * (star - (double)plan->next[i]);
                above += (double)capacity[i] * ((double)pass->max - (double)plan->next[i]);
                below += (double)capacity[i] * ((double)plan->next[i] - (double)pass->min);
            }
        }

        plan->partial[block][0] = lacking;
        plan->partial[block][1] = above;
        plan->partial[block][2] = below;
    }
}

/// Moves every particle by a share towards the bound, and rounds at random.
static void bound_shares(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    double towards = pass->share > 0 ? (double)pass->max : (double)pass->min, share = fabs(pass->share);
    uint32_t low = (uint32_t)pass->state->step, high = (uint32_t)(pass->state->step >> 32);

    for (int block = begin; block < end; block++) {
        double made = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            if (!plan->rest.awake[pass->turn][g]) continue;

            for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++) {
                if (!plan->alive[i]) {
                    plan->next[i] = pass->heat->temperature[i];
                    continue;
                }
                double T = (double)plan->next[i];
                if (bound_of_surface(pass, i)) T += share * (towards - T);
                else made += (double)pass->shell->matter.capacity[i] * (T - bound_star(pass, i));
                plan->next[i] = heat_round(T, random_hash(i, low, high, HEAT_SEED));
            }
        }

        plan->partial[block][0] = made;
    }
}

double heat_bound(HeatPass *pass) {
    HeatPlan *plan = pass->plan;
    heat_blocks(pass, bound_means);
    double lacking = heat_sum(plan, 0), room = heat_sum(plan, lacking > 0 ? 1 : 2);
    pass->share = room > 0 ? double_min(double_max(lacking / room, -1), 1) : 0;
    heat_blocks(pass, bound_shares);
    return heat_sum(plan, 0);
}

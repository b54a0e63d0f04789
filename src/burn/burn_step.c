// The burn stage: ignition, mass loss (eq 4), target lengths (eq 5 and 6).
#include "burn/burn_job.h"

#include <math.h>

static SingeResult diverged(const Shell *shell, const BurnState *burn, SingeError *error) {
    uint32_t particle = 0;
    while (particle + 1 < shell->particle_count && isfinite(burn->mass[particle])) particle++;
    return error_set(error, SINGE_ERROR_DIVERGED, "burn", particle, "the mass of particle %u is not finite", particle);
}

SingeResult burn_step(const Shell *shell, const State *state, Pool *pool, float h, float pace, const float *thickening,
                      double *partial, BurnState *burn, EventList *events, SingeError *error) {
    BurnJob job = {
        .shell = shell, .state = state, .h = h, .dt = h * pace, .time = (float)state->time,
        .thickening = thickening, .partial = partial, .burn = burn,
    };
    burn_ignite(&job, pool, events);
    burn_air(&job, pool);
    double lost = burn_lose_mass(&job, pool);
    if (!isfinite(lost)) return diverged(shell, burn, error);
    burn->mass_burnt += lost;
    if (lost > 0) burn_shrink(&job, pool);
    return SINGE_OK;
}

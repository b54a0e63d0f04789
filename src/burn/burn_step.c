// The burn stage: ignition, mass loss (eq 4), target lengths (eq 5 and 6).
#include "burn/burn_job.h"

#include <math.h>

static SingeResult diverged(const Shell *shell, const BurnState *burn, SingeError *error) {
    uint32_t particle = 0;
    while (particle + 1 < shell->particle_count && isfinite(burn->mass[particle])) particle++;
    return error_set(error, SINGE_ERROR_DIVERGED, "burn", particle, "the mass of particle %u is not finite", particle);
}

SingeResult burn_step(const StepContext *context, const float *thickening, double *partial, BurnState *burn) {
    const StateInput *state = &context->state;
    Pool *pool = context->pool;
    BurnJob job = {
        .shell = context->shell,
        .state = state,
        .h = context->h,
        .dt = context->h * context->pace,
        .time = (float)state->time,
        .thickening = thickening,
        .partial = partial,
        .burn = burn,
    };

    // ignitions, air at the embers, loss of mass
    burn_ignite(&job, pool, context->events);
    burn_air(&job, pool);
    double lost = burn_lose_mass(&job, pool);
    if (!isfinite(lost)) return diverged(context->shell, burn, context->error);
    burn->mass_burnt += lost;

    // shorten the springs of particles that lost mass
    if (lost > 0) burn_shrink(&job, pool);
    return SINGE_OK;
}

// The burn stage: ignition, mass loss (eq 4), target lengths (eq 5 and 6). A particle ignites when its temperature first
// reaches its ignition temperature.
#include "burn/burn_job.h"

#include <math.h>

#define NEVER (-1.0f)
#define JUST_NOW (-2.0f) // only between the two passes of ignition

/// Marks new ignitions, and counts those of every block in its partial.
static void mark_ignited(void *context, int begin, int end) {
    BurnJob *job = context;
    const float *temperature = job->state->heat->temperature;
    const Field ignition = job->shell->matter.ignition_temperature;
    const uint8_t *flags = job->state->ablate->particle_flags;
    float *time_ignited = job->burn->time_ignited;

    for (int block = begin; block < end; block++) {
        uint32_t first, last, run, count = 0;
        burn_block(job, block, &first, &last);
        for (; first < last; first = run) {
            run = burn_run_end(first, last);
            if (!burn_is_hot(job, first, run)) continue;
            for (uint32_t i = first; i < run; i++) {
                if (time_ignited[i] != NEVER || temperature[i] < field_at(ignition, i)) continue;
                if (!(flags[i] & SINGE_ALIVE)) continue;
                time_ignited[i] = JUST_NOW;
                count++;
            }
        }

        job->partial[block] = count;
    }
}

SingeResult burn_step(const StepContext *context, const float *thickening, double *partial, BurnAir *air,
                      BurnState *burn) {
    const Shell *shell = context->shell;
    const StateInput *state = &context->state;
    Pool *pool = context->pool;

    BurnJob job = {
        .shell = shell,
        .state = state,
        .h = context->h,
        .dt = context->h * context->pace,
        .time = (float)state->time,
        .thickening = thickening,
        .partial = partial,
        .air = air,
        .burn = burn,
    };

    // ignitions, with their events in order of particle
    int blocks = pool_blocks((int)shell->particle_count);
    pool_for(pool, blocks, 1, mark_ignited, &job);
    for (int block = 0; block < blocks; block++) {
        if (partial[block] == 0) continue;
        uint32_t first, last;
        burn_block(&job, block, &first, &last);
        for (uint32_t i = first; i < last; i++) {
            if (burn->time_ignited[i] != JUST_NOW) continue;
            burn->time_ignited[i] = job.time;
            event_push(context->events, SINGE_EVENT_IGNITED, (int32_t)i, state->time, state->dynamics->position[i]);
        }
    }

    // air at the embers, loss of mass
    burn_air(&job, pool);
    double lost = burn_lose_mass(&job, pool);
    if (!isfinite(lost)) {
        uint32_t particle = 0;
        while (particle + 1 < shell->particle_count && isfinite(burn->mass[particle])) particle++;
        return error_set(context->error, SINGE_ERROR_DIVERGED, "burn", particle,
                         "the mass of particle %u is not finite", particle);
    }

    burn->mass_burnt += lost;

    // springs of particles that lost mass get shorter
    if (lost > 0) burn_shrink(&job, pool);
    return SINGE_OK;
}

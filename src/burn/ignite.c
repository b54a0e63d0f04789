// Ignition: a particle ignites when its temperature first reaches its ignition temperature.
#include "common/assertion.h"
#include "burn/burn_job.h"

#define NEVER (-1.0f)
#define JUST_NOW (-2.0f) // only between the two passes below

/// Marks new ignitions among particles [first, last) and counts them.
static uint32_t mark_run(BurnJob *job, uint32_t first, uint32_t last) {
    const float *temperature = job->state->heat->temperature;
    const Field ignition = job->shell->matter.ignition_temperature;
    const uint8_t *flags = job->state->ablate->particle_flags;
    float *time_ignited = job->burn->time_ignited;
    uint32_t count = 0;
    for (uint32_t i = first; i < last; i++) {
        if (time_ignited[i] != NEVER || temperature[i] < field_at(ignition, i)) continue;
        if (!(flags[i] & SINGE_ALIVE)) continue;
        time_ignited[i] = JUST_NOW;
        count++;
    }
    return count;
}

/// Stores the number of new ignitions of every block in its partial.
static void mark_blocks(void *context, int begin, int end) {
    BurnJob *job = context;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    for (int block = begin; block < end; block++) {
        uint32_t first, last, run, count = 0;
        burn_block(job, block, &first, &last);
        for (; first < last; first = run) {
            run = burn_run_end(first, last);
            if (burn_is_hot(job, first, run)) count += mark_run(job, first, run);
        }
        job->partial[block] = count;
    }
}

void burn_ignite(BurnJob *job, Pool *pool, EventList *events) {
    int blocks = pool_blocks((int)job->shell->particle_count);
    pool_for(pool, blocks, 1, mark_blocks, job);
    for (int block = 0; block < blocks; block++) {
        if (job->partial[block] == 0) continue;
        uint32_t first, last;
        burn_block(job, block, &first, &last);
        for (uint32_t i = first; i < last; i++) {
            if (job->burn->time_ignited[i] != JUST_NOW) continue;
            job->burn->time_ignited[i] = job->time;
            event_push(events, SINGE_EVENT_IGNITED, (int32_t)i, job->state->time, job->state->dynamics->position[i]);
        }
    }
}

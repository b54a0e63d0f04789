// Target length of a spring, eq 6 with the layers' own share of the shrinkage:
//
//   l = l_init (1 - s (1 - (v0 + v1)/2))
//
//   l_init  initial length, m (the paper's l_rest is the same length; compounding would shrink without end)
//   v0, v1  volume ratios of the ends, eq 5
//   s       mean of the ends' shrink factors; 1 is the paper, and the layers' difference makes curl
//
// v follows from the mass alone, so that only springs with an end that lost mass need a new length.
#include "burn/burn_job.h"

/// A strong shrink factor must not turn a spring inside out.
#define LEAST_RATIO 0.05f

typedef struct ShrinkJob {
    const BurnJob *burn;
    SingeColour colour;
} ShrinkJob;

static float length_ratio(const Matter *matter, const float *mass, uint32_t a, uint32_t b) {
    float volume_a = burn_volume_ratio(mass[a], field_at(matter->mass_min, a), field_at(matter->ash_density, a));
    float volume_b = burn_volume_ratio(mass[b], field_at(matter->mass_min, b), field_at(matter->ash_density, b));
    float shrink = 0.5f * (field_at(matter->shrink, a) + field_at(matter->shrink, b));
    float ratio = 1 - shrink * (1 - 0.5f * (volume_a + volume_b));
    return ratio < LEAST_RATIO ? LEAST_RATIO : ratio;
}

static void shrink_springs(void *context, int begin, int end) {
    const ShrinkJob *job = context;
    const Shell *shell = job->burn->shell;
    const SpringSet *springs = &shell->springs[job->colour];
    const uint8_t *flags = job->burn->state->ablate.spring_flags[job->colour];
    BurnState *burn = job->burn->burn;
    for (int s = begin; s < end; s++) {
        uint32_t a = springs->ends[s][0], b = springs->ends[s][1];
        bool changed = burn->burn_rate[a] > 0 || burn->burn_rate[b] > 0;
        if (!changed || !(flags[s] & SINGE_ALIVE)) continue;
        burn->spring_length[job->colour][s] = springs->rest[s] * length_ratio(&shell->matter, burn->mass, a, b);
    }
}

void burn_shrink(BurnJob *job, Pool *pool) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        ShrinkJob shrink = {job, (SingeColour)colour};
        pool_for(pool, (int)job->shell->springs[colour].count, 4096, shrink_springs, &shrink);
    }
}

void burn_restore_lengths(const Shell *shell, const State *state, BurnState *burn) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        for (uint32_t s = 0; s < springs->count; s++) {
            if (!(state->ablate.spring_flags[colour][s] & SINGE_ALIVE)) continue;
            float ratio = length_ratio(&shell->matter, burn->mass, springs->ends[s][0], springs->ends[s][1]);
            burn->spring_length[colour][s] = springs->rest[s] * ratio;
        }
    }
}

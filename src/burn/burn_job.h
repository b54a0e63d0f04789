// Shared declarations of the passes of one burn step.
#pragma once

#include "burn/burn.h"

typedef struct BurnJob {
    const Shell *shell;
    const StateInput *state;
    float h;                 ///< s, the step in scene time
    float dt;                ///< s, of fire: h times pace
    float time;              ///< s, time stamp of this step
    const float *thickening; ///< [sheets] F
    double *partial;         ///< [pool_blocks(particles)]
    BurnAir *air;            ///< NULL: it is not limited
    bool shares;             ///< there is too little air for all in this step
    BurnState *burn;
} BurnJob;

/// The particles of block `block`: [*first, *last).
static inline void burn_block(const BurnJob *job, int block, uint32_t *first, uint32_t *last) {
    *first = (uint32_t)block * POOL_BLOCK;
    *last = *first + POOL_BLOCK < job->shell->particle_count ? *first + POOL_BLOCK : job->shell->particle_count;
}

/// Whether any of the particles [first, last), at most FIELD_RUN of them, has reached its ignition temperature or is
/// not a number. Most of a sheet usually has not.
static inline bool burn_is_hot(const BurnJob *job, uint32_t first, uint32_t last) {
    const float *temperature = job->state->heat->temperature + first;
    const float *ignition = field_run(job->shell->matter.ignition_temperature, first);
    int hot = 0;
    for (uint32_t i = 0; i < last - first; i++) hot |= !(temperature[i] < ignition[i]);
    return hot;
}

/// The end of the run of particles from `first` that is processed at once.
static inline uint32_t burn_run_end(uint32_t first, uint32_t last) {
    return last - first < FIELD_RUN ? last : first + FIELD_RUN;
}

/// The share of the air that reaches hot char, stored in burn->release until burn_lose_mass overwrites it (glow.c).
void burn_air(BurnJob *job, Pool *pool);

/// The second reaction: the share of char that is left of `share` after dt s.
float burn_glow(const BurnJob *job, uint32_t i, float fuel, float share, float air, float dt);

/// K by which unit mass is heated per mass fraction of char that glows away.
float burn_glow_heat(const BurnJob *job, uint32_t i);

/// Eq 4 and the glowing of char. Returns the mass lost as gas, kg; not finite if a mass is not.
double burn_lose_mass(BurnJob *job, Pool *pool);

/// What follows from mass and fuel, ash and volume, of the particles [first, last), at most four.
void burn_follow(const Matter *matter, BurnState *burn, uint32_t first, uint32_t last);

/// Eq 6, for springs with an end that lost mass in this step.
void burn_shrink(BurnJob *job, Pool *pool);

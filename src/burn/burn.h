// Burning: mass loss (eq 4), volume (eq 5) and target lengths (eq 6).
#ifndef BURN_BURN_H
#define BURN_BURN_H

#include "common/pool.h"
#include "burn/volume.h"

/// One step of length h: masses, times and target lengths. `thickening` holds F for every sheet; rates
/// are divided by it. `partial` is scratch of pool_blocks(particle_count) doubles. Reads `state`,
/// writes `burn` (which is &state->burn). Ignitions are pushed to `events` in order of particle.
SingeResult burn_step(const Shell *shell, const State *state, Pool *pool, float h, float pace, const float *thickening,
                      double *partial, BurnState *burn, EventList *events, SingeError *error);

/// Target lengths from the masses, of all springs alive: to the bit those that the steps left there. Reads `state`,
/// writes `burn` (which is &state->burn).
void burn_restore_lengths(const Shell *shell, const State *state, BurnState *burn);

#endif

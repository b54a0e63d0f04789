// Burning: mass loss (eq 4), volume (eq 5) and target lengths (eq 6).
#pragma once

#include "burn/supply.h"
#include "common/pool.h"
#include "shell/target_length.h"
#include "world/step_context.h"

/// One step: masses, times and target lengths. `thickening` holds F for every sheet; rates are divided by it. `partial`
/// is scratch of pool_blocks(particle_count) doubles. Reads the other parts of the State, and writes `burn`. Ignitions
/// go to context->events in order of particle. SINGE_ERROR_DIVERGED with the particle when a mass is not finite.
SingeResult burn_step(const StepContext *context, const float *thickening, double *partial, BurnAir *air,
                      BurnState *burn);

/// Computes the target lengths of all springs that are alive in `ablate` from the masses: to the bit those that the
/// steps computed.
void burn_restore_lengths(const Shell *shell, const AblateState *ablate, BurnState *burn);

// Tearing: where the line force in a sheet exceeds its strength, the sheet opens along the sides of its cells.
//
// The one stage that changes the Shell, by the splits of shell/split.h, whose list is in the TearState; and as a split
// makes a particle, it writes of every part of the State what the new one takes over from the old one. It comes after
// what can fail in a step, so that a failed step has torn nothing.
#ifndef TEAR_TEAR_H
#define TEAR_TEAR_H

#include "base/pool.h"
#include "shell/shell.h"

/// Scratch of the stage, built once.
typedef struct TearPlan TearPlan;
SingeResult tear_plan_create(Memory *memory, const Shell *shell, TearPlan **plan);
void tear_plan_free(Memory *memory, TearPlan *plan);

/// One step of length h. `pull` are the springs' forces over their lengths in that step, N/m, by colour. Returns the
/// number of new splits, which are the last ones of state->tear. *short_of_spares: a tear found no vertex left.
uint32_t tear_step(TearPlan *plan, Shell *shell, State *state, const float *const pull[SINGE_COLOUR_COUNT], Pool *pool,
                   float h, bool *short_of_spares);

#endif

// Tearing: where the line force in a sheet exceeds its strength, the sheet opens along the sides of its cells.
//
// This is the one stage that changes the Shell, by the splits of shell/split.h, whose list is in the TearState. A split
// creates a particle, so it copies the old particle's values in every part of the State. The stage runs after
// everything in a step that can fail, so a failed step has torn nothing.
#pragma once

#include "common/pool.h"
#include "shell/shell.h"

/// Scratch of the stage, built once.
typedef struct TearPlan TearPlan;

/// For substeps of h seconds.
SingeResult tear_plan_create(Memory *memory, const Shell *shell, float h, TearPlan **plan);
void tear_plan_free(Memory *memory, TearPlan *plan);

/// Sets a sheet's strength for this step from the distance at which it is held, over its geodesic length.
void tear_stretched(TearPlan *plan, uint32_t sheet, float stretch);

/// One step of length h. `pull` are the springs' forces over their lengths in that step, times their target over their
/// rest lengths, N/m, by colour. Returns the number of new splits, which are the last ones of state->tear.
/// *short_of_spares: a tear found no spare vertex.
uint32_t tear_step(TearPlan *plan, Shell *shell, State *state, const float *const pull[SINGE_COLOUR_COUNT], Pool *pool,
                   float h, bool *short_of_spares);

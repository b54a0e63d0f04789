// Ablation: removes burnt parts (section 6), labels the pieces, and gives the level set that surface/ draws.
#pragma once

#include "common/pool.h"
#include "shell/shell.h"
#include "world/step_context.h"

/// Scratch of the stage, built once.
typedef struct AblatePlan AblatePlan;
SingeResult ablate_plan_create(Memory *memory, const Shell *shell, AblatePlan **plan);
void ablate_plan_free(Memory *memory, AblatePlan *plan);

/// m' = m - m_loss at a particle; where the sheet's `ablate` is false, always 1.
float ablate_level(const Shell *shell, const State *state, uint32_t particle);

/// The same at all [particles], until the next call.
const float *ablate_levels(AblatePlan *plan, const Shell *shell, const BurnState *burn);

/// [vertices] 1 at the mesh's boundary and where it is torn, as of the last ablate_levels.
const uint8_t *ablate_rim(const AblatePlan *plan);

/// Labels the pieces in order of their smallest particle, unless they have labels. ablate_step does this
/// first; a caller that reads pieces before the first step calls it too.
void ablate_label(AblatePlan *plan, const Shell *shell, AblateState *ablate);

/// Whether data that was read back is consistent: live springs are counted at their ends, pieces are connected by them,
/// and ids suffice for all pieces that may still separate. The shell's tears have been repeated.
bool ablate_fits(AblatePlan *plan, const Shell *shell, const AblateState *ablate);

/// Removes burnt triangles, springs, particles and small loose pieces; relabels pieces when topology changed; pushes
/// hole and piece events. The enthalpy of removed particles is relative to the context's ambient temperature. Reads the
/// other parts of the State, and writes `ablate`; cannot fail. The first call labels the pieces.
void ablate_step(AblatePlan *plan, const StepContext *context, AblateState *ablate);

/// Relabels the pieces after a tear, removes small loose ones, and reports those that separated.
void ablate_torn(AblatePlan *plan, const StepContext *context, AblateState *ablate);

// Ablation: removes burnt parts (section 6), labels the pieces, and gives the level set that is drawn.
#ifndef ABLATE_ABLATE_H
#define ABLATE_ABLATE_H

#include "common/pool.h"
#include "shell/shell.h"
#include "world/step_context.h"

/// Scratch of the stage, built once.
typedef struct AblatePlan AblatePlan;
SingeResult ablate_plan_create(Memory *memory, const Shell *shell, AblatePlan **plan);
void ablate_plan_free(Memory *memory, AblatePlan *plan);

/// m' = m - m_loss at a particle; where the sheet's `ablate` is false, always 1.
float ablate_level(const Shell *shell, const State *state, uint32_t particle);

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

/// Draws the surface (marching triangles, surface.c). Grows `surface` through its allocator.
SingeResult ablate_surface(AblatePlan *plan, const Shell *shell, const State *state, SingeSurface *surface,
                           SingeError *error);

/// How finely the surface is drawn near the front.
typedef struct SurfaceDetail {
    float size;        ///< m, distance of the points of the level set, > 0
    float raggedness;  ///< m, max depth of the raggedness of burnt edges, >= 0
    uint32_t seed;     ///< of the noise; each sheet has its own
    const float *room; ///< [vertices] m, distance of another surface, or INFINITY; NULL: none is near
    float bulge_max;   ///< m, max distance of the surface from flat triangles; 0: only by the cells' size
} SurfaceDetail;

/// The same, refined near the front (surface_fine.c). Its scratch comes from `memory` and is freed before it returns.
SingeResult ablate_surface_fine(AblatePlan *plan, const Shell *shell, const State *state, const SurfaceDetail *detail,
                                Memory *memory, Pool *pool, SingeSurface *surface, SingeError *error);

#endif

// Heat: sources, losses, combustion and diffusion (eq 1 to 3).
#pragma once

#include "common/pool.h"
#include "shell/shell.h"
#include "world/step_context.h"

/// Checks a Def and fills a slot's contents (all but generation). The uv of particles come from the shell; if it is
/// empty, a texture waits for source_settle.
SingeResult source_create(Memory *memory, const Shell *shell, const SingeSourceDef *def, Source *source,
                          SingeError *error);

/// Evaluates a waiting texture once the shell exists; it stays waiting until source_settled.
SingeResult source_settle(Memory *memory, const Shell *shell, Source *source, SingeError *error);
void source_settled(Memory *memory, Source *source);

/// Reverts source_settle.
void source_unsettle(Memory *memory, const Shell *shell, Source *source);
void source_free(Memory *memory, const Shell *shell, Source *source);

/// Makes the checks of source_create, and of later moves, on a source that was read back; its texture's values are
/// those at the particles.
SingeResult source_check_read(const Shell *shell, const Source *source, SingeError *error);

/// Settings of the stage, constant while it runs.
typedef struct HeatSettings {
    float ambient_temperature; ///< K
    float tolerance;           ///< relative residual of the diffusion
    float pace;
    size_t scratch_min; ///< bytes
} HeatSettings;

/// Operators and scratch of the stage, built once.
typedef struct HeatPlan HeatPlan;

/// Fails when out of memory (*error is not filled then), if a sheet needs a front thickening above 1e6, and if its
/// conductances do not fit floats.
SingeResult heat_plan_create(Memory *memory, const Shell *shell, const HeatSettings *settings, HeatPlan **plan,
                             SingeError *error);
void heat_plan_free(Memory *memory, HeatPlan *plan);

/// Sets the pace from the next step on.
void heat_plan_set_pace(HeatPlan *plan, float pace);

/// Scratch memory of the stage, which the caller may use between two calls of heat_step: at least settings.scratch_min
/// bytes.
void *heat_scratch(HeatPlan *plan);

/// The front thickening F used for a sheet (thicken.c).
float heat_thickening(const HeatPlan *plan, uint32_t sheet);

/// Parameters that determine the thickness of a front: means over a sheet.
typedef struct FrontMatter {
    float diffusivity, mass_rate, heating, ignition_temperature, rate_ceiling;
    float pre_exponential, activation_energy;
} FrontMatter;

/// The front thickening for a material's `thickening`, its front and the cell size.
float heat_thickening_for(float thickening, const FrontMatter *front, float ambient_temperature, float cell_size);

typedef struct HeatCounters {
    uint64_t iterations;  ///< of the diffusion's solver
    uint64_t unconverged; ///< steps that ended above the tolerance
    uint64_t bounded;     ///< steps whose temperatures had to be limited to the range of conduction
} HeatCounters;

/// One step; the plan applies its own pace. Reads the other parts of the State, and writes `heat`. Callback sources get
/// context->view. `sources` and context->colliders may be NULL. SINGE_ERROR_DIVERGED with the particle when a
/// temperature is not finite. Adds to *counters.
SingeResult heat_step(HeatPlan *plan, const StepContext *context, HeatState *heat, HeatCounters *counters);

// The gas around a fire: hot air, flames and smoke on a grid.
#pragma once

#include "common/stream.h"
#include "common/pool.h"
#include "shell/shell.h"
#include "singe/sim.h"
#include "world/collider.h"
#include "world/step_context.h"

/// Constant input of the stage.
typedef struct GasSettings {
    SingeGasDef def;
    float gravity[3];          ///< m/s2
    float ambient_temperature; ///< K
    float time_step;           ///< s
    float pace;
    SingeInstructions instructions;
} GasSettings;

/// The grid, its two sets of fields and the scratch of a step.
typedef struct GasPlan GasPlan;

/// Places the grid around the sheets at rest. The arrays of *gas belong to the plan.
SingeResult gas_plan_create(Memory *memory, const Shell *shell, const GasSettings *settings, GasPlan **plan,
                            GasState *gas);
void gas_plan_free(Memory *memory, GasPlan *plan);

/// Passes the fields through a stream, as they cannot be derived from other data.
void gas_plan_stream(GasPlan *plan, GasState *gas, Stream *stream);

/// From the next step on. Gravity must keep the axis along which it is largest.
void gas_plan_set_gravity(GasPlan *plan, const float gravity[3]);
void gas_plan_set_pace(GasPlan *plan, float pace);

/// To be called when a tear has split a vertex.
void gas_plan_torn(GasPlan *plan, uint32_t vertex, uint32_t spare);

/// Called at the end of a step, with the sheets after it; cannot fail. The gas has a step of its own, of about 1/96 s:
/// it moves at every n-th call, and not while nothing is hot.
void gas_step(GasPlan *plan, const StepContext *context, GasState *gas);

/// The last step for readers.
SingeGas gas_view(const GasPlan *plan);

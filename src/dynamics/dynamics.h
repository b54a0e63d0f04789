// Shell dynamics (eq 8 to 15, 18, 19) by strand projection.
#pragma once

#include "common/stream.h"
#include "common/pool.h"
#include "collision/collision.h"
#include "shell/shell.h"
#include "world/step_context.h"
#include "world/wind.h"

typedef struct DynamicsSettings {
    float gravity[3];
    float air_density;
    SingeSolverDef solver; ///< substeps 0: as many as stiffness and load need
    bool plume;            ///< sheets that may tear hang in hot gas: at least as many as that load needs
    SingeContactDef contact;
    float time_step; ///< s
    SingeInstructions instructions;
    int thread_count; ///< max threads at once
} DynamicsSettings;

/// Whether this processor supports the instructions.
bool dynamics_runs_here(SingeInstructions instructions);

/// The set used for `asked`, which this processor supports and which may be SINGE_INSTRUCTIONS_BEST.
SingeInstructions dynamics_instructions(SingeInstructions asked);

/// Scratch of the stage, built once.
typedef struct DynamicsPlan DynamicsPlan;
SingeResult dynamics_plan_create(Memory *memory, const Shell *shell, const DynamicsSettings *settings,
                                 DynamicsPlan **plan);
void dynamics_plan_free(Memory *memory, const Shell *shell, DynamicsPlan *plan);

/// Substeps in a step.
int dynamics_plan_substeps(const DynamicsPlan *plan);

/// The plan's data of earlier steps, as part of a snapshot of this State. SINGE_ERROR_MEMORY when reading; data that
/// does not fit fails the stream.
SingeResult dynamics_plan_stream(Memory *memory, DynamicsPlan *plan, const Shell *shell, const State *state,
                                 Stream *stream);

/// Must be called when the set of pinned particles has changed.
void dynamics_plan_hold(DynamicsPlan *plan, const Shell *shell, const State *state);

/// Forces of a colour's springs in the last step, N/m: force over length, times target over rest length; NULL where
/// sheets cannot tear.
const float *dynamics_pull(const DynamicsPlan *plan, SingeColour colour);

/// Max ratio, in this step, of the distance at which a sheet is held to the length of the sheet there; 1 where unknown.
float dynamics_stretch(const DynamicsPlan *plan, uint32_t sheet);

/// Must be called when a tear has split a vertex.
void dynamics_plan_torn(DynamicsPlan *plan, uint32_t vertex, uint32_t spare);

/// From the next step on.
void dynamics_plan_set_gravity(DynamicsPlan *plan, const float gravity[3]);

/// Must be called when velocities were changed from outside a step.
void dynamics_plan_velocity_changed(DynamicsPlan *plan);

/// Makes room for that many colliders before they are added; false when out of memory.
bool dynamics_plan_reserve(Memory *memory, DynamicsPlan *plan, uint32_t collider_capacity);

/// Counters of contact of sheets so far; zero without it.
CollisionCounters dynamics_plan_contacts(const DynamicsPlan *plan);

/// J, of all springs that give (energy.c).
double dynamics_elastic_energy(const DynamicsPlan *plan, const Shell *shell, const State *state);

/// NULL, or the invariant of the plan that is broken between two steps.
const char *dynamics_plan_validate(const DynamicsPlan *plan);

/// Distance from the cells at each vertex to another part of a sheet ([vertices], m), if it is near, else INFINITY.
void dynamics_plan_clearance(const DynamicsPlan *plan, const Shell *shell, const State *state, float *room);

typedef struct DynamicsCounters {
    uint64_t strands, contacts, springs, iterations;
    double seconds, flops, bytes; ///< of the projection of springs; see SingeTimers
} DynamicsCounters;

/// One step in settings.solver.substeps substeps. Reads the other parts of the State, and writes `dynamics`. Adds to
/// *counters; `memory` is for contact lists that grow. SINGE_ERROR_DIVERGED if a particle is out of bounds; SINGE_ERROR_MEMORY if contact lists cannot grow.
SingeResult dynamics_step(Memory *memory, DynamicsPlan *plan, const StepContext *context, DynamicsState *dynamics,
                          DynamicsCounters *counters);

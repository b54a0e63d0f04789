// A simulation: everything a SingeSim owns. Only src/sim includes this.
#pragma once

#include "ablate/ablate.h"
#include "burn/burn.h"
#include "collision/collision.h"
#include "dynamics/dynamics.h"
#include "gas/gas.h"
#include "heat/heat.h"
#include "surface/render_mesh.h"
#include "tear/tear.h"
#include "sim/recorder.h"

#include <string.h>

struct SingeSim {
    Memory memory;
    SingeSimDef def;
    Pool *pool;
    SingeError error;   ///< of the last failed call
    Recorder *recorder; ///< NULL: nothing is recorded

    // description: fixed once committed
    uint32_t sheet_count, sheet_capacity;
    SheetSource *sheets;
    bool committed;
    Shell shell;
    float *thickening; ///< [sheet_count] F

    // what the sheets interact with
    uint32_t next_generation;
    SourceList sources;
    ColliderList colliders;
    PinList pins;

    // what is drawn in place of sheets
    RenderMesh **render_meshes;
    uint32_t render_mesh_count;
    int32_t render_vertex_count; ///< of all, as they were given

    // the changing part
    State state;
    double heat_start; ///< J, enthalpy at the start
    void *backup;      ///< the state's basic part before the step
    EventList events;
    EventList gathered; ///< of the steps of the last advance
    bool gathers;       ///< the last step was one of an advance
    double remainder;   ///< s that an advance has left for the next
    SingeTimers timers;
    bool intersecting_warned, crossing_warned, crowd_warned; ///< of contact, once each
    bool heat_warned;                                        ///< that the diffusion ran out of iterations
    bool tear_warned;                                        ///< that a sheet ran out of spare vertices

    // plans and scratch of the stages
    HeatPlan *heat;
    AblatePlan *ablate;
    DynamicsPlan *dynamics;
    GasPlan *gas;   ///< NULL without gas
    TearPlan *tear; ///< NULL where sheets cannot tear
    BurnAir air;
    double *partial; ///< [pool_blocks(particles)]
    float *sample;   ///< [blue springs], at least as many as cells: of a statistic
};

/// One step, for singe_sim_step and singe_sim_advance.
SingeResult sim_step(SingeSim *sim);

/// Its recorder; NULL: nothing is recorded. JavaScript cannot give the hook, so that singe.wasm is built without all that
/// writes recordings (SINGE_RECORDING).
static inline Recorder *sim_recorder(const SingeSim *sim) {
#ifdef SINGE_WITHOUT_RECORDING
    (void)sim;
    return NULL;
#else
    return sim->recorder;
#endif
}

/// Makes an empty simulation, without a recorder.
SingeResult sim_make(const SingeSimDef *def, SingeSim **sim, SingeError *error);

/// Stores a failure in sim->error and returns it.
SingeResult sim_fail(SingeSim *sim, SingeResult code, const char *stage, int64_t element, const char *message);

/// Copies the part of a caller's Def that both headers know, which begins with its struct_size, over *def of `size`
/// bytes that holds the defaults. `given_size` bounds what may be read. False when struct_size is unknown.
bool sim_read_def(void *def, size_t size, const void *given, size_t given_size);

/// Fills the caller's `size` bytes from our result; 0 where the caller's is longer.
static inline void sim_write_result(void *result, size_t size, const void *ours, size_t known) {
    memset(result, 0, size);
    memcpy(result, ours, size < known ? size : known);
}

/// The Def of a simulation, of any version. False when struct_size is not set.
bool sim_read_sim_def(const SingeSimDef *given, SingeSimDef *def);

/// Begins the recording that the simulation's Def asks for, if any: of one that was made, or loaded from `bytes`.
SingeResult sim_record(SingeSim *sim, const uint8_t *bytes, size_t size, SingeError *error);

/// Checks the numbers of a simulation's Def.
SingeResult sim_check_def(const SingeSimDef *def, SingeError *error);

/// Input of the stages of a step, with all parts of the State; `view` may be NULL (step.c).
StepContext sim_context(SingeSim *sim, const SingeView *view);

/// Everything commit builds from sim->sheets, without the first state (also used by load).
SingeResult sim_build(SingeSim *sim);

/// Logs what was committed, and warns of what will look bad.
void sim_log_commit(const SingeSim *sim);
/// Logs once that conduction is less exact than requested.
void sim_log_unconverged(SingeSim *sim);
/// Logs triangles of a render mesh that are not drawn, and edges that `singe verify` counts as faults.
void sim_log_render_mesh(const SingeSim *sim, uint32_t sheet, uint32_t left_out, uint32_t odd_edges);
/// Logs that a pin's point lies off its sheet.
void sim_log_missed(const SingeSim *sim, uint32_t pin, uint32_t sheet, const float *point, float distance);
/// Logs that a collider's mesh was inside out.
void sim_log_turned(const SingeSim *sim, uint32_t collider);
/// Logs once that a sheet has no spare vertices left for tears.
void sim_log_short_of_spares(SingeSim *sim);

/// Logs each of these once: cells that intersect from the start, pairs that could not be kept apart, lists that were
/// full.
void sim_log_contacts(SingeSim *sim, const CollisionCounters *contacts);

/// Logs colliders deep inside which sheets begin.
void sim_find_buried(const SingeSim *sim);
/// Logs one of them, `depth` m deep at `position`.
void sim_log_buried(const SingeSim *sim, uint32_t collider, double share, float depth, Float3 position);

/// Enthalpy above ambient of the remaining particles, J, sum of capacity (T - T_amb).
double sim_enthalpy(const SingeSim *sim);

/// Evaluates the textures and gathers the particles of objects added before the commit, which keep waiting after a
/// failure.
SingeResult sim_settle_objects(SingeSim *sim);

/// Copies callbacks and user data from one simulation to another with the same objects.
void sim_copy_hooks(const SingeSim *from, SingeSim *to);

void sim_free_source(SingeSim *sim, Source *source);
void sim_free_pin(SingeSim *sim, Pin *pin);
/// After a step, as nothing can fail then: lets go of pins whose end has come.
void sim_end_pins(SingeSim *sim);

/// Free slot of a list of `size`-byte items that begin with their generation; the item is zeroed and its
/// generation left 0. One at the list's end is part of it once the count is (sim_take_slot). NULL when out of memory.
void *sim_slot(SingeSim *sim, void *items_pointer, uint32_t *count, uint32_t *capacity, size_t size, uint32_t *index);

/// Gives a slot's object a generation; returns it.
static inline uint32_t sim_take_slot(SingeSim *sim, uint32_t *count, uint32_t index) {
    if (*count == index) ++*count;
    return sim->next_generation++;
}

// The public calls that change a simulation, one for each row of calls.def: recorded where a recording is asked for, then
// made by src/sim's own function.
#include "sim/calls.h"

#include "sim/objects.h"

static void tape_asked(Tape *tape, const void *result) {
    bool asked = result != NULL;
    tape_bool(tape, &asked);
}

/// 3 * count floats, behind their count.
static void tape_points(Tape *tape, uint32_t count, const float *points) {
    TAPE(tape, count);
    tape_array(tape, &points, 3 * (uint64_t)count, sizeof(float));
}

uint32_t call_collider_points(const SingeSim *sim, SingeColliderId id) {
    const Collider *collider = OBJECT_FIND(sim->colliders, id);
    return collider && collider->def.kind == SINGE_COLLIDER_DEFORMING ? collider->deform.motion.count : 0;
}

uint32_t call_pin_points(const SingeSim *sim, SingePinId id) {
    const Pin *pin = OBJECT_FIND(sim->pins, id);
    return pin ? pin->count : 0;
}

/// The vertices of a sheet's mesh; 0 for a stale handle.
static uint32_t sheet_vertices(const SingeSim *sim, SingeSheetId id) {
    return id.generation == 1 && id.index < sim->sheet_count ? sim->sheets[id.index].sheet.vertex_count : 0;
}

/// Velocities that the call reads: none if the sheet has not as many vertices.
static const float *velocities_read(const SingeSim *sim, SingeSheetId id, uint32_t first, uint32_t count,
                                    const float *velocities) {
    if (!sim->committed || !sheet_vertices(sim, id)) return NULL;
    const uint32_t room = sim->shell.sheets[id.index].vertex_count;
    return count <= room && first <= room - count ? velocities : NULL;
}

// ---- what a recording holds of each kind of arguments

#define ARGUMENTS_NOTHING
#define WRITE_NOTHING

#define ARGUMENTS_DEF(Type, name) , def
#define WRITE_DEF(Type, name) \
    Singe##Type##Def whole;   \
    tape_##name##_def(tape, def, &whole);
#define ARGUMENTS_PIN_DEF ARGUMENTS_DEF(Pin, pin)
#define WRITE_PIN_DEF WRITE_DEF(Pin, pin)
#define ARGUMENTS_NEW(Type) , made
#define WRITE_NEW(Type) tape_asked(tape, made);
#define ARGUMENTS_HANDLE(Type, name) , id
#define WRITE_HANDLE(Type, name) \
    TAPE(tape, id.index);        \
    TAPE(tape, id.generation);
#define ARGUMENTS_CALLBACK , callback, context
#define WRITE_CALLBACK              \
    bool called = callback != NULL; \
    (void)context;                  \
    tape_bool(tape, &called);
#define ARGUMENTS_COLLIDER_VERTICES , points
#define WRITE_COLLIDER_VERTICES tape_points(tape, call_collider_points(sim, id), points);
#define ARGUMENTS_PIN_POSITIONS , points
#define WRITE_PIN_POSITIONS tape_points(tape, call_pin_points(sim, id), points);
#define ARGUMENTS_PATH , path_count, path
#define WRITE_PATH tape_path(tape, &path_count, &path);
#define ARGUMENTS_GRAVITY , gravity
#define WRITE_GRAVITY tape_data(tape, (float *)(uintptr_t)gravity, 3, sizeof *gravity);
#define ARGUMENTS_NUMBER , number
#define WRITE_NUMBER TAPE(tape, number);
#define ARGUMENTS_SECONDS , seconds
#define WRITE_SECONDS TAPE(tape, seconds);
#define ARGUMENTS_VELOCITIES , first, count, velocities
#define WRITE_VELOCITIES \
    TAPE(tape, first);   \
    tape_points(tape, count, velocities_read(sim, id, first, count, velocities));
#define ARGUMENTS_SHARE , share
#define WRITE_SHARE                           \
    uint32_t count = sheet_vertices(sim, id); \
    const float *read = count ? share : NULL; \
    TAPE(tape, count);                        \
    tape_array(tape, &read, count, sizeof *share);
#define ARGUMENTS_STEPS , steps_max, steps
#define WRITE_STEPS        \
    TAPE(tape, steps_max); \
    tape_asked(tape, steps);
#define ARGUMENTS_SURFACE , surface, struct_size
#define WRITE_SURFACE            \
    uint64_t size = struct_size; \
    (void)surface;               \
    TAPE(tape, size);
#define ARGUMENTS_SNAPSHOT , bytes, size
#define WRITE_SNAPSHOT (void)bytes, (void)size;
#define ARGUMENTS_COPY , copy
#define WRITE_COPY (void)copy;

// Answers besides the result: two numbers.
#define FIRST_NOTHING 0
#define SECOND_NOTHING 0
#define FIRST_SECONDS 0
#define SECOND_SECONDS 0
#define FIRST_SHARE 0
#define SECOND_SHARE 0
#define FIRST_SURFACE 0
#define SECOND_SURFACE 0
#define FIRST_SNAPSHOT 0
#define SECOND_SNAPSHOT 0
#define FIRST_COPY 0
#define SECOND_COPY 0
#define FIRST_NEW(Type) made ? made->index : 0
#define SECOND_NEW(Type) made ? made->generation : 0
#define FIRST_STEPS steps ? *steps : 0
#define SECOND_STEPS 0

#define SINGE_CALL(number, name, A, B, C)                                                                          \
    static void write_##name(Tape *tape, SingeSim *sim PARAMETERS_##A PARAMETERS_##B PARAMETERS_##C) {             \
        (void)tape, (void)sim;                                                                                     \
        WRITE_##A WRITE_##B WRITE_##C                                                                              \
    }                                                                                                              \
    SingeResult singe_sim_##name(SingeSim *sim PARAMETERS_##A PARAMETERS_##B PARAMETERS_##C) {                     \
        if (!sim_recorder(sim)) return call_##name(sim ARGUMENTS_##A ARGUMENTS_##B ARGUMENTS_##C);                 \
        RECORD(sim->recorder, number, tape) { write_##name(tape, sim ARGUMENTS_##A ARGUMENTS_##B ARGUMENTS_##C); } \
        recorder_flush(sim->recorder);                                                                             \
        SingeResult result = call_##name(sim ARGUMENTS_##A ARGUMENTS_##B ARGUMENTS_##C);                           \
        return recorder_result(sim->recorder, result, FIRST_##C, SECOND_##C);                                      \
    }
#include "sim/calls.def"

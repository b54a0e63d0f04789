// Save, load and clone. One function walks all parts of a simulation, measuring, writing or reading; the shell and the
// plans are rebuilt from the sheets, which gives the same ones.
//
// Layout: SnapshotHeader, then the body that snapshot_body walks. Numbers are in the machine's byte order. Defs are
// stored field by field (snapshot_def.c): their padding and pointers differ from run to run. The checksum finds damage,
// not malice: data read back must pass the checks of the public functions, and a State those of what steps can leave
// (snapshot_check.c).
#include "shell/split.h"
#include "sim/calls.h"
#include "sim/snapshot_check.h"
#include "sim/snapshot_def.h"
#include "sim/snapshot_objects.h"

#include <string.h>

enum { SNAPSHOT_VERSION = 13 };

typedef struct SnapshotHeader {
    char magic[8];           ///< "SINGESIM"
    uint32_t version, order; ///< order reads 0x01020304 on a machine of the same byte order
    uint64_t size, checksum; ///< of the body
    uint32_t sizes[4];       ///< of structs in the body: another build's layout is refused
    uint32_t reserved[2];    ///< 0
} SnapshotHeader;
_Static_assert(sizeof(SnapshotHeader) == 56, "a snapshot begins with these bytes, without padding");
_Static_assert(sizeof(SingePoseKey) == 32 && sizeof(SingeValueKey) == 8, "snapshots hold keys as they are");

static SnapshotHeader snapshot_header(const uint8_t *body, size_t size) {
    SnapshotHeader header = {.version = SNAPSHOT_VERSION,
                             .order = 0x01020304u,
                             .size = size,
                             .sizes = {sizeof(SingePoseKey), sizeof(SingeValueKey), PARAM_COUNT, SINGE_COLOUR_COUNT}};
    memcpy(header.magic, "SINGESIM", 8);
    header.checksum = stream_checksum(body, size);
    return header;
}

static SingeResult snapshot_state(Stream *stream, SingeSim *sim) {
    State *state = &sim->state;
    STREAM(stream, state->time);
    STREAM(stream, state->step);
    STREAM(stream, state->heat.heat_in);
    STREAM(stream, state->heat.heat_lost);
    STREAM(stream, state->heat.heat_of_combustion);
    STREAM(stream, state->burn.mass_burnt);
    STREAM(stream, state->dynamics.earlier_time);
    STREAM(stream, state->ablate.next_piece);
    STREAM(stream, state->ablate.piece_count);
    STREAM(stream, state->ablate.topology_version);
    STREAM(stream, state->ablate.heat_removed);
    STREAM(stream, state->ablate.mass_removed);
    STREAM(stream, state->tear.split_count);
    STREAM(stream, sim->heat_start);

    // the arena
    uint64_t size = state->saved_size;
    STREAM(stream, size);
    stream->failed |= size != state->saved_size;
    stream_data(stream, state->arena, state->saved_size);

    // tears change the Shell: repeat them
    if (stream->mode == STREAM_READ && !stream->failed) // the shell is as built: it tears again in the same order
        stream->failed = state->tear.split_count > sim->shell.spare_count ||
                         !split_replay(&sim->shell, state->tear.splits, state->tear.split_count) ||
                         !snapshot_state_fits(sim);
    if (stream->failed) return SINGE_OK; // the caller reports it

    // plans with data of their own
    SingeResult result = dynamics_plan_stream(&sim->memory, sim->dynamics, &sim->shell, state, stream);
    if (sim->gas) gas_plan_stream(sim->gas, &sim->state.gas, stream);
    return result;
}

/// Parts that most simulations do not have come last, and only if there are any: a word of flags, then the parts.
static bool snapshot_more(Stream *stream, SingeSim *sim) {
    enum { MORE_REMAINDER = 1, MORE_PINS = 2, MORE_ENDS = 4, MORE_ALL = 7 };
    bool followed = false, ending = false;
    for (uint32_t i = 0; i < sim->pins.count; i++) {
        followed |= sim->pins.items[i].motion.to != NULL;
        ending |= sim->pins.items[i].generation && sim->pins.items[i].end < INFINITY;
    }

    uint32_t more = (sim->remainder != 0 ? MORE_REMAINDER : 0) | (followed ? MORE_PINS : 0) | (ending ? MORE_ENDS : 0);
    if (stream->mode == STREAM_READ ? stream->offset == stream->size : !more) return true;
    STREAM(stream, more);
    if (!snapshot_held(stream, more != 0 && (more & ~(uint32_t)MORE_ALL) == 0)) return false;
    if (more & MORE_REMAINDER) STREAM(stream, sim->remainder);
    if (!snapshot_held(stream, !(more & MORE_REMAINDER) || snapshot_remainder_fits(sim))) return false;

    // for each pin when it ends, then whether it follows positions, and these positions
    for (uint32_t i = 0; i < sim->pins.count && more & MORE_ENDS; i++) {
        Pin *pin = &sim->pins.items[i];
        STREAM(stream, pin->end);
        if (!snapshot_held(stream, pin->generation == 0 || pin->end >= 0)) return false;
    }

    for (uint32_t i = 0; i < sim->pins.count && more & MORE_PINS; i++) {
        Pin *pin = &sim->pins.items[i];
        uint8_t follows = pin->motion.to != NULL;
        STREAM(stream, follows);
        if (!snapshot_held(stream, follows <= (pin->generation != 0 && pin->count > 0))) return false;
        if (follows && !snapshot_motion(stream, &sim->memory, pin->count, &pin->motion)) return false;
    }

    return true;
}

/// Walks the whole body. When reading, builds the shell once the sheets are there.
static SingeResult snapshot_body(Stream *stream, SingeSim *sim) {
    snapshot_sim_def(stream, &sim->def);
    stream->failed |= stream->mode == STREAM_READ && sim_check_def(&sim->def, NULL) != SINGE_OK;
    bool ok = !stream->failed && snapshot_sheets(stream, sim);
    if (ok && stream->mode == STREAM_READ) {
        SingeResult result = sim_build(sim);
        if (result == SINGE_ERROR_MEMORY) return result;
        stream->failed = result != SINGE_OK;
        ok = !stream->failed;
    }

    ok = ok && snapshot_objects(stream, sim);
    if (ok && stream->mode == STREAM_READ)
        ok = dynamics_plan_reserve(&sim->memory, sim->dynamics, sim->colliders.count);
    ok = ok && snapshot_state(stream, sim) == SINGE_OK && snapshot_more(stream, sim);
    stream->failed |= ok && stream->mode == STREAM_READ && stream->offset != stream->size;
    if (stream->failed)
        return sim_fail(sim, SINGE_ERROR_FORMAT, "load", (int64_t)stream->offset,
                        "the snapshot is truncated or inconsistent");

    return ok ? SINGE_OK : sim_fail(sim, SINGE_ERROR_MEMORY, "load", -1, "out of memory");
}

SingeResult call_save(SingeSim *sim, uint8_t **bytes, size_t *size) {
    *bytes = NULL;
    *size = 0;
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "save", -1, "singe_sim_commit must come before a save");

    Stream measure = {.mode = STREAM_MEASURE};
    TRY(snapshot_body(&measure, sim));
    size_t total = sizeof(SnapshotHeader) + measure.offset;
    uint8_t *block = memory_new(&sim->memory, total, 1);
    if (!block) return sim_fail(sim, SINGE_ERROR_MEMORY, "save", -1, "out of memory");

    Stream write = {.mode = STREAM_WRITE, .bytes = block + sizeof(SnapshotHeader), .size = measure.offset};
    SingeResult result = snapshot_body(&write, sim);
    if (result) {
        memory_free(&sim->memory, (void *)&block, total, 1);
        return result;
    }

    SnapshotHeader header = snapshot_header(write.bytes, write.size);
    memcpy(block, &header, sizeof header);
    *bytes = block;
    *size = total;
    return SINGE_OK;
}

void singe_sim_free_bytes(SingeSim *sim, uint8_t *bytes, size_t size) {
    memory_free(&sim->memory, (void *)&bytes, size, 1);
}

SingeResult singe_sim_load(const SingeSimDef *hooks, const uint8_t *bytes, size_t size, SingeSim **out,
                           SingeError *error) {
    *out = NULL;
    SnapshotHeader header;
    if (size < sizeof header) return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "too short for a snapshot");

    memcpy(&header, bytes, sizeof header);
    SnapshotHeader expected = snapshot_header(bytes + sizeof header, size - sizeof header);
    if (memcmp(header.magic, expected.magic, sizeof header.magic))
        return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "not a snapshot");
    if (header.version != expected.version || header.order != expected.order ||
        memcmp(header.sizes, expected.sizes, sizeof header.sizes + sizeof header.reserved))
        return error_set(error, SINGE_ERROR_VERSION, "load", 0,
                         "the snapshot is from another version or another kind of machine");
    if (header.size != expected.size)
        return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "the snapshot is truncated");
    if (header.checksum != expected.checksum)
        return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "the snapshot is damaged: wrong checksum");

    SingeSim *sim;
    TRY(sim_make(hooks, &sim, error));

    // the stream only reads: the cast does not drop constness in effect
    Stream read = {.mode = STREAM_READ,
                   .bytes = (uint8_t *)(uintptr_t)(bytes + sizeof(SnapshotHeader)),
                   .size = size - sizeof(SnapshotHeader)};
    SingeResult result = snapshot_body(&read, sim);
    if (result && error) *error = sim->error;
    if (!result) result = sim_record(sim, bytes, size, error);

    if (result) {
        singe_sim_destroy(sim);
        return result;
    }

    sim->committed = true;
    *out = sim;
    return SINGE_OK;
}

SingeResult call_clone(SingeSim *sim, SingeSim **copy) {
    *copy = NULL;
    uint8_t *bytes;
    size_t size;
    SingeSimDef hooks = sim->def;
    hooks.record = (SingeRecord){0};
    TRY(call_save(sim, &bytes, &size));
    SingeResult result = singe_sim_load(&hooks, bytes, size, copy, &sim->error);
    singe_sim_free_bytes(sim, bytes, size);
    if (result) return result;

    sim_copy_hooks(sim, *copy);
    return SINGE_OK;
}

// Save, load and clone. One function walks everything that makes up a simulation, measuring, writing or
// reading; the shell and the plans are built again from the sheets, which gives the same ones.
//
// Layout: SnapshotHeader, then the body that snapshot_body walks. Numbers are in the machine's order. Defs
// go field by field (snapshot_def.c): their padding and pointers differ from run to run. The checksum finds
// damage, and no malice: what is read is held against the checks that calls of the public functions pass, and a State
// against what steps can leave (snapshot_check.c).
#include "shell/split.h"
#include "sim/snapshot_check.h"
#include "sim/snapshot_def.h"

#include <string.h>

enum { SNAPSHOT_VERSION = 8 };

typedef struct SnapshotHeader {
    char magic[8];           ///< "SINGESIM"
    uint32_t version, order; ///< order reads 0x01020304 on a machine of the same byte order
    uint64_t size, checksum; ///< of the body
    uint32_t sizes[4];       ///< of what the body is made of: another build's layout is refused
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

static size_t snapshot_left(const Stream *stream) { return stream->size - stream->offset; }

/// An array of *count elements; when reading, allocates it. False when out of memory or bytes.
static bool snapshot_array(Stream *stream, Memory *memory, void *array_pointer, size_t count, size_t element_size) {
    void *array = NULL;
    if (stream->mode == STREAM_READ) {
        if (element_size && count > snapshot_left(stream) / element_size) {
            stream->failed = true;
            return false;
        }
        if (!(array = memory_new(memory, count, element_size))) return false;
        memcpy(array_pointer, &array, sizeof array);
    }
    memcpy(&array, array_pointer, sizeof array);
    stream_data(stream, array, count * element_size);
    return !stream->failed;
}

/// Fails the stream where something was read that a check refuses. Returns whether the stream is still good.
static bool snapshot_held(Stream *stream, bool good) {
    if (stream->mode == STREAM_READ && !good) stream->failed = true;
    return !stream->failed;
}

static bool snapshot_path(Stream *stream, Memory *memory, Path *path) {
    STREAM(stream, path->count);
    return snapshot_array(stream, memory, &path->keys, path->count, sizeof *path->keys) &&
           snapshot_held(stream, path_check(path->count, path->keys, "load", NULL) == SINGE_OK && path_is_normal(path));
}

static bool snapshot_sheet(Stream *stream, Memory *memory, SheetSource *source) {
    snapshot_sheet_def(stream, &source->sheet);
    uint32_t vertices = source->sheet.vertex_count, cells = source->sheet.cell_count;
    if (!snapshot_array(stream, memory, &source->position, vertices, sizeof *source->position) ||
        !snapshot_array(stream, memory, &source->cells, cells, sizeof *source->cells) ||
        !snapshot_array(stream, memory, &source->uv, vertices, sizeof *source->uv))
        return false;
    uint8_t seams = source->corner_uv != NULL, numbered = source->source_vertex != NULL;
    uint8_t corners = source->corner_source != NULL;
    STREAM(stream, corners);
    STREAM(stream, seams);
    STREAM(stream, numbered);
    if ((seams && !snapshot_array(stream, memory, &source->corner_uv, cells, sizeof *source->corner_uv)) ||
        (corners && !snapshot_array(stream, memory, &source->corner_source, cells, sizeof *source->corner_source)) ||
        (numbered && !snapshot_array(stream, memory, &source->source_vertex, vertices, sizeof *source->source_vertex)))
        return false;
    for (int p = 0; p < PARAM_COUNT; p++) {
        uint8_t varies = source->values[p] != NULL;
        STREAM(stream, source->value[p]);
        STREAM(stream, varies);
        if (varies && !snapshot_array(stream, memory, &source->values[p], (size_t)vertices + cells, sizeof(float)))
            return false;
    }
    return snapshot_held(stream, sheet_source_check(source, NULL) == SINGE_OK);
}

static bool snapshot_sheets(Stream *stream, SingeSim *sim) {
    uint32_t count = sim->sheet_count;
    STREAM(stream, count);
    if (stream->mode == STREAM_READ) {
        size_t max = snapshot_left(stream) / sizeof sim->sheets->sheet.name;
        stream->failed |= count == 0 || count > UINT16_MAX || count > max;
        if (stream->failed || !NEW(&sim->memory, sim->sheets, count)) return false;
        sim->sheet_count = sim->sheet_capacity = count;
    }
    for (uint32_t i = 0; i < count; i++)
        if (!snapshot_sheet(stream, &sim->memory, &sim->sheets[i])) return false;
    return true;
}

/// Reads a list's length and makes room for it.
static bool snapshot_list(Stream *stream, Memory *memory, uint32_t *count, uint32_t *capacity, void *items_pointer,
                          size_t size) {
    STREAM(stream, *count);
    if (stream->mode != STREAM_READ) return true;
    if (stream->failed || *count > snapshot_left(stream) / sizeof(uint32_t)) { // each begins with its generation
        stream->failed = true;
        *count = 0;
        return false;
    }
    void *items = memory_new(memory, *count, size);
    memcpy(items_pointer, &items, sizeof items);
    if (!items) *count = 0;
    *capacity = *count;
    return items != NULL;
}

static bool snapshot_source(Stream *stream, SingeSim *sim, Source *source) {
    uint8_t has_texture = source->texture != NULL;
    STREAM(stream, source->generation);
    if (source->generation == 0) return !stream->failed; // a free slot holds nothing
    snapshot_source_def(stream, &source->def);
    STREAM(stream, has_texture);
    STREAM(stream, source->strength_count);
    return snapshot_path(stream, &sim->memory, &source->path) &&
           snapshot_array(stream, &sim->memory, &source->strength, source->strength_count, sizeof *source->strength) &&
           (!has_texture || snapshot_array(stream, &sim->memory, &source->texture, sim->shell.particle_count,
                                           sizeof *source->texture)) &&
           snapshot_held(stream, source_check_read(&sim->shell, source, NULL) == SINGE_OK);
}

/// A mesh as its solid has it; the rest follows from it.
static bool snapshot_mesh(Stream *stream, Memory *memory, MeshSolid *mesh) {
    MeshSolid saved = *mesh;
    STREAM(stream, saved.vertex_count);
    STREAM(stream, saved.triangle_count);
    bool ok = snapshot_array(stream, memory, &saved.vertices, saved.vertex_count, sizeof *saved.vertices) &&
              snapshot_array(stream, memory, &saved.triangles, saved.triangle_count, sizeof *saved.triangles);
    if (stream->mode != STREAM_READ) return ok;
    SingeResult result = ok ? mesh_solid_create(memory, saved.vertex_count, saved.vertices[0], saved.triangle_count,
                                                saved.triangles[0], mesh, NULL)
                            : SINGE_OK;
    if (saved.vertices) FREE(memory, saved.vertices, saved.vertex_count);
    if (saved.triangles) FREE(memory, saved.triangles, saved.triangle_count);
    stream->failed |= result != SINGE_OK && result != SINGE_ERROR_MEMORY;
    return ok && result == SINGE_OK;
}

static bool snapshot_motion(Stream *stream, Memory *memory, uint32_t count, Motion *motion) {
    motion->count = count;
    STREAM(stream, motion->start);
    STREAM(stream, motion->end);
    if (!snapshot_array(stream, memory, &motion->from, count, sizeof *motion->from) ||
        !snapshot_array(stream, memory, &motion->to, count, sizeof *motion->to))
        return false;
    return snapshot_held(stream, snapshot_motion_fits(motion));
}

/// A deforming mesh as it was given, and its motion.
static bool snapshot_deform(Stream *stream, Memory *memory, Deform *deform) {
    if (stream->mode != STREAM_READ) {
        MeshSolid given = *deform_solid(deform);
        given.vertices = deform->rest;
        return snapshot_mesh(stream, memory, &given) &&
               snapshot_motion(stream, memory, given.vertex_count, &deform->motion);
    }
    MeshSolid given = {0};
    Motion motion = {0};
    bool ok = snapshot_mesh(stream, memory, &given) && snapshot_motion(stream, memory, given.vertex_count, &motion);
    SingeResult result = ok ? deform_create(memory, given.vertex_count, given.vertices[0], given.triangle_count,
                                            given.triangles[0], deform, NULL)
                            : SINGE_OK;
    mesh_solid_free(memory, &given);
    if (ok && !result) {
        motion_free(memory, &deform->motion);
        deform->motion = motion;
    } else {
        motion_free(memory, &motion);
    }
    stream->failed |= result != SINGE_OK && result != SINGE_ERROR_MEMORY;
    return ok && !result;
}

static bool snapshot_heights(Stream *stream, Memory *memory, const SingeColliderDef *def, HeightSolid *heights) {
    float *saved = heights->heights;
    size_t count = (size_t)def->columns * def->rows;
    bool ok = snapshot_array(stream, memory, &saved, count, sizeof *saved);
    if (stream->mode != STREAM_READ || !ok) return ok;
    SingeResult result = height_solid_create(memory, def->columns, def->rows, saved, def->size, heights, NULL);
    FREE(memory, saved, count);
    stream->failed |= result != SINGE_OK && result != SINGE_ERROR_MEMORY;
    return result == SINGE_OK;
}

static bool snapshot_collider(Stream *stream, SingeSim *sim, Collider *collider) {
    STREAM(stream, collider->generation);
    if (collider->generation == 0) return !stream->failed;
    snapshot_collider_def(stream, &collider->def);
    if (stream->failed || !snapshot_path(stream, &sim->memory, &collider->path)) return false;
    SingeColliderDef def = collider->def;
    def.path_count = collider->path.count; // it may have been given another one
    if (!snapshot_held(stream, def.path_count > 0 && collider_check(&def, NULL) == SINGE_OK)) return false;
    if (collider->def.kind == SINGE_COLLIDER_MESH) return snapshot_mesh(stream, &sim->memory, &collider->mesh);
    if (collider->def.kind == SINGE_COLLIDER_DEFORMING) return snapshot_deform(stream, &sim->memory, &collider->deform);
    if (collider->def.kind == SINGE_COLLIDER_HEIGHTFIELD)
        return snapshot_heights(stream, &sim->memory, &collider->def, &collider->heights);
    return true;
}

static bool snapshot_pin(Stream *stream, SingeSim *sim, Pin *pin) {
    STREAM(stream, pin->generation);
    if (pin->generation == 0) return !stream->failed;
    STREAM(stream, pin->count);
    if (!snapshot_array(stream, &sim->memory, &pin->particles, pin->count, sizeof *pin->particles) ||
        !snapshot_array(stream, &sim->memory, &pin->anchors, pin->count, sizeof *pin->anchors) ||
        !snapshot_path(stream, &sim->memory, &pin->path))
        return false;
    return snapshot_held(stream, snapshot_pin_fits(&sim->shell, pin));
}

static bool snapshot_objects(Stream *stream, SingeSim *sim) {
    STREAM(stream, sim->next_generation);
    Memory *memory = &sim->memory;
    if (!snapshot_list(stream, memory, &sim->sources.count, &sim->sources.capacity, &sim->sources.items,
                       sizeof *sim->sources.items))
        return false;
    for (uint32_t i = 0; i < sim->sources.count; i++)
        if (!snapshot_source(stream, sim, &sim->sources.items[i])) return false;
    if (!snapshot_list(stream, memory, &sim->colliders.count, &sim->colliders.capacity, &sim->colliders.items,
                       sizeof *sim->colliders.items))
        return false;
    for (uint32_t i = 0; i < sim->colliders.count; i++)
        if (!snapshot_collider(stream, sim, &sim->colliders.items[i])) return false;
    if (!snapshot_list(stream, memory, &sim->pins.count, &sim->pins.capacity, &sim->pins.items,
                       sizeof *sim->pins.items))
        return false;
    for (uint32_t i = 0; i < sim->pins.count; i++)
        if (!snapshot_pin(stream, sim, &sim->pins.items[i])) return false;
    return snapshot_held(stream, snapshot_generations_fit(sim));
}

static SingeResult snapshot_state(Stream *stream, SingeSim *sim) {
    State *state = &sim->state;
    STREAM(stream, state->time);
    STREAM(stream, state->step);
    STREAM(stream, state->heat.heat_in);
    STREAM(stream, state->heat.heat_lost);
    STREAM(stream, state->heat.heat_of_combustion);
    STREAM(stream, state->burn.mass_burnt);
    STREAM(stream, state->ablate.next_piece);
    STREAM(stream, state->ablate.piece_count);
    STREAM(stream, state->ablate.topology_version);
    STREAM(stream, state->ablate.heat_removed);
    STREAM(stream, state->ablate.mass_removed);
    STREAM(stream, state->tear.split_count);
    STREAM(stream, sim->heat_start);
    uint64_t size = state->arena_size;
    STREAM(stream, size);
    stream->failed |= size != state->arena_size;
    stream_data(stream, state->arena, state->arena_size);
    if (stream->mode == STREAM_READ && !stream->failed) // the shell is as built: it tears again as it did
        stream->failed = state->tear.split_count > sim->shell.spare_count ||
                         !split_replay(&sim->shell, state->tear.splits, state->tear.split_count) ||
                         !snapshot_state_fits(sim);
    if (stream->failed) return SINGE_OK; // the caller tells
    SingeResult result = dynamics_plan_stream(sim->dynamics, &sim->shell, state, stream);
    if (sim->gas) gas_plan_stream(sim->gas, &sim->state.gas, stream);
    return result;
}

/// Of each pin, whether it follows positions, and those.
static bool snapshot_pin_motions(Stream *stream, SingeSim *sim) {
    for (uint32_t i = 0; i < sim->pins.count; i++) {
        Pin *pin = &sim->pins.items[i];
        uint8_t follows = pin->motion.to != NULL;
        STREAM(stream, follows);
        if (!snapshot_held(stream, follows <= (pin->generation != 0 && pin->count > 0))) return false;
        if (follows && !snapshot_motion(stream, &sim->memory, pin->count, &pin->motion)) return false;
    }
    return true;
}

static bool snapshot_follows(const SingeSim *sim) {
    for (uint32_t i = 0; i < sim->pins.count; i++)
        if (sim->pins.items[i].motion.to) return true;
    return false;
}

/// What most simulations have nothing of comes last, and only where there is something: a word that says what, and
/// that.
static bool snapshot_more(Stream *stream, SingeSim *sim) {
    enum { MORE_REMAINDER = 1, MORE_PINS = 2, MORE_ALL = 3 };
    uint32_t more = (sim->remainder != 0 ? MORE_REMAINDER : 0) | (snapshot_follows(sim) ? MORE_PINS : 0);
    if (stream->mode == STREAM_READ ? stream->offset == stream->size : !more) return true;
    STREAM(stream, more);
    if (!snapshot_held(stream, more != 0 && (more & ~(uint32_t)MORE_ALL) == 0)) return false;
    if (more & MORE_REMAINDER) STREAM(stream, sim->remainder);
    if (!snapshot_held(stream, !(more & MORE_REMAINDER) || snapshot_remainder_fits(sim))) return false;
    return !(more & MORE_PINS) || snapshot_pin_motions(stream, sim);
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
                        "the snapshot ends too soon or does not fit together");
    return ok ? SINGE_OK : sim_fail(sim, SINGE_ERROR_MEMORY, "load", -1, "out of memory");
}

SingeResult singe_sim_save(SingeSim *sim, uint8_t **bytes, size_t *size) {
    *bytes = NULL, *size = 0;
    if (!sim->committed) return sim_fail(sim, SINGE_ERROR_STATE, "save", -1, "singe_sim_commit comes before a save");
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
    *bytes = block, *size = total;
    return SINGE_OK;
}

void singe_sim_free_bytes(SingeSim *sim, uint8_t *bytes, size_t size) {
    memory_free(&sim->memory, (void *)&bytes, size, 1);
}

static SingeResult snapshot_check(const uint8_t *bytes, size_t size, SingeError *error) {
    SnapshotHeader header;
    if (size < sizeof header) return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "too short for a snapshot");
    memcpy(&header, bytes, sizeof header);
    SnapshotHeader expected = snapshot_header(bytes + sizeof header, size - sizeof header);
    if (memcmp(header.magic, expected.magic, sizeof header.magic))
        return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "not a snapshot");
    if (header.version != expected.version || header.order != expected.order ||
        memcmp(header.sizes, expected.sizes, sizeof header.sizes + sizeof header.reserved))
        return error_set(error, SINGE_ERROR_VERSION, "load", 0,
                         "the snapshot is of another version or another kind of machine");
    if (header.size != expected.size)
        return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "the snapshot is cut short");
    if (header.checksum != expected.checksum)
        return error_set(error, SINGE_ERROR_FORMAT, "load", 0, "the snapshot is damaged: wrong checksum");
    return SINGE_OK;
}

SingeResult singe_sim_load(const SingeSimDef *hooks, const uint8_t *bytes, size_t size, SingeSim **out,
                           SingeError *error) {
    *out = NULL;
    TRY(snapshot_check(bytes, size, error));
    SingeSim *sim;
    TRY(singe_sim_create(hooks, &sim, error));
    // the stream only reads: the cast takes nothing's constness away in fact
    Stream read = {.mode = STREAM_READ,
                   .bytes = (uint8_t *)(uintptr_t)(bytes + sizeof(SnapshotHeader)),
                   .size = size - sizeof(SnapshotHeader)};
    SingeResult result = snapshot_body(&read, sim);
    if (result) {
        if (error) *error = sim->error;
        singe_sim_destroy(sim);
        return result;
    }
    sim->committed = true;
    *out = sim;
    return SINGE_OK;
}

SingeResult singe_sim_clone(SingeSim *sim, SingeSim **copy) {
    *copy = NULL;
    uint8_t *bytes;
    size_t size;
    TRY(singe_sim_save(sim, &bytes, &size));
    SingeResult result = singe_sim_load(&sim->def, bytes, size, copy, &sim->error);
    singe_sim_free_bytes(sim, bytes, size);
    if (result) return result;
    sim_copy_hooks(sim, *copy);
    return SINGE_OK;
}

// Sheets, sources, colliders and pins in a snapshot. Data read back passes the checks of the calls that make them.
#include "sim/snapshot_objects.h"

#include "sim/snapshot_check.h"
#include "common/def_table.h"
#include "sim/snapshot_def.h"

#include <string.h>

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

bool snapshot_held(Stream *stream, bool good) {
    if (stream->mode == STREAM_READ && !good) stream->failed = true;
    return !stream->failed;
}

static bool snapshot_path(Stream *stream, Memory *memory, Path *path) {
    STREAM(stream, path->count);
    return snapshot_array(stream, memory, &path->keys, path->count, sizeof *path->keys) &&
           snapshot_held(stream, path_check(path->count, path->keys, "load", NULL) == SINGE_OK && path_is_normal(path));
}

bool snapshot_sheets(Stream *stream, SingeSim *sim) {
    Memory *memory = &sim->memory;
    uint32_t count = sim->sheet_count;
    STREAM(stream, count);

    if (stream->mode == STREAM_READ) {
        size_t max = snapshot_left(stream) / sizeof sim->sheets->sheet.name;
        stream->failed |= count == 0 || count > UINT16_MAX || count > max;
        if (stream->failed || !NEW(memory, sim->sheets, count)) return false;
        sim->sheet_count = sim->sheet_capacity = count;
    }

    for (uint32_t i = 0; i < count; i++) {
        SheetSource *source = &sim->sheets[i];
        snapshot_sheet_def(stream, &source->sheet);
        uint32_t vertices = source->sheet.vertex_count, cells = source->sheet.cell_count;
        if (!snapshot_array(stream, memory, &source->position, vertices, sizeof *source->position) ||
            !snapshot_array(stream, memory, &source->cells, cells, sizeof *source->cells) ||
            !snapshot_array(stream, memory, &source->uv, vertices, sizeof *source->uv))
            return false;

        // arrays that may be absent
        uint8_t seams = source->corner_uv != NULL, numbered = source->source_vertex != NULL;
        uint8_t corners = source->corner_source != NULL;
        STREAM(stream, corners);
        STREAM(stream, seams);
        STREAM(stream, numbered);

        if ((seams && !snapshot_array(stream, memory, &source->corner_uv, cells, sizeof *source->corner_uv)) ||
            (corners &&
             !snapshot_array(stream, memory, &source->corner_source, cells, sizeof *source->corner_source)) ||
            (numbered &&
             !snapshot_array(stream, memory, &source->source_vertex, vertices, sizeof *source->source_vertex)))
            return false;

        // parameters
        for (int p = 0; p < PARAM_COUNT; p++) {
            uint8_t varies = source->values[p] != NULL;
            STREAM(stream, source->value[p]);
            STREAM(stream, varies);
            if (varies && !snapshot_array(stream, memory, &source->values[p], (size_t)vertices + cells, sizeof(float)))
                return false;
        }
        if (!snapshot_held(stream, sheet_source_check(source, NULL) == SINGE_OK)) return false;
    }

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

/// A mesh as its solid stores it; the rest follows from that.
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

bool snapshot_motion(Stream *stream, Memory *memory, uint32_t count, Motion *motion) {
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

    // reading: build the tree again
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

static bool snapshot_collider(Stream *stream, SingeSim *sim, Collider *collider) {
    STREAM(stream, collider->generation);
    if (collider->generation == 0) return !stream->failed;
    snapshot_collider_def(stream, &collider->def);
    if (stream->failed || !snapshot_path(stream, &sim->memory, &collider->path)) return false;

    SingeColliderDef def = collider->def;
    def.path_count = collider->path.count; // it may have been given another path
    if (!snapshot_held(stream, def.path_count > 0 && def_check(&collider_table, &def, NULL) == SINGE_OK)) return false;
    if (collider->def.kind == SINGE_COLLIDER_MESH) return snapshot_mesh(stream, &sim->memory, &collider->mesh);
    if (collider->def.kind == SINGE_COLLIDER_DEFORMING) return snapshot_deform(stream, &sim->memory, &collider->deform);
    if (collider->def.kind != SINGE_COLLIDER_HEIGHTFIELD) return true;

    // a height field
    float *saved = collider->heights.heights;
    size_t count = (size_t)def.columns * def.rows;
    bool ok = snapshot_array(stream, &sim->memory, &saved, count, sizeof *saved);
    if (stream->mode != STREAM_READ || !ok) return ok;

    SingeResult result =
        height_solid_create(&sim->memory, def.columns, def.rows, saved, def.size, &collider->heights, NULL);
    FREE(&sim->memory, saved, count);
    stream->failed |= result != SINGE_OK && result != SINGE_ERROR_MEMORY;
    return result == SINGE_OK;
}

bool snapshot_objects(Stream *stream, SingeSim *sim) {
    STREAM(stream, sim->next_generation);
    Memory *memory = &sim->memory;
    if (!snapshot_list(stream, memory, &sim->sources.count, &sim->sources.capacity, &sim->sources.items,
                       sizeof *sim->sources.items))
        return false;

    for (uint32_t i = 0; i < sim->sources.count; i++) {
        Source *source = &sim->sources.items[i];
        uint8_t has_texture = source->texture != NULL;
        STREAM(stream, source->generation);
        if (stream->failed) return false;
        if (source->generation == 0) continue; // a free slot holds nothing

        snapshot_source_def(stream, &source->def);
        STREAM(stream, has_texture);
        STREAM(stream, source->strength_count);

        bool ok = snapshot_path(stream, memory, &source->path) &&
                  snapshot_array(stream, memory, &source->strength, source->strength_count, sizeof *source->strength) &&
                  (!has_texture || snapshot_array(stream, memory, &source->texture, sim->shell.particle_count,
                                                  sizeof *source->texture)) &&
                  snapshot_held(stream, source_check_read(&sim->shell, source, NULL) == SINGE_OK);
        if (!ok) return false;
    }

    if (!snapshot_list(stream, memory, &sim->colliders.count, &sim->colliders.capacity, &sim->colliders.items,
                       sizeof *sim->colliders.items))
        return false;
    for (uint32_t i = 0; i < sim->colliders.count; i++)
        if (!snapshot_collider(stream, sim, &sim->colliders.items[i])) return false;

    if (!snapshot_list(stream, memory, &sim->pins.count, &sim->pins.capacity, &sim->pins.items,
                       sizeof *sim->pins.items))
        return false;

    for (uint32_t i = 0; i < sim->pins.count; i++) {
        Pin *pin = &sim->pins.items[i];
        STREAM(stream, pin->generation);
        if (stream->failed) return false;
        if (pin->generation == 0) continue;

        if (stream->mode == STREAM_READ) pin->end = INFINITY;
        STREAM(stream, pin->count);
        if (!snapshot_array(stream, memory, &pin->particles, pin->count, sizeof *pin->particles) ||
            !snapshot_array(stream, memory, &pin->anchors, pin->count, sizeof *pin->anchors) ||
            !snapshot_path(stream, memory, &pin->path))
            return false;
        if (!snapshot_held(stream, snapshot_pin_fits(&sim->shell, pin))) return false;
    }

    return snapshot_held(stream, snapshot_generations_fit(sim));
}

// Creates a simulation from a scene and its files.
#include "scene/faults.h"
#include "scene/rotation.h"
#include "scene/schema.h"
#include "scene/warnings.h"

#include <stdlib.h>

typedef struct SceneBuilder {
    const Scene *scene;
    const SceneAssets *assets;
    SingeSim *sim;
    SingeSheetId *sheets;
    SceneMessages *messages;
} SceneBuilder;

static SingeResult build_fail(SceneBuilder *builder, SingeResult result, SceneLocation location,
                              const SingeError *error) {
    message_add(builder->messages, builder->scene->text, location, "%s: %s",
                error->stage[0] ? error->stage : "simulation",
                error->message[0] ? error->message : singe_result_name(result));
    return result;
}

// Keys as poses; NULL only when out of memory. Free it.
static SingePoseKey *poses(const SceneKey *keys, uint32_t count) {
    SingePoseKey *path = calloc(count ? count : 1, sizeof *path);
    for (uint32_t i = 0; i < count && path; i++) {
        path[i].time = keys[i].time;
        for (int c = 0; c < 3; c++) path[i].position[c] = keys[i].position[c];
        rotation_quaternion(keys[i].rotation, path[i].rotation);
    }
    return path;
}

static SingeResult no_memory(SceneBuilder *builder, SceneLocation location) {
    message_add(builder->messages, builder->scene->text, location, "out of memory");
    return SINGE_ERROR_MEMORY;
}

void scene_sheet_def(const Scene *scene, const SceneAssets *assets, uint32_t index, SingeSheetDef *def) {
    const SceneSheet *sheet = &scene->sheets[index];
    const Mesh *mesh = &assets->meshes[index];
    *def = singe_default_sheet();
    def->name = sheet->name;
    def->vertex_count = mesh->vertex_count;
    def->positions = mesh->positions;
    def->cell_count = mesh->cell_count;
    def->cells = mesh->cells;
    def->uv = mesh->uv;
    def->corner_uv = mesh->corner_uv;
    def->source_vertex = mesh->source;
    def->corner_source_vertex = mesh->corner_source;
    def->source_count = mesh->source ? mesh->source_count : 0;
    def->attribute_count = mesh->attribute_count;
    def->attributes = mesh->attributes;
    def->material = sheet->material.def;
    SceneParam param;
    for (int i = 0; scene_param(i, &param); i++) {
        SingeParam *given = scene_param_at(&def->material, &param);
        if (given->field) given->field = &assets->fields[index][param.slot];
    }
    for (int c = 0; c < 3; c++) def->velocity[c] = sheet->velocity[c];
    def->drop_pieces_below = sheet->drop_pieces_below;
}

/// Adds the sheets and commits. If one is refused, the others are checked as well.
static SingeResult build_sheets(SceneBuilder *builder) {
    const Scene *scene = builder->scene;
    SingeResult result = SINGE_OK;
    SceneLocation location = {0};
    for (uint32_t i = 0; i < scene->sheet_count && !result; i++) {
        SingeSheetDef def;
        scene_sheet_def(scene, builder->assets, i, &def);
        location = scene->sheets[i].location;
        result = singe_sim_add_sheet(builder->sim, &def, &builder->sheets[i]);
    }
    if (!result && (result = singe_sim_commit(builder->sim)) && scene->sheet_count > 1) location = (SceneLocation){0};
    if (result &&
        (result == SINGE_ERROR_MEMORY || !sheet_faults(scene, builder->assets, FAULTS_OF_SHEETS, builder->messages)))
        return build_fail(builder, result, location, singe_sim_error(builder->sim));
    return result;
}

static SingeResult build_source(SceneBuilder *builder, uint32_t index) {
    const SceneSource *source = &builder->scene->sources[index];
    SingeSourceDef def = source->def;
    SingePoseKey *path = poses(source->keys, source->key_count);
    if (!path) return no_memory(builder, source->location);
    def.path_count = source->key_count;
    def.path = path;
    def.texture = builder->assets->source_textures[index];
    def.strength_count = source->strength_count;
    def.strength = source->strength;
    SingeSourceId id;
    SingeResult result = singe_sim_add_source(builder->sim, &def, &id);
    free(path);
    return result ? build_fail(builder, result, source->location, singe_sim_error(builder->sim)) : SINGE_OK;
}

static SingeResult build_collider(SceneBuilder *builder, uint32_t index) {
    const SceneCollider *collider = &builder->scene->colliders[index];
    SingeColliderDef def = collider->def;
    SingePoseKey *path = poses(collider->keys, collider->key_count);
    if (!path) return no_memory(builder, collider->location);
    def.path_count = collider->key_count;
    def.path = path;
    const SceneSolid *solid = &builder->assets->solids[index];
    def.vertex_count = solid->surface.vertex_count;
    def.vertices = solid->surface.vertices;
    def.triangle_count = solid->surface.triangle_count;
    def.triangles = solid->surface.triangles;
    def.columns = solid->columns;
    def.rows = solid->rows;
    def.heights = solid->heights;
    const SceneSequence *sequence = &builder->assets->collider_motions[index];
    if (sequence->frame_count) {
        const PreviewSolid *first = &sequence->frames[0];
        def.kind = SINGE_COLLIDER_DEFORMING;
        def.vertex_count = first->vertex_count;
        def.vertices = first->vertices;
        def.triangle_count = first->triangle_count;
        def.triangles = first->triangles;
    }
    SingeColliderId id;
    SingeResult result = singe_sim_add_collider(builder->sim, &def, &id);
    free(path);
    return result ? build_fail(builder, result, collider->location, singe_sim_error(builder->sim)) : SINGE_OK;
}

/// The sheet's vertices for vertices of the file; one that was split has several. NULL when out of memory; *bad is set
/// to a vertex that no face of the file has.
static uint32_t *sheet_vertices(const Mesh *mesh, const ScenePin *pin, uint32_t *found, uint32_t *bad) {
    uint8_t *held = calloc((size_t)mesh->source_count + 1, 1);
    uint32_t *list = malloc(((size_t)mesh->vertex_count + 1) * sizeof *list);
    *found = 0;
    for (uint32_t i = 0; i < pin->vertex_count && held && list; i++) {
        uint32_t v = pin->vertices[i], now = v < mesh->source_count ? mesh->became[v] : UINT32_MAX;
        if (now == UINT32_MAX) *bad = v;
        else held[mesh->source[now]] = 1;
    }
    for (uint32_t v = 0; v < mesh->vertex_count && held && list; v++)
        if (mesh->source[v] >= 0 && held[mesh->source[v]]) list[(*found)++] = v;
    if (!held) {
        free(list);
        list = NULL;
    }
    free(held);
    return list;
}

/// Adds a pin by vertex numbers of the file, if the mesh has other numbers.
static SingeResult pin_by_file(SceneBuilder *builder, const ScenePin *pin, SingePinDef *def) {
    uint32_t bad = UINT32_MAX;
    SingePinId id;
    uint32_t *vertices = sheet_vertices(&builder->assets->meshes[pin->sheet_index], pin, &def->vertex_count, &bad);
    if (!vertices) return no_memory(builder, pin->location);
    SingeResult result = SINGE_ERROR_ARGUMENT;
    def->vertices = vertices;
    if (bad != UINT32_MAX)
        message_add(builder->messages, builder->scene->text, pin->location,
                    "pin: vertex %u is out of range or of no face of the mesh", (unsigned)bad);
    else if ((result = singe_sim_add_pin(builder->sim, def, &id)))
        build_fail(builder, result, pin->location, singe_sim_error(builder->sim));
    free(vertices);
    return result;
}

static SingeResult build_pin(SceneBuilder *builder, uint32_t index) {
    const ScenePin *pin = &builder->scene->pins[index];
    SingePinDef def = singe_default_pin();
    SingePoseKey *path = poses(pin->keys, pin->key_count);
    if (!path) return no_memory(builder, pin->location);
    def.sheet = builder->sheets[pin->sheet_index];
    def.point_count = pin->point_count;
    def.points = pin->points ? pin->points->position : NULL; // points are contiguous
    def.radius = pin->radius;
    def.vertex_count = pin->vertex_count;
    def.vertices = pin->vertices;
    def.path_count = pin->key_count;
    def.path = path;
    SingePinId id;
    if (pin->vertex_count && builder->assets->meshes[pin->sheet_index].became) {
        SingeResult by_file = pin_by_file(builder, pin, &def);
        free(path);
        return by_file;
    }
    SingeResult result = singe_sim_add_pin(builder->sim, &def, &id);
    free(path);
    return result ? build_fail(builder, result, pin->location, singe_sim_error(builder->sim)) : SINGE_OK;
}

static SingeResult build_all(SceneBuilder *builder) {
    const Scene *scene = builder->scene;
    SingeResult result = build_sheets(builder);
    for (uint32_t i = 0; i < scene->source_count && !result; i++) result = build_source(builder, i);
    for (uint32_t i = 0; i < scene->collider_count && !result; i++) result = build_collider(builder, i);
    for (uint32_t i = 0; i < scene->pin_count && !result; i++) result = build_pin(builder, i);
    return result;
}

SingeResult scene_build(const Scene *scene, const SceneAssets *assets, const SingeSimDef *hooks, SingeSim **sim,
                        SceneMessages *messages) {
    SceneBuilder builder = {.scene = scene, .assets = assets, .messages = messages};
    SingeSimDef def = scene->sim;
    SingeError error = {0};
    *sim = NULL;
    def.allocator = hooks->allocator;
    def.log = hooks->log;
    def.tasks = hooks->tasks;
    def.thread_count = hooks->thread_count;
    builder.sheets = calloc(scene->sheet_count ? scene->sheet_count : 1, sizeof *builder.sheets);
    if (!builder.sheets) return no_memory(&builder, (SceneLocation){0});
    SingeResult result = singe_sim_create(&def, &builder.sim, &error);
    if (result) build_fail(&builder, result, (SceneLocation){0}, &error);
    else result = build_all(&builder);
    free(builder.sheets);
    if (result) singe_sim_destroy(builder.sim);
    else *sim = builder.sim;
    if (!result) scene_warn(scene, assets, &hooks->log);
    return result;
}

// Creates a simulation from a scene and its files: one walk over the scene's objects, which ends at the first that the
// library refuses. faults.c reports that one in the scene's words.
#include "common/store.h"
#include "scene/builder.h"
#include "scene/faults.h"
#include "scene/space.h"
#include "scene/schema.h"
#include "scene/warnings.h"

#include <stdlib.h>

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

/// Keys as poses; NULL only when out of memory. Free it.
static SingePoseKey *poses(const SceneKey *keys, uint32_t count) {
    SingePoseKey *path = calloc(count ? count : 1, sizeof *path);
    for (uint32_t i = 0; i < count && path; i++) {
        path[i].time = keys[i].time;
        for (int c = 0; c < 3; c++) path[i].position[c] = keys[i].position[c];
        rotation_quaternion(keys[i].rotation, path[i].rotation);
    }
    return path;
}

static SingeResult no_memory(const SceneBuilder *builder) {
    return refuse(builder->error, SINGE_ERROR_MEMORY, "scene", -1, "out of memory");
}

static SingeResult take_error(const SceneBuilder *builder, SingeResult result) {
    if (result) *builder->error = *singe_sim_error(builder->sim);
    return result;
}

SingeResult builder_add_source(const SceneBuilder *builder, uint32_t index) {
    const SceneSource *source = &builder->scene->sources[index];
    SingeSourceDef def = source->def;
    SingePoseKey *path = poses(source->keys, source->key_count);
    if (!path) return no_memory(builder);

    def.path_count = source->key_count;
    def.path = path;
    def.texture = builder->assets->source_textures[index];
    def.strength_count = source->strength_count;
    def.strength = source->strength;

    SingeSourceId id;
    SingeResult result = singe_sim_add_source(builder->sim, &def, &id);
    free(path);
    return take_error(builder, result);
}

SingeResult builder_add_collider(const SceneBuilder *builder, uint32_t index) {
    const SceneCollider *collider = &builder->scene->colliders[index];
    const SceneSolid *solid = &builder->assets->solids[index];
    SingeColliderDef def = collider->def;
    SingePoseKey *path = poses(collider->keys, collider->key_count);
    if (!path) return no_memory(builder);

    def.path_count = collider->key_count;
    def.path = path;

    // a mesh that moves starts as its first frame
    const SceneSequence *sequence = &builder->assets->collider_motions[index];
    const PreviewSolid *surface = sequence->frame_count ? &sequence->frames[0] : &solid->surface;
    if (sequence->frame_count) def.kind = SINGE_COLLIDER_DEFORMING;

    def.vertex_count = surface->vertex_count;
    def.vertices = surface->vertices;
    def.triangle_count = surface->triangle_count;
    def.triangles = surface->triangles;
    def.columns = solid->columns;
    def.rows = solid->rows;
    def.heights = solid->heights;

    SingeColliderId id;
    SingeResult result = singe_sim_add_collider(builder->sim, &def, &id);
    free(path);
    return take_error(builder, result);
}

/// The sheet's vertices for vertices of the file, of which one that was split has several. Free the list.
static SingeResult vertices_of_file(const SceneBuilder *builder, const ScenePin *pin, uint32_t **vertices,
                                    uint32_t *count) {
    const Mesh *mesh = &builder->assets->meshes[pin->sheet_index];
    uint8_t *held = calloc((size_t)mesh->source_count + 1, 1);
    uint32_t *list = malloc(((size_t)mesh->vertex_count + 1) * sizeof *list);
    SingeResult result = held && list ? SINGE_OK : no_memory(builder);

    for (uint32_t i = 0; i < pin->vertex_count && !result; i++) {
        uint32_t v = pin->vertices[i], now = v < mesh->source_count ? mesh->became[v] : UINT32_MAX;
        if (now != UINT32_MAX) held[mesh->source[now]] = 1;
        else
            result = refuse(builder->error, SINGE_ERROR_ARGUMENT, "pin", v,
                            "vertex %u is out of range or belongs to no face of the mesh", (unsigned)v);
    }

    *count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count && !result; v++)
        if (mesh->source[v] >= 0 && held[mesh->source[v]]) list[(*count)++] = v;
    free(held);
    *vertices = list;

    return result;
}

SingeResult builder_add_pin(const SceneBuilder *builder, uint32_t index) {
    const ScenePin *pin = &builder->scene->pins[index];
    SingePinDef def = singe_default_pin();
    SingePoseKey *path = poses(pin->keys, pin->key_count);
    if (!path) return no_memory(builder);

    def.sheet = builder->sheets[pin->sheet_index];
    def.point_count = pin->point_count;
    def.points = pin->points ? pin->points->position : NULL; // points are contiguous
    def.radius = pin->radius;
    def.end = pin->end;
    def.vertex_count = pin->vertex_count;
    def.vertices = pin->vertices;
    def.path_count = pin->key_count;
    def.path = path;

    // a mesh that was repaired or renumbered has other numbers than its file
    uint32_t *vertices = NULL;
    SingeResult result = SINGE_OK;
    if (pin->vertex_count && builder->assets->meshes[pin->sheet_index].became) {
        result = vertices_of_file(builder, pin, &vertices, &def.vertex_count);
        def.vertices = vertices;
    }

    SingePinId id;
    if (!result) result = take_error(builder, singe_sim_add_pin(builder->sim, &def, &id));
    free(vertices);
    free(path);
    return result;
}

/// Adds sheets, commits, adds sources, colliders and pins. On failure *fault is the object that failed.
static SingeResult construct(SceneBuilder *builder, SceneFault *fault) {
    const Scene *scene = builder->scene;
    SingeResult result = SINGE_OK;
    builder->error = &fault->error;

    fault->object = FAULT_SHEET;
    for (uint32_t i = 0; i < scene->sheet_count && !result; i++) {
        SingeSheetDef def;
        scene_sheet_def(scene, builder->assets, i, &def);
        fault->index = i;
        result = take_error(builder, singe_sim_add_sheet(builder->sim, &def, &builder->sheets[i]));
    }

    if (result) return result;

    fault->object = FAULT_COMMIT;
    TRY(take_error(builder, singe_sim_commit(builder->sim)));

    const struct {
        int object;
        uint32_t count;
        SingeResult (*add)(const SceneBuilder *builder, uint32_t index);
    } lists[] = {
        {FAULT_SOURCE, scene->source_count, builder_add_source},
        {FAULT_COLLIDER, scene->collider_count, builder_add_collider},
        {FAULT_PIN, scene->pin_count, builder_add_pin},
    };

    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        fault->object = lists[k].object;
        for (uint32_t i = 0; i < lists[k].count; i++) {
            fault->index = i;
            TRY(lists[k].add(builder, i));
        }
    }

    fault->object = FAULT_RENDER_MESH;
    return scene_bind_meshes(builder->assets, builder->sim, &fault->index, &fault->error);
}

SingeResult scene_build(const Scene *scene, const SceneAssets *assets, const SingeSimDef *hooks, SingeSim **sim,
                        SceneMessages *messages) {
    SceneBuilder builder = {.scene = scene, .assets = assets};
    SceneFault fault = {.object = FAULT_SIM};
    SingeSimDef def = scene->sim;
    def.allocator = hooks->allocator;
    def.log = hooks->log;
    def.tasks = hooks->tasks;
    def.record = hooks->record;
    def.cancel = hooks->cancel;
    def.thread_count = hooks->thread_count;

    *sim = NULL;
    builder.error = &fault.error;
    builder.sheets = calloc(scene->sheet_count ? scene->sheet_count : 1, sizeof *builder.sheets);
    SingeResult result = builder.sheets ? singe_sim_create(&def, &builder.sim, &fault.error) : no_memory(&builder);
    if (!result) result = construct(&builder, &fault);
    free(builder.sheets);

    if (result) {
        fault.error.code = result;
        fault_report(scene, assets, &fault, messages);
        singe_sim_destroy(builder.sim);
        return result;
    }

    *sim = builder.sim;
    scene_warn(scene, assets, &hooks->log);
    return SINGE_OK;
}

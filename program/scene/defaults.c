// The defaults of a scene. Objects of the simulation have the library's defaults.
#include "scene/schema.h"

#include <math.h>

static void set3(float v[3], float x, float y, float z) {
    v[0] = x;
    v[1] = y;
    v[2] = z;
}

bool default_scene(SceneArena *arena, void *object) {
    (void)arena;
    Scene *scene = object;
    scene->frames = 100;
    scene->fps = 24;
    scene->steps = 20;
    scene->sim = singe_default_sim();
    scene->sim.surface_detail = 0.4e-3f;
    scene->sim.gas.enabled = true;
    scene->sim.contact.enabled = true;
    scene->tearing = true;
    scene->output.formats = 1u << OUTPUT_ply;
    scene->output.texture_size = 1024;
    scene->gas_detail = 1;

    scene->preview.def = preview_default();
    scene->preview.def.sky = PREVIEW_SKY_STUDIO;
    scene->preview.def.ground_height = scene->preview.def.wall_distance = -INFINITY;
    scene->preview.shutter = 0.5f;
    return true;
}

bool default_sheet(SceneArena *arena, void *object) {
    (void)arena;
    SceneSheet *sheet = object;
    SingeSheetDef def = singe_default_sheet();
    sheet->material.def = def.material;
    sheet->drop_pieces_below = def.drop_pieces_below;
    set3(sheet->velocity, def.velocity[0], def.velocity[1], def.velocity[2]);
    set3(sheet->colour, 1, 1, 1);
    sheet->transmittance = PREVIEW_TRANSMITTANCE;
    sheet->scale = 1;

    return true;
}

bool default_source(SceneArena *arena, void *object) {
    (void)arena;
    SceneSource *source = object;
    source->def = singe_default_source();
    source->visible = true;
    return true;
}

bool default_collider(SceneArena *arena, void *object) {
    SceneCollider *collider = object;
    collider->def = singe_default_collider();
    collider->scale = 1;
    collider->heights[1] = 0.02f;
    set3(collider->colour, 0.5f, 0.5f, 0.5f);
    collider->visible = true;
    collider->keys = arena_new(arena, 1, sizeof *collider->keys); // at the origin
    collider->key_count = 1;
    return collider->keys != NULL;
}

bool default_motion(SceneArena *arena, void *object) {
    (void)arena;
    SceneMotion *motion = object;
    motion->first = 1;
    motion->scale = 1;
    return true;
}

bool default_pin(SceneArena *arena, void *object) {
    (void)arena;
    ((ScenePin *)object)->radius = singe_default_pin().radius;
    ((ScenePin *)object)->end = singe_default_pin().end;
    return true;
}

void chosen_solver(void *object) {
    SingeSolverDef *solver = object;
    const bool creases = solver->creases; // set by a key of the scene
    singe_init_solver_method(solver, sizeof *solver, solver->method);
    solver->creases = creases;
}

bool default_grid(SceneArena *arena, void *object) {
    (void)arena;
    ((SceneGrid *)object)->def = mesh_grid_default();
    return true;
}

bool default_measured(SceneArena *arena, void *object) {
    (void)arena;
    *(SceneMeasured *)object = (SceneMeasured){0};
    return true;
}

bool default_noise(SceneArena *arena, void *object) {
    (void)arena;
    *(SingeNoise *)object = (SingeNoise){.scale = 0.01f, .octaves = 4};
    return true;
}

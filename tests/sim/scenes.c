#include "scenes.h"

#include <string.h>

SingeMaterialDef scene_quick_material(void) {
    SingeMaterialDef material = singe_default_material();
    material.thickening = 1;
    material.diffusivity = singe_param(1e-4f);
    material.ignition_temperature = singe_param(450);
    material.heat_of_combustion = singe_param(1500 * 1400), material.heat_share = singe_param(1);
    material.mass_rate = singe_param(0.08f);
    material.shrink_back = singe_param(0.9f);

    // one reaction, and no leaf that stays: holes open wherever it burns
    material.char_yield = singe_param(0), material.mass_loss = singe_param(0.25f);
    material.ash_density = singe_param(0.3f);
    return material;
}

SingeSimDef scene_def(void) {
    SingeSimDef def = singe_default_sim();
    def.time_step = 1.0f / 240;
    def.wind.gust = 0.5f;
    def.wind.velocity[0] = 0.2f;
    def.gas.enabled = true, def.gas.cell_size = 0.02f;
    return def;
}

static float scene_callback_flux = 2000;

void scene_flux(void *context, const struct SingeView *view, float *flux, float *conductance,
                float *conductance_temperature) {
    const float *strength = context;
    for (uint32_t i = 0; i < view->particle_count; i++) {
        flux[i] += *strength * (float)view->time * view->rest_position[i][0];
        conductance[i] += 2;
        conductance_temperature[i] += 2 * 400;
    }
}

static SingeResult scene_sheets(Scene *scene, uint32_t cells) {
    const float side = 0.2f;
    TestMesh grid = test_grid(cells, cells, side / (float)cells, side / (float)cells),
             tube = test_cylinder(8, 5, 0.03f, 0.1f);

    test_mesh_add_vertex(&grid, 1, 1, 1); // belongs to no cell
    test_mesh_move(&tube, 0.1f, 0.1f, 0.06f);
    SingeSheetDef sheet = test_sheet(&grid);
    sheet.material = scene_quick_material();
    sheet.material.mass_rate = singe_param_field(sheet.material.mass_rate.value, 0.12f,
                                                 &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {0.03f, 3, 5}});
    sheet.drop_pieces_below = 1e-4f;
    SingeResult result = singe_sim_add_sheet(scene->sim, &sheet, &scene->sheets[0]);
    sheet = test_sheet(&tube);
    sheet.name = "tube";
    sheet.material = scene_quick_material();
    sheet.material.heat_operator = SINGE_HEAT_UMBRELLA;
    sheet.velocity[2] = -0.1f;
    if (!result) result = singe_sim_add_sheet(scene->sim, &sheet, &scene->sheets[1]);
    test_mesh_free(&grid);
    test_mesh_free(&tube);
    return result;
}

#define SCENE_TRY(call)               \
    do {                              \
        SingeResult result_ = (call); \
        if (result_) return result_;  \
    } while (0)

static SingeResult scene_sources(Scene *scene) {
    SingeSim *sim = scene->sim;
    SingePoseKey path[] = {test_key(0, 0, 0.1f, 0.01f), test_key(0.5f, 0.2f, 0.1f, 0.01f)};
    SingeSourceDef def = singe_default_source();
    def.kind = SINGE_SOURCE_BALL;
    def.path_count = 2, def.path = path;
    def.radius = 0.015f, def.falloff = 0.01f;
    def.temperature = 1500, def.conductance = 1000;
    SCENE_TRY(singe_sim_add_source(sim, &def, &scene->ball));
    def.kind = SINGE_SOURCE_SPOT;
    def.path_count = 1, def.path = &path[1];
    def.end = 0.1f;
    SCENE_TRY(singe_sim_add_source(sim, &def, &scene->spot));
    def = singe_default_source();
    def.kind = SINGE_SOURCE_TEXTURE;
    const float grey[4] = {0, 0.5f, 1, 0};
    const SingeValueKey strength[] = {{0, 0}, {0.05f, 1}, {0.2f, 0.2f}};
    def.texture = (SingeTexture){2, 2, grey};
    def.strength_count = 3, def.strength = strength;
    def.flux = 40e3f;
    SCENE_TRY(singe_sim_add_source(sim, &def, &scene->picture));
    def = singe_default_source();
    def.kind = SINGE_SOURCE_CALLBACK;
    def.callback = scene_flux;
    def.callback_context = &scene_callback_flux;
    return singe_sim_add_source(sim, &def, &scene->callback);
}

static SingeResult scene_colliders(Scene *scene) {
    SingeSim *sim = scene->sim;
    SingePoseKey path[] = {test_key(0, 0.1f, 0.05f, -0.02f), {0.4f, {0.1f, 0.12f, 0}, {0.3f, 0, 0, 0.9f}}};
    SingeColliderDef def = singe_default_collider();
    def.path_count = 1, def.path = path;
    SCENE_TRY(singe_sim_add_collider(sim, &def, &scene->plane));
    def.kind = SINGE_COLLIDER_SPHERE;
    def.path_count = 2;
    def.radius = 0.018f;
    def.conductance = 50, def.temperature = 700;
    SCENE_TRY(singe_sim_add_collider(sim, &def, &scene->sphere));
    def.kind = SINGE_COLLIDER_BOX;
    def.half_size[0] = def.half_size[1] = def.half_size[2] = 0.01f;
    SCENE_TRY(singe_sim_add_collider(sim, &def, &scene->box));
    def.kind = SINGE_COLLIDER_CAPSULE;
    def.radius = 0.01f, def.height = 0.05f;
    SCENE_TRY(singe_sim_add_collider(sim, &def, &scene->capsule));
    static const float vertices[] = {0.01f, 0, 0, -0.01f, 0, 0, 0, 0.01f, 0, 0, -0.01f, 0, 0, 0, 0.01f, 0, 0, -0.01f};
    static const uint32_t triangles[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    def.kind = SINGE_COLLIDER_MESH;
    def.vertex_count = 6, def.vertices = vertices, def.triangle_count = 8, def.triangles = triangles;
    def.sides = SINGE_SIDES_BOTH;
    SCENE_TRY(singe_sim_add_collider(sim, &def, &scene->mesh));
    static const float heights[] = {0, 0.01f, 0, 0.02f, 0.01f, 0, 0, 0, 0.01f};
    def.kind = SINGE_COLLIDER_HEIGHTFIELD;
    def.columns = def.rows = 3, def.heights = heights;
    return singe_sim_add_collider(sim, &def, &scene->heightfield);
}

static SingeResult scene_pins(Scene *scene) {
    SingePinDef def = singe_default_pin();
    const float points[] = {0, 0, 0, 0.2f, 0, 0};
    def.sheet = scene->sheets[0];
    def.point_count = 2, def.points = points;
    def.radius = 0.015f;
    SCENE_TRY(singe_sim_add_pin(scene->sim, &def, &scene->points));
    def = singe_default_pin();
    const uint32_t vertices[] = {40, 41, 47};
    const SingePoseKey path[] = {test_key(0, 0, 0, 0), {0.3f, {0, 0, 0.02f}, {0, 0, 0.1f, 0.99f}}};
    def.sheet = scene->sheets[1];
    def.vertex_count = 3, def.vertices = vertices;
    def.path_count = 2, def.path = path;
    return singe_sim_add_pin(scene->sim, &def, &scene->vertices);
}

SingeResult scene_build(const SingeSimDef *def, uint32_t cells, Scene *scene) {
    SingeError error;
    memset(scene, 0, sizeof *scene);
    SCENE_TRY(singe_sim_create(def, &scene->sim, &error));
    SCENE_TRY(scene_sheets(scene, cells));
    SCENE_TRY(singe_sim_commit(scene->sim));
    SCENE_TRY(scene_sources(scene));
    SCENE_TRY(scene_colliders(scene));
    return scene_pins(scene);
}

SingeResult scene_build_early(const SingeSimDef *def, uint32_t cells, Scene *scene) {
    SingeError error;
    memset(scene, 0, sizeof *scene);
    SCENE_TRY(singe_sim_create(def, &scene->sim, &error));
    SCENE_TRY(scene_sources(scene));
    SCENE_TRY(scene_colliders(scene));
    SCENE_TRY(scene_sheets(scene, cells));
    SCENE_TRY(scene_pins(scene));
    return singe_sim_commit(scene->sim);
}

Scene scene_make(const SingeSimDef *def, uint32_t cells) {
    Scene scene;
    SingeSimDef standard = scene_def();
    SingeResult result = scene_build(def ? def : &standard, cells, &scene);
    test_ok(scene.sim, result);
    return scene;
}

#include "scenes.h"

SingeMaterialDef scene_quick_material(void) {
    SingeMaterialDef material = singe_default_material();
    material.thickening = 1;
    material.diffusivity = singe_param(1e-4f);
    material.ignition_temperature = singe_param(450);
    material.heat_of_combustion = singe_param(1500 * 1400), material.heat_share = singe_param(1);
    material.mass_rate = singe_param(0.08f), material.air_supply = singe_param(INFINITY);
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

static SingeResult scene_sheets(TestScene *scene, uint32_t cells) {
    const float side = 0.2f;
    OwnTestMesh grid = test_grid(cells, cells, side / (float)cells, side / (float)cells),
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
    return result;
}

#define SCENE_TRY(call)               \
    do {                              \
        SingeResult result_ = (call); \
        if (result_) return result_;  \
    } while (0)

static SingeResult scene_sources(TestScene *scene) {
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

static SingeResult scene_colliders(TestScene *scene) {
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

static SingeResult scene_pins(TestScene *scene) {
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

SingeResult scene_build(const SingeSimDef *def, uint32_t cells, TestScene *scene) {
    SingeError error;
    memset(scene, 0, sizeof *scene);
    SCENE_TRY(singe_sim_create(def, &scene->sim, &error));
    SCENE_TRY(scene_sheets(scene, cells));
    SCENE_TRY(singe_sim_commit(scene->sim));
    SCENE_TRY(scene_sources(scene));
    SCENE_TRY(scene_colliders(scene));
    return scene_pins(scene);
}

SingeResult scene_build_early(const SingeSimDef *def, uint32_t cells, TestScene *scene) {
    SingeError error;
    memset(scene, 0, sizeof *scene);
    SCENE_TRY(singe_sim_create(def, &scene->sim, &error));
    SCENE_TRY(scene_sources(scene));
    SCENE_TRY(scene_colliders(scene));
    SCENE_TRY(scene_sheets(scene, cells));
    SCENE_TRY(scene_pins(scene));
    return singe_sim_commit(scene->sim);
}

void scene_end(TestScene *scene) { singe_sim_destroy(scene->sim); }

TestScene scene_make(const SingeSimDef *def, uint32_t cells) {
    TestScene scene;
    SingeSimDef standard = scene_def();
    SingeResult result = scene_build(def ? def : &standard, cells, &scene);
    test_ok(scene.sim, result);
    return scene;
}

// ---- every call

static void scene_set(const TestScene *scene) {
    SingeSim *sim = scene->sim;
    test_steps(sim, 4);
    const float down[3] = {0, 1, -9};
    test_ok(sim, singe_sim_set_gravity(sim, down));
    test_ok(sim, singe_sim_set_pace(sim, 3));
    assert_int_equal(singe_sim_set_pace(sim, -1), SINGE_ERROR_ARGUMENT);

    SingeWindDef wind = singe_default_wind();
    wind.velocity[0] = 2;
    test_ok(sim, singe_sim_set_wind(sim, &wind));
    wind.struct_size = 0;
    assert_int_equal(singe_sim_set_wind(sim, &wind), SINGE_ERROR_ARGUMENT);
    assert_int_equal(singe_sim_set_wind(sim, NULL), SINGE_ERROR_ARGUMENT);

    const float velocity[2][3] = {{0, 0, 1}, {0, 1, 0}};
    test_ok(sim, singe_sim_set_velocity(sim, scene->sheets[0], 3, 2, velocity[0]));
    assert_int_equal(singe_sim_set_velocity(sim, scene->sheets[0], 3, 1u << 30, velocity[0]), SINGE_ERROR_ARGUMENT);

    uint32_t steps;
    test_ok(sim, singe_sim_advance(sim, 0.011, 0, &steps));
    test_ok(sim, singe_sim_advance(sim, 0.011, 2, NULL));
    test_ok(sim, singe_sim_set_ambient_temperature(sim, 280));

    SingeMaterialDef material = singe_default_material();
    const SingeField noise = {.kind = SINGE_FIELD_NOISE, .noise = {0.01f, 2, 5}};
    material.mass_rate = singe_param_field(0.5f, 2, &noise);
    material.drag = singe_param_field(1, 2, &noise);
    test_ok(sim, singe_sim_set_material(sim, scene->sheets[1], &material, NULL));

    static const float share[256] = {[1] = 0.5f, [20] = 1};
    test_ok(sim, singe_sim_set_material(sim, scene->sheets[1], &material, share));
    test_steps(sim, 2);
}

static void scene_move(const TestScene *scene) {
    SingeSim *sim = scene->sim;
    const SingePoseKey to[2] = {test_key(0, 0, 0, 0.01f), test_key(1, 0.02f, 0, 0.01f)};
    test_ok(sim, singe_sim_move_source(sim, scene->ball, 2, to));
    test_ok(sim, singe_sim_move_collider(sim, scene->sphere, 2, to));
    test_ok(sim, singe_sim_move_pin(sim, scene->points, 2, to));
    test_ok(sim, singe_sim_remove_source(sim, scene->spot));
    assert_int_equal(singe_sim_remove_source(sim, scene->spot), SINGE_ERROR_HANDLE);
    test_ok(sim, singe_sim_remove_collider(sim, scene->box));

    uint32_t held;
    const uint32_t *particles = singe_sim_pin_particles(sim, scene->vertices, &held);
    float(*positions)[3] = calloc(held, sizeof *positions);
    assert_non_null(positions);
    for (uint32_t i = 0; i < held; i++) memcpy(positions[i], singe_sim_view(sim).position[particles[i]], 12);
    test_ok(sim, singe_sim_set_pin_positions(sim, scene->vertices, positions[0], 0.5));
    free(positions);
}

static void scene_deform(SingeSim *sim) {
    static const float corners[4][3] = {{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}, {0, 0, 0.01f}};
    static const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    SingeColliderDef wedge = singe_default_collider();
    wedge.kind = SINGE_COLLIDER_DEFORMING;
    wedge.vertex_count = wedge.triangle_count = 4;
    wedge.vertices = corners[0];
    wedge.triangles = triangles[0];

    const SingeColliderId id = test_add_collider(sim, &wedge);
    test_ok(sim, singe_sim_set_collider_vertices(sim, id, corners[0], 1));
    test_steps(sim, 2);
}

void scene_every_call(const TestScene *scene) {
    SingeSim *sim = scene->sim, *copy;
    scene_set(scene);
    scene_move(scene);
    scene_deform(sim);

    SingeSurface surface = {0};
    test_ok(sim, singe_sim_surface(sim, &surface));
    singe_surface_free(&surface);

    TestBytes bytes = test_save(sim);
    free(bytes.data);
    test_ok(sim, singe_sim_clone(sim, &copy));
    test_steps(copy, 1); // a clone is not recorded
    singe_sim_destroy(copy);
    test_ok(sim, singe_sim_set_source_callback(sim, scene->callback, NULL, NULL));
    test_steps(sim, 2);
    test_ok(sim, singe_sim_remove_pin(sim, scene->points));
    test_steps(sim, 2);
}

// Sources, pins, colliders and wind: added, moved and removed while the simulation runs.
#include "scenes.h"

static SingeSimDef weightless(void) {
    SingeSimDef def = singe_default_sim();
    memset(def.gravity, 0, sizeof def.gravity);
    return def;
}

static double heat_in(SingeSim *sim) { return singe_sim_stats(sim).heat_in; }

static float mean_height(SingeSim *sim) {
    SingeView view = singe_sim_view(sim);
    double sum = 0;
    for (uint32_t v = 0; v < view.vertex_count; v++) sum += (double)view.position[v][2];
    return (float)(sum / view.vertex_count);
}

TEST(handles_go_stale) {
    TestScene scene = scene_make(NULL, 8);
    OwnSim *sim = scene.sim;
    SingePoseKey key = test_key(0, 0, 0, 0);
    SingeSourceDef source = singe_default_source();
    source.path_count = 1, source.path = &key;

    SingeColliderDef collider = singe_default_collider();
    collider.path_count = 1, collider.path = &key;
    SingePinDef pin = singe_default_pin();
    const uint32_t vertex = 3;
    pin.sheet = scene.sheets[0], pin.vertex_count = 1, pin.vertices = &vertex;

    test_ok(sim, singe_sim_remove_source(sim, scene.ball));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_source(sim, scene.ball));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_move_source(sim, scene.ball, 1, &key));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_set_source_callback(sim, scene.ball, scene_flux, NULL));

    SingeSourceId again = test_add_source(sim, &source);
    assert_int_equal(again.index, scene.ball.index); // the slot is used again
    assert_int_not_equal(again.generation, scene.ball.generation);
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_source(sim, scene.ball));
    test_ok(sim, singe_sim_move_source(sim, again, 1, &key));

    test_ok(sim, singe_sim_remove_collider(sim, scene.sphere));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_collider(sim, scene.sphere));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_move_collider(sim, scene.sphere, 1, &key));
    test_add_collider(sim, &collider);
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_collider(sim, scene.sphere));

    test_ok(sim, singe_sim_remove_pin(sim, scene.points));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_pin(sim, scene.points));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_move_pin(sim, scene.points, 1, &key));
    test_add_pin(sim, &pin);
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_pin(sim, scene.points));

    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_source(sim, (SingeSourceId){0, 0}));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_source(sim, (SingeSourceId){1000000, 1}));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_pin(sim, (SingePinId){UINT32_MAX, UINT32_MAX}));
    test_steps(sim, 5);
}

TEST(refused_moves_change_nothing) {
    TestScene scene = scene_make(NULL, 8), other = scene_make(NULL, 8);
    SingeSim *sim = scene.sim;
    SingePoseKey bad = test_key(0, NAN, 0, 0), good = test_key(0, 0, 0, 0);

    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_move_source(sim, scene.ball, 1, &bad));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_move_source(sim, scene.ball, 0, NULL));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_move_source(sim, scene.ball, 1, NULL));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_move_source(sim, scene.picture, 1, &good));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_move_collider(sim, scene.box, 1, &bad));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_move_collider(sim, scene.box, 0, NULL));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_move_pin(sim, scene.vertices, 1, &bad));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_source_callback(sim, scene.ball, scene_flux, NULL));

    test_steps_alike(sim, other.sim, 10);
    singe_sim_destroy(sim);
    singe_sim_destroy(other.sim);
}

TEST(sources_come_and_go) {
    SingeSimDef def = weightless();
    OwnSim *sim = test_sim(&def, test_grid(10, 10, 0.01f, 0.01f), NULL);
    test_steps(sim, 2);
    assert_true(heat_in(sim) == 0);

    SingeSourceId spot = test_spot(sim, 0.05f, 0.05f, 0, 0.02f, 400, 50);
    test_steps(sim, 2);
    double before = heat_in(sim);
    assert_true(before > 0);

    SingePoseKey away = test_key(0, 5, 5, 5), back = test_key(0, 0.05f, 0.05f, 0);
    test_ok(sim, singe_sim_move_source(sim, spot, 1, &away));
    test_steps(sim, 2);
    assert_true(heat_in(sim) == before);
    test_ok(sim, singe_sim_move_source(sim, spot, 1, &back));

    test_steps(sim, 2);
    assert_true(heat_in(sim) > before);
    test_ok(sim, singe_sim_remove_source(sim, spot));
    before = heat_in(sim);
    test_steps(sim, 2);
    assert_true(heat_in(sim) == before);

    SingeSourceDef late = singe_default_source();
    late.path_count = 1, late.path = &back;
    late.start = (float)singe_sim_view(sim).time + 1.5f * def.time_step;
    late.end = late.start + 2 * def.time_step;
    test_add_source(sim, &late);

    for (int i = 0; i < 6; i++) {
        before = heat_in(sim);
        test_ok(sim, singe_sim_step(sim));
        assert_int_equal(heat_in(sim) > before, i == 2 || i == 3);
    }
}

TEST(pins_hold_move_and_let_go) {
    OwnSim *sim = test_sim(NULL, test_grid(6, 6, 0.01f, 0.01f), NULL);
    SingeView view = singe_sim_view(sim);
    test_steps(sim, 10);
    assert_true(view.position[0][2] < 0); // falls

    SingePinDef def = singe_default_pin();
    const float corner[3] = {0, 0, 0};
    def.sheet = (SingeSheetId){0, 1}, def.point_count = 1, def.points = corner, def.radius = 0.0105f;
    SingePinId pin = test_add_pin(sim, &def);
    float at[3][3];
    const uint32_t held[3] = {0, 1, 7};
    for (int k = 0; k < 3; k++) memcpy(at[k], view.position[held[k]], 12);
    test_steps(sim, 40);

    for (int k = 0; k < 3; k++) {
        assert_memory_equal(view.position[held[k]], at[k], 12);
        assert_true(view.particle_flags[held[k]] & SINGE_PINNED);
    }

    assert_true(view.particle_flags[49] & SINGE_PINNED); // the first centre too
    assert_false(view.particle_flags[2] & SINGE_PINNED);
    assert_true(view.position[48][2] < at[0][2] - 0.01f); // the rest hangs

    // a new path starts from where the pin is, whatever its own position, and carries it along
    float now = (float)singe_sim_view(sim).time;
    SingePoseKey path[2] = {test_key(now, 3, 3, 3), test_key(now + 0.1f, 3.05f, 3, 3.02f)};
    test_ok(sim, singe_sim_move_pin(sim, pin, 2, path));
    test_ok(sim, singe_sim_step(sim));
    for (int k = 0; k < 3; k++) assert_true(fabsf(view.position[held[k]][0] - at[k][0]) < 0.05f / 40);
    test_steps(sim, 60);

    for (int k = 0; k < 3; k++) {
        assert_true(fabsf(view.position[held[k]][0] - at[k][0] - 0.05f) < 2e-6f);
        assert_true(fabsf(view.position[held[k]][1] - at[k][1]) < 2e-6f);
        assert_true(fabsf(view.position[held[k]][2] - at[k][2] - 0.02f) < 2e-6f);
    }

    // a second pin keeps what the first one lets go
    const uint32_t vertex = 0;
    def = singe_default_pin();
    def.sheet = (SingeSheetId){0, 1}, def.vertex_count = 1, def.vertices = &vertex;
    SingePinId second = test_add_pin(sim, &def);

    test_ok(sim, singe_sim_remove_pin(sim, pin));
    assert_true(view.particle_flags[0] & SINGE_PINNED);
    assert_false(view.particle_flags[1] & SINGE_PINNED);
    memcpy(at[0], view.position[0], 12);
    test_steps(sim, 20);

    assert_memory_equal(view.position[0], at[0], 12);
    test_ok(sim, singe_sim_remove_pin(sim, second));
    assert_false(view.particle_flags[0] & SINGE_PINNED);
    test_steps(sim, 20);
    assert_true(view.position[0][2] < at[0][2]);
}

/// As if the host had removed them at that time; saved and loaded before and after it, too.
TEST(pins_end) {
    const uint32_t corner = 0;
    const SingePoseKey path[2] = {test_key(0, 0, 0, 0), test_key(0.2f, 0.1f, 0, 0.2f)};
    SingePinDef def = singe_default_pin();
    def.sheet = (SingeSheetId){0, 1}, def.vertex_count = 1, def.vertices = &corner;
    def.path_count = 2, def.path = path;

    OwnSim *by_hand = test_sim(NULL, test_grid(6, 6, 0.01f, 0.01f), NULL);
    SingeSim *by_end = test_sim(NULL, test_grid(6, 6, 0.01f, 0.01f), NULL), *loaded = NULL;
    SingePinId removed, ended;
    test_ok(by_hand, singe_sim_add_pin(by_hand, &def, &removed));
    def.end = -1;
    test_refused(by_end, SINGE_ERROR_ARGUMENT, singe_sim_add_pin(by_end, &def, &ended));
    def.end = 40 * singe_default_sim().time_step;
    test_ok(by_end, singe_sim_add_pin(by_end, &def, &ended));

    for (int step = 0; step < 80; step++) {
        if (step % 20 == 10) { // at 10 and 30 it holds, at 50 and 70 no more
            singe_sim_destroy(loaded);
            loaded = test_reload(NULL, by_end);
        }

        test_steps(by_hand, 1);
        test_steps(by_end, 1);
        if (loaded) test_steps(loaded, 1);
        if (step == 39) test_ok(by_hand, singe_sim_remove_pin(by_hand, removed));

        const SingeView a = singe_sim_view(by_hand), b = singe_sim_view(by_end);
        assert_memory_equal(a.position, b.position, a.particle_count * sizeof *a.position);
        assert_memory_equal(a.particle_flags, b.particle_flags, a.particle_count);
        if (loaded) test_assert_same(by_end, loaded);
    }

    uint32_t count;
    assert_null(singe_sim_pin_particles(by_end, ended, &count));
    assert_int_equal(count, 0);
    test_ok(by_end, singe_sim_move_pin(by_end, ended, 1, path)); // its handle is still good
    test_ok(by_end, singe_sim_remove_pin(by_end, ended));
    singe_sim_destroy(by_end);
    singe_sim_destroy(loaded);
}

TEST(a_turning_pin_turns) {
    SingeSimDef def = weightless();
    OwnSim *sim = test_sim(&def, test_grid(4, 4, 0.01f, 0.01f), NULL);
    SingePinDef pin = singe_default_pin();
    const uint32_t vertices[] = {0, 4};
    const float s = sqrtf(0.5f);
    SingePoseKey path[2] = {test_key(0, 0, 0, 0), {0.2f, {0, 0, 0}, {0, 0, s, s}}};

    pin.sheet = (SingeSheetId){0, 1}, pin.vertex_count = 2, pin.vertices = vertices, pin.path_count = 2,
    pin.path = path;
    test_add_pin(sim, &pin);
    test_steps(sim, 120);

    SingeView view = singe_sim_view(sim);
    assert_true(fabsf(view.position[4][0]) < 1e-6f && fabsf(view.position[4][1] - 0.04f) < 1e-6f);
    assert_true(fabsf(view.position[0][0]) < 1e-6f && fabsf(view.position[0][1]) < 1e-6f);
}

/// The nearest vertex of a point is never one that no cell uses.
TEST(unused_vertices_are_not_pinned) {
    TestMesh mesh = test_grid(2, 2, 0.01f, 0.01f);
    test_mesh_add_vertex(&mesh, 0.03f, 0.03f, 0);

    OwnSim *sim = test_sim(NULL, mesh, NULL);
    const float point[3] = {0.03f, 0.03f, 0};
    SingePinDef pin = singe_default_pin();
    pin.sheet = (SingeSheetId){0, 1}, pin.point_count = 1, pin.points = point, pin.radius = 0;
    test_add_pin(sim, &pin);
    assert_true(singe_sim_view(sim).particle_flags[8] & SINGE_PINNED);
    assert_int_equal(singe_sim_view(sim).particle_flags[9], 0);
}

TEST(pins_on_one_particle_are_limited) {
    OwnSim *sim = test_sim(NULL, test_grid(2, 2, 0.01f, 0.01f), NULL);
    const uint32_t vertex = 4;
    SingePinDef pin = singe_default_pin();
    SingePinId ids[256];

    pin.sheet = (SingeSheetId){0, 1}, pin.vertex_count = 1, pin.vertices = &vertex;
    for (int i = 0; i < 255; i++) test_ok(sim, singe_sim_add_pin(sim, &pin, &ids[i]));
    test_refused(sim, SINGE_ERROR_LIMIT, singe_sim_add_pin(sim, &pin, &ids[255]));
    assert_int_equal(singe_sim_error(sim)->element, 4);

    for (int i = 0; i < 255; i++) {
        assert_true(singe_sim_view(sim).particle_flags[4] & SINGE_PINNED);
        test_ok(sim, singe_sim_remove_pin(sim, ids[i]));
    }

    assert_false(singe_sim_view(sim).particle_flags[4] & SINGE_PINNED);
}

/// Neighbours pinned anywhere on a ring of springs, and all of it.
TEST(rings_can_be_pinned) {
    for (uint32_t first = 0; first < 9; first++) {
        OwnSim *sim = test_sim(NULL, test_cylinder(8, 4, 0.03f, 0.05f), NULL);
        uint32_t vertices[8];
        for (uint32_t k = 0; k < 8; k++) vertices[k] = first < 8 && k > 1 ? (first + 1) % 8 : (first + k) % 8;

        SingePinDef pin = singe_default_pin();
        pin.sheet = (SingeSheetId){0, 1}, pin.vertex_count = 8, pin.vertices = vertices;
        test_add_pin(sim, &pin);
        for (int i = 0; i < 20; i++)
            if (singe_sim_step(sim)) fail_msg("vertices from %u on pinned: %s", first, singe_sim_error(sim)->message);
    }
}

TEST(colliders_catch_move_and_go) {
    OwnSim *sim = test_sim(NULL, test_grid(8, 8, 0.01f, 0.01f), NULL);
    SingePoseKey low = test_key(0, 0, 0, -0.01f);
    SingeColliderDef def = singe_default_collider();
    def.path_count = 1, def.path = &low;
    SingeColliderId plane = test_add_collider(sim, &def);
    test_steps(sim, 240);

    SingeView view = singe_sim_view(sim);
    for (uint32_t i = 0; i < view.particle_count; i++) assert_true(view.position[i][2] > -0.01f);
    assert_true(mean_height(sim) < -0.008f);
    assert_true(singe_sim_timers(sim).contacts > 0);

    float now = (float)singe_sim_view(sim).time;
    SingePoseKey lift[2] = {test_key(now, 0, 0, -0.01f), test_key(now + 0.2f, 0, 0, 0.05f)};
    test_ok(sim, singe_sim_move_collider(sim, plane, 2, lift));
    test_steps(sim, 150);
    for (uint32_t i = 0; i < view.particle_count; i++) assert_true(view.position[i][2] > 0.05f);

    test_ok(sim, singe_sim_remove_collider(sim, plane));
    uint64_t contacts = singe_sim_timers(sim).contacts;
    test_steps(sim, 150);
    assert_true(mean_height(sim) < 0.02f);
    assert_int_equal(singe_sim_timers(sim).contacts, contacts);
}

TEST(hot_colliders_heat) {
    SingeSimDef def = weightless();
    OwnSim *sim = test_sim(&def, test_grid(4, 4, 0.01f, 0.01f), NULL);
    SingePoseKey key = test_key(0, 0, 0, -0.001f);
    SingeColliderDef plane = singe_default_collider();
    plane.path_count = 1, plane.path = &key, plane.conductance = 100, plane.temperature = 350;
    test_add_collider(sim, &plane);

    test_steps(sim, 60);
    assert_true(heat_in(sim) > 0);
    assert_true(singe_sim_stats(sim).temperature_max > 294 && singe_sim_stats(sim).temperature_max < 350);
}

TEST(wind_blows) {
    SingeSimDef def = weightless();
    TestMesh mesh = test_grid(6, 6, 0.01f, 0.01f);
    OwnSim *sim = test_sim(&def, mesh, NULL);

    test_steps(sim, 20);
    assert_true(fabsf(mean_height(sim)) < 1e-4f);

    SingeWindDef wind = singe_default_wind();
    wind.velocity[2] = 3;
    test_ok(sim, singe_sim_set_wind(sim, &wind));
    test_steps(sim, 60);
    assert_true(mean_height(sim) > 0.01f);
}

static float callback_seen_time;
static void flux_into_first(void *context, const struct SingeView *view, float *flux, float *conductance,
                            float *conductance_temperature) {
    (void)conductance, (void)conductance_temperature;
    flux[0] += *(float *)context;
    callback_seen_time = (float)view->time;
}

TEST(callbacks_can_be_exchanged) {
    SingeSimDef def = weightless();
    OwnSim *sim = test_sim(&def, test_grid(4, 4, 0.01f, 0.01f), NULL);
    SingeSourceDef source = singe_default_source();
    source.kind = SINGE_SOURCE_CALLBACK; // none yet
    SingeSourceId id = test_add_source(sim, &source);

    test_steps(sim, 2);
    assert_true(heat_in(sim) == 0);

    float flux = 1e4f;
    test_ok(sim, singe_sim_set_source_callback(sim, id, flux_into_first, &flux));

    double time = singe_sim_view(sim).time;
    test_ok(sim, singe_sim_step(sim));
    assert_true(callback_seen_time == (float)time);
    double area = (double)singe_sim_view(sim).area[0];
    assert_true(fabs(heat_in(sim) / (1e4 * area * (double)def.time_step) - 1) < 1e-5);
    test_ok(sim, singe_sim_set_source_callback(sim, id, NULL, NULL));

    double before = heat_in(sim);
    test_ok(sim, singe_sim_step(sim));
    assert_true(heat_in(sim) == before);
}

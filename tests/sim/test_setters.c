// Setters while the simulation runs, frames of any length, and the ranges of sheets.
#include "scenes.h"

/// A scene without its callback, which a load does not have.
static TestScene quiet_scene(uint32_t cells) {
    TestScene scene = scene_make(NULL, cells);
    test_ok(scene.sim, singe_sim_remove_source(scene.sim, scene.callback));
    return scene;
}

/// A snapshot has the values that were set: a loaded simulation makes the same steps.
static void assert_loads_the_same(SingeSim *sim) {
    OwnSim *loaded = test_reload(NULL, sim);
    test_assert_same(sim, loaded);
    test_steps_alike(sim, loaded, 15);
}

// ---- gravity, pace, ambient temperature

/// A value set before the first step has the effect of one in the Def.
TEST(set_at_once_is_set_in_the_def) {
    const float gravity[3] = {1, 0, -3};
    for (int k = 0; k < 3; k++) {
        SingeSimDef def = scene_def(), other = def;
        TestScene set, made;
        test_ok(NULL, scene_build(&def, 8, &set));
        if (k == 0) test_ok(set.sim, singe_sim_set_gravity(set.sim, gravity));
        if (k == 1) test_ok(set.sim, singe_sim_set_pace(set.sim, 1.5f * def.pace));
        if (k == 2) test_ok(set.sim, singe_sim_set_ambient_temperature(set.sim, 330));
        if (k == 0) memcpy(other.gravity, gravity, sizeof gravity);
        if (k == 1) other.pace *= 1.5f;
        if (k == 2) other.ambient_temperature = 330;

        test_ok(NULL, scene_build(&other, 8, &made));
        test_steps_alike(set.sim, made.sim, 20);
        singe_sim_destroy(set.sim);
        singe_sim_destroy(made.sim);
    }
}

TEST(set_later_is_saved) {
    const float gravity[3] = {0.5f, 0, -20};
    for (int k = 0; k < 3; k++) {
        OwnTestScene scene = quiet_scene(8), twin = quiet_scene(8);
        test_steps(scene.sim, 30);
        test_steps(twin.sim, 30);
        if (k == 0) test_ok(scene.sim, singe_sim_set_gravity(scene.sim, gravity));
        if (k == 1) test_ok(scene.sim, singe_sim_set_pace(scene.sim, 0.5f));
        if (k == 2) test_ok(scene.sim, singe_sim_set_ambient_temperature(scene.sim, 400));
        assert_loads_the_same(scene.sim);
        test_steps(twin.sim, 15);

        SingeStats a = singe_sim_stats(scene.sim), b = singe_sim_stats(twin.sim);
        assert_true(a.heat_lost != b.heat_lost || a.speed_rms_unburnt != b.speed_rms_unburnt); // it matters
        assert_true(a.ledger_error < 1e-4);
    }
}

/// Substeps that follow from the load do not change when a simulation with another gravity is loaded.
TEST(substeps_are_those_of_the_commit) {
    SingeSimDef def = singe_default_sim();
    def.solver.substeps = 0;
    SingeMaterialDef material = singe_default_material();
    material.compliance[SINGE_RED] = singe_param(1e3f);

    const float gravity[3] = {0, 0, -200};
    OwnSim *sim = test_sim(&def, test_grid(20, 20, 0.00125f, 0.00125f), &material);
    test_steps(sim, 3);
    test_ok(sim, singe_sim_set_gravity(sim, gravity));
    assert_loads_the_same(sim);
}

/// A sheet that lies still in warmer air takes heat from it, and its ledger goes on without a jump.
TEST(warmer_air_warms) {
    OwnSim *sim = test_sim(NULL, test_grid(6, 6, 0.01f, 0.01f), NULL);
    test_steps(sim, 10);
    assert_true(singe_sim_stats(sim).heat_lost == 0);
    test_ok(sim, singe_sim_set_pace(sim, 10));
    test_ok(sim, singe_sim_set_ambient_temperature(sim, 400));

    SingeStats at_once = singe_sim_stats(sim);
    assert_true(fabs(at_once.heat_stored) < 1e-9 && at_once.heat_lost == 0);
    assert_int_equal(singe_sim_timers(sim).steps, 10);
    test_steps(sim, 240);

    SingeStats stats = singe_sim_stats(sim);
    assert_true(stats.temperature_max > 300 && stats.temperature_max < 400);
    assert_true(stats.heat_lost < 0 && stats.ledgers_close);
}

TEST(refused_numbers_change_nothing) {
    TestScene scene = quiet_scene(8), twin = quiet_scene(8);
    SingeSim *sim = scene.sim;
    const float nowhere[3] = {0, NAN, 0}, sideways[3] = {20, 0, -1}, fast[3] = {0, 1e5f, 0}, share[4] = {0};
    SingeMaterialDef material = singe_default_material();
    material.ash_density = singe_param(-1);

    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_gravity(sim, nowhere));
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_set_gravity(sim, sideways)); // this scene has gas
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_pace(sim, 0));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_pace(sim, INFINITY));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_ambient_temperature(sim, 0.5f));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_set_velocity(sim, (SingeSheetId){9, 1}, 0, 1, nowhere));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_velocity(sim, scene.sheets[0], 0, 1, nowhere));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_velocity(sim, scene.sheets[0], 3, 1, fast));

    assert_int_equal(singe_sim_error(sim)->element, 3);
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_velocity(sim, scene.sheets[0], 80, 1000, nowhere));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_velocity(sim, scene.sheets[0], UINT32_MAX, 1, nowhere));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_set_material(sim, (SingeSheetId){2, 1}, &material, share));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_material(sim, scene.sheets[0], &material, NULL));
    material = singe_default_material();
    material.mass_min.field = &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "ours"};
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_material(sim, scene.sheets[0], &material, NULL));

    test_steps_alike(sim, twin.sim, 10);
    singe_sim_destroy(sim);
    singe_sim_destroy(twin.sim);
}

// ---- velocities

/// m/s, the largest difference between the velocities of the surface's vertices and their displacement from `from` on.
static float surface_differs(SingeSim *sim, float (*from)[3], double seconds) {
    OwnSurface surface = {0};
    test_ok(sim, singe_sim_surface(sim, &surface));

    float worst = 0;
    for (uint32_t v = 0; v < surface.vertex_count; v++)
        for (int k = 0; k < 3 && surface.source_vertex[v] >= 0; k++) {
            const float moved = surface.position[v][k] - from[surface.source_vertex[v]][k];
            worst = fmaxf(worst, fabsf(surface.velocity[v][k] - (seconds > 0 ? moved / (float)seconds : 0)));
        }

    return worst;
}

static void take_vertices(SingeSim *sim, float to[81][3]) {
    const SingeView view = singe_sim_view(sim);
    for (uint32_t v = 0; v < 81; v++) memcpy(to[v], view.position[v], sizeof to[v]);
}

TEST(surfaces_have_the_displacement_since_the_last_frame_as_velocity) {
    SingeSimDef def = singe_default_sim();
    def.velocity_steps = 4;
    def.air_density = 0;
    def.surface_detail = 1e-3f;
    OwnSim *sim = test_sim(&def, test_grid(8, 8, 0.01f, 0.01f), NULL);
    const double h = (double)def.time_step;
    float from[81][3];
    take_vertices(sim, from);
    assert_true(surface_differs(sim, from, 0) == 0); // the Def's velocity, before the first step

    // after whole frames, and between two
    test_steps(sim, 4);
    assert_true(surface_differs(sim, from, 4 * h) < 1e-6f);
    take_vertices(sim, from);
    test_steps(sim, 2);
    assert_true(surface_differs(sim, from, 2 * h) < 1e-6f);

    OwnSim *loaded = test_reload(NULL, sim);
    assert_true(surface_differs(loaded, from, 2 * h) < 1e-6f);
    test_steps(sim, 2);
    assert_true(surface_differs(sim, from, 4 * h) < 1e-6f);

    // the last substep is faster by the half of the frame that it is ahead of the mean
    const SingeView view = singe_sim_view(sim);
    assert_true(fabs(-(double)view.velocity[0][2] - 9.81 * 8 * h) < 0.1 * 9.81 * h);
}

TEST(velocities_throw) {
    SingeSimDef def = singe_default_sim();
    memset(def.gravity, 0, sizeof def.gravity);
    def.air_density = 0;
    def.contact.enabled = true;
    OwnSim *sim = test_sim(&def, test_grid(8, 8, 0.01f, 0.01f), NULL);
    SingeSheetId sheet;
    assert_int_equal(singe_sim_sheets(sim, &sheet, 1), 1);

    float up[81][3];
    for (int v = 0; v < 81; v++) up[v][0] = up[v][1] = 0, up[v][2] = 2;
    test_steps(sim, 5);
    test_ok(sim, singe_sim_set_velocity(sim, sheet, 0, 81, up[0]));
    SingeView view = singe_sim_view(sim);
    for (uint32_t i = 0; i < view.particle_count; i++) assert_true(fabsf(view.velocity[i][2] - 2) < 1e-5f);

    OwnSim *loaded = test_reload(NULL, sim);
    test_steps_alike(sim, loaded, 48);
    for (uint32_t i = 0; i < view.vertex_count; i++) assert_true(fabsf(view.position[i][2] - 0.2f) < 0.01f);

    // a corner alone, and nothing else at first
    test_ok(sim, singe_sim_set_velocity(sim, sheet, 80, 1, up[0]));
    test_ok(sim, singe_sim_set_velocity(sim, sheet, 81, 0, NULL));
}

// ---- materials

TEST(the_same_material_changes_nothing) {
    OwnTestScene scene = quiet_scene(8), twin = quiet_scene(8);
    SingeMaterialDef material = scene_quick_material();
    material.mass_rate = singe_param_field(material.mass_rate.value, 0.12f,
                                           &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {0.03f, 3, 5}});
    test_steps(scene.sim, 25);
    test_steps(twin.sim, 25);

    test_ok(scene.sim, singe_sim_set_material(scene.sim, scene.sheets[0], &material, NULL));
    test_assert_same(scene.sim, twin.sim);
    test_steps_alike(scene.sim, twin.sim, 25);
}

/// A strip that cannot burn stops the fire there, and only there.
TEST(a_wet_strip_stops_the_fire) {
    enum { N = 24 };
    float share[(N + 1) * (N + 1)];
    double burnt[2];
    for (int wet = 0; wet < 2; wet++) {
        SingeMaterialDef dry = singe_default_material(), soaked = dry;
        SingeSimDef def = singe_default_sim();
        def.pace = 20;

        OwnSim *sim = test_sim(&def, test_grid(N, N, 0.005f, 0.005f), &dry);
        SingeSheetId sheet;
        singe_sim_sheets(sim, &sheet, 1);
        soaked.ignition_temperature = singe_param(1e5f);
        for (int v = 0; v < (N + 1) * (N + 1); v++) share[v] = wet && v % (N + 1) > N / 2;
        test_spot(sim, 0, 0.06f, 0, 0.01f, 1200, 400);
        test_steps(sim, 20);
        test_ok(sim, singe_sim_set_material(sim, sheet, &soaked, share));
        test_steps(sim, 480);

        SingeView view = singe_sim_view(sim);
        for (uint32_t v = 0; wet && v < view.vertex_count; v++)
            if (share[v] > 0) assert_true(view.mass[v] == 1);
        assert_true(singe_sim_stats(sim).ledgers_close);
        burnt[wet] = singe_sim_stats(sim).burnt_fraction;
    }

    print_message("burnt: %.2f dry, %.2f with a wet half\n", burnt[0], burnt[1]);
    assert_true(burnt[0] > 1.4 * burnt[1] && burnt[1] > 0.05);
}

/// Materials of another mass_min, char and stiffness, in the middle of a fire with tears: finite, saved, and vertices
/// keep their numbers.
TEST(any_material_can_be_set_at_any_time) {
    SingeSimDef def = scene_def();
    def.solver.tearing = true;

    TestScene scene;
    test_ok(NULL, scene_build(&def, 12, &scene));
    test_ok(scene.sim, singe_sim_remove_source(scene.sim, scene.callback));
    test_steps(scene.sim, 60);
    SingeStats before = singe_sim_stats(scene.sim);
    assert_true(before.burnt_fraction > 0.02);

    SingeMaterialDef material = scene_quick_material();
    material.mass_min = singe_param(0.6f), material.mass_loss = singe_param(0.3f),
    material.char_yield = singe_param(0.7f);
    material.ash_density = singe_param(0.5f), material.strength = singe_param(1);
    material.compliance[SINGE_GREEN] = singe_param(3), material.grammage = singe_param(5),
    material.thickness = singe_param(1);
    test_ok(scene.sim, singe_sim_set_material(scene.sim, scene.sheets[0], &material, NULL));

    SingeStats after = singe_sim_stats(scene.sim);
    assert_true(after.mass == before.mass && after.mass_initial == before.mass_initial);
    assert_int_equal(after.tears, before.tears);
    assert_loads_the_same(scene.sim);
    test_steps(scene.sim, 60);
    assert_true(singe_sim_stats(scene.sim).mass_ledger_error < 1e-4);
    singe_sim_destroy(scene.sim);
}

/// If memory runs out, the simulation is unchanged.
TEST(without_memory_nothing_changes) {
    TestAllocator hook = {0};
    SingeSimDef def = scene_def();
    def.allocator = test_allocator(&hook);
    TestScene scene;
    test_ok(NULL, scene_build(&def, 4, &scene));
    test_steps(scene.sim, 5);

    TestBytes before = test_save(scene.sim);
    size_t held = singe_sim_counts(scene.sim).memory;
    SingeMaterialDef material = scene_quick_material();
    material.drag = singe_param(2);

    long refused = 0;
    for (int k = 0; k < 2; k++)
        for (long n = 1;; n++) {
            hook.fail_at = hook.calls + n, hook.once = true;
            SingeResult result = k ? singe_sim_set_ambient_temperature(scene.sim, 300)
                                   : singe_sim_set_material(scene.sim, scene.sheets[0], &material, NULL);
            hook.fail_at = 0;
            if (!result) break;
            assert_int_equal(result, SINGE_ERROR_MEMORY);
            if (k == 0 && n % 7 == 0) test_assert_saved(scene.sim, &before);
            refused++;
        }

    assert_true(refused > 200);
    assert_true(singe_sim_counts(scene.sim).memory < held + held / 4 && singe_sim_counts(scene.sim).memory > held / 2);
    test_steps(scene.sim, 3);
    free(before.data);
    singe_sim_destroy(scene.sim);
    test_allocator_check(&hook);
}

// ---- frames

/// A frame of any length has the steps that fit into it; its remainder is neither lost nor simulated twice.
TEST(frames_may_have_any_length) {
    OwnTestScene advanced = quiet_scene(8), stepped = quiet_scene(8);
    const double h = (double)scene_def().time_step, frames[] = {0.4, 1.7, 0, 3.1, 0.8, 12.5, 0.05};
    double sum = 0;
    uint32_t done = 0, events = 0;

    for (int round = 0; round < 4; round++)
        for (size_t k = 0; k < sizeof frames / sizeof *frames; k++) {
            uint32_t steps, whole;
            sum += frames[k];
            test_ok(advanced.sim, singe_sim_advance(advanced.sim, frames[k] * h, 0, &steps));
            done += steps;
            whole = (uint32_t)floor(sum + 1e-5);
            assert_int_equal(done, whole);
            assert_true(fabs(singe_sim_remainder(advanced.sim) / h - (sum - whole)) < 1e-5);
            size_t count, of_steps = 0, one;
            const SingeEvent *list = singe_sim_events(advanced.sim, &count);
            for (uint32_t i = 0; i < steps; i++) {
                test_ok(stepped.sim, singe_sim_step(stepped.sim));
                const SingeEvent *each = singe_sim_events(stepped.sim, &one);
                assert_true(of_steps + one <= count);
                assert_memory_equal(list + of_steps, each, one * sizeof *each);
                of_steps += one;
            }

            assert_int_equal(count, of_steps);
            events += (uint32_t)count;
        }

    print_message("%u steps, %u events\n", done, events);
    assert_true(events > 20);

    OwnSim *loaded = test_reload(NULL, advanced.sim); // with what is left
    test_ok(loaded, singe_sim_advance(loaded, 0.7 * h, 0, &done));
    test_ok(advanced.sim, singe_sim_advance(advanced.sim, 0.7 * h, 0, NULL));
    assert_true(singe_sim_remainder(loaded) == singe_sim_remainder(advanced.sim) && done == 0);

    test_ok(loaded, singe_sim_advance(loaded, 0.31 * h, 0, &done));
    test_ok(advanced.sim, singe_sim_advance(advanced.sim, 0.31 * h, 0, NULL));
    test_assert_same(loaded, advanced.sim);
}

/// A sum of float steps that is a whole frame in exact numbers is whole here.
TEST(frames_of_whole_steps_stay_whole) {
    SingeSimDef def = singe_default_sim();
    def.time_step = 1.0f / 480;
    OwnSim *sim = test_sim(&def, test_grid(2, 2, 0.01f, 0.01f), NULL);
    for (int frame = 0; frame < 200; frame++) {
        uint32_t steps;
        test_ok(sim, singe_sim_advance(sim, 1.0 / 24, 0, &steps));
        assert_int_equal(steps, 20);
    }
}

TEST(advance_takes_at_most_max_steps) {
    OwnSim *sim = test_sim(NULL, test_grid(2, 2, 0.01f, 0.01f), NULL);
    const double h = (double)singe_default_sim().time_step;
    uint32_t steps;

    test_ok(sim, singe_sim_advance(sim, 10.25 * h, 4, &steps));
    assert_int_equal(steps, 4);
    assert_true(fabs(singe_sim_remainder(sim) - 0.25 * h) < 1e-9);
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_advance(sim, -1, 0, &steps));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_advance(sim, NAN, 0, &steps));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_advance(sim, INFINITY, 0, NULL));
    assert_int_equal(steps, 0);
    assert_int_equal(singe_sim_view(sim).step, 4);
}

// ---- ranges

TEST(ranges_stay_through_tears) {
    SingeSimDef def = singe_default_sim();
    SingeMaterialDef weak = singe_default_material();

    def.solver.tearing = true;
    weak.strength = singe_param(0.05f), weak.char_strength = singe_param(0.05f);
    OwnSim *sim = test_sim(&def, test_grid(10, 10, 0.01f, 0.01f), &weak);
    SingeSheetId sheet;
    singe_sim_sheets(sim, &sheet, 1);

    const uint32_t corners[] = {0, 10};
    SingePinDef pin = singe_default_pin();
    pin.sheet = sheet, pin.vertex_count = 2, pin.vertices = corners;
    test_add_pin(sim, &pin);

    SingeSheetRange before = singe_sim_sheet_range(sim, sheet);
    assert_int_equal(before.vertex_count, 121);
    assert_int_equal(before.torn_count, 0);
    assert_true(before.reserve_count > 0);
    test_steps(sim, 240);

    SingeSheetRange range = singe_sim_sheet_range(sim, sheet);
    SingeView view = singe_sim_view(sim);
    print_message("%u tears\n", range.torn_count);
    assert_true(range.torn_count > 3);
    assert_int_equal(range.torn_count, singe_sim_stats(sim).tears);

    for (uint32_t v = 0; v < range.reserve_count; v++) {
        int32_t source = view.source_vertex[range.vertex_first + range.vertex_count + v];
        if (v < range.torn_count) assert_true(source >= 0 && source < 121);
        else assert_int_equal(source, -1);
    }

    for (uint32_t v = 0; v < range.vertex_count; v++) assert_int_equal(view.source_vertex[range.vertex_first + v], v);
    range.torn_count = before.torn_count;
    assert_memory_equal(&range, &before, sizeof range);
    range = singe_sim_sheet_range(sim, (SingeSheetId){3, 1});
    assert_int_equal(range.vertex_count, 0);
    assert_int_equal(range.struct_size, sizeof range);
}

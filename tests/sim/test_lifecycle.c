// Create, add, commit, step, read: what is allowed when, and how particles are numbered.
#include "scenes.h"

#include <locale.h>

static SingeSim *create(void) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim = test_create(&def);
    return sim;
}

TEST(calls_before_the_commit_are_refused) {
    SingeSim *sim = create(), *copy = sim;
    assert_int_equal(singe_sim_error(sim)->code, SINGE_OK);
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_step(sim));
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_commit(sim));

    SingeSourceDef source = singe_default_source();
    SingeSourceId source_id = {1, 1};
    source.radius = -1;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_source(sim, &source, &source_id));
    assert_int_equal(source_id.generation, 0);

    SingeColliderDef collider = singe_default_collider();
    SingeColliderId collider_id;
    collider.rotation[3] = 0;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_collider(sim, &collider, &collider_id));

    SingePinDef pin = singe_default_pin(); // of no sheet
    SingePinId pin_id;
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_add_pin(sim, &pin, &pin_id));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_source(sim, (SingeSourceId){0, 1}));

    uint8_t *bytes = (uint8_t *)1;
    size_t size = 1;
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_save(sim, &bytes, &size));
    assert_null(bytes);
    assert_int_equal(size, 0);
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_clone(sim, &copy));
    assert_null(copy);

    SingeSurface surface = {0};
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_surface(sim, &surface));

    SingeStats stats = singe_sim_stats(sim);
    assert_int_equal(stats.particles, 0);
    size_t count = 1;
    singe_sim_events(sim, &count);
    assert_int_equal(count, 0);

    SingeWindDef wind = singe_default_wind();
    test_ok(sim, singe_sim_set_wind(sim, &wind));
    singe_sim_destroy(sim);
    singe_sim_destroy(NULL);
}

TEST(sheets_after_the_commit_are_refused) {
    OwnSim *sim = test_sim(NULL, test_grid(3, 3, 0.01f, 0.01f), NULL);
    OwnTestMesh mesh = test_grid(1, 1, 1, 1);
    SingeSheetDef sheet = test_sheet(&mesh);
    SingeSheetId id = {7, 7};

    test_refused(sim, SINGE_ERROR_STATE, singe_sim_add_sheet(sim, &sheet, &id));
    assert_int_equal(id.generation, 0);
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_commit(sim));
    test_ok(sim, singe_sim_step(sim));
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_add_sheet(sim, &sheet, &id));
}

/// A sheet that is refused leaves the simulation as it was; so does a commit that is refused.
TEST(a_refused_sheet_changes_nothing) {
    SingeSim *sim = create();
    OwnTestMesh good = test_grid(2, 2, 0.01f, 0.01f), bad = test_grid(2, 2, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&bad);
    SingeSheetId id;

    bad.cells[5] = 99;
    test_refused(sim, SINGE_ERROR_MESH, singe_sim_add_sheet(sim, &sheet, &id));
    assert_int_equal(singe_sim_error(sim)->element, 1);
    bad.cells[5] = 2;
    bad.positions[3] = NAN;
    test_refused(sim, SINGE_ERROR_MESH, singe_sim_add_sheet(sim, &sheet, &id));
    bad.positions[3] = 0.01f;
    sheet.material.thickness = singe_param(-1);
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_sheet(sim, &sheet, &id));

    SingeSheetDef fine = test_sheet(&good);
    test_ok(sim, singe_sim_add_sheet(sim, &fine, &id));
    assert_int_equal(id.index, 0);
    assert_int_equal(id.generation, 1);
    test_ok(sim, singe_sim_commit(sim));
    assert_int_equal(singe_sim_view(sim).cell_count, 4);
    test_steps(sim, 2);
    singe_sim_destroy(sim);

    sim = create(); // the third cell on one edge is found at the commit
    OwnTestMesh fan = test_grid(1, 2, 0.01f, 0.01f);
    for (int i = 0; i < 2; i++) test_mesh_add_vertex(&fan, 0.01f * (float)i, 0.005f, 0.02f);
    uint32_t cells[12];
    memcpy(cells, fan.cells, sizeof fan.cells[0] * 8);
    memcpy(cells + 8, (uint32_t[]){2, 3, 7, 6}, 4 * sizeof *cells);

    SingeSheetDef branching = test_sheet(&fan);
    branching.cell_count = 3, branching.cells = cells;
    SingeResult added = singe_sim_add_sheet(sim, &branching, &id);
    test_refused(sim, SINGE_ERROR_MESH, added ? added : singe_sim_commit(sim));
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_step(sim));
    singe_sim_destroy(sim);
    sim = create(); // a front that no cell comes near to is found there too, and a commit can be tried again
    fine.material.mass_rate = singe_param(1e12f);
    test_ok(sim, singe_sim_add_sheet(sim, &fine, &id));

    for (int k = 0; k < 2; k++) {
        test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_commit(sim));
        assert_non_null(strstr(singe_sim_error(sim)->message, "thickening"));
    }

    singe_sim_destroy(sim);
}

TEST(particles_are_numbered_as_documented) {
    OwnSim *sim = create();
    OwnTestMesh first = test_grid(2, 3, 0.01f, 0.02f), second = test_grid(1, 1, 0.03f, 0.03f);
    test_mesh_add_vertex(&first, 5, 5, 5);
    test_mesh_move(&second, 1, 0, 0);
    SingeSheetDef a = test_sheet(&first), b = test_sheet(&second);
    b.velocity[0] = 2;

    SingeSheetId id = test_add_sheet(sim, &a);
    test_ok(sim, singe_sim_add_sheet(sim, &b, &id));
    assert_int_equal(id.index, 1);
    test_ok(sim, singe_sim_commit(sim));

    SingeView view = singe_sim_view(sim);
    assert_int_equal(view.vertex_count, 13 + 4);
    assert_int_equal(view.cell_count, 6 + 1);
    assert_int_equal(view.particle_count, 24);
    for (uint32_t v = 0; v < 13; v++) assert_memory_equal(view.position[v], first.positions + 3 * v, 12);

    for (uint32_t v = 0; v < 4; v++) {
        assert_memory_equal(view.position[13 + v], second.positions + 3 * v, 12);
        assert_memory_equal(view.uv[13 + v], second.uv + 2 * v, 8);
        assert_true(view.velocity[13 + v][0] == 2);
    }

    for (int k = 0; k < 4; k++) assert_int_equal(view.cells[6][k], 13 + second.cells[k]);

    // the centre of the last cell: above its middle by the thickness, in front
    const float *centre = view.position[23];
    assert_true(fabsf(centre[0] - 1.015f) < 1e-6f && fabsf(centre[1] - 0.015f) < 1e-6f &&
                fabsf(centre[2] - singe_default_material().thickness.value) < 1e-6f);
    assert_true(fabsf(view.uv[23][0] - 0.5f) < 1e-6f);

    // the unused vertex is there, but never lives
    assert_int_equal(view.particle_flags[12] & SINGE_ALIVE, 0);
    assert_int_equal(view.piece[12], -1);
    assert_true(view.area[12] == 0);
    assert_int_equal(singe_sim_stats(sim).particles, 23);
    assert_int_equal(singe_sim_stats(sim).pieces, 2);
    assert_int_equal(view.piece[0], 0);
    assert_int_equal(view.piece[13], 1);

    float still[3];
    memcpy(still, view.position[12], sizeof still);
    test_steps(sim, 5);
    assert_memory_equal(view.position[12], still, sizeof still);

    SingeCounts counts = singe_sim_counts(sim);
    assert_int_equal(counts.particles, 23);
    assert_int_equal(counts.cells, 7);
    assert_int_equal(counts.springs[SINGE_RED], 28);
    assert_int_equal(counts.springs[SINGE_YELLOW], 14);
    assert_int_equal(counts.springs[SINGE_BLUE], 17 + 4);
    assert_int_equal(counts.springs[SINGE_GREEN], 7);
}

typedef struct Heard {
    int lines[3];
    char last[3][256];
} Heard;

static void hear(void *context, SingeLogLevel level, const char *line) {
    Heard *heard = context;
    heard->lines[level]++;
    snprintf(heard->last[level], sizeof heard->last[level], "%s", line);
}

/// The log's lines are the same where the host's decimal point is a comma.
TEST(the_log_has_no_locale) {
    if (!test_comma_locale()) skip();
    Heard heard = {0};
    SingeSimDef def = singe_default_sim();
    def.log = (SingeLog){hear, &heard};
    def.time_step = 0.1f;
    SingeSim *sim = test_sim(&def, test_grid(8, 8, 0.005f, 0.005f), NULL);
    singe_sim_destroy(sim);
    setlocale(LC_ALL, "C");
    assert_non_null(strstr(heard.last[SINGE_LOG_WARNING], "12.5 ms"));
}

/// The commit reports what was built; a step too long for the cells causes a warning.
TEST(the_commit_is_logged) {
    for (int slow = 0; slow < 2; slow++) {
        Heard heard = {0};
        SingeSimDef def = singe_default_sim();
        def.log = (SingeLog){hear, &heard};
        if (slow) def.time_step = 0.1f;

        OwnSim *sim = test_sim(&def, test_grid(8, 8, 0.005f, 0.005f), NULL);
        assert_int_equal(heard.lines[SINGE_LOG_INFO], 2);
        assert_non_null(strstr(heard.last[SINGE_LOG_INFO], "cells of 5 mm"));
        assert_int_equal(heard.lines[SINGE_LOG_WARNING], slow);
        if (slow) assert_non_null(strstr(heard.last[SINGE_LOG_WARNING], "12.5 ms"));
        test_steps(sim, 1);
        assert_int_equal(heard.lines[SINGE_LOG_INFO] + heard.lines[SINGE_LOG_WARNING], 2 + slow);
    }
}

/// A sheet that begins more than a cell behind a plane causes a warning in the first step; one that lies on it does
/// not.
TEST(sheets_that_begin_inside_a_collider_are_logged) {
    for (int deep = 0; deep < 2; deep++) {
        Heard heard = {0};
        SingeSimDef def = singe_default_sim();
        def.log = (SingeLog){hear, &heard};
        OwnSim *sim = test_sim(&def, test_grid(8, 8, 0.005f, 0.005f), NULL);
        SingeColliderDef plane = singe_default_collider();
        SingePoseKey key = {.position = {0, 0, deep ? 0.0041f : 0.0039f}, .rotation = {0, 0, 0, 1}};

        plane.path_count = 1, plane.path = &key, plane.offset = 1e-3f;
        test_add_collider(sim, &plane);
        test_steps(sim, 2);
        assert_int_equal(heard.lines[SINGE_LOG_WARNING], deep);

        const char *reported = "100 % of the sheets begin inside it, up to 0.0051 m";
        if (deep) assert_non_null(strstr(heard.last[SINGE_LOG_WARNING], reported));
    }
}

/// A pin's point that misses its sheet causes one warning, before the commit and after it; one that is near does not.
TEST(pins_that_miss_their_sheet_are_logged) {
    static const float points[2][6] = {{0, 0, 0.002f, 0, 0, 0.004f}, {0, 0, 0.3f, 0, 0, 0.4f}};
    for (int late = 0; late < 2; late++)
        for (int misses = 0; misses < 2; misses++) {
            Heard heard = {0};
            SingeSimDef def = singe_default_sim();
            def.log = (SingeLog){hear, &heard};
            OwnTestMesh mesh = test_grid(8, 8, 0.005f, 0.005f);
            const SingeSheetDef sheet = test_sheet(&mesh);
            SingePinDef pin = singe_default_pin();
            OwnSim *sim = test_create(&def);
            const SingeSheetId id = test_add_sheet(sim, &sheet);
            pin.sheet = id;
            pin.point_count = 2;
            pin.points = points[misses];
            pin.radius = 0;

            if (late) test_ok(sim, singe_sim_commit(sim));
            test_add_pin(sim, &pin);
            if (!late) test_ok(sim, singe_sim_commit(sim));
            assert_int_equal(heard.lines[SINGE_LOG_WARNING], misses);
            if (misses)
                assert_non_null(strstr(heard.last[SINGE_LOG_WARNING], "pin 0: its point [0, 0, 0.3] m misses sheet"));
        }
}

TEST(timers_and_time_grow) {
    OwnTestScene scene = scene_make(NULL, 10);
    SingeTimers last = singe_sim_timers(scene.sim);
    assert_int_equal(last.steps, 0);

    for (int i = 1; i <= 40; i++) {
        test_ok(scene.sim, singe_sim_step(scene.sim));
        SingeTimers now = singe_sim_timers(scene.sim);
        SingeView view = singe_sim_view(scene.sim);

        assert_int_equal(now.steps, i);
        assert_int_equal(view.step, i);
        assert_true(view.time == i * (double)(1.0f / 240));
        assert_true(now.strands_projected > last.strands_projected);
        assert_true(now.heat_iterations >= last.heat_iterations && now.contacts >= last.contacts);
        for (int stage = 0; stage < SINGE_STAGE_COUNT; stage++) assert_true(now.seconds[stage] >= last.seconds[stage]);
        last = now;
    }

    assert_true(last.heat_iterations > 40 && last.contacts > 0);
    for (int stage = 0; stage < SINGE_STAGE_COUNT; stage++)
        assert_true(last.seconds[stage] > 0 && last.seconds[stage] < 60);
}

static void count_warnings(void *context, SingeLogLevel level, const char *line) {
    *(int *)context += level == SINGE_LOG_WARNING && strstr(line, "iterations") != NULL;
}

/// Steps too long for the solver of the heat equation are taken all the same, and one line reports it.
TEST(conduction_cut_short_is_warned_of_once) {
    int warnings = 0;
    SingeSimDef def = singe_default_sim();
    def.log = (SingeLog){count_warnings, &warnings};

    SingeMaterialDef material = singe_default_material();
    material.convection = material.emissivity = singe_param(0);

    SingeSim *sim = test_sim(&def, test_grid(600, 1, 0.002f, 0.002f), &material);
    test_spot(sim, 0, 0, 0, 0.1f, 400, 50);
    test_steps(sim, 2);
    assert_int_equal(warnings, 0);
    singe_sim_destroy(sim);

    def.pace = 1e5f;
    sim = test_sim(&def, test_grid(600, 1, 0.002f, 0.002f), &material);
    test_spot(sim, 0, 0, 0, 0.1f, 400, 50);
    test_steps(sim, 3);
    assert_int_equal(warnings, 1);
    singe_sim_destroy(sim);
}

typedef struct HeardSubsteps {
    int chosen; ///< by the solver, where the Def's number is not taken
    bool warned;
} HeardSubsteps;

static void hear_substeps(void *context, SingeLogLevel level, const char *line) {
    HeardSubsteps *heard = context;
    const char *chooses = strstr(line, "solver: ");
    if (!chooses) return;
    sscanf(chooses, "solver: %d", &heard->chosen);
    heard->warned = level == SINGE_LOG_WARNING;
}

/// Tissue that may tear in its plume takes as many substeps as carry it, not the three that it is given, and says so: by
/// stiffness alone it would take 1. Half as many are left as they are; so is office paper, and tissue that cannot tear.
TEST(substeps_follow_from_mass_and_load) {
    static const struct {
        int substeps;
        float grammage;
        bool tearing;
    } cases[] = {{0, 0.02f, true}, {3, 0.02f, true}, {4, 0.02f, true}, {3, 0.08f, true}, {3, 0.02f, false}};

    HeardSubsteps heard[5] = {{0}};
    for (int k = 0; k < 5; k++) {
        SingeSimDef def = singe_default_sim();
        def.solver.tearing = cases[k].tearing;
        def.gas.enabled = true;
        def.solver.substeps = cases[k].substeps;
        def.log = (SingeLog){hear_substeps, &heard[k]};

        SingeMaterialDef material = singe_default_material();
        material.grammage = singe_param(cases[k].grammage);
        material.compliance[SINGE_RED] = singe_param(1e3f); // soft
        singe_sim_destroy(test_sim(&def, test_grid(60, 60, 0.00125f, 0.00125f), &material));
    }

    print_message("%d substeps carry it\n", heard[0].chosen);
    assert_in_range(heard[0].chosen, 7, 8);
    assert_false(heard[0].warned);
    assert_int_equal(heard[1].chosen, heard[0].chosen);
    assert_true(heard[1].warned);
    for (int k = 2; k < 5; k++) assert_int_equal(heard[k].chosen, 0);
}

TEST(every_byte_is_counted_and_freed) {
    TestAllocator hook = {0};
    SingeSimDef def = scene_def();
    def.allocator = test_allocator(&hook);
    TestScene scene = scene_make(&def, 8);
    assert_int_equal(singe_sim_counts(scene.sim).memory, hook.bytes);
    test_steps(scene.sim, 3);

    SingeSurface surface = {0};
    size_t before = hook.bytes;

    test_ok(scene.sim, singe_sim_surface(scene.sim, &surface));
    assert_true(surface.triangle_count > 0);
    singe_surface_free(&surface);
    assert_int_equal(hook.bytes, before);
    assert_int_equal(singe_sim_counts(scene.sim).memory, hook.bytes);
    singe_sim_destroy(scene.sim);
    assert_int_equal(hook.blocks, 0);
    assert_int_equal(hook.bytes, 0);
    assert_int_equal(hook.faults, 0);
}

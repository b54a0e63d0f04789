// Bad Defs, beyond the ranges of their fields (test_ranges.c), and Defs of older and newer headers.
#include "scenes.h"

/// The simulation's Def with one field changed is refused and the message names the field.
#define SIM_BAD(field, value, word)                                                   \
    do {                                                                              \
        SingeSimDef def_ = singe_default_sim();                                       \
        def_.field = (value);                                                         \
        SingeSim *sim_ = (SingeSim *)1;                                               \
        SingeError error_ = {0};                                                      \
        if (singe_sim_create(&def_, &sim_, &error_) != SINGE_ERROR_ARGUMENT)          \
            fail_msg(#field " = " #value " was taken");                               \
        assert_null(sim_);                                                            \
        assert_int_equal(error_.code, SINGE_ERROR_ARGUMENT);                          \
        if (!strstr(error_.message, (word))) fail_msg(#field ": %s", error_.message); \
        assert_int_equal(singe_sim_create(&def_, &sim_, NULL), SINGE_ERROR_ARGUMENT); \
    } while (0)

TEST(bad_simulations_are_refused) {
    SingeSolverDef paper = singe_default_sim().solver;
    paper.method = SINGE_SOLVER_PAPER;
    paper.isotropic = true;
    SIM_BAD(solver, paper, "isotropic");
    SIM_BAD(solver.order[0], SINGE_RED, "order");
    SIM_BAD(solver.order[3], (SingeColour)4, "order");
    SIM_BAD(wind.gust, -1, "gust");
    SIM_BAD(struct_size, 0, "struct_size");
    SIM_BAD(struct_size, sizeof(size_t), "struct_size");
    SIM_BAD(struct_size, sizeof(SingeSimDef) - 1, "struct_size");
    SIM_BAD(struct_size, sizeof(SingeSimDef) + 3, "struct_size");
    SIM_BAD(struct_size, (size_t)1 << 20, "struct_size");
    SIM_BAD(struct_size, SIZE_MAX / 8 * 8, "struct_size");
    SIM_BAD(wind.struct_size, sizeof(SingeWindDef) - 2, "struct_size");
    SIM_BAD(wind.struct_size, 0, "struct_size");
    SIM_BAD(solver.struct_size, 0, "struct_size");
    SIM_BAD(wind.struct_size, 1 << 20, "struct_size");
    SIM_BAD(gas.struct_size, 0, "struct_size");
}

static void *no_enqueue(void *context, SingeTaskFn *run, void *task, int count, int grain) {
    (void)grain;
    run(task, 0, count);
    return context;
}

TEST(half_a_task_hook_is_refused) { SIM_BAD(tasks.enqueue, no_enqueue, "tasks"); }

static SingeSim *small_sim(void) { return test_sim(NULL, test_grid(4, 4, 0.01f, 0.01f), NULL); }

#define SOURCE_BAD(kind_, change)                                                      \
    do {                                                                               \
        SingeSourceDef def = singe_default_source();                                   \
        def.kind = (kind_);                                                            \
        def.path_count = 1, def.path = &key;                                           \
        def.texture = (SingeTexture){1, 1, &grey};                                     \
        SingeSourceId id = {1, 1};                                                     \
        change;                                                                        \
        test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_source(sim, &def, &id)); \
        assert_string_equal(singe_sim_error(sim)->stage, "source");                    \
        assert_int_equal(id.generation, 0);                                            \
    } while (0)

TEST(bad_sources_are_refused) {
    OwnSim *sim = small_sim();
    SingePoseKey key = test_key(0, 0, 0, 0), keys[2] = {key, key};
    const float grey = 1, nan_grey = NAN;
    SingeValueKey strengths[2] = {{0, 1}, {0, 1}};

    SOURCE_BAD(SINGE_SOURCE_BALL, def.struct_size = 0);
    SOURCE_BAD(SINGE_SOURCE_BALL, def.struct_size = sizeof(SingeSourceDef) + 1);
    SOURCE_BAD(SINGE_SOURCE_BALL, def.struct_size = 1 << 20);
    SOURCE_BAD(SINGE_SOURCE_BALL, (def.path_count = 0, def.position[1] = NAN));
    SOURCE_BAD(SINGE_SOURCE_BALL, def.path = NULL);
    SOURCE_BAD(SINGE_SOURCE_BALL, (def.path = keys, def.path_count = 2)); // not later than the one before
    SOURCE_BAD(SINGE_SOURCE_SPOT, (keys[1].time = 1, def.path = keys, def.path_count = 2));
    SOURCE_BAD(SINGE_SOURCE_TEXTURE, def.texture.width = 0);
    SOURCE_BAD(SINGE_SOURCE_TEXTURE, def.texture.height = -1);
    SOURCE_BAD(SINGE_SOURCE_TEXTURE, def.texture.values = NULL);
    SOURCE_BAD(SINGE_SOURCE_TEXTURE, def.texture.values = &nan_grey);
    SOURCE_BAD(SINGE_SOURCE_TEXTURE, def.strength_count = 2);
    SOURCE_BAD(SINGE_SOURCE_TEXTURE, (def.strength_count = 2, def.strength = strengths));
    SOURCE_BAD(SINGE_SOURCE_JET, def.direction[2] = 0);
    SOURCE_BAD(SINGE_SOURCE_JET, def.blow_out = 0);
    SOURCE_BAD(SINGE_SOURCE_VORTEX, def.speed = -1);
    SOURCE_BAD(SINGE_SOURCE_ATTRACT, (def.path_count = 0, def.position[1] = NAN));
    SOURCE_BAD(SINGE_SOURCE_TURBULENCE, (def.strength_count = 2, def.strength = strengths));
    SOURCE_BAD(SINGE_SOURCE_TURBULENCE, (strengths[0].value = 1e3f, def.strength_count = 1, def.strength = strengths));

    strengths[0].value = -1e4f;
    SOURCE_BAD(SINGE_SOURCE_TEXTURE, (def.flux = 1e12f, def.strength_count = 1, def.strength = strengths));
    SOURCE_BAD((SingeSourceKind)17, (void)0);
    SOURCE_BAD((SingeSourceKind)-1, (void)0);
    test_steps(sim, 2);
}

#define PIN_BAD(result, change)                                         \
    do {                                                                \
        SingePinDef def = singe_default_pin();                          \
        def.sheet = (SingeSheetId){0, 1};                               \
        def.point_count = 1, def.points = point;                        \
        SingePinId id = {1, 1};                                         \
        change;                                                         \
        test_refused(sim, (result), singe_sim_add_pin(sim, &def, &id)); \
        assert_string_equal(singe_sim_error(sim)->stage, "pin");        \
        assert_int_equal(id.generation, 0);                             \
    } while (0)

TEST(bad_pins_are_refused) {
    OwnSim *sim = small_sim();
    const float point[3] = {0, 0, 0}, bad_point[3] = {0, NAN, 0}, far_point[3] = {1e30f, 0, 0};
    const uint32_t vertices[2] = {0, 25};
    SingePoseKey key = test_key(NAN, 0, 0, 0);

    PIN_BAD(SINGE_ERROR_ARGUMENT, def.struct_size = 0);
    PIN_BAD(SINGE_ERROR_HANDLE, def.sheet.index = 1);
    PIN_BAD(SINGE_ERROR_HANDLE, def.sheet.generation = 0);
    PIN_BAD(SINGE_ERROR_ARGUMENT, def.point_count = 0);
    PIN_BAD(SINGE_ERROR_ARGUMENT, def.points = NULL);
    PIN_BAD(SINGE_ERROR_ARGUMENT, def.points = bad_point);
    PIN_BAD(SINGE_ERROR_ARGUMENT, def.points = far_point);
    PIN_BAD(SINGE_ERROR_ARGUMENT, def.vertex_count = 2);
    PIN_BAD(SINGE_ERROR_ARGUMENT, (def.vertex_count = 2, def.vertices = vertices));

    assert_int_equal(singe_sim_error(sim)->element, 1);
    PIN_BAD(SINGE_ERROR_ARGUMENT, (def.path_count = 1, def.path = &key));
    PIN_BAD(SINGE_ERROR_ARGUMENT, def.path_count = 1);

    SingeView view = singe_sim_view(sim);
    for (uint32_t i = 0; i < view.particle_count; i++) assert_int_equal(view.particle_flags[i], SINGE_ALIVE);
}

TEST(bad_colliders_and_wind_are_refused) {
    OwnSim *sim = small_sim();
    SingeColliderDef def = singe_default_collider();
    SingeColliderId id;
    def.rotation[3] = 0;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_collider(sim, &def, &id)); // without a path, no rotation

    SingePoseKey key = {0, {0, 0, 0}, {0, 0, 0, 0}};
    def.path_count = 1, def.path = &key;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_collider(sim, &def, &id)); // no rotation
    def.path = NULL;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_collider(sim, &def, &id));

    key.rotation[3] = 1;
    def.path = &key, def.struct_size = 0;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_collider(sim, &def, &id));
    for (int kind = -1; kind < 18; kind += 18) {
        def = singe_default_collider();
        def.kind = (SingeColliderKind)kind;
        test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_collider(sim, &def, &id));
        assert_non_null(strstr(singe_sim_error(sim)->message, "kind"));
    }

    SingeWindDef wind = singe_default_wind();
    wind.struct_size = 0;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_wind(sim, &wind));
    test_steps(sim, 1);
}

/// The size of an older header's struct whose fields end there, or before the padding that it would need.
#define OLDER(Type, field) (offsetof(Type, field) / sizeof(size_t) * sizeof(size_t))

/// Fields beyond an older header's struct_size hold rubbish that must not be read.
TEST(rubbish_beyond_an_older_def_is_not_read) {
    SingeSimDef def = singe_default_sim();
    def.struct_size = OLDER(SingeSimDef, heat_tolerance);
    def.heat_tolerance = NAN, def.wind.struct_size = 0, def.solver.substeps = -1;
    OwnSim *sim = test_create(&def);
    OwnTestMesh mesh = test_grid(4, 4, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&mesh);
    sheet.struct_size = OLDER(SingeSheetDef, drop_pieces_below);
    sheet.drop_pieces_below = NAN;

    SingeSheetId sheet_id = test_add_sheet(sim, &sheet);
    sheet.struct_size = OLDER(SingeSheetDef, material);
    memset(&sheet.material, 0xFF, sizeof sheet.material);
    test_mesh_move(&mesh, 1, 0, 0);
    test_ok(sim, singe_sim_add_sheet(sim, &sheet, &sheet_id));
    test_ok(sim, singe_sim_commit(sim));

    SingePoseKey key = test_key(0, 0, 0, -1);
    SingeSourceDef source = singe_default_source();
    source.path_count = 1, source.path = &key;
    source.struct_size = OLDER(SingeSourceDef, texture);
    source.texture.width = -1, source.callback = (SingeFluxFn *)1;
    test_add_source(sim, &source);

    SingePinDef pin = singe_default_pin();
    const uint32_t vertex = 0;
    pin.sheet = sheet_id, pin.vertex_count = 1, pin.vertices = &vertex;
    pin.struct_size = OLDER(SingePinDef, path_count);
    pin.path_count = 99, pin.path = NULL;
    test_add_pin(sim, &pin);

    SingeWindDef wind = singe_default_wind();
    wind.struct_size = OLDER(SingeWindDef, gust_time);
    wind.gust = 1, wind.gust_time = NAN;
    test_ok(sim, singe_sim_set_wind(sim, &wind));
    test_steps(sim, 3);
}

/// An older header's wind inside the simulation's Def is smaller, and what comes after it lies earlier.
TEST(a_def_inside_may_be_older) {
    SingeSimDef def = singe_default_sim();
    def.wind.gust = 0.25f;
    def.wind.struct_size = offsetof(SingeWindDef, gust_size);
    def.solver.substeps = 5;
    _Alignas(max_align_t) unsigned char bytes[sizeof def];
    memset(bytes, 0xFF, sizeof bytes);

    size_t head = offsetof(SingeSimDef, wind), inner = (def.wind.struct_size + 7) / 8 * 8;
    def.wind.struct_size = inner; // an old struct's size is a multiple of its alignment
    memcpy(bytes, &def, head);
    memcpy(bytes + head, &def.wind, inner);
    memcpy(bytes + head + inner, &def.solver, sizeof def.solver);
    size_t size = head + inner + sizeof def.solver;
    memcpy(bytes, &size, sizeof size);

    SingeSim *old, *new;
    SingeSimDef *given = (SingeSimDef *)(void *)bytes;
    assert_int_equal(singe_sim_create(given, &old, NULL), SINGE_OK);
    def.wind.struct_size = sizeof def.wind;
    assert_int_equal(singe_sim_create(&def, &new, NULL), SINGE_OK);

    OwnTestMesh mesh = test_grid(6, 6, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&mesh);
    SingeSim *both[2] = {old, new};
    for (int i = 0; i < 2; i++) {
        test_add_sheet(both[i], &sheet);
        test_ok(both[i], singe_sim_commit(both[i]));
        test_steps(both[i], 5);
    }

    test_assert_same(old, new);
    singe_sim_destroy(old);
    singe_sim_destroy(new);
}

TEST(fields_of_newer_defs_are_ignored) {
    struct {
        SingeWindDef wind;
        double unknown[4];
    } wind = {singe_default_wind(), {NAN, 1, 2, 3}};

    wind.wind.struct_size = sizeof wind;
    OwnSim *sim = small_sim();
    test_ok(sim, singe_sim_set_wind(sim, &wind.wind));
    test_steps(sim, 1);
}

/// The simulation copies what it is given.
TEST(defs_are_copied) {
    OwnSim *a = small_sim(), *b = small_sim();
    for (int i = 0; i < 2; i++) {
        SingePoseKey keys[2] = {test_key(0, 0, 0, 0), test_key(0.1f, 0.04f, 0, 0)};
        float grey[4] = {0, 1, 0.5f, 0.2f};
        SingeSourceDef def = singe_default_source();

        def.kind = SINGE_SOURCE_BALL, def.path_count = 2, def.path = keys;
        SingeSourceId id = test_add_source(i ? b : a, &def);
        def.kind = SINGE_SOURCE_TEXTURE, def.texture = (SingeTexture){2, 2, grey};
        test_ok(b, singe_sim_add_source(i ? b : a, &def, &id));
        if (i == 0) continue;

        memset(keys, 0xFF, sizeof keys);
        memset(grey, 0xFF, sizeof grey);
        memset(&def, 0xFF, sizeof def);
    }

    test_steps_alike(a, b, 10);
}

// Every kind of heat source, by its formula.
#include "rig.h"

static const double PER_AREA = 0.04 * 1400; // J/(m2 K), of a layer

/// A sheet of cold, still particles: nothing but sources moves them.
static RigDef inert(int nx, int ny) {
    RigDef def = rig_default(nx, ny, 0.002f, 0.002f);
    def.material.diffusivity = singe_param(0);
    def.material.layer_exchange = singe_param(0);
    def.material.temperature = singe_param(300);
    return def;
}

static SingeSourceDef ball(const SingePoseKey *path, uint32_t count, float conductance, float radius, float falloff) {
    SingeSourceDef def = singe_default_source();
    def.kind = count > 1 ? SINGE_SOURCE_BALL : SINGE_SOURCE_SPOT;
    def.path = path, def.path_count = count;
    def.temperature = 1200, def.conductance = conductance, def.radius = radius, def.falloff = falloff;
    return def;
}

static const SingePoseKey MIDDLE = {.position = {0.01f, 0.01f, 0}, .rotation = {0, 0, 0, 1}};

TEST(relaxes_to_the_source_by_the_formula) {
    RigDef def = inert(10, 10);
    OwnRig rig = rig_open(&def);
    SingeSourceDef source = ball(&MIDDLE, 1, 150, 1, 0);
    rig_source(&rig, &source);
    for (int k = 0; k < 40; k++) rig_step(&rig);

    double expected = 1200 - 900 * pow(1 + 0.002 * 150 / PER_AREA, -40);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) CHECK_NEAR(rig.state.heat.temperature[i], expected, 2e-3);
    CHECK_NEAR(rig.state.heat.heat_in, 2 * 4e-4 * PER_AREA * (expected - 300), 1e-4 * rig.state.heat.heat_in);
}

TEST(never_overshoots) {
    RigDef def = inert(4, 4);
    OwnRig rig = rig_open(&def);

    SingeSourceDef source = ball(&MIDDLE, 1, 1e9f, 1, 0);
    rig_source(&rig, &source);
    for (int k = 0; k < 10; k++) {
        rig_step(&rig);
        for (uint32_t i = 0; i < rig.shell.particle_count; i++)
            CHECK_NEAR(rig.state.heat.temperature[i], 1200 - (k ? 0 : 0.03), 0.02);
    }
}

TEST(falls_off_smoothly_and_moves) {
    const SingePoseKey path[] = {{0, {0, 0.01f, 0}, {0, 0, 0, 1}}, {1, {0.02f, 0.01f, 0}, {0, 0, 0, 1}}};
    RigDef def = inert(10, 10);

    OwnRig rig = rig_open(&def);
    SingeSourceDef source = ball(path, 2, 100, 0.003f, 0.004f);
    source.start = 0.5f, source.end = 0.501f;
    rig_source(&rig, &source);
    rig_step(&rig); // time 0: not yet
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) assert_true(rig.state.heat.temperature[i] == 300);

    rig.state.time = 0.5; // half way: at (0.01, 0.01)
    rig_step(&rig);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
        const float *x = rig_position(&rig, i);
        double d = sqrt(pow((double)x[0] - 0.01, 2) + pow((double)x[1] - 0.01, 2) + pow((double)x[2], 2)),
               s = (d - 0.003) / 0.004;
        double g = 100 * (s <= 0 ? 1 : s >= 1 ? 0 : 1 - s * s * (3 - 2 * s)), a = 0.002 * g / PER_AREA;
        CHECK_NEAR(rig.state.heat.temperature[i], (300 + a * 1200) / (1 + a), 1e-3);
    }

    float before = rig.state.heat.temperature[rig_vertex(&rig, 5, 5)];
    rig.state.time = 0.502; // over
    rig_step(&rig);
    assert_true(rig.state.heat.temperature[rig_vertex(&rig, 5, 5)] == before && before > 300);
}

TEST(contact_heats_the_near_layer) {
    RigDef def = inert(4, 4);
    def.material.thickness = singe_param(0.002f);
    OwnRig rig = rig_open(&def);

    SingePoseKey pose = {.position = {0, 0, -0.0008f}, .rotation = {0, 0, 0, 1}};
    Collider *plane = &rig.colliders.items[0];
    plane->def = singe_default_collider();
    plane->def.conductance = 300, plane->def.temperature = 700, plane->def.contact_distance = 0.001f;
    assert_int_equal(path_set(&plane->path, &rig.memory, 1, &pose, "collider", &rig.error), SINGE_OK);
    rig.colliders.count = 1;
    rig_step(&rig); // the slot is still free
    assert_true(rig.state.heat.temperature[0] == 300);

    plane->generation = 1;
    rig_step(&rig);

    double a = 0.002 * 300 / PER_AREA;
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        CHECK_NEAR(rig.state.heat.temperature[i], shell_is_corner(&rig.shell, i) ? (300 + a * 700) / (1 + a) : 300,
                   1e-4);
}

static const float CUBE[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
static const uint32_t CUBE_TRIANGLES[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                          2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/// A slab of 2 cm by 2 cm by 2 m about (2 cm, 2 cm), in contact with the flat sheet's back (from below) or front.
static void slab(Rig *r, SingeColliderKind kind, bool below, SingeContactSides sides, float temperature) {
    static float vertices[24];
    static const float heights[4] = {0, 0, 0, 0};
    for (int k = 0; k < 24; k++) vertices[k] = CUBE[k] * (k % 3 == 2 ? 1 : 0.01f);
    SingeColliderDef def = singe_default_collider();

    // a heightfield's top is its z = 0; turned about x by half a turn it looks down
    float top = kind == SINGE_COLLIDER_HEIGHTFIELD ? 0 : 1;
    SingePoseKey pose = {.position = {0.02f, 0.02f, below ? -0.0005f - top : 0.0025f + top}, .rotation = {0, 0, 0, 1}};
    if (!below) pose.rotation[0] = 1, pose.rotation[3] = 0;

    def.kind = kind;
    def.half_size[0] = def.half_size[1] = 0.01f, def.half_size[2] = 1;
    def.vertex_count = 8, def.vertices = vertices, def.triangle_count = 12, def.triangles = CUBE_TRIANGLES;
    def.columns = def.rows = 2, def.size[0] = def.size[1] = 0.02f, def.heights = heights;
    def.conductance = 300, def.temperature = temperature, def.contact_distance = 0.001f, def.sides = sides;
    def.path_count = 1, def.path = &pose;
    if (collider_create(&r->memory, &def, &r->colliders.items[0], &r->error)) fail_msg("%s", r->error.message);
    r->colliders.items[0].generation = 1;
    r->colliders.count = 1;
}

/// Every kind, from either side, hot and cold: the layer that faces it or both, and nothing beside it.
TEST(contact_heats_the_given_sides) {
    static const SingeColliderKind kinds[] = {SINGE_COLLIDER_BOX, SINGE_COLLIDER_HEIGHTFIELD, SINGE_COLLIDER_MESH};
    for (int k = 0; k < 24; k++) {
        bool below = k & 1, both = k & 2, cold = k & 4;
        RigDef def = inert(20, 20); // 4 cm, the front 2 mm above the back
        def.material.thickness = singe_param(0.002f);
        OwnRig rig = rig_open(&def);

        float temperature = cold ? 250 : 700;
        slab(&rig, kinds[k / 8], below, both ? SINGE_SIDES_BOTH : SINGE_SIDES_TOUCHING, temperature);
        rig_step(&rig);

        double a = 0.002 * 300 / PER_AREA, heated = (300 + a * (double)temperature) / (1 + a), stored = 0;
        for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
            const float *x = rig_position(&rig, i);
            double off = fmax(fabs((double)x[0] - 0.02), fabs((double)x[1] - 0.02));
            if (off > 0.0095 && off < 0.0125) { // the corners of the reach are round
                stored += (double)rig.shell.matter.area[i] * PER_AREA * ((double)rig.state.heat.temperature[i] - 300);
                continue;
            }

            bool touches = off < 0.01 && (both || shell_is_corner(&rig.shell, i) == below);
            CHECK_NEAR(rig.state.heat.temperature[i], touches ? heated : 300, 2e-4);
            stored += (double)rig.shell.matter.area[i] * PER_AREA * ((double)rig.state.heat.temperature[i] - 300);
        }

        CHECK_NEAR(rig.state.heat.heat_in, stored, 1e-4 * fabs(stored)); // below 0 where it is cold
        assert_true((rig.state.heat.heat_in < 0) == cold);
        collider_free(&rig.memory, &rig.colliders.items[0]);
    }
}

/// The layer behind warms by what comes through the sheet, and tends to the same temperature.
TEST(contact_heat_goes_through_the_sheet) {
    RigDef def = inert(20, 20);
    def.material.thickness = singe_param(0.002f);
    def.material.layer_exchange = singe_param(4); // the difference of the two falls as e^-4t
    OwnRig rig = rig_open(&def);
    slab(&rig, SINGE_COLLIDER_MESH, true, SINGE_SIDES_TOUCHING, 700);

    uint32_t near = rig_vertex(&rig, 10, 10), behind = rig_centre(&rig, 10, 10), aside = rig_centre(&rig, 1, 1);
    float before = 300;
    for (int k = 0; k < 1500; k++) {
        rig_step(&rig);
        if (k == 20) assert_true(rig.state.heat.temperature[near] > 330 && rig.state.heat.temperature[behind] < 310);
        assert_true(rig.state.heat.temperature[behind] >= before - 1e-3f);
        before = rig.state.heat.temperature[behind];
    }

    CHECK_NEAR(rig.state.heat.temperature[behind], 700, 12); // in 3 s
    CHECK_NEAR(rig.state.heat.temperature[aside], 300, 0.5); // 8 mm from its edge
    collider_free(&rig.memory, &rig.colliders.items[0]);
}

TEST(a_texture_heats_by_its_key_frames) {
    const float pixels[] = {0, 1, 0.5f, 0.25f}; // top row 0 1, bottom row .5 .25
    const SingeValueKey keys[] = {{1, 0}, {3, 2}};
    RigDef def = inert(8, 8);

    OwnRig rig = rig_open(&def);
    SingeSourceDef source = singe_default_source();
    source.kind = SINGE_SOURCE_TEXTURE, source.texture = (SingeTexture){2, 2, pixels}, source.flux = 20e3f;
    source.strength = keys, source.strength_count = 2;
    rig_source(&rig, &source);

    const struct { double time, strength; } times[] = {{0, 0}, {1.5, 0.5}, {2, 1}, {9, 2}};
    double total = 0;
    for (int k = 0; k < 4; k++) {
        rig.state.time = times[k].time;
        rig_step(&rig);
        total += times[k].strength;

        double per_unit = 0.002 * 20e3 / PER_AREA;
        CHECK_NEAR(rig.state.heat.temperature[rig_vertex(&rig, 0, 0)], 300 + total * per_unit * 0.5, 1e-3);
        CHECK_NEAR(rig.state.heat.temperature[rig_vertex(&rig, 8, 0)], 300 + total * per_unit * 0.25, 1e-3);
        CHECK_NEAR(rig.state.heat.temperature[rig_vertex(&rig, 0, 8)], 300, 1e-6);
        CHECK_NEAR(rig.state.heat.temperature[rig_vertex(&rig, 8, 8)], 300 + total * per_unit, 1e-3);
        CHECK_NEAR(rig.state.heat.temperature[rig_vertex(&rig, 4, 4)], 300 + total * per_unit * 0.4375, 1e-3);
        CHECK_NEAR(rig.state.heat.temperature[rig_centre(&rig, 0, 0)], 300 + total * per_unit * 0.5, 1e-3);
    }
}

static void my_flux(void *context, const struct SingeView *view, float *flux, float *conductance,
                    float *conductance_temperature) {
    ++*(int *)context;
    flux[2] += 5e3f;
    for (uint32_t i = 0; i < view->particle_count; i++) conductance[i] += 10, conductance_temperature[i] += 10 * 500;
}

TEST(callback_adds_to_the_rest) {
    RigDef def = inert(3, 3);
    OwnRig rig = rig_open(&def);
    int calls = 0;
    SingeSourceDef source = singe_default_source();
    source.kind = SINGE_SOURCE_CALLBACK, source.callback = my_flux, source.callback_context = &calls;
    rig_source(&rig, &source);

    SingeSourceDef spot = ball(&MIDDLE, 1, 20, 1, 0);
    rig_source(&rig, &spot);
    rig_remove(&rig, 5);
    rig_step(&rig);
    assert_int_equal(calls, 1);

    double a = 0.002 / PER_AREA;
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
        double q = i == 2 ? 5e3 : 0;
        CHECK_NEAR(rig.state.heat.temperature[i], i == 5 ? 300 : (300 + a * (q + 10 * 500 + 20 * 1200)) / (1 + a * 30),
                   1e-4);
    }

    rig.sources.items[0].def.callback = NULL; // as after a load
    rig_step(&rig);
    assert_int_equal(calls, 1);
}

/// A flux below 0 cools, as fast as it says, and to 1 K; the ledger has what it took.
TEST(a_sink_stops_at_1_kelvin) {
    static const float fluxes[] = {-1e3f, -1e6f, -1e15f};
    const float white = 1;
    for (int k = 0; k < 3; k++) {
        RigDef def = inert(3, 3);
        OwnRig rig = rig_open(&def);

        SingeSourceDef source = singe_default_source();
        source.kind = SINGE_SOURCE_TEXTURE, source.texture = (SingeTexture){1, 1, &white}, source.flux = fluxes[k];
        rig_source(&rig, &source);
        double before = rig_content(&rig, 1);
        for (int step = 0; step < 50; step++) rig_step(&rig);

        double expected = fmax(300 + 50 * 0.002 * (double)fluxes[k] / PER_AREA, 1);
        for (uint32_t i = 0; i < rig.shell.particle_count; i++)
            CHECK_NEAR(rig.state.heat.temperature[i], expected, 2e-3);
        CHECK_NEAR(rig.state.heat.heat_in, rig_content(&rig, 1) - before, 1e-4 * fabs(rig.state.heat.heat_in));
    }
}

/// Exchange with the gas never takes a particle past the gas's temperature, however long the step and thick the front.
TEST(hot_gas_heats_up_to_itself) {
    static const float starts[] = {250, 300, 500, 999}, convections[] = {14, 1e3f, 1e7f};
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) {
            RigDef def = inert(3, 3);
            def.material.convection = singe_param(convections[c]);
            def.material.thickening = 50;
            OwnRig rig = rig_open(&def);
            rig.h = 0.5f;
            float conductance[25], temperature[25];
            assert_int_equal(rig.shell.particle_count, 25);
            for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
                rig.state.heat.temperature[i] = starts[k];
                conductance[i] = 10, temperature[i] = 1000;
            }

            rig.state.gas.warm = true;
            rig.state.gas.conductance = conductance, rig.state.gas.temperature = temperature;
            for (int step = 0; step < 20; step++) {
                rig_step(&rig);
                for (uint32_t i = 0; i < rig.shell.particle_count; i++)
                    if (!(rig.state.heat.temperature[i] >= 249 && rig.state.heat.temperature[i] <= 1000.01f))
                        fail_msg("from %g K, convection %g: %g K", (double)starts[k], (double)convections[c],
                                 (double)rig.state.heat.temperature[i]);
            }
        }
}

// what bad Defs have in common is refused in tests/sim/test_defs.c and test_ranges.c
TEST(sheets_without_uv_take_no_picture) {
    RigDef def = inert(2, 2);
    OwnRig rig = rig_open(&def);

    static const float grey = 1;
    SingeSourceDef picture = singe_default_source();
    picture.kind = SINGE_SOURCE_TEXTURE, picture.texture = (SingeTexture){1, 1, &grey};
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) rig.shell.uv[i][0] = rig.shell.uv[i][1] = 0;
    assert_int_equal(source_create(&rig.memory, &rig.shell, &picture, &rig.sources.items[0], &rig.error),
                     SINGE_ERROR_ARGUMENT);
}

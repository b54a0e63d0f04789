// Exchange of heat between particles and the air, and failures of the step.
#include "rig.h"
#include "support/support.h"

static const double SIGMA = 5.670374e-8;

static void fill(Rig *r, float temperature) {
    for (uint32_t i = 0; i < r->shell.particle_count; i++) r->state.heat.temperature[i] = temperature;
}

static RigDef lossy(void) {
    RigDef def = rig_default(3, 2, 0.002f, 0.002f);
    def.material.convection = singe_param(14);
    def.material.emissivity = singe_param(0.9f);
    return def;
}

/// dT/dt of one particle in the air at 293 K.
static double cooling(double T, double mass, double thickening) {
    double capacity = 0.04 * 1400;
    return -(14 * (T - 293) + 0.9 * SIGMA * (pow(T, 4) - pow(293, 4))) / (capacity * mass * thickening);
}

/// The temperature after a time from 1100 K, by Runge and Kutta's fourth-order rule.
static double cooled(double seconds, double mass, double thickening) {
    double T = 1100, h = seconds / 20000;
    for (int k = 0; k < 20000; k++) {
        double a = cooling(T, mass, thickening), b = cooling(T + h / 2 * a, mass, thickening);
        double c = cooling(T + h / 2 * b, mass, thickening), d = cooling(T + h * c, mass, thickening);
        T += h / 6 * (a + 2 * b + 2 * c + d);
    }

    return T;
}

static double cool(float h, float mass, float thickening) {
    RigDef def = lossy();
    def.material.thickening = thickening;
    OwnRig rig = rig_open(&def);
    fill(&rig, 1100);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) rig.state.burn.mass[i] = mass;
    rig.h = h;
    for (int k = 0; k < (int)lround(2 / (double)h); k++) rig_step(&rig);

    double T = (double)rig.state.heat.temperature[3];
    return T;
}

TEST(cooling_follows_radiation_and_convection) {
    const struct {
        float mass, thickening;
        double effective;
    } cases[] = {{1, 1, 1}, {0.4f, 1, 0.4f}, {1, 3, 1}, {0.01f, 1, 0.15f}};

    for (int k = 0; k < 4; k++) {
        double exact = cooled(2, cases[k].effective, (double)cases[k].thickening);
        double coarse = cool(0.02f, cases[k].mass, cases[k].thickening) - exact,
               fine = cool(0.01f, cases[k].mass, cases[k].thickening) - exact;
        CHECK_NEAR(fine, 0, 0.05 * (exact - 293));
        if (fabs(fine) > 0.05) CHECK_NEAR(coarse / fine, 2, 0.2); // first order in time
    }
}

TEST(one_step_of_losses_matches_the_formula) {
    RigDef def = lossy();
    OwnRig rig = rig_open(&def);
    fill(&rig, 900);
    rig_step(&rig);

    double capacity = 0.04 * 1400, rate = (14 + 0.9 * SIGMA * (900.0 + 293) * (900.0 * 900 + 293.0 * 293)) / capacity;
    const double share = 0.002 * rate * (1 + 0.001 * rate);
    double after = (900 + share * 293) / (1 + share);
    CHECK_NEAR(rig.state.heat.temperature[0], after, 1e-4);

    // exactly the loss by eps sigma (T^4 - Ta^4), to first order
    CHECK_NEAR((900 - after) / 0.002, -cooling(900, 1, 1), 0.005 * -cooling(900, 1, 1));
    double lost = share * (after - 293) * rig_content(&rig, 1) / ((double)rig.state.heat.temperature[0] - 293);
    CHECK_NEAR(rig.state.heat.heat_lost, lost, 1e-4 * lost);
}

TEST(combustion_is_eta_times_burnt_mass) {
    RigDef def = rig_default(3, 2, 0.002f, 0.002f);
    def.material.heat_of_combustion = singe_param(2400 * 1400), def.material.heat_share = singe_param(1);
    def.settings.pace = 4; // burn_rate is per second of scene time already
    OwnRig rig = rig_open(&def);
    fill(&rig, 600);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        rig.state.burn.burn_rate[i] = 2, rig.state.burn.release[i] = 2 * 2400;

    rig_step(&rig);
    CHECK_NEAR(rig.state.heat.temperature[1], 600 + 2400 * 2 * 0.002, 1e-3);
    CHECK_NEAR(rig.state.heat.heat_of_combustion, 2 * 6 * 4e-6 * 0.04 * 1400 * 9.6, 1e-6);
}

TEST(pace_is_fire_time) {
    double T[2];
    for (int k = 0; k < 2; k++) {
        RigDef def = lossy();
        def.settings.pace = k ? 4 : 1;
        OwnRig rig = rig_open(&def);
        fill(&rig, 900);
        rig.h = k ? 0.002f : 0.008f;
        rig_step(&rig);
        T[k] = (double)rig.state.heat.temperature[0];
    }

    CHECK_NEAR(T[0], T[1], 1e-4);
}

/// Heated by combustion, then cooling: the peak is the hottest state, and stays.
TEST(the_peak_is_the_hottest_so_far) {
    RigDef def = lossy();
    def.material.heat_of_combustion = singe_param(2400 * 1400), def.material.heat_share = singe_param(1);
    OwnRig rig = rig_open(&def);
    fill(&rig, 600);
    uint32_t n = rig.shell.particle_count;
    float *hottest = calloc(n, sizeof *hottest);
    assert_non_null(hottest);

    for (uint32_t i = 0; i < n; i++) {
        rig.state.heat.temperature_peak[i] = hottest[i] = i % 2 ? 1500 : 600;
        rig.state.burn.burn_rate[i] = 8, rig.state.burn.release[i] = 8 * 2400;
    }

    for (int step = 0; step < 30; step++) {
        for (uint32_t i = 0; step == 10 && i < n; i++) rig.state.burn.burn_rate[i] = rig.state.burn.release[i] = 0;
        rig_step(&rig);
        for (uint32_t i = 0; i < n; i++) {
            float T = rig.state.heat.temperature[i];
            hottest[i] = T > hottest[i] ? T : hottest[i];
            assert_true(rig.state.heat.temperature_peak[i] == hottest[i]);
        }
    }

    assert_true(hottest[0] > 900 && rig.state.heat.temperature[0] < hottest[0] - 20);
    assert_true(hottest[1] == 1500);
    free(hottest);
}

// --- parameters that vary over the sheet ----------------------------------------------------------------

static const float halves[] = {0, 1};

/// `value` in the left quarter of the sheet, `to` in the right one, a straight line between.
static SingeParam from_left(float value, float to) {
    static const SingeField field = {.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, halves}};
    return singe_param_field(value, to, &field);
}

static void even_flux(void *context, const struct SingeView *view, float *flux, float *conductance,
                      float *temperature) {
    (void)conductance, (void)temperature;
    for (uint32_t i = 0; i < view->particle_count; i++) flux[i] += *(float *)context;
}

/// Under the same flux, a heavier sheet or one of more specific heat warms less, by eq 1.
TEST(heavier_halves_heat_slower) {
    for (int which = 0; which < 2; which++) {
        RigDef def = rig_default(8, 2, 0.002f, 0.002f);
        def.material.diffusivity = def.material.layer_exchange = singe_param(0);
        if (which) def.material.specific_heat = from_left(1000, 3000);
        else def.material.grammage = from_left(0.05f, 0.15f);
        OwnRig rig = rig_open(&def);
        fill(&rig, 300);

        float flux = 2e4f;
        SingeSourceDef source = singe_default_source();
        source.kind = SINGE_SOURCE_CALLBACK, source.callback = even_flux, source.callback_context = &flux;
        rig_source(&rig, &source);
        for (int k = 0; k < 10; k++) rig_step(&rig);

        double left = which ? 0.04 * 1000 : 0.025 * 1400, right = 3 * left; // J/(m2 K)
        const float *T = rig.state.heat.temperature;
        CHECK_NEAR(T[rig_vertex(&rig, 0, 1)], 300 + 2e4 * 0.02 / left, 1e-3);
        CHECK_NEAR(T[rig_centre(&rig, 1, 0)], 300 + 2e4 * 0.02 / left, 1e-3);
        CHECK_NEAR(T[rig_vertex(&rig, 8, 1)], 300 + 2e4 * 0.02 / right, 1e-3);
        CHECK_NEAR(T[rig_centre(&rig, 7, 0)], 300 + 2e4 * 0.02 / right, 1e-3);

        double stored = 0; // above 300 K
        for (uint32_t i = 0; i < rig.shell.particle_count; i++)
            stored += (double)rig.shell.matter.capacity[i] * ((double)T[i] - 300);
        CHECK_NEAR(rig.state.heat.heat_in, stored, 1e-5 * stored);
    }
}

/// The losses of each particle are those of a sheet that is all of its material.
TEST(losses_are_each_particles_own) {
    float T[3][2]; // varying, all left, all right
    for (int run = 0; run < 3; run++) {
        RigDef def = rig_default(8, 2, 0.002f, 0.002f);
        def.material.diffusivity = def.material.layer_exchange = singe_param(0);

        SingeParam *params[] = {&def.material.convection, &def.material.emissivity, &def.material.loss_mass_floor};
        const float ends[3][2] = {{5, 50}, {0.9f, 0.1f}, {0.3f, 0.9f}};
        for (int k = 0; k < 3; k++)
            *params[k] = run ? singe_param(ends[k][run - 1]) : from_left(ends[k][0], ends[k][1]);

        OwnRig rig = rig_open(&def);
        fill(&rig, 900);
        for (uint32_t i = 0; i < rig.shell.particle_count; i++) rig.state.burn.mass[i] = 0.2f;
        for (int k = 0; k < 20; k++) rig_step(&rig);
        T[run][0] = rig.state.heat.temperature[rig_vertex(&rig, 0, 1)];
        T[run][1] = rig.state.heat.temperature[rig_centre(&rig, 7, 1)];
    }

    assert_true(T[0][0] == T[1][0] && T[0][1] == T[2][1]);
    assert_true(fabsf(T[0][0] - T[0][1]) > 5);
}

// --- failures -------------------------------------------------------------------------------------------

static void poison(void *context, const struct SingeView *view, float *flux, float *conductance, float *temperature) {
    (void)view, (void)conductance, (void)temperature;
    flux[7] = *(float *)context;
}

TEST(a_bad_temperature_is_named_and_kept_out) {
    float values[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        RigDef def = rig_default(3, 2, 0.002f, 0.002f);
        def.material.diffusivity = singe_param(0);
        def.material.layer_exchange = singe_param(0);
        OwnRig rig = rig_open(&def);
        fill(&rig, 300);

        SingeSourceDef source = singe_default_source();
        source.kind = SINGE_SOURCE_CALLBACK, source.callback = poison, source.callback_context = &values[k];
        rig_source(&rig, &source);
        assert_int_equal(rig_try_step(&rig), SINGE_ERROR_DIVERGED);
        assert_int_equal(rig.error.element, 7);
        assert_string_equal(rig.error.stage, "heat");
        for (uint32_t i = 0; i < rig.shell.particle_count; i++) assert_true(rig.state.heat.temperature[i] == 300);
        assert_true(rig.state.heat.heat_in == 0);
    }
}

/// From any temperature, in any step: the result lies between the ambient temperature and the previous one.
TEST(any_heat_ends_finite) {
    static const float starts[] = {1e-30f, 1e-3f, 1, 292, 294, 1e4f, 1e6f, 1e12f, 1e20f, 1e38f};
    static const float steps[] = {1e-9f, 1e-3f, 10, 1e7f};
    for (size_t k = 0; k < sizeof starts / sizeof *starts; k++)
        for (size_t s = 0; s < 4; s++) {
            RigDef def = lossy();
            def.material.convection = singe_param(1e5f);
            OwnRig rig = rig_open(&def);
            fill(&rig, starts[k]);
            rig.h = steps[s];
            double before = rig_content(&rig, 1);
            rig_step(&rig);
            float min = fminf(starts[k], 293), max = fmaxf(starts[k], 293);
            for (uint32_t i = 0; i < rig.shell.particle_count; i++)
                if (!(rig.state.heat.temperature[i] >= min * 0.9999f && rig.state.heat.temperature[i] <= max))
                    fail_msg("%g K, step of %g s: %g K", (double)starts[k], (double)steps[s],
                             (double)rig.state.heat.temperature[i]);
            assert_true(isfinite(rig.state.heat.heat_lost));
            double change = rig_content(&rig, 1) - before, scale = fmax(fabs(rig.state.heat.heat_lost), fabs(change));
            CHECK_NEAR(rig.state.heat.heat_lost, -change, 1e-4 * scale + 2e-6 * fabs(before) + 1e-12);
        }
}

/// Refused with the sheet's name, and not found in a step.
TEST(conductances_beyond_floats_are_refused) {
    for (int k = 0; k < 4; k++) {
        RigDef def = rig_default(3, 2, 0.002f, 0.002f);
        OwnRig rig = rig_open(&def); // a shell to try other materials on

        HeatPlan *plan = NULL;
        if (k < 2) rig.shell.matter.diffusivity.values[0] = k == 0 ? 1e30f : 1e15f;
        if (k == 2) rig.shell.matter.layer_exchange.values[0] = 3e38f;
        rig.shell.sheets[0].material.thickening = k == 1 ? 1e10f : 1;
        SingeResult result = heat_plan_create(&rig.memory, &rig.shell, &rig.settings, &plan, &rig.error);
        assert_int_equal(result, k < 3 ? SINGE_ERROR_ARGUMENT : SINGE_OK);
        if (k < 3) assert_non_null(strstr(rig.error.message, "sheet 'sheet': its diffusivity"));
        heat_plan_free(&rig.memory, plan);
    }
}

TEST(running_out_of_memory_is_clean) {
    RigDef def = rig_default(3, 2, 0.002f, 0.002f);
    OwnRig rig = rig_open(&def);

    float pixels[] = {0, 1};
    SingeValueKey keys[] = {{0, 0}, {1, 1}};
    SingePoseKey path = {.rotation = {0, 0, 0, 1}};
    SingeSourceDef picture = singe_default_source(), ball = singe_default_source();
    picture.kind = SINGE_SOURCE_TEXTURE, picture.texture = (SingeTexture){2, 1, pixels};
    picture.strength = keys, picture.strength_count = 2;
    ball.kind = SINGE_SOURCE_BALL, ball.path = &path, ball.path_count = 1;

    Memory memory;
    HeatPlan *plan;
    Source source = {0};

    test_allocations_fail(
        12, (memory = memory_make(allocator), heat_plan_create(&memory, &rig.shell, &rig.settings, &plan, &rig.error)),
        heat_plan_free(&memory, plan));
    for (int k = 0; k < 2; k++)
        test_allocations_fail(2 - k,
                              (memory = memory_make(allocator),
                               source_create(&memory, &rig.shell, k ? &ball : &picture, &source, &rig.error)),
                              source_free(&memory, &rig.shell, &source));
}

// The burning front on strips: its speed must not depend on the cells, thanks to the thickening.
#include "rig.h"

#include "analysis/strip.h"

/// Burns a strip of cells of `size` in steps of h.
static StripResult burn_strip(float size, float h, const SingeMaterialDef *material) {
    StripSetup setup = strip_setup(material);
    StripResult result = {0};
    SingeError error = {0};
    setup.cell = size, setup.time_step = h;
    setup.length = size < 0.003f ? 0.06f : 0.08f; // the front is measured from 0.4 to 0.9 of it
    if (strip_burn(&setup, &result, &error)) fail_msg("%s", error.message);
    return result;
}

static void compare(const SingeMaterialDef *material, double slowest, double fastest) {
    const float sizes[] = {0.0005f, 0.001f, 0.002f, 0.004f};
    double reference = 0;
    for (int k = 0; k < 4; k++) {
        StripResult front = burn_strip(sizes[k], 0.002f, material);
        print_message("cells %.1f mm: F %.2f, front %.3f mm/s, hottest %.0f C\n", (double)sizes[k] * 1e3,
                      front.thickening, front.speed * 1e3, front.hottest - 273.15);
        if (k == 0) reference = front.speed;
        CHECK_NEAR(front.speed / reference, 1, 0.05);
        if (front.speed < slowest || front.speed > fastest) fail_msg("%.2f mm/s", front.speed * 1e3);
        if (front.hottest < 1023 || front.hottest > 1223) fail_msg("%.0f K", front.hottest);
    }
}

/// A step that is ten times as long burns as fast: heat and burning are of second order in it. With backward
/// Euler's conduction it lost 3 to 4 %, and with burning at the temperature of the step's beginning as well 7 %.
TEST(front_speed_does_not_depend_on_steps) {
    const SingeMaterialDef material = singe_default_material();
    const double fine = burn_strip(0.002f, 0.003f, &material).speed,
                 coarse = burn_strip(0.002f, 0.03f, &material).speed;
    print_message("%.3f mm/s in steps of 3 ms, %.3f in steps of 30 ms\n", fine * 1e3, coarse * 1e3);
    CHECK_NEAR(coarse / fine, 1, 0.02);
}

/// Eq 4 as the paper has it, without a ceiling, and a straight ash exponent.
TEST(front_speed_does_not_depend_on_cells) {
    SingeMaterialDef material = singe_default_material();
    material.diffusivity = singe_param(2.7e-6f), material.mass_rate = singe_param(8e-3f);
    material.heat_of_combustion = singe_param(2400 * 1400), material.heat_share = singe_param(1);
    material.rate_ceiling = singe_param(INFINITY);
    material.ash_exponent = singe_param(1), material.mass_loss = singe_param(0.22f);
    compare(&material, 4e-3, 7e-3);
}

/// The default material: 80 g/m2 office paper, 4.4 to 7.0 mm/s (Thomas & Law, FRN 584), 750 to 950 C.
TEST(calibrated_paper_burns_at_its_real_pace) {
    SingeMaterialDef material = singe_default_material();
    compare(&material, 4.4e-3, 7.0e-3);
}

/// A front that is 10 cm wide has its air from the side, as one of three cells has.
TEST(a_wide_front_is_not_short_of_air) {
    static const float widths[] = {6e-3f, 0.1f};
    double speed[2];
    for (int k = 0; k < 2; k++) {
        const SingeMaterialDef material = singe_default_material();
        StripSetup setup = strip_setup(&material);
        StripResult result = {0};
        SingeError error = {0};
        setup.cell = 2e-3f, setup.time_step = 8e-3f, setup.length = 0.06f, setup.width = widths[k];
        if (strip_burn(&setup, &result, &error)) fail_msg("%s", error.message);
        print_message("%.0f mm wide: %.3f mm/s\n", 1e3 * (double)widths[k], 1e3 * result.speed);
        speed[k] = result.speed;
    }
    CHECK_NEAR(speed[1] / speed[0], 1, 0.01);
}

/// The same material at other grammages, all of it derived from fluxes per area: a lighter sheet's front is faster in
/// proportion, as thick and as hot, to the rounding where its steps are shorter in proportion too. The ranges at 45 and
/// 20 g/m2 (Thomas & Law again) are predictions.
TEST(speed_is_in_proportion_to_one_over_grammage) {
    static const struct {
        float grammage;
        double slowest, fastest;
    } sheets[] = {{0.080f, 4.4e-3, 7.0e-3}, {0.045f, 7.8e-3, 12.4e-3}, {0.020f, 17.5e-3, 28e-3}};

    StripResult office = {0};
    for (int k = 0; k < 3; k++) {
        float grammage = sheets[k].grammage, ratio = grammage / 0.080f;
        SingeMaterialDef material = singe_default_material();
        material.grammage = singe_param(grammage);

        const StripResult same = burn_strip(0.001f, 0.002f, &material);
        const StripResult shorter = k ? burn_strip(0.001f, 0.002f * ratio, &material) : same;
        print_message("%.0f g/m2: F %.2f, front %.3f mm/s, hottest %.0f C; steps of %.1f ms: %.3f mm/s, %.0f C\n",
                      (double)grammage * 1e3, same.thickening, same.speed * 1e3, same.hottest - 273.15,
                      2 * (double)ratio, shorter.speed * 1e3, shorter.hottest - 273.15);

        if (k == 0) office = same;
        CHECK_NEAR(same.speed * (double)ratio / office.speed, 1, 0.05);
        CHECK_NEAR(shorter.speed * (double)ratio / office.speed, 1, 1e-3);
        CHECK_NEAR(shorter.hottest, office.hottest, 2); // char's kinetics are its own, whatever the sheet weighs
        CHECK_NEAR(same.thickening, office.thickening, 1e-5);
        if (same.speed < sheets[k].slowest || same.speed > sheets[k].fastest) fail_msg("%.2f mm/s", same.speed * 1e3);
    }

    SingeMaterialDef stated = singe_default_material(); // at any grammage alike: losses alone are less
    stated.grammage = singe_param(0.020f), stated.reference_grammage = 0; // which the bar of 2 K does not let pass
    StripResult unscaled = burn_strip(0.001f, 0.0005f, &stated);
    print_message("20 g/m2, rates not scaled: hottest %.0f C\n", unscaled.hottest - 273.15);
    assert_true(fabs(unscaled.hottest - office.hottest) > 2);
    stated.grammage = singe_param(0.160f);
    assert_true(burn_strip(0.001f, 0.002f, &stated).speed > office.speed);
}

static void moved(float x[3], uint32_t column, uint32_t row, float cell) {
    x[0] += 0.8f * cell * (rig_random(column, 2 * row) - 0.5f);
    x[1] += 0.8f * cell * (rig_random(column, 2 * row + 1) - 0.5f);
}

static void leaning(float x[3], uint32_t column, uint32_t row, float cell) {
    (void)column, (void)row, (void)cell;
    x[0] += x[1];
}

/// Cells of 4 : 1, with vertices moved by a seventh of each side: their short sides lean.
static void long_across(float x[3], uint32_t column, uint32_t row, float cell) {
    x[0] += 0.3f * cell * (rig_random(column, 2 * row) - 0.5f);
    x[1] += 0.3f * cell * (rig_random(column, 2 * row + 1) - 0.5f);
    x[1] *= 4;
}

static void narrow(float x[3], uint32_t column, uint32_t row, float cell) {
    (void)row;
    if (column % 4 == 1) x[0] -= 0.95f * cell;
    x[0] += 0.02f * cell * (rig_random(column, 2 * row) - 0.5f);
}

/// Bad cells burn at the pace of good ones, about.
TEST(bad_cells_do_not_hold_a_front_up) {
    static const struct {
        const char *name;
        void (*shape)(float x[3], uint32_t column, uint32_t row, float cell);
        double off;
    } cases[] = {{"moved by 0.4", moved, 0.05},
                 {"leaning", leaning, 0.2},
                 {"long across", long_across, 0.1},
                 {"narrow", narrow, 0.1}};
    SingeMaterialDef material = singe_default_material();
    material.thickening = 2.4f; // enough for the longest sides

    StripSetup setup = strip_setup(&material);
    SingeError error = {0};
    StripResult good = {0};

    setup.length = 0.06f;
    if (strip_burn(&setup, &good, &error)) fail_msg("%s", error.message);

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        StripResult bad = {0};
        setup.shape = cases[k].shape;
        if (strip_burn(&setup, &bad, &error)) fail_msg("%s: %s", cases[k].name, error.message);
        print_message("%s: front %.3f mm/s, on squares %.3f mm/s; hottest %.0f C, on squares %.0f C\n", cases[k].name,
                      bad.speed * 1e3, good.speed * 1e3, bad.hottest - 273.15, good.hottest - 273.15);
        if (!(fabs(bad.speed / good.speed - 1) < cases[k].off)) fail_msg("%s", cases[k].name);
    }
}

/// A strip ends where its front is through, where its fire is out, or where it has cost too much, as conduction that
/// takes many iterations does.
TEST(a_strip_takes_so_much_work) {
    SingeMaterialDef material = singe_default_material();
    StripSetup setup = strip_setup(&material);
    StripResult result = {0};

    setup.patience = 500, setup.work_max = 60000;
    assert_int_equal(strip_burn(&setup, &result, NULL), SINGE_OK);
    assert_true(result.end == STRIP_THROUGH && result.speed > 0 && result.work > 5000 && result.work < 60000);
    setup.work_max = 5000; // too little for paper
    assert_int_equal(strip_burn(&setup, &result, NULL), SINGE_OK);
    assert_true(result.end == STRIP_CUT && result.speed == 0 && result.work < 5000 + 100); // a step more, at most

    setup.work_max = 20000, setup.material.heat_share = singe_param(0);
    assert_int_equal(strip_burn(&setup, &result, NULL), SINGE_OK);
    assert_true(result.end == STRIP_OUT && result.speed == 0 && result.work < 10000);
    setup.material.diffusivity = singe_param(3.7e5f); // a hundred iterations a step
    assert_int_equal(strip_burn(&setup, &result, NULL), SINGE_OK);
    assert_true(result.end == STRIP_CUT && result.speed == 0 && result.work < 20000 + 1000);
}

TEST(thickening_has_limits) {
    FrontMatter front = {
        .diffusivity = 1e-5f, .mass_rate = 9e-3f, .heating = 2400, .ignition_temperature = 513, .rate_ceiling = 260};
    assert_true(heat_thickening_for(3.5f, &front, 293, 0.01f) == 3.5f);
    float a = heat_thickening_for(0, &front, 293, 0.01f);
    CHECK_NEAR(heat_thickening_for(0, &front, 293, 0.02f), 2 * (double)a, 1e-3);
    assert_true(heat_thickening_for(0, &front, 293, 1e-5f) == 1);
    front.rate_ceiling = 4 * 260;
    CHECK_NEAR(heat_thickening_for(0, &front, 293, 0.01f), 2 * (double)a, 1e-3);

    FrontMatter still = front, unburnt = front, cold = front;
    still.diffusivity = 0, unburnt.mass_rate = 0, cold.heating = 100;
    assert_true(heat_thickening_for(0, &still, 293, 0.01f) == 1);
    assert_true(heat_thickening_for(0, &unburnt, 293, 0.01f) == 1);
    assert_true(heat_thickening_for(0, &cold, 293, 0.01f) == 1);

    FrontMatter thin = front;
    thin.diffusivity = 1e-20f, thin.mass_rate = 1e10f;
    assert_true(heat_thickening_for(0, &thin, 293, 0.01f) > 1e6f); // the plan refuses it
}

/// One F for a sheet whose parameters vary: that of their means.
TEST(thickening_follows_the_means) {
    static const float halves[] = {0, 1};
    RigDef def = rig_default(16, 4, 0.01f, 0.01f);
    SingeParam *params[] = {&def.material.rate_ceiling, &def.material.mass_rate};
    const SingeField field = {.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, halves}};

    for (int k = 0; k < 2; k++) *params[k] = singe_param_field(k ? 5e-3f : 100, k ? 15e-3f : 300, &field);
    def.material.thickening = 0;

    OwnRig rig = rig_open(&def);

    FrontMatter front = {.diffusivity = 1e-4f,
                         .mass_rate = 10e-3f,
                         .heating = 2250,
                         .ignition_temperature = def.material.ignition_temperature.value,
                         .rate_ceiling = 200};
    double expected = (double)heat_thickening_for(0, &front, 293, 0.01f);
    assert_true(expected > 1.5);
    CHECK_NEAR(heat_thickening(rig.plan, 0), expected, 1e-5 * expected);
}

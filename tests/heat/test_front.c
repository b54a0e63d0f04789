// The burning front on strips: its speed must not depend on the cells, thanks to the thickening.
#include "heat/rig.h"

#include <math.h>
#include <stdlib.h>

#include "burn/burn.h"

typedef struct Front {
    float thickening;
    double speed;   ///< m/s
    double hottest; ///< K
} Front;

/// Burns a strip of 3 cells' width from one end in steps of h; particles burnt to m_loss fall away.
static Front burn_strip(float size, float h, const SingeMaterialDef *material) {
    const double length = 0.12, first = 0.4 * length, last = 0.9 * length;
    int n = (int)lround(length / (double)size);
    RigDef def = rig_default(n, 3, size, size);
    def.material = *material;
    def.settings.ambient_temperature = 293.15f;
    def.settings.tolerance = 1e-5f;
    Rig rig;
    rig_open(&rig, &def);
    rig.h = h;
    const Shell *shell = &rig.shell;
    State *state = &rig.state;
    double *partial = calloc((size_t)pool_blocks((int)shell->particle_count), sizeof *partial);
    EventList events = {0};
    Front front = {.thickening = heat_thickening(rig.plan, 0)};
    for (uint32_t i = 0; i < shell->particle_count; i++)
        if (rig_place(&rig, i)[0] < 0.02f) state->heat.temperature[i] = 1100;
    double passed[2] = {0, 0}, before = 0, place = 0;
    while (passed[1] == 0 && state->time < 60) {
        rig_step(&rig);
        assert_int_equal(burn_step(shell, state, NULL, rig.h, 1, &front.thickening, partial, &state->burn, &events,
                                   &rig.error), SINGE_OK);
        for (uint32_t i = 0; i < shell->particle_count; i++) {
            if (!(state->ablate.particle_flags[i] & SINGE_ALIVE)) continue;
            if (state->burn.mass[i] < field_at(shell->matter.mass_loss, i)) rig_remove(&rig, i);
            else if (place > first) front.hottest = fmax(front.hottest, (double)state->heat.temperature[i]);
        }
        before = place;
        for (int i = 0; i < n; i++) { // where the mass is 0.6
            double a = (double)state->burn.mass[rig_vertex(&rig, i, 1)],
                b = (double)state->burn.mass[rig_vertex(&rig, i + 1, 1)];
            if (a < 0.6 && b >= 0.6) place = (double)size * (i + (0.6 - a) / (b - a));
        }
        for (int k = 0; k < 2; k++) {
            double gate = k ? last : first;
            if (before < gate && place >= gate)
                passed[k] = state->time - (double)rig.h * (place - gate) / (place - before);
        }
    }
    if (passed[1] > 0) front.speed = (last - first) / (passed[1] - passed[0]);
    free(partial);
    rig_close(&rig);
    return front;
}

static void compare(const SingeMaterialDef *material, double slowest, double fastest) {
    const float sizes[] = {0.0005f, 0.001f, 0.002f, 0.004f};
    double reference = 0;
    for (int k = 0; k < 4; k++) {
        Front front = burn_strip(sizes[k], 0.002f, material);
        print_message("cells %.1f mm: F %.2f, front %.3f mm/s, hottest %.0f C\n", (double)sizes[k] * 1e3,
                      (double)front.thickening,
                      front.speed * 1e3, front.hottest - 273.15);
        if (k == 0) reference = front.speed;
        CHECK_NEAR(front.speed / reference, 1, 0.05);
        if (front.speed < slowest || front.speed > fastest) fail_msg("%.2f mm/s", front.speed * 1e3);
        if (front.hottest < 1023 || front.hottest > 1223) fail_msg("%.0f K", front.hottest);
    }
}

/// Eq 4 as the paper has it, without a ceiling, and a straight ash exponent.
static void front_speed_does_not_depend_on_cells(void **unused) {
    (void)unused;
    SingeMaterialDef material = singe_default_material();
    material.diffusivity = singe_param(2.7e-6f), material.mass_rate = singe_param(8e-3f);
    material.heat_of_combustion = singe_param(2400 * 1400), material.heat_share = singe_param(1), material.rate_ceiling = singe_param(INFINITY);
    material.ash_exponent = singe_param(1), material.mass_loss = singe_param(0.22f);
    compare(&material, 4e-3, 7e-3);
}

/// The default material: 80 g/m2 office paper, 4.4 to 7.0 mm/s (Thomas & Law, FRN 584), 750 to 950 C.
static void calibrated_paper_burns_at_its_real_pace(void **unused) {
    (void)unused;
    SingeMaterialDef material = singe_default_material();
    compare(&material, 4.4e-3, 7.0e-3);
}

/// The same material at other grammages, all of it derived from fluxes per area: a lighter sheet's front is faster in
/// proportion, as thick and as hot, to the rounding where its steps are shorter in proportion too. The ranges at 45 and
/// 20 g/m2 (Thomas & Law again) are predictions.
static void speed_is_in_proportion_to_one_over_grammage(void **unused) {
    (void)unused;
    static const struct { float grammage; double slowest, fastest; } sheets[] = {
        {0.080f, 4.4e-3, 7.0e-3}, {0.045f, 7.8e-3, 12.4e-3}, {0.020f, 17.5e-3, 28e-3}};
    Front office = {0};
    for (int k = 0; k < 3; k++) {
        float grammage = sheets[k].grammage, ratio = grammage / 0.080f;
        SingeMaterialDef material = singe_default_material();
        material.grammage = singe_param(grammage);
        Front same = burn_strip(0.001f, 0.002f, &material), shorter = burn_strip(0.001f, 0.002f * ratio, &material);
        print_message("%.0f g/m2: F %.2f, front %.3f mm/s, hottest %.0f C; steps of %.1f ms: %.3f mm/s, %.0f C\n",
                      (double)grammage * 1e3, (double)same.thickening, same.speed * 1e3, same.hottest - 273.15,
                      2 * (double)ratio, shorter.speed * 1e3, shorter.hottest - 273.15);
        if (k == 0) office = same;
        CHECK_NEAR(same.speed * (double)ratio / office.speed, 1, 0.05);
        CHECK_NEAR(shorter.speed * (double)ratio / office.speed, 1, 1e-3);
        CHECK_NEAR(shorter.hottest, office.hottest, 0.5);
        CHECK_NEAR(same.thickening, office.thickening, 1e-5);
        if (same.speed < sheets[k].slowest || same.speed > sheets[k].fastest) fail_msg("%.2f mm/s", same.speed * 1e3);
    }
    SingeMaterialDef stated = singe_default_material(); // at any grammage alike: losses alone are less
    stated.grammage = singe_param(0.160f), stated.reference_grammage = 0;
    assert_true(burn_strip(0.001f, 0.002f, &stated).speed > office.speed);
}

static void thickening_by_hand_and_its_limits(void **unused) {
    (void)unused;
    FrontMatter front = {1e-5f, 9e-3f, 2400, 513, 260};
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
static void thickening_goes_by_the_means(void **unused) {
    (void)unused;
    static const float halves[] = {0, 1};
    RigDef def = rig_default(16, 4, 0.01f, 0.01f);
    SingeParam *params[] = {&def.material.rate_ceiling, &def.material.mass_rate};
    for (int k = 0; k < 2; k++)
        *params[k] = (SingeParam){.value = k ? 5e-3f : 100, .to = k ? 15e-3f : 300, .field = SINGE_FIELD_PICTURE,
                                  .picture = {2, 1, halves}};
    def.material.thickening = 0;
    Rig rig;
    rig_open(&rig, &def);
    FrontMatter front = {1e-4f, 10e-3f, 2250, def.material.ignition_temperature.value, 200};
    double expected = (double)heat_thickening_for(0, &front, 293, 0.01f);
    assert_true(expected > 1.5);
    CHECK_NEAR(heat_thickening(rig.plan, 0), expected, 1e-5 * expected);
    rig_close(&rig);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_speed_does_not_depend_on_cells),
        cmocka_unit_test(calibrated_paper_burns_at_its_real_pace),
        cmocka_unit_test(speed_is_in_proportion_to_one_over_grammage),
        cmocka_unit_test(thickening_by_hand_and_its_limits),
        cmocka_unit_test(thickening_goes_by_the_means),
    };
    return cmocka_run_group_tests_name("heat_front", tests, NULL, NULL);
}

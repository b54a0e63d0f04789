// What puts fires out. Water boils off before sheets burn and takes the heat that is published; a jet of air blows the
// flame off and cools; a collider or another sheet smothers.
#include "support/support.h"

static const double FLUX = 40e3;         // W/m2, into each layer
static const double GRAMMAGE = 0.08 / 2; // kg/m2, of a layer
static const float WHITE = 1;

/// A sheet of 20 mm by 20 mm that loses no heat, lit all over from 20 C.
static SingeSim *lit(float moisture, bool burns) {
    SingeSimDef def = singe_default_sim();
    def.gravity[2] = 0;
    def.solver.substeps = 1;

    SingeMaterialDef material = singe_default_material();
    material.moisture = singe_param(moisture);
    material.convection = singe_param(0);
    material.emissivity = singe_param(0);
    material.drag = singe_param(0);
    material.ablate = false;
    if (!burns) material.mass_rate = singe_param(0);

    SingeSim *sim = test_sim(&def, test_grid(4, 4, 5e-3f, 5e-3f), &material);
    SingeSourceDef source = singe_default_source();
    source.kind = SINGE_SOURCE_TEXTURE;
    source.texture = (SingeTexture){1, 1, &WHITE};
    source.flux = (float)FLUX;
    test_add_source(sim, &source);
    return sim;
}

/// Heat per kilogram of dry sheet until it ignites, J/kg.
static double heat_of_ignition(float moisture) {
    OwnSim *sim = lit(moisture, true);
    while (singe_sim_view(sim).time_ignited[12] < 0 && singe_sim_view(sim).step < 4000) test_steps(sim, 1);
    double time = (double)singe_sim_view(sim).time_ignited[12];
    assert_true(time > 0 && singe_sim_stats(sim).ledgers_close);
    return FLUX * time / GRAMMAGE;
}

/// The heat of preignition of fine fuels is 250 + 1116 M Btu/lb, M the moisture (Rothermel 1972, INT-115, eq 12):
/// 2.596 MJ for each kilogram of water.
TEST(ignition_waits_for_the_water) {
    const double published = 1116 * 2326.0, dry = heat_of_ignition(0);
    assert_true(fabs(dry / (1400 * 220.0) - 1) < 0.03); // c_p from 20 to 240 C
    static const float moistures[] = {0.07f, 0.3f, 1};
    for (int k = 0; k < 3; k++) {
        const double water = (heat_of_ignition(moistures[k]) - dry) / (double)moistures[k];
        if (!(fabs(water / published - 1) < 0.05)) fail_msg("%g MJ/kg at %g", 1e-6 * water, (double)moistures[k]);
    }
}

TEST(nothing_wet_is_hotter_than_boiling) {
    OwnSim *sim = lit(0.5f, false);
    double mass = 4e-4 * 2 * GRAMMAGE, before = singe_sim_stats(sim).water;
    assert_true(fabs(before / (0.5 * mass) - 1) < 1e-5);

    for (int k = 0; k < 200; k++) {
        test_steps(sim, 4);
        SingeStats stats = singe_sim_stats(sim);
        assert_true(stats.ledgers_close && stats.water >= 0);
        if (stats.water > 1e-4 * before) assert_true(stats.temperature_max < 373.2f);

        // what has gone took its heat along, and nothing else did
        const double heat = (before - stats.water) * (2.257e6 + 4186 * 80);
        assert_true(fabs(stats.heat_lost - heat) < 1e-3 * (before * 2.6e6));
    }

    assert_true(singe_sim_stats(sim).water == 0 && singe_sim_stats(sim).temperature_max > 500);
}

/// A burning sheet on which it rains from the 300th step on.
static SingeSim *rained_on(float wetting, int steps) {
    SingeSim *sim = lit(0.05f, true);
    SingeSourceDef rain = singe_default_source();
    SingeSourceId id, heat;
    const SingeValueKey strength[] = {{300 / 480.0f, 0}, {301 / 480.0f, 1}};

    singe_sim_sources(sim, &heat, 1);
    rain.kind = SINGE_SOURCE_WATER;
    rain.texture = (SingeTexture){1, 1, &WHITE};
    rain.wetting = wetting;
    rain.strength_count = 2;
    rain.strength = strength;
    test_ok(sim, singe_sim_add_source(sim, &rain, &id));

    test_steps(sim, 400);
    test_ok(sim, singe_sim_remove_source(sim, heat));
    test_steps(sim, steps);

    return sim;
}

TEST(rain_puts_a_fire_out) {
    SingeSim *dry = rained_on(0, 100), *wet = rained_on(1, 100);
    assert_true(singe_sim_stats(dry).temperature_max > 600);
    assert_true(singe_sim_stats(wet).temperature_max < 380);

    SingeView view = singe_sim_view(wet);
    for (uint32_t i = 0; i < view.particle_count; i++) assert_true(view.burn_rate[i] == 0);
    assert_true(singe_sim_stats(wet).mass > singe_sim_stats(dry).mass);
    assert_true(singe_sim_stats(wet).water > 0 && singe_sim_stats(wet).ledgers_close);

    // a sheet holds no more than three times its mass
    test_steps(wet, 400);
    assert_true(singe_sim_stats(wet).water <= 3.001 * singe_sim_stats(wet).mass_initial);
    assert_true(singe_sim_stats(wet).water > 2.99 * singe_sim_stats(wet).mass_initial);

    // saved, with the rain that still falls
    SingeSimDef hooks = singe_default_sim();
    hooks.thread_count = 2;
    SingeSim *loaded = test_reload(&hooks, wet);
    test_steps(wet, 20), test_steps(loaded, 20);
    test_assert_same(wet, loaded);
    singe_sim_destroy(dry), singe_sim_destroy(wet), singe_sim_destroy(loaded);
}

/// A burning sheet at which a jet blows, or onto which a plate comes down, from the 170th step on.
static SingeSim *put_out(float speed, float blow_out, bool smothers, float conductance) {
    SingeSim *sim = lit(0, true);
    SingeSourceDef jet = singe_default_source();
    SingeColliderDef plate = singe_default_collider();
    SingeSourceId id, heat;
    const SingeValueKey strength[] = {{170 / 480.0f, 0}, {171 / 480.0f, 1}};

    singe_sim_sources(sim, &heat, 1);
    jet.kind = SINGE_SOURCE_JET;
    jet.radius = 0.05f;
    jet.position[0] = 5; // far away, until it is moved
    jet.speed = speed;
    jet.blow_out = blow_out;
    jet.strength_count = 2;
    jet.strength = strength;
    test_ok(sim, singe_sim_add_source(sim, &jet, &id));
    test_steps(sim, 170);

    const SingePoseKey below = {.position = {0, 0, -0.1f}, .rotation = {0, 0, 0, 1}};
    test_ok(sim, singe_sim_move_source(sim, id, 1, &below));
    plate.position[2] = -1.5e-3f;
    plate.smothers = smothers;
    plate.conductance = conductance;
    if (smothers || conductance > 0) test_add_collider(sim, &plate);
    test_ok(sim, singe_sim_remove_source(sim, heat));
    test_steps(sim, 160);
    assert_true(singe_sim_stats(sim).ledgers_close);

    return sim;
}

TEST(a_jet_blows_a_fire_out) {
    SingeSim *calm = put_out(0, 4, false, 0), *fanned = put_out(10, INFINITY, false, 0),
             *blown = put_out(10, 4, false, 0);
    const SingeStats free_ = singe_sim_stats(calm), cooled = singe_sim_stats(fanned), out = singe_sim_stats(blown);
    print_message("mass %g, fanned %g, blown out %g; hottest %g, %g, %g K\n", free_.mass, cooled.mass, out.mass,
                  (double)free_.temperature_max, (double)cooled.temperature_max, (double)out.temperature_max);
    assert_true(out.mass > cooled.mass && cooled.mass > free_.mass);
    assert_true(out.temperature_max < 513); // below ignition, so it stays out

    const SingeView view = singe_sim_view(blown);
    for (uint32_t i = 0; i < view.particle_count; i++) assert_true(view.burn_rate[i] == 0);

    SingeSim *loaded = test_reload(NULL, blown);
    test_steps(blown, 20), test_steps(loaded, 20);
    test_assert_same(blown, loaded);
    singe_sim_destroy(calm), singe_sim_destroy(fanned), singe_sim_destroy(blown), singe_sim_destroy(loaded);
}

TEST(a_plate_smothers_a_fire) {
    SingeSim *plain = put_out(0, 4, false, 100), *smothered = put_out(0, 4, true, 100);
    print_message("hottest %g, smothered %g K\n", (double)singe_sim_stats(plain).temperature_max,
                  (double)singe_sim_stats(smothered).temperature_max);
    assert_true(singe_sim_stats(smothered).mass > singe_sim_stats(plain).mass);
    assert_true(singe_sim_stats(smothered).temperature_max < 513);
    singe_sim_destroy(plain), singe_sim_destroy(smothered);
}

/// A sheet that burns, and another above it, which burns at another rate. From the 200th step on one of them keeps air
/// within `distance` from the other.
static SingeSim *covered_by(float cover_rate, float height, float distance, bool from_above, uint32_t threads) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = threads;
    def.gravity[2] = 0;
    def.solver.substeps = 1;

    SingeSheetId burning, cover;
    SingeSim *sim = test_create(&def);
    TestMesh low = test_grid(8, 8, 2.5e-3f, 2.5e-3f), high = test_grid(4, 4, 5e-3f, 5e-3f);
    test_mesh_move(&high, 0, 0, height);

    SingeSheetDef sheet = test_sheet(&low), above = test_sheet(&high);
    sheet.material.drag = above.material.drag = singe_param(0);
    sheet.material.ablate = false;
    above.material.mass_rate = singe_param(cover_rate);
    above.material.mass_loss = singe_param(0.95f);
    test_ok(sim, singe_sim_add_sheet(sim, &sheet, &burning));
    test_ok(sim, singe_sim_add_sheet(sim, &above, &cover));
    test_ok(sim, singe_sim_commit(sim));

    SingeSourceDef source = singe_default_source();
    source.kind = SINGE_SOURCE_TEXTURE;
    source.texture = (SingeTexture){1, 1, &WHITE};
    source.flux = (float)FLUX;
    SingeSourceId heat = test_add_source(sim, &source);

    test_steps(sim, 200);
    test_ok(sim, singe_sim_remove_source(sim, heat));

    SingeMaterialDef *keeps = from_above ? &above.material : &sheet.material;
    keeps->smother_distance = singe_param(distance);
    test_ok(sim, singe_sim_set_material(sim, from_above ? cover : burning, keeps, NULL));
    test_steps(sim, 900);
    assert_true(singe_sim_stats(sim).ledgers_close);
    test_mesh_free(&low), test_mesh_free(&high);
    return sim;
}

/// The same by a sheet that does not burn.
static SingeSim *covered(float height, float distance, bool from_above, uint32_t threads) {
    return covered_by(0, height, distance, from_above, threads);
}

/// K, of the sheet that burns.
static float hottest(const SingeSim *sim) {
    float max = 0;
    for (uint32_t v = 0; v < 81; v++) max = fmaxf(max, singe_sim_view(sim).temperature[v]);
    return max;
}

TEST(a_sheet_smothers_a_fire) {
    SingeSim *plain = covered(3e-3f, 0, true, 1), *near = covered(3e-3f, 8e-3f, true, 1),
             *again = covered(3e-3f, 8e-3f, true, 2), *far = covered(25e-3f, 8e-3f, true, 1),
             *own = covered(3e-3f, 8e-3f, false, 1);
    print_message("hottest %g, covered %g K; mass %g, %g kg\n", (double)hottest(plain), (double)hottest(near),
                  singe_sim_stats(plain).mass, singe_sim_stats(near).mass);
    assert_true(hottest(plain) > 600 && hottest(near) < 513);
    assert_true(singe_sim_stats(near).mass > 1.1 * singe_sim_stats(plain).mass);
    for (uint32_t v = 0; v < 81; v++) assert_true(singe_sim_view(near).burn_rate[v] == 0);

    // a sheet that is too far away does nothing, nor does a sheet to itself
    assert_true(singe_sim_stats(far).mass == singe_sim_stats(plain).mass);
    assert_true(singe_sim_stats(own).mass == singe_sim_stats(plain).mass);

    // any number of threads, and saved
    test_assert_same(near, again);
    SingeSim *loaded = test_reload(NULL, near);
    test_steps(near, 20), test_steps(loaded, 20);
    test_assert_same(near, loaded);

    SingeSim *all[] = {plain, near, again, far, own, loaded};
    for (int k = 0; k < 6; k++) singe_sim_destroy(all[k]);
}

/// A blanket may burn itself. It smothers what is below as long as it is there.
TEST(a_burning_sheet_smothers_until_it_has_gone) {
    static const float rates[] = {0, 1e-3f, 0.2f}; // stays, goes in the middle, goes before
    double left[3];
    for (int k = 0; k < 3; k++) {
        OwnSim *sim = covered_by(rates[k], 3e-3f, 8e-3f, true, 1);
        left[k] = 0;
        for (uint32_t v = 0; v < 81; v++) left[k] += (double)singe_sim_view(sim).mass[v] / 81;
        print_message("hottest %g K, %.3f of the sheet is left\n", (double)hottest(sim), left[k]);
        assert_true(k == 0 ? hottest(sim) < 513 : hottest(sim) > 600);
    }
    assert_true(left[0] > left[1] + 0.1 && left[1] > left[2] + 0.1);
}

/// The most power of flames, W, above a blanket that lies 3 mm over a sheet which loses mass.
static double flames_above(float distance) {
    SingeSimDef def = singe_default_sim();
    def.gravity[2] = 0;
    def.solver.substeps = 1;
    def.gas.enabled = true;
    def.gas.cell_size = 8e-3f;
    def.gas.height = 0.05f;
    OwnSim *sim = test_create(&def);
    TestMesh low = test_grid(8, 8, 5e-3f, 5e-3f), high = test_grid(10, 10, 8e-3f, 8e-3f);
    test_mesh_move(&high, -20e-3f, -20e-3f, 3e-3f);

    SingeSheetDef sheet = test_sheet(&low), blanket = test_sheet(&high);
    sheet.material.drag = blanket.material.drag = singe_param(0);
    sheet.material.ablate = false;
    sheet.material.air_supply = singe_param(INFINITY);
    sheet.material.temperature = singe_param(800); // gives off gas whatever its flame does

    blanket.material.mass_rate = singe_param(0);
    blanket.material.smother_distance = singe_param(distance);
    test_add_sheet(sim, &sheet);
    test_add_sheet(sim, &blanket);
    test_ok(sim, singe_sim_commit(sim));

    const double before = singe_sim_stats(sim).mass;
    double most = 0;
    for (int step = 0; step < 120; step += 5) {
        test_steps(sim, 5);
        const SingeGas gas = singe_sim_gas(sim);
        double power = 0;
        for (uint32_t c = 0; c < gas.size[0] * gas.size[1] * gas.size[2]; c++) {
            const uint32_t layer = c / (gas.size[0] * gas.size[1]);
            const float z = gas.origin[2] + gas.cell * ((float)layer + 0.5f);
            if (z > 3e-3f) power += (double)gas.flame[c] * pow((double)gas.cell, 3);
        }
        most = fmax(most, power);
    }

    const SingeStats stats = singe_sim_stats(sim);
    print_message("mass %g of %g kg\n", stats.mass, before);
    assert_true(stats.ledgers_close && stats.mass < 0.98 * before);
    test_mesh_free(&low), test_mesh_free(&high);
    return most;
}

TEST(no_fire_stands_above_a_blanket) {
    const double plain = flames_above(0), smothered = flames_above(4e-3f), thin = flames_above(2e-4f);
    print_message("flames above: %g W; of one that smothers %g W, too far away %g W\n", plain, smothered, thin);
    assert_true(plain > 10);
    assert_true(smothered == 0);
    assert_true(thin == plain);
}

TEST(bad_water_is_refused) {
    SingeSim *sim = lit(0, true);
    SingeSourceDef rain = singe_default_source();
    SingeSourceId id;

    rain.kind = SINGE_SOURCE_WATER;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_source(sim, &rain, &id)); // no picture
    rain.texture = (SingeTexture){1, 1, &WHITE};
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_source(sim, &rain, &id)); // a dry sheet has no room
    singe_sim_destroy(sim);

    sim = lit(0.01f, true);
    rain.wetting = -1;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_source(sim, &rain, &id));
    rain.wetting = 1;
    test_ok(sim, singe_sim_add_source(sim, &rain, &id));

    SingeMaterialDef material = singe_default_material();
    material.moisture = singe_param(3.5f);
    SingeSheetId sheet;
    singe_sim_sheets(sim, &sheet, 1);
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_material(sim, sheet, &material, NULL));
    singe_sim_destroy(sim);
}

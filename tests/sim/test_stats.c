// The numbers: ledgers over a whole burning run, and each statistic against the view.
#include "common/random.h"
#include "common/order.h"
#include "scenes.h"

TEST(ledgers_close) {
    OwnTestScene scene = scene_make(NULL, 20);
    double worst_heat = 0, worst_mass = 0;
    for (int i = 0; i < 250; i++) {
        test_ok(scene.sim, singe_sim_step(scene.sim));
        SingeStats stats = singe_sim_stats(scene.sim);
        worst_heat = fmax(worst_heat, stats.ledger_error);
        worst_mass = fmax(worst_mass, stats.mass_ledger_error);
        double heat = stats.heat_in + stats.heat_of_combustion - stats.heat_lost - stats.heat_stored;
        assert_true(fabs(heat) <= 1e-5 * fmax(stats.heat_in, stats.heat_of_combustion));
    }

    assert_true(singe_sim_stats(scene.sim).ledgers_close);
    print_message("ledger errors: heat %.1e, mass %.1e\n", worst_heat, worst_mass);
    assert_true(worst_heat < 1e-5);
    assert_true(worst_mass < 1e-6);

    SingeStats stats = singe_sim_stats(scene.sim);
    assert_true(stats.heat_of_combustion > 0 && stats.heat_lost > 0 && stats.mass_removed > 0 &&
                stats.burnt_fraction > 0.3);
}

/// What damping takes from a sheet that falls is what the energies lack, and free fall lacks nothing; a strip that swings
/// passes all its energy to its springs and back.
TEST(energies_are_accounted_for) {
    SingeSimDef def = singe_default_sim();
    SingeMaterialDef material = singe_default_material();
    material.drag = singe_param(0);
    for (int damped = 0; damped < 2; damped++) {
        const double rate = damped ? 5 : 0, g = 9.81, time = 0.5, mass = 0.08 * 0.01;
        material.damping = singe_param((float)rate);
        OwnSim *sim = test_sim(&def, test_grid(10, 10, 0.01f, 0.01f), &material);
        test_steps(sim, 240);
        const SingeStats stats = singe_sim_stats(sim);

        // v = g (1 - exp(-d t))/d, and damping takes d m v^2
        double taken = 0;
        for (int i = 0; i < 1000 && damped; i++) {
            const double v = g * (1 - exp(-rate * time * (i + 0.5) / 1000)) / rate;
            taken += rate * mass * v * v * time / 1000;
        }

        print_message("damping %g: kinetic %.4g J, gravity %.4g J, lost %.4g J, to damping %.4g J\n", rate,
                      stats.energy_kinetic, stats.energy_gravity, stats.energy_lost, taken);
        assert_true(fabs(stats.energy_lost - taken) < 4e-3 * fabs(stats.energy_gravity));
        assert_true(stats.energy_elastic < 1e-4 * stats.energy_kinetic);
    }

    // a strip held along one side falls and swings
    material.damping = singe_param(0);
    def.gravity[2] = -1;
    def.solver.substeps = 24;
    def.solver.smoothing = 0;
    OwnSim *sim = test_sim(&def, test_grid(16, 4, 0.0025f, 0.0025f), &material);
    float points[3 * 10] = {0};
    for (int k = 0; k < 10; k++) points[3 * k] = k < 5 ? 0 : 0.0025f, points[3 * k + 1] = 0.0025f * (float)(k % 5);

    SingePinDef pin = singe_default_pin();
    pin.sheet = (SingeSheetId){0, 1}, pin.points = points, pin.point_count = 10, pin.radius = 1e-4f;
    test_add_pin(sim, &pin);

    double passed = 0, elastic = 0, lost = 0;
    for (int i = 0; i < 160; i++) {
        test_steps(sim, 1);
        const SingeStats stats = singe_sim_stats(sim);
        passed = fmax(passed, -stats.energy_gravity);
        elastic = fmax(elastic, stats.energy_elastic);
        lost = fmax(lost, fabs(stats.energy_lost));
    }

    print_message("a strip: weight gave %.3g J, springs held %.3g J, lost %.3g J\n", passed, elastic, lost);
    assert_true(elastic > 0.98 * passed && lost < 0.01 * passed);
}

/// A light sheet's heat spreads beside a heavy one of 10,000 K as it does alone.
TEST(a_hot_sheet_does_not_blur_another) {
    enum { PACES = 2, CELLS = 24 };
    static const float paces[PACES] = {50, 200};
    float *alone[PACES] = {NULL};
    for (int run = 0; run < 2 * PACES; run++) {
        SingeSimDef def = singe_default_sim();
        def.pace = paces[run % PACES];

        SingeMaterialDef light = singe_default_material(), heavy = singe_default_material();
        light.mass_rate = heavy.mass_rate = singe_param(0);
        light.grammage = singe_param(0.02f), heavy.grammage = singe_param(2);
        light.temperature =
            singe_param_field(293.15f, 443.15f, &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {0.02f, 2, 3}});
        heavy.temperature =
            singe_param_field(5000, 10000, &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {0.02f, 2, 4}});

        OwnSim *sim = test_create(&def);
        for (int sheet = 0; sheet < (run < PACES ? 1 : 2); sheet++) {
            OwnTestMesh mesh = test_grid(CELLS, CELLS, 0.0025f, 0.0025f);
            test_mesh_move(&mesh, 0, 0, (float)sheet);
            SingeSheetDef added = test_sheet(&mesh);
            added.material = sheet ? heavy : light;
            test_add_sheet(sim, &added);
        }

        test_ok(sim, singe_sim_commit(sim));
        test_steps(sim, 10);

        const SingeView view = singe_sim_view(sim);
        const uint32_t count = (CELLS + 1) * (CELLS + 1);
        if (run < PACES) {
            alone[run] = malloc(count * sizeof *alone[run]);
            memcpy(alone[run], view.temperature, count * sizeof *alone[run]);
        } else {
            double worst = 0;
            for (uint32_t v = 0; v < count; v++)
                worst = fmax(worst, (double)fabsf(view.temperature[v] - alone[run % PACES][v]));
            print_message("pace %g: off by %.2g K\n", (double)def.pace, worst);
            assert_true(worst < 5e-3);
            free(alone[run % PACES]);
        }
    }
}

/// Cells as bad as they come burn away, and nothing is ever colder than the air.
TEST(bad_cells_burn_and_stay_above_the_air) {
    for (uint32_t seed = 0; seed < 2; seed++) {
        SingeSimDef def = scene_def();
        def.solver.tearing = seed == 1;

        SingeMaterialDef material = scene_quick_material();
        TestMesh mesh = test_grid(20, 20, 0.01f, 0.01f);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            for (uint32_t k = 0; k < 2; k++)
                mesh.positions[3 * v + k] += 0.0084f * (random_unit(random_hash(v, k, seed, 9)) - 0.5f);

        OwnSim *sim = test_sim(&def, mesh, &material);
        test_spot(sim, 0.1f, 0.1f, 0, 0.05f, 1500, 1000);

        for (int step = 0; step < 160; step++) {
            test_ok(sim, singe_sim_step(sim));
            SingeView view = singe_sim_view(sim);
            for (uint32_t i = 0; i < view.particle_count; i++)
                if (!(view.temperature[i] > def.ambient_temperature - 0.1f))
                    fail_msg("step %d: particle %u has %g K", step, i, (double)view.temperature[i]);
        }

        SingeStats stats = singe_sim_stats(sim);
        assert_true(stats.particles < 800 && stats.ledgers_close); // of 841
    }
}

/// Steps so short that their changes vanish in a float are reported.
TEST(ledgers_that_do_not_close_are_reported) {
    SingeSimDef def = scene_def();
    def.pace = 1e-6f;
    SingeMaterialDef material = scene_quick_material();
    material.temperature = singe_param(400);
    OwnSim *sim = test_sim(&def, test_grid(8, 8, 0.01f, 0.01f), &material);
    test_steps(sim, 40);

    SingeStats stats = singe_sim_stats(sim);
    print_message("pace 1e-6: ledger error %.2g\n", stats.ledger_error);
    assert_true(stats.ledger_error > SINGE_LEDGER_BOUND && !stats.ledgers_close);
    assert_true(fabs(stats.heat_stored) < 1e-3); // next to nothing has happened
}

/// Heat of combustion: eta C dm of every particle, summed by hand over a run.
TEST(combustion_is_eta_times_mass) {
    SingeSimDef def = scene_def();
    SingeMaterialDef material = scene_quick_material();
    material.ablate = false;
    OwnSim *sim = test_sim(&def, test_grid(8, 8, 0.01f, 0.01f), &material);
    test_spot(sim, 0.04f, 0.04f, 0, 0.02f, 1500, 1000);
    test_steps(sim, 100);

    SingeStats stats = singe_sim_stats(sim);
    double expected = stats.mass_burnt * (double)material.specific_heat.value * 1500;

    // the mass of a step becomes heat in the next one
    assert_true(stats.heat_of_combustion > 0.9 * expected && stats.heat_of_combustion < 1.0001 * expected);
}

TEST(statistics_match_the_view) {
    OwnTestScene scene = scene_make(NULL, 12);
    const float mass_loss = scene_quick_material().mass_loss.value;
    for (int round = 0; round < 6; round++) {
        test_steps(scene.sim, 20);
        SingeView view = singe_sim_view(scene.sim);
        SingeStats stats = singe_sim_stats(scene.sim);
        uint32_t n = 0, springs = 0, cells = 0, particles = 0;
        float *strain = malloc(view.spring_count[SINGE_BLUE] * sizeof *strain), hottest = 0;
        assert_non_null(strain);

        double sum = 0;
        for (uint32_t k = 0; k < view.spring_count[SINGE_BLUE]; k++) {
            const uint32_t *ends = view.springs[SINGE_BLUE][k];
            if (!(view.spring_flags[SINGE_BLUE][k] & SINGE_ALIVE)) continue;
            if (view.particle_flags[ends[0]] & view.particle_flags[ends[1]] & SINGE_PINNED) continue; // held
            if (view.mass[ends[0]] < mass_loss && view.mass[ends[1]] < mass_loss) continue;           // not drawn
            const float *a = view.position[ends[0]], *b = view.position[ends[1]];
            float d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
            strain[n] = fabsf(sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / view.spring_length[SINGE_BLUE][k] - 1);
            sum += (double)strain[n++];
        }

        qsort(strain, n, sizeof *strain, order_by_float);
        assert_true(fabs(stats.strain_mean - sum / n) < 1e-6);
        assert_true(fabs(stats.strain_max - (double)strain[n - 1]) < 1e-6);
        assert_true(fabs(stats.strain_p99 - (double)strain[(size_t)(0.99 * (n - 1))]) < 1e-6);
        free(strain);

        for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
            for (uint32_t k = 0; k < view.spring_count[c]; k++) springs += view.spring_flags[c][k] & SINGE_ALIVE;
        for (uint32_t c = 0; c < view.cell_count; c++) cells += view.cell_flags[c] & SINGE_ALIVE;
        for (uint32_t i = 0; i < view.particle_count; i++)
            if (view.particle_flags[i] & SINGE_ALIVE) particles++, hottest = fmaxf(hottest, view.temperature[i]);
        assert_int_equal(stats.springs, springs);
        assert_int_equal(stats.cells, cells);
        assert_int_equal(stats.particles, particles);
        assert_true(stats.temperature_max == hottest);
    }
}

TEST(a_sheet_at_rest_has_no_strain) {
    OwnSim *sim = test_sim(NULL, test_grid(7, 5, 0.02f, 0.01f), NULL);
    SingeStats stats = singe_sim_stats(sim);
    double kilograms = 0.08 * 7 * 5 * 0.02 * 0.01;

    assert_true(fabs(stats.mass_initial / kilograms - 1) < 1e-5);
    assert_true(stats.mass == stats.mass_initial && stats.mass_burnt == 0 && stats.mass_removed == 0 &&
                stats.burnt_fraction == 0);
    assert_true(stats.strain_max < 1e-6 && stats.heat_stored == 0 && stats.ledger_error == 0 &&
                stats.mass_ledger_error < 1e-12);

    assert_int_equal(stats.inverted_cells, 0);
    assert_int_equal(stats.pieces, 1);
    assert_true(fabsf(stats.temperature_max - 293.15f) < 1e-3f);
    assert_true(stats.thickening >= 1);
    test_steps(sim, 12);

    double speed = singe_sim_stats(sim).speed_rms_unburnt; // falls freely, less a little air
    assert_true(speed > 0.1 && speed < 9.81 * 12 / 480 + 1e-6);
}

/// Heating without fire: what went in is stored or lost, and all of it is gone after long cooling.
TEST(heat_without_fire_is_stored_or_lost) {
    SingeSimDef def = scene_def();
    SingeMaterialDef material = singe_default_material();
    material.thickening = 1;
    OwnSim *sim = test_sim(&def, test_grid(6, 6, 0.01f, 0.01f), &material);
    SingeSourceId spot = test_spot(sim, 0.03f, 0.03f, 0, 0.05f, 450, 200);
    test_steps(sim, 30);

    SingeStats hot = singe_sim_stats(sim);
    assert_true(hot.heat_in > 0 && hot.heat_stored > 0.1 * hot.heat_in && hot.heat_of_combustion == 0);
    test_ok(sim, singe_sim_remove_source(sim, spot));
    test_steps(sim, 240 * 30);

    SingeStats cold = singe_sim_stats(sim);
    assert_true(cold.heat_in == hot.heat_in);
    assert_true(fabs(cold.heat_stored) < 2e-3 * cold.heat_in);
    assert_true(cold.ledger_error < 1e-5);
}

/// Office paper through all four stages: the front's speed, from the pattern of times and from two gates.
TEST(a_front_runs_along_a_strip) {
    const float size = 0.002f, length = 0.1f;
    SingeSimDef def = singe_default_sim();
    def.gravity[2] = 0;
    def.pace = 4;

    OwnSim *sim = test_sim(&def, test_grid(50, 4, size, size), NULL);
    SingeSourceId spot = test_spot(sim, 0, 0.004f, 0, 0.006f, 1100, 200);
    double gate[2] = {0, 0}; // s, when the middle line had ignited up to 40 % and 90 %
    uint32_t hit[2] = {0, 0};
    SingeView view = singe_sim_view(sim);
    for (uint32_t i = 0; i < view.particle_count; i++)
        for (int k = 0; k < 2; k++) {
            float d[2] = {view.rest_position[i][0] - (k ? 0.9f : 0.4f) * length, view.rest_position[i][1] - 0.004f};
            if (fabsf(d[0]) + fabsf(d[1]) < 1e-5f) hit[k] = i;
        }

    for (int step = 0; step < 480 * 6 && gate[1] == 0; step++) {
        test_ok(sim, singe_sim_step(sim));
        if (step == 240) test_ok(sim, singe_sim_remove_source(sim, spot));
        view = singe_sim_view(sim);
        for (int k = 0; k < 2; k++)
            if (view.time_ignited[hit[k]] >= 0) gate[k] = (double)view.time_ignited[hit[k]];
    }

    assert_true(gate[1] > gate[0] && gate[0] > 0);
    double speed = 0.5 * (double)length / ((gate[1] - gate[0]) * (double)def.pace);
    double measured = singe_sim_stats(sim).front_speed;
    print_message("front: %.2f mm/s between gates, %.2f mm/s by its times\n", 1e3 * speed, 1e3 * measured);
    assert_true(fabs(measured / speed - 1) < 0.05);
    assert_true(speed > 4.4e-3 && speed < 7.0e-3);
}

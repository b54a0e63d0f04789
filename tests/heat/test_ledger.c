// The ledger of heat: stored = in + combustion - lost, each counted by its own formula; and the same bits from any
// number of threads.
#include "rig.h"

static const SingePoseKey MIDDLE = {.position = {0.03f, 0.03f, 0}, .rotation = {0, 0, 0, 1}};

static RigDef paper(SingeHeatOperator heat_operator) {
    RigDef def = rig_default(40, 40, 0.002f, 0.002f);
    def.material = singe_default_material();
    def.material.heat_operator = heat_operator;
    def.settings.tolerance = 1e-5f;
    def.material.temperature = singe_param(310);
    return def;
}

static void light(Rig *rig) {
    SingeSourceDef spot = singe_default_source();
    spot.path = &MIDDLE, spot.path_count = 1, spot.end = 0.6f;
    rig_source(rig, &spot);
}

/// A ring of fire that grows from the middle; what it has passed falls away here and there.
static void burn(Rig *rig, bool remove) {
    double radius = 0.005 + 0.01 * rig->state.time;
    for (uint32_t i = 0; i < rig->shell.particle_count; i++) {
        const float *x = rig_position(rig, i);
        double d = hypot((double)x[0] - 0.03, (double)x[1] - 0.03);
        bool burns = fabs(d - radius) < 0.004 && rig->state.burn.mass[i] > 0.2f;
        rig->state.burn.burn_rate[i] = burns ? 0.8f : 0;
        rig->state.burn.release[i] = burns ? 0.8f * field_at(rig->shell.matter.heating, i) : 0;
        if (burns) rig->state.burn.mass[i] -= 0.8f * rig->h;
        if (remove && d < radius - 0.006 && i % 3 == 0) rig_remove(rig, i);
    }
}

TEST(ledger_closes) {
    for (int k = 0; k < 4; k++) {
        RigDef def = paper(k % 2 ? SINGE_HEAT_UMBRELLA : SINGE_HEAT_SURFACE);
        def.settings.pace = k < 2 ? 1 : 3;
        def.material.thickening = k < 2 ? 0 : 1;

        OwnRig rig = rig_open(&def);
        light(&rig);
        double start = rig_content(&rig, 1);

        for (int step = 0; step < 500; step++) {
            burn(&rig, step % 20 == 0);
            rig_step(&rig);
        }

        const HeatState *heat = &rig.state.heat;
        double stored = rig_content(&rig, 1) + rig.removed - start;
        double largest = fmax(fmax(fabs(stored), heat->heat_in), fmax(heat->heat_lost, heat->heat_of_combustion));
        double error = (heat->heat_in + heat->heat_of_combustion - heat->heat_lost - stored) / largest;
        print_message("ledger %d: in %.3f J, combustion %.3f J, lost %.3f J, error %.2e\n", k, heat->heat_in,
                      heat->heat_of_combustion, heat->heat_lost, error);

        CHECK_NEAR(error, 0, 1e-6);
        assert_true(heat->heat_in > 0.03 * largest && heat->heat_lost > 0.03 * largest &&
                    heat->heat_of_combustion > 0.1 * largest);
    }
}

/// Warmth far below a float's last digit must not leak away while nothing else happens.
TEST(small_changes_are_not_lost) {
    RigDef def = paper(SINGE_HEAT_SURFACE);
    def.settings.ambient_temperature = 293;
    def.material.thickening = 1;
    def.material.temperature = singe_param(293.02f); // cools by 1e-5 K a step; a float's digit is 3e-5 K

    OwnRig rig = rig_open(&def);
    double start = rig_content(&rig, 1);
    for (int step = 0; step < 500; step++) rig_step(&rig);

    double stored = rig_content(&rig, 1) - start;
    assert_true(rig.state.heat.heat_lost > 0.2 * start);
    CHECK_NEAR(-stored, rig.state.heat.heat_lost, 2e-3 * start);
}

/// A sheet after 60 steps, in which it burns; 0 threads stand for no pool.
static Rig burn_on(int threads) {
    RigDef def = paper(SINGE_HEAT_SURFACE);
    Rig rig = rig_open(&def);
    light(&rig);
    if (threads) assert_int_equal(pool_create(&rig.memory, (SingeTasks){0}, threads, &rig.pool), SINGE_OK);
    for (int step = 0; step < 60; step++) {
        burn(&rig, step % 10 == 0);
        rig_step(&rig);
    }
    return rig;
}

TEST(threads_do_not_matter) {
    OwnRig one = burn_on(0);
    for (int threads = 1; threads <= 3; threads++) {
        OwnRig rig = burn_on(threads);
        const HeatState *a = &one.state.heat, *b = &rig.state.heat;
        assert_memory_equal(a->temperature, b->temperature, rig.shell.particle_count * sizeof *a->temperature);
        assert_true(a->heat_in == b->heat_in && a->heat_lost == b->heat_lost &&
                    a->heat_of_combustion == b->heat_of_combustion);
        assert_int_equal(one.counters.iterations, rig.counters.iterations);
    }
}

/// A plan made in the middle of a run (after a load) gives what the old one gives.
TEST(a_new_plan_goes_on_to_the_bit) {
    Rig rigs[2];
    for (int k = 0; k < 2; k++) {
        RigDef def = paper(SINGE_HEAT_SURFACE);
        rigs[k] = rig_open(&def);
        light(&rigs[k]);
        for (int step = 0; step < 60; step++) {
            if (k && step == 35) {
                heat_plan_free(&rigs[k].memory, rigs[k].plan);
                assert_int_equal(
                    heat_plan_create(&rigs[k].memory, &rigs[k].shell, &rigs[k].settings, &rigs[k].plan, &rigs[k].error),
                    SINGE_OK);
            }

            burn(&rigs[k], step % 10 == 0);
            rig_step(&rigs[k]);
        }
    }

    assert_memory_equal(rigs[0].state.heat.temperature, rigs[1].state.heat.temperature,
                        rigs[0].shell.particle_count * sizeof(float));
    for (int k = 0; k < 2; k++) rig_close(&rigs[k]);
}

// Arrival maps: the front is where the map says, whatever the cells, the pace and the material.
#include "support/support.h"

enum { WIDE = 51, HIGH = 10 };

/// A map from black at the left to grey at the right, whose upper third is white.
static SingeTexture ramp(float values[HIGH * WIDE]) {
    for (int k = 0; k < HIGH * WIDE; k++) values[k] = k / WIDE < 3 ? 1 : 0.99f * (float)(k % WIDE) / (WIDE - 1);
    return (SingeTexture){WIDE, HIGH, values};
}

static SingeSourceDef map_of(const SingeTexture *texture) {
    SingeSourceDef def = singe_default_source();
    def.kind = SINGE_SOURCE_ARRIVAL;
    def.texture = *texture;
    def.arrival_from = 0.1f;
    def.arrival_to = 0.6f;
    return def;
}

/// A sheet of 200 mm by 80 mm in cells of `cell` mm, with a map.
static SingeSim *mapped(int cell, float pace, float mass_rate, SingeSourceId *id) {
    SingeSimDef def = singe_default_sim();
    def.pace = pace;
    def.gravity[2] = 0;
    def.solver.substeps = 2;

    SingeMaterialDef material = singe_default_material();
    material.mass_rate = singe_param(mass_rate);

    SingeSim *sim =
        test_sim(&def, test_grid(200u / (uint32_t)cell, 80u / (uint32_t)cell, 1e-3f * (float)cell, 1e-3f * (float)cell),
                 &material);
    float values[HIGH * WIDE];
    SingeTexture texture = ramp(values);
    SingeSourceDef source = map_of(&texture);
    test_ok(sim, singe_sim_add_source(sim, &source, id));
    return sim;
}

/// The time that the ramp says, s: bilinear between the centres of its pixels.
static double due(float u) {
    const double at = fmin(fmax((double)u * WIDE - 0.5, 0), WIDE - 1);
    return 0.1 + 0.5 * 0.99 * at / (WIDE - 1);
}

TEST(the_front_arrives_when_the_map_says) {
    static const struct {
        int cell;
        float pace, mass_rate;
    } cases[] = {{5, 1, 9e-3f}, {10, 6, 9e-3f}, {10, 0.2f, 9e-3f}, {10, 1, 1e-4f}, {10, 1, 0.1f}};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        SingeSourceId id;
        OwnSim *sim = mapped(cases[k].cell, cases[k].pace, cases[k].mass_rate, &id);
        double h = 1.0 / 480;
        for (int half = 0; half < 2; half++) {
            test_steps(sim, half ? 180 : 150);
            SingeView view = singe_sim_view(sim);
            uint32_t lit = 0, spared = 0;
            for (uint32_t i = 0; i < view.particle_count; i++) {
                const float u = view.uv[i][0], v = view.uv[i][1];
                if (v > 0.71f) {
                    assert_true(view.time_ignited[i] < 0);
                    spared++;
                } else if (v < 0.69f) {
                    const bool is = due(u) < view.time - 1.01 * h;
                    if (is) assert_true(fabs((double)view.time_ignited[i] - due(u)) <= 1.01 * h);
                    else if (due(u) > view.time) assert_true(view.time_ignited[i] < 0);
                    lit += is;
                }
            }

            assert_true(lit > (half ? 200 : 80) && spared > 60);
            SingeStats stats = singe_sim_stats(sim);
            assert_true(stats.arrival_error > 0 && stats.arrival_error <= 1.01 * h && stats.arrival_missed == 0);
            assert_true(stats.ledgers_close);
        }

        // without the map the fire is on its own; what it did not reach cannot be missed
        test_ok(sim, singe_sim_remove_source(sim, id));
        assert_true(singe_sim_stats(sim).arrival_error == 0 && singe_sim_stats(sim).arrival_missed == 0);
    }
}

TEST(particles_that_miss_the_map_are_counted) {
    SingeSourceId id;
    OwnSim *sim = mapped(10, 1, 9e-3f, &id);
    test_steps(sim, 100);
    test_ok(sim, singe_sim_remove_source(sim, id));

    float values[HIGH * WIDE];
    SingeTexture texture = ramp(values);
    SingeSourceDef source = map_of(&texture);
    source.arrival_from = 0.3f; // later than what has burnt
    test_ok(sim, singe_sim_add_source(sim, &source, &id));

    assert_true(singe_sim_stats(sim).arrival_error > 0.1);
    test_ok(sim, singe_sim_remove_source(sim, id));
    for (int k = 0; k < HIGH * WIDE; k++) values[k] = 1;
    test_ok(sim, singe_sim_add_source(sim, &source, &id));
    assert_true(singe_sim_stats(sim).arrival_missed > 20); // burnt where nothing may
}

TEST(a_map_is_saved) {
    SingeSourceId id;
    SingeSim *sim = mapped(10, 2, 9e-3f, &id), *copy;
    test_steps(sim, 120);

    OwnTestBytes bytes = test_save(sim);
    SingeSimDef hooks = singe_default_sim();
    hooks.thread_count = 2;
    SingeSim *loaded = test_load(&hooks, &bytes);

    test_ok(sim, singe_sim_clone(sim, &copy));
    test_steps(sim, 60), test_steps(loaded, 60), test_steps(copy, 60);
    test_assert_same(sim, loaded);
    test_assert_same(sim, copy);
    assert_true(singe_sim_stats(loaded).arrival_error < 0.003);
    singe_sim_destroy(sim), singe_sim_destroy(loaded), singe_sim_destroy(copy);

    // a value that is no time
    const float bad = -0.5f, good = 2;
    size_t at = 0;
    for (size_t k = 0; k + 4 <= bytes.size && !at; k++) {
        float run[3];
        memcpy(run, bytes.data + k, k + sizeof run <= bytes.size ? sizeof run : 4);
        if (k + sizeof run <= bytes.size && run[0] == good && run[1] == good && run[2] == good) at = k;
    }

    assert_true(at > 0);
    memcpy(bytes.data + at, &bad, sizeof bad);
    SingeError error;
    assert_int_equal(singe_sim_load(&hooks, bytes.data, bytes.size, &loaded, &error), SINGE_ERROR_FORMAT);
}

TEST(bad_maps_are_refused) {
    SingeSourceId id;
    OwnSim *sim = mapped(20, 1, 9e-3f, &id);
    float values[HIGH * WIDE];
    SingeTexture texture = ramp(values);
    SingeSourceDef good = map_of(&texture), bad[5];
    for (int k = 0; k < 5; k++) bad[k] = good;

    bad[0].texture.width = 0;
    bad[1].texture.values = NULL;
    bad[2].arrival_from = -1;
    bad[3].arrival_to = INFINITY;
    bad[4].lead = 0;
    for (int k = 0; k < 5; k++) test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_source(sim, &bad[k], &id));

    const float wrong[] = {-0.01f, 1.01f, NAN};
    for (int k = 0; k < 3; k++) {
        values[7] = wrong[k];
        test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_source(sim, &good, &id));
        assert_int_equal(singe_sim_error(sim)->element, 7);
    }

    values[7] = 0.5f;
    test_ok(sim, singe_sim_add_source(sim, &good, &id));
}

// Eq 4 to 6 against their closed forms; ignition; determinism; the mass ledger.
#include "ablate/burning_sheet.h"

static SingeResult step(BurningSheet *b, Pool *pool, float h, float pace, float thickening) {
    double partial[64];
    float factors[4] = {thickening, thickening, thickening, thickening};
    assert_true(pool_blocks((int)b->shell.particle_count) <= 64);
    return sheet_burn(b, pool, h, pace, factors, partial);
}

static void heat_all(BurningSheet *b, float temperature) {
    for (uint32_t i = 0; i < b->shell.particle_count; i++) b->state.heat.temperature[i] = temperature;
}

static float volume_ratio(float mass, float fuel, float ash, float char_density, float ash_density) {
    return burn_volume_ratio(float4_all(mass), float4_all(fuel), float4_all(ash), float4_all(char_density),
                             float4_all(ash_density))[3];
}

TEST(volume_ratio_follows_eq_5) {
    // constant density: the volume is the mass
    assert_float_equal(volume_ratio(1, 1, 0, 1, 1), 1, 1e-7);
    assert_float_equal(volume_ratio(0.4f, 0.3f, 0.7f, 1, 1), 0.4f, 1e-7);

    // the density at half the way to m_min = 0.2 and rho_ash = 0.3 is 0.65: 0.6/0.65
    assert_float_equal(volume_ratio(0.6f, 0.5f, 0.5f, 0.45f, 0.3f), 0.6 / 0.65, 1e-6);
    assert_float_equal(volume_ratio(0.2f, 0, 1, 0.45f, 0.3f), 0.2 / 0.3, 1e-6);

    // never outside [0.05, 1]
    assert_float_equal(volume_ratio(0.9f, 0.125f, 0.875f, 0.45f, 0.01f), 1, 0);
    assert_float_equal(volume_ratio(0, 0, 1, 0.45f, 1), 0.05f, 0);
    assert_float_equal(shell_burn_progress(0.6f, 0.2f), 0.5, 1e-6);
    assert_float_equal(shell_burn_progress(0.1f, 0.2f), 1, 0);
}

TEST(no_exponent_is_a_straight_line) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_sheet(2, 2, 0.01f, &material);
    heat_all(b, 600); // mu (T - T_ign) = 0.1 1/s

    for (int n = 1; n <= 20; n++) {
        assert_int_equal(step(b, NULL, 0.25f, 2, 2.5f), SINGE_OK); // 0.1 * 0.25 * 2 / 2.5 = 0.02 a step
        for (uint32_t i = 0; i < b->shell.particle_count; i++) {
            assert_float_equal(b->state.burn.mass[i], 1 - 0.02 * n, 1e-6);
            assert_float_equal(b->state.burn.burn_rate[i], 0.08, 1e-6); // per second of scene time
        }
    }
}

/// The error of the mass after a second in steps of h, of a sheet that heats itself by 2400 K when all of it burns:
/// e = T - T_ign grows as exp(eta mu t).
static double self_heated(float h) {
    SingeMaterialDef material = plain_material();
    material.heat_of_combustion = singe_param(2400 * 1400), material.heat_share = singe_param(1);
    OwnBurningSheet *b = burning_sheet(1, 1, 0.01f, &material);
    heat_all(b, 520);
    for (int n = 0; n < (int)lround(1 / (double)h); n++) {
        assert_int_equal(step(b, NULL, h, 1, 1), SINGE_OK);
        for (uint32_t i = 0; i < b->shell.particle_count; i++)
            b->state.heat.temperature[i] += h * b->state.burn.release[i];
    }

    const double mass = (double)b->state.burn.mass[0], exact = 1 - 20 * (exp(2400 * 1e-3) - 1) / 2400;
    return exact - mass;
}

/// Half the step is a quarter of the error; with the T of each step's beginning it is half, and ten times as much.
TEST(fuel_heats_itself_to_second_order) {
    const double coarse = self_heated(0.1f), fine = self_heated(0.05f);
    print_message("off by %.2e and %.2e\n", coarse, fine);
    assert_true(fabs(fine / coarse) < 0.3 && fabs(coarse) < 2e-3);
}

TEST(rate_stops_growing_at_its_ceiling) {
    SingeMaterialDef material = plain_material();
    material.rate_ceiling = singe_param(50);
    OwnBurningSheet *b = burning_sheet(2, 2, 0.01f, &material);
    const float temperatures[] = {540, 550, 560, 5000};
    for (int i = 0; i < 4; i++) b->state.heat.temperature[i] = temperatures[i];
    assert_int_equal(step(b, NULL, 1, 1, 1), SINGE_OK);
    assert_float_equal(b->state.burn.mass[0], 1 - 1e-3 * 40, 1e-6);
    for (int i = 1; i < 4; i++) assert_float_equal(b->state.burn.mass[i], 1 - 1e-3 * 50, 1e-6);
}

TEST(ceilings_may_vary) {
    static const float halves[] = {0, 1};
    SingeMaterialDef material = plain_material();
    material.rate_ceiling =
        singe_param_field(50, 200, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, halves}});
    OwnBurningSheet *b = burning_sheet(8, 2, 0.01f, &material);
    heat_all(b, 5000);
    assert_int_equal(step(b, NULL, 1, 1, 1), SINGE_OK);

    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        float u = b->shell.uv[i][0], f = fminf(fmaxf(2 * u - 0.5f, 0), 1);
        assert_float_equal(b->state.burn.mass[i], 1 - 1e-3f * (50 + 150 * f), 1e-6);
    }
}

/// The solution of dx/dt = -k x^p from x = 1.
static double exact(double k, double t, double p) {
    if (p == 1) return exp(-k * t);
    double y = 1 - (1 - p) * k * t;
    return y <= 0 ? 0 : pow(y, 1 / (1 - p));
}

/// Eq 4 alone would burn 40 g/(m2 s) everywhere. Areas of a radius of 8 mm do so, and a large sheet burns the 24 for which
/// its two faces have air, whatever the size of its cells and its position. Two threads do the same.
TEST(a_large_area_burns_what_it_has_air_for) {
    static const struct {
        uint32_t side;
        float cell, slope; // of the sheet along x
        bool all;          // is hot, or 8 mm about the middle
        double expected;   // g/(m2 s)
    } cases[] = {
        {40, 5e-3f, 0, true, 24}, {40, 5e-3f, 0.7f, true, 24}, {12, 20e-3f, 0.1f, true, 24}, {40, 5e-3f, 0, false, 40}};
    SingeMaterialDef material = plain_material();
    material.air_supply = singe_param(0.012f);

    Memory memory = memory_make((SingeAllocator){0});
    Pool *pool;
    assert_int_equal(pool_create(&memory, (SingeTasks){0}, 2, &pool), SINGE_OK);

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const float length = (float)cases[k].side * cases[k].cell, middle = length / 2;
        BurningSheet *b[2];
        for (int n = 0; n < 2; n++) {
            b[n] = burning_sheet(cases[k].side, cases[k].side, cases[k].cell, &material);
            float(*x)[4] = b[n]->state.dynamics.position;
            for (uint32_t i = 0; i < b[n]->shell.particle_count; i++) {
                const bool hot = cases[k].all || fabsf(x[i][0] - middle) < 4e-3f;
                b[n]->state.heat.temperature[i] = hot ? 1000 : 300;
                x[i][2] = cases[k].slope * x[i][0], x[i][0] *= sqrtf(1 - cases[k].slope * cases[k].slope);
            }
            assert_int_equal(step(b[n], n ? pool : NULL, 1e-3f, 1, 1), SINGE_OK);
        }

        const uint32_t at = cases[k].side / 2 * (cases[k].side + 1) + cases[k].side / 2;
        const double burns = 80 * (double)b[0]->state.burn.burn_rate[at];
        print_message("%.1f g/(m2 s)\n", burns);
        assert_float_equal(burns, cases[k].expected, 0.1 * cases[k].expected);
        assert_memory_equal(b[1]->state.arena, b[0]->state.arena, b[0]->state.arena_size);
        burning_sheet_free(b[0]), burning_sheet_free(b[1]);
    }

    pool_destroy(&memory, pool);
}

TEST(exponents_follow_their_solutions) {
    const float exponents[] = {0, 0.25f, 0.5f, 0.999f, 1, 1.5f, 2, 3};
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        SingeMaterialDef material = plain_material();
        material.ash_exponent = singe_param(exponents[e]);
        OwnBurningSheet *b = burning_sheet(1, 1, 0.01f, &material);
        heat_all(b, 670); // k = 0.17/0.85 = 0.2 1/s

        for (int n = 1; n <= 80; n++) {
            assert_int_equal(step(b, NULL, 0.1f, 1, 1), SINGE_OK);
            double expected = 0.15 + 0.85 * exact(0.2, 0.1 * n, (double)exponents[e]);
            assert_float_equal(b->state.burn.mass[0], expected, 5e-6);
        }
    }
}

/// However fast it burns and whatever the exponent, the mass that is left is a number and at least m_min.
TEST(any_rate_leaves_a_mass) {
    const float exponents[] = {0, 0.01f, 0.5f, 1, 2, 3, 30, 300};
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++)
        for (int k = 0; k < 2; k++) {
            SingeMaterialDef material = plain_material();
            material.ash_exponent = singe_param(exponents[e]), material.mass_rate = singe_param(k ? 3e38f : 1);
            OwnBurningSheet *b = burning_sheet(1, 1, 0.01f, &material);
            heat_all(b, 5000);
            b->state.burn.mass[0] = 0.3f, b->state.burn.fuel[0] = 0.15f / 0.85f;
            for (int n = 0; n < 3; n++) {
                assert_int_equal(step(b, NULL, 10, 1, 1), SINGE_OK);
                assert_true(b->state.burn.mass[0] >= 0.15f && b->state.burn.mass[0] < 0.30001f);
            }
        }
}

/// dx/dt = -A exp(-E/(R T)) x^p at a T of each particle's own, as hot as the ceiling lets it count.
TEST(kinetics_follow_arrhenius) {
    const float exponents[] = {0, 0.5f, 1, 1.3f};
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        SingeMaterialDef material = plain_material();
        material.ash_exponent = singe_param(exponents[e]), material.rate_ceiling = singe_param(120);
        material.pre_exponential = singe_param(4.276e11f), material.activation_energy = singe_param(160e3f);
        OwnBurningSheet *b = burning_sheet(2, 2, 0.01f, &material);
        const double ignition = (double)material.ignition_temperature.value;
        for (uint32_t i = 0; i < b->shell.particle_count; i++)
            b->state.heat.temperature[i] = (float)ignition - 10 + 15 * (float)i;

        for (int n = 1; n <= 40; n++) {
            assert_int_equal(step(b, NULL, 0.1f, 2, 2.5f), SINGE_OK); // 0.08 s over F
            for (uint32_t i = 0; i < b->shell.particle_count; i++) {
                double t = fmin((double)b->state.heat.temperature[i], ignition + 120);
                double k = t > ignition ? 4.276e11 * exp(-160e3 / (8.314462618 * t)) : 0;
                assert_float_equal(b->state.burn.mass[i], 0.15 + 0.85 * exact(k, 0.08 * n, (double)exponents[e]), 2e-5);
            }
        }
    }
}

TEST(no_step_passes_the_least_mass) {
    const float exponents[] = {0, 0.3f, 0.5f, 1, 1.7f, 2, 5}, steps[] = {1, 50, 1e4f, 1e30f};
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++)
        for (size_t s = 0; s < sizeof steps / sizeof *steps; s++) {
            SingeMaterialDef material = plain_material();
            material.ash_exponent = singe_param(exponents[e]);
            OwnBurningSheet *b = burning_sheet(1, 1, 0.01f, &material);
            heat_all(b, 1500);
            float min = field_at(b->shell.matter.mass_min, 0), before = 1;
            for (int n = 0; n < 30; n++) {
                assert_int_equal(step(b, NULL, steps[s], 1, 1), SINGE_OK);
                float mass = b->state.burn.mass[0];
                assert_true(mass >= min && mass <= before);
                before = mass;
            }

            if (exponents[e] <= 1) assert_float_equal(before, min, 1e-6);
        }
}

TEST(particles_ignite_once_and_in_order) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_sheet(60, 40, 0.01f, &material);
    const BurnState *burn = &b->state.burn;
    const uint32_t lit[] = {3, 1023, 1024, 2500, 4000, 4100};

    b->state.time = 1.5;
    b->state.heat.temperature[4000] = 499.99f;
    for (int k = 0; k < 6; k++)
        if (lit[k] != 4000) b->state.heat.temperature[lit[k]] = 500; // exactly at the ignition point
    b->state.ablate.particle_flags[4100] = 0;
    assert_int_equal(step(b, NULL, 0.1f, 1, 1), SINGE_OK);
    assert_int_equal(b->events.count, 4);

    for (size_t k = 0; k < 4; k++) {
        assert_int_equal(b->events.items[k].kind, SINGE_EVENT_IGNITED);
        assert_int_equal(b->events.items[k].element, lit[k]);
        assert_float_equal(b->events.items[k].time, 1.5, 0);
        assert_float_equal(b->events.items[k].position[0], b->shell.rest_position[lit[k]][0], 0);
        assert_float_equal(burn->time_ignited[lit[k]], 1.5f, 0);
    }

    assert_float_equal(burn->time_ignited[4000], -1, 0);
    assert_float_equal(burn->time_ignited[4100], -1, 0);
    b->state.time = 1.6;
    b->state.heat.temperature[4000] = 800;
    assert_int_equal(step(b, NULL, 0.1f, 1, 1), SINGE_OK);
    assert_int_equal(b->events.count, 5);
    assert_int_equal(b->events.items[4].element, 4000);

    assert_float_equal(burn->time_ignited[3], 1.5f, 0);
    assert_float_equal(burn->time_ignited[4000], 1.6f, 0);
}

TEST(particles_are_burnt_below_the_loss) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_sheet(1, 1, 0.01f, &material);
    heat_all(b, 600); // 0.1 of the mass a second

    b->state.ablate.particle_flags[0] = 0;
    for (int n = 0; n < 8; n++) {
        b->state.time = n;
        for (uint32_t i = 0; i < b->shell.particle_count; i++) assert_float_equal(b->state.burn.time_burnt[i], -1, 0);
        if (n == 7) b->state.heat.temperature[2] = 500; // 0.3 of its mass stays
        assert_int_equal(step(b, NULL, 1, 1, 1), SINGE_OK);
    }

    assert_float_equal(b->state.burn.time_burnt[1], 7, 0);
    assert_float_equal(b->state.burn.mass[1], 0.2, 1e-6);
    b->state.time = 8;
    assert_int_equal(step(b, NULL, 0.1f, 1, 1), SINGE_OK);

    assert_float_equal(b->state.burn.mass[1], 0.19, 1e-6);
    assert_float_equal(b->state.burn.time_burnt[1], 7, 0); // stamped once
    assert_float_equal(b->state.burn.time_burnt[2], -1, 0);
    assert_float_equal(b->state.burn.burn_rate[2], 0, 0);
    assert_float_equal(b->state.burn.mass[0], 1, 0); // what is gone does not burn
    assert_float_equal(b->state.burn.time_burnt[0], -1, 0);
}

/// The blue spring between two corners.
static uint32_t blue_between(const Shell *shell, uint32_t a, uint32_t b) {
    const SpringSet *set = &shell->springs[SINGE_BLUE];
    for (uint32_t s = 0; s < set->count; s++)
        if ((set->ends[s][0] == a && set->ends[s][1] == b) || (set->ends[s][0] == b && set->ends[s][1] == a)) return s;
    fail();
    return 0;
}

/// Target over rest length of the spring between two corners burnt to the given masses.
static double shrunk_ratio(float mass_a, float mass_b, float shrink_a, float shrink_b) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_sheet(2, 1, 0.01f, &material);
    uint32_t s = blue_between(&b->shell, 0, 1);
    float *shrink = burning_sheet_vary(b, &b->shell.matter.shrink);
    shrink[0] = shrink_a, shrink[1] = shrink_b;
    b->state.heat.temperature[0] = 500 + 1000 * (1 - mass_a);
    b->state.heat.temperature[1] = 500 + 1000 * (1 - mass_b);
    assert_int_equal(step(b, NULL, 1, 1, 1), SINGE_OK);
    assert_float_equal(b->state.burn.mass[0], mass_a, 1e-6);

    double ratio = (double)(b->state.burn.spring_length[SINGE_BLUE][s] / b->shell.springs[SINGE_BLUE].rest[s]);
    return ratio;
}

TEST(springs_shrink_by_eq_6) {
    // Fig 5 a to d: 87.5, 62.5, 57.5 and 50 %
    assert_float_equal(shrunk_ratio(1, 0.75f, 1, 1), 0.875, 1e-6);
    assert_float_equal(shrunk_ratio(0.75f, 0.5f, 1, 1), 0.625, 1e-6);
    assert_float_equal(shrunk_ratio(0.95f, 0.2f, 1, 1), 0.575, 1e-6);
    assert_float_equal(shrunk_ratio(0.8f, 0.2f, 1, 1), 0.5, 1e-6);

    // a layer's own share
    assert_float_equal(shrunk_ratio(0.75f, 0.5f, 0, 0), 1, 0);
    assert_float_equal(shrunk_ratio(0.75f, 0.5f, 0.5f, 1), 1 - 0.75 * 0.375, 1e-6);

    // shrinking more than all there is does not turn a spring inside out
    assert_float_equal(shrunk_ratio(0.15f, 0.15f, 2, 2), 0.05, 1e-6);
}

TEST(all_colours_shrink_and_do_not_compound) {
    SingeMaterialDef material = plain_material();
    material.ash_density = singe_param(0.3f);
    material.shrink_front = singe_param(0.5f);
    OwnBurningSheet *b = burning_sheet(5, 4, 0.01f, &material);
    for (uint32_t i = 0; i < b->shell.particle_count; i++) b->state.heat.temperature[i] = 400 + 10 * (float)i;
    const CellSprings *gone = &b->shell.cell_springs[7]; // with its cell, which has a neighbour at every side
    for (int i = 0; i < 4; i++) {
        assert_true(gone->green[i] != SHELL_NONE);
        b->state.ablate.spring_flags[SINGE_RED][gone->red[i]] = 0;
        b->state.ablate.spring_flags[SINGE_GREEN][gone->green[i]] = 0;
        b->state.ablate.spring_flags[SINGE_YELLOW][gone->yellow[i & 1]] = 0;
    }
    b->state.ablate.cell_flags[7] = 0;
    for (int n = 0; n < 5; n++) assert_int_equal(step(b, NULL, 0.2f, 1, 1), SINGE_OK);

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t s = 0; s < b->shell.springs[colour].count; s++) {
            double volumes = 0, shrink = 0;
            for (int k = 0; k < 2; k++) {
                uint32_t end = b->shell.springs[colour].ends[s][k];
                double m = (double)b->state.burn.mass[end];
                volumes += m / (1 - 0.7 * (1 - m) / 0.85) / 2;
                shrink += (end < b->shell.vertex_count ? 1 : 0.5) / 2;
            }

            double expected = 1 - shrink * (1 - volumes), rest = (double)b->shell.springs[colour].rest[s];
            if (!(b->state.ablate.spring_flags[colour][s] & SINGE_ALIVE)) expected = 1;
            assert_float_equal((double)b->state.burn.spring_length[colour][s] / rest, expected, 2e-6);
        }
}

/// Where a stretched plane takes the way d: l_along and l_across the fibres at `angle`, l_up along z.
static double stretched_length(const double *d, double angle, double l_along, double l_across, double l_up) {
    double along = cos(angle) * d[0] + sin(angle) * d[1], across = cos(angle) * d[1] - sin(angle) * d[0];
    return sqrt(pow(l_along * along, 2) + pow(l_across * across, 2) + pow(l_up * d[2], 2));
}

/// Across fibres a sheet shrinks q times as much as along them, and all springs of all colours measure one plane.
TEST(fibres_turn_shrinkage) {
    const double q = 2.5, angles[] = {0, 0.3, 1.2, -0.7};
    for (int k = 0; k < 4; k++) {
        SingeMaterialDef material = plain_material();
        material.fibre_angle = singe_param((float)angles[k]);
        material.fibre_shrink = singe_param((float)q);
        OwnBurningSheet *b = burning_sheet(5, 4, 0.01f, &material);
        for (uint32_t i = 0; i < b->shell.particle_count; i++) b->state.heat.temperature[i] = 800;
        assert_int_equal(step(b, NULL, 1, 1, 1), SINGE_OK);

        const double even = (double)b->state.burn.mass[0], stretch = (1 - even) * (q - 1) / (q + 1);
        assert_float_equal(even, 0.7, 1e-6);

        for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
            for (uint32_t s = 0; s < b->shell.springs[colour].count; s++) {
                const uint32_t *ends = b->shell.springs[colour].ends[s];
                double d[3];
                const float *from = b->shell.rest_position[ends[0]], *to = b->shell.rest_position[ends[1]];
                for (int axis = 0; axis < 3; axis++) d[axis] = (double)to[axis] - (double)from[axis];
                double expected = stretched_length(d, angles[k], even + stretch, even - stretch, even);
                assert_float_equal((double)b->state.burn.spring_length[colour][s], expected, 1e-7);
            }
    }

    SingeMaterialDef even = plain_material();
    even.fibre_shrink = singe_param(1);
    OwnBurningSheet *b = burning_sheet(2, 2, 0.01f, &even);
    assert_null(b->shell.springs[SINGE_BLUE].grain); // no memory is taken where there is no direction
}

TEST(bad_mass_is_named) {
    const float exponents[] = {0, 0.3f, 0.5f, 1, 1.7f, 2};
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        SingeMaterialDef material = plain_material();
        material.ash_exponent = singe_param(exponents[e]);
        OwnBurningSheet *b = burning_sheet(3, 3, 0.01f, &material);
        heat_all(b, 600);
        b->state.heat.temperature[11] = NAN;
        assert_int_equal(step(b, NULL, 0.1f, 1, 1), SINGE_ERROR_DIVERGED);
        assert_int_equal(b->error.element, 11);
        assert_string_equal(b->error.stage, "burn");
    }
}

/// A hot stripe crosses a sheet of 8041 particles.
static BurningSheet *crossed_by_stripe(Pool *pool) {
    SingeMaterialDef material = plain_material();
    material.ash_exponent = singe_param(0.5f);
    material.mass_rate =
        singe_param_field(material.mass_rate.value, 2e-3f,
                          &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {.scale = 0.02f, .octaves = 3, .seed = 7}});

    BurningSheet *b = burning_sheet(80, 50, 0.001f, &material);
    for (int n = 0; n < 40; n++) {
        b->state.time = 0.1 * n;
        b->events.count = 0;
        for (uint32_t i = 0; i < b->shell.particle_count; i++) {
            float away = b->shell.rest_position[i][0] - 0.002f * (float)n;
            b->state.heat.temperature[i] = 300 + 900 * expf(-away * away * 1e4f);
        }
        assert_int_equal(step(b, pool, 0.1f, 1, 1.5f), SINGE_OK);
    }

    return b;
}

TEST(mass_ledger_closes) {
    OwnBurningSheet *b = crossed_by_stripe(NULL);
    double initial = 0;
    for (uint32_t i = 0; i < b->shell.particle_count; i++) initial += (double)b->shell.matter.mass[i];
    double error = fabs(initial - mass_left(b) - b->state.burn.mass_burnt) / initial;
    assert_true(b->state.burn.mass_burnt > 0.2 * initial);
    assert_true(error < 1e-12);
}

TEST(threads_change_nothing) {
    OwnBurningSheet *one = crossed_by_stripe(NULL);
    for (int threads = 1; threads <= 4; threads += threads) {
        Memory memory = memory_make((SingeAllocator){0});
        Pool *pool;
        assert_int_equal(pool_create(&memory, (SingeTasks){0}, threads, &pool), SINGE_OK);

        OwnBurningSheet *many = crossed_by_stripe(pool);
        assert_int_equal(many->state.arena_size, one->state.arena_size);
        assert_memory_equal(many->state.arena, one->state.arena, one->state.arena_size);
        assert_memory_equal(&many->state.burn.mass_burnt, &one->state.burn.mass_burnt, sizeof(double));
        assert_int_equal(many->events.count, one->events.count);
        for (size_t k = 0; k < one->events.count; k++)
            assert_int_equal(many->events.items[k].element, one->events.items[k].element);
        pool_destroy(&memory, pool);
    }
}

// The second reaction, char to ash, against its closed form; where it lives; its heat; the switch to the paper's eq 4.
#include "ablate/burning_sheet.h"
#include "burn/burn_job.h"

static const double YIELD = 0.35, MIN = 0.15, RATE = 0.5, AIR = 0.1;
static const double SLOWING = 4; // of char without fuel
static const float HOT = 1500;   // K: kinetics are no limit

static SingeResult step(BurningSheet *b, float h, float pace, float thickening) {
    double partial[64];
    float factors[4] = {thickening, thickening, thickening, thickening};
    assert_true(pool_blocks((int)b->shell.particle_count) <= 64);
    return sheet_burn(b, NULL, h, pace, factors, partial);
}

static SingeMaterialDef charring(void) {
    SingeMaterialDef material = plain_material();
    material.char_yield = singe_param((float)YIELD), material.mass_min = singe_param((float)MIN);
    material.char_rate = singe_param((float)RATE), material.char_air = singe_param((float)AIR);
    material.reference_grammage = 0;
    return material;
}

/// A sheet of char at one temperature.
static BurningSheet *leaf(uint32_t cells, const SingeMaterialDef *material, float temperature) {
    BurningSheet *b = burning_sheet(cells, cells, 0.01f, material);
    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        b->state.burn.fuel[i] = 0, b->state.burn.mass[i] = (float)YIELD;
        b->state.heat.temperature[i] = temperature;
    }
    return b;
}

static double left_of_char(const BurningSheet *b, uint32_t i) {
    return ((double)b->state.burn.mass[i] - MIN) / (YIELD - MIN);
}

static double kinetics(double temperature) { return 5.667e9 * exp(-160e3 / (8.314462618 * temperature)); }

/// At an edge z^(1/2) falls evenly, at half the rate of supply and kinetics in series; F, the slowing and pace scale
/// the time.
TEST(edges_glow_at_two_resistances_in_series) {
    const double temperatures[] = {700, 850, 1000, 1500};
    for (int t = 0; t < 4; t++) {
        SingeMaterialDef material = charring();
        OwnBurningSheet *b = leaf(1, &material, (float)temperatures[t]);
        double k = 1 / (1 / kinetics(temperatures[t]) + 1 / RATE);
        for (int n = 1; n <= 60; n++) {
            assert_int_equal(step(b, 0.05f, 2, 2.5f), SINGE_OK); // 0.04 s over F
            double root = fmax(1 - 0.5 * k * 0.04 * n / SLOWING, 0);
            assert_float_equal(left_of_char(b, 0), root * root, 2e-4);
        }
    }
}

/// Little air reaches the inside of a leaf until char has begun to go; fuel keeps air away; cold char does not glow.
TEST(leaves_glow_slower_than_edges) {
    SingeMaterialDef material = charring();
    OwnBurningSheet *b = leaf(6, &material, HOT);
    uint32_t inner = 3 * 7 + 3, fuelled = 2 * 7 + 3, cold = 3 * 7 + 4;
    b->state.burn.fuel[fuelled] = 0.5f, b->state.burn.mass[fuelled] = 0.5f + 0.5f * (float)YIELD;
    b->state.heat.temperature[fuelled] = b->state.heat.temperature[cold] = 400;
    assert_int_equal(step(b, 0.1f * (float)SLOWING, 1, 1), SINGE_OK);

    assert_float_equal(1 - sqrt(left_of_char(b, 0)), 0.5 * 0.1 * RATE, 2e-4);
    assert_float_equal(1 - sqrt(left_of_char(b, inner)), 0.5 * 0.1 * RATE * AIR, 2e-4);
    assert_float_equal(b->state.burn.mass[fuelled], 0.5f + 0.5f * (float)YIELD, 0);
    assert_float_equal(b->state.burn.mass[cold], YIELD, 1e-7);

    // ash beside it lets air through
    uint32_t centre = b->shell.vertex_count + 3 * 6 + 3;
    b->state.burn.mass[centre] = (float)(MIN + 0.5 * (YIELD - MIN));
    burn_follow(&b->shell.matter, &b->state.burn, centre, centre + 1);
    double root = sqrt(left_of_char(b, inner));
    assert_int_equal(step(b, 0.1f * (float)SLOWING, 1, 1), SINGE_OK);
    assert_float_equal(root - sqrt(left_of_char(b, inner)), 0.5 * 0.1 * RATE * 0.5, 1e-3);

    // fuel beside it, in the other layer, keeps the air away, and so does the flame
    b->state.burn.fuel[centre] = 0.5f, b->state.burn.mass[centre] += 0.5f - 0.5f * (float)MIN;
    burn_follow(&b->shell.matter, &b->state.burn, centre, centre + 1);
    double held = sqrt(left_of_char(b, inner));
    b->state.heat.temperature[centre] = 400;
    assert_int_equal(step(b, 0.1f * (float)SLOWING, 1, 1), SINGE_OK);
    assert_float_equal(sqrt(left_of_char(b, inner)), held, 2e-4);
    b->state.burn.fuel[centre] = 0, b->state.burn.mass[centre] = (float)MIN;
    burn_follow(&b->shell.matter, &b->state.burn, centre, centre + 1);

    // a hole beside it is an edge
    uint32_t before = inner;
    double was = sqrt(left_of_char(b, before));
    b->state.ablate.cell_flags[2 * 6 + 2] = 0;
    assert_int_equal(step(b, 0.1f * (float)SLOWING, 1, 1), SINGE_OK);
    assert_float_equal(was - sqrt(left_of_char(b, inner)), 0.5 * 0.1 * RATE, 1e-3);
}

/// Fuel leaves char, char leaves ash, no step passes either, and mass, gas and heat add up.
TEST(ledgers_close_from_fuel_to_ash) {
    const float steps[] = {0.02f, 1, 1e4f, 1e30f};
    for (int s = 0; s < 4; s++) {
        SingeMaterialDef material = charring();
        material.ash_exponent = singe_param(0.5f);
        material.char_heat = singe_param(28e6f), material.specific_heat = singe_param(1400);
        material.heat_of_combustion = singe_param(16e6f), material.heat_share = singe_param(0.25f);
        material.loss_mass_floor = singe_param(1); // heat over the initial mass

        OwnBurningSheet *b = burning_sheet(2, 2, 0.01f, &material);
        double warmed = 0, first = 0, last = 1;
        for (uint32_t i = 0; i < b->shell.particle_count; i++) {
            b->state.heat.temperature[i] = HOT;
            first += (double)b->shell.matter.mass[i];
        }

        for (int n = 0; n < 2000; n++) {
            assert_int_equal(step(b, steps[s], 1, 1), SINGE_OK);
            double mass = (double)b->state.burn.mass[0];
            assert_true(mass <= last && mass >= MIN - 1e-7);
            assert_true(b->state.burn.fuel[0] > 0 || mass <= YIELD + 1e-6);
            warmed += (double)b->state.burn.release[0] * (double)steps[s], last = mass;
        }

        assert_float_equal(last, MIN, 1e-6);
        assert_float_equal(b->state.burn.mass_burnt / first, 1 - MIN, 1e-6);
        double monoxide = 2500 * exp(-6240 / (double)HOT), heat = 0.28 + 0.72 / (1 + monoxide);
        double eta = 0.25 * 16e6 / 1400 * (1 - YIELD), glow = 28e6 / 1400 * heat * (YIELD - MIN);
        if (s < 2) assert_float_equal(warmed, eta + glow, 2e-3 * (eta + glow));
    }
}

/// A yield of m_min or less is the paper's one reaction, to the bit.
TEST(no_char_is_the_papers_eq_4) {
    BurningSheet *b[2];
    for (int k = 0; k < 2; k++) {
        SingeMaterialDef material = charring();
        material.char_yield = singe_param(k ? (float)MIN : 0), material.char_rate = singe_param(k ? 1e6f : 0);
        b[k] = burning_sheet(3, 3, 0.01f, &material);
        for (uint32_t i = 0; i < b[k]->shell.particle_count; i++) b[k]->state.heat.temperature[i] = 500 + 20 * (float)i;
        for (int n = 0; n < 50; n++) assert_int_equal(step(b[k], 0.1f, 1, 1), SINGE_OK);
    }

    assert_memory_equal(b[0]->state.arena, b[1]->state.arena, b[0]->state.arena_size);
    burning_sheet_free(b[0]), burning_sheet_free(b[1]);
}

/// Eq 5 with two densities: char, then ash.
TEST(char_and_ash_have_densities_of_their_own) {
    SingeMaterialDef material = charring();
    material.char_density = singe_param(0.45f), material.ash_density = singe_param(0.22f);
    material.shrink_back = singe_param(1), material.mass_rate = singe_param(1);
    OwnBurningSheet *b = burning_sheet(1, 1, 0.01f, &material);
    for (uint32_t i = 0; i < b->shell.particle_count; i++) b->state.heat.temperature[i] = 600;

    float *air = burning_sheet_vary(b, &b->shell.matter.char_rate);
    for (uint32_t i = 0; i < b->shell.particle_count; i++) air[i] = 0;
    assert_int_equal(step(b, 100, 1, 1), SINGE_OK);

    double ratio[2];
    for (int k = 0; k < 2; k++) {
        ratio[k] = (double)(b->state.burn.spring_length[SINGE_BLUE][0] / b->shell.springs[SINGE_BLUE].rest[0]);
        for (uint32_t i = 0; i < b->shell.particle_count; i++) b->state.heat.temperature[i] = HOT, air[i] = 1e3f;
        assert_int_equal(step(b, 100, 1, 1), SINGE_OK);
    }

    assert_float_equal(ratio[0], YIELD / 0.45, 1e-5);
    assert_float_equal(ratio[1], MIN / 0.22, 1e-5);
}

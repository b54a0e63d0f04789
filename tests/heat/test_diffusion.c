// The diffusion operators against solutions of the heat equation.
#include "rig.h"

static const double PI = 3.14159265358979;

// --- slab: T = 600 + 300 cos(pi x/L) decays as exp(-alpha (pi/L)^2 t), insulated at both ends -------------------

/// Amplitude of the mode in one layer: its projection, with areas as weights.
static double mode_amplitude(const Rig *r, double length, bool centres) {
    double sum = 0, norm = 0;
    for (uint32_t i = 0; i < r->shell.particle_count; i++) {
        if (shell_is_corner(&r->shell, i) == centres) continue;
        double c = cos(PI * (double)rig_position(r, i)[0] / length), area = (double)r->shell.matter.area[i];
        sum += area * c * ((double)r->state.heat.temperature[i] - 600);
        norm += area * c * c;
    }

    return sum / norm;
}

/// Runs n cells with dt proportional to dx^2 and returns the error of the amplitude at 4 s, relative to exact.
static double mode_error(int n, float aspect, bool centres, float exchange) {
    double length = 0.08, decay = 1e-4 * PI * PI / (length * length), seconds = 4;
    float dx = (float)length / (float)n;
    RigDef def = rig_default(n, 3, dx, dx * aspect);
    def.material.layer_exchange = singe_param(exchange);
    OwnRig rig = rig_open(&def);

    int steps = 2 * n * n;
    rig.h = (float)(seconds / steps);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        rig.state.heat.temperature[i] = (float)(600 + 300 * cos(PI * (double)rig_position(&rig, i)[0] / length));
    for (int step = 0; step < steps; step++) rig_step(&rig);
    double amplitude = mode_amplitude(&rig, length, centres);

    // the scheme's own decay is known too: (1 - y)/(1 + y), y = dt lambda/2, with the part X dx^2/16 of alpha that goes by way of the
    // other layer, half a cell aside: lambda = (2 alpha/dx^2 - X/8)(1 - cos k dx) + (X/2)(1 - cos(k dx/2))
    double k = PI / length, d = (double)dx, x = (double)exchange;
    double lambda = (2e-4 / (d * d) - x / 8) * (1 - cos(k * d)) + x / 2 * (1 - cos(k * d / 2));
    const double half = (double)rig.h * lambda / 2;
    CHECK_NEAR(amplitude, 300 * pow((1 - half) / (1 + half), steps), 2e-3);
    return fabs(amplitude / (300 * exp(-decay * seconds)) - 1);
}

TEST(slab_mode_decays_with_second_order) {
    for (int centres = 0; centres < 2; centres++)
        for (int k = 0; k < 2; k++) {
            float aspect = k ? 0.5f : 1, exchange = k ? 2 : 0;
            double coarse = mode_error(12, aspect, centres, exchange),
                   middle = mode_error(24, aspect, centres, exchange);
            double fine = mode_error(48, aspect, centres, exchange);
            if (log2(coarse / middle) < 1.9 || log2(middle / fine) < 1.9)
                fail_msg("orders %.3f, %.3f", log2(coarse / middle), log2(middle / fine));
            assert_true(fine < 2e-3);
        }
}

// --- Gaussian: variances grow by 2 alpha t ------------------------------------------------------------------

typedef struct Moments {
    double x, y, xy, sum;
} Moments;

/// Second moments of T - 300 in a layer (0 corners, 1 centres, 2 both), or with the umbrella's capacity as weight (3).
static Moments moments(const Rig *r, int layer) {
    Moments m = {0};
    double mx = 0, my = 0, *weight = test_calloc(r->shell.particle_count, sizeof *weight);
    for (uint32_t i = 0; i < r->shell.particle_count; i++) weight[i] = layer == 3 ? 0 : (double)r->shell.matter.area[i];
    for (int c = 0; c < SINGE_COLOUR_COUNT && layer == 3; c++)
        for (uint32_t k = 0; k < r->shell.springs[c].count; k++)
            for (int end = 0; end < 2; end++)
                weight[r->shell.springs[c].ends[k][end]] += (double)r->shell.springs[c].rest[k] / 2;

    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < r->shell.particle_count; i++) {
            if (layer < 2 && shell_is_corner(&r->shell, i) == (layer == 1)) continue;
            double w = weight[i] * ((double)r->state.heat.temperature[i] - 300);
            double x = (double)rig_position(r, i)[0], y = (double)rig_position(r, i)[1];
            if (pass == 0) m.sum += w, mx += w * x, my += w * y;
            else
                m.x += w * (x - mx / m.sum) * (x - mx / m.sum), m.y += w * (y - my / m.sum) * (y - my / m.sum),
                    m.xy += w * (x - mx / m.sum) * (y - my / m.sum);
        }

    test_free(weight);
    m.x /= m.sum, m.y /= m.sum, m.xy /= m.sum;
    return m;
}

/// Growth of the variances over 2 t, that is the diffusivity in each direction.
static Moments gaussian(const RigDef *def, int layer, double deviation) {
    OwnRig rig = rig_open(def);
    double x = (double)rig_position(&rig, rig_vertex(&rig, def->nx / 2, def->ny / 2))[0];
    double y = (double)rig_position(&rig, rig_vertex(&rig, def->nx / 2, def->ny / 2))[1];
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
        double a = ((double)rig_position(&rig, i)[0] - x) / deviation,
               b = ((double)rig_position(&rig, i)[1] - y) / deviation;
        rig.state.heat.temperature[i] = (float)(300 + 800 * exp(-(a * a + b * b) / 2));
    }

    for (uint32_t i = 0; i < rig.shell.particle_count && def->size > 0; i++)
        for (int k = 0; k < 3; k++) rig.state.dynamics.position[i][k] = def->size * rig_position(&rig, i)[k];

    Moments before = moments(&rig, layer);
    rig.h = 0.004f;
    for (int k = 0; k < 100; k++) rig_step(&rig);

    Moments after = moments(&rig, layer);
    double twice = 2 * 100 * (double)rig.h;
    return (Moments){(after.x - before.x) / twice, (after.y - before.y) / twice, (after.xy - before.xy) / twice,
                     after.sum / before.sum};
}

TEST(gaussian_spreads_at_the_right_rate) {
    for (int layer = 0; layer < 3; layer++) {
        RigDef def = rig_default(60, 60, 0.002f, 0.002f);
        Moments m = gaussian(&def, layer, 0.008);
        CHECK_NEAR(m.x, 1e-4, 3e-7);
        CHECK_NEAR(m.y, 1e-4, 3e-7);
        CHECK_NEAR(m.xy, 0, 1e-7);
    }
}

TEST(surface_is_isotropic_on_long_cells) {
    for (int layer = 0; layer < 2; layer++) {
        RigDef def = rig_default(36, 72, 0.004f, 0.002f);
        Moments m = gaussian(&def, layer, 0.008);
        CHECK_NEAR(m.x, 1e-4, 3e-7);
        CHECK_NEAR(m.y, 1e-4, 3e-7);
    }
}

static void shear(float position[3], int column, int row) {
    (void)column, (void)row;
    position[0] += 0.5f * position[1];
}

TEST(heat_spreads_evenly_on_skewed_cells) {
    RigDef def = rig_default(70, 60, 0.002f, 0.002f);
    def.shape = shear;
    def.material.layer_exchange = singe_param(0);

    // corners: cotangents are exact
    Moments m = gaussian(&def, 0, 0.008);
    CHECK_NEAR(m.x, 1e-4, 3e-7);
    CHECK_NEAR(m.y, 1e-4, 3e-7);
    CHECK_NEAR(m.xy, 0, 3e-7);

    // centres: two-point fluxes are right in the mean of both directions only
    m = gaussian(&def, 1, 0.008);
    CHECK_NEAR((m.x + m.y) / 2, 1e-4, 3e-7);
    assert_true(fabs(m.xy) > 1e-5);
}

/// The umbrella's diffusivity along x over alpha, as operator.c derives it.
static double umbrella_factor(double dx, double dy, double t) {
    double q = hypot(dx, dy), r = sqrt(q * q / 4 + t * t);
    return (2 * dx + 2 * dx * dx / q + dx * dx / r) / (2 * dx + 2 * dy + 2 * q + 4 * r);
}

TEST(umbrella_has_its_derived_diffusivity) {
    CHECK_NEAR(umbrella_factor(1, 1, 0), 0.5, 1e-12);
    const struct {
        float dx, dy, t;
    } cases[] = {{0.002f, 0.002f, 1e-4f}, {0.002f, 0.002f, 0.002f}, {0.004f, 0.002f, 1e-3f}};

    for (int k = 0; k < 3; k++) {
        RigDef def = rig_default((int)(0.16f / cases[k].dx), (int)(0.16f / cases[k].dy), cases[k].dx, cases[k].dy);
        def.material.heat_operator = SINGE_HEAT_UMBRELLA;
        def.material.thickness = singe_param(cases[k].t);
        Moments m = gaussian(&def, 3, 0.012);
        CHECK_NEAR(m.sum, 1, 1e-6); // sum D T is kept
        CHECK_NEAR(m.x, 1e-4 * umbrella_factor((double)cases[k].dx, (double)cases[k].dy, (double)cases[k].t), 1e-6);
        CHECK_NEAR(m.y, 1e-4 * umbrella_factor((double)cases[k].dy, (double)cases[k].dx, (double)cases[k].t), 1e-6);
        if (k == 2) assert_true(m.x / m.y > 2); // the known bias towards the long sides
    }
}

/// A warm spot on a crumpled sheet spreads for 20 steps; the sheet's corner is burnt away in the middle of them.
static Rig spread(SingeHeatOperator operator, float size, bool burns) {
    RigDef def = rig_default(12, 12, 0.002f, 0.002f);
    def.material.heat_operator = operator;
    Rig r = rig_open(&def);

    for (uint32_t i = 0; i < r.shell.particle_count; i++) {
        for (int k = 0; k < 3; k++) r.state.dynamics.position[i][k] = size * rig_position(&r, i)[k];
        r.state.heat.temperature[i] = i % 7 == 0 ? 900.0f : 300.0f;
    }

    for (int k = 0; k < 20; k++) {
        if (burns && k == 10) rig_remove(&r, rig_vertex(&r, 5, 5)), rig_remove(&r, rig_vertex(&r, 6, 5));
        rig_step(&r);
    }
    return r;
}

TEST(umbrella_as_printed_is_the_umbrella_on_a_sheet_at_rest) {
    OwnRig initial = spread(SINGE_HEAT_UMBRELLA, 1, false), printed = spread(SINGE_HEAT_UMBRELLA_LIVE, 1, false);
    for (uint32_t i = 0; i < initial.shell.particle_count; i++)
        CHECK_NEAR(printed.state.heat.temperature[i], initial.state.heat.temperature[i], 0.01);
}

TEST(the_printed_umbrella_uses_current_lengths) {
    // at half its size heat spreads four times as well; as well as with four times the diffusivity
    RigDef def = rig_default(80, 80, 0.002f, 0.002f);
    for (int k = 0; k < 2; k++) {
        const float size = k ? 0.5f : 1;
        def.material.heat_operator = SINGE_HEAT_UMBRELLA_LIVE;
        def.material.thickness = singe_param(1e-4f);
        def.size = size;
        Moments m = gaussian(&def, 3, 0.012);
        CHECK_NEAR(m.x * (double)(size * size), 1e-4 * umbrella_factor(0.002, 0.002, 1e-4), 1e-6);
    }
}

TEST(umbrella_as_printed_leaves_out_burnt_springs) {
    // E_i is that of the springs that are left: next to a hole a particle's heat moves on faster than with all of them
    OwnRig initial = spread(SINGE_HEAT_UMBRELLA, 1, true), printed = spread(SINGE_HEAT_UMBRELLA_LIVE, 1, true);

    double near = 0, far = 0;
    for (uint32_t i = 0; i < initial.shell.vertex_count; i++) {
        if (!(initial.state.ablate.particle_flags[i] & SINGE_ALIVE)) continue;
        const float *x = rig_position(&initial, i);
        const double off = fabs((double)(printed.state.heat.temperature[i] - initial.state.heat.temperature[i]));
        const bool edge = fabsf(x[0] - 0.011f) < 0.0035f && fabsf(x[1] - 0.010f) < 0.0025f;
        if (edge) near = fmax(near, off);
        if (x[0] < 0.003f && x[1] > 0.020f) far = fmax(far, off);
    }

    print_message("a hole: differs by %.2f K at its edge, by %.4f K far off\n", near, far);
    assert_true(near > 1 && far < 0.1 * near);
}

TEST(umbrella_slab_mode_decays) {
    // thin strip, many cells: the boundary corners' wrong capacity matters less and less; first order remains
    double length = 0.08, error[3];
    for (int k = 0; k < 3; k++) {
        int n = 16 << k;
        float s = (float)length / (float)n;
        RigDef def = rig_default(n, n, s, s);
        def.material.heat_operator = SINGE_HEAT_UMBRELLA;
        def.material.thickness = singe_param(s / 2);
        OwnRig rig = rig_open(&def);
        rig.h = 0.01f;
        for (uint32_t i = 0; i < rig.shell.particle_count; i++)
            rig.state.heat.temperature[i] = (float)(600 + 300 * cos(PI * (double)rig_position(&rig, i)[0] / length));
        for (int step = 0; step < 300; step++) rig_step(&rig);

        double lambda = 1e-4 * umbrella_factor(1, 1, 0.5) * PI * PI / (length * length);
        error[k] = fabs(mode_amplitude(&rig, length, false) / (300 * pow(1 + lambda * (double)rig.h, -300)) - 1);
    }

    double order[2] = {log2(error[0] / error[1]), log2(error[1] / error[2])};
    print_message("umbrella: errors %.2g %.2g %.2g, orders %.2f %.2f\n", error[0], error[1], error[2], order[0],
                  order[1]);
    assert_true(error[1] < 0.02 && error[2] < 0.6 * error[1]);
    for (int k = 0; k < 2; k++) assert_true(order[k] > 0.75 && order[k] < 1.5);
}

// --- properties ------------------------------------------------------------------------------------------------

static void jitter(float position[3], int column, int row) {
    for (int k = 0; k < 2; k++) position[k] += 0.0012f * (rig_random((uint32_t)column, (uint32_t)(2 * row + k)) - 0.5f);
}

TEST(insulated_sheet_keeps_its_heat) {
    RigDef def = rig_default(20, 20, 0.002f, 0.002f);
    def.shape = jitter;
    def.settings.tolerance = 1e-2f; // conserved however badly it is solved
    OwnRig rig = rig_open(&def);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        rig.state.heat.temperature[i] = 300 + 900 * rig_random(i, 5);
    for (uint32_t i = 0; i < 30; i++) rig_remove(&rig, 200 + i);

    double before = rig_content(&rig, 0), spread = 0;
    for (int k = 0; k < 400; k++) rig_step(&rig);
    CHECK_NEAR(rig_content(&rig, 0) / before, 1, 1e-6);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        if (rig.state.ablate.particle_flags[i])
            spread = fmax(spread, fabs((double)rig.state.heat.temperature[i] - 750));
    assert_true(spread < 200); // it did diffuse
}

TEST(uniform_temperature_stays_to_the_bit) {
    for (int k = 0; k < 2; k++) {
        RigDef def = rig_default(9, 7, 0.002f, 0.002f);
        def.shape = jitter;
        def.material.heat_operator = k ? SINGE_HEAT_UMBRELLA : SINGE_HEAT_SURFACE;
        OwnRig rig = rig_open(&def);
        for (uint32_t i = 0; i < rig.shell.particle_count; i++) rig.state.heat.temperature[i] = 517.3f;
        for (int step = 0; step < 20; step++) rig_step(&rig);
        for (uint32_t i = 0; i < rig.shell.particle_count; i++) assert_true(rig.state.heat.temperature[i] == 517.3f);
    }
}

TEST(linear_temperature_is_steady_on_skewed_quads) {
    RigDef def = rig_default(16, 16, 0.002f, 0.002f);
    def.shape = jitter;
    def.material.layer_exchange = singe_param(0);
    OwnRig rig = rig_open(&def);
    rig.h = 2e-4f; // alpha dt/s^2 = 0.005: the border is not felt four cells away
    for (uint32_t i = 0; i < rig.shell.vertex_count; i++)
        rig.state.heat.temperature[i] = 400 + 9000 * rig_position(&rig, i)[0] - 4000 * rig_position(&rig, i)[1];
    rig_step(&rig);

    double border = 0;
    for (int row = 0; row <= 16; row++)
        for (int column = 0; column <= 16; column++) {
            const float *x = rig_position(&rig, rig_vertex(&rig, column, row));
            double T = (double)rig.state.heat.temperature[rig_vertex(&rig, column, row)];
            double change = fabs(T - (double)(400 + 9000 * x[0] - 4000 * x[1]));
            if (column >= 4 && column <= 12 && row >= 4 && row <= 12) CHECK_NEAR(change, 0, 2e-4);
            border = fmax(border, change);
        }

    assert_true(border > 0.05); // where insulation bends it
}

/// A long strip and a step of 20 s: the solver stops at its cap, says so, and loses no heat.
TEST(iterations_have_an_end) {
    RigDef def = rig_default(600, 1, 0.002f, 0.002f);
    def.settings.tolerance = 1e-6f;
    OwnRig rig = rig_open(&def);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        rig.state.heat.temperature[i] = rig_position(&rig, i)[0] < 0.3f ? 900 : 400;

    double before = rig_content(&rig, 0);
    rig_step(&rig);
    assert_int_equal(rig.counters.unconverged, 0);
    assert_true(rig.counters.iterations > 0 && rig.counters.iterations < 200);

    rig.counters = (HeatCounters){0};
    rig.h = 20;
    rig_step(&rig);
    assert_int_equal(rig.counters.unconverged, 1);
    assert_int_equal(rig.counters.iterations, 200);
    CHECK_NEAR(rig_content(&rig, 0) / before, 1, 1e-6);
}

TEST(layers_even_out_at_their_rate) {
    RigDef def = rig_default(8, 6, 0.002f, 0.003f);
    def.shape = jitter;
    def.material.thickening = 2;
    OwnRig rig = rig_open(&def);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        rig.state.heat.temperature[i] = shell_is_corner(&rig.shell, i) ? 900 : 300;
    for (int k = 0; k < 50; k++) rig_step(&rig);

    const double half = 36.0 / 2 * (double)rig.h / 2;
    double difference = 600 * pow((1 - half) / (1 + half), 50);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
        double sign = shell_is_corner(&rig.shell, i) ? 0.5 : -0.5;
        CHECK_NEAR(rig.state.heat.temperature[i], 600 + sign * difference, 5e-3);
    }
}

TEST(removed_particles_conduct_nothing) {
    RigDef def = rig_default(8, 2, 0.002f, 0.002f);
    def.shape = shear;
    OwnRig rig = rig_open(&def);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        rig.state.heat.temperature[i] = rig_position(&rig, i)[0] < 0.008f ? 900 : 300;
    rig_step(&rig);

    // a cut across the sheet: a column of vertices and one of centres beside it
    for (int row = 0; row < 3; row++) rig_remove(&rig, rig_vertex(&rig, 4, row));
    for (int row = 0; row < 2; row++)
        for (int column = 3; column < 5; column++) rig_remove(&rig, rig_centre(&rig, column, row));

    float *T = rig.state.heat.temperature, kept = T[rig_vertex(&rig, 4, 1)];
    double left = 0, right = 0, area = 0;

    for (int k = 0; k < 3000; k++) rig_step(&rig);
    assert_true(T[rig_vertex(&rig, 4, 1)] == kept);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 9; column++) {
            if (column == 4) continue;
            double *side = column < 4 ? &left : &right,
                   a = (double)rig.shell.matter.area[rig_vertex(&rig, column, row)];
            *side += a * (double)T[rig_vertex(&rig, column, row)];
            area += a / 2;
        }

    // each side has come to rest on a value of its own
    CHECK_NEAR(T[rig_vertex(&rig, 0, 0)], T[rig_vertex(&rig, 3, 2)], 0.5);
    CHECK_NEAR(T[rig_vertex(&rig, 5, 0)], T[rig_vertex(&rig, 8, 2)], 0.5);
    assert_true((left - right) / area > 300);
}

/// Conduction moves heat, not temperature: where the sheet is heavier or of more specific heat, as much heat warms it
/// less. The total is kept on the way, and the end is the mean by capacity.
TEST(heat_is_kept_where_capacity_varies) {
    static const float halves[] = {0, 1};
    RigDef def = rig_default(12, 3, 0.002f, 0.003f);
    def.material.grammage =
        singe_param_field(0.04f, 0.4f, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, halves}});
    def.material.specific_heat =
        singe_param_field(900, 1800, &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {0.01f, 2, 5}});
    def.material.reference_grammage = 0;
    OwnRig rig = rig_open(&def);

    double sum = 0, capacity = 0;
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
        rig.state.heat.temperature[i] = rig_position(&rig, i)[0] < 0.012f ? 900 : 300;
        sum += (double)rig.shell.matter.capacity[i] * (double)rig.state.heat.temperature[i];
        capacity += (double)rig.shell.matter.capacity[i];
    }

    double before = rig_content(&rig, 1);
    for (int k = 0; k < 6000; k++) {
        rig_step(&rig);
        if (k % 100 == 0) CHECK_NEAR(rig_content(&rig, 1), before, 1e-5 * before);
    }

    assert_true(sum / capacity < 450); // the light half's heat goes into the heavy one
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        CHECK_NEAR(rig.state.heat.temperature[i], sum / capacity, 0.05);
}

/// Where the exchange varies, the layers even out at the local rate, and no heat is lost.
TEST(layers_even_out_at_their_own_rates) {
    static const float halves[] = {0, 1};
    RigDef def = rig_default(40, 2, 0.002f, 0.002f);
    def.material.diffusivity = singe_param(0);
    def.material.layer_exchange =
        singe_param_field(10, 40, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, halves}});
    OwnRig rig = rig_open(&def);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++)
        rig.state.heat.temperature[i] = i < rig.shell.vertex_count ? 500 : 300;

    double before = rig_content(&rig, 1);
    for (int k = 0; k < 25; k++) rig_step(&rig); // 0.05 s

    const float *T = rig.state.heat.temperature;
    double left = (double)(T[rig_vertex(&rig, 0, 1)] - T[rig_centre(&rig, 0, 0)]);
    double right = (double)(T[rig_vertex(&rig, 40, 1)] - T[rig_centre(&rig, 39, 0)]);

    CHECK_NEAR(left / 200, exp(-10 * 0.05), 1e-3);
    CHECK_NEAR(right / 200, exp(-40 * 0.05), 1e-3);
    CHECK_NEAR(rig_content(&rig, 1), before, 1e-6 * before);
}

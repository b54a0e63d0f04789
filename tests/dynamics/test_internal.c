// Internal friction, the order of the layers, and the weights of springs.
#include "sample_sheets.h"

#include "dynamics/dynamics_plan.h"

static const float pi = 3.14159265f;

static void momentum(const Bench *b, double p[3]) {
    p[0] = p[1] = p[2] = 0;
    for (uint32_t i = 0; i < b->shell.particle_count; i++)
        for (int k = 0; k < 3; k++) p[k] += (double)b->state.dynamics.velocity[i][k] / (double)b->plan->inverse_mass[i];
}

/// Share of a standing wave across the sheet that is left after `steps` of friction, measured off the margins.
static double wave_left(float cell, float wavelength, int steps) {
    uint32_t n = (uint32_t)lroundf(0.4f / cell);

    OwnBench bench = bench_open_plain(quads_grid(n, 4, cell, cell, false));
    bench_prepare(&bench);
    float(*v)[4] = bench.state.dynamics.velocity;
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        v[i][2] = sinf(2 * pi * bench.shell.rest_position[i][0] / wavelength);
    for (int s = 0; s < steps; s++)
        dynamics_smooth(bench.plan, &bench.shell, &bench.state.ablate, bench.pool, 1.0f / 480, &bench.state.dynamics);
    double dot = 0, square = 0;
    for (uint32_t i = 0; i < bench.shell.vertex_count; i++) {
        float x = bench.shell.rest_position[i][0];
        if (x < 0.1f || x > 0.3f) continue;
        double wave = sin(2 * 3.14159265 * (double)x / (double)wavelength);
        dot += wave * (double)v[i][2], square += wave * wave;
    }

    return dot / square;
}

/// Friction damps a wave by its length in metres; the mesh hardly matters.
TEST(waves_decay_by_their_length) {
    double fine = wave_left(0.0025f, 0.1f, 5), coarse = wave_left(0.005f, 0.1f, 5);
    assert_true(fine > 0.2 && fine < 0.9);
    assert_true(fabs(fine - coarse) < 0.05);
    assert_true(wave_left(0.0025f, 0.4f, 5) > 0.99);  // long waves go on
    assert_true(wave_left(0.0025f, 0.02f, 20) < 0.8); // nodes 2 cm apart do not see this one, neighbours do
    assert_true(fabs(wave_left(0.0025f, 0.005f, 20)) < 0.1);
}

TEST(friction_keeps_momentum) {
    OwnBench bench = bench_open_plain(quads_grid(20, 16, 0.004f, 0.004f, false));
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        bench.state.burn.mass[i] = 0.3f + 0.7f * (float)(i % 7) / 6;
    bench_prepare(&bench);
    float(*v)[4] = bench.state.dynamics.velocity;
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        for (int k = 0; k < 3; k++) v[i][k] = 0.1f * (float)k + sinf((float)(i * (uint32_t)(k + 1)));
    double before[3], after[3];
    momentum(&bench, before);
    for (int s = 0; s < 50; s++)
        dynamics_smooth(bench.plan, &bench.shell, &bench.state.ablate, bench.pool, 1.0f / 480, &bench.state.dynamics);
    momentum(&bench, after);
    for (int k = 0; k < 3; k++) assert_true(fabs(after[k] - before[k]) < 1e-5 * fabs(before[2]));

    // a body that moves as one is not held back
    for (uint32_t i = 0; i < bench.shell.particle_count; i++) v[i][0] = 1, v[i][1] = -2, v[i][2] = 3;
    dynamics_smooth(bench.plan, &bench.shell, &bench.state.ablate, bench.pool, 1.0f / 480, &bench.state.dynamics);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        assert_true(v[i][0] == 1 && v[i][1] == -2 && v[i][2] == 3);
}

/// Friction does not act across a spring that is gone.
TEST(friction_stops_at_cuts) {
    OwnBench bench = bench_open_plain(quads_grid(20, 1, 0.01f, 0.01f, false));
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < bench.shell.springs[c].count; k++) {
            const uint32_t *ends = bench.shell.springs[c].ends[k];
            float a = bench.shell.rest_position[ends[0]][0], b = bench.shell.rest_position[ends[1]][0];
            if ((a < 0.1001f) != (b < 0.1001f)) bench.state.ablate.spring_flags[c][k] = 0;
        }
    bench_prepare(&bench);
    float(*v)[4] = bench.state.dynamics.velocity;
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        v[i][2] = bench.shell.rest_position[i][0] < 0.1001f ? 0 : 1;
    for (int s = 0; s < 20; s++)
        dynamics_smooth(bench.plan, &bench.shell, &bench.state.ablate, bench.pool, 1.0f / 480, &bench.state.dynamics);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        assert_true(v[i][2] == (bench.shell.rest_position[i][0] < 0.1001f ? 0 : 1));
}

TEST(inverted_cells_are_mended) {
    OwnBench bench = bench_open_plain(quads_grid(8, 8, 0.005f, 0.005f, false));
    double thickness = (double)field_at(bench.shell.matter.thickness, shell_centre(&bench.shell, 0));
    for (uint32_t c = 0; c < bench.shell.cell_count; c += 9) // the diagonal: centres pushed through their corners
        bench.state.dynamics.position[shell_centre(&bench.shell, c)][2] -= (float)(1.5 * thickness);
    bench_prepare(&bench);
    double before = 0, after = 0;
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        before += (double)bench.state.dynamics.position[i][2] / (double)bench.plan->inverse_mass[i];
    assert_true(bench_height(&bench, 9) < 0);
    for (int pass = 0; pass < 60; pass++)
        height_project(bench.plan, &bench.shell, &bench.state.ablate, bench.pool, &bench.state.dynamics);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        after += (double)bench.state.dynamics.position[i][2] / (double)bench.plan->inverse_mass[i];
    for (uint32_t c = 0; c < bench.shell.cell_count; c++)
        assert_true(bench_height(&bench, c) > 0.99 * (double)bench.settings.solver.height_min * thickness);
    assert_true(fabs(after - before) < 1e-6 * thickness); // a sheet of 3.2 g: the centre of mass stays
}

/// The most that a side of any cell is longer than its target, times it.
static double longest_side(const Bench *b) {
    const Shell *shell = &b->shell;
    double max = 0;
    for (uint32_t c = 0; c < shell->cell_count; c++)
        for (int i = 0; i < 4; i++) {
            const float(*x)[4] = (const float(*)[4])b->state.dynamics.position;
            Float3 side = float3_sub(float3_load(x[shell->cells[c][(i + 1) & 3]]), float3_load(x[shell->cells[c][i]]));
            uint32_t spring = shell->cell_springs[c].blue[i];
            max = fmax(max, (double)(float3_length(side) / b->state.burn.spring_length[SINGE_BLUE][spring]));
        }
    return max;
}

/// A vertex that was pulled away by three cells returns to a quarter more than a side and flies off no further;
/// momentum is conserved.
TEST(sides_have_a_max) {
    OwnBench bench = bench_open_plain(quads_grid(12, 12, 0.01f, 0.01f, false));
    bench_prepare(&bench);
    float(*x)[4] = bench.state.dynamics.position, (*v)[4] = bench.state.dynamics.velocity;
    const uint32_t at = 6 * 13 + 6;
    x[at][2] += 0.03f, v[at][2] = 5, x[0][0] -= 0.02f;
    double before[3], after[3];
    momentum(&bench, before);
    dynamics_limit(bench.plan, &bench.shell, STATE_INPUT(&bench.state), bench.pool, &bench.state.dynamics);
    momentum(&bench, after);
    for (int k = 0; k < 3; k++) assert_true(fabs(after[k] - before[k]) < 1e-5 * fabs(before[2]));
    assert_true(longest_side(&bench) < 1.3);
    assert_true(v[at][2] < 4);
    for (bench.state.step = 1; bench.state.step < 5; bench.state.step++) { // in every step
        x[at][2] += 0.03f;
        dynamics_limit(bench.plan, &bench.shell, STATE_INPUT(&bench.state), bench.pool, &bench.state.dynamics);
        assert_true(longest_side(&bench) < 1.3);
    }

    assert_false(
        dynamics_limit(bench.plan, &bench.shell, STATE_INPUT(&bench.state), bench.pool, &bench.state.dynamics));
}

/// Sides that have burnt, may stretch or are held at both ends have no maximum length, nor has a sheet held too far
/// apart.
TEST(some_sides_have_no_max) {
    for (int kind = 0; kind < 5; kind++) {
        SingeMaterialDef material = bench_plain_material();
        if (kind == 1) material.compliance[SINGE_BLUE].value = 1e-3f;
        OwnBench bench = bench_open(quads_grid(3, 1, 0.01f, 0.01f, false), &material, 1);
        bench_prepare(&bench);
        float(*x)[4] = bench.state.dynamics.position;
        const float far = x[7][0] + 0.02f;
        x[3][0] += 0.02f, x[7][0] += 0.02f; // the end of the strip
        const CellSprings *springs = &bench.shell.cell_springs[2];
        for (uint32_t k = 0; kind == 0 && k < 4; k++) bench.state.ablate.spring_flags[SINGE_BLUE][springs->blue[k]] = 0;
        for (uint32_t k = 0; kind == 0 && k < 2; k++)
            bench.state.ablate.spring_flags[SINGE_YELLOW][springs->yellow[k]] = 0;
        for (uint32_t v = 0; kind == 2 && v < bench.shell.vertex_count; v++) x[v][3] = 0;
        bench.plan->attachments.spread[0].tight = kind == 3;
        bool found =
            dynamics_limit(bench.plan, &bench.shell, STATE_INPUT(&bench.state), bench.pool, &bench.state.dynamics);
        assert_true(found == (kind == 4)); // burnt, soft, held or tightly attached sides have none
        assert_true(kind == 4 ? x[7][0] < far - 1e-3f : x[7][0] == far);
    }
}

/// Eq 19 by hand: the mean of the ends' weights, softened by how far they are burnt; none where a spring is gone.
TEST(weights_follow_eq_19) {
    SingeMaterialDef material = bench_plain_material();
    material.weight[SINGE_BLUE].value = 0.8f, material.char_weight.value = 0.4f, material.mass_min.value = 0.2f;
    OwnBench bench = bench_open(quads_grid(3, 3, 0.005f, 0.005f, false), &material, 1);
    const SpringSet *blue = &bench.shell.springs[SINGE_BLUE];
    bench.state.burn.mass[blue->ends[0][0]] = 0.2f; // ash
    bench.state.burn.mass[blue->ends[0][1]] = 0.6f; // half burnt
    bench.state.ablate.spring_flags[SINGE_BLUE][1] = 0;
    bench_prepare(&bench);
    assert_true(fabsf(bench_weight(&bench, SINGE_BLUE, 0) - 0.8f * (1 - 0.6f * 0.75f)) < 1e-6f);
    assert_true(bench_weight(&bench, SINGE_BLUE, 1) == 0);
    assert_true(fabsf(bench_weight(&bench, SINGE_BLUE, blue->count - 1) - 0.8f) < 1e-6f);
}

/// A ribbon of compliant springs hangs as long whatever the number of substeps.
TEST(compliance_does_not_depend_on_substeps) {
    double stretch[2];
    for (int run = 0; run < 2; run++) {
        SingeMaterialDef material = bench_plain_material();
        material.damping = singe_param(6);
        for (int c = 0; c < SINGE_COLOUR_COUNT; c++) material.compliance[c] = singe_param(5);
        OwnBench bench = bench_open(quads_grid(1, 10, 0.01f, 0.01f, false), &material, 1);
        bench.plan->settings.solver.substeps = run ? 12 : 3;
        bench.plan->settings.solver.height_min = 0;
        for (int c = 0; c < SINGE_COLOUR_COUNT; c++) bench.plan->settings.solver.regularisation[c] = 1e-6f;
        bench.plan->settings.gravity[1] = -9.81f, bench.plan->settings.gravity[2] = 0;
        for (uint32_t i = 0; i < bench.shell.vertex_count; i++)
            if (bench.shell.rest_position[i][1] > 0.0999f) bench.state.dynamics.pinned[i] = 1;
        for (int s = 0; s < 960; s++) bench_step(&bench, 1.0f / 480);
        double low = 1;
        for (uint32_t i = 0; i < bench.shell.vertex_count; i++)
            low = fmin(low, (double)bench.state.dynamics.position[i][1]);
        stretch[run] = -low;
    }

    assert_true(stretch[0] > 1e-4 && fabs(stretch[0] / stretch[1] - 1) < 0.02);
}

/// Two masses on a spring between two corners swing with omega^2 = (w_a + w_b)/c, and keep their energy: eq 13 gives
/// back all that the projection takes.
TEST(compliant_springs_swing_with_their_period_and_energy) {
    SingeMaterialDef material = bench_plain_material();
    const double compliance = 20, h = 1.0 / 40000;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) material.compliance[c] = singe_param(c == SINGE_BLUE ? 20 : 1e6f);
    OwnBench bench = bench_open(quads_grid(1, 1, 0.01f, 0.01f, false), &material, 1);
    SingeSolverDef *solver = &bench.plan->settings.solver;
    solver->substeps = 1, solver->smoothing = solver->height_min = 0;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) solver->regularisation[c] = 1e-6f;
    bench.plan->settings.gravity[2] = 0;

    // thrown apart along x
    double before = 0, fastest = 0, crossing[3] = {0};
    int crossings = 0, step = 0;
    for (uint32_t i = 0; i < bench.shell.vertex_count; i++)
        bench.state.dynamics.velocity[i][0] = bench.shell.rest_position[i][0] > 0.005f ? 0.05f : -0.05f;
    for (; step < 4000 && crossings < 3; step++) {
        bench_step(&bench, (float)h);
        const float(*x)[4] = (const float(*)[4])bench.state.dynamics.position;
        const double now = (double)x[1][0] - (double)x[0][0] - 0.01;
        const double speed =
            fabs((double)bench.state.dynamics.velocity[1][0] - (double)bench.state.dynamics.velocity[0][0]) / 2;
        if (crossings == 2) fastest = fmax(fastest, speed);
        if (step > 0 && before * now <= 0 && now != before) crossing[crossings++] = step - now / (now - before);
        before = now;
    }

    assert_int_equal(crossings, 3);
    const double period = h * (crossing[2] - crossing[0]);
    const double expected = 2 * 3.14159265358979 / sqrt(2 * (double)bench.plan->inverse_mass[0] / compliance);
    print_message("period %.3f ms, by the formula %.3f ms; speed %.5f m/s of 0.05\n", 1e3 * period, 1e3 * expected,
                  fastest);
    assert_true(fabs(period / expected - 1) < 0.02);
    assert_true(fastest > 0.9 * 0.05 && fastest < 1.01 * 0.05);
}

/// Springs burnt to ash keep a share of their weight that varies: here from 0.2 at the left to 0.8 at the right.
TEST(char_weight_follows_an_attribute) {
    SingeMaterialDef material = bench_plain_material();
    material.char_weight =
        singe_param_field(0.2f, 0.8f, &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "along"});
    OwnBench bench = bench_open(quads_grid(10, 2, 0.01f, 0.01f, false), &material, 1);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        bench.state.burn.mass[i] = field_at(bench.shell.matter.mass_min, i);
    bench_prepare(&bench);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t k = 0; k < bench.shell.springs[colour].count; k++) {
            const uint32_t *ends = bench.shell.springs[colour].ends[k];
            float x = 0.5f * (bench.shell.rest_position[ends[0]][0] + bench.shell.rest_position[ends[1]][0]);
            assert_true(fabsf(bench_weight(&bench, colour, k) - (0.2f + 6 * x)) < 1e-5f);
        }
}

/// Each particle is slowed by its own damping and drag; springs without weight do not even them out.
TEST(damping_and_drag_follow_a_texture) {
    static const float halves[] = {0, 1};
    for (int drag = 0; drag < 2; drag++) {
        SingeMaterialDef material = bench_plain_material();
        SingeParam param =
            singe_param_field(0, 4, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, halves}});
        if (drag) material.drag = param;
        else material.damping = param;
        OwnBench bench = bench_open(quads_grid(8, 2, 0.01f, 0.01f, false), &material, 1);
        for (int k = 0; k < 3; k++) bench.plan->settings.gravity[k] = 0;
        float h = 0.01f;
        for (uint32_t i = 0; i < bench.shell.particle_count; i++) bench.state.dynamics.velocity[i][2] = 2;
        bench_prepare(&bench);
        dynamics_move(bench.plan, &bench.shell, bench.pool, h, &(Between){.opens = true}, &bench.state.dynamics);
        for (uint32_t i = 0; i < bench.shell.particle_count; i++) {
            float f = fminf(fmaxf(2 * bench.shell.rest_position[i][0] / 0.08f - 0.5f, 0), 1);

            // a layer of 40 g/m2 in air of 1.2 kg/m3 takes half of the drag
            float slower = drag ? h * 0.25f * 1.2f * 4 * f / 0.04f * 2 : h * 4 * f;
            assert_true(fabsf(bench.state.dynamics.velocity[i][2] - 2 / (1 + slower)) < 1e-5f);
        }
    }
}

/// A ribbon whose lower half gives and whose upper half does not: the stretch of its two ends as it hangs.
static void hang(SingeParam compliance, double stretch[2]) {
    SingeMaterialDef material = bench_plain_material();
    material.damping = singe_param(6);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) material.compliance[c] = compliance;
    OwnBench bench = bench_open(quads_grid(1, 20, 0.01f, 0.01f, false), &material, 1);
    bench.plan->settings.solver.substeps = 6;
    bench.plan->settings.solver.height_min = 0;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) bench.plan->settings.solver.regularisation[c] = 1e-6f;
    bench.plan->settings.gravity[1] = -9.81f, bench.plan->settings.gravity[2] = 0;
    for (uint32_t i = 0; i < bench.shell.vertex_count; i++)
        if (bench.shell.rest_position[i][1] > 0.1999f) bench.state.dynamics.pinned[i] = 1;
    for (int s = 0; s < 960; s++) bench_step(&bench, 1.0f / 480);
    for (uint32_t end = 0; end < 2; end++) {
        uint32_t row = end ? 15 : 0; // rows 0 to 5 and 15 to 20: where the picture is one colour
        const float(*x)[4] = (const float(*)[4])bench.state.dynamics.position;
        stretch[end] = (double)(x[2 * (row + 5)][1] - x[2 * row][1]) - 0.05;
    }
}

TEST(compliance_follows_a_texture) {
    static const float halves[] = {0, 1}; // white at the bottom
    double all[2], half[2];
    hang(singe_param(5), all);
    hang(singe_param_field(0, 5, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {1, 2, halves}}), half);
    assert_true(all[0] > 1e-5 && all[1] > 3 * all[0]); // the upper end bears more
    assert_true(fabs(half[0] / all[0] - 1) < 0.05);
    assert_true(fabs(half[1]) < 0.02 * all[1]);
}

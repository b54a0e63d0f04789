// The limit of curvature: what is bent too sharply, and what is not touched.
#include "sample_sheets.h"

#include "dynamics/dynamics_plan.h"

enum { NX = 24, NY = 6 };
static const float cell = 2e-3f, curvature = 350; // about 40 degrees a cell

static Bench open_sheet(Quads quads, float limit) {
    SingeMaterialDef material = singe_default_material();
    material.curvature_max = singe_param(limit);
    return bench_open(quads, &material, 2);
}

/// Folds a grid along its middle column: `angle` in rad within one row of edges, or spread over an arc of `turns`
/// cells.
static void fold(Bench *b, float angle, int turns) {
    for (uint32_t v = 0; v < b->shell.vertex_count; v++) {
        uint32_t i = v % (NX + 1);
        float x = 0, z = 0, heading = 0;
        for (uint32_t k = 0; k < i; k++) {
            int into = (int)k - (NX - turns) / 2;
            if (into >= 0 && into < turns) heading += angle / (float)turns;
            x += cell * cosf(heading), z += cell * sinf(heading);
        }

        float *p = b->state.dynamics.position[v];
        p[0] = x, p[2] = z;
    }
}

/// The largest |r| of three vertices in a row along x, over what an arc of the limit has.
static double sharpest(const Bench *b) {
    double max = 0;
    for (uint32_t v = 0; v < b->shell.vertex_count; v++) {
        if (v % (NX + 1) == 0 || v % (NX + 1) == NX) continue;
        const float(*x)[4] = (const float(*)[4])b->state.dynamics.position;
        Float3 to = float3_sub(float3_load(x[v]), float3_load(x[v - 1])),
               from = float3_sub(float3_load(x[v + 1]), float3_load(x[v]));
        max = fmax(max, (double)float3_length(float3_sub(from, to)));
    }

    return max / (double)(2 * cell * sinf(0.5f * curvature * cell));
}

/// kg m and kg m2: sums of m x and of m x cross x_0, which no force between particles changes.
static void momenta(const Bench *b, const float (*start)[4], double *sums) {
    memset(sums, 0, 6 * sizeof *sums);
    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        const float *x = b->state.dynamics.position[i];
        double m = (double)b->shell.matter.mass[i], d[3];
        for (int k = 0; k < 3; k++) d[k] = (double)x[k] - (double)start[i][k];
        for (int k = 0; k < 3; k++) {
            const int next = (k + 1) % 3, last = (k + 2) % 3;
            sums[k] += m * d[k];
            sums[3 + k] += m * ((double)start[i][next] * d[last] - (double)start[i][last] * d[next]);
        }
    }
}

static float (*copy_positions(const Bench *b))[4] {
    size_t bytes = (b->shell.particle_count + 1) * sizeof *b->state.dynamics.position;
    float(*copy)[4] = malloc(bytes);
    memcpy(copy, b->state.dynamics.position, bytes);
    return copy;
}

static bool is_touched(Bench *b) {
    bench_prepare(b);
    float(*before)[4] = copy_positions(b);
    curvature_project(b->plan, b->pool, &b->state.dynamics);
    bool touched = memcmp(before, b->state.dynamics.position, b->shell.particle_count * sizeof *before) != 0;
    free(before);
    return touched;
}

TEST(sharp_folds_are_rounded) {
    OwnBench bench = open_sheet(quads_grid(NX, NY, cell, cell, false), curvature);
    fold(&bench, 2, 1);
    bench_prepare(&bench);
    assert_true(sharpest(&bench) > 2);
    for (int i = 0; i < 400; i++) curvature_project(bench.plan, bench.pool, &bench.state.dynamics);
    assert_true(sharpest(&bench) < 1.02);
}

TEST(momenta_are_kept) {
    OwnBench bench = open_sheet(quads_grid(NX, NY, cell, cell, false), curvature);
    fold(&bench, 2, 1);
    bench_prepare(&bench);
    float(*start)[4] = copy_positions(&bench);
    curvature_project(bench.plan, bench.pool, &bench.state.dynamics);
    double sums[6], moved = 0;
    momenta(&bench, (const float(*)[4])start, sums);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        for (int k = 0; k < 3; k++)
            moved += (double)bench.shell.matter.mass[i] *
                     fabs((double)bench.state.dynamics.position[i][k] - (double)start[i][k]);
    assert_true(moved > 0);
    for (int k = 0; k < 3; k++) assert_true(fabs(sums[k]) < 1e-4 * moved);
    for (int k = 3; k < 6; k++) assert_true(fabs(sums[k]) < 1e-4 * moved * NX * (double)cell + 1e-12);
    free(start);
}

TEST(gentle_bends_are_not_touched) {
    OwnBench bench = open_sheet(quads_grid(NX, NY, cell, cell, false), curvature);
    fold(&bench, 0.9f * curvature * cell * 8, 8);
    assert_false(is_touched(&bench));
    fold(&bench, 1.2f * curvature * cell * 8, 8);
    assert_true(is_touched(&bench));
}

/// A vertex of a grid around the origin that is bent to a cylinder whose axis is at an angle to its columns.
static void cylinder(const float *rest, double bend, double angle, double *x) {
    const double c = cos(angle), s = sin(angle);
    const double p = (double)rest[0] - 0.5 * NX * (double)cell, q = (double)rest[1] - 0.5 * NX * (double)cell;
    const double u = sin((c * p + s * q) * bend) / bend, v = c * q - s * p;
    x[0] = c * u - s * v, x[1] = s * u + c * v, x[2] = (1 - cos((c * p + s * q) * bend)) / bend;
}

/// What the limit resists a bend beyond it with: the work of a projection on the way to a sharper bend.
static double resistance(double angle, bool isotropic) {
    const double bend = 150;
    double work = 0;
    OwnBench bench = open_sheet(quads_grid(NX, NX, cell, cell, false), 100);
    dynamics_plan_free(&bench.memory, &bench.shell, bench.plan);
    bench.settings.solver.isotropic = isotropic;
    assert_int_equal(dynamics_plan_create(&bench.memory, &bench.shell, &bench.settings, &bench.plan), SINGE_OK);
    for (uint32_t v = 0; v < bench.shell.vertex_count; v++) {
        double x[3];
        cylinder(bench.shell.rest_position[v], bend, angle, x);
        for (int k = 0; k < 3; k++) bench.state.dynamics.position[v][k] = (float)x[k];
    }
    bench_prepare(&bench);
    float(*before)[4] = copy_positions(&bench);
    curvature_project(bench.plan, bench.pool, &bench.state.dynamics);
    for (uint32_t v = 0; v < bench.shell.vertex_count; v++) {
        double x[3], more[3];
        cylinder(bench.shell.rest_position[v], bend, angle, x);
        cylinder(bench.shell.rest_position[v], 1.001 * bend, angle, more);
        for (int k = 0; k < 3; k++)
            work -= (double)bench.shell.matter.mass[v] * (more[k] - x[k]) *
                    ((double)bench.state.dynamics.position[v][k] - (double)before[v][k]);
    }
    free(before);
    return work;
}

/// Along the diagonals the limit is four times as stiff as along rows, with `isotropic` the same.
TEST(isotropic_limits_hold_all_folds_alike) {
    const double quarter = 0.785398163;
    for (int isotropic = 0; isotropic < 2; isotropic++) {
        const double ratio = resistance(quarter, isotropic) / resistance(0, isotropic);
        print_message("isotropic %d: %.2f\n", isotropic, ratio);
        assert_true(isotropic ? fabs(ratio - 1) < 0.2 : ratio > 3);
    }
}

/// A limit beyond what cells of this size bear is that of the cells: beta, 45 degrees for these.
TEST(coarse_cells_set_the_curvature_limit) {
    const float beta = atanf(2 * singe_default_material().thickness.value / cell);
    OwnBench bench = open_sheet(quads_grid(NX, NY, cell, cell, false), 1e5f);
    fold(&bench, 0.95f * beta * 8, 8);
    assert_false(is_touched(&bench));
    fold(&bench, 1.2f * beta * 8, 8);
    assert_true(is_touched(&bench));
}

TEST(without_a_limit_nothing_is_touched) {
    OwnBench bench = open_sheet(quads_grid(NX, NY, cell, cell, false), 0);
    fold(&bench, 2.5f, 1);
    assert_false(is_touched(&bench));
}

TEST(char_folds_as_it_likes) {
    OwnBench bench = open_sheet(quads_grid(NX, NY, cell, cell, false), curvature);
    fold(&bench, 2, 1);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++) bench.state.burn.mass[i] = 0.9f;
    assert_false(is_touched(&bench));
}

TEST(removed_springs_do_not_bend) {
    OwnBench bench = open_sheet(quads_grid(NX, NY, cell, cell, false), curvature);
    fold(&bench, 2, 1);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        memset(bench.state.ablate.spring_flags[colour], 0, bench.shell.springs[colour].count);
    assert_false(is_touched(&bench));
}

/// A tube that is rounder at rest than the limit, and a flat sheet whose vertices lie off their rows.
TEST(rest_shapes_are_kept) {
    OwnBench tube = open_sheet(quads_grid(8, NY, cell, cell, true), 100);
    assert_false(is_touched(&tube));

    Quads quads = quads_grid(NX, NY, cell, cell, false);
    for (uint32_t v = 0; v < quads.vertex_count; v++) {
        quads.positions[3 * v] += 0.3f * cell * sinf(7.0f * (float)v);
        quads.positions[3 * v + 1] += 0.3f * cell * sinf(13.0f * (float)v);
    }
    OwnBench sheet = open_sheet(quads, 10);
    assert_false(is_touched(&sheet));
}

/// Around a tube that is pressed flat there are folds at every ring's first vertex or elsewhere: all are rounded.
TEST(rings_are_limited_all_around) {
    OwnBench bench = open_sheet(quads_grid(32, 2, cell, cell, true), curvature);
    for (uint32_t turn = 0; turn < 32; turn++) {
        for (uint32_t v = 0; v < bench.shell.vertex_count; v++) {
            uint32_t i = (v + turn) % 32; // two flat sides, and folds where i is 0 and 16
            float *p = bench.state.dynamics.position[v];
            p[0] = cell * (float)(i < 16 ? i : 32 - i), p[2] = 0;
        }

        bench_prepare(&bench);
        for (int i = 0; i < 300; i++) curvature_project(bench.plan, bench.pool, &bench.state.dynamics);
        for (uint32_t v = 0; v < 32; v++) {
            const float(*x)[4] = (const float(*)[4])bench.state.dynamics.position;
            Float3 r = float3_add(float3_sub(float3_load(x[(v + 31) % 32]), float3_scale(float3_load(x[v]), 2)),
                                  float3_load(x[(v + 1) % 32]));
            assert_true(float3_length(r) < 1.15f * 2 * cell * sinf(0.5f * curvature * cell) + 0.2f * cell);
        }
    }
}

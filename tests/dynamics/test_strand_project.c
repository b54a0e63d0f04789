// A strand's Newton step against a dense solve of eq 16 and 19 in double precision, chains and rings.
#include "sample_sheets.h"

#include "common/random.h"
#include "dynamics/dynamics_plan.h"

#include "support/dense_solve.h"

enum { N_MAX = 64 };

/// The compliance of a spring whose own compliance is zero, m/N: (a + r) h^2/m.
static double own_softness(const Bench *bench, SingeColour colour) {
    const double h = (double)bench->settings.time_step / bench->settings.solver.substeps;
    double s = (double)bench->shell.sheets[0].cell_size, area = 0, mass = 0;
    for (uint32_t c = 0; c < bench->shell.cell_count; c++) {
        area += (double)bench->shell.matter.area[shell_centre(&bench->shell, c)];
        mass += (double)bench->shell.matter.mass[shell_centre(&bench->shell, c)];
    }
    double r = (double)bench->settings.solver.regularisation[colour], a = colour == SINGE_RED ? 2.5 : 0;
    return (a + r) * h * h / (s * s * mass / area);
}

/// One strand by the definition: J M^-1 J^T assembled from the gradients of every spring.
static void dense_strand(const Bench *bench, SingeColour colour, uint32_t strand, double (*x)[3]) {
    const SpringSet *set = &bench->shell.springs[colour];
    uint32_t first = set->strand_first[strand];
    int n = (int)(set->strand_first[strand + 1] - first);

    assert_true(n <= N_MAX);
    static double a[N_MAX * N_MAX], b[N_MAX], u[N_MAX][3], stretch[N_MAX];
    const float *w = bench->plan->inverse_mass;
    double relative = (double)bench->settings.solver.regularisation[colour];
    const SingeMaterialDef material = singe_default_material();
    double compliance = (double)material.compliance[colour].value;
    double t = (double)material.thickness.value, s = (double)bench->shell.sheets[0].cell_size;
    if (colour == SINGE_RED) compliance *= t * t / (s * s / 2 + t * t);
    compliance = fmax(0, compliance - own_softness(bench, colour));
    for (int k = 0; k < n; k++) {
        const uint32_t *e = set->ends[first + (uint32_t)k];
        double l = (double)bench->state.burn.spring_length[colour][first + (uint32_t)k], length = 0;
        for (int i = 0; i < 3; i++) u[k][i] = x[e[1]][i] - x[e[0]][i], length += u[k][i] * u[k][i];
        length = sqrt(length);
        for (int i = 0; i < 3; i++) u[k][i] /= length;
        stretch[k] = (length * length - l * l) / (2 * length * length);
        b[k] = (double)bench_weight(bench, colour, first + (uint32_t)k) * (length * length - l * l) / (2 * length);
    }

    for (int p = 0; p < n; p++)
        for (int q = 0; q < n; q++) {
            double *entry = &a[p * n + q];
            *entry = 0;
            const uint32_t *ep = set->ends[first + (uint32_t)p], *eq = set->ends[first + (uint32_t)q];
            double dot = u[p][0] * u[q][0] + u[p][1] * u[q][1] + u[p][2] * u[q][2];
            for (int i = 0; i < 2; i++)
                for (int j = 0; j < 2; j++)
                    if (ep[i] == eq[j]) *entry += (i == j ? 1 : -1) * (double)w[ep[i]] * dot;
            if (p == q) *entry += 0.5 * relative * ((double)w[ep[0]] + (double)w[ep[1]]);

            // what is too long yields
            if (p == q) *entry += 0.5 * fmax(stretch[p] - 0.01, 0) * ((double)w[ep[0]] + (double)w[ep[1]]);
            if (p == q) *entry += compliance * 1e6;
        }
    dense_solve(a, b, (uint32_t)n);
    for (int k = 0; k < n; k++) {
        const uint32_t *e = set->ends[first + (uint32_t)k];
        for (int i = 0; i < 3; i++) {
            x[e[0]][i] += (double)w[e[0]] * u[k][i] * b[k];
            x[e[1]][i] -= (double)w[e[1]] * u[k][i] * b[k];
        }
    }
}

static void shake(Bench *bench, float amount) {
    for (uint32_t i = 0; i < bench->shell.particle_count; i++)
        for (uint32_t k = 0; k < 3; k++)
            bench->state.dynamics.position[i][k] += amount * (random_unit(random_hash(i, k, 7, 1)) - 0.5f);
    for (uint32_t i = 0; i < bench->shell.particle_count; i++)
        bench->state.burn.mass[i] = 0.3f + 0.7f * random_unit(random_hash(i, 9, 9, 2));
}

static void compare(Quads quads, bool pin_some) {
    DynamicsCounters counters = {0};
    OwnBench bench = bench_open(quads, NULL, 1);
    if (pin_some)
        for (uint32_t i = 0; i < bench.shell.particle_count; i += 5) bench.state.dynamics.pinned[i] = 1;
    shake(&bench, 0.002f);
    bench_prepare(&bench);
    double(*x)[3] = malloc(bench.shell.particle_count * sizeof *x);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        for (uint32_t i = 0; i < bench.shell.particle_count; i++)
            for (int k = 0; k < 3; k++) x[i][k] = (double)bench.state.dynamics.position[i][k];

        // strands are stored family by family, and strands of a family do not touch: one after another is the same
        for (uint32_t s = 0; s < bench.shell.springs[colour].strand_count; s++)
            dense_strand(&bench, (SingeColour)colour, s, x);
        strand_project(bench.plan, (SingeColour)colour, NULL, 1e-3f, &bench.state.dynamics, &counters);
        for (uint32_t i = 0; i < bench.shell.particle_count; i++)
            for (int k = 0; k < 3; k++) assert_true(fabs(x[i][k] - (double)bench.state.dynamics.position[i][k]) < 2e-6);
    }

    free(x);
}

TEST(chains_match_a_dense_solver) {
    compare(quads_grid(7, 9, 0.01f, 0.012f, false), false);
    compare(quads_grid(12, 5, 0.01f, 0.008f, false), true);
}

TEST(rings_match_a_dense_solver) {
    compare(quads_grid(14, 4, 0.01f, 0.012f, true), false);
    compare(quads_grid(15, 4, 0.01f, 0.012f, true), true);
}

TEST(gone_springs_decouple) {
    DynamicsCounters counters = {0};
    OwnBench bench = bench_open(quads_grid(6, 1, 0.01f, 0.01f, false), NULL, 1);
    shake(&bench, 0.002f);
    const SpringSet *blue = &bench.shell.springs[SINGE_BLUE];
    for (uint32_t k = 0; k < blue->count; k++) bench.state.ablate.spring_flags[SINGE_BLUE][k] = 0;
    bench_prepare(&bench);
    float before[4], (*x)[4] = bench.state.dynamics.position;
    memcpy(before, x[3], sizeof before);
    strand_project(bench.plan, SINGE_BLUE, NULL, 1e-3f, &bench.state.dynamics, &counters);
    assert_memory_equal(before, x[3], sizeof before);
}

TEST(springs_pinned_at_both_ends_do_not_move) {
    OwnBench bench = bench_open(quads_grid(6, 2, 0.01f, 0.01f, false), NULL, 1);
    memset(bench.state.dynamics.pinned, 1, bench.shell.particle_count);
    bench.state.dynamics.pinned[9] = 0; // one free corner among pinned ones
    for (int step = 0; step < 100; step++) bench_step(&bench, 0.002f);
    assert_true(fabsf(bench.state.dynamics.position[9][2]) < 0.001f);
}

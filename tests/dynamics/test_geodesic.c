// Geodesic distances against those that are known: straight lines, unrolled surfaces, ways round a corner.
#include "sample_sheets.h"

#include "dynamics/geodesic.h"

typedef struct Distances {
    Bench bench;
    Geodesic search;
    float *distance;
} Distances;

static void distances_open(Distances *d, Quads quads) {
    d->bench = bench_open(quads, NULL, 1);
    assert_true(geodesic_create(&d->bench.memory, d->bench.shell.vertex_count, &d->search));
    d->distance = malloc(d->bench.shell.vertex_count * sizeof *d->distance);
    assert_non_null(d->distance);
}

static void distances_close(Distances *d) {
    free(d->distance);
    geodesic_free(&d->bench.memory, d->bench.shell.vertex_count, &d->search);
    bench_close(&d->bench);
}
#define OwnDistances OWNED(distances_close) Distances

static void distances_from(Distances *d, uint32_t source) {
    geodesic_from(&d->search, &d->bench.shell, STATE_INPUT(&d->bench.state), source, 0, d->bench.shell.vertex_count,
                  d->distance);
}

static double apart(const Distances *d, uint32_t a, uint32_t b) {
    return (double)float3_length(
        float3_sub(float3_load(d->bench.shell.rest_position[a]), float3_load(d->bench.shell.rest_position[b])));
}

/// The largest relative error against straight lines, from some sources to all vertices.
static double straight_error(Quads quads) {
    OwnDistances d;
    distances_open(&d, quads);
    const uint32_t n = d.bench.shell.vertex_count, sources[] = {0, n / 3, n / 2, n - 1};
    double worst = 0;
    for (int s = 0; s < 4; s++) {
        distances_from(&d, sources[s]);
        for (uint32_t v = 0; v < n; v++) {
            double straight = apart(&d, sources[s], v);
            if (v == sources[s]) assert_true(d.distance[v] == 0);
            else worst = fmax(worst, fabs((double)d.distance[v] / straight - 1));
        }
    }

    return worst;
}

TEST(flat_distances_are_straight_lines) {
    Quads sheared = quads_grid(24, 16, 0.01f, 0.01f, false);
    for (uint32_t v = 0; v < sheared.vertex_count; v++) sheared.positions[3 * v] += 0.4f * sheared.positions[3 * v + 1];
    double square = straight_error(quads_grid(24, 16, 0.01f, 0.01f, false));
    double flat = straight_error(quads_grid(12, 30, 0.02f, 0.007f, false)), leaning = straight_error(sheared);
    print_message("worst error: square cells %.1e, 1 : 3 %.1e, sheared %.1e\n", square, flat, leaning);
    assert_true(square < 1e-3 && flat < 1e-3 && leaning < 1e-3);
}

/// A bent sheet is as far across as a flat one: here a cylinder, unrolled in chords as its springs are.
TEST(a_cylinder_is_as_far_across_as_flat) {
    enum { AROUND = 40, ALONG = 24 };
    const float side = 0.01f;
    OwnDistances d;
    distances_open(&d, quads_grid(AROUND, ALONG, side, side, true));
    const double chord = apart(&d, 0, 1);
    double worst = 0;
    distances_from(&d, 5);
    for (uint32_t v = 0; v < d.bench.shell.vertex_count; v++) {
        int i = abs((int)(v % AROUND) - 5);
        if (i > AROUND / 2) i = AROUND - i;
        double displacement = hypot(chord * i, (double)side * (v / AROUND));
        if (displacement > 0) worst = fmax(worst, fabs((double)d.distance[v] / displacement - 1));
    }

    print_message("worst error on a cylinder: %.1e\n", worst);
    assert_true(worst < 1e-3);
}

enum { SIDE = 40, ROW = SIDE + 1 };

static uint32_t vertex(uint32_t i, uint32_t j) { return j * ROW + i; }

static void remove_cells(Distances *d, uint32_t i0, uint32_t i1, uint32_t j0, uint32_t j1) {
    for (uint32_t j = j0; j < j1; j++)
        for (uint32_t i = i0; i < i1; i++) d->bench.state.ablate.cell_flags[j * SIDE + i] = 0;
}

/// The way over corners: the sum of the straight lines between them.
static double displacement(const Distances *d, int count, const uint32_t *corners) {
    double sum = 0;
    for (int k = 1; k < count; k++) sum += apart(d, corners[k - 1], corners[k]);
    return sum;
}

static void assert_displacement(const Distances *d, uint32_t to, double expected) {
    double error = (double)d->distance[to] / expected - 1;
    if (fabs(error) > 0.01) fail_msg("vertex %u: %g m, not %g", to, (double)d->distance[to], expected);
}

TEST(distances_go_around_a_slit) {
    OwnDistances d;
    distances_open(&d, quads_grid(SIDE, SIDE, 0.01f, 0.01f, false));
    remove_cells(&d, 0, 20, 20, 21);
    const uint32_t source = vertex(5, 8);
    distances_from(&d, source);
    for (uint32_t j = 21; j <= SIDE; j++)
        for (uint32_t i = 0; i <= 10; i++) {
            const uint32_t corners[] = {source, vertex(20, 20), vertex(20, 21), vertex(i, j)};
            assert_displacement(&d, corners[3], displacement(&d, 4, corners));
        }
    assert_displacement(&d, vertex(35, 30), apart(&d, source, vertex(35, 30))); // in sight
}

TEST(distances_go_around_a_hole) {
    OwnDistances d;
    distances_open(&d, quads_grid(SIDE, SIDE, 0.01f, 0.01f, false));
    remove_cells(&d, 12, 28, 14, 26);
    const uint32_t source = vertex(20, 4), to = vertex(20, 36);
    distances_from(&d, source);
    const uint32_t corners[] = {source, vertex(12, 14), vertex(12, 26), to};
    assert_displacement(&d, to, displacement(&d, 4, corners));
    assert_true(isinf(d.distance[vertex(20, 20)])); // within the hole
}

/// No path leads across cells that are gone.
TEST(paths_avoid_removed_cells) {
    OwnDistances d;
    distances_open(&d, quads_grid(SIDE, SIDE, 0.01f, 0.01f, false));
    remove_cells(&d, 0, SIDE, 20, 21);
    distances_from(&d, vertex(3, 3));
    for (uint32_t v = 0; v < d.bench.shell.vertex_count; v++)
        if (isinf(d.distance[v]) == (v < vertex(0, 21))) fail_msg("vertex %u: %g m", v, (double)d.distance[v]);
}

/// A sheet that has shrunk to 0.8 has distances of 0.8.
TEST(distances_follow_target_lengths) {
    OwnDistances d;
    distances_open(&d, quads_grid(SIDE, SIDE, 0.01f, 0.01f, false));
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t k = 0; k < d.bench.shell.springs[colour].count; k++)
            d.bench.state.burn.spring_length[colour][k] *= 0.8f;
    distances_from(&d, vertex(3, 3));
    for (uint32_t v = 0; v < d.bench.shell.vertex_count; v++)
        assert_true(fabs((double)d.distance[v] - 0.8 * apart(&d, vertex(3, 3), v)) < 1e-5);
}

/// Held vertices stay where they are, whatever their target lengths: distances between them do not shrink.
TEST(held_vertices_do_not_shrink_distances) {
    OwnDistances d;
    distances_open(&d, quads_grid(SIDE, SIDE, 0.01f, 0.01f, false));
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t k = 0; k < d.bench.shell.springs[colour].count; k++)
            d.bench.state.burn.spring_length[colour][k] *= 0.5f;
    for (uint32_t j = 0; j <= SIDE; j++)
        for (uint32_t i = 0; i <= 10; i++) d.bench.state.dynamics.pinned[vertex(i, j)] = 1;
    distances_from(&d, vertex(0, 20));
    assert_displacement(&d, vertex(10, 20), 0.10);
    assert_displacement(&d, vertex(30, 20), 0.10 + 0.5 * 0.20);
}

TEST(distances_are_symmetric) {
    OwnDistances d;
    distances_open(&d, quads_grid(SIDE, SIDE, 0.01f, 0.01f, false));
    remove_cells(&d, 10, 30, 15, 17);
    remove_cells(&d, 25, 40, 28, 29);
    enum { COUNT = 12 };
    uint32_t sources[COUNT];
    double between[COUNT][COUNT], worst = 0;
    for (uint32_t s = 0; s < COUNT; s++) sources[s] = vertex(s * 17 % ROW, s * 29 % ROW);
    for (int s = 0; s < COUNT; s++) {
        distances_from(&d, sources[s]);
        for (int t = 0; t < COUNT; t++) between[s][t] = (double)d.distance[sources[t]];
    }
    for (int s = 0; s < COUNT; s++)
        for (int t = 0; t < s; t++) worst = fmax(worst, fabs(between[s][t] / between[t][s] - 1));
    print_message("worst difference between there and back: %.1e\n", worst);
    assert_true(worst < 0.01);
}

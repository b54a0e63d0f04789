// Rest geometry: areas, masses, where centres lie, lengths.

#include "common/order.h"

#include "sample_shells.h"

static void assert_near(double value, double expected, double relative) {
    if (!(fabs(value - expected) <= relative * fabs(expected))) fail_msg("%.9g is not %.9g", value, expected);
}

/// Sum of a layer's values: 0 corners, 1 centres.
static double layer_sum(const Shell *shell, const float *values, int layer) {
    double sum = 0;
    uint32_t end = layer ? shell->particle_count : shell->vertex_count;
    for (uint32_t p = layer ? shell->vertex_count : 0; p < end; p++) sum += (double)values[p];
    return sum;
}

static void check_layers(const Shell *shell, double area, double tolerance) {
    const SingeMaterialDef material = singe_default_material();
    double mass = area * (double)material.grammage.value / 2;
    for (int layer = 0; layer < 2; layer++) {
        assert_near(layer_sum(shell, shell->matter.area, layer), area, tolerance);
        assert_near(layer_sum(shell, shell->matter.mass, layer), mass, tolerance);
        assert_near(layer_sum(shell, shell->matter.capacity, layer), mass * (double)material.specific_heat.value,
                    tolerance);
    }
}

// Rectangles: quarters at the corner, halves at the side; every length by hand.
TEST(rectangles_match_lengths_by_hand) {
    const float dx = 0.02f, dy = 0.01f, t = 0.003f;
    OwnSample sample = sample_open(mesh_grid(4, 3, dx, dy), t);
    const Shell *shell = &sample.shell;
    check_layers(shell, 12.0 * 0.02 * 0.01, 1e-6);

    double cell = 0.02 * 0.01;
    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        uint32_t i = v % 5, j = v / 5;
        double share = (i == 0 || i == 4 ? 0.5 : 1) * (j == 0 || j == 3 ? 0.5 : 1);
        assert_near((double)shell->matter.area[v], cell * share, 1e-6);
    }

    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const float *p = shell->rest_position[shell_centre(shell, c)];
        assert_near((double)p[0], 0.02 * (c % 4 + 0.5), 1e-6);
        assert_near((double)p[1], 0.01 * (c / 4 + 0.5), 1e-6);
        assert_near((double)p[2], (double)t, 1e-6); // the front of a counter-clockwise cell
        assert_near((double)shell->matter.area[shell_centre(shell, c)], cell, 1e-6);
    }

    for (uint32_t s = 0; s < shell->springs[SINGE_RED].count; s++)
        assert_near((double)shell->springs[SINGE_RED].rest[s], sqrt(1e-4 + 0.25e-4 + 9e-6), 1e-6);
    for (uint32_t s = 0; s < shell->springs[SINGE_YELLOW].count; s++)
        assert_near((double)shell->springs[SINGE_YELLOW].rest[s], sqrt(4e-4 + 1e-4), 1e-6);

    double green = 0, blue = 0;
    for (uint32_t s = 0; s < shell->springs[SINGE_GREEN].count; s++)
        green += (double)shell->springs[SINGE_GREEN].rest[s];
    for (uint32_t s = 0; s < shell->springs[SINGE_BLUE].count; s++) blue += (double)shell->springs[SINGE_BLUE].rest[s];
    assert_near(green, 9 * 0.02 + 8 * 0.01, 1e-6);
    assert_near(blue, 16 * 0.02 + 15 * 0.01, 1e-6);

    // 16 edges of 2 cm and 15 of 1 cm: the middle one of 31 is long
    assert_near((double)shell->sheets[0].cell_size, 0.02, 1e-6);
}

// The median by histograms is the median by sorting.
TEST(the_median_cell_size_is_exact) {
    for (uint32_t seed = 1; seed < 6; seed++) {
        QuadMesh mesh = mesh_random(2 + seed, seed);
        for (uint32_t v = 0; v < mesh.vertex_count; v++) mesh.position[v][2] = 0.1f * sinf((float)(v * v));

        OwnSample sample = sample_open(mesh, 0);
        const Shell *shell = &sample.shell;
        const SpringSet *blue = &shell->springs[SINGE_BLUE];
        float *sorted = malloc(blue->count * sizeof *sorted);
        assert_non_null(sorted);
        for (uint32_t s = 0; s < blue->count; s++) sorted[s] = blue->rest[s];

        qsort(sorted, blue->count, sizeof *sorted, order_by_float);
        assert_true(shell->sheets[0].cell_size == sorted[blue->count / 2]);
        free(sorted);
    }
}

// Any planar mesh: the parts sum to the whole. The polygon of k patches: k/2 sin(2 pi/k) of its outline.
TEST(parts_of_a_planar_mesh_sum_to_the_whole) {
    OwnSample random = sample_open(mesh_random(7, 3), 0), pentagon = sample_open(mesh_polygon(5, 4), 0);
    const Shell *shell = &random.shell;
    check_layers(shell, 49, 1e-5);
    for (uint32_t p = 0; p < shell->particle_count; p++) assert_true(shell->matter.mass[p] > 0);
    check_layers(&pentagon.shell, 2.5 * sin(2 * 3.14159265358979 / 5), 1e-5);
}

// A dart: the triangle (0,0) (2,0) (1,2) without (0,0) (2,0) (1,1), its corners equal for want of better.
TEST(a_concave_cell_has_equal_corners) {
    QuadMesh mesh = {0};
    static const float position[4][2] = {{0, 0}, {1, 1}, {2, 0}, {1, 2}};

    for (int v = 0; v < 4; v++) mesh_add_vertex(&mesh, position[v][0], position[v][1], 0);
    mesh_add_cell(&mesh, 0, 1, 2, 3);
    OwnSample sample = sample_open(mesh, 0);
    const Shell *shell = &sample.shell;
    check_layers(shell, 1, 1e-6);
    for (uint32_t v = 0; v < 4; v++) assert_near((double)shell->matter.area[v], 0.25, 1e-6);
}

// A curved shell: the centre layer of a cylinder is longer outside, at the radius of its own prism.
TEST(the_centre_layer_of_a_cylinder_is_longer_outside) {
    const uint32_t n = 16;
    const double pi = 3.14159265358979, r = 0.1, t = 0.01, h = 0.3;
    OwnSample sample = sample_open(mesh_cylinder(n, 6, (float)r, (float)h), (float)t);
    const Shell *shell = &sample.shell;
    check_layers(shell, n * 2 * r * sin(pi / n) * h, 1e-5);

    double around = 2 * (r * cos(pi / n) + t) * sin(pi / n);
    uint32_t rings = 0;
    const SpringSet *green = &shell->springs[SINGE_GREEN];
    for (uint32_t s = 0; s < green->strand_count; s++) {
        rings += green->strand_ring[s];
        for (uint32_t k = green->strand_first[s]; k < green->strand_first[s + 1]; k++)
            assert_near((double)green->rest[k], green->strand_ring[s] ? around : h / 6, 1e-5);
    }

    assert_int_equal(rings, 6);
}

// Welding, repairs, collapsed sides, and meshes that are refused.
#include "sample_meshes.h"
#include "common/order.h"

static Text text;

TEST(soup_is_welded) {
    text.size = 0;
    for (int j = 0; j < 5; j++)
        for (int i = 0; i < 6; i++) {
            float x = 0.01f * (float)i, y = 0.01f * (float)j, noise = (i * 7 + j * 3) % 5 * 1e-8f, s = 0.01f;
            text_add(&text, "v %.9g %.9g 0\nv %.9g %.9g 0\nv %.9g %.9g 0\n", x + noise, y, x + s, y + noise, x + s,
                     y + s);
            text_add(&text, "v %.9g %.9g 0\nv %.9g %.9g 0\nv %.9g %.9g 0\n", x, y, x + s, y + s, x, y + s + noise);
            text_add(&text, "f -6 -5 -4\nf -3 -2 -1\n");
        }

    Made made = make(&text);
    assert_int_equal(made.mesh.vertex_count, 42);
    assert_int_equal(made.mesh.cell_count, 30);
    assert_int_equal(made.report.count[MESH_WELDED], 180 - 42);
    assert_int_equal(made.report.components, 1);
    mesh_free(&made.mesh);
}

// Layers that touch inside stay two; a seam farther apart than the tolerance stays open until that is raised.
TEST(weld_keeps_layers_apart) {
    text.size = 0;
    for (int layer = 0; layer < 2; layer++)
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++) {
                bool middle = i == 1 && j == 1;
                text_add(&text, "v %d %d %g\n", i, j, layer && !middle ? 0.3 : 0);
            }

    for (int layer = 0; layer < 2; layer++)
        for (int c = 0; c < 4; c++) {
            int a = 9 * layer + c / 2 * 3 + c % 2 + 1;
            text_add(&text, "f %d %d %d %d\n", a, a + 1, a + 4, a + 3);
        }

    Made made = make(&text);
    assert_int_equal(made.mesh.vertex_count, 18);
    assert_int_equal(made.report.components, 2);
    mesh_free(&made.mesh);

    text.size = 0;
    text_add(&text,
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1.001 0 0\nv 2 0 0\nv 2 1 0\nv 1.001 1 0\nf 1 2 3 4\nf 5 6 7 8\n");
    made = make(&text);
    assert_int_equal(made.report.components, 2);
    mesh_free(&made.mesh);

    MeshOptions options = mesh_default_options();
    options.weld = 0.002f;
    made = make_with(&text, options);
    assert_int_equal(made.report.components, 1);
    assert_int_equal(made.mesh.vertex_count, 6);
    mesh_free(&made.mesh);
}

TEST(t_junctions_are_closed) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 .5 0\nv 2 0 0\nv 2 .5 0\nv 2 1 0\n"
                    "f 1 2 3 4\nf 2 6 7 5\nf 5 7 8 3\n");
    Made made = make(&text);
    assert_int_equal(made.report.count[MESH_JUNCTION], 1);
    assert_int_equal(made.report.first[MESH_JUNCTION], 9);
    assert_int_equal(made.report.components, 1);

    // a vertex that lies on a side but belongs to what depends on a point there is no junction
    mesh_free(&made.mesh);
}

TEST(faults_are_repaired_and_said) {
    text.size = 0;
    text_grid(&text, 3, 3); // lines 1 to 16
    text_add(&text, "v 9 9 9\n");
    text_cells(&text, 3, 3, WHOLE);                   // lines 18 to 26
    text_add(&text, "f 1 5 6 2\nf 1 2 3\nf 4 4 8\n"); // there already, the other way round; flat; two corners

    Made made = make(&text);
    assert_int_equal(made.mesh.cell_count, 9);
    assert_int_equal(made.mesh.vertex_count, 16);
    assert_int_equal(made.report.count[MESH_UNUSED], 1);
    assert_int_equal(made.report.first[MESH_UNUSED], 16);
    assert_int_equal(made.report.count[MESH_DUPLICATE], 1);
    assert_int_equal(made.report.first[MESH_DUPLICATE], 27);
    assert_int_equal(made.report.count[MESH_DEGENERATE], 2);

    char line[200];
    bool said = false;
    for (int i = 0; mesh_report_line(&made.report, i, line, sizeof line); i++)
        said = said || strstr(line, "2 faces without area left out (line 28)");
    assert_true(said);
    mesh_free(&made.mesh);
}

TEST(faces_are_turned_one_way) {
    text.size = 0;
    text_grid(&text, 3, 1);
    text_add(&text, "f 1 2 6 5\nf 2 6 7 3\nf 3 4 8 7\n");
    Made made = make(&text);
    assert_int_equal(made.report.count[MESH_TURNED], 1);
    assert_int_equal(made.report.first[MESH_TURNED], 10);
    assert_squares(&made.mesh, 0.01f);
    mesh_free(&made.mesh);
}

static void add_cube(float x, bool inside_out, int base) {
    static const int faces[6][4] = {{1, 4, 3, 2}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}};
    for (int i = 0; i < 8; i++)
        text_add(&text, "v %g %d %d\n", (double)x + ((i & 3) == 1 || (i & 3) == 2), (i & 3) >= 2, i >= 4);
    for (int f = 0; f < 6; f++) {
        text_add(&text, "f");
        for (int k = 0; k < 4; k++) text_add(&text, " %d", base + faces[f][inside_out ? 3 - k : k]);
        text_add(&text, "\n");
    }
}

static double volume(const Mesh *mesh) {
    double sum = 0;
    for (uint32_t c = 0; c < mesh->cell_count; c++)
        for (uint32_t k = 1; k < 3; k++) {
            const float *a = mesh->positions + 3 * mesh->cells[4 * c];
            const float *b = mesh->positions + 3 * mesh->cells[4 * c + k];
            const float *d = mesh->positions + 3 * mesh->cells[4 * c + k + 1];
            sum += (a[0] * (b[1] * d[2] - b[2] * d[1]) + a[1] * (b[2] * d[0] - b[0] * d[2]) +
                    a[2] * (b[0] * d[1] - b[1] * d[0])) /
                   6;
        }

    return sum;
}

TEST(closed_surfaces_have_their_front_outside) {
    for (int inside_out = 0; inside_out < 2; inside_out++) {
        text.size = 0;
        add_cube(0, inside_out, 0);
        Made made = make(&text);
        assert_int_equal(made.report.count[MESH_INSIDE_OUT], inside_out);
        assert_float_equal(volume(&made.mesh), 1, 1e-6);
        mesh_free(&made.mesh);
    }
}

// Two cubes that share an edge come apart; so does a fin from the sheet that it stands on, which stays whole.
TEST(edges_of_many_faces_are_cut) {
    text.size = 0;
    add_cube(0, false, 0);
    for (int i = 0; i < 8; i++)
        text_add(&text, "v %d %d %d\n", 1 + ((i & 3) == 1 || (i & 3) == 2), 1 + ((i & 3) >= 2), i >= 4);

    static const int faces[6][4] = {{1, 4, 3, 2}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}};
    for (int f = 0; f < 6; f++) { // corners 1 and 5 of the second are 3 and 7 of the first
        text_add(&text, "f");
        for (int k = 0; k < 4; k++) {
            int v = faces[f][k];
            text_add(&text, " %d", v == 1 ? 3 : v == 5 ? 7 : 8 + v);
        }

        text_add(&text, "\n");
    }

    Made made = make(&text);
    assert_int_equal(made.report.count[MESH_CUT], 1);
    assert_int_equal(made.report.components, 2);
    assert_int_equal(made.mesh.vertex_count, 16);
    mesh_free(&made.mesh);

    text.size = 0;
    text_grid(&text, 2, 2);
    text_add(&text, "v .01 0 .01\nv .01 .01 .01\nv .01 .02 .01\n");
    text_cells(&text, 2, 2, WHOLE);
    text_add(&text, "f 2 5 11 10\nf 5 8 12 11\n");
    made = make(&text);
    assert_int_equal(made.report.count[MESH_CUT], 2);
    assert_int_equal(made.report.components, 2);
    assert_int_equal(made.mesh.vertex_count, 12 + 3);

    int copies = 0;
    for (uint32_t v = 0; v < made.mesh.vertex_count; v++) copies += made.mesh.source[v] == 4;
    assert_int_equal(copies, 2);      // both are the file's vertex
    for (uint32_t v = 9; v < 15; v++) // and the fin does not begin on the sheet
        assert_true(made.mesh.positions[3 * v + 2] > 1e-4f && made.mesh.positions[3 * v + 2] < 0.02f);
    mesh_free(&made.mesh);
}

TEST(bow_ties_are_parted) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\nf 1 2 3 4\nf 3 5 6 7\n");
    Made made = make(&text);
    assert_int_equal(made.report.count[MESH_BOW_TIE], 1);
    assert_int_equal(made.mesh.vertex_count, 8);
    assert_int_equal(made.mesh.source[7], 2);
    mesh_free(&made.mesh);
}

typedef struct Side {
    uint32_t low, high;
    bool up;
} Side;

/// Every side has one cell, or two that run along it in opposite ways. Returns the open ones.
static uint32_t assert_manifold(const Mesh *mesh) {
    const uint32_t count = 4 * mesh->cell_count;
    uint32_t open = 0;
    Side *sides = calloc(count, sizeof *sides);

    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = mesh->cells[i], b = mesh->cells[i / 4 * 4 + (i + 1) % 4];
        sides[i] = (Side){a < b ? a : b, a < b ? b : a, a < b};
    }

    qsort(sides, count, sizeof *sides, order_by_two);
    for (uint32_t i = 0, size; i < count; i += size) {
        for (size = 1; i + size < count && order_by_two(&sides[i], &sides[i + size]) == 0; size++) {
        }
        assert_true(size <= 2);
        assert_true(size == 1 || sides[i].up != sides[i + 1].up);
        open += size == 1;
    }

    free(sides);
    return open;
}

// A surface that comes back to itself the other way round is cut across, once.
TEST(one_sided_surfaces_are_cut) {
    enum { AROUND = 40 };
    text.size = 0;
    for (int i = 0; i < AROUND; i++)
        for (int k = -1; k <= 1; k++) {
            double a = 6.283185307179586 * i / AROUND, r = 1 + 0.2 * k * cos(a / 2);
            text_add(&text, "v %.9g %.9g %.9g\n", r * cos(a), r * sin(a), 0.2 * k * sin(a / 2));
        }

    for (int i = 0; i < AROUND; i++)
        for (int k = 0; k < 2; k++) {
            int a = 3 * i + k + 1, b = a + 1, c = a + 4, d = a + 3;
            if (i + 1 == AROUND) c = 2 - k, d = 3 - k; // the other way round
            text_add(&text, "f %d %d %d %d\n", a, b, c, d);
        }

    Made made = make(&text);
    const uint32_t cut = made.report.count[MESH_ONE_SIDED];
    assert_in_range(cut, 2, 4);
    assert_int_equal(made.mesh.cell_count, 2 * AROUND);
    assert_int_equal(assert_manifold(&made.mesh), 2 * AROUND + 2 * cut);
    mesh_free(&made.mesh);

    text.size = 0; // the one of five triangles
    text_add(&text, "v 1 0 0\nv 0.3 0.9 0.1\nv -0.8 0.6 0.4\nv -0.8 -0.6 0\nv 0.3 -0.9 0.3\n"
                    "f 1 2 3\nf 2 3 4\nf 3 4 5\nf 4 5 1\nf 5 1 2\n");
    made = make(&text);
    assert_manifold(&made.mesh);
    mesh_free(&made.mesh);
}

// Sides of three faces and more of one sheet, which are connected elsewhere as well.
TEST(sheets_that_meet_themselves_are_cut) {
    text.size = 0; // a tent on a sheet, whose feet are two of the sheet's rows: each row has three faces
    text_grid(&text, 4, 4);
    for (int j = 0; j <= 4; j++) text_add(&text, "v .02 %.6g .01\n", 0.01 * j);
    text_cells(&text, 4, 4, WHOLE);
    for (int j = 0; j < 4; j++)
        text_add(&text, "f %d %d %d %d\nf %d %d %d %d\n", 5 * j + 2, 5 * j + 7, 27 + j, 26 + j, 26 + j, 27 + j,
                 5 * j + 9, 5 * j + 4);

    Made made = make(&text);
    assert_int_equal(made.report.count[MESH_CUT], 8);
    assert_int_equal(made.mesh.cell_count, 24);
    assert_manifold(&made.mesh);
    mesh_free(&made.mesh);

    // a sheet with a loop that is pinched shut at one side, which has four faces that are connected all around
    static const double x[] = {-2, -1, -0.2, -0.5, 0.5, 0.2, 1, 2}, z[] = {0, 0, 0, 1, 1, 0, 0, 0};
    text.size = 0;
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 8; i++) text_add(&text, "v %g %d %g\n", x[i], j, z[i]);

    for (int j = 0; j < 5; j++)
        for (int i = 0; i < 7; i++) {
            const int at[4] = {j * 8 + i, j * 8 + i + 1, j * 8 + i + 9, j * 8 + i + 8};
            text_add(&text, "f");
            for (int k = 0; k < 4; k++) text_add(&text, " %d", (at[k] == 21 ? 18 : at[k] == 29 ? 26 : at[k]) + 1);
            text_add(&text, "\n");
        }

    made = make(&text);
    assert_true(made.report.count[MESH_CUT] >= 1);
    assert_manifold(&made.mesh);
    mesh_free(&made.mesh);
}

// Two sheets that lie between the same two vertices, each with its own side there, which no vertex tells apart.
TEST(sides_between_the_same_vertices_are_parted) {
    text.size = 0; // six triangles at a side, three sheets that join in its two ends
    text_add(&text, "v 0 0 0\nv 0 0 1\n");
    for (int i = 0; i < 6; i++) text_add(&text, "v %.9g %.9g .5\n", cos(1.0471975512 * i), sin(1.0471975512 * i));
    for (int i = 0; i < 6; i++) text_add(&text, i % 2 ? "f 2 1 %d\n" : "f 1 2 %d\n", i + 3);
    for (int i = 0; i < 6; i++) text_add(&text, "f %d %d %d\n", 1 + i % 2, i + 3, (i + 1) % 6 + 3);

    Made made = make(&text);
    assert_true(made.report.count[MESH_CUT] >= 1);
    assert_manifold(&made.mesh);
    mesh_free(&made.mesh);
}

// A quad and the two triangles that it could be cut into lie on each other, and so do cells.
TEST(quads_on_their_triangles_are_left_out) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\nf 1 3 4\n");
    Made made = make(&text);
    assert_int_equal(made.mesh.cell_count, 1);
    assert_int_equal(made.report.count[MESH_DUPLICATE], 1);
    assert_int_equal(assert_manifold(&made.mesh), 4);
    mesh_free(&made.mesh);
}

TEST(irreparable_meshes_are_refused) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    Made made = make_with(&text, mesh_default_options());
    assert_int_equal(made.result, SINGE_ERROR_MESH);
    assert_non_null(strstr(made.error.message, "no face has an area"));
}

// Sides below a fiftieth of the median go: a tiny face with its point, a column too narrow, whose border stays.
TEST(short_sides_shrink) {
    text.size = 0;
    text_grid(&text, 4, 4);
    text_cells(&text, 4, 4, REGULAR);
    text_add(&text, "v .02 .05 0\nv .020001 .05 0\nv .02 .050001 0\nf -3 -2 -1\n");
    Made made = make(&text);
    assert_int_equal(made.report.count[MESH_SHRUNK], 2);
    assert_int_equal(made.mesh.cell_count, 16);
    mesh_free(&made.mesh);
    text.size = 0;

    const double x[] = {0, 0.01, 0.02, 0.02001, 0.03, 0.03999, 0.04};
    for (int j = 0; j < 5; j++)
        for (int i = 0; i < 7; i++)
            text_add(&text, "v %.6g %.6g 0\nvt %.6g %.6g\n", x[i], 0.01 * j, 10 * x[i], 0.1 * j);

    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 6; i++) {
            int a = 7 * j + i + 1, c = a + 8;
            text_add(&text, "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, c, c, a, a, c, c, a + 7,
                     a + 7);
        }

    made = make(&text);
    assert_int_equal(made.report.count[MESH_SHRUNK], 10);
    assert_int_equal(made.mesh.cell_count, 16);
    assert_int_equal(made.mesh.vertex_count, 25);
    assert_int_equal(made.report.seam_vertices, 0);
    assert_int_not_equal(vertex_at(&made.mesh, 0.04f, 0.02f, 0), UINT32_MAX);
    assert_int_equal(vertex_at(&made.mesh, 0.03999f, 0.02f, 0), UINT32_MAX);
    mesh_free(&made.mesh);
}

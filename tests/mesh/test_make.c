// Quads out of triangles and polygons; what vertices keep; files of other formats.
#include "sample_meshes.h"

static Text text;

TEST(quads_stay_as_they_are) {
    text.size = 0;
    text_grid(&text, 4, 3), text_cells(&text, 4, 3, WHOLE);
    Made made = make(&text);
    assert_int_equal(made.mesh.vertex_count, 20);
    assert_int_equal(made.mesh.cell_count, 12);
    assert_null(made.mesh.source);
    assert_null(made.mesh.cell_faces);
    assert_null(made.mesh.uv);

    static const uint32_t first[4] = {0, 1, 6, 5};
    assert_memory_equal(made.mesh.cells, first, sizeof first);
    assert_int_equal(made.mesh.cell_lines[0], 21);
    for (int i = 0; i < MESH_REPAIRS; i++) assert_int_equal(made.report.count[i], 0);
    mesh_free(&made.mesh);
}

TEST(triangulated_grids_give_back_their_quads) {
    for (Diagonals d = REGULAR; d <= RANDOM; d++) {
        text.size = 0;
        text_grid(&text, 17, 12), text_cells(&text, 17, 12, d);

        Made made = make(&text);
        assert_int_equal(made.mesh.cell_count, 17 * 12);
        assert_int_equal(made.mesh.vertex_count, 18 * 13);
        assert_null(made.mesh.source);
        assert_squares(&made.mesh, 0.01f);
        assert_int_equal(made.report.count[MESH_PAIRED], 17 * 12);
        assert_int_equal(made.report.count[MESH_HALVED], 0);
        mesh_free(&made.mesh);
    }
}

/// Inner vertices of other than four cells.
static int irregular(const Mesh *mesh) {
    int *cells = calloc(mesh->vertex_count, sizeof *cells), *sides = calloc(mesh->vertex_count, sizeof *sides);
    int count = 0;
    for (uint32_t i = 0; i < 4 * mesh->cell_count; i++) cells[mesh->cells[i]]++;

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = mesh->positions + 3 * v;
        bool inside = p[0] > 0.016f && p[0] < 0.184f && p[1] > 0.001f && p[1] < 0.17f;
        count += inside && cells[v] != 4;
    }

    free(cells), free(sides);
    return count;
}

// Where all pairs are as good, as in a mesh of equilateral triangles, quads go on each other's rows.
TEST(quads_continue_rows) {
    text.size = 0;
    const int n = 20;
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++)
            text_add(&text, "v %.7g %.7g 0\n", 0.01 * (i + 0.5 * (j % 2)), 0.01 * sqrt(0.75) * j);
    text_cells(&text, n, n, REGULAR);

    // rows lean the other way on odd rows: take the diagonal that makes equilateral triangles
    text.size = 0;
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++)
            text_add(&text, "v %.7g %.7g 0\n", 0.01 * (i + 0.5 * (j % 2)), 0.01 * sqrt(0.75) * j);

    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            int a = j * (n + 1) + i + 1, b = a + 1, c = b + n + 1, d = a + n + 1;
            if (j % 2) text_add(&text, "f %d %d %d\nf %d %d %d\n", a, b, c, a, c, d);
            else text_add(&text, "f %d %d %d\nf %d %d %d\n", a, b, d, b, c, d);
        }

    Made made = make(&text);
    assert_int_equal(made.mesh.cell_count, n * n);
    assert_true(irregular(&made.mesh) <= n * n / 50);
    mesh_free(&made.mesh);
}

TEST(lone_triangles_are_halved) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    Made made = make(&text);
    assert_int_equal(made.mesh.cell_count, 1);
    assert_int_equal(made.mesh.vertex_count, 4);
    assert_int_equal(made.mesh.source[3], -1);
    assert_int_equal(made.mesh.source_count, 3);

    uint32_t middle = vertex_at(&made.mesh, 1, 0.5f, 0); // of the longest side
    assert_int_equal(middle, 3);
    mesh_free(&made.mesh);

    // a tetrahedron: closed, pairs would leave vertices of two cells
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    made = make(&text);
    assert_int_equal(made.mesh.cell_count, 4);
    assert_int_equal(made.report.count[MESH_HALVED], 2);
    mesh_free(&made.mesh);
}

TEST(polygons_become_quads) {
    for (int n = 5; n <= 90; n += 17) {
        text.size = 0;
        for (int i = 0; i < n; i++) text_add(&text, "v %.7g %.7g 0\n", cos(6.2831853 * i / n), sin(6.2831853 * i / n));
        text_add(&text, "f");
        for (int i = 0; i < n; i++) text_add(&text, " %d", i + 1);

        Made made = make(&text);
        double area = 0;
        for (uint32_t c = 0; c < made.mesh.cell_count; c++) {
            const float *p[4];
            for (uint32_t k = 0; k < 4; k++) p[k] = made.mesh.positions + 3 * made.mesh.cells[4 * c + k];
            area += 0.5 * ((p[2][0] - p[0][0]) * (p[3][1] - p[1][1]) - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]));
        }

        assert_float_equal(area, 0.5 * n * sin(6.2831853 / n), 1e-5);
        mesh_free(&made.mesh);
    }
}

TEST(split_makes_n_quads_of_n_corners) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n");

    MeshOptions options = mesh_default_options();
    options.quads = SINGE_MESH_SPLIT;
    Made made = make_with(&text, options);
    assert_int_equal(made.result, SINGE_OK);
    assert_int_equal(made.mesh.cell_count, 7);
    assert_int_equal(made.mesh.vertex_count, 5 + 6 + 2);
    for (int v = 0; v < 13; v++) assert_int_equal(made.mesh.source[v], v < 5 ? v : -1);
    assert_int_not_equal(vertex_at(&made.mesh, 0.5f, 0.5f, 0), UINT32_MAX);
    mesh_free(&made.mesh);
}

TEST(attributes_and_ids_follow_their_vertices) {
    static const char ply[] =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "property float wet\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "9 9 9 7\n0 0 0 1\n2 0 0 3\n0 1 0 5\n8 8 8 8\n3 1 2 3\n";
    OWNED(polygons_free) Polygons polygons;
    Made made;
    MeshOptions options = mesh_default_options();

    assert_int_equal(
        ply_read("a.ply", (const uint8_t *)ply, sizeof ply - 1, (SingeAllocator){0}, &polygons, &made.error), SINGE_OK);
    assert_int_equal(
        mesh_make("a.ply", &polygons, &options, (SingeAllocator){0}, &made.mesh, &made.report, &made.error), SINGE_OK);

    static const int32_t source[] = {1, 2, 3, -1};
    static const float wet[] = {1, 3, 5, 4};

    assert_memory_equal(made.mesh.source, source, sizeof source);
    assert_int_equal(made.mesh.attribute_count, 1);
    assert_memory_equal(made.mesh.attributes[0].values, wet, sizeof wet);
    assert_int_equal(made.mesh.source_count, 5);
    mesh_free(&made.mesh);
}

// A mesh numbered at random is numbered row by row, and keeps the file's numbers beside.
TEST(shuffled_meshes_are_put_in_order) {
    enum { N = 24, VERTICES = (N + 1) * (N + 1) };
    static int to[VERTICES], from[VERTICES];
    uint32_t random = 99;
    for (int v = 0; v < VERTICES; v++) {
        random = random * 1664525u + 1013904223u;
        int other = (int)((random >> 8) % (uint32_t)(v + 1));
        to[v] = to[other], to[other] = v;
    }

    for (int v = 0; v < VERTICES; v++) from[to[v]] = v;
    text.size = 0;
    for (int v = 0; v < VERTICES; v++)
        text_add(&text, "v %.6g %.6g 0\n", 0.01 * (from[v] % (N + 1)), 0.01 * (from[v] / (N + 1)));

    for (int c = 0; c < N * N; c++) {
        int cell = c * 7 % (N * N), a = cell / N * (N + 1) + cell % N;
        text_add(&text, "f %d %d %d\n", to[a] + 1, to[a + 1] + 1, to[a + N + 2] + 1);
        text_add(&text, "f %d %d %d\n", to[a] + 1, to[a + N + 2] + 1, to[a + N + 1] + 1);
    }

    Made made = make(&text);
    const Mesh *mesh = &made.mesh;
    assert_int_equal(mesh->cell_count, N * N);
    assert_squares(mesh, 0.01f);

    uint32_t beside = 0;
    for (uint32_t i = 0; i < 4 * mesh->cell_count; i++) {
        uint32_t a = mesh->cells[i], b = mesh->cells[i / 4 * 4 + (i + 1) % 4];
        beside += a + 1 == b || b + 1 == a;
    }

    assert_int_equal(beside, 2 * N * N); // every row's sides
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = mesh->positions + 3 * v;
        int file = mesh->source[v];
        assert_float_equal(p[0], 0.01 * (from[file] % (N + 1)), 1e-6);
        assert_float_equal(p[1], 0.01 * (from[file] / (N + 1)), 1e-6);
        assert_int_equal(mesh->became[file], v);
    }

    mesh_free(&made.mesh);
}

TEST(other_formats_are_made_too) {
    static const char stl[] =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\n"
        "endfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid a\n";
    Polygons polygons;
    SingeError error;
    SingeResult result =
        polygons_read("a.stl", (const uint8_t *)stl, sizeof stl - 1, (SingeAllocator){0}, &polygons, &error);

    if (result) fail_msg("%s", error.message);
    assert_int_equal(polygons.face_count, 2);

    Mesh mesh;
    MeshReport report;
    MeshOptions options = mesh_default_options();
    assert_int_equal(mesh_make("a.stl", &polygons, &options, (SingeAllocator){0}, &mesh, &report, &error), SINGE_OK);
    assert_int_equal(mesh.cell_count, 1);
    assert_int_equal(mesh.vertex_count, 4);
    mesh_free(&mesh);
    polygons_free(&polygons);

    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 .5 0\nf 1 2 3 4\nf 2 5 3\n";
    result = polygons_read("a.obj", (const uint8_t *)obj, sizeof obj - 1, (SingeAllocator){0}, &polygons, &error);
    if (result) fail_msg("%s", error.message);
    assert_int_equal(polygons.face_count, 2);
    assert_int_equal(polygons.corner_count, 7); // quads stay quads

    polygons_free(&polygons);
    assert_int_equal(
        polygons_read("a.glb", (const uint8_t *)obj, sizeof obj - 1, (SingeAllocator){0}, &polygons, &error),
        SINGE_ERROR_FORMAT);
    assert_non_null(strstr(error.message, "a.glb"));
}

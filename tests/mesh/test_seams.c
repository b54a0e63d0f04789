// Seams of the uv in the drawn surface: pictures break there, the surface does not.
#include "sample_meshes.h"
#include "common/order.h"

enum { AROUND = 24, ALONG = 16 };
static Text text;

/// A tube of triangles along z whose uv run once around it, so that they break along one line; and across it a second
/// chart begins half way up, whose uv are elsewhere.
static void tube(void) {
    text.size = 0;
    for (int j = 0; j <= ALONG; j++)
        for (int i = 0; i < AROUND; i++) {
            double a = 6.283185307179586 * i / AROUND;
            text_add(&text, "v %.9g %.9g %.9g\n", 0.03 * cos(a), 0.03 * sin(a), 0.008 * j);
        }

    for (int chart = 0; chart < 2; chart++)
        for (int j = 0; j <= ALONG; j++)
            for (int i = 0; i <= AROUND; i++)
                text_add(&text, "vt %.9g %.9g\n", 0.4 * i / AROUND + 0.5 * chart, 0.9 * j / ALONG);

    for (int j = 0; j < ALONG; j++)
        for (int i = 0; i < AROUND; i++) {
            int a = j * AROUND + i + 1, b = j * AROUND + (i + 1) % AROUND + 1, c = b + AROUND, d = a + AROUND;
            int chart = j >= ALONG / 2 ? (AROUND + 1) * (ALONG + 1) : 0;
            int ta = chart + j * (AROUND + 1) + i + 1, tb = ta + 1, td = ta + AROUND + 1, tc = td + 1;
            text_add(&text, "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, ta, b, tb, c, tc, a, ta, c, tc, d, td);
        }
}

/// With its seams, or as a tube whose vertices have one uv each.
static SingeSim *tube_sim(float detail, bool seams) {
    tube();
    Made made = make(&text);
    assert_int_equal(made.mesh.cell_count, AROUND * ALONG);
    assert_int_equal(made.report.seam_vertices, ALONG + 1 + AROUND - 1);
    assert_non_null(made.mesh.corner_uv);

    SingeSimDef def = singe_default_sim();
    def.surface_detail = detail;
    def.time_step = 0.01f;
    def.pace = 4;
    def.gravity[2] = 0; // it stays at the source

    SingeSim *sim;
    assert_int_equal(singe_sim_create(&def, &sim, NULL), SINGE_OK);

    SingeSheetDef sheet = singe_default_sheet();
    sheet.vertex_count = made.mesh.vertex_count, sheet.positions = made.mesh.positions;
    sheet.cell_count = made.mesh.cell_count, sheet.cells = made.mesh.cells;
    sheet.uv = made.mesh.uv, sheet.corner_uv = seams ? made.mesh.corner_uv : NULL;
    sheet.material.fibre_shrink = singe_param(1); // else the directions of the uv matter

    SingeSheetId id;
    if (singe_sim_add_sheet(sim, &sheet, &id) || singe_sim_commit(sim)) fail_msg("%s", singe_sim_error(sim)->message);
    mesh_free(&made.mesh);

    SingeSourceDef source = singe_default_source();
    const SingePoseKey at = {0, {0.03f, 0, 0.064f}, {0, 0, 0, 1}};
    SingeSourceId source_id;

    source.kind = SINGE_SOURCE_SPOT, source.path_count = 1, source.path = &at;
    source.radius = 0.012f, source.falloff = 0.003f, source.temperature = 2000, source.conductance = 3000;
    if (singe_sim_add_source(sim, &source, &source_id)) fail_msg("%s", singe_sim_error(sim)->message);
    return sim;
}

/// The uv that a point of the tube has at rest, apart from the chart: those between the seams are exact.
static void check_uv(const SingeSurface *surface) {
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        float low[2] = {9, 9}, high[2] = {-9, -9}, z = 0;
        for (int k = 0; k < 3; k++) {
            uint32_t v = surface->triangles[t][k];
            assert_true(v < surface->vertex_count);
            z += surface->rest_position[v][2] / 3;
            for (int c = 0; c < 2; c++) {
                low[c] = fminf(low[c], surface->uv[v][c]);
                high[c] = fmaxf(high[c], surface->uv[v][c]);
            }
        }

        bool upper = z > 0.064f;
        assert_true(high[0] - low[0] < 0.4f / AROUND + 1e-4f);
        assert_true(high[1] - low[1] < 0.9f / ALONG + 1e-4f);
        assert_true(upper ? low[0] > 0.499f : high[0] < 0.401f);

        for (int k = 0; k < 3; k++) {
            uint32_t v = surface->triangles[t][k];
            const float *p = surface->rest_position[v];
            float angle = atan2f(p[1], p[0]) / 6.2831853f, u = (surface->uv[v][0] - (upper ? 0.5f : 0)) / 0.4f;
            assert_float_equal(surface->uv[v][1], 0.9f * p[2] / 0.128f, 2e-4f);
            assert_float_equal(remainderf(u - angle, 1), 0, 0.003f);
        }
    }
}

typedef struct Position {
    float at[3];
    uint32_t vertex;
} Position;

static int by_position(const void *a, const void *b) { return memcmp(a, b, sizeof(float[3])); }

typedef struct Edge {
    uint32_t low, high;
} Edge;

/// The number of edges of one triangle alone, after vertices at exactly the same position are merged.
static int open_edges(const SingeSurface *surface) {
    uint32_t vertices = surface->vertex_count, edges = 3 * surface->triangle_count;
    Position *positions = calloc(vertices, sizeof *positions);
    uint32_t *one = calloc(vertices, sizeof *one);
    Edge *edge = calloc(edges, sizeof *edge);

    for (uint32_t v = 0; v < vertices; v++) {
        memcpy(positions[v].at, surface->position[v], sizeof positions[v].at);
        positions[v].vertex = v;
    }

    qsort(positions, vertices, sizeof *positions, by_position);
    for (uint32_t i = 0, number = 0; i < vertices; i++) {
        if (i && by_position(&positions[i], &positions[i - 1]) != 0) number++;
        one[positions[i].vertex] = number;
    }

    for (uint32_t e = 0; e < edges; e++) {
        uint32_t a = one[surface->triangles[e / 3][e % 3]], b = one[surface->triangles[e / 3][(e + 1) % 3]];
        edge[e] = (Edge){a < b ? a : b, a < b ? b : a};
    }

    qsort(edge, edges, sizeof *edge, order_by_two);
    int open = 0;
    for (uint32_t e = 0, size; e < edges; e += size) {
        for (size = 1; e + size < edges && order_by_two(&edge[e], &edge[e + size]) == 0; size++) {
        }
        open += size == 1;
    }

    free(positions), free(one), free(edge);
    return open;
}

TEST(seams_open_no_cracks) {
    for (int fine = 0; fine < 2; fine++) {
        SingeSim *sim = tube_sim(fine ? 0.0008f : 0, true), *plain = tube_sim(fine ? 0.0008f : 0, false);
        SingeSurface surface = {0}, whole = {0};
        assert_int_equal(singe_sim_surface(sim, &surface), SINGE_OK);
        assert_int_equal(surface.triangle_count, 4 * AROUND * ALONG);

        // one more on every seam vertex, two more where seams cross
        assert_int_equal(surface.vertex_count, AROUND * (ALONG + 1) + AROUND * ALONG + (ALONG + 1) + AROUND + 1);
        assert_int_equal(open_edges(&surface), 2 * AROUND);
        check_uv(&surface);

        int burnt = 0;
        for (int frame = 0; frame < 60 && burnt < 8; frame++) {
            for (int s = 0; s < 5; s++)
                if (singe_sim_step(sim) || singe_sim_step(plain)) fail_msg("%s", singe_sim_error(sim)->message);
            assert_int_equal(singe_sim_surface(sim, &surface), SINGE_OK);
            assert_int_equal(singe_sim_surface(plain, &whole), SINGE_OK);
            check_uv(&surface);

            // the same surface, with copies of vertices
            assert_int_equal(surface.triangle_count, whole.triangle_count);
            assert_int_equal(open_edges(&surface), open_edges(&whole));
            for (uint32_t i = 0; i < 3 * surface.triangle_count; i++) {
                uint32_t a = surface.triangles[i / 3][i % 3], b = whole.triangles[i / 3][i % 3];
                assert_memory_equal(surface.position[a], whole.position[b], sizeof surface.position[a]);
                assert_int_equal(surface.source_vertex[a], whole.source_vertex[b]);
            }

            burnt += open_edges(&surface) > 2 * AROUND;
        }

        assert_int_equal(burnt, 8);
        singe_surface_free(&surface), singe_surface_free(&whole);
        singe_sim_destroy(sim), singe_sim_destroy(plain);
    }
}

// A file that has two vertices at each position of a seam gets both numbers back, each with its uv.
TEST(seams_keep_their_vertices) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv .01 0 0\nv .01 .01 0\nv 0 .01 0\nv .01 0 0\nv .02 0 0\nv .02 .01 0\nv .01 .01 0\n"
                    "vt 0 0\nvt .4 0\nvt .4 1\nvt 0 1\nvt .6 0\nvt 1 0\nvt 1 1\nvt .6 1\n"
                    "f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n");
    Made made = make(&text);
    assert_int_equal(made.mesh.vertex_count, 6);

    SingeSim *sim;
    SingeSimDef def = singe_default_sim();
    SingeSheetId id;
    assert_int_equal(singe_sim_create(&def, &sim, NULL), SINGE_OK);

    SingeSheetDef sheet = singe_default_sheet();
    sheet.vertex_count = 6, sheet.positions = made.mesh.positions, sheet.cell_count = 2, sheet.cells = made.mesh.cells;
    sheet.uv = made.mesh.uv, sheet.corner_uv = made.mesh.corner_uv, sheet.source_vertex = made.mesh.source;
    sheet.source_count = made.mesh.source_count, sheet.corner_source_vertex = made.mesh.corner_source;
    for (int i = 0; i < 2; i++) // of the second sheet they count on
        if (singe_sim_add_sheet(sim, &sheet, &id)) fail_msg("%s", singe_sim_error(sim)->message);
    if (singe_sim_commit(sim)) fail_msg("%s", singe_sim_error(sim)->message);
    mesh_free(&made.mesh);

    OwnSurface surface = {0};
    assert_int_equal(singe_sim_surface(sim, &surface), SINGE_OK);
    assert_int_equal(surface.vertex_count, 2 * (8 + 2));

    static const float u[] = {0, 0.4f, 0.4f, 0, 0.6f, 1, 1, 0.6f};
    uint32_t seen = 0;
    for (uint32_t v = 0; v < surface.vertex_count; v++) {
        int32_t number = surface.source_vertex[v];
        if (number < 0) continue;
        assert_false(seen & 1u << number);
        seen |= 1u << number;
        assert_true(surface.uv[v][0] == u[number % 8]);
        assert_int_equal(surface.sheet[v], number / 8);
    }

    assert_int_equal(seen, 0xffff);
    singe_sim_destroy(sim);
}

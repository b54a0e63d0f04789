// Random polygons become a sheet that the library accepts, or are refused with a reason.
#include "sample_meshes.h"

static uint32_t random_state;

static uint32_t below(uint32_t count) {
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 8) % count;
}

/// Faces between random vertices, some of which lie at one position or on one line.
static void random_polygons(Text *text) {
    uint32_t vertices = 3 + below(14), faces = 1 + below(24), grid = 1 + below(4);
    bool uv = below(2);

    text->size = 0;
    for (uint32_t v = 0; v < vertices; v++)
        text_add(text, "v %g %g %g\n", below(3 * grid) / (double)grid, below(3 * grid) / (double)grid,
                 below(3) ? 0 : below(100) * 0.01);
    for (uint32_t t = 0; uv && t < 5; t++) text_add(text, "vt %g %g\n", below(10) * 0.1, below(10) * 0.1);

    for (uint32_t f = 0; f < faces; f++) {
        uint32_t corners = 3 + below(below(3) ? 2 : 5);
        text_add(text, "f");
        for (uint32_t k = 0; k < corners; k++) {
            text_add(text, " %u", 1 + below(vertices));
            if (uv) text_add(text, "/%u", 1 + below(5));
        }
        text_add(text, "\n");
    }
}

/// A grid of triangles with random holes, faces turned over, doubled faces, and moved vertices.
static void broken_grid(Text *text) {
    int n = 2 + (int)below(7), m = 2 + (int)below(7);
    double shake = below(3) * 0.004;

    text->size = 0;
    for (int j = 0; j <= m; j++)
        for (int i = 0; i <= n; i++)
            text_add(text, "v %g %g %g\n", 0.01 * i + shake * (below(200) / 100.0 - 1),
                     0.01 * j + shake * (below(200) / 100.0 - 1), below(8) ? 0 : 0.005);

    for (int c = 0; c < n * m; c++) {
        int a = c / n * (n + 1) + c % n + 1, at[4] = {a, a + 1, a + n + 2, a + n + 1}, s = (int)below(2);
        if (below(9) == 0) continue;

        for (int times = below(12) ? 1 : 2; times > 0; times--) {
            if (below(5) == 0) text_add(text, "f %d %d %d %d\n", at[0], at[1], at[2], at[3]);
            else if (below(9) == 0)
                text_add(text, "f %d %d %d\nf %d %d %d\n", at[2], at[1], at[0], at[0], at[2], at[3]);
            else
                text_add(text, "f %d %d %d\nf %d %d %d\n", at[s], at[s + 1], at[s + 2], at[s], at[s + 2],
                         at[(s + 3) & 3]);
        }
    }

    text_add(text, "f 1 2 %d\n", n + 2);
}

static bool library_takes(const Made *made) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;
    SingeSheetId id;
    SingeSheetDef sheet = singe_default_sheet();

    assert_int_equal(singe_sim_create(&def, &sim, NULL), SINGE_OK);
    sheet.vertex_count = made->mesh.vertex_count, sheet.positions = made->mesh.positions;
    sheet.cell_count = made->mesh.cell_count, sheet.cells = made->mesh.cells;
    sheet.uv = made->mesh.uv, sheet.corner_uv = made->mesh.corner_uv;
    sheet.source_vertex = made->mesh.source, sheet.source_count = made->mesh.source ? made->mesh.source_count : 0;
    bool taken = !singe_sim_add_sheet(sim, &sheet, &id) && !singe_sim_commit(sim);

    // a crumpled one may be too thick for its curvature, which is no fault of its faces
    if (!taken) taken = strstr(singe_sim_error(sim)->message, "has no length") != NULL;
    if (!taken) print_message("%s\n", singe_sim_error(sim)->message);
    singe_sim_destroy(sim);
    return taken;
}

TEST(random_meshes_are_refused_or_sound) {
    static Text text;
    int refused = 0, made_sheets = 0;
    for (uint32_t seed = 0; seed < 2000; seed++) {
        random_state = seed * 7919u + 1;
        if (seed & 1) broken_grid(&text);
        else random_polygons(&text);
        MeshOptions options = mesh_default_options();
        if (seed % 5 == 4) options.quads = SINGE_MESH_SPLIT;

        Made made = make_with(&text, options);
        if (made.result) {
            assert_int_equal(made.result, SINGE_ERROR_MESH);
            assert_true(made.error.message[0] != 0);
            assert_null(made.mesh.positions);
            refused++;
            continue;
        }

        if (!library_takes(&made)) fail_msg("seed %u:\n%s", seed, text.bytes);
        mesh_free(&made.mesh);
        made_sheets++;
    }

    print_message("%d made, %d refused\n", made_sheets, refused);
    assert_true(made_sheets > 1000);
}

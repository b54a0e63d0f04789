// singe/mesh.h and the named materials as callers use them: with the public headers alone.
#include "support/support.h"

// two triangles and a pentagon beside them, and a vertex of no face
static const float positions[] = {0,    0, 0, 0.1f,  0,     0, 0.1f, 0.1f, 0, 0, 0.1f, 0,
                                  0.2f, 0, 0, 0.25f, 0.05f, 0, 0.2f, 0.1f, 0, 9, 9,    9};
static const uint32_t sizes[] = {3, 3, 5}, corners[] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 6, 2};
static const float uv[] = {0, 0, 0.4f, 0, 0.4f, 1, 0, 1, 0.8f, 0, 1, 0.5f, 0.8f, 1, 0, 0};

static SingeMeshDef house(void) {
    SingeMeshDef def = singe_default_mesh();
    def.vertex_count = 8, def.positions = positions;
    def.face_count = 3, def.face_sizes = sizes, def.corners = corners;
    def.uv = uv;
    return def;
}

static double area_of(const SingeMeshView *view) {
    double area = 0;
    for (uint32_t c = 0; c < view->cell_count; c++) {
        const float *p[4];
        for (int i = 0; i < 4; i++) p[i] = view->positions + 3 * (size_t)view->cells[4 * c + (uint32_t)i];
        area += 0.5 * (double)((p[2][0] - p[0][0]) * (p[3][1] - p[1][1]) - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]));
    }

    return area;
}

static void burn(const SingeMesh *mesh, uint32_t held) {
    SingeSimDef def = singe_default_sim();
    SingeSheetDef sheet = singe_default_sheet();
    SingePinDef pin = singe_default_pin();

    singe_mesh_fill_sheet(mesh, &sheet);
    pin.vertex_count = 1, pin.vertices = &held;

    OwnSim *sim = test_create(&def);
    test_ok(sim, singe_sim_add_sheet(sim, &sheet, &pin.sheet));
    test_add_pin(sim, &pin);
    test_ok(sim, singe_sim_commit(sim));
    test_steps(sim, 10);
    assert_true(singe_sim_view(sim).particle_flags[held] & SINGE_PINNED);
    assert_true(singe_sim_stats(sim).particles > 8);
}

TEST(polygons_become_a_sheet) {
    static const SingeMeshQuads ways[] = {SINGE_MESH_PAIR, SINGE_MESH_SPLIT};
    for (int k = 0; k < 2; k++) {
        SingeMeshDef def = house();
        SingeMesh *mesh;
        SingeError error;
        def.quads = ways[k];
        if (singe_mesh_create(&def, &mesh, &error)) fail_msg("%s", error.message);

        SingeMeshView view = singe_mesh_view(mesh);
        assert_int_equal(view.struct_size, sizeof view);
        assert_true(fabs(area_of(&view) - 0.0225) < 1e-7);
        assert_true(view.cell_count >= 3);
        assert_int_equal(singe_mesh_vertex(mesh, 7), UINT32_MAX); // of no face
        assert_int_equal(singe_mesh_vertex(mesh, 8), UINT32_MAX);

        for (uint32_t v = 0; v < 7; v++) {
            uint32_t now = singe_mesh_vertex(mesh, v);
            assert_memory_equal(view.positions + 3 * (size_t)now, positions + 3 * (size_t)v, 3 * sizeof(float));
            assert_memory_equal(view.uv + 2 * (size_t)now, uv + 2 * (size_t)v, 2 * sizeof(float));
        }

        burn(mesh, singe_mesh_vertex(mesh, 0));
        singe_mesh_destroy(mesh);
    }
}

/// Quads without faults come out as they went in.
TEST(quads_stay) {
    const uint32_t four[] = {4}, quad[] = {0, 1, 2, 3};
    SingeMeshDef def = house();
    SingeMesh *mesh;

    def.vertex_count = 4, def.face_count = 1, def.face_sizes = four, def.corners = quad, def.uv = NULL;
    assert_int_equal(singe_mesh_create(&def, &mesh, NULL), SINGE_OK);

    SingeMeshView view = singe_mesh_view(mesh);
    assert_int_equal(view.vertex_count, 4);
    assert_memory_equal(view.positions, positions, 12 * sizeof(float));
    assert_memory_equal(view.cells, quad, sizeof quad);

    assert_null(view.uv);
    assert_null(view.source_vertex);
    assert_int_equal(singe_mesh_vertex(mesh, 3), 3);
    assert_int_equal(singe_mesh_vertex(mesh, 4), UINT32_MAX);
    singe_mesh_destroy(mesh);
    singe_mesh_destroy(NULL);
}

static void refused(const SingeMeshDef *def, SingeResult expected, int64_t element, const char *part) {
    SingeMesh *mesh = (SingeMesh *)1;
    SingeError error = {0};
    assert_int_equal(singe_mesh_create(def, &mesh, &error), expected);
    assert_null(mesh);
    assert_int_equal(error.code, expected);
    assert_int_equal(error.element, element);
    if (!strstr(error.message, part)) fail_msg("\"%s\" is not in \"%s\"", part, error.message);
    assert_int_equal(singe_mesh_create(def, &mesh, NULL), expected);
}

TEST(bad_meshes_are_refused) {
    float broken[24];
    const uint32_t thin[] = {3, 2, 5}, far[] = {0, 1, 2, 0, 2, 30, 1, 4, 5, 6, 2};
    SingeMeshDef def = house();
    def.struct_size = 0;
    refused(&def, SINGE_ERROR_ARGUMENT, -1, "singe_default_mesh()");
    refused(NULL, SINGE_ERROR_ARGUMENT, -1, "singe_default_mesh()");

    def = house(), def.positions = NULL;
    refused(&def, SINGE_ERROR_ARGUMENT, -1, "NULL");
    def = house(), def.face_count = 0;
    refused(&def, SINGE_ERROR_MESH, -1, "no faces");
    def = house(), def.face_sizes = thin;
    refused(&def, SINGE_ERROR_MESH, 1, "2 corners");
    def = house(), def.corners = far, def.name = "cape";
    refused(&def, SINGE_ERROR_MESH, 5, "cape: a face uses vertex 30 of 8");
    memcpy(broken, positions, sizeof broken);

    broken[4] = NAN;
    def = house(), def.positions = broken;
    refused(&def, SINGE_ERROR_MESH, 1, "not finite");
    memcpy(broken, uv, sizeof uv);

    broken[0] = INFINITY;
    def = house(), def.uv = broken;
    refused(&def, SINGE_ERROR_MESH, 0, "uv");
    def = house(), def.quads = (SingeMeshQuads)7;
    refused(&def, SINGE_ERROR_ARGUMENT, -1, "quads");
    def = house(), def.attribute_count = 1;
    refused(&def, SINGE_ERROR_ARGUMENT, -1, "attributes");
}

TEST(grids_are_meshes) {
    SingeGridDef def = singe_default_grid();
    SingeMesh *mesh;
    SingeError error;

    def.cells[0] = 8, def.cells[1] = 5, def.size[0] = 0.16f, def.size[1] = 0.1f;
    assert_int_equal(singe_mesh_create_grid(&def, &mesh, &error), SINGE_OK);

    SingeMeshView view = singe_mesh_view(mesh);
    assert_int_equal(view.vertex_count, 54);
    assert_int_equal(view.cell_count, 40);
    assert_true(fabs(area_of(&view) - 0.016) < 1e-7);
    burn(mesh, 3);
    singe_mesh_destroy(mesh);

    def.struct_size = 0;
    assert_int_equal(singe_mesh_create_grid(&def, &mesh, &error), SINGE_ERROR_ARGUMENT);
}

TEST(every_allocation_fails_once) {
    SingeMeshDef def = house();
    SingeMesh *mesh;
    test_allocations_fail(5, (def.allocator = allocator, singe_mesh_create(&def, &mesh, NULL)),
                          singe_mesh_destroy(mesh));
    assert_non_null(mesh);
}

/// An older header has a shorter Def, a newer one a longer.
TEST(defs_may_be_of_other_versions) {
    struct {
        SingeMeshDef def;
        char more[64];
    } newer;

    SingeMesh *mesh;
    memset(&newer, 0x55, sizeof newer);
    singe_init_mesh(&newer.def, sizeof newer);

    SingeMeshDef def = house();
    memcpy(&newer.def, &def, sizeof def);
    newer.def.struct_size = sizeof newer;
    assert_int_equal(newer.more[63], 0);
    assert_int_equal(singe_mesh_create(&newer.def, &mesh, NULL), SINGE_OK);
    singe_mesh_destroy(mesh);
    def.struct_size = offsetof(SingeMeshDef, quads);
    def.quads = (SingeMeshQuads)99; // not known then
    assert_int_equal(singe_mesh_create(&def, &mesh, NULL), SINGE_OK);

    SingeMeshView view;
    memset(&view, 0x55, sizeof view);
    singe_mesh_read(mesh, &view, offsetof(SingeMeshView, cells));
    assert_int_equal(view.struct_size, offsetof(SingeMeshView, cells));
    assert_non_null(view.positions);
    assert_int_equal(((unsigned char *)&view)[offsetof(SingeMeshView, cells)], 0x55);
    singe_mesh_destroy(mesh);
}

static void collect(void *context, SingeLogLevel level, const char *line) {
    (void)level;
    char *text = context;
    assert_true(strlen(text) + strlen(line) < 500);
    strcat(strcat(text, line), "\n");
}

TEST(repairs_are_logged) {
    char text[512] = "";
    SingeMeshDef def = house();
    SingeMesh *mesh;
    def.log = (SingeLog){collect, text};
    assert_int_equal(singe_mesh_create(&def, &mesh, NULL), SINGE_OK);
    assert_non_null(strstr(text, "8 vertices, 2 triangles, 0 quads, 1 polygons, 1 component\n"));
    assert_non_null(strstr(text, "1 unused vertex left out"));
    singe_mesh_destroy(mesh);
}

TEST(materials_have_names) {
    SingeMaterialDef def = singe_default_material();
    SingeError error = {0};
    uint32_t count = 0;

    for (const char *name; (name = singe_material_preset_name(count)); count++)
        assert_int_equal(singe_material_preset(name, &def, NULL), SINGE_OK);
    assert_int_equal(count, 5);
    assert_null(singe_material_preset_name(UINT32_MAX));
    assert_int_equal(singe_material_preset("cotton", &def, &error), SINGE_OK);
    assert_true(def.struct_size == sizeof def && def.grammage.value == 0.12f && def.fibre_shrink.value == 1);
    assert_true(def.compliance[SINGE_GREEN].value == 0.5f && def.char_strength.to == 20);
    assert_true(def.char_strength.field->kind == SINGE_FIELD_NOISE && def.char_strength.field->noise.seed == 3);

    SingeMaterialDef before = def;
    assert_int_equal(singe_material_preset("silk", &def, &error), SINGE_ERROR_ARGUMENT);
    assert_memory_equal(&before, &def, sizeof def);
    assert_non_null(strstr(error.message, "cotton, newsprint, office-paper, one-reaction, tissue"));
    assert_int_equal(singe_material_preset(NULL, &def, &error), SINGE_ERROR_ARGUMENT);
    def.struct_size = 0;
    assert_int_equal(singe_material_preset("cotton", &def, &error), SINGE_ERROR_ARGUMENT);
}

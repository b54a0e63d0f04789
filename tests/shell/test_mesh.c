// Meshes that are refused, each with its code and its position.

#include "sample_shells.h"

/// Makes the source and the shell; checks code and element of the failure, the sheet's name in the
/// message, and that nothing is left allocated.
static void refuse_def(const SingeSheetDef *def, SingeResult code, int64_t element, const char *says) {
    Memory memory = memory_make((SingeAllocator){0});
    SheetSource source;
    Shell shell;
    SingeError error = {0};
    SingeResult result = sheet_source_create(&memory, def, &source, &error);

    if (result == SINGE_OK) {
        result = shell_create(&memory, &source, 1, &shell, &error);
        sheet_source_free(&memory, &source);
    }

    assert_int_equal(result, code);
    assert_int_equal(error.code, code);
    assert_int_equal(error.element, element);
    assert_string_equal(error.stage, "sheet");
    if (!strstr(error.message, says) || (def->name && !strstr(error.message, def->name))) fail_msg("%s", error.message);
    assert_int_equal(memory.held, 0);
}

static void refuse(QuadMesh *mesh, SingeResult code, int64_t element, const char *says) {
    SingeSheetDef def = mesh_sheet(mesh);
    def.name = "rag";
    refuse_def(&def, code, element, says);
    mesh_release(mesh);
}

TEST(a_moebius_strip_is_refused) {
    QuadMesh mesh = mesh_moebius(12);
    refuse(&mesh, SINGE_ERROR_MESH, 11, "is flipped");
}

TEST(a_turned_cell_is_refused) {
    QuadMesh mesh = mesh_grid(3, 3, 1, 1);
    uint32_t *cell = mesh.cells[4], swap = cell[1];
    cell[1] = cell[3], cell[3] = swap;
    refuse(&mesh, SINGE_ERROR_MESH, 4, "vertex 6 to 5"); // its edge with cell 1, the first in order of vertices
}

// Three pages bound at the edge 0-1.
TEST(three_cells_at_an_edge_are_refused) {
    QuadMesh mesh = {0};
    for (int k = 0; k < 2; k++) mesh_add_vertex(&mesh, 0, (float)k, 0);
    for (int page = 0; page < 3; page++)
        for (int k = 0; k < 2; k++)
            mesh_add_vertex(&mesh, cosf(2.0f * (float)page), (float)k, sinf(2.0f * (float)page));
    mesh_add_cell(&mesh, 0, 1, 3, 2);
    mesh_add_cell(&mesh, 1, 0, 4, 5);
    mesh_add_cell(&mesh, 0, 1, 7, 6);
    refuse(&mesh, SINGE_ERROR_MESH, 2, "more than two cells");
}

// Two cells that share only vertex 4.
TEST(a_bow_tie_is_refused) {
    QuadMesh mesh = mesh_grid(2, 2, 1, 1);
    memcpy(mesh.cells[1], mesh.cells[3], sizeof mesh.cells[1]);
    mesh.cell_count = 2;
    refuse(&mesh, SINGE_ERROR_MESH, 4, "not in one fan");
}

// Two closed surfaces that touch in a vertex have no boundary to betray them.
TEST(touching_spheres_are_refused) {
    QuadMesh mesh = mesh_sphere(2), other = mesh_sphere(2);
    uint32_t first = mesh.vertex_count, touch = 3;
    for (uint32_t v = 0; v < other.vertex_count; v++)
        mesh_add_vertex(&mesh, other.position[v][0] + 5, other.position[v][1], other.position[v][2]);

    for (uint32_t c = 0; c < other.cell_count; c++) {
        uint32_t k[4];
        for (int i = 0; i < 4; i++) k[i] = other.cells[c][i] == touch ? touch : first + other.cells[c][i];
        mesh_add_cell(&mesh, k[0], k[1], k[2], k[3]);
    }

    mesh_release(&other);
    refuse(&mesh, SINGE_ERROR_MESH, 3, "not in one fan");
}

// The element is the second sheet's own, not the shell's.
TEST(errors_name_the_element_within_its_sheet) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnQuadMesh good = mesh_grid(3, 3, 1, 1), bad = mesh_grid(2, 2, 1, 1);
    memcpy(bad.cells[1], bad.cells[3], sizeof bad.cells[1]);
    bad.cell_count = 2;
    SingeSheetDef defs[2] = {mesh_sheet(&good), mesh_sheet(&bad)};
    defs[0].name = "good", defs[1].name = "bad";

    SheetSource sources[2];
    Shell shell;
    SingeError error;
    for (int i = 0; i < 2; i++) assert_int_equal(sheet_source_create(&memory, &defs[i], &sources[i], &error), SINGE_OK);
    assert_int_equal(shell_create(&memory, sources, 2, &shell, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 4);

    assert_non_null(strstr(error.message, "'bad'"));
    for (int i = 0; i < 2; i++) sheet_source_free(&memory, &sources[i]);
    assert_int_equal(memory.held, 0);
}

TEST(bad_numbers_are_refused) {
    static const float bad[] = {NAN, INFINITY, -INFINITY, 1e30f};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        QuadMesh mesh = mesh_grid(3, 2, 1, 1);
        mesh.position[5][i % 3] = bad[i];
        refuse(&mesh, SINGE_ERROR_MESH, 5, "vertex 5");
    }

    QuadMesh mesh = mesh_grid(3, 2, 1, 1);
    float uv[12][2] = {{0}};
    SingeSheetDef def = mesh_sheet(&mesh);
    def.uv = uv[0];
    uv[7][1] = NAN;
    refuse_def(&def, SINGE_ERROR_MESH, 7, "uv");

    mesh_release(&mesh);
    mesh = mesh_grid(3, 2, 1, 1);
    mesh.cells[4][2] = 12;
    refuse(&mesh, SINGE_ERROR_MESH, 4, "vertex 12 of 12");
    mesh = mesh_grid(3, 2, 1, 1);
    mesh.cells[4][2] = UINT32_MAX;
    refuse(&mesh, SINGE_ERROR_MESH, 4, "cell 4");
    mesh = mesh_grid(3, 2, 1, 1);
    mesh.cells[3][2] = mesh.cells[3][0];
    refuse(&mesh, SINGE_ERROR_MESH, 3, "twice");
}

TEST(degenerate_cells_are_refused) {
    QuadMesh mesh = mesh_grid(1, 1, 1, 1);
    memcpy(mesh.position[1], mesh.position[0], sizeof mesh.position[0]);
    refuse(&mesh, SINGE_ERROR_MESH, 0, "side without length");
    mesh = mesh_grid(2, 1, 1, 0);
    refuse(&mesh, SINGE_ERROR_MESH, 0, "side without length");
    mesh = mesh_grid(1, 1, 1, 1); // all on one line
    for (int v = 0; v < 4; v++) mesh.position[v][0] = (float)(v * v), mesh.position[v][1] = 0;
    refuse(&mesh, SINGE_ERROR_MESH, 0, "no area");
    mesh = mesh_grid(1, 1, 1, 1); // crossed: two turns that cancel

    uint32_t *cell = mesh.cells[0], swap = cell[2];
    cell[2] = cell[3], cell[3] = swap;
    refuse(&mesh, SINGE_ERROR_MESH, 0, "no area");
    mesh = mesh_grid(1, 1, 1e-20f, 1e-20f);
    refuse(&mesh, SINGE_ERROR_MESH, 0, "outside");

    OwnSample large = sample_open(mesh_grid(1, 1, 1e12f, 1e12f), 0); // but floats hold it
    OwnSample thin = sample_open(mesh_grid(1, 1, 1, 1e-4f), 0);      // but a cell
    (void)large, (void)thin;
}

// A tube as thick as its radius: the centre layer would be a line.
TEST(a_tube_as_thick_as_its_radius_is_refused) {
    OwnQuadMesh mesh = mesh_cylinder(4, 3, 1, 1);
    for (uint32_t c = 0; c < mesh.cell_count; c++) {
        uint32_t swap = mesh.cells[c][1];
        mesh.cells[c][1] = mesh.cells[c][3], mesh.cells[c][3] = swap;
    }

    for (uint32_t v = 0; v < mesh.vertex_count; v++) { // exact corners, so that centres meet exactly
        static const float corner[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
        memcpy(mesh.position[v], corner[v % 4], sizeof corner[0]);
    }

    SingeSheetDef def = mesh_sheet(&mesh);
    def.material.thickness = singe_param(1);
    refuse_def(&def, SINGE_ERROR_MESH, 0, "too thick");
}

TEST(bad_defs_are_refused) {
    QuadMesh mesh = mesh_grid(1, 1, 1, 1);
    SingeSheetDef def = mesh_sheet(&mesh);

    refuse_def(&(SingeSheetDef){0}, SINGE_ERROR_ARGUMENT, -1, "struct_size");
    def.material.struct_size = 0;
    refuse_def(&def, SINGE_ERROR_ARGUMENT, -1, "struct_size");
    def = mesh_sheet(&mesh);
    def.cell_count = 0;
    refuse_def(&def, SINGE_ERROR_MESH, -1, "no cells");
    def = mesh_sheet(&mesh);
    def.cells = NULL;
    refuse_def(&def, SINGE_ERROR_ARGUMENT, -1, "NULL");
    def = mesh_sheet(&mesh);
    def.cell_count = 0x30000000;
    refuse_def(&def, SINGE_ERROR_LIMIT, -1, "too many");
    def = mesh_sheet(&mesh);
    def.vertex_count = 0xFFFFFFFF;
    refuse_def(&def, SINGE_ERROR_LIMIT, -1, "too many");
    def = mesh_sheet(&mesh);
    def.attribute_count = 1;
    refuse_def(&def, SINGE_ERROR_ARGUMENT, -1, "attributes");
    def = mesh_sheet(&mesh);
    def.velocity[1] = NAN;
    refuse_def(&def, SINGE_ERROR_ARGUMENT, -1, "velocity");
    def = mesh_sheet(&mesh);
    def.drop_pieces_below = -1;
    refuse_def(&def, SINGE_ERROR_ARGUMENT, -1, "drop_pieces_below");
    mesh_release(&mesh);

    Memory memory = memory_make((SingeAllocator){0});
    SheetSource source;
    assert_int_equal(sheet_source_create(&memory, NULL, &source, NULL), SINGE_ERROR_ARGUMENT);
}

// More cells around a vertex than a particle's count of springs can hold.
TEST(too_many_cells_at_a_vertex_are_refused) {
    QuadMesh mesh = {0};
    const uint32_t sides = 21845;

    mesh_add_vertex(&mesh, 0, 0, 0);
    for (uint32_t k = 0; k < 2 * sides; k++) {
        double a = 3.14159265358979 * k / sides;
        mesh_add_vertex(&mesh, (float)cos(a), (float)sin(a), 0);
    }

    for (uint32_t s = 0; s < sides; s++) mesh_add_cell(&mesh, 0, 1 + 2 * s, 2 + 2 * s, 1 + (2 * s + 2) % (2 * sides));
    refuse(&mesh, SINGE_ERROR_LIMIT, 0, "21845 cells");
}

static SingeResult build_all(Memory *memory, const SingeSheetDef *def, SingeError *error) {
    SheetSource source;
    Shell shell;
    State start;
    SingeResult result = sheet_source_create(memory, def, &source, error);

    if (result != SINGE_OK) return result;
    result = shell_create(memory, &source, 1, &shell, error);
    if (result == SINGE_OK) {
        result = state_create(memory, &shell, &start);
        if (result == SINGE_OK) state_free(memory, &start);
        shell_free(memory, &shell);
    }

    sheet_source_free(memory, &source);
    return result;
}

// The n-th allocation fails, for every n: the right code, nothing leaked.
TEST(every_allocation_fails_once) {
    OwnQuadMesh mesh = mesh_sphere(3);
    SingeSheetDef def = mesh_sheet(&mesh);
    Memory memory;
    SingeError error;
    test_allocations_fail(100, (memory = memory_make(allocator), build_all(&memory, &def, &error)), (void)0);
}

// Springs, strands and families on meshes whose numbers are known.

#include "sample_shells.h"

/// Expected numbers by colour: red, green, blue, yellow. 0 families stands for any number.
typedef struct Expected {
    uint32_t springs[4], strands[4], rings[4], families[4], cell_families;
} Expected;

/// Takes the mesh.
static void expect(QuadMesh mesh, const char *name, Expected expected) {
    OwnSample sample = sample_open(mesh, 0);
    const Shell *shell = &sample.shell;
    check_shell(shell);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *set = &shell->springs[colour];
        print_message("%-16s colour %d: %5u springs %4u strands %3u rings %2u families, longest %u\n", name, colour,
                      set->count, set->strand_count, count_rings(set), set->family_count, set->longest);
        assert_int_equal(set->count, expected.springs[colour]);
        assert_int_equal(set->strand_count, expected.strands[colour]);
        assert_int_equal(count_rings(set), expected.rings[colour]);
        if (expected.families[colour]) assert_int_equal(set->family_count, expected.families[colour]);
    }

    print_message("%-16s %u families of cells\n", name, shell->cell_family_count);
    if (expected.cell_families) assert_int_equal(shell->cell_family_count, expected.cell_families);
}

/// n x m: n (m + 1) + m (n + 1) edges in n + m + 2 lines, and n + m - 1 diagonals each way.
static Expected grid_expected(uint32_t n, uint32_t m) {
    uint32_t diagonals = 2 * (n + m - 1), green = (m > 1 ? n : 0) + (n > 1 ? m : 0);
    return (Expected){.springs = {4 * n * m, n * (m - 1) + m * (n - 1), n * (m + 1) + m * (n + 1), 2 * n * m},
                      .strands = {diagonals, green, n + m + 2, diagonals},
                      .families = {2, green == n + m ? 2 : green > 0, 2, n * m > 1 ? 2 : 1},
                      .cell_families = n > 1 && m > 1 ? 4
                                       : n * m > 1    ? 2
                                                      : 1};
}

TEST(a_grid_has_straight_strands) {
    static const uint32_t sizes[][2] = {{1, 1}, {2, 2}, {3, 2}, {7, 5}, {5, 7}, {20, 20}, {31, 8}, {1, 9}, {9, 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        uint32_t n = sizes[i][0], m = sizes[i][1];
        expect(mesh_grid(n, m, 0.01f, 0.02f), "grid", grid_expected(n, m));
    }
}

// The families do not depend on how vertices and cells are numbered.
TEST(families_do_not_depend_on_numbering) {
    for (uint32_t seed = 1; seed < 4; seed++) {
        QuadMesh mesh = mesh_grid(14, 11, 0.01f, 0.01f);
        mesh_shuffle(&mesh, seed);
        Expected expected = grid_expected(14, 11);
        expected.cell_families = 0;
        expect(mesh, "shuffled grid", expected);
    }
}

static uint32_t gcd(uint32_t a, uint32_t b) { return b ? gcd(b, a % b) : a; }

// All strands are rings: n + m lines, and gcd(n, m) diagonals each way.
TEST(strands_of_a_torus_are_rings) {
    static const uint32_t sizes[][2] = {{12, 8}, {9, 9}, {13, 7}, {3, 3}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        uint32_t n = sizes[i][0], m = sizes[i][1], d = 2 * gcd(n, m), cells = n * m;
        expect(mesh_torus(n, m), "torus",
               (Expected){.springs = {4 * cells, 2 * cells, 2 * cells, 2 * cells},
                          .strands = {d, n + m, n + m, d},
                          .rings = {d, n + m, n + m, d},
                          .families = {2, 2, 2, 2}});
    }
}

// Two cells around: green rings of two springs between the same centres are cut open into two strands.
TEST(rings_of_two_springs_are_cut) {
    QuadMesh mesh = {0};
    static const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    for (int i = 0; i < 4; i++) mesh_add_vertex(&mesh, square[i][0], square[i][1], 0);
    mesh_add_cell(&mesh, 0, 1, 2, 3);
    mesh_add_cell(&mesh, 0, 3, 2, 1);

    OwnSample sample = sample_open(mesh, 0);
    const Shell *shell = &sample.shell;
    check_shell(shell);
    assert_int_equal(shell->springs[SINGE_GREEN].count, 4);
    assert_int_equal(shell->springs[SINGE_GREEN].strand_count, 4);
    assert_int_equal(shell->springs[SINGE_GREEN].family_count, 4);
    assert_int_equal(shell->springs[SINGE_BLUE].strand_count, 1); // the square's outline
    assert_int_equal(count_rings(&shell->springs[SINGE_BLUE]), 1);
    assert_int_equal(shell->springs[SINGE_BLUE].family_count, 1);
}

TEST(strands_go_around_a_cylinder) {
    // a diagonal climbs one row a cell, so each starts at one of 12 places and goes once up
    expect(mesh_cylinder(12, 5, 0.1f, 0.2f), "cylinder",
           (Expected){.springs = {240, 12 * 4 + 12 * 5, 12 * 6 + 12 * 5, 120},
                      .strands = {24, 12 + 5, 12 + 6, 24},
                      .rings = {0, 5, 6, 0},
                      .families = {2, 2, 2, 2}});
    expect(mesh_cylinder(9, 1, 0.1f, 0.02f), "ring strip",
           (Expected){.springs = {36, 9, 27, 18},
                      .strands = {18, 1, 9 + 2, 18},
                      .rings = {0, 1, 2, 0},
                      .families = {0, 1, 2, 0}});
}

// Eight vertices of valence three: the cube's 12 edges are chains, the other lines go round.
TEST(strands_of_a_cube_sphere_end_at_its_corners) {
    for (uint32_t n = 1; n <= 8; n++) {
        OwnSample sample = sample_open(mesh_sphere(n), 0);
        const Shell *shell = &sample.shell;
        assert_int_equal(shell->vertex_count, 6 * n * n + 2);

        check_shell(shell);

        const SpringSet *green = &shell->springs[SINGE_GREEN], *blue = &shell->springs[SINGE_BLUE];
        assert_int_equal(green->count, 12 * n * n);
        assert_int_equal(green->strand_count, 3 * n);
        assert_int_equal(count_rings(green), 3 * n);
        assert_int_equal(green->longest, 4 * n);
        assert_int_equal(green->family_count, 3); // three ways round, each crosses both others
        assert_int_equal(blue->count, 12 * n * n);
        assert_int_equal(blue->strand_count, 3 * (n - 1) + 12);
        assert_int_equal(count_rings(blue), 3 * (n - 1));

        print_message("sphere %u: families R %u G %u B %u Y %u cells %u\n", n, shell->springs[0].family_count,
                      shell->springs[1].family_count, shell->springs[2].family_count, shell->springs[3].family_count,
                      shell->cell_family_count);
    }
}

// Around a vertex of odd valence all ends; of even valence lines go through.
TEST(strands_end_at_vertices_of_odd_valence) {
    const uint32_t n = 6;
    OwnSample pentagon = sample_open(mesh_polygon(5, n), 0), hexagon = sample_open(mesh_polygon(6, n), 0);
    const Shell *shell = &pentagon.shell;

    check_shell(shell);
    const SpringSet *blue = &shell->springs[SINGE_BLUE], *green = &shell->springs[SINGE_GREEN];
    assert_int_equal(blue->strand_count, 5 + 5 * (n - 1) + 5); // spokes, lines across, sides
    assert_int_equal(green->strand_count, 5 * n);
    assert_int_equal(count_rings(blue) + count_rings(green), 0);
    print_message("pentagon: families R %u G %u B %u Y %u cells %u\n", shell->springs[0].family_count,
                  green->family_count, blue->family_count, shell->springs[3].family_count, shell->cell_family_count);

    shell = &hexagon.shell;
    check_shell(shell);
    assert_int_equal(shell->springs[SINGE_BLUE].strand_count, 3 + 6 * (n - 1) + 6);
    assert_int_equal(shell->springs[SINGE_GREEN].strand_count, 6 * n);
}

// The inner corner has three cells: both boundary lines run on into the mesh.
TEST(strands_run_on_from_an_inner_corner) {
    const uint32_t n = 4;
    const uint32_t cells = 3 * n * n;
    OwnSample sample = sample_open(mesh_ell(n), 0);
    const Shell *shell = &sample.shell;

    check_shell(shell);
    assert_int_equal(shell->springs[SINGE_RED].count, 4 * cells);
    assert_int_equal(shell->springs[SINGE_BLUE].strand_count, 2 * (2 * n + 1));
    assert_int_equal(shell->springs[SINGE_BLUE].count, 2 * ((n + 1) * 2 * n + n * n));
    assert_int_equal(shell->springs[SINGE_BLUE].longest, 2 * n);
    assert_int_equal(shell->springs[SINGE_GREEN].strand_count, 4 * n);

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        assert_int_equal(shell->springs[colour].family_count, 2);
        assert_int_equal(count_rings(&shell->springs[colour]), 0);
    }
}

TEST(components_are_separate) {
    QuadMesh mesh = mesh_grid(5, 4, 0.01f, 0.01f);
    mesh_append_grid(&mesh, 3, 6, 1, 1);
    Expected a = grid_expected(5, 4), b = grid_expected(3, 6);
    for (int colour = 0; colour < 4; colour++) {
        a.springs[colour] += b.springs[colour];
        a.strands[colour] += b.strands[colour];
    }
    expect(mesh, "two components", a);
}

// Two sheets are numbered as one shell: all vertices, then all cells.
TEST(sheets_are_numbered_as_one_shell) {
    Memory memory = memory_make((SingeAllocator){0});
    QuadMesh a = mesh_grid(4, 3, 0.01f, 0.01f), b = mesh_grid(2, 5, 0.03f, 0.03f);
    SingeSheetDef defs[2] = {mesh_sheet(&a), mesh_sheet(&b)};
    defs[0].name = "first", defs[1].name = "second";

    SheetSource sources[2];
    Shell shell;

    for (int i = 0; i < 2; i++) assert_int_equal(sheet_source_create(&memory, &defs[i], &sources[i], NULL), SINGE_OK);
    assert_int_equal(shell_create(&memory, sources, 2, &shell, NULL), SINGE_OK);
    check_shell(&shell);
    assert_int_equal(shell.vertex_count, 20 + 18);
    assert_int_equal(shell.cell_count, 12 + 10);
    assert_int_equal(shell.particle_count, 60);

    assert_string_equal(shell.sheets[1].name, "second");
    assert_int_equal(shell.sheets[1].vertex_first, 20);
    assert_int_equal(shell.sheets[1].cell_first, 12);
    assert_int_equal(shell.cells[12][0], 20 + b.cells[0][0]);

    for (uint32_t p = 0; p < 60; p++) assert_int_equal(shell.matter.sheet[p], p < 38 ? p >= 20 : p >= 38 + 12);
    assert_float_equal(shell.sheets[0].cell_size, 0.01f, 1e-8f);
    assert_float_equal(shell.sheets[1].cell_size, 0.03f, 1e-8f);
    for (int colour = 0; colour < 4; colour++) assert_int_equal(shell.springs[colour].family_count, 2);
    shell_free(&memory, &shell);
    for (int i = 0; i < 2; i++) sheet_source_free(&memory, &sources[i]);
    mesh_release(&a);
    mesh_release(&b);
    assert_int_equal(memory.held, 0);
}

// General meshes: valences from 3 to 8 or so, strands that cross themselves.
TEST(random_meshes_have_valid_strands) {
    for (uint32_t seed = 1; seed <= 12; seed++) {
        QuadMesh mesh = mesh_random(seed, seed);
        if (seed % 2) mesh_shuffle(&mesh, seed);

        OwnSample sample = sample_open(mesh, 0);
        const Shell *shell = &sample.shell;
        check_shell(shell);
        if (seed == 12)
            for (int colour = 0; colour < 4; colour++)
                print_message("random colour %d: %u springs %u strands %u rings %u families, longest %u\n", colour,
                              shell->springs[colour].count, shell->springs[colour].strand_count,
                              count_rings(&shell->springs[colour]), shell->springs[colour].family_count,
                              shell->springs[colour].longest);
    }
}

// A hub of 201 cells: more strands meet than one word of families holds.
TEST(a_hub_has_many_families) {
    OwnSample sample = sample_open(mesh_polygon(201, 1), 0);
    const Shell *shell = &sample.shell;

    check_shell(shell);
    assert_int_equal(shell->springs[SINGE_BLUE].family_count, 201);
    assert_int_equal(shell->springs[SINGE_YELLOW].family_count, 201);
    assert_int_equal(shell->cell_family_count, 201);
}

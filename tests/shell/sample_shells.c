#include "sample_shells.h"

#include "common/random.h"

static const double pi = 3.14159265358979323846;

void mesh_add_vertex(QuadMesh *mesh, float x, float y, float z) {
    if (mesh->vertex_count == mesh->vertex_capacity) {
        mesh->vertex_capacity = mesh->vertex_capacity ? 2 * mesh->vertex_capacity : 64;
        mesh->position = realloc(mesh->position, mesh->vertex_capacity * sizeof *mesh->position);
        assert_non_null(mesh->position);
    }

    float *p = mesh->position[mesh->vertex_count++];
    p[0] = x, p[1] = y, p[2] = z;
}

void mesh_add_cell(QuadMesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    if (mesh->cell_count == mesh->cell_capacity) {
        mesh->cell_capacity = mesh->cell_capacity ? 2 * mesh->cell_capacity : 64;
        mesh->cells = realloc(mesh->cells, mesh->cell_capacity * sizeof *mesh->cells);
        assert_non_null(mesh->cells);
    }

    uint32_t *cell = mesh->cells[mesh->cell_count++];
    cell[0] = a, cell[1] = b, cell[2] = c, cell[3] = d;
}

void mesh_release(QuadMesh *mesh) {
    free(mesh->position);
    free(mesh->cells);
    *mesh = (QuadMesh){0};
}

/// The vertex at a position, added unless one is there already.
static uint32_t vertex_at(QuadMesh *mesh, double x, double y, double z) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = mesh->position[v];
        if (fabs((double)p[0] - x) + fabs((double)p[1] - y) + fabs((double)p[2] - z) < 1e-4) return v;
    }
    mesh_add_vertex(mesh, (float)x, (float)y, (float)z);
    return mesh->vertex_count - 1;
}

/// Adds n x n cells over the quad with the given corners, sharing vertices with the cells that exist.
static void add_patch(QuadMesh *mesh, const double corner[4][3], uint32_t n) {
    for (uint32_t j = 0; j < n; j++) {
        for (uint32_t i = 0; i < n; i++) {
            uint32_t cell[4];
            for (int k = 0; k < 4; k++) {
                double u = (double)(i + (k == 1 || k == 2)) / n, v = (double)(j + (k >= 2)) / n, p[3];
                for (int a = 0; a < 3; a++)
                    p[a] = (1 - v) * ((1 - u) * corner[0][a] + u * corner[1][a]) +
                           v * ((1 - u) * corner[3][a] + u * corner[2][a]);
                cell[k] = vertex_at(mesh, p[0], p[1], p[2]);
            }

            mesh_add_cell(mesh, cell[0], cell[1], cell[2], cell[3]);
        }
    }
}

static void append_grid(QuadMesh *mesh, uint32_t n, uint32_t m, float x, float y, float dx, float dy) {
    uint32_t first = mesh->vertex_count;
    for (uint32_t j = 0; j <= m; j++)
        for (uint32_t i = 0; i <= n; i++) mesh_add_vertex(mesh, x + (float)i * dx, y + (float)j * dy, 0);
    for (uint32_t j = 0; j < m; j++) {
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = first + j * (n + 1) + i;
            mesh_add_cell(mesh, a, a + 1, a + n + 2, a + n + 1);
        }
    }
}

QuadMesh mesh_grid(uint32_t n, uint32_t m, float dx, float dy) {
    QuadMesh mesh = {0};
    append_grid(&mesh, n, m, 0, 0, dx, dy);
    return mesh;
}

void mesh_append_grid(QuadMesh *mesh, uint32_t n, uint32_t m, float x, float y) {
    append_grid(mesh, n, m, x, y, 0.01f, 0.01f);
}

static QuadMesh to_quads(TestMesh from) {
    free(from.uv);
    return (QuadMesh){from.vertex_count,
                      from.cell_count,
                      from.vertex_count,
                      from.cell_count,
                      (float(*)[3])(void *)from.positions,
                      (uint32_t(*)[4])(void *)from.cells};
}

QuadMesh mesh_torus(uint32_t n, uint32_t m) { return to_quads(test_torus(n, m, 1, 0.4f)); }

QuadMesh mesh_cylinder(uint32_t n, uint32_t m, float radius, float height) {
    return to_quads(test_cylinder(n, m, radius, height));
}

QuadMesh mesh_moebius(uint32_t n) {
    QuadMesh mesh = {0};
    for (uint32_t i = 0; i < n; i++) {
        for (int side = -1; side <= 1; side += 2) {
            double a = 2 * pi * i / n, r = 1 + side * 0.2 * cos(a / 2);
            mesh_add_vertex(&mesh, (float)(r * cos(a)), (float)(r * sin(a)), (float)(side * 0.2 * sin(a / 2)));
        }
    }

    for (uint32_t i = 0; i + 1 < n; i++) mesh_add_cell(&mesh, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    mesh_add_cell(&mesh, 2 * n - 2, 1, 0, 2 * n - 1);
    return mesh;
}

QuadMesh mesh_polygon(uint32_t sides, uint32_t n) {
    QuadMesh mesh = {0};
    for (uint32_t s = 0; s < sides; s++) {
        double corner[4][3] = {{0}}, a = 2 * pi / sides, r = cos(a / 2);
        corner[1][0] = r * cos(a * (s - 0.5)), corner[1][1] = r * sin(a * (s - 0.5));
        corner[2][0] = cos(a * s), corner[2][1] = sin(a * s);
        corner[3][0] = r * cos(a * (s + 0.5)), corner[3][1] = r * sin(a * (s + 0.5));
        add_patch(&mesh, corner, n);
    }

    return mesh;
}

QuadMesh mesh_ell(uint32_t n) {
    QuadMesh mesh = {0};
    static const int square[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (int s = 0; s < 3; s++) {
        double x = square[s][0], y = square[s][1];
        const double corner[4][3] = {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}};
        add_patch(&mesh, corner, n);
    }

    return mesh;
}

QuadMesh mesh_sphere(uint32_t n) {
    QuadMesh mesh = {0};
    for (int axis = 0; axis < 3; axis++) {
        for (int side = -1; side <= 1; side += 2) {
            double corner[4][3];
            for (int k = 0; k < 4; k++) {
                double u = k == 1 || k == 2 ? 1 : -1, v = k >= 2 ? 1 : -1;
                corner[k][axis] = side;
                corner[k][(axis + 1) % 3] = u * side; // turned outwards on both sides
                corner[k][(axis + 2) % 3] = v;
            }

            add_patch(&mesh, corner, n);
        }
    }

    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        float *p = mesh.position[v], r = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        for (int k = 0; k < 3; k++) p[k] /= r;
    }

    return mesh;
}

/// Three quads around the middle of a triangle.
static void add_triangle(QuadMesh *mesh, const double p[3][2]) {
    double x = (p[0][0] + p[1][0] + p[2][0]) / 3, y = (p[0][1] + p[1][1] + p[2][1]) / 3;
    for (int k = 0; k < 3; k++) {
        const double *a = p[k], *b = p[(k + 1) % 3], *c = p[(k + 2) % 3];
        uint32_t v0 = vertex_at(mesh, a[0], a[1], 0), v1 = vertex_at(mesh, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, 0);
        uint32_t v2 = vertex_at(mesh, x, y, 0), float3 = vertex_at(mesh, (a[0] + c[0]) / 2, (a[1] + c[1]) / 2, 0);
        mesh_add_cell(mesh, v0, v1, v2, float3);
    }
}

QuadMesh mesh_random(uint32_t n, uint32_t seed) {
    QuadMesh mesh = {0};
    for (uint32_t j = 0; j < n; j++) {
        for (uint32_t i = 0; i < n; i++) {
            double c[4][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}};
            int k = (int)(random_hash(i, j, 0, seed) >> 31);
            for (int half = 0; half < 2; half++) {
                int a = k + 2 * half;
                double p[3][2];
                for (int q = 0; q < 3; q++) memcpy(p[q], c[(a + q) % 4], sizeof p[q]);
                add_triangle(&mesh, p);
            }
        }
    }

    return mesh;
}

void mesh_shuffle(QuadMesh *mesh, uint32_t seed) {
    uint32_t *to = malloc(mesh->vertex_count * sizeof *to);
    float(*moved)[3] = malloc(mesh->vertex_count * sizeof *moved);
    assert_true(to && moved);

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t k = random_hash(v, 1, 0, seed) % (v + 1);
        to[v] = to[k], to[k] = v;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) memcpy(moved[to[v]], mesh->position[v], sizeof *moved);
    memcpy(mesh->position, moved, mesh->vertex_count * sizeof *moved);

    for (uint32_t c = 0; c < mesh->cell_count; c++) {
        uint32_t turned[4], k = random_hash(c, 2, 0, seed) % (c + 1), turn = random_hash(c, 3, 0, seed) & 3;
        for (uint32_t i = 0; i < 4; i++) turned[i] = to[mesh->cells[c][(i + turn) & 3]];
        memcpy(mesh->cells[c], mesh->cells[k], sizeof turned);
        memcpy(mesh->cells[k], turned, sizeof turned);
    }

    free(to);
    free(moved);
}

SingeSheetDef mesh_sheet(const QuadMesh *mesh) {
    SingeSheetDef def = singe_default_sheet();
    def.vertex_count = mesh->vertex_count;
    def.positions = mesh->position[0];
    def.cell_count = mesh->cell_count;
    def.cells = mesh->cells[0];
    return def;
}

static Shell def_shell(Memory *memory, const SingeSheetDef *def) {
    SheetSource source;
    SingeError error = {0};
    Shell shell;
    if (sheet_source_create(memory, def, &source, &error)) fail_msg("%s", error.message);
    if (shell_create(memory, &source, 1, &shell, &error)) fail_msg("%s", error.message);
    sheet_source_free(memory, &source);
    return shell;
}

Shell mesh_shell(Memory *memory, const QuadMesh *mesh) {
    const SingeSheetDef def = mesh_sheet(mesh);
    return def_shell(memory, &def);
}

Sample sample_open(QuadMesh mesh, float thickness) {
    Sample sample = {.memory = memory_make((SingeAllocator){0}), .mesh = mesh};
    SingeSheetDef def = mesh_sheet(&mesh);
    if (thickness > 0) def.material.thickness = singe_param(thickness);
    sample.shell = def_shell(&sample.memory, &def);
    return sample;
}

void sample_close(Sample *sample) {
    shell_free(&sample->memory, &sample->shell);
    assert_int_equal(sample->memory.held, 0);
    mesh_release(&sample->mesh);
}

uint32_t count_rings(const SpringSet *set) {
    uint32_t rings = 0;
    for (uint32_t s = 0; s < set->strand_count; s++) rings += set->strand_ring[s];
    return rings;
}

/// Strands are chains of all springs, touch no particle twice, and not that of another in their family.
static void check_strands(const SpringSet *set, uint32_t particle_count) {
    uint32_t *strand_at = calloc(particle_count, sizeof *strand_at);
    uint32_t *family_at = calloc(particle_count, sizeof *family_at);
    uint32_t longest = 0;

    assert_true(strand_at && family_at);
    assert_int_equal(set->strand_first[0], 0);
    assert_int_equal(set->strand_first[set->strand_count], set->count);
    assert_int_equal(set->family_first[0], 0);
    assert_int_equal(set->family_first[set->family_count], set->strand_count);

    for (uint32_t f = 0; f < set->family_count; f++) {
        assert_true(set->family_first[f] < set->family_first[f + 1]);
        for (uint32_t s = set->family_first[f]; s < set->family_first[f + 1]; s++) {
            uint32_t begin = set->strand_first[s], end = set->strand_first[s + 1];
            assert_true(begin < end);
            if (end - begin > longest) longest = end - begin;

            for (uint32_t k = begin; k < end; k++) {
                assert_int_not_equal(set->ends[k][0], set->ends[k][1]);
                if (k + 1 < end) assert_int_equal(set->ends[k][1], set->ends[k + 1][0]);

                for (int side = 0; side < (k + 1 == end ? 2 : 1); side++) {
                    uint32_t p = set->ends[k][side];
                    assert_true(p < particle_count);
                    if (side == 1 && set->strand_ring[s]) continue;
                    assert_int_not_equal(strand_at[p], s + 1); // touched twice
                    assert_int_not_equal(family_at[p], f + 1); // a conflict
                    strand_at[p] = s + 1;
                }
            }

            for (uint32_t k = begin; k < end; k++) family_at[set->ends[k][0]] = family_at[set->ends[k][1]] = f + 1;
            assert_int_equal(set->strand_ring[s], set->ends[end - 1][1] == set->ends[begin][0]);
            if (set->strand_ring[s]) assert_true(end - begin >= 3);
        }
    }

    assert_int_equal(set->longest, longest);
    free(strand_at);
    free(family_at);
}

static void check_ends(const SpringSet *set, uint32_t spring, uint32_t a, uint32_t b, uint8_t *uses) {
    assert_true(spring < set->count);
    const uint32_t *ends = set->ends[spring];
    assert_true((ends[0] == a && ends[1] == b) || (ends[0] == b && ends[1] == a));
    uses[spring]++;
}

/// The springs of a cell join what their slot says, and all springs are some cell's.
static void check_cells(const Shell *shell) {
    uint8_t *uses[SINGE_COLOUR_COUNT];
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        assert_non_null(uses[colour] = calloc((size_t)shell->springs[colour].count + 1, 1));

    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const CellSprings *springs = &shell->cell_springs[c];
        const uint32_t *corner = shell->cells[c];
        uint32_t centre = shell_centre(shell, c);
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t a = corner[i], b = corner[(i + 1) & 3], other = shell_neighbour(shell, c, (int)i);
            check_ends(&shell->springs[SINGE_RED], springs->red[i], centre, a, uses[SINGE_RED]);
            check_ends(&shell->springs[SINGE_BLUE], springs->blue[i], a, b, uses[SINGE_BLUE]);
            if (i < 2)
                check_ends(&shell->springs[SINGE_YELLOW], springs->yellow[i], a, corner[i + 2], uses[SINGE_YELLOW]);
            assert_int_equal(other == SHELL_NONE, springs->green[i] == SHELL_NONE);
            if (other == SHELL_NONE) continue;

            check_ends(&shell->springs[SINGE_GREEN], springs->green[i], centre, shell_centre(shell, other),
                       uses[SINGE_GREEN]);

            int back = 0;
            for (int j = 0; j < 4; j++) {
                if (shell->cell_springs[other].green[j] != springs->green[i]) continue;
                back++;
                assert_int_equal(shell_neighbour(shell, other, j), c);
                assert_int_equal(shell->cell_springs[other].blue[j], springs->blue[i]);
            }

            assert_int_equal(back, 1);
        }
    }

    static const int low[] = {[SINGE_RED] = 1, [SINGE_GREEN] = 2, [SINGE_BLUE] = 1, [SINGE_YELLOW] = 1};
    static const int high[] = {[SINGE_RED] = 1, [SINGE_GREEN] = 2, [SINGE_BLUE] = 2, [SINGE_YELLOW] = 1};
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        for (uint32_t s = 0; s < shell->springs[colour].count; s++)
            assert_in_range(uses[colour][s], low[colour], high[colour]);
        free(uses[colour]);
    }
}

static void check_cell_families(const Shell *shell) {
    uint32_t *family_at = calloc(shell->vertex_count, sizeof *family_at);
    uint8_t *seen = calloc(shell->cell_count, 1);
    assert_true(family_at && seen);
    assert_int_equal(shell->cell_family_first[0], 0);
    assert_int_equal(shell->cell_family_first[shell->cell_family_count], shell->cell_count);

    for (uint32_t f = 0; f < shell->cell_family_count; f++) {
        for (uint32_t k = shell->cell_family_first[f]; k < shell->cell_family_first[f + 1]; k++) {
            uint32_t c = shell->cell_order[k];
            assert_true(c < shell->cell_count);
            assert_int_equal(seen[c]++, 0);
            for (int i = 0; i < 4; i++) {
                assert_int_not_equal(family_at[shell->cells[c][i]], f + 1);
                family_at[shell->cells[c][i]] = f + 1;
            }
        }
    }

    free(family_at);
    free(seen);
}

void check_shell(const Shell *shell) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        check_strands(&shell->springs[colour], shell->particle_count);
    check_cells(shell);
    check_cell_families(shell);
}

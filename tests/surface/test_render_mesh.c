// Meshes that are drawn in place of a sheet: flat, moved, curled, burnt, torn, with buttons, and damaged ones.
#include "drawing.h"

#include "../collision/count_crossings.h"
#include "drawn_mesh.h"

/// A mesh in the making.
typedef struct Draft {
    uint32_t vertex_count, triangle_count;
    float positions[3 * 12000], uv[2 * 12000];
    uint32_t triangles[3 * 24000];
} Draft;

static uint32_t add_vertex(Draft *m, float x, float y, float z) {
    const uint32_t v = m->vertex_count++;
    assert_true(m->vertex_count <= 12000);
    float3_store(&m->positions[3 * v], float3(x, y, z));
    m->uv[2 * v] = 7 * x;
    m->uv[2 * v + 1] = 1 - y;
    return v;
}

static void add_quad(Draft *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    const uint32_t corner[6] = {a, b, c, a, c, d};
    memcpy(&m->triangles[3 * m->triangle_count], corner, sizeof corner);
    m->triangle_count += 2;
}

/// A layer of n by n quads over a square at this height, facing up.
static void add_layer(Draft *m, uint32_t n, float side, float height) {
    const uint32_t first = m->vertex_count;
    for (uint32_t k = 0; k < (n + 1) * (n + 1); k++)
        add_vertex(m, side * (float)(k % (n + 1)) / (float)n, side * (float)(k / (n + 1)) / (float)n, height);
    for (uint32_t k = 0; k < n * n; k++) {
        const uint32_t v = first + k / n * (n + 1) + k % n;
        add_quad(m, v, v + 1, v + n + 2, v + n + 1);
    }
}

/// A box with this middle.
static void add_box(Draft *m, float x, float y, float z, float size) {
    const uint32_t v = m->vertex_count;
    for (int k = 0; k < 8; k++)
        add_vertex(m, x + size * ((float)(k & 1) - 0.5f), y + size * ((float)(k >> 1 & 1) - 0.5f),
                   z + size * ((float)(k >> 2) - 0.5f));
    add_quad(m, v, v + 2, v + 3, v + 1);
    add_quad(m, v + 4, v + 5, v + 7, v + 6);
    add_quad(m, v, v + 1, v + 5, v + 4);
    add_quad(m, v + 1, v + 3, v + 7, v + 5);
    add_quad(m, v + 3, v + 2, v + 6, v + 7);
    add_quad(m, v + 2, v, v + 4, v + 6);
}

/// A sheet of 10 cm, of n by n cells, and a mesh for it.
typedef struct Garment {
    Drawing *d;
    SheetSource source;
    Memory memory;
    RenderSheet sheet;
    SingeRenderMeshDef def;
    Draft *draft;
    RenderMesh *mesh;
} Garment;

static const float side = 0.1f;

static Garment *garment(uint32_t n, float detail, float raggedness) {
    const SingeMaterialDef material = plain_material();
    Garment *g = calloc(1, sizeof *g);
    assert_non_null(g);
    g->d = drawing_of(burning_spare_sheets(1, n, n, side / (float)n, &material, 0, 40));
    g->d->detail = (SurfaceDetail){.size = detail, .raggedness = raggedness, .seed = 1};
    g->memory = memory_make((SingeAllocator){0});
    g->source = grid_source(&g->memory, n, n, side / (float)n, 0, &material, 0);
    g->sheet = (RenderSheet){.source = &g->source, .cell_size = side / (float)n, .number_first = 1000};
    g->def = singe_default_render_mesh();
    g->draft = calloc(1, sizeof *g->draft);
    assert_non_null(g->draft);
    return g;
}

static SingeResult bind(Garment *g, SingeError *error) {
    g->def.vertex_count = g->draft->vertex_count;
    g->def.triangle_count = g->draft->triangle_count;
    g->def.positions = g->draft->positions;
    g->def.uv = g->draft->uv;
    g->def.triangles = g->draft->triangles;
    return render_mesh_create(&g->memory, g->d->pool, &g->sheet, &g->def, &g->mesh, error);
}

static const SingeSurface *draw(Garment *g) {
    if (!g->mesh) assert_int_equal(bind(g, NULL), SINGE_OK);
    g->d->detail.meshes = &g->mesh;
    g->d->detail.mesh_count = 1;
    draw_fine(g->d);
    return &g->d->surface;
}

static void garment_free(Garment *g) {
    render_mesh_free(&g->memory, g->mesh);
    sheet_source_free(&g->memory, &g->source);
    assert_int_equal(g->memory.held, 0);
    drawing_free(g->d);
    free(g->draft);
    free(g);
}

static void garment_end(Garment **g) { garment_free(*g); }
#define OwnGarment OWNED(garment_end) Garment

/// The vertex of the surface that was vertex v of the mesh.
static uint32_t found(const SingeSurface *s, uint32_t v) {
    uint32_t i = 0;
    while (i < s->vertex_count && s->source_vertex[i] != 1000 + (int32_t)v) i++;
    assert_true(i < s->vertex_count);
    return i;
}

static float distance(const float *a, const float *b) {
    return float3_length(float3_sub(float3_load(a), float3_load(b)));
}

/// A thick mesh is drawn where it was given, with its own uv, beside the edges that were halved; in place of the sheet.
TEST(flat_meshes_stay_as_they_are) {
    OwnGarment *g = garment(9, 1e-3f, 1e-3f);
    add_layer(g->draft, 31, side, 4e-4f);
    add_layer(g->draft, 4, side, -4e-4f);
    add_box(g->draft, 0.1f, 0.05f, 0.001f, 0.004f); // over the border
    const SingeSurface *s = draw(g);
    assert_int_equal(s->sheet[0], 0);
    assert_true(s->vertex_count > g->draft->vertex_count && s->triangle_count > g->draft->triangle_count);
    for (uint32_t v = 0; v < g->draft->vertex_count; v++) {
        const uint32_t i = found(s, v);
        const float *given = &g->draft->positions[3 * v];
        assert_true(distance(s->position[i], given) < 1e-7f);
        assert_true(distance(s->rest_position[i], given) == 0);
        assert_memory_equal(s->uv[i], &g->draft->uv[2 * v], sizeof s->uv[i]);
    }
    for (uint32_t i = 0; i < s->vertex_count; i++)
        assert_true(s->rest_position[i][2] == 0 || fabsf(s->rest_position[i][2]) < 0.01f);

    // both layers whole, without cracks: as many triangles as the halving makes
    double area = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) area += fabs(doubled_area(s, t)) / 2;
    assert_float_equal(area, 2 * 0.01 + 2 * 0.004 * 0.004, 1e-7);
}

/// Beside the sheet both are drawn.
TEST(meshes_beside_their_sheet) {
    uint32_t triangles[2];
    for (int beside = 0; beside < 2; beside++) {
        OwnGarment *g = garment(6, 1e-3f, 0);
        g->def.beside = beside;
        add_layer(g->draft, 12, side, 1e-3f);
        triangles[beside] = draw(g)->triangle_count;
    }
    assert_true(triangles[0] >= 2 * 144);
    assert_int_equal(triangles[1], triangles[0] + 4 * 36);
}

/// A motion of the sheet as a whole is one of the mesh.
TEST(meshes_move_with_their_sheet) {
    OwnGarment *g = garment(9, 1e-3f, 1e-3f);
    add_layer(g->draft, 20, side, 6e-4f);
    add_box(g->draft, 0.1f, 0.05f, 0.001f, 0.004f);
    const float turn[4] = {0.5f, -0.1f, 0.7f, sqrtf(1 - 0.75f)};
    const Float3 shift = {0.2f, -0.3f, 0.5f};
    for (uint32_t v = 0; v < g->d->sheet->shell.vertex_count; v++) {
        float *p = g->d->sheet->state.dynamics.position[v];
        float3_store(p, float3_add(quat_rotate(turn, float3_load(p)), shift));
    }
    const SingeSurface *s = draw(g);
    const Float3 up = quat_rotate(turn, float3(0, 0, 1));
    for (uint32_t v = 0; v < g->draft->vertex_count; v++) {
        float wanted[3];
        const uint32_t i = found(s, v);
        float3_store(wanted, float3_add(quat_rotate(turn, float3_load(&g->draft->positions[3 * v])), shift));
        assert_true(distance(s->position[i], wanted) < 3e-7f);
        if (v < 441) assert_true(float3_dot(float3_load(s->normal[i]), up) > 0.99999f);
    }
}

/// Rolled up to a cylinder, both sides of a thick mesh keep their distance from the sheet along its normal.
TEST(thickness_is_kept_in_a_curl) {
    const float radius = 0.03f, half = 1e-3f;
    OwnGarment *g = garment(20, 1e-3f, 0);
    add_layer(g->draft, 40, side, half);
    const uint32_t below = g->draft->vertex_count;
    add_layer(g->draft, 40, side, -half);
    for (uint32_t v = 0; v < g->d->sheet->shell.vertex_count; v++) {
        float *p = g->d->sheet->state.dynamics.position[v], angle = p[0] / radius;
        p[0] = radius * sinf(angle);
        p[2] = radius - radius * cosf(angle); // the front is inside
    }
    const SingeSurface *s = draw(g);
    const float drawn = radius * (2 + cosf(side / 20 / radius)) / 3; // a cubic B-spline through the corners' cylinder
    float worst = 0, axis[3] = {0, 0, radius};
    for (uint32_t v = 0; v < below; v++) {
        const float *in = s->position[found(s, v)], *out = s->position[found(s, below + v)];
        assert_float_equal(distance(in, out), 2 * half, 1e-6);
        axis[1] = in[1];
        const float along = g->draft->positions[3 * v]; // at its ends the cylinder is drawn otherwise
        if (along > 0.011f && along < side - 0.011f) worst = fmaxf(worst, fabsf(distance(in, axis) - (drawn - half)));
    }
    print_message("off the cylinder by %.3g mm, of a thickness of %g mm\n", (double)(1e3f * worst), 2e3 * (double)half);
    assert_true(worst < 0.05f * half);
}

/// In folds sharper than a mesh is thick its inner side is pressed together, and does not cross itself. Gentler ones leave
/// it as it is.
TEST(thick_meshes_do_not_cross_in_folds) {
    static const struct { float amplitude, half; } cases[] = {{1.5e-3f, 4e-3f}, {8e-3f, 8e-3f}, {12e-3f, 8e-3f}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        OwnGarment *g = garment(20, 1e-3f, 0);
        g->def.reach = 0.02f;
        add_layer(g->draft, 50, side, cases[k].half);
        add_layer(g->draft, 50, side, -cases[k].half);
        for (uint32_t v = 0; v < g->d->sheet->shell.vertex_count; v++) {
            float *p = g->d->sheet->state.dynamics.position[v];
            p[2] = cases[k].amplitude * sinf(157.0796f * p[0] + 40 * p[1]); // eight cells a wave
        }
        const SingeSurface *s = draw(g);
        const long crossings = surface_crossings(s);
        float thinnest = INFINITY, thickest = 0;
        for (uint32_t v = 0; v < 51 * 51; v += 23) {
            const float apart = distance(s->position[found(s, v)], s->position[found(s, 2601 + v)]);
            thinnest = fminf(thinnest, apart), thickest = fmaxf(thickest, apart);
        }
        print_message("waves of %g mm: %ld crossings, thickness %.2f to %.2f of %g mm\n",
                      1e3 * (double)cases[k].amplitude, crossings, 1e3 * (double)thinnest, 1e3 * (double)thickest,
                      2e3 * (double)cases[k].half);
        assert_int_equal(crossings, 0);
        assert_true(k > 0 ? thinnest < 1.5f * cases[k].half : thinnest > 1.999f * cases[k].half);
    }
}

/// A sheet that is folded over itself leaves its mesh half of the gap.
TEST(thick_meshes_do_not_cross_where_sheets_are_folded) {
    for (int gap = 5; gap <= 9; gap += 4) {
        OwnGarment *g = garment(20, 1e-3f, 0);
        add_layer(g->draft, 50, side, 4e-3f);
        add_layer(g->draft, 50, side, -4e-3f);
        const float radius = 0.5e-3f * (float)gap, begin = 0.5f * side - 1.5707963f * radius;
        for (uint32_t v = 0; v < g->d->sheet->shell.vertex_count; v++) {
            float *p = g->d->sheet->state.dynamics.position[v];
            const float angle = fminf(fmaxf((p[0] - begin) / radius, 0), 3.1415927f);
            p[2] = radius * (1 - cosf(angle));
            p[0] = fminf(p[0], begin) + radius * sinf(angle) - fmaxf(p[0] - begin - 3.1415927f * radius, 0);
        }
        const long crossings = surface_crossings(draw(g));
        print_message("%d mm between the two halves: %ld crossings\n", gap, crossings);
        assert_int_equal(crossings, 0);
    }
}

/// What the fire cuts from the mesh is what it cuts from the sheet, at the border within a fifth of a cell; edges that
/// it cuts have no cracks.
TEST(meshes_burn_with_their_sheet) {
    OwnGarment *g = garment(25, 4e-4f, 0);
    const float cell = side / 25;
    burn_rings(g->d, 0.015f);
    ablate(g->d);
    draw_fine(g->d);
    OwnSurface sheet = g->d->surface;
    g->d->surface = (SingeSurface){0};
    add_layer(g->draft, 53, side, 0);
    const SingeSurface *s = draw(g);
    const double whole = area_of(&sheet), area = area_of(s);
    print_message("%.4g of the sheet's area, of the mesh's %.4g\n", 1e4 * whole, 1e4 * area);
    assert_true(whole < 0.009 && fabs(area - whole) < 0.005 * whole);

    // borders of the mesh
    Edge *edges = drawn_edges(s);
    const size_t count = 3 * (size_t)s->triangle_count;
    uint32_t rims = 0;
    float worst = 0;
    for (size_t k = 0; k < count; k++) {
        Edge back = {edges[k].b, edges[k].a};
        const float *p = s->position[edges[k].a];
        assert_true(k == 0 || order_by_two(&edges[k - 1], &edges[k]) != 0);
        if (bsearch(&back, edges, count, sizeof *edges, order_by_two)) continue;
        if (fminf(p[0], p[1]) < 1e-6f || fmaxf(p[0], p[1]) > side - 1e-6f) continue;
        float nearest = 1;
        for (uint32_t v = 0; v < sheet.vertex_count; v++)
            if (sheet.source_vertex[v] < 0 && sheet.mass[v] < 0.4f)
                nearest = fminf(nearest, distance(p, sheet.position[v]));
        worst = fmaxf(worst, nearest);
        rims++;
        assert_true(s->mass[edges[k].a] < 0.4f);
    }
    print_message("%u edges at the fire, at most %.2f of a cell from the sheet's\n", rims, (double)(worst / cell));
    assert_true(rims > 100 && worst < 0.2f * cell);
    free(edges);
}

/// A tear parts the mesh: no triangle spans it, and little is lost. Coarse cells tear along their sides, fine ones fray.
TEST(meshes_tear_with_their_sheet) {
    for (int fine = 0; fine < 2; fine++) {
        OwnGarment *g = garment(10, fine ? 1e-3f : 1, 0);
        add_layer(g->draft, 27, side, 2e-4f);
        tear_along(g->d, 4, 11);
        float(*position)[4] = g->d->sheet->state.dynamics.position;
        for (uint32_t c = 40; c < 100; c++)
            for (int i = 0; i < 4; i++) {
                const uint32_t v = g->d->sheet->shell.cells[c][i];
                position[v][2] = 0.05f; // the farther side goes away
            }
        const SingeSurface *s = draw(g);
        double area = 0;
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            area += doubled_area(s, t) / 2;
            for (int k = 0; k < 3; k++) {
                const float *p = s->position[s->triangles[t][k]], *q = s->position[s->triangles[t][(k + 1) % 3]];
                assert_true(fabsf(p[2] - q[2]) < 1e-6f);
            }
        }
        print_message("%.4f of the area is left\n", area / 0.01);
        assert_true(area < 0.01001 && area > (fine ? 0.95 : 0.985) * 0.01);
    }
}

/// Small parts keep their shape wherever the sheet goes, and go when it burns beneath them.
TEST(buttons_are_rigid) {
    OwnGarment *g = garment(12, 1e-3f, 1e-3f);
    g->def.rigid = 0.01f;
    add_box(g->draft, 0.03f, 0.05f, 0.002f, 0.004f);
    add_box(g->draft, 0.08f, 0.05f, 0.002f, 0.004f);
    add_box(g->draft, 0.05f, 0.02f, 0, 0.005f);
    for (uint32_t v = 0; v < g->d->sheet->shell.vertex_count; v++) {
        float *p = g->d->sheet->state.dynamics.position[v];
        p[2] = 0.3f * p[0] + 8 * p[0] * p[1];
    }
    for (uint32_t i = 0; i < g->d->sheet->shell.particle_count; i++)
        if (g->d->sheet->shell.rest_position[i][0] > 0.06f) set_level(g->d, i, -0.1f);
    const SingeSurface *s = draw(g);
    assert_int_equal(s->vertex_count, 16);
    assert_int_equal(s->triangle_count, 24);
    for (uint32_t v = 0; v < 24; v++)
        for (uint32_t w = v / 8 * 8; w < v && v / 8 != 1; w++)
            assert_float_equal(distance(s->position[found(s, v)], s->position[found(s, w)]),
                               distance(&g->draft->positions[3 * v], &g->draft->positions[3 * w]), 2e-7);
}

/// A mesh that stands elsewhere, turned, curled and three times as large, lies on the sheet by its uv, and burns with it.
TEST(meshes_are_bound_by_uv) {
    OwnGarment *g = garment(9, 1e-3f, 1e-3f);
    SingeError error = {0};
    add_layer(g->draft, 31, side, 0);
    for (uint32_t v = 0; v < g->draft->vertex_count; v++) {
        float *p = &g->draft->positions[3 * v], *uv = &g->draft->uv[2 * v];
        uv[0] = p[0] / side, uv[1] = p[1] / side;
        float3_store(p, float3(5 + 0.3f * cosf(20 * p[1]), -3 * p[0], 2 + 0.3f * sinf(20 * p[1])));
    }
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH); // by position
    g->def.by_uv = true;
    const SingeSurface *s = draw(g);
    double area = 0;
    for (uint32_t v = 0; v < g->draft->vertex_count; v++) {
        const uint32_t i = found(s, v);
        const float *uv = &g->draft->uv[2 * v], at[3] = {side * uv[0], side * uv[1], 0};
        assert_true(distance(s->position[i], at) < 1e-6f && distance(s->rest_position[i], at) < 1e-6f);
        assert_true(s->normal[i][2] > 0.999f);
        assert_memory_equal(s->uv[i], uv, sizeof s->uv[i]);
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) area += fabs(doubled_area(s, t)) / 2;
    assert_float_equal(area, 0.01, 1e-7);

    // a uv that the sheet lacks, no uv at all, and a sheet without
    render_mesh_free(&g->memory, g->mesh);
    g->mesh = NULL;
    g->draft->uv[2 * 40] = 1.5f;
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 40);
    g->draft->uv[2 * 40] = 1e30f;
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH);
    g->def.uv = NULL;
    assert_int_equal(render_mesh_create(&g->memory, g->d->pool, &g->sheet, &g->def, &g->mesh, &error),
                     SINGE_ERROR_ARGUMENT);
    g->def.uv = g->draft->uv;
    memset(g->source.uv, 0, g->source.sheet.vertex_count * sizeof *g->source.uv);
    assert_int_equal(render_mesh_create(&g->memory, g->d->pool, &g->sheet, &g->def, &g->mesh, &error),
                     SINGE_ERROR_ARGUMENT);
}

TEST(damaged_meshes_are_refused) {
    OwnGarment *g = garment(4, 1e-3f, 0);
    SingeError error = {0};
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH); // no triangles
    add_layer(g->draft, 4, side, 0);

    g->draft->positions[7] = NAN;
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 2);
    g->draft->positions[7] = 0;
    g->draft->uv[9] = INFINITY;
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 4);
    g->draft->uv[9] = 0;
    const uint32_t corner = g->draft->triangles[10];
    g->draft->triangles[10] = 25;
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 3);
    g->draft->triangles[10] = corner;

    // too far away, near or out of all sight
    g->draft->positions[3 * 6 + 2] = 0.04f;
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 6);
    assert_non_null(strstr(error.message, "vertex 6 is 0.04 m away"));
    g->draft->positions[3 * 6 + 2] = 900;
    assert_int_equal(bind(g, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 6);
    g->draft->positions[3 * 6 + 2] = 0;

    g->def.edge_max = 1e-6f;
    assert_int_equal(bind(g, &error), SINGE_ERROR_LIMIT);
    g->def.edge_max = -1;
    assert_int_equal(bind(g, &error), SINGE_ERROR_ARGUMENT);
    g->def.edge_max = 0;
    assert_null(g->mesh);

    // lines and points are left out
    const uint32_t line[3] = {3, 3, 8};
    memcpy(g->draft->triangles, line, sizeof line);
    assert_int_equal(bind(g, &error), SINGE_OK);
    assert_true(draw(g)->triangle_count >= 31);
}

TEST(binding_and_drawing_survive_lack_of_memory) {
    OwnGarment *g = garment(8, 1e-3f, 1e-3f);
    add_layer(g->draft, 5, side, 0);
    burn_rings(g->d, 0.015f);
    assert_int_equal(bind(g, NULL), SINGE_OK);
    int failures = 0;
    SingeResult result = SINGE_ERROR_MEMORY;
    for (int n = 0; result; n++) {
        TestAllocator allocator = {.fail_at = n + 1};
        Memory memory = memory_make(test_allocator(&allocator));
        SingeSurface surface = {.allocator = test_allocator(&allocator)};
        RenderMesh *mesh;
        result = render_mesh_create(&memory, NULL, &g->sheet, &g->def, &mesh, NULL);
        if (!result) {
            g->d->detail.meshes = &mesh;
            g->d->detail.mesh_count = 1;
            result = surface_draw_fine(g->d->plan, &g->d->sheet->shell, &g->d->sheet->state, &g->d->detail, &memory,
                                       NULL, &surface, NULL);
        }
        assert_true(result == SINGE_OK || result == SINGE_ERROR_MEMORY);
        failures += result != SINGE_OK;
        render_mesh_free(&memory, mesh);
        assert_int_equal(memory.held, 0);
        singe_surface_free(&surface);
        test_allocator_check(&allocator);
    }
    assert_true(failures > 60);
}

/// Any number of threads binds and draws the same.
TEST(threads_bind_and_draw_the_same) {
    OwnSurface first = {0};
    for (int threads = 1; threads <= 3; threads += 2) {
        OwnGarment *g = garment(25, 4e-4f, 2e-3f);
        if (threads > 1)
            assert_int_equal(pool_create(&g->d->sheet->memory, (SingeTasks){0}, threads, &g->d->pool), SINGE_OK);
        burn_rings(g->d, 0.012f);
        ablate(g->d);
        add_layer(g->draft, 40, side, 3e-4f);
        const SingeSurface *s = draw(g);
        if (threads == 1) {
            first = *s;
            g->d->surface = (SingeSurface){0};
        } else {
            assert_int_equal(s->vertex_count, first.vertex_count);
            assert_memory_equal(s->position, first.position, s->vertex_count * sizeof *s->position);
            assert_memory_equal(s->mass, first.mass, s->vertex_count * sizeof *s->mass);
        }
    }
}

/// Triangles without an area, and those that come again with any winding, are left out; edges that are not a surface's are
/// counted, which the drawn mesh keeps.
TEST(flaws_of_meshes_are_counted) {
    Garment *g = garment(4, 2e-3f, 0), *clean = garment(4, 2e-3f, 0);
    add_layer(g->draft, 4, side, 1e-3f);
    add_layer(clean->draft, 4, side, 1e-3f);
    const uint32_t more[][3] = {{6, 1, 0}, {0, 1, 6}, {7, 2, 8}, {0, 1, 2}, {3, 3, 4}}; // three of before, and two flat
    memcpy(&g->draft->triangles[3 * g->draft->triangle_count], more, sizeof more);
    g->draft->triangle_count += 5;
    assert_int_equal(bind(g, NULL), SINGE_OK);
    assert_int_equal(render_mesh_flaws(g->mesh).left_out, 5);
    assert_int_equal(render_mesh_flaws(g->mesh).odd_edges, 0);
    assert_int_equal(draw(g)->triangle_count, draw(clean)->triangle_count);
    assert_int_equal(render_mesh_flaws(clean->mesh).left_out, 0);
    garment_free(clean);
    garment_free(g);

    // a third triangle at an edge, and one that is wound against its two neighbours
    g = garment(4, 2e-3f, 0);
    add_layer(g->draft, 4, side, 1e-3f);
    const uint32_t top = add_vertex(g->draft, 0, 0.01f, 2e-3f), fin[3] = {0, 6, top};
    memcpy(&g->draft->triangles[3 * g->draft->triangle_count++], fin, sizeof fin);
    const uint32_t last = 3 * 31, kept = g->draft->triangles[last];
    g->draft->triangles[last] = g->draft->triangles[last + 1];
    g->draft->triangles[last + 1] = kept;
    assert_int_equal(bind(g, NULL), SINGE_OK);
    assert_int_equal(render_mesh_flaws(g->mesh).left_out, 0);
    assert_int_equal(render_mesh_flaws(g->mesh).odd_edges, 3);
    garment_free(g);
}

/// The public call works after the commit, and on sheets that exist.
TEST(simulations_draw_meshes) {
    SingeSimDef def = singe_default_sim();
    OwnTestMesh mesh = test_grid(6, 6, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&mesh);
    def.surface_detail = 0;
    OwnSim *sim = test_create(&def);
    SingeSheetId id = test_add_sheet(sim, &sheet);

    SingeRenderMeshDef render = singe_default_render_mesh();
    const float positions[] = {0.01f, 0.01f, 1e-3f, 0.05f, 0.01f, 1e-3f, 0.01f, 0.05f, 1e-3f};
    const uint32_t triangle[] = {0, 1, 2};
    render.vertex_count = 3;
    render.triangle_count = 1;
    render.positions = positions;
    render.triangles = triangle;
    test_refused(sim, SINGE_ERROR_STATE, singe_sim_add_render_mesh(sim, id, &render));
    test_ok(sim, singe_sim_commit(sim));
    SingeRenderMeshDef unset = {0};
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_render_mesh(sim, id, &unset));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_render_mesh(sim, (SingeSheetId){1, 1}, &render));

    const SingeView view = singe_sim_view(sim);
    const float *at = view.rest_position[0];
    float moved[9];
    for (int k = 0; k < 9; k++) moved[k] = positions[k] + at[k % 3];
    render.positions = moved;
    test_ok(sim, singe_sim_add_render_mesh(sim, id, &render));
    OwnSurface surface = {0};
    test_ok(sim, singe_sim_surface(sim, &surface));
    assert_true(surface.triangle_count >= 64 && surface.triangle_count < 300);
    uint32_t given = 0;
    for (uint32_t v = 0; v < surface.vertex_count; v++) {
        given += surface.source_vertex[v] >= 49 && surface.source_vertex[v] < 52;
        assert_true(surface.uv[v][0] > 0); // the sheet's
        assert_float_equal(surface.position[v][2], (double)at[2] + 1e-3, 1e-7);
    }
    assert_int_equal(given, 3);
}

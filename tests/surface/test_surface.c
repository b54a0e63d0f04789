// Marching triangles: areas by hand, linear fields, no cracks, memory.
#include "drawing.h"

#include "drawn_mesh.h"
#include "common/random.h"

static Drawing *plain_drawing(uint32_t nx, uint32_t ny, float cell) {
    SingeMaterialDef material = plain_material();
    return drawing_of(burning_sheet(nx, ny, cell, &material));
}

TEST(one_cell_is_cut_by_its_levels) {
    // levels of the corners and the virtual centre in quarters; the areas follow from t of eq 7
    const struct {
        int level[5];
        double area;
        uint32_t triangles, vertices;
    } cases[] = {
        {{1, 1, 1, 1, 1}, 1, 4, 5},
        {{1, -1, -1, -1, -1}, 2.0 / 16, 2, 4},        // twice the small triangle, cut in the middle
        {{2, -1, -1, -1, -1}, 2 * 4.0 / 9 / 4, 2, 4}, // t = 2/3
        {{-1, -1, -1, -1, 1}, 4.0 / 16, 4, 5},
        {{-1, 1, 1, 1, 1}, 1 - 2.0 / 16, 6, 7}, // two whole ones, two quadrilaterals
        {{1, 1, 1, 1, -1}, 1 - 4.0 / 16, 8, 8},
        {{1, 1, -1, -1, -1}, 3.0 / 16 + 2.0 / 16, 4, 6},
        {{1, -1, 1, -1, 1}, 4 * 3.0 / 16, 8, 9},
        {{1, -1, 1, -1, -1}, 4.0 / 16, 4, 8},
        {{-1, -1, -1, -1, -1}, 0, 0, 0},
        {{0, -1, -1, -1, -1}, 0, 0, 0}, // on the level set: inside, but nothing to draw
        {{0, 0, -1, -1, -1}, 0, 0, 0},
        {{-1, -1, -1, -1, 0}, 0, 0, 0},
        {{0, 0, -1, -1, 0}, 1.0 / 4, 1, 3},
        {{0, 0, -1, -1, 1}, 1.0 / 4 + 2.0 / 8 + 1.0 / 16, 4, 5},
        {{0, 1, 1, 1, 1}, 1, 4, 5},
        {{0, 1, 0, -1, -1}, 2.0 / 8, 2, 4},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        OwnDrawing *d = plain_drawing(1, 1, 1);
        for (int i = 0; i < 5; i++)
            set_level(d, i < 4 ? d->sheet->shell.cells[0][i] : 4, 0.25f * (float)cases[k].level[i]);
        draw_coarse(d);
        assert_float_equal(area_of(&d->surface), cases[k].area, 1e-6);
        assert_int_equal(d->surface.triangle_count, cases[k].triangles);
        assert_int_equal(d->surface.vertex_count, cases[k].vertices);
    }
}

/// Area of the rectangle [0, w] x [0, h] where f >= 0, by clipping its polygon.
static double clipped_area(Linear f, double w, double h) {
    const double box[4][2] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
    double p[6][2], area = 0;
    int n = 0;

    for (int i = 0; i < 4; i++) {
        const double *a = box[i], *b = box[(i + 1) % 4];
        double fa = f.a * a[0] + f.b * a[1] + f.c, fb = f.a * b[0] + f.b * b[1] + f.c;
        if (fa >= 0) p[n][0] = a[0], p[n][1] = a[1], n++;
        if ((fa >= 0) != (fb >= 0)) {
            double t = fa / (fa - fb);
            p[n][0] = a[0] + t * (b[0] - a[0]), p[n][1] = a[1] + t * (b[1] - a[1]), n++;
        }
    }

    for (int i = 0; i < n; i++) area += p[i][0] * p[(i + 1) % n][1] - p[i][1] * p[(i + 1) % n][0];
    return area / 2;
}

TEST(linear_fields_are_exact) {
    const Linear levels[] = {{0.1, 0.05, -0.333}, {-0.07, 0.11, 0.031}, {0.02, -0.13, 0.217}, {0.09, 0, -0.3141}};
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++) {
        OwnDrawing *d = plain_drawing(7, 5, 1);
        const SingeSurface *s = &d->surface;
        set_linear_fields(d, levels[k]);
        draw_coarse(d);
        assert_float_equal(area_of(s), clipped_area(levels[k], 7, 5), 2e-5);
        expect_linear_fields(d, levels[k], 1e-5);
    }
}

TEST(whole_sheet_keeps_the_input_order) {
    OwnDrawing *d = plain_drawing(4, 3, 0.01f);
    draw_coarse(d);
    assert_int_equal(d->surface.triangle_count, 48);
    assert_int_equal(d->surface.vertex_count, 20 + 12);
    for (int v = 0; v < 32; v++) assert_int_equal(d->surface.source_vertex[v], v < 20 ? v : -1);
}

TEST(without_ablation_all_is_drawn) {
    SingeMaterialDef material = plain_material();
    material.ablate = false;

    OwnDrawing *d = drawing_of(burning_sheet(3, 3, 1, &material));
    for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) d->sheet->state.burn.mass[i] = i & 1 ? 0.15f : 0.5f;
    draw_coarse(d);
    assert_float_equal(area_of(&d->surface), 9, 1e-5);
    assert_int_equal(d->surface.triangle_count, 36);
    assert_float_equal(d->surface.burn[1], 1, 0);
    assert_float_equal(d->surface.burn[2], 0.5 / 0.85, 1e-6);
}

TEST(never_ignited_ends_do_not_count) {
    OwnDrawing *d = plain_drawing(1, 1, 1);
    for (uint32_t i = 0; i < 5; i++) set_level(d, i, -0.25f);
    set_level(d, 0, 0.25f);
    for (uint32_t i = 1; i < 5; i++) d->sheet->state.burn.time_ignited[i] = 4;
    draw_coarse(d);
    assert_float_equal(d->surface.time_ignited[0], -1, 0);
    for (uint32_t v = 1; v < 4; v++) assert_float_equal(d->surface.time_ignited[v], 4, 0);
}

/// The part of a triangle with area `whole` that is inside, by eq 7.
static double part_inside(const float level[3], double whole) {
    double sum = 0;
    int inside = 0;
    for (int i = 0; i < 3; i++) inside += level[i] >= 0;
    if (inside == 0 || inside == 3) return inside ? whole : 0;

    for (int i = 0; i < 3; i++) {
        if ((level[i] >= 0) != (inside == 1)) continue; // the one that is alone
        double own = (double)level[i], p = (double)level[(i + 1) % 3], q = (double)level[(i + 2) % 3];
        sum = own / (own - p) * (own / (own - q)) * whole;
    }

    return inside == 1 ? sum : whole - sum;
}

/// Both ends on the level set, or both on one side of the sheet.
static bool on_boundary(const SingeSurface *s, uint32_t a, uint32_t b, float width, float height) {
    bool cut = fabsf(s->mass[a] - 0.25f) < 1e-6f && fabsf(s->mass[b] - 0.25f) < 1e-6f;
    const float *p = s->position[a], *q = s->position[b];
    return cut || (p[0] == 0 && q[0] == 0) || (p[1] == 0 && q[1] == 0) || (p[0] == width && q[0] == width) ||
           (p[1] == height && q[1] == height);
}

/// Every edge is walked once in each direction, or once in all where the surface ends.
static void expect_no_cracks(const SingeSurface *s, float width, float height) {
    size_t count = 3 * (size_t)s->triangle_count;
    Edge *edges = drawn_edges(s);
    for (size_t k = 0; k < count; k++) {
        Edge back = {edges[k].b, edges[k].a};
        assert_true(k == 0 || order_by_two(&edges[k - 1], &edges[k]) != 0);
        bool shared = bsearch(&back, edges, count, sizeof *edges, order_by_two) != NULL;
        assert_int_equal(shared, !on_boundary(s, back.a, back.b, width, height));
    }

    free(edges);
}

TEST(random_levels_leave_no_cracks) {
    for (uint32_t seed = 0; seed < 20; seed++) {
        OwnDrawing *d = plain_drawing(12, 9, 1);
        const Shell *shell = &d->sheet->shell;
        const SingeSurface *s = &d->surface;
        for (uint32_t i = 0; i < shell->particle_count; i++)
            set_level(d, i, ((float)(random_hash(i, seed, 0, 0) % 15) - 6.5f - (float)(seed % 5)) / 64);

        double expected = 0;
        for (uint32_t c = 0; c < shell->cell_count; c++)
            for (int i = 0; i < 4; i++) {
                uint32_t at[3] = {shell->cells[c][i], shell->cells[c][(i + 1) % 4], shell_centre(shell, c)};
                float level[3];
                for (int k = 0; k < 3; k++) level[k] = ablate_level(shell, &d->sheet->state, at[k]);
                expected += part_inside(level, 0.25);
            }

        ablate(d);
        draw_coarse(d);
        assert_true(expected > 1);
        assert_float_equal(area_of(s), expected, 1e-4);
        expect_no_cracks(s, 12, 9);
        for (uint32_t v = 0; v < s->vertex_count; v++) // a shared vertex exists once
            for (uint32_t w = 0; w < v; w++) assert_true(memcmp(s->position[v], s->position[w], 12) != 0);
    }
}

TEST(levels_near_zero_leave_no_cracks) {
    const float levels[] = {0, 1e-7f, -1e-7f, 3e-5f, -3e-5f, 0.25f, -0.2f};
    for (uint32_t seed = 0; seed < 20; seed++) {
        OwnDrawing *d = plain_drawing(12, 9, 1);
        float *mass_loss = burning_sheet_vary(d->sheet, &d->sheet->shell.matter.mass_loss);
        for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) {
            mass_loss[i] = 0; // tiny levels need a float's full range
            d->sheet->state.burn.mass[i] = levels[random_hash(i, seed, 1, 0) % 7];
        }
        draw_coarse(d);

        const SingeSurface *s = &d->surface;
        size_t count = 3 * (size_t)s->triangle_count;
        Edge *edges = drawn_edges(s);
        for (size_t k = 0; k < count; k++) {
            assert_true(edges[k].a != edges[k].b);
            assert_true(k == 0 || order_by_two(&edges[k - 1], &edges[k]) != 0);
        }

        assert_true(area_of(s) > 0); // no triangle is without area
        free(edges);
    }
}

TEST(crumpled_normals_are_unit) {
    OwnDrawing *d = plain_drawing(6, 6, 0.01f);
    float(*position)[4] = d->sheet->state.dynamics.position;
    const uint32_t *corners = d->sheet->shell.cells[0];

    for (uint32_t i = 0; i < 49; i++)
        for (uint32_t k = 0; k < 3; k++) position[i][k] += 0.02f * random_unit(random_hash(i, k, 5, 0));
    for (uint32_t k = 1; k < 4; k++) memcpy(position[corners[k]], position[corners[0]], 16); // a cell in one point
    draw_coarse(d);
    for (uint32_t v = 0; v < d->surface.vertex_count; v++)
        assert_float_equal(float3_length(float3_load(d->surface.normal[v])), 1, 1e-5);
}

TEST(sheets_and_pieces_are_kept_apart) {
    SingeMaterialDef material = plain_material();
    OwnDrawing *d = calloc(1, sizeof *d);
    d->sheet = burning_sheets(2, 2, 2, 0.01f, &material, 0);
    assert_int_equal(ablate_plan_create(&d->sheet->memory, &d->sheet->shell, &d->plan), SINGE_OK);
    ablate_label(d->plan, &d->sheet->shell, &d->sheet->state.ablate);
    set_level(d, shell_centre(&d->sheet->shell, 4), -0.25f); // a cell of the second sheet
    draw_coarse(d);

    for (uint32_t t = 0; t < d->surface.triangle_count; t++) {
        int32_t sheet = d->surface.position[d->surface.triangles[t][0]][0] > 0.5f;
        for (int i = 0; i < 3; i++) {
            assert_int_equal(d->surface.sheet[d->surface.triangles[t][i]], sheet);
            assert_int_equal(d->surface.piece[d->surface.triangles[t][i]], sheet);
        }
    }
}

/// Every allocation of a first drawing and of one that must grow fails once.
TEST(survives_lack_of_memory) {
    Drawing *small = plain_drawing(2, 2, 0.01f), *large = plain_drawing(9, 9, 0.01f);
    int failures = 0;
    for (int grow = 0; grow < 2; grow++) {
        SingeResult result = SINGE_ERROR_MEMORY;
        for (int n = 0; result; n++) {
            TestAllocator allocator = {0};
            SingeSurface surface = {.allocator = test_allocator(&allocator)};
            const BurningSheet *b = small->sheet;
            if (grow) assert_int_equal(surface_draw(small->plan, &b->shell, &b->state, &surface, NULL), SINGE_OK);
            allocator.calls = 0, allocator.fail_at = n + 1;
            b = large->sheet;
            result = surface_draw(large->plan, &b->shell, &b->state, &surface, NULL);
            assert_true(result == SINGE_OK || result == SINGE_ERROR_MEMORY);

            if (result) {
                failures++;
                assert_int_equal(surface.vertex_count + surface.triangle_count, 0);
                test_allocator_check(&allocator);
                allocator.fail_at = 0; // it can be used again
                assert_int_equal(surface_draw(large->plan, &b->shell, &b->state, &surface, NULL), SINGE_OK);
            }

            assert_int_equal(surface.triangle_count, 9 * 9 * 4);
            singe_surface_free(&surface);
            test_allocator_check(&allocator);
        }
    }

    assert_int_equal(failures, 2 * 19);
    singe_surface_free(NULL);
    drawing_free(small), drawing_free(large);
}

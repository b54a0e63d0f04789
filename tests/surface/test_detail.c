// The surface refined near the front as a mesh: no cracks, linear fields, bent and crumpled sheets, memory.
#include "drawing.h"

#include "drawn_mesh.h"
#include "common/random.h"

/// Levels of about -0.1 to 0.15, smooth over some cells or not at all.
static void set_random_levels(Drawing *d, uint32_t seed) {
    const float scale = 0.4f / d->sheet->shell.sheets[0].cell_size;
    for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) {
        const float *p = d->sheet->shell.rest_position[i];
        float wave = random_noise(scale * p[0], scale * p[1], 0, seed) - 0.4f;
        float rough = random_unit(random_hash(i, seed, 0, 0)) - 0.4f;
        set_level(d, i, 0.25f * (seed & 1 ? wave : rough));
    }
}

static bool covers(const SingeSurface *s, uint32_t t, double x, double y) {
    const uint32_t *corner = s->triangles[t];
    for (int i = 0; i < 3; i++) {
        const float *a = s->position[corner[i]], *b = s->position[corner[(i + 1) % 3]];
        double ax = (double)a[0], ay = (double)a[1];
        if (((double)b[0] - ax) * (y - ay) - ((double)b[1] - ay) * (x - ax) < 0) return false;
    }

    return true;
}

/// The surface goes on right behind an edge of it: a crack. Not asked of edges so short that the point may lie behind
/// another one.
static bool covered_behind(const SingeSurface *s, uint32_t a, uint32_t b) {
    const float *p = s->position[a], *q = s->position[b];
    double x = (double)q[0] - (double)p[0], y = (double)q[1] - (double)p[1], step = 1e-5 / hypot(x, y);
    if (step > 1e-3) return false;
    double px = 0.5 * ((double)p[0] + (double)q[0]) + step * y, py = 0.5 * ((double)p[1] + (double)q[1]) - step * x;
    for (uint32_t t = 0; t < s->triangle_count; t++)
        if (covers(s, t, px, py)) return true;
    return false;
}

/// Every edge is walked once in each direction, or once where the surface ends: there lies nothing behind it.
static void expect_no_cracks(const SingeSurface *s) {
    size_t count = 3 * (size_t)s->triangle_count;
    Edge *edges = drawn_edges(s);
    for (size_t k = 0; k < count; k++) {
        Edge back = {edges[k].b, edges[k].a};
        assert_true(k == 0 || order_by_two(&edges[k - 1], &edges[k]) != 0);
        if (!bsearch(&back, edges, count, sizeof *edges, order_by_two)) assert_false(covered_behind(s, back.b, back.a));
    }

    free(edges);
}

TEST(random_levels_leave_no_cracks) {
    const float details[] = {0.05f, 0.12f, 0.2f, 0.36f, 0.9f};
    for (uint32_t seed = 0; seed < 20; seed++) {
        OwnDrawing *d = fine_drawing(12, 9, 1, details[seed % 5], seed % 3 ? 0.4f : 0);
        State *state = &d->sheet->state;

        set_random_levels(d, seed);
        draw_fine(d); // nothing has been removed yet: the surface ends where the level does
        assert_true(d->surface.triangle_count > 200);
        expect_no_cracks(&d->surface);
        assert_true(area_of(&d->surface) > 1);
        ablate(d);
        draw_fine(d);

        expect_no_cracks(&d->surface);
        for (uint32_t t = 0; t < d->surface.triangle_count; t++) { // nothing is drawn where nothing is
            float x = 0, y = 0;
            for (int i = 0; i < 3; i++) {
                const float *p = d->surface.position[d->surface.triangles[t][i]];
                x += p[0] / 3, y += p[1] / 3;
            }
            assert_true(state->ablate.cell_flags[(int)y * 12 + (int)x] & SINGE_ALIVE);
        }
    }
}

TEST(linear_fields_are_exact) {
    const Linear levels[] = {{0.1, 0.05, -0.333}, {-0.07, 0.11, 0.031}, {0.02, -0.13, 0.217}, {0.09, 0, -0.3141}};
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++) {
        OwnDrawing *d = fine_drawing(7, 5, 1, 0.15f, 0);
        const SingeSurface *s = &d->surface;
        set_linear_fields(d, levels[k]);
        draw_fine(d);
        expect_linear_fields(d, levels[k], 1e-4);

        double min = 1;
        for (uint32_t v = 0; v < s->vertex_count; v++) min = fmin(min, value_at(levels[k], s->position[v]));
        assert_float_equal(min, 0, 2e-6); // cut at the level, wherever that is
    }
}

/// A sheet bent to a cylinder is drawn as one, by the limit surface's own radius: less by side^2/(6 R).
TEST(bent_sheets_are_drawn_round) {
    OwnDrawing *d = fine_drawing(12, 9, 1, 0.1f, 0);
    const float radius = 3, sagitta = 1 / (8 * radius), drawn = (4 + 2 * cosf(1 / radius)) / 6 * radius;
    set_linear_fields(d, (Linear){0.03, 0.07, -0.4});

    for (uint32_t i = 0; i < d->sheet->shell.vertex_count; i++) {
        float *p = d->sheet->state.dynamics.position[i], angle = d->sheet->shell.rest_position[i][0] / radius;
        p[0] = radius * sinf(angle), p[2] = radius * cosf(angle);
    }
    draw_fine(d);

    const SingeSurface *s = &d->surface;
    assert_true(s->fine_triangle_count > 1000);

    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (s->rest_position[v][0] < 1 || s->rest_position[v][0] > 11) continue; // at the border it lies farther out
        float distance = hypotf(s->position[v][0], s->position[v][2]);
        assert_float_equal(distance, drawn, 0.01 * (double)sagitta); // flat cells are off by up to 2
        float outwards = (s->normal[v][0] * s->position[v][0] + s->normal[v][2] * s->position[v][2]) / distance;
        assert_true(outwards > 0.9999f);
    }
}

static Float3 doubled_normal(const SingeSurface *s, uint32_t t) {
    Float3 p = float3_load(s->position[s->triangles[t][0]]), q = float3_load(s->position[s->triangles[t][1]]);
    return float3_cross(float3_sub(q, p), float3_sub(float3_load(s->position[s->triangles[t][2]]), p));
}

/// Far from the origin floats lie 0.5 um apart, wherever the level cuts fine sides.
TEST(no_triangle_is_lost_to_rounding) {
    const Float3 normal = {-0.36f, 0.48f, 0.8f}, along = {0.8f, 0.6f, 0}, up = {-0.48f, 0.64f, -0.6f};
    for (uint32_t seed = 0; seed < 12; seed++) {
        OwnDrawing *d = fine_drawing(12, 9, 2.5e-3f, 4e-4f, seed % 3 ? 1e-3f : 0);
        set_random_levels(d, seed);

        for (uint32_t v = 0; v < d->sheet->shell.vertex_count; v++) {
            const float *rest = d->sheet->shell.rest_position[v];
            Float3 p = float3_mad(float3_mad(float3(5, -6, -7), along, rest[0]), up, rest[1]);
            float3_store(d->sheet->state.dynamics.position[v], p);
        }

        draw_fine(d);
        const SingeSurface *s = &d->surface;
        float thinnest = 1;
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            float longest = 0;
            for (int i = 0; i < 3; i++) {
                const uint32_t *at = s->triangles[t];
                Float3 side = float3_sub(float3_load(s->position[at[(i + 1) % 3]]), float3_load(s->position[at[i]]));
                longest = fmaxf(longest, float3_length(side));
            }

            thinnest = fminf(thinnest, fabsf(float3_dot(doubled_normal(s, t), normal)) / longest);
        }

        assert_true(s->fine_triangle_count > 500);
        assert_true(thinnest > 5e-6f);
    }
}

/// However crumpled the sheet is, its fine triangles face as they would on flat cells, and leave these by `bulge_max`.
TEST(crumpled_sheets_are_not_turned_over) {
    for (uint32_t seed = 0; seed < 8; seed++) {
        Drawing *round = fine_drawing(12, 9, 1, 0.1f, 0), *straight = fine_drawing(12, 9, 1, 0.1f, 0);
        float room[130]; // another surface everywhere: as finely drawn, and as flat as can be
        for (int v = 0; v < 130; v++) room[v] = 1e-9f;

        for (uint32_t v = 0; v < round->sheet->shell.vertex_count; v++) {
            float *p = round->sheet->state.dynamics.position[v];
            p[0] *= seed < 4 ? 1 : 2.5f; // sides of different lengths
            for (int k = 0; k < 3; k++)
                p[k] += (float)(seed % 4 + 1) * 0.4f * (random_unit(random_hash(v, seed, (uint32_t)k, 3)) - 0.5f);
            memcpy(straight->sheet->state.dynamics.position[v], p, 3 * sizeof *p);
        }

        set_random_levels(round, seed), set_random_levels(straight, seed);
        straight->detail.room = room, round->detail.bulge_max = seed & 1 ? 0.06f : 0;
        draw_fine(round), draw_fine(straight);

        const SingeSurface *s = &round->surface, *plain = &straight->surface;
        assert_int_equal(s->triangle_count, plain->triangle_count);

        for (uint32_t t = 0; t < s->triangle_count; t++) {
            assert_true(float3_dot(doubled_normal(s, t), doubled_normal(plain, t)) > 0);
            for (int i = 0; i < 3; i++) { // no step between triangles
                uint32_t a = s->triangles[t][i], b = s->triangles[t][(i + 1) % 3];
                Float3 side = float3_sub(float3_load(s->position[b]), float3_load(s->position[a]));
                Float3 was = float3_sub(float3_load(plain->position[b]), float3_load(plain->position[a]));
                assert_true(float3_length(float3_sub(side, was)) < 0.9f * float3_length(was));
            }
        }

        float farthest = 0;
        for (uint32_t v = 0; v < s->vertex_count; v++)
            farthest = fmaxf(farthest,
                             float3_length(float3_sub(float3_load(s->position[v]), float3_load(plain->position[v]))));
        assert_true(farthest > 0.01f && (!(seed & 1) || farthest < 0.0601f));
        drawing_free(round), drawing_free(straight);
    }
}

/// The level cuts either tear edge otherwise; what is drawn of the one ends before the other.
TEST(tear_edges_at_one_point_are_drawn_apart) {
    SingeMaterialDef material = plain_material();
    for (uint32_t seed = 0; seed < 6; seed++) {
        OwnDrawing *d = drawing_of(burning_spare_sheets(1, 12, 9, 1, &material, 0, 8));
        d->detail = (SurfaceDetail){.size = 0.1f, .raggedness = 0.4f, .seed = seed};
        set_random_levels(d, seed);
        tear_along(d, 4, 7);
        draw_fine(d);

        const SingeSurface *s = &d->surface;
        int ends[2] = {0, 0};
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            float middle = 0;
            for (int i = 0; i < 3; i++) middle += s->rest_position[s->triangles[t][i]][1] / 3;
            for (int i = 0; i < 3; i++) {
                const float *rest = s->rest_position[s->triangles[t][i]], *p = s->position[s->triangles[t][i]];
                if (fabsf(rest[1] - 4) > 0.4f || rest[0] > 6.9f) continue;
                assert_true(middle > 4 ? p[1] > 4 + 5e-5f : p[1] < 4 - 5e-5f);
                ends[middle > 4]++;
            }
        }

        assert_true(ends[0] > 5 && ends[1] > 5);
    }
}

/// A cell's triangles that have been pulled apart are left out once its centre has burnt, and not before.
TEST(triangles_pulled_apart_by_a_lost_corner_are_left_out) {
    OwnDrawing *d = fine_drawing(6, 6, 1, 0.2f, 0);
    const uint32_t cell = cell_at(d->sheet, 2, 2), corner = d->sheet->shell.cells[cell][0];
    const float room[49] = {0};
    d->detail.room = room; // flat cells, which are not split for their bends
    set_linear_fields(d, (Linear){0.03, 0.07, -0.05});
    draw_fine(d);

    uint32_t whole = d->surface.triangle_count;
    d->sheet->state.dynamics.position[corner][0] -= 3;
    draw_fine(d);
    assert_int_equal(d->surface.triangle_count, whole);

    for (int k = 0; k < 4; k++) {
        const Shell *shell = &d->sheet->shell;
        const uint32_t centre = shell_centre(shell, shell->fan[shell->fan_first[corner] + (uint32_t)k]);
        d->sheet->state.burn.mass[centre] -= ablate_level(shell, &d->sheet->state, centre) + 1e-4f;
    }

    draw_fine(d);
    assert_true(d->surface.triangle_count <= whole - 8);

    for (uint32_t t = 0; t < d->surface.triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            uint32_t a = d->surface.triangles[t][i], b = d->surface.triangles[t][(i + 1) % 3];
            Float3 now = float3_sub(float3_load(d->surface.position[b]), float3_load(d->surface.position[a]));
            Float3 rest =
                float3_sub(float3_load(d->surface.rest_position[b]), float3_load(d->surface.rest_position[a]));
            assert_true(float3_length(now) < 2 * float3_length(rest));
        }
}

TEST(whole_sheets_are_drawn_coarsely) {
    OwnDrawing *d = fine_drawing(4, 3, 0.01f, 1e-4f, 1e-3f);
    draw_fine(d);
    assert_int_equal(d->surface.triangle_count, 48);
    assert_int_equal(d->surface.vertex_count, 20 + 12);
    for (uint32_t v = 0; v < 32; v++) assert_float_equal(d->surface.mass[v], 1, 0);

    d->sheet->state.burn.time_ignited[0] = 3; // never ignited ends do not count
    draw_fine(d);
    for (uint32_t v = 0; v < 32; v++)
        assert_float_equal(d->surface.time_ignited[v], d->surface.source_vertex[v] == 0 ? 3 : -1, 0);
}

TEST(threads_draw_the_same) {
    Drawing *one = fine_drawing(25, 25, 0.004f, 4e-4f, 2e-3f), *four = fine_drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    assert_int_equal(pool_create(&four->sheet->memory, (SingeTasks){0}, 4, &four->pool), SINGE_OK);
    burn_rings(one, 0.02f), burn_rings(four, 0.02f);
    draw_fine(one), draw_fine(four);

    const SingeSurface *a = &one->surface, *b = &four->surface;
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_memory_equal(a->triangles, b->triangles, a->triangle_count * sizeof *a->triangles);
    assert_memory_equal(a->position, b->position, a->vertex_count * sizeof *a->position);
    assert_memory_equal(a->mass, b->mass, a->vertex_count * sizeof *a->mass);
    assert_memory_equal(a->temperature, b->temperature, a->vertex_count * sizeof *a->temperature);
    drawing_free(one), drawing_free(four);
}

/// A point of the sheet at a fraction of its cells.
static FineLocation location_at(uint32_t n, uint32_t cells) {
    FineLocation location = {random_hash(n, 1, 0, 0) % cells, (uint8_t)(random_hash(n, 2, 0, 0) & 3), {0}};
    float x = random_unit(random_hash(n, 3, 0, 0)), y = (1 - x) * random_unit(random_hash(n, 4, 0, 0));
    location.weight[0] = x, location.weight[1] = y, location.weight[2] = 1 - x - y;
    return location;
}

/// A walk ends where it would in the plane, across cells that are turned against each other.
TEST(walks_cross_cells) {
    OwnDrawing *d = fine_drawing(5, 4, 1, 0.3f, 0);
    const Shell *shell = &d->sheet->shell;
    for (uint32_t n = 0; n < 2000; n++) {
        FineLocation from = location_at(n, shell->cell_count);
        float x = random_unit(random_hash(n, 5, 0, 0)) - 0.5f, y = random_unit(random_hash(n, 6, 0, 0)) - 0.5f;
        FineLocation to;
        fine_walk(shell, &from, x, y, &to);
        float at[2][2] = {{0}};
        for (int k = 0; k < 2; k++) {
            const FineLocation *location = k ? &to : &from;
            const uint32_t *c = shell->cells[location->cell];
            for (int i = 0; i < 2; i++)
                at[k][i] = location->weight[0] * shell->rest_position[c[location->side]][i] +
                           location->weight[1] * shell->rest_position[c[(location->side + 1) & 3]][i] +
                           location->weight[2] * shell->rest_position[shell_centre(shell, location->cell)][i];
        }

        assert_float_equal(at[1][0], fminf(fmaxf(at[0][0] + x, 0), 5), 1e-5);
        assert_float_equal(at[1][1], fminf(fmaxf(at[0][1] + y, 0), 4), 1e-5);
        for (int i = 0; i < 3; i++) assert_true(to.weight[i] >= -1e-6f);
    }
}

/// A spline is nowhere less in a quarter of a cell than the bound there, but often less than those of other quarters.
TEST(quarters_bound_their_splines) {
    OwnDrawing *d = fine_drawing(5, 4, 1, 0.3f, 0);
    const Shell *shell = &d->sheet->shell;
    float edge[64], corner[64];
    uint32_t less = 0;
    assert_true(shell->springs[SINGE_BLUE].count <= 64 && shell->vertex_count <= 64);
    for (uint32_t n = 0; n < 20000; n++) {
        if (n % 200 == 0)
            for (uint32_t i = 0; i < 64; i++) {
                edge[i] = random_unit(random_hash(n, i, 7, 0)) - 0.5f;
                corner[i] = random_unit(random_hash(n, i, 8, 0)) - 0.5f;
            }
        const Spline spline = {edge, corner};
        const FineLocation at = location_at(n, shell->cell_count);
        const Float4 low = fine_spline_quarters(shell, &spline, at.cell);
        const int near = at.weight[0] > at.weight[1] ? at.side : (at.side + 1) & 3, far = (near + 2) & 3;
        const float value = fine_spline_at(shell, &spline, &at);
        assert_true(value >= low[near] - 1e-6f);
        less += value < low[far] - 0.05f;
    }

    assert_true(less > 100);
}

TEST(survives_lack_of_memory) {
    OwnDrawing *d = fine_drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    const BurningSheet *b = d->sheet;
    SingeSurface surface;
    Memory memory;

    burn_rings(d, 0.02f);
    test_allocations_fail(30,
                          (memory = memory_make(allocator), surface = (SingeSurface){.allocator = allocator},
                           surface_draw_fine(d->plan, &b->shell, &b->state, &d->detail, &memory, NULL, &surface, NULL)),
                          singe_surface_free(&surface));
}

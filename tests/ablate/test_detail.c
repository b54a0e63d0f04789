// The surface refined near the front: no cracks, linear fields, no direction preferred, what is gone stays gone.
#include "ablate/burning_sheet.h"

#include "ablate/drawn_mesh.h"
#include "ablate/surface_fine.h"
#include "base/random.h"
#include "shell/split.h"
#include "support/support.h"

#include <stdio.h>
#include <string.h>

typedef struct Drawing {
    BurningSheet *sheet;
    AblatePlan *plan;
    Pool *pool;
    SurfaceDetail detail;
    SingeSurface surface;
} Drawing;

static Drawing *drawing(uint32_t nx, uint32_t ny, float cell, float detail, float raggedness) {
    SingeMaterialDef material = plain_material();
    Drawing *d = calloc(1, sizeof *d);
    d->sheet = burning_sheet(nx, ny, cell, &material);
    d->detail = (SurfaceDetail){.size = detail, .raggedness = raggedness, .seed = 1};
    assert_int_equal(ablate_plan_create(&d->sheet->memory, &d->sheet->shell, &d->plan), SINGE_OK);
    return d;
}

static void draw(Drawing *d) {
    const BurningSheet *b = d->sheet;
    assert_int_equal(ablate_surface_fine(d->plan, &b->shell, &b->state, &d->detail, &d->sheet->memory, d->pool,
                                         &d->surface, &d->sheet->error), SINGE_OK);
}

static void finish(Drawing *d) {
    singe_surface_free(&d->surface);
    ablate_plan_free(&d->sheet->memory, d->plan);
    if (d->pool) pool_destroy(&d->sheet->memory, d->pool);
    burning_sheet_free(d->sheet);
    free(d);
}

static void set_level(Drawing *d, uint32_t particle, float level) {
    d->sheet->state.burn.mass[particle] = field_at(d->sheet->shell.matter.mass_loss, particle) + level;
}

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

/// Both ends on the same border of a sheet that begins at 0.
static bool on_border(const float *p, const float *q, int axis, float size) {
    float near = 1e-6f * size;
    return (fabsf(p[axis]) < near && fabsf(q[axis]) < near) ||
           (fabsf(p[axis] - size) < near && fabsf(q[axis] - size) < near);
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

/// The surface goes on right behind an edge of it: a crack. Not asked of edges so short that the place may lie behind
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
        assert_true(k == 0 || compare_edges(&edges[k - 1], &edges[k]) != 0);
        if (!bsearch(&back, edges, count, sizeof *edges, compare_edges))
            assert_false(covered_behind(s, back.b, back.a));
    }
    free(edges);
}

static void random_levels_leave_no_cracks(void **unused) {
    (void)unused;
    const float details[] = {0.05f, 0.12f, 0.2f, 0.36f, 0.9f};
    for (uint32_t seed = 0; seed < 20; seed++) {
        Drawing *d = drawing(12, 9, 1, details[seed % 5], seed % 3 ? 0.4f : 0);
        const Shell *shell = &d->sheet->shell;
        State *state = &d->sheet->state;
        set_random_levels(d, seed);
        draw(d); // nothing has been removed yet: the surface ends where the level does
        assert_true(d->surface.triangle_count > 200);
        expect_no_cracks(&d->surface);
        assert_true(area_of(&d->surface) > 1);
        SingeResult result = ablate_step(d->plan, shell, state, NULL, 293, &state->ablate, &d->sheet->events, NULL);
        assert_int_equal(result, SINGE_OK);
        draw(d);
        expect_no_cracks(&d->surface);
        for (uint32_t t = 0; t < d->surface.triangle_count; t++) { // nothing is drawn where nothing is
            float x = 0, y = 0;
            for (int i = 0; i < 3; i++) {
                const float *p = d->surface.position[d->surface.triangles[t][i]];
                x += p[0] / 3, y += p[1] / 3;
            }
            assert_true(state->ablate.cell_flags[(int)y * 12 + (int)x] & SINGE_ALIVE);
        }
        finish(d);
    }
}

/// A field a x + b y + c of the rest position.
typedef struct Linear { double a, b, c; } Linear;
static double value_at(Linear f, const float *p) { return f.a * (double)p[0] + f.b * (double)p[1] + f.c; }

static const Linear temperature = {100, 200, 300}, peak = {-50, 100, 900}, rate = {0.1, -0.1, 1}, ignited = {2, 1, 5};

static void set_linear_fields(Drawing *d, Linear level) {
    BurningSheet *b = d->sheet;
    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        const float *p = b->shell.rest_position[i];
        set_level(d, i, (float)value_at(level, p));
        b->state.heat.temperature[i] = (float)value_at(temperature, p);
        b->state.heat.temperature_peak[i] = (float)value_at(peak, p);
        b->state.burn.burn_rate[i] = (float)value_at(rate, p);
        b->state.burn.time_ignited[i] = (float)value_at(ignited, p);
        b->state.dynamics.velocity[i][2] = (float)value_at((Linear){-3, 1, 0}, p);
        b->state.dynamics.position[i][2] = i < b->shell.vertex_count ? 0.5f * p[0] : 77; // tilted; centres do not count
    }
}

static void linear_fields_are_exact(void **unused) {
    (void)unused;
    const Linear levels[] = {{0.1, 0.05, -0.333}, {-0.07, 0.11, 0.031}, {0.02, -0.13, 0.217}, {0.09, 0, -0.3141}};
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++) {
        Drawing *d = drawing(7, 5, 1, 0.15f, 0);
        const SingeSurface *s = &d->surface;
        set_linear_fields(d, levels[k]);
        draw(d);
        double least = 1;
        for (uint32_t v = 0; v < s->vertex_count; v++) {
            const float *p = s->position[v];
            double level = value_at(levels[k], p);
            least = fmin(least, level);
            assert_float_equal(s->mass[v], 0.25 + level, 2e-6);
            assert_float_equal(s->temperature[v], value_at(temperature, p), 1e-3);
            assert_float_equal(s->temperature_peak[v], value_at(peak, p), 1e-3);
            assert_float_equal(s->burn_rate[v], value_at(rate, p), 1e-5);
            assert_float_equal(s->time_ignited[v], value_at(ignited, p), 2e-5);
            assert_float_equal(s->velocity[v][2], value_at((Linear){-3, 1, 0}, p), 2e-5);
            assert_float_equal(p[2], 0.5 * (double)p[0], 2e-6);
            assert_float_equal(s->uv[v][0], p[0] / 7, 1e-6);
            assert_float_equal(s->uv[v][1], p[1] / 5, 1e-6);
            assert_float_equal(s->rest_position[v][1], p[1], 1e-6);
            assert_float_equal(s->normal[v][0], -0.5 / sqrt(1.25), 1e-4);
            assert_int_equal(s->sheet[v], 0);
            if (s->source_vertex[v] < 0) continue;
            assert_memory_equal(p, d->sheet->state.dynamics.position[s->source_vertex[v]], 12);
        }
        assert_float_equal(least, 0, 2e-6); // cut at the level, wherever that is
        finish(d);
    }
}

/// A sheet bent to a cylinder is drawn nearer to it than its cells are.
static void bent_sheets_are_drawn_round(void **unused) {
    (void)unused;
    Drawing *d = drawing(12, 9, 1, 0.1f, 0);
    const float radius = 3, sagitta = 1 / (8 * radius);
    set_linear_fields(d, (Linear){0.03, 0.07, -0.4});
    for (uint32_t i = 0; i < d->sheet->shell.vertex_count; i++) {
        float *p = d->sheet->state.dynamics.position[i], angle = d->sheet->shell.rest_position[i][0] / radius;
        p[0] = radius * sinf(angle), p[2] = radius * cosf(angle);
    }
    draw(d);
    const SingeSurface *s = &d->surface;
    assert_true(s->fine_triangle_count > 1000);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (s->rest_position[v][0] < 1 || s->rest_position[v][0] > 11) continue; // normals at the border lean
        float distance = hypotf(s->position[v][0], s->position[v][2]);
        assert_float_equal(distance, radius, 0.1 * (double)sagitta);
        float outwards = (s->normal[v][0] * s->position[v][0] + s->normal[v][2] * s->position[v][2]) / distance;
        assert_true(outwards > 0.99f);
    }
    finish(d);
}

static Vec doubled_normal(const SingeSurface *s, uint32_t t) {
    Vec p = vec_load(s->position[s->triangles[t][0]]), q = vec_load(s->position[s->triangles[t][1]]);
    return vec_cross(vec_sub(q, p), vec_sub(vec_load(s->position[s->triangles[t][2]]), p));
}

/// Far from the origin floats lie 0.5 um apart, wherever the level cuts fine sides.
static void no_triangle_is_lost_to_rounding(void **unused) {
    (void)unused;
    const Vec normal = {-0.36f, 0.48f, 0.8f}, along = {0.8f, 0.6f, 0}, up = {-0.48f, 0.64f, -0.6f};
    for (uint32_t seed = 0; seed < 12; seed++) {
        Drawing *d = drawing(12, 9, 2.5e-3f, 4e-4f, seed % 3 ? 1e-3f : 0);
        set_random_levels(d, seed);
        for (uint32_t v = 0; v < d->sheet->shell.vertex_count; v++) {
            const float *rest = d->sheet->shell.rest_position[v];
            Vec p = vec_mad(vec_mad(vec(5, -6, -7), along, rest[0]), up, rest[1]);
            vec_store(d->sheet->state.dynamics.position[v], p);
        }
        draw(d);
        const SingeSurface *s = &d->surface;
        float thinnest = 1;
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            float longest = 0;
            for (int i = 0; i < 3; i++) {
                const uint32_t *at = s->triangles[t];
                Vec side = vec_sub(vec_load(s->position[at[(i + 1) % 3]]), vec_load(s->position[at[i]]));
                longest = fmaxf(longest, vec_length(side));
            }
            thinnest = fminf(thinnest, fabsf(vec_dot(doubled_normal(s, t), normal)) / longest);
        }
        assert_true(s->fine_triangle_count > 500);
        assert_true(thinnest > 5e-6f);
        finish(d);
    }
}

/// However crumpled the sheet is, its fine triangles face as they would on flat cells, and leave these by `bulge_most`.
static void crumpled_sheets_are_not_turned_over(void **unused) {
    (void)unused;
    for (uint32_t seed = 0; seed < 8; seed++) {
        Drawing *round = drawing(12, 9, 1, 0.1f, 0), *straight = drawing(12, 9, 1, 0.1f, 0);
        uint8_t flat[130];
        memset(flat, 1, sizeof flat);
        for (uint32_t v = 0; v < round->sheet->shell.vertex_count; v++) {
            float *p = round->sheet->state.dynamics.position[v];
            p[0] *= seed < 4 ? 1 : 2.5f; // sides of different lengths
            for (int k = 0; k < 3; k++)
                p[k] += (float)(seed % 4 + 1) * 0.4f * (random_unit(random_hash(v, seed, (uint32_t)k, 3)) - 0.5f);
            memcpy(straight->sheet->state.dynamics.position[v], p, 3 * sizeof *p);
        }
        set_random_levels(round, seed), set_random_levels(straight, seed);
        straight->detail.flat = flat, round->detail.bulge_most = seed & 1 ? 0.06f : 0;
        draw(round), draw(straight);
        const SingeSurface *s = &round->surface, *plain = &straight->surface;
        assert_int_equal(s->triangle_count, plain->triangle_count);
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            assert_true(vec_dot(doubled_normal(s, t), doubled_normal(plain, t)) > 0);
            for (int i = 0; i < 3; i++) { // no step between triangles
                uint32_t a = s->triangles[t][i], b = s->triangles[t][(i + 1) % 3];
                Vec side = vec_sub(vec_load(s->position[b]), vec_load(s->position[a]));
                Vec was = vec_sub(vec_load(plain->position[b]), vec_load(plain->position[a]));
                assert_true(vec_length(vec_sub(side, was)) < 0.9f * vec_length(was));
            }
        }
        float farthest = 0;
        for (uint32_t v = 0; v < s->vertex_count; v++)
            farthest = fmaxf(farthest, vec_length(vec_sub(vec_load(s->position[v]), vec_load(plain->position[v]))));
        assert_true(farthest > 0.01f && (!(seed & 1) || farthest < 0.0601f));
        finish(round), finish(straight);
    }
}

/// Tears the sheet along y = row from its border on, up to `length` cells far; the lips stay at one place.
static void tear_along(Drawing *d, uint32_t row, uint32_t length) {
    BurningSheet *b = d->sheet;
    for (uint32_t i = 0; i < length; i++) {
        ShellSplit split = {.vertex = corner_at(b, i, row)};
        Fan fan;
        split_fan(&b->shell, split.vertex, &fan);
        for (int k = 0; k < fan.count; k++) split.cells |= (uint32_t)(fan.cell[k] >= row * b->nx) << k;
        assert_true(split_is_possible(&b->shell, &fan, &split));
        uint32_t spare = split_vertex(&b->shell, &fan, &split).spare;
        memcpy(b->state.dynamics.position[spare], b->state.dynamics.position[split.vertex], 16);
        b->state.burn.mass[spare] = b->state.burn.mass[split.vertex];
        b->state.ablate.particle_flags[spare] = SINGE_ALIVE;
        b->shell.split_count++;
    }
}

/// The level cuts either lip otherwise; what is drawn of the one ends before the other.
static void lips_at_one_place_are_drawn_apart(void **unused) {
    (void)unused;
    SingeMaterialDef material = plain_material();
    for (uint32_t seed = 0; seed < 6; seed++) {
        Drawing *d = calloc(1, sizeof *d);
        d->sheet = burning_spare_sheets(1, 12, 9, 1, &material, 0, 8);
        d->detail = (SurfaceDetail){.size = 0.1f, .raggedness = 0.4f, .seed = seed};
        assert_int_equal(ablate_plan_create(&d->sheet->memory, &d->sheet->shell, &d->plan), SINGE_OK);
        set_random_levels(d, seed);
        tear_along(d, 4, 7);
        draw(d);
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
        finish(d);
    }
}

/// A cell's triangles that have been pulled apart are left out once springs of it have burnt, and not before.
static void what_a_lost_corner_pulls_apart_is_left_out(void **unused) {
    (void)unused;
    Drawing *d = drawing(6, 6, 1, 0.2f, 0);
    const uint32_t cell = cell_at(d->sheet, 2, 2), corner = d->sheet->shell.cells[cell][0];
    set_linear_fields(d, (Linear){0.03, 0.07, -0.05});
    draw(d);
    uint32_t whole = d->surface.triangle_count;
    d->sheet->state.dynamics.position[corner][0] -= 3;
    draw(d);
    assert_int_equal(d->surface.triangle_count, whole);
    for (int k = 0; k < 4; k++) {
        uint32_t other = d->sheet->shell.fan[d->sheet->shell.fan_first[corner] + (uint32_t)k];
        d->sheet->state.ablate.spring_flags[SINGE_BLUE][d->sheet->shell.cell_springs[other].blue[0]] = 0;
    }
    draw(d);
    assert_true(d->surface.triangle_count <= whole - 8);
    for (uint32_t t = 0; t < d->surface.triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            uint32_t a = d->surface.triangles[t][i], b = d->surface.triangles[t][(i + 1) % 3];
            Vec now = vec_sub(vec_load(d->surface.position[b]), vec_load(d->surface.position[a]));
            Vec rest = vec_sub(vec_load(d->surface.rest_position[b]), vec_load(d->surface.rest_position[a]));
            assert_true(vec_length(now) < 2 * vec_length(rest));
        }
    finish(d);
}

static void whole_sheets_are_drawn_coarsely(void **unused) {
    (void)unused;
    Drawing *d = drawing(4, 3, 0.01f, 1e-4f, 1e-3f);
    draw(d);
    assert_int_equal(d->surface.triangle_count, 48);
    assert_int_equal(d->surface.vertex_count, 20 + 12);
    for (uint32_t v = 0; v < 32; v++) assert_float_equal(d->surface.mass[v], 1, 0);
    d->sheet->state.burn.time_ignited[0] = 3; // never ignited ends do not count
    draw(d);
    for (uint32_t v = 0; v < 32; v++)
        assert_float_equal(d->surface.time_ignited[v], d->surface.source_vertex[v] == 0 ? 3 : -1, 0);
    finish(d);
}

/// A fire that burns from some places at 1 m/s: rings, so that the front runs in all directions.
static void burn_rings(Drawing *d, float time) {
    const float at[3][2] = {{0.031f, 0.042f}, {0.068f, 0.075f}, {0.083f, 0.017f}};
    const float width = 0.008f; // of the front, m
    BurnState *burn = &d->sheet->state.burn;
    d->sheet->state.time = (double)time;
    for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) {
        const float *p = d->sheet->shell.rest_position[i];
        float nearest = 1;
        for (int k = 0; k < 3; k++) nearest = fminf(nearest, hypotf(p[0] - at[k][0], p[1] - at[k][1]));
        float mass = 0.6f + (nearest - time) / width;
        if (mass < 1) burn->time_ignited[i] = nearest - 0.4f * width;
        if (mass < 0.25f) burn->time_burnt[i] = nearest + 0.35f * width;
        burn->mass[i] = fminf(1, fmaxf(0.15f, mass));
    }
}

enum { DIRECTIONS = 36 };

/// Adds the lengths of the edges that end the surface within the sheet by their direction.
static void add_directions(const SingeSurface *s, double length[DIRECTIONS]) {
    size_t count = 3 * (size_t)s->triangle_count;
    Edge *edges = drawn_edges(s);
    for (size_t k = 0; k < count; k++) {
        Edge back = {edges[k].b, edges[k].a};
        const float *p = s->rest_position[back.a], *q = s->rest_position[back.b];
        if (bsearch(&back, edges, count, sizeof *edges, compare_edges)) continue;
        if (on_border(p, q, 0, 0.1f) || on_border(p, q, 1, 0.1f)) continue;
        double x = (double)q[0] - (double)p[0], y = (double)q[1] - (double)p[1];
        int bin = (int)floor(atan2(y, x) * DIRECTIONS / 3.14159265358979 + 0.5); // the axes in the middle of theirs
        length[((bin % DIRECTIONS) + DIRECTIONS) % DIRECTIONS] += hypot(x, y);
    }
    free(edges);
}

/// The largest share of a direction over the mean, over a whole fire.
static double preference(Drawing *d, bool fine) {
    double length[DIRECTIONS] = {0}, sum = 0, most = 0;
    for (int step = 0; step < 12; step++) {
        State *state = &d->sheet->state;
        burn_rings(d, 0.004f + 0.0023f * (float)step);
        SingeResult result = ablate_step(d->plan, &d->sheet->shell, state, NULL, 293, &state->ablate, &d->sheet->events,
                                         NULL);
        assert_int_equal(result, SINGE_OK);
        if (fine) draw(d);
        else assert_int_equal(ablate_surface(d->plan, &d->sheet->shell, state, &d->surface, NULL), SINGE_OK);
        add_directions(&d->surface, length);
    }
    for (int k = 0; k < DIRECTIONS; k++) sum += length[k], most = fmax(most, length[k]);
    return most * DIRECTIONS / sum;
}

static void no_direction_is_preferred(void **unused) {
    (void)unused;
    Drawing *coarse = drawing(25, 25, 0.004f, 4e-4f, 2e-3f), *fine = drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    double before = preference(coarse, false), after = preference(fine, true);
    printf("largest share of a direction over the mean: %.2f as cells are, %.2f refined\n", before, after);
    assert_true(after < 1.3);
    assert_true(after < before);
    finish(coarse), finish(fine);
}

/// A place of the sheet at a fraction of its cells.
static FinePlace place_at(uint32_t n, uint32_t cells) {
    FinePlace place = {random_hash(n, 1, 0, 0) % cells, (uint8_t)(random_hash(n, 2, 0, 0) & 3), {0}};
    float x = random_unit(random_hash(n, 3, 0, 0)), y = (1 - x) * random_unit(random_hash(n, 4, 0, 0));
    place.weight[0] = x, place.weight[1] = y, place.weight[2] = 1 - x - y;
    return place;
}

/// Which points of a raster lie in a triangle of the surface.
static void raster(const SingeSurface *s, int width, int height, float step, uint8_t *covered) {
    memset(covered, 0, (size_t)(width * height));
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const float *a = s->position[s->triangles[t][0]], *b = s->position[s->triangles[t][1]];
        const float *c = s->position[s->triangles[t][2]];
        int x0 = (int)ceilf(fminf(a[0], fminf(b[0], c[0])) / step);
        int y0 = (int)ceilf(fminf(a[1], fminf(b[1], c[1])) / step);
        int x1 = (int)floorf(fmaxf(a[0], fmaxf(b[0], c[0])) / step);
        int y1 = (int)floorf(fmaxf(a[1], fmaxf(b[1], c[1])) / step);
        for (int y = y0; y <= y1 && y < height; y++)
            for (int x = x0; x <= x1 && x < width; x++) {
                float p[2] = {step * (float)x, step * (float)y};
                float ab = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                float bc = (c[0] - b[0]) * (p[1] - b[1]) - (c[1] - b[1]) * (p[0] - b[0]);
                float ca = (a[0] - c[0]) * (p[1] - c[1]) - (a[1] - c[1]) * (p[0] - c[0]);
                if (ab >= 0 && bc >= 0 && ca >= 0) covered[y * width + x] = 1;
            }
    }
}

static void what_is_gone_stays_gone(void **unused) {
    (void)unused;
    enum { WIDTH = 301, HEIGHT = 226 };
    static uint8_t before[WIDTH * HEIGHT], after[WIDTH * HEIGHT];
    Drawing *d = drawing(12, 9, 1, 0.1f, 0.5f);
    State *state = &d->sheet->state;
    int gone = 0, back = 0;
    memset(before, 1, sizeof before);
    for (uint32_t step = 0; step < 30; step++) {
        for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) { // each burns as it likes
            float *mass = &state->burn.mass[i];
            if (state->ablate.particle_flags[i] & SINGE_ALIVE)
                *mass = fmaxf(0.15f, *mass - 0.1f * random_unit(random_hash(i, step, 7, 0)));
        }
        SingeResult result = ablate_step(d->plan, &d->sheet->shell, state, NULL, 293, &state->ablate, &d->sheet->events,
                                         NULL);
        assert_int_equal(result, SINGE_OK);
        draw(d);
        raster(&d->surface, WIDTH, HEIGHT, 0.04f, after);
        for (int k = 0; k < WIDTH * HEIGHT; k++) gone += !after[k], back += after[k] && !before[k];
        memcpy(before, after, sizeof before);
    }
    assert_true(gone > WIDTH * HEIGHT);
    printf("%d of %d places gone are drawn again\n", back, gone);
    assert_true(back * 2000 < gone); // where a fine edge cuts straight through what is curved
    finish(d);
}

static void edges_are_eaten_by_a_length(void **unused) {
    (void)unused;
    // straight fronts of different widths across the sheet: they lose the same strip
    double lost[3];
    const float width[3] = {0.5f, 0.1f, 0.03f};
    for (int k = 0; k < 3; k++) {
        Drawing *d = drawing(30, 30, 0.004f, 4e-4f, 1.5e-3f);
        float angle = 0.5f;
        for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) {
            const float *p = d->sheet->shell.rest_position[i];
            set_level(d, i, (p[0] * cosf(angle) + p[1] * sinf(angle) - 0.07f) / width[k] * 0.2f);
        }
        d->detail.raggedness = 0;
        draw(d);
        double whole = area_of(&d->surface);
        d->detail.raggedness = 1.5e-3f;
        draw(d);
        lost[k] = whole - area_of(&d->surface);
        double length = 0.12; // of the front, about
        assert_true(lost[k] > 0.15 * 1.5e-3 * length && lost[k] < 1.5e-3 * length * 1.2);
        finish(d);
    }
    assert_float_equal(lost[1] / lost[0], 1, 0.02);
    assert_float_equal(lost[2] / lost[0], 1, 0.02);
}

/// Whether a place of the raster within `reach` of (x, y) is covered, or is not, as wanted.
static bool near_a_place_that_is(const uint8_t *raster, bool wanted, int size, int x, int y, int reach) {
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < size && j < size && (i - x) * (i - x) + (j - y) * (j - y) <= reach * reach &&
                raster[j * size + i] == wanted)
                return true;
    return false;
}

static void edges_stay_within_a_cell(void **unused) {
    (void)unused;
    enum { SIZE = 201 };
    static uint8_t coarse[SIZE * SIZE], fine[SIZE * SIZE];
    Drawing *d = drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    int missing = 0, reach = (int)(0.004f / 0.0005f);
    for (int step = 0; step < 12; step++) {
        State *state = &d->sheet->state;
        burn_rings(d, 0.004f + 0.0023f * (float)step);
        SingeResult result = ablate_step(d->plan, &d->sheet->shell, state, NULL, 293, &state->ablate, &d->sheet->events,
                                         NULL);
        assert_int_equal(result, SINGE_OK);
        assert_int_equal(ablate_surface(d->plan, &d->sheet->shell, state, &d->surface, NULL), SINGE_OK);
        raster(&d->surface, SIZE, SIZE, 0.0005f, coarse);
        draw(d);
        raster(&d->surface, SIZE, SIZE, 0.0005f, fine);
        for (int k = 0; k < SIZE * SIZE; k++) {
            if (coarse[k] == fine[k]) continue;
            missing += coarse[k];
            assert_true(near_a_place_that_is(coarse, fine[k], SIZE, k % SIZE, k / SIZE, reach));
        }
    }
    assert_true(missing > 1000);
    finish(d);
}

static void finer_details_converge(void **unused) {
    (void)unused;
    double area[4];
    const float detail[4] = {2e-3f, 1e-3f, 5e-4f, 2.5e-4f};
    for (int k = 0; k < 4; k++) {
        Drawing *d = drawing(25, 25, 0.004f, detail[k], 0);
        burn_rings(d, 0.02f);
        draw(d);
        area[k] = area_of(&d->surface);
        finish(d);
    }
    assert_true(fabs(area[2] - area[1]) < 0.5 * fabs(area[1] - area[0]));
    assert_true(fabs(area[3] - area[2]) < 0.5 * fabs(area[2] - area[1]));
}

static void threads_draw_the_same(void **unused) {
    (void)unused;
    Drawing *one = drawing(25, 25, 0.004f, 4e-4f, 2e-3f), *four = drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    assert_int_equal(pool_create(&four->sheet->memory, (SingeTasks){0}, 4, &four->pool), SINGE_OK);
    burn_rings(one, 0.02f), burn_rings(four, 0.02f);
    draw(one), draw(four);
    const SingeSurface *a = &one->surface, *b = &four->surface;
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_memory_equal(a->triangles, b->triangles, a->triangle_count * sizeof *a->triangles);
    assert_memory_equal(a->position, b->position, a->vertex_count * sizeof *a->position);
    assert_memory_equal(a->mass, b->mass, a->vertex_count * sizeof *a->mass);
    assert_memory_equal(a->temperature, b->temperature, a->vertex_count * sizeof *a->temperature);
    finish(one), finish(four);
}

/// A walk ends where it would in the plane, across cells that are turned against each other.
static void walks_cross_cells(void **unused) {
    (void)unused;
    Drawing *d = drawing(5, 4, 1, 0.3f, 0);
    const Shell *shell = &d->sheet->shell;
    for (uint32_t n = 0; n < 2000; n++) {
        FinePlace from = place_at(n, shell->cell_count);
        float x = random_unit(random_hash(n, 5, 0, 0)) - 0.5f, y = random_unit(random_hash(n, 6, 0, 0)) - 0.5f;
        FinePlace to = fine_walk(shell, from, x, y);
        float at[2][2] = {{0}};
        for (int k = 0; k < 2; k++) {
            const FinePlace *place = k ? &to : &from;
            const uint32_t *c = shell->cells[place->cell];
            for (int i = 0; i < 2; i++)
                at[k][i] = place->weight[0] * shell->rest_position[c[place->side]][i] +
                           place->weight[1] * shell->rest_position[c[(place->side + 1) & 3]][i] +
                           place->weight[2] * shell->rest_position[shell_centre(shell, place->cell)][i];
        }
        assert_float_equal(at[1][0], fminf(fmaxf(at[0][0] + x, 0), 5), 1e-5);
        assert_float_equal(at[1][1], fminf(fmaxf(at[0][1] + y, 0), 4), 1e-5);
        for (int i = 0; i < 3; i++) assert_true(to.weight[i] >= -1e-6f);
    }
    finish(d);
}

static void survives_lack_of_memory(void **unused) {
    (void)unused;
    Drawing *d = drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    const BurningSheet *b = d->sheet;
    SingeResult result = SINGE_ERROR_MEMORY;
    burn_rings(d, 0.02f);
    int failures = 0;
    for (int n = 0; result; n++) {
        TestAllocator allocator = {.fail_at = n + 1};
        Memory memory = memory_make(test_allocator(&allocator));
        SingeSurface surface = {.allocator = test_allocator(&allocator)};
        result = ablate_surface_fine(d->plan, &b->shell, &b->state, &d->detail, &memory, NULL, &surface, NULL);
        assert_int_equal(memory.held, 0);
        assert_true(result == SINGE_OK || result == SINGE_ERROR_MEMORY);
        failures += result != SINGE_OK;
        if (result) assert_int_equal(surface.vertex_count + surface.triangle_count + surface.vertex_capacity, 0);
        singe_surface_free(&surface);
        assert_int_equal(allocator.bytes, 0);
    }
    assert_true(failures > 30);
    finish(d);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_levels_leave_no_cracks),
        cmocka_unit_test(linear_fields_are_exact),
        cmocka_unit_test(bent_sheets_are_drawn_round),
        cmocka_unit_test(no_triangle_is_lost_to_rounding),
        cmocka_unit_test(crumpled_sheets_are_not_turned_over),
        cmocka_unit_test(lips_at_one_place_are_drawn_apart),
        cmocka_unit_test(what_a_lost_corner_pulls_apart_is_left_out),
        cmocka_unit_test(whole_sheets_are_drawn_coarsely),
        cmocka_unit_test(no_direction_is_preferred),
        cmocka_unit_test(what_is_gone_stays_gone),
        cmocka_unit_test(edges_are_eaten_by_a_length),
        cmocka_unit_test(edges_stay_within_a_cell),
        cmocka_unit_test(finer_details_converge),
        cmocka_unit_test(threads_draw_the_same),
        cmocka_unit_test(walks_cross_cells),
        cmocka_unit_test(survives_lack_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

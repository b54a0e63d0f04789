// Where the refined surface ends: no direction preferred, what is gone stays gone, near the edge that cells make.
#include "drawing.h"

#include "drawn_mesh.h"
#include "common/random.h"

/// Both ends on the same border of a sheet that begins at 0.
static bool on_border(const float *p, const float *q, int axis, float size) {
    float near = 1e-6f * size;
    return (fabsf(p[axis]) < near && fabsf(q[axis]) < near) ||
           (fabsf(p[axis] - size) < near && fabsf(q[axis] - size) < near);
}

enum { DIRECTIONS = 36 };

/// Adds the lengths of the edges that end the surface within the sheet by their direction.
static void add_directions(const SingeSurface *s, double length[DIRECTIONS]) {
    size_t count = 3 * (size_t)s->triangle_count;
    Edge *edges = drawn_edges(s);
    for (size_t k = 0; k < count; k++) {
        Edge back = {edges[k].b, edges[k].a};
        const float *p = s->rest_position[back.a], *q = s->rest_position[back.b];
        if (bsearch(&back, edges, count, sizeof *edges, order_by_two)) continue;
        if (on_border(p, q, 0, 0.1f) || on_border(p, q, 1, 0.1f)) continue;
        double x = (double)q[0] - (double)p[0], y = (double)q[1] - (double)p[1];
        int bin = (int)floor(atan2(y, x) * DIRECTIONS / 3.14159265358979 + 0.5); // the axes in the middle of theirs
        length[((bin % DIRECTIONS) + DIRECTIONS) % DIRECTIONS] += hypot(x, y);
    }

    free(edges);
}

/// The largest share of a direction over the mean, over a whole fire.
static double preference(Drawing *d, bool fine) {
    double length[DIRECTIONS] = {0}, sum = 0, max = 0;
    for (int step = 0; step < 12; step++) {
        burn_rings(d, 0.004f + 0.0023f * (float)step);
        ablate(d);
        if (fine) draw_fine(d);
        else draw_coarse(d);
        add_directions(&d->surface, length);
    }

    for (int k = 0; k < DIRECTIONS; k++) sum += length[k], max = fmax(max, length[k]);
    return max * DIRECTIONS / sum;
}

TEST(no_direction_is_preferred) {
    Drawing *coarse = fine_drawing(25, 25, 0.004f, 4e-4f, 2e-3f), *fine = fine_drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    double before = preference(coarse, false), after = preference(fine, true);
    printf("largest share of a direction over the mean: %.2f as cells are, %.2f refined\n", before, after);
    assert_true(after < 1.3);
    assert_true(after < before);
    drawing_free(coarse), drawing_free(fine);
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

TEST(removed_surface_stays_removed) {
    enum { WIDTH = 301, HEIGHT = 226 };
    static uint8_t before[WIDTH * HEIGHT], after[WIDTH * HEIGHT];
    OwnDrawing *d = fine_drawing(12, 9, 1, 0.1f, 0.5f);
    State *state = &d->sheet->state;
    int gone = 0, back = 0;
    memset(before, 1, sizeof before);

    for (uint32_t step = 0; step < 30; step++) {
        for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) { // each burns as it likes
            float *mass = &state->burn.mass[i];
            if (state->ablate.particle_flags[i] & SINGE_ALIVE)
                *mass = fmaxf(0.15f, *mass - 0.1f * random_unit(random_hash(i, step, 7, 0)));
        }

        ablate(d);
        draw_fine(d);
        raster(&d->surface, WIDTH, HEIGHT, 0.04f, after);
        for (int k = 0; k < WIDTH * HEIGHT; k++) gone += !after[k], back += after[k] && !before[k];
        memcpy(before, after, sizeof before);
    }

    assert_true(gone > WIDTH * HEIGHT);
    printf("%d of %d pixels gone are drawn again\n", back, gone);
    assert_true(back * 2000 < gone); // where a fine edge cuts straight through what is curved
}

TEST(edges_are_eaten_by_a_length) {
    // straight fronts of different widths across the sheet: they lose the same strip
    double lost[3];
    const float width[3] = {0.5f, 0.1f, 0.03f};
    for (int k = 0; k < 3; k++) {
        OwnDrawing *d = fine_drawing(30, 30, 0.004f, 4e-4f, 1.5e-3f);
        float angle = 0.5f;
        for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) {
            const float *p = d->sheet->shell.rest_position[i];
            set_level(d, i, (p[0] * cosf(angle) + p[1] * sinf(angle) - 0.07f) / width[k] * 0.2f);
        }

        d->detail.raggedness = 0;
        draw_fine(d);

        double whole = area_of(&d->surface);
        d->detail.raggedness = 1.5e-3f;
        draw_fine(d);
        lost[k] = whole - area_of(&d->surface);

        double length = 0.12; // of the front, about
        assert_true(lost[k] > 0.15 * 1.5e-3 * length && lost[k] < 1.5e-3 * length * 1.2);
    }

    assert_float_equal(lost[1] / lost[0], 1, 0.02);
    assert_float_equal(lost[2] / lost[0], 1, 0.02);
}

/// Whether some pixel of the raster within `reach` of (x, y) is covered, or uncovered, as wanted.
static bool near_one_that_is(const uint8_t *raster, bool wanted, int size, int x, int y, int reach) {
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < size && j < size && (i - x) * (i - x) + (j - y) * (j - y) <= reach * reach &&
                raster[j * size + i] == wanted)
                return true;
    return false;
}

TEST(edges_stay_within_a_cell) {
    enum { SIZE = 201 };
    static uint8_t coarse[SIZE * SIZE], fine[SIZE * SIZE];
    OwnDrawing *d = fine_drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
    int missing = 0, reach = (int)(0.004f / 0.0005f);
    for (int step = 0; step < 12; step++) {
        burn_rings(d, 0.004f + 0.0023f * (float)step);
        ablate(d);
        draw_coarse(d);
        raster(&d->surface, SIZE, SIZE, 0.0005f, coarse);
        draw_fine(d);
        raster(&d->surface, SIZE, SIZE, 0.0005f, fine);

        for (int k = 0; k < SIZE * SIZE; k++) {
            if (coarse[k] == fine[k]) continue;
            missing += coarse[k];
            assert_true(near_one_that_is(coarse, fine[k], SIZE, k % SIZE, k / SIZE, reach));
        }
    }

    assert_true(missing > 1000);
}

TEST(finer_details_converge) {
    double area[4];
    const float detail[4] = {2e-3f, 1e-3f, 5e-4f, 2.5e-4f};
    for (int k = 0; k < 4; k++) {
        OwnDrawing *d = fine_drawing(25, 25, 0.004f, detail[k], 0);
        burn_rings(d, 0.02f);
        draw_fine(d);
        area[k] = area_of(&d->surface);
    }

    assert_true(fabs(area[2] - area[1]) < 0.5 * fabs(area[1] - area[0]));
    assert_true(fabs(area[3] - area[2]) < 0.5 * fabs(area[2] - area[1]));
}

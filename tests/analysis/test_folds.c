// The drawn surface along folds that run at an angle to the rows of cells: smooth, and of flat cells.
#include "analysis/wrinkles.h"
#include "surface/drawing.h"
#include "common/random.h"

static const float cell = 2.5e-3f;
enum { CELLS = 40 };

/// A fold of 140 degrees and of 390 1/m at its sharpest, this many degrees off the rows; cells as uneven at rest as
/// those of a grid that is read.
static Drawing *folded(float degrees) {
    Drawing *d = fine_drawing(CELLS, CELLS, cell, 4e-4f, 2e-3f);
    const float turn = degrees * 0.01745329f, half = 1.2f, wide = half / 390;
    for (uint32_t v = 0; v < d->sheet->shell.vertex_count; v++) {
        float *rest = d->sheet->shell.rest_position[v], *p = d->sheet->state.dynamics.position[v];
        for (int k = 0; k < 2; k++) rest[k] += 0.15f * cell * (2 * random_unit(random_hash(v, (uint32_t)k, 3, 7)) - 1);

        float x = rest[0] - CELLS * cell / 2, y = rest[1] - CELLS * cell / 2;
        float off = x * cosf(turn) - y * sinf(turn), along = x * sinf(turn) + y * cosf(turn), across = 0, height = 0;
        const int steps = 400; // the angle goes as tanh; summed up from the fold
        for (int i = 0; i < steps; i++) {
            float angle = half * tanhf(((float)i + 0.5f) / steps * off / wide);
            across += cosf(angle) * off / steps, height -= sinf(angle) * off / steps;
        }
        p[0] = across, p[1] = along, p[2] = height;
    }

    return d;
}

static double drawn_angle(float degrees, const float *room) {
    Folds folds = {0};
    OwnDrawing *d = folded(degrees);
    d->detail.room = room, d->detail.bulge_max = 2.25e-4f; // of contact at its usual thickness
    draw_fine(d);
    assert_true(folds_add(&d->surface, &folds));
    assert_true(folds.count > 50);
    return folds_angle(&folds);
}

/// 0.48 to 0.60 degrees on the smooth surface, 1.15 to 1.18 on flat cells, as they are drawn where another surface lies
/// at once beside them: the bar of 1 degree is between.
TEST(slanting_folds_are_smooth) {
    float room[(CELLS + 1) * (CELLS + 1)] = {0};
    for (float degrees = 4; degrees < 16; degrees += 4) {
        double smooth = drawn_angle(degrees, NULL), flat = drawn_angle(degrees, room);
        print_message("%.0f degrees off the rows: smooth %.2f, flat %.2f degrees rms\n", (double)degrees, smooth, flat);
        assert_true(smooth < 0.8);
        assert_true(flat > 1.05);
    }
}

TEST(flat_sheets_have_no_folds) {
    Folds folds = {0};
    OwnDrawing *d = fine_drawing(CELLS, CELLS, cell, 4e-4f, 2e-3f);
    draw_fine(d);
    assert_true(folds_add(&d->surface, &folds));
    assert_float_equal(folds.count, 0, 0);
    assert_true(isnan(folds_angle(&folds)));
}

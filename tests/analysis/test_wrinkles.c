// Sheets whose creases and wrinkles are known, drawn as the program draws them: four triangles a cell, normals from
// the facets.

#include "support/test.h"

#include "analysis/wrinkles.h"
#include "formats/formats.h"

static const double side = 0.12, pi = 3.14159265358979323846;

/// Height over the sheet, m.
typedef double Height(double x, double y, double number);

static void set_vertex(SingeSurface *s, uint32_t v, double x, double y, double z) {
    const float rest[3] = {(float)x, 0.3f, (float)y}, position[3] = {(float)x, (float)(0.3 - z), (float)y};
    memcpy(s->rest_position[v], rest, sizeof rest); // it stands upright: no axis of space is the sheet's normal
    memcpy(s->position[v], position, sizeof position);
    s->uv[v][0] = (float)(x / side), s->uv[v][1] = (float)(y / side);
    s->burn[v] = x < side / 3 ? 1 : 0, s->time_ignited[v] = x < side / 3 ? 1 : -1;
}

static void add_normals(SingeSurface *s) {
    for (uint32_t f = 0; f < s->triangle_count; f++) {
        const uint32_t *t = s->triangles[f];
        float a[3], b[3], n[3];
        for (int k = 0; k < 3; k++) {
            a[k] = s->position[t[1]][k] - s->position[t[0]][k];
            b[k] = s->position[t[2]][k] - s->position[t[0]][k];
        }
        for (int k = 0; k < 3; k++) n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) s->normal[t[i]][k] += n[k];
    }
}

/// A square sheet of cells by cells.
static SingeSurface draw(int cells, Height *height, double number) {
    const uint32_t n = (uint32_t)cells, row = n + 1, corners = row * row;
    SingeSurface s;
    assert_true(surface_new(&s, corners + n * n, 4 * n * n));

    const double step = side / cells;
    for (uint32_t v = 0; v < corners; v++) {
        double x = v % row * step, y = v / row * step;
        set_vertex(&s, v, x, y, height(x, y, number));
    }

    for (uint32_t c = 0; c < n * n; c++) {
        const uint32_t a = c / n * row + c % n, corner[4] = {a, a + 1, a + row + 1, a + row};
        double z = 0;
        for (int i = 0; i < 4; i++) z += (0.3 - (double)s.position[corner[i]][1]) / 4;
        set_vertex(&s, corners + c, (c % n + 0.5) * step, (c / n + 0.5) * step, z);
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t *t = s.triangles[4 * c + i];
            t[0] = corner[i], t[1] = corner[(i + 1) & 3], t[2] = corners + c;
        }
    }

    add_normals(&s);
    return s;
}

static void look_too(int cells, Height *height, double number, Wrinkles *wrinkles) {
    OwnSurface s = draw(cells, height, number);
    assert_true(wrinkles_add(&s, wrinkles));
}

static Wrinkles look(int cells, Height *height, double number) {
    Wrinkles wrinkles = {0};
    look_too(cells, height, number, &wrinkles);
    return wrinkles;
}

/// A fold of 40 degrees, 6 mm wide, along this many degrees through the middle.
static double fold(double x, double y, double degrees) {
    double angle = degrees * pi / 180, off = (y - side / 2) * cos(angle) - (x - side / 2) * sin(angle);
    return 0.36 * 0.003 * log(cosh(off / 0.003));
}

/// Share of the bend within this many degrees of a direction.
static double share_near(const Wrinkles *w, double degrees, double within) {
    double near = 0, total = 0;
    for (int b = 0; b < WRINKLE_BINS; b++) {
        double off = fmod(fabs((b + 0.5) * 180 / WRINKLE_BINS - degrees), 180);
        total += w->crease[b];
        if (fmin(off, 180 - off) <= within) near += w->crease[b];
    }

    return near / total;
}

TEST(folds_run_where_they_run) {
    const double angles[] = {0, 30, 45, 68, 90, 117, 135, 150};
    for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
        Wrinkles w = look(48, fold, angles[k]);
        print_message("fold along %.0f degrees: %.3f of the bend within 10 degrees, axis over diagonal %.3g\n",
                      angles[k], share_near(&w, angles[k], 10), wrinkles_bias(&w));
        assert_true(share_near(&w, angles[k], 10) > 0.9);
        if (fmod(angles[k], 90) == 0) assert_true(wrinkles_bias(&w) > 20);
        if (fmod(angles[k], 90) == 45) assert_true(wrinkles_bias(&w) < 0.05);
    }
}

static struct { double x, y, phase; } wave[64];

static void set_waves(int seed) {
    for (int i = 0; i < 64; i++) {
        wave[i].x = cos(pi * i / 64), wave[i].y = sin(pi * i / 64);
        wave[i].phase = 377 * sin(12.9898 * (i + 64 * seed) + 4.1);
    }
}

/// Waves of this length in all directions, none preferred.
static double waves(double x, double y, double length) {
    double z = 0;
    for (int i = 0; i < 64; i++) z += cos(2 * pi / length * (x * wave[i].x + y * wave[i].y) + wave[i].phase);
    return 2e-4 * z / 8 * length / 0.012;
}

/// However fine the mesh is, of three cells a wave or more: shorter ones it cannot draw alike in all directions.
TEST(even_waves_have_no_direction) {
    const int cells[] = {32, 48, 96};
    const double lengths[] = {0.012, 0.016, 0.024};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            Wrinkles w = {0};
            for (int seed = 0; seed < 8; seed++) {
                set_waves(seed);
                look_too(cells[k], waves, lengths[i], &w);
            }
            print_message("waves of %.0f mm, cells of %.2f mm: axis over diagonal %.3f\n", 1e3 * lengths[i],
                          1e3 * side / cells[k], wrinkles_bias(&w));
            assert_true(fabs(wrinkles_bias(&w) - 1) < 0.12);
        }
}

/// A fold of 100 degrees, some 5 mm wide, along this many degrees, a part of a cell off the middle.
static double sharp_fold(double x, double y, double degrees) {
    const double angle = degrees * pi / 180, beside = 0.5 * sin(78.233 * degrees) * side / 60;
    const double off = (y - side / 2) * cos(angle) - (x - side / 2) * sin(angle) - beside;
    return 1.19 * 0.0015 * log(cosh(off / 0.0015));
}

/// Nor do sharp folds, of two or three rows of cells, seem to follow the mesh that draws them. Diagonals of the sheet are
/// longer than its sides: so the ratio on a finer mesh is what it should be.
TEST(even_folds_have_no_direction) {
    Wrinkles w = {0}, fine = {0};
    for (int i = 0; i < 48; i++) {
        const double degrees = (i + 0.5) * 180 / 48;
        look_too(60, sharp_fold, degrees, &w);
        look_too(160, sharp_fold, degrees, &fine);
    }

    const double all = wrinkles_bias(&w) / wrinkles_bias(&fine);
    const double sharp = wrinkles_bias_sharp(&w) / wrinkles_bias_sharp(&fine);
    print_message("folds of 100 degrees: axis over diagonal %.3f of that on a fine mesh, sharp bends %.3f\n", all,
                  sharp);
    assert_true(fabs(all - 1) < 0.05 && fabs(sharp - 1) < 0.05);
}

/// Waves up and down x, of a slope of 0.1, where x is below a third; a tenth of it beyond.
static double ripple(double x, double y, double length) {
    (void)y;
    return (x < side / 3 + 0.011 ? 0.1 : 0.01) * length / (2 * pi) * sin(2 * pi * x / length);
}

TEST(power_matches_the_waves) {
    const double lengths[] = {0.006, 0.008, 0.012, 0.06};
    for (int k = 0; k < 4; k++) {
        Wrinkles w = look(192, ripple, lengths[k]);
        double share = sqrt(2 * log(2)) / lengths[k]; // exp(-(2 pi deviation/length)^2/2) of both Gaussians
        double band = exp(-0.5 * pow(share * 0.003, 2)) - exp(-0.5 * pow(share * 0.015, 2));
        double expected = 0.5 * pow(0.1 * band, 2);
        print_message("waves of %.0f mm: power %.3g, %.3g expected; %.3g where unburnt\n", 1e3 * lengths[k],
                      wrinkles_burnt(&w), expected, wrinkles_unburnt(&w));
        if (lengths[k] < 0.02) {
            assert_true(fabs(wrinkles_burnt(&w) / expected - 1) < 0.2);
            assert_true(fabs(wrinkles_burnt(&w) / wrinkles_unburnt(&w) / 100 - 1) < 0.2);
        } else {
            assert_true(wrinkles_burnt(&w) < 0.1 * 0.5 * 0.1 * 0.1); // out of the band
        }
    }
}

static double flat(double x, double y, double unused) {
    (void)x, (void)y, (void)unused;
    return 0;
}

TEST(flat_sheets_have_no_waves) {
    Wrinkles w = look(24, flat, 0), none = {0};
    assert_true(w.axis + w.diagonal < 1e-9);
    assert_true(wrinkles_burnt(&w) < 1e-12 && w.unburnt_area > 0);
    SingeSurface empty = {0};
    assert_true(wrinkles_add(&empty, &none));
    assert_true(isnan(wrinkles_bias(&none)) && isnan(wrinkles_burnt(&none)));
}

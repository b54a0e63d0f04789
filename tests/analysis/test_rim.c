// Rims whose curl, slope and shrinkage are known: a sheet whose left edge has burnt, rolled, shrunk, seamed or whole.

#include "support/test.h"

#include "analysis/rim.h"
#include "formats/formats.h"

enum { CELLS = 60 };
static const double side = 0.06, rolled = 0.02, degree = 3.14159265358979323846 / 180;

typedef struct Sheet {
    double curl;   ///< degrees over 10 mm, of what lies within 20 mm of the left edge
    double shrunk; ///< length along that edge over that at rest, within 8 mm of it
    bool burnt;    ///< that edge
    bool seam;     ///< the vertices 5 mm from that edge are doubled
    bool second;   ///< a smaller piece beside it, whose burnt edge stands upright
} Sheet;

/// The sheet leaves its plane upwards; x is the distance from the edge at rest.
static void position(const Sheet *sheet, double x, double y, float *position, float *normal) {
    const double radius = sheet->curl > 0 ? 0.01 / (sheet->curl * degree) : INFINITY;
    double turn = x < rolled ? (rolled - x) / radius : 0;
    double px = x, pz = 0;
    if (turn > 0) px = rolled - radius * sin(turn), pz = radius * (1 - cos(turn));
    const float p[3] = {(float)px, (float)(x < 0.008 ? y * sheet->shrunk : y), (float)pz};
    const float n[3] = {(float)sin(turn), 0, (float)cos(turn)};
    memcpy(position, p, sizeof p);
    memcpy(normal, n, sizeof n);
}

static void add_cell(SingeSurface *s, uint32_t *f, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    const uint32_t first[3] = {a, b, c}, second[3] = {a, c, d};
    memcpy(s->triangles[(*f)++], first, sizeof first);
    memcpy(s->triangles[(*f)++], second, sizeof second);
}

/// A second piece: 10 by 10 mm, upright, all of it burnt.
static void add_second(SingeSurface *s, uint32_t v, uint32_t *f) {
    for (uint32_t i = 0; i < 4; i++) {
        const float x = i == 1 || i == 2 ? 0.01f : 0, y = i >= 2 ? 0.01f : 0;
        const float rest[3] = {x + 0.1f, y, 0}, now[3] = {0.1f, y, x}, normal[3] = {1, 0, 0};
        memcpy(s->rest_position[v + i], rest, sizeof rest);
        memcpy(s->position[v + i], now, sizeof now);
        memcpy(s->normal[v + i], normal, sizeof normal);
        s->burn[v + i] = 1, s->mass[v + i] = 0.2f, s->piece[v + i] = 7;
    }

    add_cell(s, f, v, v + 1, v + 2, v + 3);
}

static Rim look(Sheet sheet) {
    const uint32_t row = CELLS + 1, seam = 5, plain = row * row, extra = sheet.seam ? row : 0;
    OwnSurface s;
    assert_true(surface_new(&s, plain + extra + (sheet.second ? 4 : 0), 2 * CELLS * CELLS + (sheet.second ? 2 : 0)));
    for (uint32_t v = 0; v < plain + extra; v++) {
        uint32_t i = v < plain ? v % row : seam, j = v < plain ? v / row : v - plain;
        double x = i * side / CELLS, y = j * side / CELLS;
        const float rest[3] = {(float)x, (float)y, 0};
        memcpy(s.rest_position[v], rest, sizeof rest);
        position(&sheet, x, y, s.position[v], s.normal[v]);
        s.burn[v] = sheet.burnt && i == 0 ? 1 : 0; // the edges that meet it have not burnt
        s.mass[v] = (float)fmin(0.25 + 0.75 * x / 0.012, 1);
    }

    uint32_t f = 0;
    for (uint32_t j = 0; j < CELLS; j++)
        for (uint32_t i = 0; i < CELLS; i++) {
            uint32_t a = j * row + i, d = a + row;
            bool moved = sheet.seam && i == seam; // the cells right of the seam have its second vertices
            add_cell(&s, &f, moved ? plain + j : a, a + 1, d + 1, moved ? plain + j + 1 : d);
        }

    if (sheet.second) add_second(&s, plain + extra, &f);
    Rim rim = {0};
    assert_true(rim_add(&s, &rim));
    return rim;
}

static void near_to(double value, double expected, double off) {
    if (!(fabs(value - expected) <= off)) fail_msg("%g instead of %g", value, expected);
}

static double ratio(const Rim *rim, int band) { return rim->band[band].area / rim->band[band].rest_area; }

static double height(const Rim *rim, int band) { return rim->band[band].height / rim->band[band].rest_area; }

TEST(a_flat_rim_has_no_curl) {
    Rim rim = look((Sheet){.shrunk = 1, .burnt = true});
    near_to(rim_percentile(rim.curl, 0.9), 0, 0.5);
    near_to(rim.curl_max, 0, 0.1);

    for (int b = 0; b < RIM_BANDS; b++) {
        near_to(ratio(&rim, b), 1, 1e-5);
        near_to(rim_percentile(rim.band[b].slope, 0.9), 0, 0.5);
        near_to(rim.band[b].height, 0, 1e-9);
        double area = side * (rim_band_limits[b + 1] - rim_band_limits[b]);
        near_to(rim.band[b].rest_area, area, 0.15 * area);
    }

    near_to(rim.band[2].mass / rim.band[2].rest_area, 0.25 + 0.75 * 3 / 12, 0.02);
}

TEST(a_rolled_rim_curls) {
    static const double curls[] = {8, 30, 60};
    for (int i = 0; i < 3; i++) {
        Rim rim = look((Sheet){.curl = curls[i], .shrunk = 1, .burnt = true});

        // the rim's own normal is the mean over its first 1.5 mm
        near_to(rim_percentile(rim.curl, 0.5), curls[i] * (10 - 0.75) / 10, 0.06 * curls[i]);
        near_to(rim_percentile(rim.band[3].slope, 0.5), curls[i] * (20 - 5.5) / 10, 0.08 * curls[i]);
        near_to(rim_percentile(rim.band[6].slope, 0.9), 0, 1);
        assert_true(height(&rim, 0) > height(&rim, 4) && height(&rim, 4) > 0);
        near_to(ratio(&rim, 3), 1, 0.01); // rolling shrinks nothing
    }
}

TEST(a_shrunk_rim_is_smaller) {
    Rim rim = look((Sheet){.shrunk = 0.6, .burnt = true});
    near_to(ratio(&rim, 0), 0.6, 0.001);
    near_to(ratio(&rim, 2), 0.6, 0.001);
    near_to(ratio(&rim, 5), 1, 0.05);
    near_to(rim_percentile(rim.band[0].slope, 0.9), 0, 0.5);
}

TEST(only_burnt_edges_are_rims) {
    Rim rim = look((Sheet){.curl = 30, .shrunk = 1, .burnt = false});
    assert_true(isnan(rim_percentile(rim.curl, 0.5)));
    for (int b = 0; b < RIM_BANDS; b++) assert_true(rim.band[b].rest_area == 0);
}

TEST(seams_are_no_rims) {
    Rim whole = look((Sheet){.curl = 30, .shrunk = 1, .burnt = true});
    Rim seamed = look((Sheet){.curl = 30, .shrunk = 1, .burnt = true, .seam = true});
    assert_memory_equal(&whole, &seamed, sizeof whole);
}

TEST(only_the_largest_piece_counts) {
    Rim alone = look((Sheet){.curl = 30, .shrunk = 1, .burnt = true});
    Rim both = look((Sheet){.curl = 30, .shrunk = 1, .burnt = true, .second = true});
    assert_memory_equal(&alone, &both, sizeof alone);
}

TEST(sums_are_weighted_by_area) {
    Rim small = look((Sheet){.curl = 8, .shrunk = 1, .burnt = true});
    Rim large = look((Sheet){.curl = 60, .shrunk = 1, .burnt = true}), sum = small;
    rim_sum(&large, &sum);
    near_to(sum.band[1].rest_area, small.band[1].rest_area + large.band[1].rest_area, 1e-12);
    assert_true(sum.curl_max == large.curl_max);
    double median = rim_percentile(sum.curl, 0.5);
    assert_true(median > rim_percentile(small.curl, 0.4) && median < rim_percentile(large.curl, 0.6));
}

TEST(an_empty_surface_has_no_rim) {
    SingeSurface none = {0};
    Rim rim = {0};
    assert_true(rim_add(&none, &rim));
    assert_true(isnan(rim_percentile(rim.curl, 0.5)));
}

// The exact predicates against integers, pairs of triangles against known cases, the tree against all pairs.

#include "support/test.h"

#include "analysis/crossings.h"
#include "analysis/exact.h"

static uint64_t random_state = 1;

static uint32_t random_bits(void) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(random_state >> 33);
}

static int random_integer(int max) { return (int)(random_bits() % (2 * (uint32_t)max + 1)) - max; }

// ---- orientation

typedef __int128 Wide;

static Wide minor(const int64_t p[3], const int64_t q[3], const int64_t r[3]) {
    Wide sum = 0;
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        sum += (Wide)p[k] * ((Wide)q[l] * r[m] - (Wide)q[m] * r[l]);
    }
    return sum;
}

static int orient3_of_integers(int64_t p[4][3]) {
    int64_t from[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) from[i][k] = p[i][k] - p[3][k];
    const Wide value = minor(from[0], from[1], from[2]);
    return (value > 0) - (value < 0);
}

/// Points of whole coordinates up to `max`, of which a fourth is put into the plane of the others half of the time.
static void random_points(int max, int64_t p[4][3]) {
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) p[i][k] = random_integer(max);
    const int64_t s = random_integer(3), t = random_integer(3);
    if (random_bits() % 2) return;
    for (int k = 0; k < 3; k++) p[3][k] = p[0][k] + s * (p[1][k] - p[0][k]) + t * (p[2][k] - p[0][k]);
}

TEST(orientation_has_the_exact_sign) {
    int flat = 0;
    for (int trial = 0; trial < 200000; trial++) {
        const int max = trial % 2 ? 3 : 1 << 20, shift = random_integer(90);
        int64_t p[4][3];
        float at[4][3];
        random_points(max, p);
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++) at[i][k] = ldexpf((float)p[i][k], shift);

        const int expected = orient3_of_integers(p);
        flat += expected == 0;
        assert_int_equal(exact_orient3(at[0], at[1], at[2], at[3]), expected);
        assert_int_equal(exact_orient3(at[1], at[0], at[2], at[3]), -expected);

        const Wide turn =
            (Wide)(p[0][0] - p[2][0]) * (p[1][1] - p[2][1]) - (Wide)(p[0][1] - p[2][1]) * (p[1][0] - p[2][0]);
        assert_int_equal(exact_orient2(at[0], at[1], at[2], 0, 1), (turn > 0) - (turn < 0));
    }

    assert_in_range(flat, 90000, 180000);
}

/// A point a little off the plane of 0, p, q and p + q, whose differences no double holds: d (q x p) has the sign.
TEST(orientation_is_exact_near_a_plane) {
    for (int trial = 0; trial < 100000; trial++) {
        int64_t p[4][3];
        float at[4][3];
        const int shift = trial % 90;
        random_points(100, p);

        for (int k = 0; k < 3; k++) {
            p[3][k] = p[1][k] + p[2][k], p[0][k] %= 2;
            at[0][k] = ldexpf((float)p[0][k], -30);
            for (int i = 1; i < 4; i++) at[i][k] = ldexpf((float)p[i][k], shift - 20);
        }

        const Wide value = minor(p[0], p[2], p[1]);
        assert_int_equal(exact_orient3(at[0], at[1], at[2], at[3]), (value > 0) - (value < 0));
        assert_int_equal(exact_orient3(at[3], at[1], at[2], at[0]), (value < 0) - (value > 0));
    }
}

/// Signs that doubles cannot decide: the smallest of floats next to the largest.
TEST(orientation_is_exact_far_apart) {
    const float huge = 0x1p126f, min = 0x1p-149f;
    const float a[3] = {huge, 0, 0}, b[3] = {0, huge, 0}, c[3] = {-huge, -huge, 0};
    const float d[3] = {1, 2, 0}, below[3] = {1, 2, -min}, above[3] = {1, 2, min};

    assert_int_equal(exact_orient3(a, b, c, d), 0);
    assert_int_equal(exact_orient3(a, b, c, below), 1);
    assert_int_equal(exact_orient3(a, b, c, above), -1);

    // a plane that no axis is normal to: x + y + z = 0 but for the last of its bits
    const float e[3] = {1, -1, 0}, f[3] = {0, 1, -1}, g[3] = {0x1p60f, 0, -0x1p60f};
    const float on[3] = {0x1p-80f, 0x1p-80f, -0x1p-79f}, off[3] = {0x1p-80f, 0x1p-80f, -0x1.000002p-79f};
    assert_int_equal(exact_orient3(e, f, g, on), 0);
    assert_int_equal(abs(exact_orient3(e, f, g, off)), 1);
    assert_int_equal(exact_orient3(e, f, g, off), exact_orient3(e, f, g, (float[3]){0, 0, -1}));

    // p + (2^-40, 2^-40) is on the diagonal through p, and rounds to no float there
    const float p[3] = {0, 0, 0}, q[3] = {0x1p-40f, 0x1p-40f, 5}, r[3] = {1, 1, 7}, s[3] = {1, 0x1.000002p0f, 7};
    assert_int_equal(exact_orient2(p, q, r, 0, 1), 0);
    assert_int_equal(exact_orient2(p, q, s, 0, 1), 1);
    assert_true(exact_collinear((float[3]){1, 2, 3}, (float[3]){2, 4, 6}, (float[3]){-3, -6, -9}));
    assert_false(exact_collinear((float[3]){1, 2, 3}, (float[3]){2, 4, 6}, (float[3]){-3, -6, -9.000001f}));
}

// ---- pairs

typedef struct Case {
    const char *what;
    float a[3][3], b[3][3];
    bool cross;
} Case;

static const Case cases[] = {
    {"one pierces the other", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, -1}, {1, 1, 1}, {2, 1, 1}}, true},
    {"edge through edge", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{2, -1, -1}, {2, 1, -1}, {2, 0, 1}}, true},
    {"apart", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, 1}, {1, 1, 2}, {2, 1, 2}}, false},
    {"apart in a plane", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{3, 3, 0}, {5, 3, 0}, {3, 5, 0}}, false},
    {"corner on a face", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, 0}, {1, 1, 2}, {2, 1, 2}}, false},
    {"edge on a face", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, 0}, {2, 1, 0}, {2, 1, 2}}, false},
    {"edge on edge", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 0, 0}, {3, 0, 0}, {2, -1, 2}}, false},
    {"edge touches edge", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{2, 0, -1}, {2, 0, 1}, {2, -1, 0}}, false},
    {"neighbours along an edge", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{4, 0, 0}, {0, 0, 0}, {2, -3, 1}}, false},
    {"neighbours in a plane", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{4, 0, 0}, {0, 0, 0}, {2, -3, 0}}, false},
    {"folded shut", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{4, 0, 0}, {0, 0, 0}, {2, 3, 0}}, true},
    {"neighbours at a corner", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 0, 0}, {-4, 0, 1}, {0, -4, 1}}, false},
    {"a corner shared, and through", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 0, 0}, {2, 2, -1}, {2, 2, 1}}, true},
    {"a corner shared, overlapping flat", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 0, 0}, {3, 1, 0}, {1, 3, 0}}, true},
    {"the same", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, true},
    {"the same, turned over", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 0, 0}, {0, 4, 0}, {4, 0, 0}}, true},
    {"one within the other", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}, true},
    {"flat star", {{0, 0, 0}, {4, 0, 0}, {2, 3, 0}}, {{0, 2, 0}, {4, 2, 0}, {2, -1, 0}}, true},
    {"flat, a corner on an edge", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{2, 0, 0}, {3, -1, 0}, {1, -1, 0}}, false},
    {"a hair above", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, 1e-40f}, {2, 1, 1e-40f}, {1, 2, 1e-40f}}, false},
    {"a hair through", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, -1e-40f}, {2, 1, 1e-40f}, {1, 2, 1e-40f}}, true},
};

/// The answer is the same for all orders of the corners, for both orders of the triangles, and with exchanged axes.
static void check_case(const Case *one, int turn) {
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    float a[3][3], b[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) a[i][(k + turn) % 3] = one->a[i][k], b[i][(k + turn) % 3] = one->b[i][k];

    for (int i = 0; i < 36; i++) {
        const int *s = orders[i / 6], *t = orders[i % 6];
        const Corners first = {a[s[0]], a[s[1]], a[s[2]]}, second = {b[t[0]], b[t[1]], b[t[2]]};
        bool touch;
        if (triangles_cross(first, second, &touch) != one->cross ||
            triangles_cross(second, first, &touch) != one->cross)
            fail_msg("%s, order %d, turned %d", one->what, i, turn);
    }
}

TEST(pairs_match_a_plain_search) {
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int turn = 0; turn < 3; turn++) check_case(&cases[i], turn);
}

// ---- the tree

enum { MAX = 3000 };

typedef struct Soup {
    uint32_t count;
    float position[3 * MAX][3];
    uint32_t triangles[MAX][3];
} Soup;

/// Triangles of about `size` in the unit cube, on a lattice where `steps` is above 0; those on a line are left out.
static Soup *soup_make(uint32_t count, float size, int steps) {
    Soup *soup = calloc(1, sizeof *soup);
    assert_non_null(soup);

    while (soup->count < count) {
        float(*p)[3] = &soup->position[3 * soup->count], centre[3];
        for (int k = 0; k < 3; k++) centre[k] = (float)random_bits() * 0x1p-31f;
        for (int i = 0; i < 9; i++) {
            float x = centre[i % 3] + size * ((float)random_bits() * 0x1p-31f - 0.5f);
            p[i / 3][i % 3] = steps ? roundf(x * (float)steps) / (float)steps : x;
        }

        if (exact_collinear(p[0], p[1], p[2])) continue;
        for (uint32_t k = 0; k < 3; k++) soup->triangles[soup->count][k] = 3 * soup->count + k;
        soup->count++;
    }

    return soup;
}

static void check_soup(Soup *soup) {
    const float(*position)[3] = (const float(*)[3])soup->position;
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])soup->triangles;
    const size_t pairs = (size_t)soup->count * soup->count / 2 + 1;
    uint32_t(*touching)[2] = malloc(pairs * sizeof *touching);
    bool *crossing = calloc((size_t)soup->count * soup->count + 1, sizeof *crossing);
    size_t touches = 0, count = 0;

    assert_true(touching && crossing);
    for (uint32_t a = 0; a < soup->count; a++)
        for (uint32_t b = a + 1; b < soup->count; b++) {
            const Corners first = {position[3 * a], position[3 * a + 1], position[3 * a + 2]};
            const Corners second = {position[3 * b], position[3 * b + 1], position[3 * b + 2]};
            bool touch;
            if (triangles_cross(first, second, &touch)) crossing[a * soup->count + b] = true, count++;
            else if (touch) touching[touches][0] = a, touching[touches++][1] = b;
        }

    assert_true(hinges_find(position, triangles, soup->count, touching, &touches));
    for (size_t i = 0; i < touches; i++) crossing[touching[i][0] * soup->count + touching[i][1]] = true, count++;

    CrossingList list;
    assert_true(crossings_find(position, triangles, soup->count, &list));
    assert_int_equal(list.count, count);

    for (size_t i = 0; i < list.count; i++) {
        bool *pair = &crossing[list.pairs[i][0] * soup->count + list.pairs[i][1]];
        assert_true(*pair);
        *pair = false; // each once
    }

    assert_true(soup->count < 10 || count > 0);
    crossings_free(&list);
    free(touching);
    free(crossing);
    free(soup);
}

TEST(the_tree_finds_what_a_plain_search_finds) {
    for (uint32_t count = 0; count < 10; count++) check_soup(soup_make(count, 1, 0));
    check_soup(soup_make(300, 1, 0));
    check_soup(soup_make(2000, 0.2f, 0));
    check_soup(soup_make(1000, 0.4f, 16));
    check_soup(soup_make(500, 1, 3)); // many lie on top of each other
}

/// A sheet of cells x cells squares of side 1/cells at a height of its own.
static void add_sheet(uint32_t cells, int sheet, float tilt, float (*position)[3], uint32_t (*triangles)[3]) {
    const uint32_t side = cells + 1, first = (uint32_t)sheet * side * side;
    uint32_t(*t)[3] = triangles + 2 * (size_t)sheet * cells * cells;

    for (uint32_t v = 0; v < side * side; v++) {
        float *p = position[first + v];
        p[0] = (float)(v % side) / (float)cells, p[1] = (float)(v / side) / (float)cells;
        p[2] = 0.01f * (float)sheet + tilt * p[0];
    }

    for (uint32_t c = 0; c < cells * cells; c++) {
        const uint32_t v = first + c / cells * side + c % cells;
        const uint32_t corners[6] = {v, v + 1, v + side, v + 1, v + side + 1, v + side};
        memcpy(*t, corners, sizeof corners);
        t += 2;
    }
}

/// A sheet of four squares in z = 0 with the lines x = -1, 0 and 1, and another that meets it along a line of its own.
typedef struct Meeting {
    const char *what;
    float ridge[3], foot[3], other[3]; ///< where the middle line of the second sheet lies, and those beside it
    bool cross;
} Meeting;

static const Meeting meetings[] = {
    {"straight through", {0, 0, 0}, {0, 0, 1}, {0, 0, -1}, true},
    {"through, and bent", {0, 0, 0}, {0.5f, 0, 1}, {0.75f, 0, -1}, true},
    {"a ridge on it", {0, 0, 0}, {0.5f, 0, 1}, {-0.5f, 0, 1}, false},
    {"through between the lines", {0.25f, 0, 0}, {0.25f, 0, 1}, {0.25f, 0, -1}, true},
    {"a ridge between the lines", {0.25f, 0, 0}, {0.5f, 0, 1}, {0, 0, 1}, false},
    {"stands on it", {0.25f, 0, 1}, {0.25f, 0, 2}, {0.25f, 0, 0}, false},
    {"beside it", {1, 0, 0}, {1, 0, 1}, {1, 0, -1}, false},
    {"folded shut on it", {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, true}, // with itself
};

/// Squares between three lines along y, cut by diagonals.
static void add_lines(const float *const lines[3], uint32_t first, float (*position)[3], uint32_t (*triangles)[3]) {
    for (uint32_t v = 0; v < 9; v++)
        for (int k = 0; k < 3; k++) position[first + v][k] = lines[v % 3][k] + (k == 1 ? (float)(v / 3) : 0);
    for (uint32_t c = 0; c < 4; c++) {
        const uint32_t v = first + c / 2 * 3 + c % 2;
        const uint32_t corners[6] = {v, v + 1, v + 3, v + 1, v + 4, v + 3};
        memcpy(triangles[2 * c], corners, sizeof corners);
    }
}

TEST(hinges_are_no_crossings) {
    static const float left[3] = {-1, 0, 0}, middle[3] = {0, 0, 0}, right[3] = {1, 0, 0};
    for (size_t i = 0; i < sizeof meetings / sizeof *meetings; i++)
        for (int apart = 0; apart < 4; apart++) { // lines at the same positions, or not; the sheets' order
            const Meeting *m = &meetings[i];
            float position[18][3];
            uint32_t triangles[16][3];
            CrossingList list;
            const uint32_t first = apart & 1 ? 9 : 0;
            add_lines((const float *const[3]){left, middle, right}, first, position, triangles + (first ? 8 : 0));
            const uint32_t second = 9 - first;
            add_lines((const float *const[3]){m->other, m->ridge, m->foot}, second, position,
                      triangles + (first ? 0 : 8));
            for (uint32_t v = second; v < second + 9 && apart & 2; v++)
                position[v][1] = 0.75f * position[v][1] + 0.125f;
            assert_true(crossings_find((const float(*)[3])position, (const uint32_t(*)[3])triangles, 16, &list));
            if ((list.count > 0) != m->cross) fail_msg("%s, %d: %zu", m->what, apart, list.count);
            crossings_free(&list);
        }
}

/// A stack of eight sheets: the number of tested pairs grows with the triangles, not with their square.
TEST(cost_grows_with_the_triangles) {
    enum { SHEETS = 8, LARGE = 80 };
    float(*position)[3] = calloc(SHEETS * (LARGE + 1) * (LARGE + 1), sizeof *position);
    uint32_t(*triangles)[3] = calloc(2 * SHEETS * LARGE * LARGE, sizeof *triangles);
    double each[2];
    for (int size = 0; size < 2; size++) {
        const uint32_t cells = size ? LARGE : LARGE / 4, count = 2 * SHEETS * cells * cells;
        CrossingList list;
        for (int sheet = 0; sheet < SHEETS; sheet++) add_sheet(cells, sheet, 0.1f, position, triangles);
        assert_true(crossings_find((const float(*)[3])position, (const uint32_t(*)[3])triangles, count, &list));
        assert_int_equal(list.count, 0);
        each[size] = (double)list.tested / count;
        crossings_free(&list);
    }

    assert_true(each[1] < 1.5 * each[0]);
    free(position);
    free(triangles);
}

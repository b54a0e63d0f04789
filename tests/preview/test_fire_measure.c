// The measures of the ember line and of flames, on layers whose line and colours are known.

#include "fixture.h"

enum { WIDE = 400, HIGH = 300 };

typedef struct Frame {
    float glow[HIGH * WIDE][3], depth[HIGH * WIDE];
    int32_t sheet[HIGH * WIDE];
} Frame;

/// From 1 m above a plane that is 0.4 m wide in the picture: 1 mm a pixel.
static PreviewDef camera_above(void) {
    PreviewDef def = preview_default();
    def.width = WIDE;
    def.height = HIGH;
    def.camera = (PreviewCamera){.eye = {0, 0, 1}, .up = {0, 1, 0}, .fov = 2 * atanf(0.15f)};
    return def;
}

/// A line of this half width through the middle, that fades over two pixels, on a sheet that leans by `slope`.
static void draw_line(Frame *frame, float angle, float half, float slope) {
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            int i = y * WIDE + x;
            float u = (float)x + 0.5f - WIDE / 2, v = HIGH / 2 - (float)y - 0.5f;
            frame->depth[i] = 1 / (1 + slope * u * 1e-3f); // the plane z = slope x
            float d = fabsf(cosf(angle) * v - sinf(angle) * u);
            float glow = fminf(fmaxf(0.5f * (half - d) + 0.5f, 0), 1);
            frame->sheet[i] = 0;
            for (int k = 0; k < 3; k++) frame->glow[i][k] = glow;
        }
}

static double measured(Frame *frame) {
    PreviewDef def = camera_above();
    PreviewLayers layers = {.glow = frame->glow, .depth = frame->depth, .sheet = frame->sheet};
    double width;
    assert_int_equal(preview_glow_width(&def, &layers, &width, NULL), SINGE_OK);
    return width;
}

static Frame frame;

TEST(a_glow_has_its_width) {
    static const float half[] = {2, 4, 10};
    for (int w = 0; w < 3; w++)
        for (float angle = 0; angle < 3.2f; angle += 0.13f) {
            draw_line(&frame, angle, half[w], 0);
            double expected = 1e-3 * (2 * (double)half[w] + 1.6); // a tenth is reached 0.8 pixels beyond the half
            assert_true(fabs(measured(&frame) - expected) < 1.3e-3);
        }
}

/// A tilted glow is measured along the sheet: 10 pixels across are 14 mm at 45 degrees.
TEST(a_leaning_glow_is_measured_along_itself) {
    draw_line(&frame, 1.5707963f, 5, 1);
    assert_true(fabs(measured(&frame) - 11.6e-3 * sqrt(2)) < 2e-3);
}

/// A hot ball, which is no sheet, does not count.
TEST(only_sheets_count) {
    draw_line(&frame, 0.4f, 5, 0);
    for (int i = 0; i < WIDE * HIGH; i++) frame.sheet[i] = -1;
    assert_true(isnan(measured(&frame)));
    memset(frame.glow, 0, sizeof frame.glow), memset(frame.sheet, 0, sizeof frame.sheet);
    assert_true(isnan(measured(&frame)));
}

/// Flames as tongues of 6 x 30 mm, 20 mm apart, from `left` on, that begin `up` above a line of fuel 200 mm long through the
/// middle of white paper.
static FlameFeet feet_of(int left, int up) {
    enum { VERTICES = 201, TONGUES = 5 };
    static uint8_t rgb[HIGH * WIDE * 3];
    static float beauty[HIGH * WIDE][3], fire[HIGH * WIDE][4], burn[HIGH * WIDE];
    static float position[VERTICES][3], rate[VERTICES];
    const PreviewDef def = camera_above();
    memset(rgb, 0, sizeof rgb), memset(fire, 0, sizeof fire);
    for (int i = 0; i < HIGH * WIDE; i++) {
        frame.depth[i] = 1, frame.sheet[i] = 0;
        beauty[i][0] = beauty[i][1] = beauty[i][2] = 1;
    }
    for (int v = 0; v < VERTICES; v++) position[v][0] = 1e-3f * (float)(v - VERTICES / 2), rate[v] = 1;
    for (int i = 0; i < TONGUES * 6 * 30; i++) {
        const int x = WIDE / 2 + left + 20 * (i / 180) + i % 6, y = HIGH / 2 - up - i % 180 / 6, at = y * WIDE + x;
        memcpy(rgb + 3 * at, (const uint8_t[]){255, 180, 60}, 3);
        fire[at][0] = fire[at][1] = fire[at][2] = 0.9f;
    }

    PreviewLayers layers = {.beauty = beauty, .fire = fire, .burn = burn, .depth = frame.depth, .sheet = frame.sheet};
    const SingeSurface surface = {.vertex_count = VERTICES, .position = position, .burn_rate = rate};
    FlameFeet feet;
    assert_int_equal(preview_flame_feet(&def, &layers, rgb, &surface, &feet, NULL), SINGE_OK);
    return feet;
}

/// Flames on what burns, above it, and beside it.
TEST(feet_have_their_distance) {
    const FlameFeet on = feet_of(-80, 1), above = feet_of(-80, 20), beside = feet_of(112, 1);
    assert_true(on.median < 2e-3 && on.most < 2e-3 && on.astray == 0);
    assert_true(fabs(above.median - 20e-3) < 2e-3 && above.astray == 0);
    assert_true(beside.median > 40e-3 && beside.most > 80e-3 && beside.astray > 0.85); // one leans that far
}

/// Of a hundred rows twenty are pale, thirty lemon and fifty orange; white paper that a flame lights does not count.
TEST(flames_have_their_shares) {
    static const uint8_t colours[4][3] = {{255, 245, 190}, {255, 240, 60}, {250, 150, 20}, {255, 250, 240}};
    static uint8_t rgb[HIGH * WIDE * 3];
    static float beauty[HIGH * WIDE][3], fire[HIGH * WIDE][4];
    PreviewDef def = camera_above();
    PreviewLayers layers = {.beauty = beauty, .fire = fire};
    FlameShares shares;
    for (int i = 0; i < WIDE * HIGH; i++) {
        const int row = i / WIDE, what = row >= 100 ? 3 : row < 20 ? 0 : row < 50 ? 1 : 2;
        memcpy(rgb + 3 * i, colours[what], 3);
        for (int k = 0; k < 3; k++) {
            beauty[i][k] = 2;
            fire[i][k] = what == 3 ? 0.9f : 1.1f;
        }
    }

    preview_flame_shares(&def, &layers, rgb, &shares);
    assert_true(fabs(shares.pale - 0.2) < 1e-9 && fabs(shares.lemon - 0.3) < 1e-9);
    for (int i = 0; i < 100 * WIDE; i++) fire[i][0] = fire[i][1] = fire[i][2] = 0.9f; // paper everywhere
    preview_flame_shares(&def, &layers, rgb, &shares);
    assert_true(isnan(shares.pale) && isnan(shares.lemon));
}

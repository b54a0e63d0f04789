// Flame and smoke in the picture: where they are, what colour they have, what hides them, what they light.

#include "fixture.h"
#include "synthetic.h"
#include "synthetic_gas.h"
#include "support/support.h"

#include <math.h>

enum { SIDE = 12, CELLS = SIDE * SIDE * SIDE };

/// A cube of gas of 12 cells of 8 mm about (x, y, z), in which a ball of `radius` m burns or smokes.
typedef struct Ball {
    float temperature[CELLS], smoke[CELLS], flame[CELLS], velocity[CELLS][3];
    SingeGas gas;
} Ball;

static void ball_make(Ball *b, float x, float y, float z, float radius, float flame, float smoke) {
    const float cell = 0.008f, half = 0.5f * SIDE * cell;
    memset(b, 0, sizeof *b);
    b->gas = (SingeGas){.size = {SIDE, SIDE, SIDE}, .origin = {x - half, y - half, z - half}, .cell = cell,
                        .temperature = b->temperature, .smoke = b->smoke, .flame = b->flame,
                        .velocity = (const float (*)[3])b->velocity};
    for (int i = 0; i < CELLS; i++) {
        float at[3] = {(float)(i % SIDE), (float)(i / SIDE % SIDE), (float)(i / SIDE / SIDE)}, r2 = 0;
        for (int c = 0; c < 3; c++) r2 += (at[c] + 0.5f - 0.5f * SIDE) * (at[c] + 0.5f - 0.5f * SIDE);
        bool in = r2 * cell * cell < radius * radius;
        b->temperature[i] = in && flame > 0 ? 1400 : 293, b->flame[i] = in ? flame : 0, b->smoke[i] = in ? smoke : 0;
        b->velocity[i][2] = 1;
    }
}

static void draw_gas(const PreviewDef *def, const SingeSurface *surface, const SingeGas *gas, double time,
                     uint8_t *rgb) {
    Preview *preview = NULL;
    SingeError error = {0};
    assert_int_equal(preview_create(def, (SingeAllocator){0}, &preview, &error), SINGE_OK);
    if (preview_set_gas(preview, gas, &error)) fail_msg("%s", error.message);
    assert_int_equal(preview_draw(preview, surface, time, rgb, &error), SINGE_OK);
    preview_destroy(preview);
}

/// A camera at the height of the flames, looking along y at nothing but the background.
static PreviewDef aside(float background) {
    PreviewDef def = small();
    def.camera = (PreviewCamera){.eye = {0, -0.5f, 0.2f}, .target = {0, 0, 0.2f}, .up = {0, 0, 1}, .fov = 0.5f};
    def.ground_height = -INFINITY;
    for (int c = 0; c < 3; c++) def.background[c] = background;
    return def;
}

static float area(const uint8_t *rgb, int x0, int y0, int x1, int y1, int channel) {
    float sum = 0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) sum += pixel(rgb, x, y)[channel];
    return sum / (float)((x1 - x0) * (y1 - y0));
}

static float middle(const uint8_t *rgb, int channel) {
    return area(rgb, W / 2 - 5, H / 2 - 5, W / 2 + 5, H / 2 + 5, channel);
}

static float corner(const uint8_t *rgb, int channel) { return area(rgb, 0, 0, 8, 8, channel); }

/// No gas, a gas of size 0, and still air: the same picture, bit by bit, as if gas had never been asked about.
static void test_nothing_burns(void **state) {
    (void)state;
    static uint8_t plain[BYTES], rgb[BYTES];
    static Ball air;
    SingeSurface surface;
    SingeGas none = {{0}, {0}, 0, NULL, NULL, NULL, NULL};
    assert_true(synthetic_make(SYNTHETIC_FLAT, 20, 0.05f, &surface));
    PreviewDef def = small();
    draw(&def, &surface, 1, plain);
    draw_gas(&def, &surface, NULL, 1, rgb);
    assert_memory_equal(plain, rgb, BYTES);
    draw_gas(&def, &surface, &none, 1, rgb);
    assert_memory_equal(plain, rgb, BYTES);
    ball_make(&air, 0, 0, 0.05f, 0, 0, 0);
    draw_gas(&def, &surface, &air.gas, 1, rgb);
    assert_memory_equal(plain, rgb, BYTES);
    synthetic_free(&surface);
}

/// Before dark and before bright: a flame glows orange to yellow, and not as a white blob.
static void test_flame(void **state) {
    (void)state;
    static uint8_t rgb[BYTES], plain[BYTES];
    static Ball ball;
    SingeSurface nothing = {0};
    ball_make(&ball, 0, 0, 0.2f, 0.03f, 4e6f, 0);
    for (int k = 0; k < 2; k++) {
        PreviewDef def = aside(k ? 0.75f : 0.02f);
        draw(&def, &nothing, 0.3, plain);
        draw_gas(&def, &nothing, &ball.gas, 0.3, rgb);
        float r = middle(rgb, 0), g = middle(rgb, 1), b = middle(rgb, 2);
        assert_true(r > 200 && r >= g && g > b + 40);
        assert_true(k || r > middle(plain, 0) + 150);
        // and elsewhere nothing but a little halo
        for (int c = 0; c < 3; c++) assert_true(fabsf(corner(rgb, c) - corner(plain, c)) < 6);
        int white = 0, orange = 0;
        for (int i = 0; i < W * H; i++) {
            const uint8_t *p = rgb + 3 * i;
            white += p[2] > 245, orange += p[0] > 120 && p[1] < 0.7f * p[0] && p[2] < 0.4f * p[0];
        }
        assert_true(white < 10 && (k || orange > 30)); // its rim, where it is cooler
    }
}

/// What flickers goes on in time, and stays where the gas is.
static void test_flicker(void **state) {
    (void)state;
    static uint8_t a[BYTES], b[BYTES];
    static Ball ball;
    SingeSurface nothing = {0};
    PreviewDef def = aside(0.02f);
    ball_make(&ball, 0, 0, 0.2f, 0.03f, 4e6f, 0);
    draw_gas(&def, &nothing, &ball.gas, 0.3, a);
    draw_gas(&def, &nothing, &ball.gas, 0.3 + 1 / 24.0, b);
    assert_memory_not_equal(a, b, BYTES);
    assert_true(fabsf(mean(a, 0) - mean(b, 0)) < 0.35f * mean(a, 0));
    draw_gas(&def, &nothing, &ball.gas, 0.3, b);
    assert_memory_equal(a, b, BYTES);
}

/// A sheet hides the flame behind it, and not that before it.
static void test_hidden(void **state) {
    (void)state;
    static uint8_t before[BYTES], behind[BYTES], plain[BYTES];
    static Ball ball;
    Quad q;
    quad_make(&q, 0.1f, 0.2f);
    PreviewDef def = above();
    draw(&def, &q.surface, 0.3, plain);
    ball_make(&ball, 0, 0, 0.30f, 0.03f, 4e6f, 0);
    draw_gas(&def, &q.surface, &ball.gas, 0.3, before);
    ball_make(&ball, 0, 0, 0.10f, 0.03f, 4e6f, 0);
    draw_gas(&def, &q.surface, &ball.gas, 0.3, behind);
    float warm = middle(plain, 0) - middle(plain, 2);
    assert_true(middle(before, 0) - middle(before, 2) > warm + 40);
    assert_true(middle(behind, 0) - middle(behind, 2) < warm + 20); // shone through, at most
}

/// Flames light the paper beside them, warmly.
static void test_light(void **state) {
    (void)state;
    static uint8_t dark[BYTES], lit[BYTES];
    static Ball ball;
    Quad q;
    quad_make(&q, 0.15f, 0.02f);
    PreviewDef def = above();
    for (int c = 0; c < 3; c++) def.sun_colour[c] = 0, def.sky_colour[c] = 0.1f;
    ball_make(&ball, -0.09f, 0, 0.10f, 0.03f, 4e6f, 0);
    draw(&def, &q.surface, 0.3, dark);
    draw_gas(&def, &q.surface, &ball.gas, 0.3, lit);
    float more[3];
    for (int c = 0; c < 3; c++) more[c] = middle(lit, c) - middle(dark, c);
    assert_true(more[0] > 10 && more[0] > more[1] && more[1] > more[2]);
}

/// Smoke dims what is bright and shows before what is dark.
static void test_smoke(void **state) {
    (void)state;
    static uint8_t rgb[BYTES], plain[BYTES];
    static Ball ball;
    SingeSurface nothing = {0};
    ball_make(&ball, 0, 0, 0.2f, 0.035f, 0, 2e-3f);
    for (int k = 0; k < 2; k++) {
        PreviewDef def = aside(k ? 0.75f : 0.0f);
        draw(&def, &nothing, 0.3, plain);
        draw_gas(&def, &nothing, &ball.gas, 0.3, rgb);
        float change = middle(rgb, 1) - middle(plain, 1);
        assert_true(k ? change < -20 : change > 15);
        assert_true(fabsf(middle(rgb, 0) - middle(rgb, 2)) < 30); // grey
    }
}

/// The layer of the fire is what it adds to the picture and what it hides of it.
static void test_layer(void **state) {
    (void)state;
    static float with[W * H][3], without[W * H][3], fire[W * H][4];
    static Ball ball;
    SingeSurface nothing = {0};
    PreviewDef def = aside(0.3f);
    Preview *preview = NULL;
    SingeError error;
    ball_make(&ball, 0, 0, 0.2f, 0.03f, 4e6f, 5e-4f);
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, &error), SINGE_OK);
    PreviewLayers layers = {.beauty = without, .fire = fire};
    assert_int_equal(preview_draw_layers(preview, &nothing, 0.3, NULL, &layers, &error), SINGE_OK);
    for (int i = 0; i < W * H; i++) assert_true(fire[i][0] == 0 && fire[i][3] == 0);
    assert_int_equal(preview_set_gas(preview, &ball.gas, &error), SINGE_OK);
    layers.beauty = with;
    assert_int_equal(preview_draw_layers(preview, &nothing, 0.3, NULL, &layers, &error), SINGE_OK);
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(with[i][c] - fire[i][c] - (1 - fire[i][3]) * without[i][c]) < 1e-3f * (1 + with[i][c]));
    const float *middle_of = fire[W * (H / 2) + W / 2];
    assert_true(middle_of[0] > 1 && middle_of[0] > middle_of[2] && middle_of[3] > 0.3f && middle_of[3] < 1);
    assert_true(fire[0][0] == 0 && fire[0][3] == 0);
    preview_destroy(preview);
}

/// From kilometres away, and from inside of the flame: rays come to an end.
static void test_far_and_near(void **state) {
    (void)state;
    static uint8_t rgb[BYTES];
    static Ball ball;
    SingeSurface nothing = {0};
    ball_make(&ball, 0, 0, 0.2f, 0.03f, 4e6f, 1e-3f);
    static const float eyes[4][3] = {{0, -0.01f, 0.2f}, {0, -90, 0.2f}, {0, -9000, 0.2f}, {7000, 6000, 8000}};
    for (int i = 0; i < 4; i++) {
        PreviewDef def = aside(0.02f);
        memcpy(def.camera.eye, eyes[i], sizeof eyes[i]);
        def.camera.fov = i == 0 ? 1 : i == 1 ? 0.002f : 0.0011f;
        draw_gas(&def, &nothing, &ball.gas, 0.3, rgb);
        assert_true(i > 1 || middle(rgb, 0) > 120);
    }
}

/// Neither threads nor what was drawn before show.
static void test_same_bytes(void **state) {
    (void)state;
    enum { BIG_W = 200, BIG_H = 150, BIG = BIG_W * BIG_H * 3 };
    static uint8_t first[BIG], again[BIG];
    SingeSurface surface;
    SyntheticGas gas, other;
    assert_true(synthetic_make(SYNTHETIC_FLAT, 20, 0.05f, &surface));
    assert_true(synthetic_gas_make(&surface, 0.008f, 1, &gas) && synthetic_gas_make(&surface, 0.011f, 3, &other));
    for (int threads = 1; threads <= 3; threads++) {
        PreviewDef def = small();
        def.width = BIG_W, def.height = BIG_H, def.thread_count = threads;
        Preview *preview = NULL;
        assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, NULL), SINGE_OK);
        if (threads == 3) {
            assert_int_equal(preview_set_gas(preview, &other.gas, NULL), SINGE_OK);
            assert_int_equal(preview_draw(preview, &surface, 2, again, NULL), SINGE_OK);
            assert_memory_not_equal(first, again, BIG);
        }
        assert_int_equal(preview_set_gas(preview, &gas.gas, NULL), SINGE_OK);
        assert_int_equal(preview_draw(preview, &surface, 1, threads == 1 ? first : again, NULL), SINGE_OK);
        if (threads > 1) assert_memory_equal(first, again, BIG);
        preview_destroy(preview);
    }
    synthetic_gas_free(&gas), synthetic_gas_free(&other), synthetic_free(&surface);
}

static void test_bad_gas(void **state) {
    (void)state;
    static Ball ball;
    SingeError error;
    PreviewDef def = small();
    TestAllocator allocator = {0};
    Preview *preview = NULL;
    assert_int_equal(preview_create(&def, test_allocator(&allocator), &preview, &error), SINGE_OK);
    ball_make(&ball, 0, 0, 0.2f, 0.03f, 4e6f, 0);
    SingeGas bad[5] = {ball.gas, ball.gas, ball.gas, ball.gas, ball.gas};
    bad[0].cell = 0, bad[1].cell = NAN, bad[2].origin[1] = INFINITY, bad[3].flame = NULL, bad[4].size[2] = 1u << 31;
    for (int i = 0; i < 5; i++) {
        assert_int_equal(preview_set_gas(preview, &bad[i], &error), SINGE_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "gas"));
    }
    ball.flame[7] = NAN;
    assert_int_equal(preview_set_gas(preview, &ball.gas, &error), SINGE_ERROR_ARGUMENT);
    ball.flame[7] = 0;
    SingeResult result = SINGE_ERROR_MEMORY;
    int needed = -1;
    while (result) {
        allocator.calls = 0, allocator.fail_at = ++needed + 1;
        result = preview_set_gas(preview, &ball.gas, &error);
        if (result) assert_int_equal(error.code, SINGE_ERROR_MEMORY);
    }
    assert_in_range(needed, 1, 5);
    preview_destroy(preview);
    test_allocator_check(&allocator);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_burns), cmocka_unit_test(test_flame), cmocka_unit_test(test_flicker),
        cmocka_unit_test(test_hidden), cmocka_unit_test(test_far_and_near), cmocka_unit_test(test_layer),
        cmocka_unit_test(test_light), cmocka_unit_test(test_smoke), cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_bad_gas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

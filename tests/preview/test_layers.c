// The layers of a picture whose values are known.

#include "fixture.h"
#include "synthetic.h"

typedef struct Kept {
    float beauty[H * W][3], glow[H * W][3], coverage[H * W], normal[H * W][3], temperature[H * W], burn[H * W];
    float depth[H * W];
    int32_t sheet[H * W], piece[H * W];
} Kept;

static void draw_kept(const PreviewDef *def, const SingeSurface *surface, uint8_t *rgb, Kept *kept) {
    const PreviewLayers layers = {kept->beauty, kept->glow,  kept->coverage, kept->normal, kept->temperature,
                                  kept->burn,   kept->depth, kept->sheet,    kept->piece,  NULL,
                                  NULL};
    OwnPreview *preview = preview_open(def);
    assert_int_equal(preview_draw_layers(preview, surface, 1, rgb, &layers, NULL), SINGE_OK);
}

enum { ON = H / 2 * W + W / 2 + 5, OFF = 4 * W + 4 };

TEST(layers_have_the_surfaces_values) {
    static Kept kept;
    static int32_t piece[4] = {7, 7, 7, 7};
    Float4 q;

    quad_make(&q, 0.08f, 0.1f);
    for (int i = 0; i < 4; i++) q.temperature[i] = 500, q.burn[i] = 0.25f, q.sheet[i] = 2;
    q.surface.piece = piece;
    PreviewDef def = above();
    draw_kept(&def, &q.surface, NULL, &kept);
    assert_float_equal(kept.depth[ON], 0.4f, 1e-4);
    assert_float_equal(kept.depth[ON + 10], 0.4f, 1e-4); // along the view, not along the ray
    assert_float_equal(kept.normal[ON][0], 0, 0.5);      // char's wrinkles
    assert_true(kept.normal[ON][2] > 0.7f);
    assert_float_equal(kept.temperature[ON], 500, 0.01);
    assert_float_equal(kept.burn[ON], 0.25, 1e-5);
    assert_float_equal(kept.coverage[ON], 1, 0);
    assert_int_equal(kept.sheet[ON], 2);
    assert_int_equal(kept.piece[ON], 7);
    assert_float_equal(kept.glow[ON][0], 0, 0);
    assert_true(kept.beauty[ON][0] > 0);
    assert_float_equal(kept.depth[OFF], 0.5f, 1e-4); // the table
    assert_float_equal(kept.coverage[OFF], 0, 0);
    assert_float_equal(kept.temperature[OFF], 0, 0);
    assert_int_equal(kept.sheet[OFF], -1);
    assert_int_equal(kept.piece[OFF], -1);
    def.ground_height = -INFINITY;
    draw_kept(&def, &q.surface, NULL, &kept);
    assert_true(isinf(kept.depth[OFF]));
}

/// A fresh sheet that leans: its normal, to the eye from both sides.
TEST(normals_face_the_eye) {
    static Kept kept;
    Float4 q;
    quad_make(&q, 0.08f, 0.1f);
    for (int i = 0; i < 4; i++) {
        q.position[i][2] = 0.1f + 0.5f * q.position[i][0];
        q.normal[i][0] = 0.5f / sqrtf(1.25f), q.normal[i][1] = 0, q.normal[i][2] = -1 / sqrtf(1.25f); // from below
    }
    PreviewDef def = above();
    draw_kept(&def, &q.surface, NULL, &kept);
    assert_float_equal(kept.normal[ON][0], -0.5f / sqrtf(1.25f), 1e-4);
    assert_float_equal(kept.normal[ON][1], 0, 1e-4);
    assert_float_equal(kept.normal[ON][2], 1 / sqrtf(1.25f), 1e-4);
}

TEST(glow_has_its_own_layer) {
    static Kept kept;
    Float4 q;
    quad_make(&q, 0.08f, 0.1f);
    for (int i = 0; i < 4; i++) q.burn[i] = i == 1 || i == 2 ? 0.9f : 0.6f, q.temperature[i] = 1100, q.rate[i] = 1;
    PreviewDef def = above();
    draw_kept(&def, &q.surface, NULL, &kept);
    float max = 0;
    for (int i = 0; i < W * H; i++) {
        max = fmaxf(max, kept.glow[i][0]);
        for (int c = 0; c < 3; c++) assert_true(kept.glow[i][c] >= 0 && kept.glow[i][c] <= kept.beauty[i][c] + 1e-5f);
    }
    assert_true(max > 0.3f);
    assert_float_equal(kept.glow[OFF][0], 0, 0);
}

/// The ember line of a burning sheet seen from straight above: thin, broken, and elsewhere a moment later.
TEST(the_ember_line_is_thin_and_broken) {
    enum { SIDE = 400, COUNT = SIDE * SIDE, SECTORS = 90 };
    static float glow[2][COUNT][3];
    SingeSurface surface;
    assert_true(synthetic_make(SYNTHETIC_FLAT, 84, 0.04f, &surface));
    PreviewDef def = above();
    def.width = def.height = SIDE;
    def.camera =
        (PreviewCamera){.eye = {0.012f, 0.02f, 0.5f}, .target = {0.012f, 0.02f, 0}, .up = {0, 1, 0}, .fov = 0.24f};
    OwnPreview *preview = preview_open(&def);
    for (int k = 0; k < 2; k++) {
        const PreviewLayers layers = {.glow = glow[k]};
        assert_int_equal(preview_draw_layers(preview, &surface, 1 + 0.5 * k, NULL, &layers, NULL), SINGE_OK);
    }

    synthetic_free(&surface);
    const float pixel = 1e3f * 2 * 0.5f * tanf(0.12f) / SIDE; // mm
    int count[SECTORS] = {0}, lit = 0;
    float radius[SECTORS] = {0}, change = 0, sum = 0, area = 0, around = 0, widest = 0;
    for (int i = 0; i < COUNT; i++) {
        change += fabsf(glow[1][i][0] - glow[0][i][0]), sum += glow[0][i][0];
        if (glow[0][i][0] < 0.3f) continue;
        float x = (float)(i % SIDE - SIDE / 2), y = (float)(i / SIDE - SIDE / 2);
        int sector = (int)((atan2f(y, x) / 6.2832f + 0.5f) * (SECTORS - 0.01f));
        count[sector]++, radius[sector] += sqrtf(x * x + y * y) * pixel;
    }

    for (int k = 0; k < SECTORS; k++) {
        if (!count[k]) continue;
        float arc = 6.2832f / SECTORS * radius[k] / (float)count[k], bright = (float)count[k] * pixel * pixel;
        lit++, area += bright, around += arc, widest = fmaxf(widest, bright / arc);
    }

    assert_true(area / around > 0.2f && area / around < 1.6f); // mm wide where it glows
    assert_true(widest < 3);
    assert_in_range(lit, SECTORS / 3, SECTORS - 5);
    assert_true(change > 0.1f * sum);
}

/// The picture is the same with layers and without, and so are the layers with and without the picture, whoever draws.
TEST(layers_change_no_picture) {
    static Kept one, two;
    static uint8_t alone[BYTES], beside[BYTES];
    SingeSurface surface;

    assert_true(synthetic_make(SYNTHETIC_FLAT, 30, 0.05f, &surface));
    PreviewDef def = small();
    draw(&def, &surface, 1, alone);
    draw_kept(&def, &surface, beside, &one);
    assert_memory_equal(alone, beside, BYTES);
    def.thread_count = 3;
    draw_kept(&def, &surface, NULL, &two);
    assert_memory_equal(&one, &two, sizeof one);
    synthetic_free(&surface);
}

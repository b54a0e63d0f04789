// The lens and the shutter: what blurs, and what does not.

#include "fixture.h"

enum { STRIPES = 32 };

/// A sheet of black and white stripes across x, straight below the camera.
typedef struct Striped {
    uint8_t texels[3 * STRIPES];
    Image image;
    const Image *pictures[1];
    Float4 q;
    PreviewDef def;
} Striped;

static void striped(Striped *s) {
    for (int i = 0; i < STRIPES; i++) memset(s->texels + 3 * i, i & 1 ? 255 : 0, 3);
    s->image = (Image){.width = STRIPES, .height = 1, .rgb = s->texels};
    s->pictures[0] = &s->image;
    quad_make(&s->q, 0.1f, 0.1f);
    s->def = above();
    s->def.pictures = s->pictures;
    s->def.sheet_count = 1;
    s->def.samples = 64;
}

/// Mean difference between neighbours along a direction, in the middle of the sheet.
static float sharpness(const uint8_t *rgb, int dx, int dy) {
    float sum = 0;
    int count = 0;
    for (int y = H / 2 - 14; y < H / 2 + 14; y++)
        for (int x = W / 2 - 14; x < W / 2 + 14; x++, count++)
            sum += (float)abs(pixel(rgb, x, y)[1] - pixel(rgb, x + dx, y + dy)[1]);
    return sum / (float)count;
}

TEST(a_lens_blurs_what_is_out_of_focus) {
    static uint8_t rgb[BYTES];
    Striped s;
    striped(&s);
    draw(&s.def, &s.q.surface, 0, rgb);
    float pinhole = sharpness(rgb, 1, 0);
    s.def.camera.aperture = 0.04f, s.def.camera.focus = 0.4f; // the sheet's distance
    draw(&s.def, &s.q.surface, 0, rgb);
    float focused = sharpness(rgb, 1, 0);
    s.def.camera.focus = 0.25f;
    draw(&s.def, &s.q.surface, 0, rgb);
    float near = sharpness(rgb, 1, 0);
    s.def.camera.focus = 2;
    draw(&s.def, &s.q.surface, 0, rgb);
    float far = sharpness(rgb, 1, 0);
    static uint8_t target[BYTES];
    s.def.camera.focus = 0; // the target's distance
    draw(&s.def, &s.q.surface, 0, target);
    s.def.camera.focus = 0.5f;
    draw(&s.def, &s.q.surface, 0, rgb);
    assert_memory_equal(target, rgb, BYTES);
    assert_true(pinhole > 30);
    assert_true(focused > 0.9f * pinhole);
    assert_true(near < 0.3f * pinhole);
    assert_true(far < 0.3f * pinhole);
}

/// What a lens blurs is smooth with few samples: stripes out of focus differ from those of very many samples by less than
/// the bar in the root mean square, of 255. One sample, from which nothing is known of its noise, breaks it.
TEST(out_of_focus_pictures_are_smooth) {
    static uint8_t exact[BYTES], few[BYTES];
    Striped s;
    striped(&s);
    s.def.camera.aperture = 0.04f, s.def.camera.focus = 0.25f, s.def.samples = 256;
    draw(&s.def, &s.q.surface, 0, exact);
    const int samples[] = {16, 1};
    for (int k = 0; k < 2; k++) {
        s.def.samples = samples[k];
        draw(&s.def, &s.q.surface, 0, few);
        float squares = 0;
        for (int y = H / 2 - 14; y < H / 2 + 14; y++)
            for (int x = W / 2 - 14; x < W / 2 + 14; x++) {
                const float wrong = (float)(pixel(few, x, y)[1] - pixel(exact, x, y)[1]);
                squares += wrong * wrong / (28 * 28);
            }
        print_message("stripes out of focus, %d samples: rms %.1f of 255\n", samples[k], (double)sqrtf(squares));
        assert_true((squares < 6 * 6) == (samples[k] == 16));
    }
}

/// Blur of the lens is drawn wherever it reaches.
TEST(blur_is_drawn_wherever_it_reaches) {
    static uint8_t wide[BYTES], none[BYTES];
    Float4 q;
    quad_make(&q, 0.02f, 0.3f);
    PreviewDef def = above();
    def.sun_colour[0] = def.sun_colour[1] = def.sun_colour[2] = 0; // no shadow
    def.samples = 64, def.camera.aperture = 0.1f, def.camera.focus = 0.5f, def.ground = PREVIEW_GROUND_PLAIN;
    def.ground_colour[0] = def.ground_colour[1] = def.ground_colour[2] = 0;
    draw(&def, &q.surface, 0, wide);
    def.camera.aperture = 0;
    draw(&def, &q.surface, 0, none);

    // 5 cm of lens over 20 cm beyond the sheet: 7.5 cm around it on the ground, besides its own 3.3 cm
    int beyond = (int)(0.07f / (0.5f * tanf(0.35f)) * (H / 2));
    assert_true(pixel(none, W / 2 + beyond, H / 2)[1] < 8);
    assert_true(pixel(wide, W / 2 + beyond, H / 2)[1] > 12);
}

TEST(a_shutter_blurs_motion) {
    static uint8_t still[BYTES], moving[BYTES];
    static float velocity[4][3];
    Striped s;
    striped(&s);
    draw(&s.def, &s.q.surface, 0, still);
    for (int i = 0; i < 4; i++) velocity[i][0] = 0.5f;
    s.q.surface.velocity = velocity;
    draw(&s.def, &s.q.surface, 0, moving); // with no shutter nothing may change
    assert_memory_equal(still, moving, BYTES);
    s.def.shutter = 0.02f; // 1 cm of way, and stripes of 6 mm
    draw(&s.def, &s.q.surface, 0, moving);
    assert_true(sharpness(moving, 1, 0) < 0.5f * sharpness(still, 1, 0));
    for (int i = 0; i < 4; i++) velocity[i][0] = 0, velocity[i][1] = 0.5f;
    draw(&s.def, &s.q.surface, 0, moving); // along the stripes
    assert_true(sharpness(moving, 1, 0) > 0.9f * sharpness(still, 1, 0));
    for (int i = 0; i < 4; i++) velocity[i][0] = NAN, velocity[i][1] = 1e30f;
    draw(&s.def, &s.q.surface, 0, moving); // without the ball's velocity
    assert_true(sharpness(moving, 1, 0) > 0.9f * sharpness(still, 1, 0));
}

/// The blurred edge of a bright sheet that moves before the dark is no comb: its pixels get as many samples where the first
/// few have missed the sheet, or hit it, by chance.
TEST(a_moving_edge_is_smooth) {
    static uint8_t exact[BYTES], few[BYTES];
    static float velocity[4][3];
    Float4 q;
    quad_make(&q, 0.06f, 0);
    q.surface.velocity = velocity;
    for (int i = 0; i < 4; i++) velocity[i][0] = 2, velocity[i][1] = 1;
    PreviewDef def = above();
    def.ground_height = -INFINITY, def.shutter = 0.02f; // 4.5 cm of way, 8 pixels
    for (int c = 0; c < 3; c++) def.background[c] = 0;
    def.samples = 256;
    draw(&def, &q.surface, 0, exact);
    def.samples = 16;
    draw(&def, &q.surface, 0, few);

    const int inside = pixel(exact, W / 2, H / 2)[0];
    float squares = 0;
    int edge = 0;
    for (int i = 0; i < W * H; i++) {
        if (exact[3 * i] < 0.1f * (float)inside || exact[3 * i] > 0.9f * (float)inside) continue;
        const float wrong = (float)(few[3 * i] - exact[3 * i]);
        squares += wrong * wrong;
        edge++;
    }
    const float rms = sqrtf(squares / (float)edge);
    print_message("a moving edge of %d pixels: rms %.1f of 255\n", edge, (double)rms);
    assert_true(edge > 200 && rms < 20); // 28 if blocks go by what their first samples meet
}

/// The edge of a bright sheet that is a little out of focus has no teeth: it lies as far to the left in each row. Where pixels
/// have points of the lens of their own it does not.
TEST(edges_a_little_out_of_focus_have_no_teeth) {
    static uint8_t picture[BYTES];
    Float4 q;
    quad_make(&q, 0.09f, 0);
    PreviewDef def = above();
    def.ground_height = -INFINITY, def.camera.focus = 0.4f, def.camera.aperture = 0.05f; // 1.1 pixels
    for (int c = 0; c < 3; c++) def.background[c] = 0;
    def.samples = 16;
    draw(&def, &q.surface, 0, picture);
    float sum = 0, squares = 0;
    for (int y = H / 2 - 12; y < H / 2 + 12; y++) {
        float at = 0; // pixels
        for (int x = 0; x < W / 2; x++) at += 1 - (float)pixel(picture, x, y)[1] / pixel(picture, W / 2, y)[1];
        sum += at / 24, squares += at * at / 24;
    }
    const float teeth = sqrtf(fmaxf(squares - sum * sum, 0));
    print_message("teeth of an edge: rms %.3f pixels\n", (double)teeth);
    assert_true(teeth < 0.1f); // was 0.25
}

TEST(a_moving_ball_is_blurred) {
    static uint8_t rgb[BYTES];
    PreviewDef def = above();
    def.samples = 32, def.ground_height = -INFINITY, def.shutter = 0.1f;
    PreviewShape ball = {.kind = SINGE_COLLIDER_SPHERE, .radius = 0.02f, .temperature = 1300, .velocity = {1, 0, 0}};
    def.shapes = &ball, def.shape_count = 1;
    draw(&def, &nothing, 0, rgb);
    int way = (int)(0.045f / (0.5f * tanf(0.35f)) * (H / 2)), off = (int)(0.045f / (0.5f * tanf(0.35f)) * (H / 2));
    assert_true(pixel(rgb, W / 2 + way, H / 2)[0] > 150 && pixel(rgb, W / 2 - way, H / 2)[0] > 150);
    assert_true(pixel(rgb, W / 2, H / 2 + off)[0] < 140);
}

/// How steep borders are in the middle of a picture: the sum of the squares of differences, as a share of their range's. What a
/// flame adds to that and hides of it is taken out.
static float steepness(const float beauty[][3], const float fire[][4], int side) {
    float sum = 0, low = INFINITY, high = -INFINITY;
    for (int y = side / 2 - 16; y < side / 2 + 16; y++)
        for (int x = side / 2 - 16; x < side / 2 + 16; x++) {
            float behind[2];
            for (int k = 0; k < 2; k++) {
                const int i = y * side + x + k;
                behind[k] = (beauty[i][0] - fire[i][0]) / (1 - fire[i][3]);
            }
            low = fminf(low, behind[0]), high = fmaxf(high, behind[0]);
            sum += (behind[1] - behind[0]) * (behind[1] - behind[0]);
        }
    return sum / ((high - low) * (high - low));
}

/// Through hot gas edges are seen less sharply. Print lay behind a flame as sharp as beside it. Gas behind a sheet does nothing to it.
TEST(what_is_behind_a_flame_shimmers) {
    enum { SIDE = 384, TEXELS = 512 };
    static float beauty[SIDE * SIDE][3], fire[SIDE * SIDE][4];
    static Ball ball;
    static uint8_t texels[3 * TEXELS];
    Striped s;
    striped(&s);
    for (int i = 0; i < TEXELS; i++) memset(texels + 3 * i, i & 8 ? 255 : 0, 3);
    s.image = (Image){.width = TEXELS, .height = 1, .rgb = texels};
    s.def.width = s.def.height = SIDE;
    s.def.samples = 16;
    const PreviewLayers layers = {.beauty = beauty, .fire = fire};
    float steep[3];
    for (int k = 0; k < 3; k++) {
        ball_make(&ball, 0, 0, k == 1 ? 0.25f : 0.02f, 0.03f, 1e6f, 0);
        draw_layers(&s.def, &s.q.surface, k ? &ball.gas : NULL, 0.3, &layers);
        steep[k] = steepness(beauty, fire, SIDE);
    }
    print_message("edges: %.2f, behind a flame %.2f, before one %.2f\n", (double)steep[0], (double)steep[1],
                  (double)steep[2]);
    assert_true(steep[1] < 0.75f * steep[0]); // .96
    assert_true(steep[2] > 0.9f * steep[0]);
}

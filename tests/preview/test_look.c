// How paper looks in each of its states: fresh, printed, browned, charred, glowing, burnt out.

#include "plate.h"

// what a case works on
static Plate plate;
static uint8_t rgb[BYTES];
static Float4 q;

/// Mean over the middle of the picture.
static float middle(const uint8_t *picture, int channel) {
    enum { HALF = 10 };
    float sum = 0;
    for (int y = H / 2 - HALF; y < H / 2 + HALF; y++)
        for (int x = W / 2 - HALF; x < W / 2 + HALF; x++) sum += pixel(picture, x, y)[channel];
    return sum / (4 * HALF * HALF);
}

TEST(fresh_paper_is_white) {
    quad_make(&q, 0.1f, 0.01f);
    PreviewDef def = above(); // no sheets, no pictures: white
    draw(&def, &q.surface, 0, rgb);
    for (int y = H / 2 - 8; y < H / 2 + 8; y++)
        for (int x = W / 2 - 8; x < W / 2 + 8; x++) {
            const uint8_t *p = pixel(rgb, x, y);
            assert_in_range(p[0], 215, 252);
            assert_in_range(p[1], 210, 252);
            assert_in_range(p[2], 195, 250);
        }
}

/// White in the sun keeps below the film's end, so that print and creases show.
TEST(white_in_the_sun_is_not_clipped) {
    uint8_t texels[2 * 1 * 3] = {255, 255, 255, 20, 20, 20};
    Image image = {.width = 2, .height = 1, .rgb = texels};
    const Image *pictures[1] = {&image};

    quad_make(&q, 0.1f, 0.01f);
    PreviewDef def = above();
    def.pictures = pictures, def.sheet_count = 1;
    draw(&def, &q.surface, 0, rgb);
    const uint8_t *white = pixel(rgb, W / 2 - 16, H / 2), *ink = pixel(rgb, W / 2 + 15, H / 2);
    assert_in_range(white[0], 222, 242); // not clipped
    assert_true(ink[0] < 70);
}

TEST(states_of_burning_differ) {
    PreviewDef def = above();
    float fresh, brown, black;

    quad_make(&q, 0.1f, 0.01f);
    draw(&def, &q.surface, 0, rgb);
    fresh = pixel(rgb, W / 2, H / 2)[1];
    for (int i = 0; i < 4; i++) q.temperature[i] = 520;
    draw(&def, &q.surface, 0, rgb);
    const uint8_t *p = pixel(rgb, W / 2, H / 2);
    brown = p[1];
    assert_true(p[0] > p[1] + 15 && p[1] > p[2] + 10);
    for (int i = 0; i < 4; i++) q.temperature[i] = 400, q.burn[i] = 0.5f;
    draw(&def, &q.surface, 0, rgb);
    black = pixel(rgb, W / 2, H / 2)[1];
    assert_true(fresh > brown + 30 && brown > black + 40 && black < 80);
}

/// Paper that was hot stays brown when it is cold again, and ash is grey: paler than char, but not white.
TEST(cold_remains_stay_brown_and_grey) {
    PreviewDef def = above();

    quad_make(&q, 0.1f, 0.01f);
    for (int i = 0; i < 4; i++) q.peak[i] = 520;
    draw(&def, &q.surface, 0, rgb);
    const uint8_t *p = pixel(rgb, W / 2, H / 2);
    assert_true(p[0] > p[1] + 15 && p[1] > p[2] + 10);
    assert_in_range(p[1], 25, 180);
    for (int i = 0; i < 4; i++) q.peak[i] = 1000, q.burn[i] = 0.5f;
    draw(&def, &q.surface, 0, rgb);
    float black = middle(rgb, 1);
    for (int i = 0; i < 4; i++) q.burn[i] = 1;
    draw(&def, &q.surface, 0, rgb);
    float grey = middle(rgb, 1);
    assert_true(grey > black + 15);
    assert_in_range((int)grey, 60, 180);
    assert_true(fabsf(middle(rgb, 0) - middle(rgb, 2)) < 30);
}

/// Only where it is hot *and* burning does the char glow.
TEST(only_hot_and_burning_char_glows) {
    PreviewDef def = above();

    quad_make(&q, 0.1f, 0.01f);
    def.sun_colour[0] = def.sun_colour[1] = def.sun_colour[2] = 0;
    for (int i = 0; i < 4; i++) q.burn[i] = 0.7f + 0.2f * (float)(i == 1 || i == 2), q.temperature[i] = 1100;
    draw(&def, &q.surface, 0, rgb);
    float idle = mean(rgb, 0);
    for (int i = 0; i < 4; i++) q.rate[i] = 1;
    draw(&def, &q.surface, 0, rgb);
    float burning = mean(rgb, 0), burning_blue = mean(rgb, 2);
    for (int i = 0; i < 4; i++) q.temperature[i] = 600;
    draw(&def, &q.surface, 0, rgb);
    assert_true(burning > idle + 1.5f);
    assert_true(burning - mean(rgb, 0) > 1.5f);
    assert_true(burning > burning_blue);
}

/// A scrap that burns as a whole, at 1500 K, stays orange and uneven; it was flat white.
TEST(scraps_of_ember_stay_orange) {
    PreviewDef def = above();

    quad_make(&q, 0.1f, 0.01f);
    for (int c = 0; c < 3; c++) def.sun_colour[c] = def.sky_colour[c] = 0;
    for (int i = 0; i < 4; i++) q.burn[i] = 0.74f, q.temperature[i] = 1500, q.rate[i] = 1;
    draw(&def, &q.surface, 1, rgb);
    print_message("a scrap of ember: %.0f %.0f %.0f\n", (double)middle(rgb, 0), (double)middle(rgb, 1),
                  (double)middle(rgb, 2));
    assert_true(middle(rgb, 0) > 120 && middle(rgb, 2) < 0.5f * middle(rgb, 0));

    // nor does the film bleach the hottest of it
    int blue = 0;
    for (int i = 0; i < BYTES; i += 3) blue = rgb[i + 2] > blue ? rgb[i + 2] : blue;
    print_message("its palest pixel: blue %d\n", blue);
    assert_true(blue < 180); // was 245
}

/// Ash pales with time.
TEST(ash_pales_with_time) {
    static float ignited[4] = {1, 1, 1, 1};
    PreviewDef def = above();

    quad_make(&q, 0.1f, 0.01f);
    for (int i = 0; i < 4; i++) q.peak[i] = 1000, q.burn[i] = 1;
    q.surface.time_ignited = ignited;
    draw(&def, &q.surface, 1.5, rgb);
    float sooty = middle(rgb, 1);
    draw(&def, &q.surface, 30, rgb);
    float pale = middle(rgb, 1);
    assert_true(pale > sooty + 10);
    def.pace = 60; // a fire of that pace is done within half a second
    draw(&def, &q.surface, 1.5, rgb);
    assert_float_equal(middle(rgb, 1), pale, 6);
}

/// Surfaces that face up get the same light from any sky; those that face sideways do not.
TEST(light_on_upward_faces_is_the_same_for_any_sky) {
    enum { PW = 16, PH = 8 };
    uint8_t texels[PW * PH * 3];
    for (int i = 0; i < PW * PH; i++) memset(texels + 3 * i, i % PW < PW / 2 ? 250 : 60, 3); // bright towards -x
    Image image = {.width = PW, .height = PH, .rgb = texels};
    PreviewDef def = above();
    quad_make(&q, 0.1f, 0.01f);
    def.sun_colour[0] = def.sun_colour[1] = def.sun_colour[2] = 0;
    for (int c = 0; c < 3; c++) def.sky_colour[c] = 1;
    def.sky_picture = &image;
    float up[4], aside[4];
    for (int sky = 0; sky < 4; sky++) {
        def.sky = (PreviewSky)sky;
        quad_make(&q, 0.1f, 0.01f);
        draw(&def, &q.surface, 0, rgb);
        up[sky] = middle(rgb, 1);
        for (int side = 0; side < 2; side++) { // its shading normal leans to either side
            for (int i = 0; i < 4; i++) q.normal[i][0] = side ? 0.8f : -0.8f, q.normal[i][2] = 0.6f;
            draw(&def, &q.surface, 0, rgb);
            aside[sky] = side ? aside[sky] - middle(rgb, 1) : middle(rgb, 1);
        }
    }

    assert_in_range((int)up[0], 100, 200);
    for (int sky = 1; sky < 4; sky++) assert_float_equal(up[sky], up[0], 12);
    assert_float_equal(aside[PREVIEW_SKY_EVEN], 0, 3);
    assert_true(fabsf(aside[PREVIEW_SKY_STUDIO]) > 8);
    assert_true(aside[PREVIEW_SKY_PICTURE] > 15);
    def.sky = PREVIEW_SKY_PICTURE, def.sky_turn = 3.14159265f;
    for (int i = 0; i < 4; i++) q.normal[i][0] = 0.8f;
    draw(&def, &q.surface, 0, rgb);
    float turned = middle(rgb, 1);
    for (int i = 0; i < 4; i++) q.normal[i][0] = -0.8f;
    draw(&def, &q.surface, 0, rgb);
    assert_true(turned > middle(rgb, 1) + 15);
}

/// Each ground has its own look and about the brightness of its colour.
TEST(each_ground_has_its_look) {
    static uint8_t looks[3][BYTES];
    PreviewDef def = above();

    for (int kind = 0; kind < 3; kind++) {
        def.ground = (PreviewGround)kind;
        draw(&def, &nothing, 0, looks[kind]);
    }
    float plain = mean(looks[PREVIEW_GROUND_PLAIN], 1);
    assert_float_equal(mean(looks[PREVIEW_GROUND_WOOD], 1), plain, 20);
    assert_float_equal(mean(looks[PREVIEW_GROUND_STONE], 1), plain, 20);
    for (int kind = 0; kind < 3; kind++) {
        float spread = 0;
        for (int i = 0; i < W * H; i++) spread += fabsf(looks[kind][3 * i + 1] - mean(looks[kind], 1));
        spread /= W * H;
        assert_true(kind == PREVIEW_GROUND_PLAIN ? spread < 4 : spread > 4);
    }
}

/// So have walls; a brick has a hue of its own.
TEST(each_wall_has_its_look) {
    static uint8_t looks[3][BYTES];
    PreviewDef def = small();
    def.wall_distance = 0.3f, def.sun_direction[1] = -0.45f;
    def.camera = (PreviewCamera){.eye = {0, -0.4f, 0.5f}, .target = {0, 0.3f, 0.5f}, .up = {0, 0, 1}, .fov = 0.6f};
    float spread[3];
    for (int kind = 0; kind < 3; kind++) {
        def.wall = (PreviewWall)kind;
        draw(&def, &nothing, 0, looks[kind]);
        spread[kind] = 0;
        for (int i = 0; i < W * H; i++) spread[kind] += fabsf(looks[kind][3 * i + 1] - mean(looks[kind], 1)) / (W * H);
    }
    print_message("walls: plaster %.1f, brick %.1f, plain %.1f levels\n", (double)spread[0], (double)spread[1],
                  (double)spread[2]);
    assert_float_equal(mean(looks[PREVIEW_WALL_PLASTER], 1), mean(looks[PREVIEW_WALL_PLAIN], 1), 20);
    assert_true(spread[PREVIEW_WALL_PLASTER] > 2 * spread[PREVIEW_WALL_PLAIN] && spread[PREVIEW_WALL_BRICK] > 5);
}

/// The ground is stained where a sheet lay that has burnt away, and not where it is whole, beside it, below one that
/// hung, or if it is to stay clean. The stain is darker than a tenth; without one the table is the same to a level.
TEST(burning_sheets_stain_the_ground) {
    static const uint32_t cells[4] = {0, 1, 2, 3};
    PreviewStart start = {4, 1, &q.position[0][0], cells, NULL, NULL};
    PreviewDef def = above();
    quad_make(&q, 0.09f, 0.001f);
    def.ground = PREVIEW_GROUND_PLAIN;
    draw(&def, &nothing, 0, rgb);
    const float clean = middle(rgb, 1), beside = pixel(rgb, 2, H / 2)[1];

    def.starts = &start, def.sheet_count = 1;
    draw(&def, &nothing, 0, rgb);
    print_message("the table is %.1f clean, %.1f stained\n", (double)clean, (double)middle(rgb, 1));
    assert_true(middle(rgb, 1) < 0.9f * clean);
    assert_float_equal(pixel(rgb, 2, H / 2)[1], beside, 3);
    def.ground_stain = 0;
    draw(&def, &nothing, 0, rgb);
    assert_float_equal(middle(rgb, 1), clean, 1);

    def.ground_stain = 1;
    for (int i = 0; i < 4; i++) q.position[i][2] = 0.1f; // whole, and lifted
    float lifted[12];
    memcpy(lifted, q.position, sizeof lifted);
    for (int i = 0; i < 4; i++) q.position[i][0] += 1; // out of sight
    float low[12];
    memcpy(low, q.rest, sizeof low);
    start.positions = low;
    draw(&def, &q.surface, 0, rgb);
    assert_float_equal(middle(rgb, 1), clean, 1);
    start.positions = lifted;
    draw(&def, &nothing, 0, rgb);
    assert_float_equal(middle(rgb, 1), clean, 1);
}

static int compare_bytes(const void *a, const void *b) { return *(const uint8_t *)a - *(const uint8_t *)b; }

/// Ash touches the table: it is darker around what is pale. It looked like confetti. Seen at several places, as it lies in
/// drifts.
TEST(ash_has_a_shadow) {
    enum { NEAR = 1, RING = 3, PLACES = 16 };
    static uint8_t sorted[W * H];
    static const uint32_t cells[4] = {0, 1, 2, 3};
    PreviewStart start = {4, 1, &q.position[0][0], cells, NULL, NULL};
    quad_make(&q, 0.09f, 0.001f);
    PreviewDef def = above();
    def.camera.fov = 2 * atanf(0.006f / def.camera.eye[2]);
    def.ground = PREVIEW_GROUND_PLAIN, def.starts = &start, def.sheet_count = 1;
    float sum = 0;
    int around = 0, pale = 0, table = 0;
    for (int place = 0; place < PLACES; place++) {
        def.camera.eye[0] = def.camera.target[0] = 0.016f * (float)(place % 4) - 0.024f;
        def.camera.eye[1] = def.camera.target[1] = 0.012f * (float)(place / 4) - 0.018f;
        draw(&def, &nothing, 0, rgb);
        for (int i = 0; i < W * H; i++) sorted[i] = rgb[3 * i + 1];
        qsort(sorted, W * H, 1, compare_bytes);
        table = sorted[W * H / 2];
        for (int y = RING; y < H - RING; y++)
            for (int x = RING; x < W - RING; x++) {
                int nearest = RING + 1;
                for (int i = 0; i < (2 * RING + 1) * (2 * RING + 1); i++) {
                    const int dx = i % (2 * RING + 1) - RING, dy = i / (2 * RING + 1) - RING;
                    const int far = abs(dx) > abs(dy) ? abs(dx) : abs(dy);
                    if (far < nearest && pixel(rgb, x + dx, y + dy)[1] > table + 20) nearest = far;
                }
                pale += nearest == 0;
                const int level = pixel(rgb, x, y)[1];
                if (nearest <= NEAR || nearest > RING || level > table + 6) continue; // of a leaf that is less pale
                sum += (float)(level - table);
                around++;
            }
    }

    const float ring = sum / (float)around;
    print_message("%d pixels of pale ash on a table of %d, %.1f levels darker around them\n", pale, table,
                  (double)-ring);
    assert_true(pale > 100 && ring < -0.8f); // -0.3
}

/// Pale scales of ash lie on the table in drifts: their share, and how much it varies over squares of 3 cm. Specks that were
/// strewn evenly looked like snow.
TEST(ash_lies_in_drifts) {
    enum { SIDE = 8, ACROSS = W / SIDE, DOWN = H / SIDE };
    static uint8_t clean[BYTES];
    static const uint32_t cells[4] = {0, 1, 2, 3};
    PreviewStart start = {4, 1, &q.position[0][0], cells, NULL, NULL};
    quad_make(&q, 0.3f, 0.001f);
    PreviewDef def = above();
    def.camera.fov = 2 * atanf(0.12f / def.camera.eye[2]);
    def.ground = PREVIEW_GROUND_PLAIN, def.starts = &start, def.sheet_count = 1;
    draw(&def, &nothing, 0, rgb);
    for (int i = 0; i < W * H; i++) clean[i] = rgb[3 * i + 1];
    qsort(clean, W * H, 1, compare_bytes);
    const int table = clean[W * H / 2];

    float sum = 0, squares = 0;
    for (int k = 0; k < ACROSS * DOWN; k++) {
        float share = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const uint8_t *p = pixel(rgb, k % ACROSS * SIDE + i % SIDE, k / ACROSS * SIDE + i / SIDE);
            share += (float)(p[1] > table + 35) / (SIDE * SIDE);
        }
        sum += share, squares += share * share;
    }
    const float mean = sum / (ACROSS * DOWN), varies = sqrtf(squares / (ACROSS * DOWN) - mean * mean) / mean;
    print_message("pale ash covers %.4f of the table, and varies by %.2f of that\n", (double)mean, (double)varies);
    assert_true(mean > 0.005f); // 0.0002 of it was as pale
    assert_true(varies > 1.5f);
}

/// Pyrolysis leaves a black leaf, however little its mass, which greys as it glows away. It glows where char burns: not
/// where a hot leaf no longer burns, and less where it still has fuel, which burns in the flame.
TEST(char_is_black_and_greys) {
    float mass[4], charred[4], ash[4], green[3], red[4];
    PreviewDef def = above();

    quad_make(&q, 0.1f, 0.01f);
    q.surface.mass = mass, q.surface.char_fraction = charred, q.surface.ash_fraction = ash;
    for (int k = 0; k < 3; k++) { // with one reaction, with a leaf of char, with ash
        for (int i = 0; i < 4; i++) {
            charred[i] = k == 1 ? 0.25f : 0, ash[i] = k == 2 ? 0.12f : 0, mass[i] = k == 2 ? 0.12f : 0.25f;
            q.burn[i] = (1 - mass[i]) / 0.88f, q.peak[i] = 900;
        }

        draw(&def, &q.surface, 1, rgb);
        green[k] = middle(rgb, 1);
    }

    print_message("one reaction %.0f, leaf %.0f, ash %.0f\n", (double)green[0], (double)green[1], (double)green[2]);
    assert_true(green[1] < 60 && green[2] > green[1] + 30 && green[0] > green[1]);
    for (int c = 0; c < 3; c++) def.sun_colour[c] = 0;
    for (int k = 0; k < 4; k++) { // idle, with fuel, glowing, the line between leaf and ash
        for (int i = 0; i < 4; i++) {
            bool gone = k == 3 && (i == 1 || i == 2);
            charred[i] = gone ? 0 : 0.25f, ash[i] = gone ? 0.12f : 0;
            mass[i] = k == 1 ? 0.4f : charred[i] + ash[i];
            q.burn[i] = (1 - mass[i]) / 0.88f, q.temperature[i] = 1100, q.rate[i] = k > 0;
        }

        draw(&def, &q.surface, 1, rgb);
        red[k] = mean(rgb, 0) - mean(rgb, 2);
    }

    print_message("red of a hot leaf that is idle %.1f, has fuel %.1f, glows %.1f; of a line %.1f\n", (double)red[0],
                  (double)red[1], (double)red[2], (double)red[3]);
    assert_true(red[2] > red[0] + 1.5f && red[2] > red[1] + 1.5f && red[3] > red[0] + 1.5f);
}

/// A leaf of char glows in threads and specks, not as a whole: few of its pixels are as bright as half of the brightest.
/// Char that still feeds a flame, which takes the air, has fewer; it was black.
TEST(a_leaf_glows_in_threads) {
    static float glow[W * H][3];
    plate_make(&plate, 0.03f);
    PreviewDef def = above();
    def.camera.eye[2] = 0.06f, def.ground_height = -INFINITY;
    for (int c = 0; c < 3; c++) def.sun_colour[c] = def.sky_colour[c] = def.background[c] = 0;

    float red[2];
    for (int flames = 0; flames < 2; flames++) {
        plate_char(&plate, 1000, 0.5f, flames ? 0.2f : 0);
        draw(&def, &plate.surface, 1, rgb);

        int count[256] = {0}, most = 255, above_most = 0, bright = 0;
        for (int i = 0; i < W * H; i++) count[rgb[3 * i]]++;
        while (above_most < W * H / 50) above_most += count[most--]; // the brightest fiftieth is above
        for (int level = most / 2; level < 256; level++) bright += count[level];
        const float share = (float)bright / (W * H);
        red[flames] = mean(rgb, 0);
        print_message("brightest %d, mean %.0f, %.0f %% of the leaf above half of it\n", most, (double)red[flames],
                      100 * (double)share);
        assert_true(most > (flames ? 60 : 120) && share > 0.03f && share < 0.5f);

        // cores are hot, and what is around them is dull and red: one orange was a print
        const PreviewLayers layers = {.glow = glow};
        float average = 0, light[2][2] = {{0, 0}, {0, 0}};
        draw_layers(&def, &plate.surface, NULL, 1, &layers);
        for (int i = 0; i < W * H; i++) average += glow[i][0] / (W * H);
        for (int i = 0; i < 2 * W * H; i++) light[glow[i / 2][0] > 2 * average][i % 2] += glow[i / 2][i % 2];
        const float dull = light[0][1] / light[0][0], core = light[1][1] / light[1][0];
        print_message("green over red: %.3f where it is dull, %.3f in cores\n", (double)dull, (double)core);
        assert_true(core > 1.7f * dull); // 1.50, 1.23
    }

    assert_true(red[1] < 0.7f * red[0]);
}

/// Change from pixel to pixel of the bare table over its mean, along the planks and across them, seen from `height` m.
static void table_grain(float height, float change[2]) {
    PreviewDef def = above();
    def.camera.eye[0] = def.camera.target[0] = 0.3f, def.camera.eye[1] = def.camera.target[1] = 0.06f;
    def.camera.eye[2] = height, def.camera.fov = 0.3f;
    def.samples = 16;
    draw(&def, &nothing, 0, rgb);

    float sum[2] = {0, 0};
    for (int y = 0; y + 1 < H; y++)
        for (int x = 0; x + 1 < W; x++) {
            const float here = pixel(rgb, x, y)[1];
            sum[0] += fabsf((float)pixel(rgb, x + 1, y)[1] - here);
            sum[1] += fabsf((float)pixel(rgb, x, y + 1)[1] - here);
        }
    for (int k = 0; k < 2; k++) change[k] = sum[k] / (W * H) / mean(rgb, 1);
}

/// A wooden table has fibres and pores: fine lines along its planks, which a camera sees from near.
TEST(wood_has_a_grain) {
    float near[2], far[2];
    table_grain(0.12f, near);
    table_grain(3, far);
    print_message("along, across: %.2f, %.2f %% from near, %.2f, %.2f %% from afar\n", (double)(100 * near[0]),
                  (double)(100 * near[1]), (double)(100 * far[0]), (double)(100 * far[1]));
    assert_true(near[1] > 2.5f * near[0]);
    assert_true(near[1] > 0.045f); // 0.035 by year rings alone
    assert_true(far[0] < 0.011f && far[1] < 0.05f);
}

/// How much pixels of the sheet's middle differ from their mean, over it.
static float unevenness(const uint8_t *picture) {
    enum { HALF = 10 };
    const float whole = middle(picture, 1);
    float sum = 0;
    for (int y = H / 2 - HALF; y < H / 2 + HALF; y++)
        for (int x = W / 2 - HALF; x < W / 2 + HALF; x++) {
            const float off = (float)pixel(picture, x, y)[1] - whole;
            sum += off * off;
        }
    return sqrtf(sum) / (2 * HALF) / whole;
}

/// A coated print mirrors the light; in heat that only browns paper its coating blisters.
TEST(coatings_mirror_and_blister) {
    float bright[2], uneven[2];
    for (int coated = 0; coated < 2; coated++) {
        const PreviewLook look = {.coating = (float)coated};
        quad_make(&q, 0.008f, 0.45f);
        PreviewDef def = above();
        def.looks = &look, def.sheet_count = 1;
        def.camera.fov = 0.3f;
        for (int c = 0; c < 3; c++) def.sun_direction[c] = c == 2, def.sun_colour[c] = 1;
        uint8_t texels[3] = {60, 60, 60};
        Image image = {.width = 1, .height = 1, .rgb = texels};
        const Image *pictures[1] = {&image};
        def.pictures = pictures;
        draw(&def, &q.surface, 0, rgb);
        bright[coated] = middle(rgb, 1);
        for (int i = 0; i < 4; i++) q.peak[i] = 430;
        draw(&def, &q.surface, 0, rgb);
        uneven[coated] = unevenness(rgb);
    }
    print_message("facing the sun %.0f bare, %.0f coated; heated, uneven by %.1f and %.1f %%\n", (double)bright[0],
                  (double)bright[1], (double)(100 * uneven[0]), (double)(100 * uneven[1]));
    assert_true(bright[1] > bright[0] + 15);
    assert_true(uneven[1] > 2 * uneven[0]);
}

/// How much lighter print is than what is around it, of 255, on a cold sheet that is burnt so far and was ignited so long
/// ago.
static float print_on(float burnt, float age) {
    uint8_t texels[2 * 1 * 3] = {255, 255, 255, 20, 20, 20};
    Image image = {.width = 2, .height = 1, .rgb = texels};
    const Image *pictures[1] = {&image};
    float ignited[4] = {0, 0, 0, 0};
    quad_make(&q, 0.1f, 0.01f);
    for (int i = 0; i < 4; i++) q.burn[i] = burnt, q.peak[i] = 900;
    q.surface.time_ignited = ignited;

    PreviewDef def = above();
    def.pictures = pictures, def.sheet_count = 1;
    draw(&def, &q.surface, (double)age, rgb);
    float sum[2] = {0, 0};
    for (int y = 4; y < H - 4; y++)
        for (int x = 4; x < 12; x++)
            for (int side = 0; side < 2; side++) sum[side] += pixel(rgb, side ? W / 2 + x : W / 2 - x, y)[1];
    return (sum[1] - sum[0]) / (8 * (H - 8));
}

/// Print is lighter than char, and than the ash that char turns to: it never fades away between.
TEST(print_stays_on_ash) {
    const float stages[6][2] = {{0.6f, 2}, {0.82f, 3}, {0.9f, 4}, {1, 4}, {1, 10}, {1, 40}};
    for (int k = 0; k < 6; k++) {
        const float lighter = print_on(stages[k][0], stages[k][1]);
        print_message("burnt %.2f, %2.0f s: print is lighter by %.1f\n", (double)stages[k][0], (double)stages[k][1],
                      (double)lighter);
        assert_true(lighter > 12);
    }
}

/// A camera from above whose picture is `high` m high.
static PreviewDef close_above(float high) {
    PreviewDef def = above();
    def.camera.fov = 2 * atanf(0.5f * high / def.camera.eye[2]);
    def.ground_height = -INFINITY;
    for (int c = 0; c < 3; c++) def.background[c] = 0;
    return def;
}

/// Mean of a channel over what is within 0.6 mm of the borders of a plate 12 mm wide, and over its middle.
static void border_and_middle(const uint8_t *picture, int channel, float mean[2]) {
    const float millimetres = 16.0f / H;
    float sum[2] = {0, 0}, count[2] = {0, 0};
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const float across = fabsf((float)x + 0.5f - W / 2) * millimetres;
            const float along = fabsf((float)y + 0.5f - H / 2) * millimetres, from = 6 - fmaxf(across, along);
            const int part = from > 0 && from < 0.6f ? 0 : from > 2 ? 1 : 2;
            if (part == 2 || pixel(picture, x, y)[0] == 0) continue; // beyond the plate, or bitten off
            sum[part] += pixel(picture, x, y)[channel];
            count[part]++;
        }
    for (int k = 0; k < 2; k++) mean[k] = sum[k] / fmaxf(count[k], 1);
}

/// A loose plate of char is pale at its borders, which glow on while it is warm, for some seconds.
TEST(plates_have_pale_borders_that_glow_for_a_while) {
    float pale[2], young[2], old[2];
    plate_make(&plate, 0.012f);
    for (int i = 0; i < NODES; i++) plate.burn[i] = 0.6f, plate.peak[i] = 900;
    PreviewDef def = close_above(0.016f);
    draw(&def, &plate.surface, 4, rgb);
    border_and_middle(rgb, 1, pale);

    for (int c = 0; c < 3; c++) def.sun_colour[c] = def.sky_colour[c] = 0;
    for (int i = 0; i < NODES; i++) plate.temperature[i] = 600;
    draw(&def, &plate.surface, 1, rgb);
    border_and_middle(rgb, 0, young);
    draw(&def, &plate.surface, 9, rgb);
    border_and_middle(rgb, 0, old);
    print_message("border, middle: cold %.0f, %.0f; warm, red, after 1 s %.0f, %.0f, after 9 s %.0f, %.0f\n",
                  (double)pale[0], (double)pale[1], (double)young[0], (double)young[1], (double)old[0], (double)old[1]);
    assert_true(pale[0] > pale[1] + 18); // 14 without scales of ash
    assert_true(young[0] > young[1] + 20);
    assert_true(young[0] - young[1] > 3 * fmaxf(old[0] - old[1], 1));
}

/// Between cream and brown, scorched paper has a band of tan, whose border is uneven.
TEST(scorch_has_a_tan_band_with_an_uneven_border) {
    const float pixel_size = 24.0f / W; // mm
    plate_make(&plate, 0.024f);
    for (int i = 0; i < NODES; i++)
        plate.peak[i] = 293 + 450 * expf(-(plate.position[i][0] + 0.012f) / 0.006f); // as ahead of a fire
    PreviewDef def = close_above(0.016f);
    draw(&def, &plate.surface, 0, rgb);

    float tan = 0, brown = 0, place = 0, squares = 0;
    for (int y = 0; y < H; y++) {
        int border = 0;
        for (int x = 0; x < W; x++) {
            const uint8_t *p = pixel(rgb, x, y);
            const bool is_tan = p[0] >= 150 && p[0] < 225 && p[0] > p[1] + 12 && p[0] - p[2] > 45 && p[0] - p[2] < 105;
            tan += is_tan;
            brown += p[0] > 30 && p[0] < 150;
            if (p[0] - p[2] > 45) border = x;
        }
        place += (float)border;
        squares += (float)border * (float)border;
    }
    const float uneven = sqrtf(fmaxf(squares / H - place * place / (H * H), 0)) * pixel_size;
    print_message("tan %.2f mm wide, brown %.2f mm, border uneven by %.2f mm\n", (double)(tan / H * pixel_size),
                  (double)(brown / H * pixel_size), (double)uneven);
    assert_true(tan > 1.4f * brown);
    assert_true(uneven > 0.8f);
}

/// Ahead of a front the band is wide, as vapour condenses there; paper that is evenly warm remains white.
TEST(scorch_is_wide_ahead_of_a_front_and_nowhere_else) {
    plate_make(&plate, 0.024f);
    PreviewDef def = close_above(0.016f);
    float browned[2] = {0, 0}, brown = 0; // mm; brown: not tan any more, nor black
    for (int even = 0; even < 2; even++) {
        for (int i = 0; i < NODES; i++)
            plate.peak[i] = 293 + (even ? 40 : 450 * expf(-(plate.position[i][0] + 0.012f) / 0.0015f));
        draw(&def, &plate.surface, 0, rgb);
        for (int k = 0; k < W * H; k++) {
            const uint8_t *p = pixel(rgb, k % W, k / W);
            browned[even] += (p[0] - p[2] > 30 || p[0] < 150) * 24.0f / W / H;
            brown += (p[0] < 170 && p[0] - p[2] > 45) * 24.0f / W / H;
        }
    }
    print_message("ahead of a front %.2f mm are tan or darker, %.2f mm brown; where evenly warm %.2f mm\n",
                  (double)browned[0], (double)brown, (double)browned[1]);
    assert_true(browned[0] > 4 && brown > 2.5f);
    assert_true(browned[1] == 0);
}

/// A fine picture, of pixels of 0.14 mm.
enum { FINE_W = 384, FINE_H = 256 };
#define FINE_HIGH 0.036f

/// Char pales by and by: there is about as much dark grey as pale ash. Flat flakes looked pasted on.
TEST(ash_on_char_pales_by_degrees) {
    static uint8_t picture[FINE_W * FINE_H * 3], sorted[FINE_W * FINE_H];
    plate_make(&plate, 0.06f);
    for (int i = 0; i < NODES; i++) plate.burn[i] = 0.62f, plate.peak[i] = 900;
    PreviewDef def = close_above(FINE_HIGH);
    def.width = FINE_W, def.height = FINE_H;
    Preview *preview = preview_open(&def);
    assert_int_equal(preview_draw(preview, &plate.surface, 12, picture, NULL), SINGE_OK);
    preview_destroy(preview);

    for (int i = 0; i < FINE_W * FINE_H; i++) sorted[i] = picture[3 * i + 1];
    qsort(sorted, FINE_W * FINE_H, 1, compare_bytes);
    const float black = sorted[FINE_W * FINE_H / 4], span = sorted[FINE_W * FINE_H - FINE_W * FINE_H / 200] - black;
    float grey = 0, pale = 0;
    for (int i = 0; i < FINE_W * FINE_H; i++) {
        const float share = ((float)sorted[i] - black) / span;
        grey += share > 0.3f && share < 0.65f;
        pale += share >= 0.65f;
    }
    print_message("from %.0f by %.0f levels; dark grey over pale: %.2f\n", (double)black, (double)span,
                  (double)(grey / pale));
    assert_true(span > 50);
    assert_true(grey > 0.8f * pale); // was 0.32
}

/// A plate of char that glows away, drawn in the dark: its own light.
static void draw_leaf(float glow[FINE_W * FINE_H][3], double time) {
    plate_make(&plate, 0.033f);
    plate_char(&plate, 1000, 0.5f, 0);
    PreviewDef def = close_above(FINE_HIGH);
    def.width = FINE_W, def.height = FINE_H;
    for (int c = 0; c < 3; c++) def.sun_colour[c] = def.sky_colour[c] = 0;
    def.flakes = 0; // they hide parts of it
    OwnPreview *preview = preview_open(&def);
    const PreviewLayers layers = {.glow = glow};
    assert_int_equal(preview_draw_layers(preview, &plate.surface, time, NULL, &layers, NULL), SINGE_OK);
}

/// How far into the plate a pixel of the fine picture lies, mm, and at which of its sides.
static float plate_depth(int pixel, float width, int *side, float *along) {
    const float size = 1e3f * FINE_HIGH / FINE_H, half = 500 * width;
    const float x = ((float)(pixel % FINE_W) + 0.5f - FINE_W / 2) * size + half;
    const float y = ((float)(pixel / FINE_W) + 0.5f - FINE_H / 2) * size + half;
    const float depth[4] = {x, 2 * half - x, y, 2 * half - y};
    *side = 0;
    for (int k = 1; k < 4; k++)
        if (depth[k] < depth[*side]) *side = k;
    *along = *side < 2 ? y : x;
    return depth[*side];
}

/// Ash is a fringe along dead borders, and a thin skin elsewhere: pale patches all over a leaf were blots.
TEST(ash_is_a_fringe_along_dead_borders) {
    enum { BINS = 12 };
    static uint8_t picture[FINE_W * FINE_H * 3];
    const float width = 0.033f;
    plate_make(&plate, width);
    for (int i = 0; i < NODES; i++) plate.burn[i] = 0.64f, plate.peak[i] = 900;
    PreviewDef def = close_above(FINE_HIGH);
    def.width = FINE_W, def.height = FINE_H;
    OwnPreview *preview = preview_open(&def);
    assert_int_equal(preview_draw(preview, &plate.surface, 12, picture, NULL), SINGE_OK);

    float sum[BINS] = {0}, count[BINS] = {0};
    for (int i = 0; i < FINE_W * FINE_H; i++) {
        int side;
        float along;
        const float depth = plate_depth(i, width, &side, &along);
        if (depth < 0 || depth >= BINS || picture[3 * i] == 0) continue;
        sum[(int)depth] += picture[3 * i + 1], count[(int)depth]++;
    }
    const float fringe = (sum[0] + sum[1]) / (count[0] + count[1]), next = sum[2] / count[2];
    const float within = (sum[8] + sum[9] + sum[10] + sum[11]) / (count[8] + count[9] + count[10] + count[11]);
    print_message("ash at the border %.1f, 2 mm within %.1f, in the middle %.1f\n", (double)fringe, (double)next,
                  (double)within);
    assert_true(fringe > 1.4f * within); // 1.2
    assert_true(next < 0.8f * fringe);
}

/// How much the green of ash changes from pixel to pixel, over that from each to the tenth beside it, where its middle lay that
/// far along both sides of its sheet.
static float ash_grain(float place) {
    static float rest[NODES][3];
    static uint8_t picture[FINE_W * FINE_H * 3];
    plate_make(&plate, 0.08f);
    memcpy(rest, plate.position, sizeof rest);
    for (int i = 0; i < NODES; i++)
        rest[i][0] += place, rest[i][1] += place, plate.burn[i] = 0.64f, plate.peak[i] = 900;
    plate.surface.rest_position = rest;
    PreviewDef def = close_above(FINE_HIGH);
    def.width = FINE_W, def.height = FINE_H;
    OwnPreview *preview = preview_open(&def);
    assert_int_equal(preview_draw(preview, &plate.surface, 12, picture, NULL), SINGE_OK);
    float next = 0, tenth = 0;
    for (int i = 10; i < FINE_W * FINE_H; i++) {
        const float here = picture[3 * i + 1];
        next += fabsf(here - (float)picture[3 * (i - 1) + 1]), tenth += fabsf(here - (float)picture[3 * (i - 10) + 1]);
    }
    return next / tenth;
}

/// Fibres of ash are as long and as wide all over a sheet. Where their direction wandered about its corner they were rings, as of
/// wood, the narrower the farther they lay from it.
TEST(ash_is_alike_all_over_a_sheet) {
    const float near = ash_grain(0), far = ash_grain(0.3f);
    print_message("ash changes from pixel to pixel by %.2f, 40 cm away by %.2f\n", (double)near, (double)far);
    assert_true(near > 0.2f && far < 1.1f * near);
}

/// A leaf glows along its border, where air comes to it: yellow there, dull red some millimetres within, and hardly in its
/// middle; and the border is dead in places, for more than a centimetre. An even mat of coals was lava.
TEST(a_leaf_glows_along_its_border) {
    enum { TIMES = 6, BINS = 12, STEP = 3 }; // bins of a millimetre; stretches of border of three
    static float glow[FINE_W * FINE_H][3];
    float sum[BINS][2] = {{0}}, count[BINS] = {0};
    int dead = 0, all = 0, longest = 0;
    for (int time = 0; time < TIMES; time++) {
        float border[4 * 11] = {0};
        draw_leaf(glow, 20 * time);
        for (int i = 0; i < FINE_W * FINE_H; i++) {
            int side;
            float way;
            const float depth = plate_depth(i, 0.033f, &side, &way), pixel = 1e3f * FINE_HIGH / FINE_H;
            if (depth < 0 || depth >= BINS) continue;
            const int bin = (int)depth;
            for (int c = 0; c < 2; c++) sum[bin][c] += glow[i][c];
            count[bin]++;
            const int along = (int)fminf(way / STEP, 10);
            if (bin < 4) border[11 * side + along] += glow[i][0] * pixel * pixel;
        }
        for (int k = 0, run = 0; k < 44; k++) {
            if (k % 11 == 0) run = 0;
            const bool dark = border[k] < 0.5f;
            run = dark ? run + STEP : 0;
            longest = run > longest ? run : longest;
            dead += dark, all++;
        }
    }
    const float bright = (sum[1][0] + sum[2][0]) / (count[1] + count[2]);
    const float within = (sum[6][0] + sum[7][0] + sum[8][0]) / (count[6] + count[7] + count[8]);
    const float yellow = (sum[1][1] + sum[2][1]) / (sum[1][0] + sum[2][0]),
                red = (sum[5][1] + sum[6][1]) / (sum[5][0] + sum[6][0]);
    print_message("border %.2f, within %.2f; green over red %.3f, %.3f; %.2f of the border is dead, for up to %d mm\n",
                  (double)bright, (double)within, (double)yellow, (double)red, (double)dead / all, longest);
    assert_true(bright > 3 * within);  // 1.3
    assert_true(yellow > 1.35f * red); // 1.07
    assert_true(longest > 9 && dead > all / 10 && dead < all / 2);
}

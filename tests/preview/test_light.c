// Light and shadow: light of flames, shadows of sheets, light through sheets, and the grain of shadows.

#include "plate.h"

// what a case works on
static Float4 q;
static Ball ball;

/// A sheet that stands on the table in the plane x = 0, 24 cm wide and high, printed with what is given.
static void wall_make(Float4 *quad) {
    quad_make(quad, 0.12f, 0);
    for (int i = 0; i < 4; i++) {
        float across = quad->position[i][0], up = quad->position[i][1];
        quad->position[i][0] = 0, quad->position[i][1] = across, quad->position[i][2] = 0.12f + up;
        quad->normal[i][0] = 1, quad->normal[i][2] = 0;
    }
}

/// The picture's linear light; `gas` may be NULL.
static void see(const PreviewDef *def, const SingeSurface *surface, const SingeGas *gas, float (*beauty)[3]) {
    PreviewLayers layers = {.beauty = beauty};
    draw_layers(def, surface, gas, 0.3, &layers);
}

/// Mean of the green over a box of 9 x 9 pixels.
static float box(float (*beauty)[3], int x, int y) {
    float sum = 0;
    for (int k = 0; k < 81; k++) sum += beauty[(y + k / 9 - 4) * W + x + k % 9 - 4][1] / 81;
    return sum;
}

/// The light that a flame adds to a point.
static float added(const PreviewDef *def, const SingeSurface *surface, int x, int y) {
    static float dark[W * H][3], lit[W * H][3];
    ball_make(&ball, -0.07f, 0, 0.1f, 0.03f, 4e6f, 0);
    see(def, surface, NULL, dark), see(def, surface, &ball.gas, lit);
    return box(lit, x, y) - box(dark, x, y);
}

static PreviewDef at_night(void) {
    PreviewDef def = above();
    def.ground = PREVIEW_GROUND_PLAIN;
    for (int c = 0; c < 3; c++) def.sun_colour[c] = 0, def.sky_colour[c] = 0.05f, def.ground_colour[c] = 0.5f;
    return def;
}

/// Firelight on what is white is amber, as a camera that is balanced for lamps sees 1900 K: with the moon's blue it stays
/// warm. As daylight's white sees it, it was 1, 0.28, 0.01: red, and pink under the moon.
TEST(firelight_is_warm) {
    static float dark[W * H][3], lit[W * H][3];
    const PreviewDef def = at_night();
    float sum[3] = {0, 0, 0};
    ball_make(&ball, -0.07f, 0, 0.1f, 0.03f, 4e6f, 0);
    see(&def, &nothing, NULL, dark), see(&def, &nothing, &ball.gas, lit);
    for (int x = W / 2; x < W / 2 + 20; x++)
        for (int c = 0; c < 3; c++) sum[c] += lit[H / 2 * W + x][c] - dark[H / 2 * W + x][c];
    print_message("firelight 1, %.3f, %.3f\n", (double)(sum[1] / sum[0]), (double)(sum[2] / sum[0]));
    assert_true(sum[1] > 0.34f * sum[0] && sum[1] < 0.46f * sum[0]);
    assert_true(sum[2] > 0.04f * sum[0] && sum[2] < 0.13f * sum[0]);
}

/// A sheet between the flame and the table: the table's light is that of the open times what comes through. An eighth
/// of it is the bar for an opaque sheet, and a sheet that lets half through breaks it.
TEST(a_sheet_shadows_the_light_of_a_flame) {
    PreviewDef def = at_night();
    float share = 0, light[3], open;
    def.transmittances = &share, def.sheet_count = 1;
    wall_make(&q);
    const int x = W / 2 + 16, y = H / 2; // 8 cm before the sheet
    open = added(&def, &nothing, x, y);
    for (int k = 0; k < 3; k++) share = 0.3f * (float)k, light[k] = added(&def, &q.surface, x, y);
    print_message("before the sheet: open %.4f, through 0, .3, .6: %.4f %.4f %.4f\n", (double)open, (double)light[0],
                  (double)light[1], (double)light[2]);
    assert_true(open > 0.002f && light[0] < 0.125f * open && light[2] > 0.125f * open);
    assert_float_equal((light[2] - light[0]) / (light[1] - light[0]), 2, 0.15);
    assert_true(added(&def, &q.surface, W / 2 - 16, y) > 0.8f * open); // behind it nothing is hidden
}

/// Nothing leaks through an opaque sheet that a flame stands close to: rays ended before the sheet, within a lamp's extent.
TEST(firelight_does_not_leak_through_a_sheet) {
    static float dark[W * H][3], lit[W * H][3];
    PreviewDef def = at_night();
    float share = 0, light[2];
    def.transmittances = &share, def.sheet_count = 1;
    wall_make(&q), ball_make(&ball, -0.04f, 0, 0.06f, 0.018f, 4e6f, 0);
    for (int k = 0; k < 2; k++) {
        see(&def, k ? &q.surface : &nothing, NULL, dark), see(&def, k ? &q.surface : &nothing, &ball.gas, lit);
        light[k] = box(lit, W / 2 + 6, H / 2) - box(dark, W / 2 + 6, H / 2); // 3 cm behind it
    }
    print_message("behind a sheet that stands by a flame: %.4f, in the open %.4f\n", (double)light[1],
                  (double)light[0]);
    assert_true(light[1] < 0.12f * light[0]);
}

/// Seen from the other side, a sheet in front of a flame glows by transmitted light, and its print shows.
TEST(a_sheet_before_a_flame_shines_through) {
    uint8_t texels[2 * 1 * 3] = {255, 255, 255, 60, 60, 60};
    Image image = {.width = 2, .height = 1, .rgb = texels};
    const Image *pictures[1] = {&image};
    PreviewDef def = at_night();
    def.camera = (PreviewCamera){.eye = {0.5f, 0, 0.12f}, .target = {0, 0, 0.12f}, .up = {0, 0, 1}, .fov = 0.4f};
    float share = 0, white[3], ink = 0;
    def.transmittances = &share, def.sheet_count = 1, def.pictures = pictures;
    wall_make(&q);
    for (int k = 0; k < 3; k++) {
        share = 0.15f * (float)k, white[k] = added(&def, &q.surface, W / 2 - 12, H / 2);
        ink = added(&def, &q.surface, W / 2 + 12, H / 2);
    }
    print_message("through the sheet: %.4f %.4f %.4f, of ink %.4f\n", (double)white[0], (double)white[1],
                  (double)white[2], (double)ink);
    assert_true(white[0] < 0.05f * white[1] && white[1] > 0.06f); // .01: what flames cast was less, and spread further
    assert_float_equal(white[2] / white[1], 2, 0.1);              // farther up it is 1.85: what is bright adds less
    assert_true(ink < 0.4f * white[2]);
}

/// Light through paper over the same light before it: an opacity of 92 % by ISO 2471 (it was 87 %), for office paper of 80 g/m2
/// has 90 to 94, and warm from whatever lamp (a flame's kept its colour). With the reflectance R of a stack, R0 = o R of a
/// sheet over black and T^2 = (R - R0) (1 - R0 R) / R.
TEST(paper_is_as_opaque_as_it_should_be) {
    static float picture[W * H][3], dark[W * H][3];
    PreviewDef def = at_night();
    float light[2][3], flame[2][3], opacity = 1;
    def.ground_height = -INFINITY;
    for (int k = 0; k < 2; k++) {
        quad_make(&q, 0.12f, 0);
        def.camera.eye[2] = k ? -0.5f : 0.5f;
        for (int c = 0; c < 3; c++) def.sky_colour[c] = 0, def.sun_colour[c] = 1;
        see(&def, &q.surface, NULL, picture);
        for (int c = 0; c < 3; c++) def.sun_colour[c] = 0;
        ball_make(&ball, 0, 0, 0.1f, 0.03f, 4e6f, 0);
        see(&def, &q.surface, NULL, dark);
        for (int c = 0; c < 3; c++) light[k][c] = picture[(H / 2 + 8) * W + W / 2 + 12][c];
        see(&def, &q.surface, &ball.gas, picture);
        for (int c = 0; c < 3; c++) flame[k][c] = picture[(H / 2 + 8) * W + W / 2 + 12][c];
    }
    const float luminance[3] = {0.2126f, 0.7152f, 0.0722f};
    float before = 0, through = 0;
    for (int c = 0; c < 3; c++) before += luminance[c] * light[0][c], through += luminance[c] * light[1][c];
    const float stack = 0.852f, passed = stack * through / before;
    while (opacity > 0.5f && (1 - opacity) * (1 - opacity * stack * stack) < passed * passed) opacity -= 1e-3f;
    const float warm = flame[1][0] / flame[1][2] / (flame[0][0] / flame[0][2]);
    print_message("through paper %.3f, opacity %.3f; light of a flame is %.2f times as red\n", (double)passed,
                  (double)opacity, (double)warm);
    assert_true(opacity > 0.90f && opacity < 0.94f && warm > 1.3f);
}

/// Print is on the side from which it reads. On the other it is a shadow, a twentieth of its contrast to a fifth, and dyes of
/// cloth are on both. It was as black on both.
TEST(print_shows_faintly_on_the_back) {
    static float picture[W * H][3];
    uint8_t texels[2 * 1 * 3] = {255, 255, 255, 60, 60, 60};
    Image image = {.width = 2, .height = 1, .rgb = texels};
    const Image *pictures[1] = {&image};
    PreviewDef def = at_night();
    float contrast[2];
    def.ground_height = -INFINITY, def.sheet_count = 1, def.pictures = pictures;
    for (int k = 0; k < 2; k++) {
        quad_make(&q, 0.12f, 0);
        def.camera.eye[2] = def.sun_direction[2] = k ? -0.5f : 0.5f;
        for (int c = 0; c < 3; c++) def.sky_colour[c] = 0, def.sun_colour[c] = 1;
        see(&def, &q.surface, NULL, picture);
        const float a = box(picture, W / 2 - 12, H / 2), b = box(picture, W / 2 + 12, H / 2);
        contrast[k] = 1 - fminf(a, b) / fmaxf(a, b);
    }
    print_message("contrast of print: %.3f, on the back %.3f\n", (double)contrast[0], (double)contrast[1]);
    assert_true(contrast[0] > 0.9f && contrast[1] > 0.05f * contrast[0] && contrast[1] < 0.2f * contrast[0]);
}

/// White paper beside a flame keeps its shades, however large it is: it was lit by four times the film's white.
TEST(paper_beside_a_flame_is_not_blown_out) {
    static float picture[W * H][3];
    PreviewDef def = at_night();
    quad_make(&q, 0.12f, 0);
    ball_make(&ball, 0, 0, 0, 0.03f, 4e6f, 0);
    ball.gas.cell *= 15;
    for (int c = 0; c < 3; c++) ball.gas.origin[c] = -0.5f * GAS_SIDE * ball.gas.cell;
    ball.gas.origin[0] -= 4.2f * ball.gas.cell; // beside what is seen
    ball.gas.origin[2] += 0.45f;                // on the paper's side
    see(&def, &q.surface, &ball.gas, picture);
    const float light = box(picture, W / 2, H / 2);
    print_message("paper beside a flame: %.2f\n", (double)light);
    assert_true(light > 0.5f && light < 1.2f); // was 3.2
}

/// A near lamp lights what is below it, less with the square of the distance, and not what a sheet hides from it.
TEST(a_lamp_lights_what_is_near) {
    static float beauty[W * H][3];
    PreviewDef def = at_night();
    float share = 0, seen[4];
    const float height[4] = {0, 0.15f, 0.3f, 0.15f};
    def.ground_gloss = 0, def.transmittances = &share, def.sheet_count = 1;
    quad_make(&q, 0.03f, 0.1f);
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) def.lamp_colour[c] = k ? 0.05f : 0;
        def.lamp_position[2] = height[k], def.lamp_radius = 0.01f;
        def.camera.eye[1] = -0.5f, def.camera.up[2] = 1; // past the sheet
        see(&def, k == 3 ? &q.surface : &nothing, NULL, beauty);
        seen[k] = box(beauty, W / 2, H / 2);
    }
    print_message("lamp: none %.4f, at 15 cm %.4f, at 30 cm %.4f, behind a sheet %.4f\n", (double)seen[0],
                  (double)seen[1], (double)seen[2], (double)seen[3]);
    assert_float_equal((seen[1] - seen[0]) / (seen[2] - seen[0]), 4, 0.3);
    assert_true(seen[3] < seen[0] + 0.1f * (seen[1] - seen[0]));
}

/// What char gives off as it is seen, and the light that it throws are one: char that glows alone, char that feeds a flame, and
/// char whose flame is slow, which is dark. Leaves of char threw no light at all.
TEST(char_throws_the_light_that_is_seen) {
    enum { ALONE, WIDE, FED, SLOW, CASES, TIMES = 8 };
    static const float width[CASES] = {0.02f, 0.045f, 0.02f, 0.02f}, fuel[CASES] = {0, 0, 0.3f, 0.3f};
    static const float rate[CASES] = {1, 1, 1, 0.05f};
    static float glow[W * H][3];
    static Plate plate;
    PreviewDef def = at_night();
    def.camera.fov = 0.1f;
    const float pixel = 2 * 0.5f * tanf(0.05f) / H;

    for (int k = 0; k < CASES; k++) {
        plate_make(&plate, width[k]);
        plate_char(&plate, 950, rate[k], fuel[k]);
        const PreviewLayers layers = {.glow = glow};
        uint8_t *frame;
        size_t size;
        float seen = 0, thrown = 0, strength[3];
        uint32_t lights;
        OwnPreview *preview = preview_open(&def);
        for (int time = 0; time < TIMES; time++) {
            assert_int_equal(preview_draw_layers(preview, &plate.surface, 12 * time, NULL, &layers, NULL), SINGE_OK);
            assert_int_equal(preview_pack(preview, &plate.surface, 12 * time, &frame, &size, NULL), SINGE_OK);
            for (int i = 0; i < W * H; i++) seen += glow[i][0] * pixel * pixel / TIMES;

            // a light's strength is five times the radiance, over half a sphere (lamps.c, pack.c)
            memcpy(&lights, frame + 16, sizeof lights);
            for (uint32_t i = 0; i < lights; i++) {
                memcpy(strength, frame + 80 + 32 * i + 16, sizeof strength);
                thrown += strength[0] * 2 * 3.1415927f / 5 / TIMES;
            }
            free(frame);
        }
        print_message("case %d: seen %.3g, thrown %.3g\n", k, (double)seen, (double)thrown);
        if (k == SLOW) assert_true(seen < 1e-5f && thrown < 1e-5f);
        else assert_true(thrown > 0.6f * seen && seen > 0.6f * thrown);
    }
}

/// Beside flames, which dazzle, embers throw a third of the light that they throw in the dark: all of it made rooms red.
TEST(flames_outshine_embers) {
    const PreviewDef def = at_night();
    float charred[4] = {0.4f, 0.4f, 0.4f, 0.4f}, ash[4] = {0};
    quad_make(&q, 0.02f, 0);
    for (int i = 0; i < 4; i++) q.burn[i] = 0.6f, q.temperature[i] = q.peak[i] = 950, q.rate[i] = 1;
    q.surface.mass = q.surface.char_fraction = charred, q.surface.ash_fraction = ash;
    ball_make(&ball, -0.07f, 0, 0.1f, 0.03f, 4e6f, 0);
    float red[2] = {0, 0};

    for (int k = 0; k < 2; k++) {
        uint8_t *frame;
        size_t size;
        uint32_t lights;
        OwnPreview *preview = preview_open(&def);
        assert_int_equal(preview_set_gas(preview, k ? &ball.gas : NULL, NULL), SINGE_OK);
        assert_int_equal(preview_pack(preview, &q.surface, 0, &frame, &size, NULL), SINGE_OK);
        memcpy(&lights, frame + 16, sizeof lights);
        for (uint32_t i = 0; i < lights; i++) {
            float strength[3];
            memcpy(strength, frame + 80 + 32 * i + 16, sizeof strength);
            if (strength[1] < 0.2f * strength[0]) red[k] += strength[0]; // no flame's
        }
        free(frame);
    }
    print_message("embers throw %.3g in the dark, %.3g beside flames\n", (double)red[0], (double)red[1]);
    assert_true(red[0] > 0 && red[1] > 0.25f * red[0] && red[1] < 0.5f * red[0]);
}

/// A glossy ground mirrors a glowing ball: the camera looks at its image. A dull ground, as all were, breaks the bar.
TEST(a_glossy_ground_mirrors_embers) {
    static float beauty[W * H][3];
    PreviewDef def = at_night();
    PreviewShape ember = {
        .kind = SINGE_COLLIDER_SPHERE, .position = {0, 0, 0.08f}, .radius = 0.025f, .temperature = 1450};
    float seen[3];
    def.shapes = &ember, def.shape_count = 1;
    def.camera = (PreviewCamera){.eye = {0, -0.5f, 0.1f}, .target = {0, 0, -0.08f}, .up = {0, 0, 1}, .fov = 0.6f};
    for (int k = 0; k < 3; k++) {
        def.ground_gloss = 3 * (float)k;
        see(&def, &nothing, NULL, beauty);
        seen[k] = box(beauty, W / 2, H / 2) - box(beauty, 8, H / 2);
    }
    print_message("mirrored by gloss 0, 3, 6: %.4f %.4f %.4f\n", (double)seen[0], (double)seen[1], (double)seen[2]);
    assert_true(seen[1] > seen[0] + 0.002f);
    assert_float_equal((seen[2] - seen[0]) / (seen[1] - seen[0]), 2, 0.1);
}

/// A hot ball sets bit by bit on a sheet that bulges, as it is wide: the largest share of the light that is lost from one
/// pixel to the next. A lamp that sets at one angle, whatever its extent, draws an arc.
TEST(light_sets_softly_on_a_bulging_sheet) {
    enum { ACROSS = 61, COUNT = 2 * ACROSS, CELLS = ACROSS - 1 };
    static float position[COUNT][3], normal[COUNT][3], uv[COUNT][2], cold[COUNT], nought[COUNT], beauty[W * H][3];
    static uint32_t triangles[2 * CELLS][3];
    static int32_t sheet[COUNT];
    const float radius = 0.08f;
    for (uint32_t i = 0; i < COUNT; i++) {
        const float turn = 0.025f * ((float)(i / 2) - 0.5f * CELLS);
        normal[i][0] = sinf(turn), normal[i][2] = cosf(turn), cold[i] = 293;
        position[i][0] = radius * normal[i][0], position[i][1] = i % 2 ? 0.08f : -0.08f;
        position[i][2] = radius * (normal[i][2] - 1);
    }
    for (uint32_t k = 0; k < CELLS; k++) {
        memcpy(triangles[2 * k], (uint32_t[3]){2 * k, 2 * k + 2, 2 * k + 1}, sizeof *triangles);
        memcpy(triangles[2 * k + 1], (uint32_t[3]){2 * k + 2, 2 * k + 3, 2 * k + 1}, sizeof *triangles);
    }
    const SingeSurface surface = {.vertex_count = COUNT,
                                  .triangle_count = 2 * CELLS,
                                  .position = position,
                                  .normal = normal,
                                  .uv = uv,
                                  .rest_position = position,
                                  .temperature = cold,
                                  .temperature_peak = cold,
                                  .burn = nought,
                                  .burn_rate = nought,
                                  .sheet = sheet,
                                  .triangles = triangles};
    PreviewShape hot = {
        .kind = SINGE_COLLIDER_SPHERE, .position = {-0.09f, 0, 0.02f}, .radius = 0.025f, .temperature = 1300};
    PreviewDef def = at_night();
    def.camera = above().camera;
    def.camera.fov = 0.25f, def.samples = 64, def.ground_height = -INFINITY;
    def.shapes = &hot, def.shape_count = 1;
    see(&def, &surface, NULL, beauty);
    float profile[W] = {0};
    for (int x = 0; x < W; x++)
        for (int y = H / 2 - 8; y < H / 2 + 8; y++) profile[x] += beauty[y * W + x][0] / 16;
    float steepest = 0;
    for (int x = W / 4; x < W * 7 / 8; x++) steepest = fmaxf(steepest, 1 - profile[x + 1] / profile[x]);
    print_message("of the light %.3f is lost from pixel to pixel at most\n", (double)steepest);
    assert_true(profile[W / 4] > 1 && steepest < 0.18f); // was 0.20
}

/// The waves of a wooden floor break up what it mirrors: bends from pixel to pixel down the image of a ball, over its light.
/// The floor itself is black, and what it mirrors of an even sky is divided out.
TEST(waves_of_wood_break_its_reflections) {
    static float beauty[2][W * H][3];
    PreviewDef def = at_night();
    PreviewShape sphere = {
        .kind = SINGE_COLLIDER_SPHERE, .position = {0, 0, 0.08f}, .radius = 0.025f, .temperature = 1450};
    def.shapes = &sphere, def.shape_count = 1;
    def.camera = (PreviewCamera){.eye = {0, -0.5f, 0.1f}, .target = {0, 0, -0.08f}, .up = {0, 0, 1}, .fov = 0.3f};
    def.ground = PREVIEW_GROUND_WOOD, def.ground_gloss = 6;
    for (int c = 0; c < 3; c++) def.ground_colour[c] = 0;
    see(&def, &nothing, NULL, beauty[0]);
    for (int c = 0; c < 3; c++) def.sky_colour[c] = 1;
    def.shape_count = 0;
    see(&def, &nothing, NULL, beauty[1]);
    float bends = 0, sum = 0;
    for (int y = H / 2 - 16; y < H / 2 + 16; y++)
        for (int x = W / 2 - 12; x < W / 2 + 12; x++) {
            float share[3];
            for (int k = 0; k < 3; k++)
                share[k] = beauty[0][(y + k - 1) * W + x][0] / beauty[1][(y + k - 1) * W + x][0];
            bends += fabsf(share[0] - 2 * share[1] + share[2]), sum += share[1];
        }
    print_message("mirrored light bends by %.3f from pixel to pixel\n", (double)(bends / sum));
    assert_true(bends > 0.045f * sum); // was 0.018
}

/// Where a wall meets the floor the light does not jump from one pixel to the next: the steepest step in a column is at most
/// .56 of the way in focus, with the rim slanted, and .5 where a lens blurs it. One sample a pixel, which is enough where
/// nothing but a floor is seen, breaks both bars: .66 and .92.
TEST(a_wall_meets_the_floor_without_steps) {
    static float picture[W * H][3];
    PreviewDef def = at_night();
    def.camera = (PreviewCamera){.eye = {0, 0, 0.1f}, .target = {0, 0.3f, 0}, .up = {0.3f, 0, 1}, .fov = 0.3f};
    for (int c = 0; c < 3; c++) def.sun_colour[c] = 1, def.wall_colour[c] = def.ground_colour[c] = 0.3f;
    def.sun_direction[1] = -10, def.ground_gloss = 0, def.samples = 16;
    def.wall = PREVIEW_WALL_PLAIN, def.wall_distance = 0.3f;
    for (int blurred = 0; blurred < 2; blurred++) {
        def.camera.aperture = 0.02f * (float)blurred, def.camera.focus = 0.15f;
        see(&def, &nothing, NULL, picture);
        float sum = 0;
        for (int x = 0; x < W; x++) {
            float low = INFINITY, high = 0, steepest = 0;
            for (int y = H / 4; y < H * 3 / 4; y++) {
                const float here = picture[y * W + x][1];
                low = fminf(low, here), high = fmaxf(high, here);
                steepest = fmaxf(steepest, fabsf(here - picture[(y + 1) * W + x][1]));
            }
            sum += steepest / (high - low) / W;
        }
        print_message("wall and floor, blurred %d: %.2f of the way in a pixel\n", blurred, (double)sum);
        assert_true(sum < (blurred ? 0.5f : 0.56f));
    }
}

/// A wall behind the scene is lit by a flame, and a sheet before the flame shadows it: at most a fifth of the light is left,
/// with the sky's. It is in no picture that is taken from behind it.
TEST(a_wall_catches_light_and_shadows) {
    static float open[W * H][3], hidden[W * H][3], behind[W * H][3], none[W * H][3];
    float share = 0;
    PreviewDef def = at_night();
    ball_make(&ball, 0, -0.1f, 0.1f, 0.03f, 4e6f, 0);
    quad_make(&q, 0.12f, 0);
    for (int i = 0; i < 4; i++) { // it stands in the plane y = 0
        const float up = q.position[i][1];
        q.position[i][1] = 0, q.position[i][2] = 0.12f + up, q.normal[i][1] = -1, q.normal[i][2] = 0;
    }
    for (int c = 0; c < 3; c++) def.sky_colour[c] = 0, def.wall_colour[c] = 0.5f, def.ground_colour[c] = 0.05f;
    def.transmittances = &share, def.sheet_count = 1, def.wall = PREVIEW_WALL_PLAIN, def.wall_distance = 0.3f;
    def.camera = (PreviewCamera){.eye = {0, 0.02f, 0.1f}, .target = {0, 0.3f, 0.1f}, .up = {0.2f, 0, 1}, .fov = 1.2f};
    see(&def, &nothing, &ball.gas, open), see(&def, &q.surface, &ball.gas, hidden);
    const float lit = box(open, W / 2, H / 2), dark = box(hidden, W / 2, H / 2);
    print_message("wall: %.4f lit, %.4f in the shadow of a sheet\n", (double)lit, (double)dark);
    assert_true(lit > 0.001f && dark < 0.2f * lit);

    def.camera = (PreviewCamera){.eye = {0, 0.6f, 0.1f}, .target = {0, 0.3f, 0.1f}, .up = {0, 0, 1}, .fov = 1.2f};
    see(&def, &nothing, &ball.gas, behind);
    def.wall_distance = -INFINITY;
    see(&def, &nothing, &ball.gas, none);
    assert_memory_equal(behind, none, sizeof none);
}

/// A wall has no end: a sun behind it does not light what is before it, which one beside it does. It shone through.
TEST(a_wall_stops_the_sun_behind_it) {
    static float dark[W * H][3], picture[W * H][3];
    PreviewDef def = at_night();
    def.camera = (PreviewCamera){.eye = {0, -0.4f, 0.3f}, .target = {0, 0, 0}, .up = {0, 0, 1}, .fov = 0.6f};
    def.wall = PREVIEW_WALL_PLAIN, def.wall_distance = 0.3f;
    see(&def, &nothing, NULL, dark);
    float light[2];
    for (int before = 0; before < 2; before++) {
        for (int c = 0; c < 3; c++) def.sun_colour[c] = 1;
        def.sun_direction[0] = 0.5f, def.sun_direction[1] = before ? -1 : 1, def.sun_direction[2] = 0.8f;
        see(&def, &nothing, NULL, picture);
        light[before] = box(picture, W / 2, H / 2) - box(dark, W / 2, H / 2);
    }
    print_message("the sun lights the floor by %.4f behind the wall, %.4f before it\n", (double)light[0],
                  (double)light[1]);
    assert_true(light[1] > 0.02f && fabsf(light[0]) < 1e-3f * light[1]);
}

static void see_shadow(int samples, float (*beauty)[3]) {
    PreviewDef def = above();
    def.ground = PREVIEW_GROUND_PLAIN, def.samples = samples, def.sun_angle = 0.08f;
    def.sun_direction[0] = -1, def.sun_direction[1] = 0.2f, def.sun_direction[2] = 1;
    for (int c = 0; c < 3; c++) def.sky_colour[c] = 0, def.ground_colour[c] = 0.5f;
    quad_make(&q, 0.05f, 0.1f);
    see(&def, &q.surface, NULL, beauty);
}

/// The rim of a shadow is smooth: the default's sixteen samples, and four, differ from very many by less than 1 %
/// of the sun's light in the root mean square; one breaks that bar.
TEST(the_rim_of_a_shadow_is_smooth) {
    static float exact[W * H][3], picture[W * H][3];
    see_shadow(1024, exact);
    const int samples[] = {16, 4, 1};
    for (int few = 0; few < 3; few++) {
        see_shadow(samples[few], picture);
        float full = 0, squares = 0, largest = 0;
        int count = 0;
        for (int i = 0; i < W * H; i++) full = fmaxf(full, exact[i][1]);
        for (int y = 0; y < H; y++)
            for (int x = W / 2 + 12; x < W; x++) { // beside the sheet itself
                float value = exact[y * W + x][1] / full, wrong = fabsf(picture[y * W + x][1] / full - value);
                if (value < 0.2f || value > 0.97f) continue;
                squares += wrong * wrong, count++, largest = fmaxf(largest, wrong);
            }
        float rms = sqrtf(squares / (float)count);
        print_message("rim of a shadow, %d samples: %d pixels, rms %.3f, at most %.3f\n", samples[few], count,
                      (double)rms, (double)largest);
        assert_true(count > 60 && (rms < 0.01f) == (samples[few] > 1));
    }
}

/// Far from what burns, where neither sun nor sky can be hidden, a sheet still shadows flames: a picture of many samples has
/// no grain there. With one ray a pixel neighbours differ by 60 % in the root mean square; the lattice of which ray asks for
/// which lamp showed as dots.
TEST(the_shadow_of_a_flame_has_no_grain_in_a_still) {
    static float beauty[W * H][3];
    PreviewDef def = at_night();
    def.samples = 64;
    for (int c = 0; c < 3; c++) def.sky_colour[c] = 0;
    def.camera = (PreviewCamera){.eye = {0.55f, 0, 0.4f}, .target = {0.55f, 0, 0}, .up = {0, 1, 0}, .fov = 0.4f};
    ball_make(&ball, -0.25f, 0, 0.15f, 0.1f, 4e6f, 0);
    wall_make(&q);
    for (int i = 0; i < 4; i++) {
        q.position[i][1] *= 0.1f;
        q.position[i][2] *= 0.5f;
    }
    see(&def, &q.surface, &ball.gas, beauty);

    float squares = 0, sum = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x + 1 < W; x++) {
            const float differs = beauty[y * W + x][1] - beauty[y * W + x + 1][1];
            squares += differs * differs;
            sum += beauty[y * W + x][1];
        }
    const float mean = sum / (W * H), grain = sqrtf(squares / (W * H)) / mean;
    print_message("shadow of a flame, 64 samples: mean %.4f, grain %.1f %%\n", (double)mean, 100 * (double)grain);
    assert_true(mean > 0.001f && grain < 0.015f);
}

/// Two quads of two sheets.
typedef struct Pair {
    float position[8][3], normal[8][3], uv[8][2], rest[8][3], temperature[8], peak[8], burn[8], rate[8];
    int32_t sheet[8];
    uint32_t triangles[4][3];
} Pair;

static void pair_set(Pair *pair, int which, const Float4 *quad) {
    for (int i = 0, v = 4 * which; i < 4; i++, v++) {
        memcpy(pair->position[v], quad->position[i], sizeof pair->position[v]);
        memcpy(pair->normal[v], quad->normal[i], sizeof pair->normal[v]);
        memcpy(pair->uv[v], quad->uv[i], sizeof pair->uv[v]),
            memcpy(pair->rest[v], quad->rest[i], sizeof pair->rest[v]);
        pair->temperature[v] = pair->peak[v] = 293, pair->sheet[v] = which;
    }
    for (int t = 0; t < 2; t++)
        for (int c = 0; c < 3; c++) pair->triangles[2 * which + t][c] = quad->triangles[t][c] + 4 * (uint32_t)which;
}

/// The edge of paper before what is dark is straight where a wide lamp is half hidden: a pixel of several faces took the
/// shadow from its own few rays, and the edge had teeth. Pixels, by which the edge leaves the line of its neighbours, the root
/// mean square, by how much light rows of pixels have across the edge; paper that has no shadow tells what is due to
/// the samples of the edge itself. In a video, too, before a sheet that lies in its shadow: pixels took all of their shadow
/// from one of the two.
TEST(the_edge_of_lit_paper_has_no_teeth) {
    static float beauty[W * H][3];
    static Pair pair;
    enum { ALONE, SHADOWED, BEFORE, CASES };
    static const char *const names[CASES] = {"lit", "half in shadow", "before a sheet"};
    float teeth[CASES];
    for (int kind = ALONE; kind < CASES; kind++) {
        PreviewDef def = above();
        def.samples = kind == BEFORE ? 16 : 64;
        def.lamp_radius = 0.05f;
        const float lamp[3] = {0.3f, 0, 0.35f};
        memcpy(def.lamp_position, lamp, sizeof lamp);
        for (int c = 0; c < 3; c++) {
            def.sun_colour[c] = def.sky_colour[c] = def.ground_colour[c] = def.background[c] = 0;
            def.lamp_colour[c] = 0.2f;
        }
        quad_make(&q, 0.06f, 0.05f);
        for (int i = 0; i < 4; i++) q.position[i][0] += 0.04f * q.position[i][1]; // its edge crosses pixels
        pair_set(&pair, 0, &q);
        quad_make(&q, kind == BEFORE ? 0.15f : 0.03f, kind == BEFORE ? 0.01f : 0.2f);
        for (int i = 0; i < 4; i++) q.position[i][0] += (float[]){[ALONE] = 5, [SHADOWED] = 0.2f, [BEFORE] = 0}[kind];
        pair_set(&pair, 1, &q);
        const SingeSurface surface = SURFACE_OF(&pair, rest, peak, 8, 4);
        see(&def, &surface, NULL, beauty);

        enum { FIRST = H / 2 - 8, ROWS = 17 };
        const int edge = kind == BEFORE ? 36 : 60; // within 5 pixels; the lamp is on the right
        float row[ROWS] = {0}, squares = 0, paper = 0;
        for (int y = 0; y < ROWS; y++) {
            for (int x = edge - 5; x < edge + 5; x++) row[y] += beauty[(FIRST + y) * W + x][1];
            paper += beauty[(FIRST + y) * W + edge + (kind == BEFORE ? 5 : -5)][1] / ROWS;
        }
        for (int y = 1; y + 1 < ROWS; y++) {
            const float bent = (row[y - 1] - 2 * row[y] + row[y + 1]) / paper;
            squares += bent * bent / (ROWS - 2);
        }
        teeth[kind] = sqrtf(squares);
        print_message("edge of paper, %s: paper %.3f, teeth of %.3f pixels\n", names[kind], (double)paper,
                      (double)teeth[kind]);
    }
    assert_true(teeth[ALONE] < 0.06f && teeth[SHADOWED] < 0.12f); // 0.28 by rays of its own
    assert_true(teeth[BEFORE] < 0.1f);
}

/// Water darkens a sheet, a coloured one more, and what paper holds in a room does not. Bars: damp 5 %, soaked another
/// 10 %; without the water there is no difference.
TEST(wet_sheets_are_darker) {
    static float picture[W * H][3];
    PreviewDef def = above();
    float colour[2][3] = {{1, 1, 1}, {0.1f, 0.3f, 0.6f}}, water[4], light[2][4];
    quad_make(&q, 0.12f, 0);
    def.sheet_count = 1;
    q.surface.water = water;
    for (int k = 0; k < 2; k++) {
        def.colours = (const float(*)[3]) & colour[k];
        for (int step = 0; step < 4; step++) { // as it was before, air-dry, damp, soaked
            for (int i = 0; i < 4; i++) water[i] = step == 1 ? 0.07f : step == 2 ? 0.45f : 1.5f;
            q.surface.wet = step > 0;
            see(&def, &q.surface, NULL, picture);
            light[k][step] = box(picture, W / 2 + 16, H / 2);
        }
        print_message("dry %.3f, air-dry %.3f, damp %.3f, soaked %.3f\n", (double)light[k][0], (double)light[k][1],
                      (double)light[k][2], (double)light[k][3]);
        assert_true(light[k][1] == light[k][0]);
        assert_true(light[k][2] < 0.95f * light[k][0] && light[k][3] < 0.9f * light[k][2]);
        assert_true(light[k][3] > 0.3f * light[k][0]);
    }
    assert_true(light[1][3] / light[1][0] < light[0][3] / light[0][0]); // colours deepen
}

TEST(bad_transmittance_is_refused) {
    const float bad[] = {-0.1f, 1.1f, NAN};
    for (int k = 0; k < 3; k++) {
        PreviewDef def = above();
        Preview *preview = NULL;
        SingeError error;
        def.transmittances = &bad[k], def.sheet_count = 1;
        assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, &error), SINGE_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "transmittance"));
    }
}

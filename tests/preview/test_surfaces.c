// What shapes are made of: wood, metal and cloth.

#include "fixture.h"

// what a case works on
static uint8_t rgb[BYTES];

static const PreviewSurface SURFACES[4] = {PREVIEW_SURFACE_MATT, PREVIEW_SURFACE_WOOD, PREVIEW_SURFACE_METAL,
                                           PREVIEW_SURFACE_CLOTH};

/// A box of 12 x 6 x 8 cm seen from aslant, without a ground, `aside` from the origin as its camera is.
static PreviewDef box_make(PreviewSurface surface, float aside, PreviewShape *box) {
    *box = (PreviewShape){.kind = SINGE_COLLIDER_BOX,
                          .position = {aside, -aside, 0.5f * aside},
                          .rotation = {0, 0, 0, 1},
                          .half_size = {0.06f, 0.03f, 0.04f},
                          .surface = surface,
                          .colour = {0.4f, 0.4f, 0.4f},
                          .temperature = 293};
    PreviewDef def = small();
    def.camera = (PreviewCamera){.eye = {aside + 0.05f, -aside - 0.3f, 0.5f * aside + 0.12f},
                                 .target = {aside, -aside, 0.5f * aside},
                                 .up = {0, 0, 1},
                                 .fov = 0.3f};
    def.ground_height = -INFINITY;
    def.shapes = box, def.shape_count = 1;
    return def;
}

/// The front of the box in a picture: the means of its channels, and the standard deviation of green over its mean.
typedef struct Front {
    float mean[3], varies;
} Front;

static Front front_of(const uint8_t *picture) {
    Front front = {.varies = 0};
    float squares = 0;
    enum { ACROSS = 40, DOWN = 16, COUNT = ACROSS * DOWN };
    for (int i = 0; i < COUNT; i++) {
        const uint8_t *p = pixel(picture, W / 2 - ACROSS / 2 + i % ACROSS, H / 2 + i / ACROSS);
        for (int c = 0; c < 3; c++) front.mean[c] += (float)p[c] / COUNT;
        squares += (float)p[1] * (float)p[1] / COUNT;
    }
    front.varies = sqrtf(fmaxf(squares - front.mean[1] * front.mean[1], 0)) / front.mean[1];
    return front;
}

/// Each surface has a pattern, which moves with its shape. The largest change is in thousandths of a metre's rounding.
TEST(patterns_stay_on_their_shape) {
    static uint8_t here[BYTES], there[BYTES];
    PreviewShape box;
    for (int k = 0; k < 4; k++) {
        PreviewDef def = box_make(SURFACES[k], 0, &box);
        draw(&def, &nothing, 0, here);
        def = box_make(SURFACES[k], 0.25f, &box);
        draw(&def, &nothing, 0, there);
        float change = 0;
        for (int i = 0; i < BYTES; i++) change += fabsf((float)here[i] - (float)there[i]) / BYTES;
        const Front front = front_of(here);
        print_message("surface %d varies by %.3f; moved by %.2f\n", k, (double)front.varies, (double)change);
        assert_true(change < 0.3f);
        assert_true((front.varies > 0.02f) == (SURFACES[k] != PREVIEW_SURFACE_MATT));
    }
}

/// Metal mirrors the flame before it; what is matt is lit by it all over.
TEST(metal_mirrors_a_flame) {
    static float beauty[W * H][3];
    static Ball ball;
    PreviewShape box;
    float share[2];
    for (int k = 0; k < 2; k++) {
        PreviewDef def = box_make(k ? PREVIEW_SURFACE_METAL : PREVIEW_SURFACE_MATT, 0, &box);
        for (int c = 0; c < 3; c++) def.sun_colour[c] = def.sky_colour[c] = 0;
        ball_make(&ball, 0, -0.12f, -0.07f, 0.02f, 4e6f, 0); // below what the camera sees
        PreviewLayers layers = {.beauty = beauty};
        draw_layers(&def, &nothing, &ball.gas, 0.3, &layers);

        float sum = 0, most = 0, count = 0;
        for (int y = H / 2 - 4; y < H / 2 + 20; y++)
            for (int x = W / 2 - 24; x < W / 2 + 24; x++, count++) {
                const float green = beauty[y * W + x][1];
                sum += green, most = fmaxf(most, green);
            }
        share[k] = most * count / sum;
    }
    print_message("brightest over mean: matt %.2f, metal %.2f\n", (double)share[0], (double)share[1]);
    assert_true(share[1] > 2 * share[0]);

    // other rays see the same: they were too few, and a flame's image blotchy
    static float again[W * H][3];
    PreviewDef def = box_make(PREVIEW_SURFACE_METAL, 0, &box);
    for (int c = 0; c < 3; c++) def.sun_colour[c] = def.sky_colour[c] = 0;
    def.seed++;
    draw_layers(&def, &nothing, &ball.gas, 0.3, &(PreviewLayers){.beauty = again});
    float differs = 0, sum = 0;
    for (int y = H / 2 - 4; y < H / 2 + 20; y++)
        for (int x = W / 2 - 24; x < W / 2 + 24; x++)
            differs += fabsf(again[y * W + x][1] - beauty[y * W + x][1]), sum += beauty[y * W + x][1];
    print_message("what metal mirrors differs by %.3f with other rays\n", (double)(differs / sum));
    assert_true(differs < 0.12f * sum); // was 0.23
}

/// Steel that a fire has heated wears straw at 235 C and blue at 300 C.
TEST(heated_metal_wears_temper_colours) {
    static const float kelvin[3] = {293, 505, 576};
    PreviewShape box;
    float blue[3];
    for (int k = 0; k < 3; k++) {
        PreviewDef def = box_make(PREVIEW_SURFACE_METAL, 0, &box);
        box.temperature = kelvin[k];
        draw(&def, &nothing, 0, rgb);
        const Front front = front_of(rgb);
        blue[k] = front.mean[2] / front.mean[0];
    }
    print_message("blue over red: cold %.2f, straw %.2f, blue %.2f\n", (double)blue[0], (double)blue[1],
                  (double)blue[2]);
    assert_true(blue[1] < 0.85f * blue[0] && blue[2] > 1.2f * blue[0]);
}

/// How alike the fine lines of a table's wood are at places 7 mm apart along them: they end, as pores do, and rings are not
/// straight. Fibres that went on and on looked like a picture that the camera's motion had smeared.
TEST(wood_is_not_smeared_along_its_grain) {
    enum { PLACES = 6, APART = 24, ACROSS = 3 };
    float both = 0, square = 0;
    for (int k = 0; k < PLACES; k++) {
        PreviewDef def = above();
        def.camera.eye[0] = def.camera.target[0] = 0.23f * (float)k, def.camera.eye[1] = def.camera.target[1] = 0.06f;
        def.camera.eye[2] = 0.12f, def.camera.fov = 0.15f;
        draw(&def, &nothing, 0, rgb);
        for (int y = ACROSS; y < H - ACROSS; y++)
            for (int x = 0; x < W - APART; x++) {
                float line[2];
                for (int i = 0; i < 2; i++)
                    line[i] = (float)pixel(rgb, x + i * APART, y)[1] -
                              0.5f * (float)(pixel(rgb, x + i * APART, y - ACROSS)[1] +
                                             pixel(rgb, x + i * APART, y + ACROSS)[1]);
                both += line[0] * line[1], square += 0.5f * (line[0] * line[0] + line[1] * line[1]);
            }
    }
    print_message("lines of wood are alike by %.3f\n", (double)(both / square));
    assert_true(both / square < 0.3f); // was 0.58
}

/// Paper that is bent to a radius of some millimetres has creased: its shade changes along the fold too, where it was as even as
/// a tube's. Paper that curls does not.
TEST(paper_that_is_crumpled_has_creases) {
    static Float4 q;
    float changes[2];
    for (int k = 0; k < 2; k++) {
        PreviewDef def = above();
        def.camera.fov = 0.08f, def.samples = 16;
        quad_make(&q, 0.02f, 0);
        for (int i = 0; i < 4; i++) { // about y; the radius is told by the rest
            q.normal[i][0] = q.position[i][0] > 0 ? 0.6f : -0.6f, q.normal[i][2] = 0.8f;
            q.rest[i][0] *= k ? 0.1f : 1;
        }
        draw(&def, &q.surface, 0, rgb);
        changes[k] = 0;
        for (int x = W / 4; x < W * 3 / 4; x++) {
            float sum = 0, square = 0;
            for (int y = 0; y < H; y++) {
                const float here = (float)pixel(rgb, x, y)[1];
                sum += here / H, square += here * here / H;
            }
            changes[k] += sqrtf(fmaxf(square - sum * sum, 0)) / (W / 2);
        }
    }
    print_message("a bend's shade changes by %.2f levels, a fold's by %.2f\n", (double)changes[0], (double)changes[1]);
    assert_true(changes[0] < 1.2f && changes[1] > 2);
}

/// Crumpled paper is flat between ridges: of how its shade changes from pixel to pixel most lies on few of them. Smooth
/// waves of the same height are cloth.
TEST(crumpled_paper_has_flat_facets) {
    enum { SIDE = 41, CELLS = (SIDE - 1) * (SIDE - 1), EDGE = 12, CHANGES = (W - 2 * EDGE) * (H - 2 * EDGE) };
    static float position[SIDE * SIDE][3], normal[SIDE * SIDE][3], zero[SIDE * SIDE][2], change[CHANGES];
    static uint32_t triangles[2 * CELLS][3];
    static int32_t sheet[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float x = 0.001f * (float)(i % SIDE - SIDE / 2), y = 0.001f * (float)(i / SIDE - SIDE / 2);
        const float turn = 0.5f * sinf(300 * x + 90 * y);
        position[i][0] = x, position[i][1] = y, position[i][2] = 0.02f;
        normal[i][0] = sinf(turn), normal[i][2] = cosf(turn);
    }
    for (uint32_t k = 0; k < CELLS; k++) {
        const uint32_t v = k % (SIDE - 1) + k / (SIDE - 1) * SIDE;
        memcpy(triangles[2 * k], (uint32_t[3]){v, v + 1, v + SIDE}, sizeof *triangles);
        memcpy(triangles[2 * k + 1], (uint32_t[3]){v + 1, v + SIDE + 1, v + SIDE}, sizeof *triangles);
    }
    static float cold[SIDE * SIDE], nought[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) cold[i] = 293;
    const SingeSurface surface = {.vertex_count = SIDE * SIDE,
                                  .triangle_count = 2 * CELLS,
                                  .position = position,
                                  .normal = normal,
                                  .uv = zero,
                                  .rest_position = position,
                                  .temperature = cold,
                                  .temperature_peak = cold,
                                  .burn = nought,
                                  .burn_rate = nought,
                                  .sheet = sheet,
                                  .triangles = triangles};
    PreviewDef def = above();
    def.camera.fov = 0.06f, def.samples = 16;
    def.sun_direction[0] = 1, def.ground_height = -INFINITY;
    draw(&def, &surface, 0, rgb);
    float all = 0, most = 0;
    for (int y = EDGE, i = 0; y < H - EDGE; y++)
        for (int x = EDGE; x < W - EDGE; x++, i++) {
            const float here = (float)pixel(rgb, x, y)[1];
            change[i] = fabsf((float)pixel(rgb, x + 1, y)[1] - here) + fabsf((float)pixel(rgb, x, y + 1)[1] - here);
            all += change[i];
        }
    float even = 0;
    for (int i = 0; i < CHANGES; i++) even += change[i] <= 0.5f * all / CHANGES, most = fmaxf(most, change[i]);
    print_message("of crumpled paper %.2f changes little, by %.2f in the mean, %.0f at most\n",
                  (double)(even / CHANGES), (double)(all / CHANGES), (double)most);
    assert_true(even > 0.4f * CHANGES); // .34
}

/// Honed stone draws a flame out towards the eye, in one piece: how far down from the brightest row of what it mirrors
/// there is more than a third of that, in pixels.
TEST(stone_draws_a_flame_out) {
    static float dull[W * H][3], gloss[W * H][3];
    static Ball ball;
    PreviewDef def = small();
    def.camera = (PreviewCamera){.eye = {0, -0.6f, 0.25f}, .target = {0, 0, 0}, .up = {0, 0, 1}, .fov = 0.5f};
    def.ground = PREVIEW_GROUND_STONE;
    for (int c = 0; c < 3; c++) def.sun_colour[c] = def.sky_colour[c] = 0;
    ball_make(&ball, 0, 0, 0.05f, 0.015f, 4e6f, 0);
    for (int k = 0; k < 2; k++) {
        PreviewLayers layers = {.beauty = k ? gloss : dull};
        def.ground_gloss = k ? 2 : 0;
        draw_layers(&def, &nothing, &ball.gas, 0.3, &layers);
    }
    float rows[H] = {0}, most = 0;
    int long_as = 0;
    for (int i = 0; i < W * H; i++) rows[i / W] += gloss[i][1] - dull[i][1];
    for (int y = 0; y < H; y++) most = fmaxf(most, rows[y]);
    for (int y = 0; y < H; y++) long_as += rows[y] > most / 3;
    print_message("the mirrored flame is %d rows long, %.3f in the brightest\n", long_as, (double)most);
    assert_true(most > 0 && long_as > 17); // 15
}

/// Stone has scale: joints between its slabs are the darkest lines in it, and its tone changes over decimetres. It was noise of
/// centimetres.
TEST(stone_has_joints_and_large_tones) {
    enum { PLACES = 6, BOX = 16 };
    float darkest = 1, sum = 0, squares = 0, count = 0;
    for (int k = 0; k < PLACES; k++) {
        PreviewDef def = above();
        def.ground = PREVIEW_GROUND_STONE, def.ground_gloss = 0;
        def.camera.eye[0] = def.camera.target[0] = 0.27f * (float)k, def.camera.fov = 0.4f;
        draw(&def, &nothing, 0, rgb);
        const float whole = mean(rgb, 1);
        for (int y = 0; y < H; y += BOX)
            for (int x = 0; x < W; x += BOX, count++) {
                float box = 0;
                for (int i = 0; i < BOX * BOX; i++) {
                    const float green = pixel(rgb, x + i % BOX, y + i / BOX)[1];
                    darkest = fminf(darkest, green / whole);
                    box += green / (BOX * BOX);
                }
                sum += box, squares += box * box;
            }
    }
    const float average = sum / count, varies = sqrtf(squares / count - average * average) / average;
    print_message("stone: darkest %.2f of its mean, varies by %.3f over decimetres\n", (double)darkest, (double)varies);
    assert_true(darkest < 0.45f && varies > 0.05f);
}

/// A table far out of focus changes little from pixel to pixel. Its few samples, others in each pixel, left it speckled.
TEST(a_table_out_of_focus_is_smooth) {
    PreviewDef def = above();
    def.camera.eye[1] = def.camera.target[1] = 0.118f, def.camera.fov = 0.15f; // a joint
    def.camera.aperture = 0.01f, def.camera.focus = 0.25f;
    draw(&def, &nothing, 0, rgb);
    float change = 0;
    for (int y = 0; y + 2 < H; y++)
        for (int x = 0; x < W; x++)
            change += fabsf((float)pixel(rgb, x, y)[1] - 2 * (float)pixel(rgb, x, y + 1)[1] +
                            (float)pixel(rgb, x, y + 2)[1]) /
                      (W * H);
    print_message("changes by %.3f levels\n", (double)change);
    assert_true(change < 2);
}

/// A ball of 1300 K glows under a few flakes of scale: how much its green differs three pixels apart, and the share of its
/// inner face that is darker than four fifths of the mean. It was a mosaic of scale and cracks. Its middle is pale, its limb
/// orange: blue over red. It was a disc of one orange.
TEST(a_glowing_ball_wears_a_little_scale) {
    PreviewShape ball = {.kind = SINGE_COLLIDER_SPHERE, .rotation = {0, 0, 0, 1}, .radius = 0.02f, .temperature = 1300};
    PreviewDef def = above();
    def.camera.fov = 0.09f, def.samples = 16;
    def.shapes = &ball, def.shape_count = 1;
    draw(&def, &nothing, 0, rgb);
    float sum = 0, change = 0, dark = 0, count = 0;
    for (int y = H / 2 - 18; y < H / 2 + 18; y++)
        for (int x = W / 2 - 18; x < W / 2 + 18; x++, count++) {
            const float green = (float)pixel(rgb, x, y)[1];
            sum += green, change += fabsf((float)pixel(rgb, x + 3, y)[1] - green);
        }
    for (int y = H / 2 - 18; y < H / 2 + 18; y++)
        for (int x = W / 2 - 18; x < W / 2 + 18; x++) dark += (float)pixel(rgb, x, y)[1] < 0.8f * sum / count;
    const float mean = sum / count;
    change /= sum, dark /= count;
    float middle[2] = {0, 0}, limb[2] = {0, 0}; // red and blue
    for (int k = 0; k < 2; k++)
        for (int x = -4; x < 4; x++)
            middle[k] += (float)pixel(rgb, W / 2 + x, H / 2)[2 * k],
                limb[k] += (float)pixel(rgb, W / 2 + x, H / 2 - 26)[2 * k];
    const float pale = middle[1] / middle[0], red = limb[1] / limb[0];
    // air that rises cools its lower half
    float half[2] = {0, 0};
    def.camera = (PreviewCamera){.eye = {0, -0.5f, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}, .fov = 0.09f};
    draw(&def, &nothing, 0, rgb);
    for (int y = H / 2 - 20; y < H / 2 + 20; y++)
        for (int x = W / 2 - 18; x < W / 2 + 18; x++) half[y >= H / 2] += (float)pixel(rgb, x, y)[1];
    print_message(
        "a glowing ball of %.0f changes by %.3f, %.3f dark; upper half over lower %.2f; blue %.2f, at its limb %.2f\n",
        (double)mean, (double)change, (double)dark, (double)(half[0] / half[1]), (double)pale, (double)red);
    assert_true(change < 0.1f && dark > 0.02f && dark < 0.2f && half[0] > 1.3f * half[1]);
    assert_true(pale > 0.55f && red < 0.3f); // was 0.48, 0.24
}

/// Mortar is lighter than bricks: rows of pixels along a joint, over those along the middles of bricks. It was a dark line.
TEST(mortar_is_lighter_than_bricks) {
    PreviewDef def = small();
    def.camera = (PreviewCamera){.eye = {0, 0, 0.45f}, .target = {0, 1, 0.45f}, .up = {0, 0, 1}, .fov = 0.3f};
    def.wall = PREVIEW_WALL_BRICK, def.wall_distance = 0.4f;
    draw(&def, &nothing, 0, rgb);
    const int half = (int)(0.0375f / 0.4f / (2 * tanf(0.15f)) * H); // of a brick's height, in pixels
    float row[2] = {0, 0};
    for (int x = 0; x < W; x++)
        for (int k = -1; k < 1; k++) {
            row[0] += pixel(rgb, x, H / 2 + k)[1];
            row[1] += 0.5f * (float)(pixel(rgb, x, H / 2 - half + k)[1] + pixel(rgb, x, H / 2 + half + k)[1]);
        }
    print_message("mortar over bricks: %.2f\n", (double)(row[0] / row[1]));
    assert_true(row[0] > 1.15f * row[1]);
}

/// Grazing light shows no axes in plaster: how much more of its changes goes along two lines at right angles than along those
/// between them. The squares of its noise's lattice were seen as blocks.
TEST(plaster_is_not_in_blocks) {
    enum { PLACES = 32 };
    float axes[2] = {0, 0}, all = 0;
    for (int k = 0; k < PLACES; k++) {
        PreviewDef def = small();
        const float at = 0.3f * (float)k;
        def.camera = (PreviewCamera){.eye = {at, 0, 0.45f}, .target = {at, 1, 0.45f}, .up = {0, 0, 1}, .fov = 0.1f};
        def.wall = PREVIEW_WALL_PLASTER, def.wall_distance = 0.4f, def.samples = 4;
        // along an axis and between two by turns: light itself has a direction
        def.sun_direction[0] = k % 2 ? 0.7f : 1, def.sun_direction[1] = -0.2f, def.sun_direction[2] = k % 2 ? 0.7f : 0;
        memset(def.sky_colour, 0, sizeof def.sky_colour);
        draw(&def, &nothing, 0, rgb);
        for (int y = 1; y + 1 < H; y++)
            for (int x = 1; x + 1 < W; x++) {
                const float g = (float)pixel(rgb, x + 1, y)[1] - (float)pixel(rgb, x - 1, y)[1];
                const float h = (float)pixel(rgb, x, y + 1)[1] - (float)pixel(rgb, x, y - 1)[1];
                const float square = g * g + h * h, angle = 4 * atan2f(h, g);
                axes[0] += square * cosf(angle), axes[1] += square * sinf(angle), all += square;
            }
    }
    const float most = hypotf(axes[0], axes[1]) / all;
    print_message("plaster: %.3f along its axes\n", (double)most);
    assert_true(most < 0.15f); // was 0.32
}

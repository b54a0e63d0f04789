// Woven cloth: threads that are seen from near, and what a fire leaves of them.

#include "fixture.h"
#include "synthetic.h"

// what a case works on
static uint8_t rgb[BYTES];
static Float4 q;

static const uint32_t QUAD[4] = {0, 1, 2, 3};

/// Root mean square over the picture's middle of what changes from pixel to pixel along rows, of 255. The sheet leans
/// by that angle.
static float grain(float weave, float lean) {
    quad_make(&q, lean > 0 ? 0.25f : 0.1f, 0.01f);
    for (int i = 0; i < 4 && lean > 0; i++) {
        q.position[i][2] = sinf(lean) * q.position[i][0], q.position[i][0] *= cosf(lean);
        q.normal[i][0] = -sinf(lean), q.normal[i][2] = cosf(lean);
    }
    const PreviewLook look = {.weave = weave};
    const PreviewStart start = {4, 1, q.position[0], QUAD, q.uv[0], NULL};
    PreviewDef def = above();
    def.looks = &look, def.starts = &start, def.sheet_count = 1, def.ground_height = -INFINITY;
    draw(&def, &q.surface, 0, rgb);

    enum { HALF = 10 };
    float sum = 0;
    for (int y = H / 2 - HALF; y < H / 2 + HALF; y++)
        for (int x = W / 2 - HALF; x < W / 2 + HALF; x++) {
            const float step = (float)pixel(rgb, x + 1, y)[1] - (float)pixel(rgb, x, y)[1];
            sum += step * step;
        }
    return sqrtf(sum) / (2 * HALF);
}

/// A pixel is 5.8 mm wide here: it resolves threads of 40 mm, and none of 5 mm or less, which must not make patterns.
TEST(threads_are_seen_from_near_alone) {
    const float paper = grain(0, 0), near = grain(0.04f, 0), far = grain(0.005f, 0), farther = grain(0.0011f, 0);
    const float aslant = grain(0.014f, 1.05f), aslant_paper = grain(0, 1.05f);
    print_message("rms from pixel to pixel: paper %.2f, threads of 40 mm %.2f, 5 mm %.2f, 1.1 mm %.2f\n", (double)paper,
                  (double)near, (double)far, (double)farther);
    assert_true(near > 3 * paper);
    assert_true(far < paper + 1 && farther < paper + 1);

    // and those of 14 mm only where the sheet faces the eye
    print_message("aslant: paper %.2f, threads of 14 mm %.2f\n", (double)aslant_paper, (double)aslant);
    assert_true(aslant < aslant_paper + 1);
}

/// Whole cloth of threads of 0.4 mm in pixels of 0.9 mm, that leans to the right by that angle (rad) under a low sun, into
/// rgb. `tone`: of its dye.
static void draw_whole(float weave, float lean, uint8_t tone) {
    uint8_t texel[3] = {tone, tone, tone};
    const Image image = {.width = 1, .height = 1, .rgb = texel}, *pictures[1] = {&image};
    quad_make(&q, 0.12f, 0);
    for (int i = 0; i < 4; i++) {
        q.position[i][2] = sinf(lean) * q.position[i][0], q.position[i][0] *= cosf(lean);
        q.normal[i][0] = -sinf(lean), q.normal[i][2] = cosf(lean);
    }
    const PreviewLook look = {.weave = weave};
    const PreviewStart start = {4, 1, q.position[0], QUAD, q.uv[0], NULL};
    PreviewDef def = above();
    def.camera.fov = 0.12f;
    def.sun_direction[0] = -1, def.sun_direction[1] = 0.5f, def.sun_direction[2] = 0.5f;
    def.looks = &look, def.starts = &start, def.sheet_count = 1, def.ground_height = -INFINITY, def.pictures = pictures;
    draw(&def, &q.surface, 0, rgb);
}

/// How much its light varies over 8 pixels along a row, over the mean; *step: the largest change from pixel to pixel, of 255.
static float crease(float weave, float lean, int *step) {
    draw_whole(weave, lean, 200);
    float squares = 0, sum = 0;
    *step = 0;
    for (int y = 8; y < H - 8; y++)
        for (int x = W / 2 - 20; x < W / 2 + 12; x++) {
            const int here = pixel(rgb, x, y)[1], beside = abs(pixel(rgb, x + 1, y)[1] - here);
            const float far = (float)(pixel(rgb, x + 8, y)[1] - here);
            squares += far * far, sum += (float)here, *step = beside > *step ? beside : *step;
        }
    return sqrtf(squares * (float)((H - 16) * 32)) / sum;
}

/// Cloth has creases where paper lies flat, and they are soft.
TEST(whole_cloth_has_soft_creases) {
    int paper_step, flat_step, aslant_step;
    const float paper = crease(0, 0, &paper_step), flat = crease(4e-4f, 0, &flat_step),
                aslant = crease(4e-4f, 1.2f, &aslant_step);
    print_message("light varies by %.3f on paper, %.3f on cloth, %.3f aslant; steps %d, %d, %d\n", (double)paper,
                  (double)flat, (double)aslant, paper_step, flat_step, aslant_step);
    assert_true(flat > 3 * paper && aslant > 2 * paper);
    assert_true(flat <
                0.035f); // 0.050: what lies flat had slopes as of what hangs, blotches in the light of a low fire
    assert_true(flat_step < 14 && aslant_step < 14);
}

/// The light of dark cloth's middle.
static float fuzz(float weave, float lean) {
    draw_whole(weave, lean, 40);
    float sum = 0;
    for (int y = H / 2 - 12; y < H / 2 + 12; y++)
        for (int x = W / 2 - 6; x < W / 2 + 6; x++) sum += (float)pixel(rgb, x, y)[1];
    return sum / (24 * 12);
}

/// Where cloth turns away from the eye its fibres are seen, which are paler than its dye.
TEST(fibres_pale_what_turns_away) {
    const float front = fuzz(4e-4f, 0) / fuzz(0, 0), side = fuzz(4e-4f, 1.25f) / fuzz(0, 1.25f);
    print_message("dark cloth over paper: %.2f seen from the front, %.2f from the side\n", (double)front, (double)side);
    assert_true(front > 0.7f && front < 1.2f && side > 1.3f * front);
}

/// How much brighter the right half of char is than its left, of 255, where the sheet's picture had that tone.
static float right_of_char(float weave, uint8_t tone) {
    uint8_t texels[2 * 1 * 3] = {255, 255, 255, tone, tone, tone};
    const Image image = {.width = 2, .height = 1, .rgb = texels}, *pictures[1] = {&image};
    quad_make(&q, 0.1f, 0.01f);
    for (int i = 0; i < 4; i++) q.burn[i] = 0.6f, q.peak[i] = 900;
    const PreviewLook look = {.weave = weave};
    const PreviewStart start = {4, 1, q.position[0], QUAD, q.uv[0], NULL};
    PreviewDef def = above();
    def.looks = &look, def.starts = &start, def.sheet_count = 1, def.pictures = pictures;
    draw(&def, &q.surface, 0, rgb);

    float difference = 0;
    for (int y = H / 2 - 10; y < H / 2 + 10; y++)
        for (int x = 10; x < 16; x++)
            difference += (float)pixel(rgb, W / 2 + x, y)[1] - (float)pixel(rgb, W / 2 - x, y)[1];
    return difference / (20 * 6);
}

/// How much brighter what was dark in a sheet's picture is once the sheet is char.
static float print_on_char(float weave) { return right_of_char(weave, 10) - right_of_char(weave, 255); }

/// Ink stays readable on the char of paper; dye does not on that of cloth.
TEST(dye_burns_with_its_threads) {
    const float ink = print_on_char(0), dye = print_on_char(5e-4f);
    print_message("on char, print is brighter by %.1f on paper, %.1f on cloth\n", (double)ink, (double)dye);
    assert_true(ink > 15 && fabsf(dye) < 0.3f * ink);
}

/// Char of cloth whose threads of 0.4 mm no pixel of 0.9 mm resolves keeps relief and tones of its bundles: how much its light
/// varies over 4 pixels along a row, over the mean.
TEST(char_of_cloth_shows_its_bundles) {
    quad_make(&q, 0.12f, 0);
    for (int i = 0; i < 4; i++) q.burn[i] = 0.5f, q.peak[i] = 900;
    const PreviewLook look = {.weave = 4e-4f};
    const PreviewStart start = {4, 1, q.position[0], QUAD, q.uv[0], NULL};
    PreviewDef def = above();
    def.camera.fov = 0.12f;
    def.looks = &look, def.starts = &start, def.sheet_count = 1, def.ground_height = -INFINITY;
    draw(&def, &q.surface, 30, rgb);
    float steps = 0, sum = 0;
    for (int y = 8; y < H - 8; y++)
        for (int x = 8; x < W - 8; x++) {
            const float step = (float)pixel(rgb, x + 4, y)[1] - (float)pixel(rgb, x, y)[1];
            steps += step * step, sum += (float)pixel(rgb, x, y)[1];
        }
    const float count = (float)((W - 16) * (H - 16)), varies = sqrtf(steps * count) / sum;
    print_message("char of cloth is %.1f, and varies by %.2f of it\n", (double)(sum / count), (double)varies);
    assert_true(varies > 0.28f); // 0.23: flat
}

static const float A4[12] = {-0.105f, -0.1485f, 0, 0.105f, -0.1485f, 0, 0.105f, 0.1485f, 0, -0.105f, 0.1485f, 0};
static const float A4_UV[8] = {0, 0, 1, 0, 1, 1, 0, 1};

/// What is left of a burnt sheet, seen from straight above.
typedef struct Remains {
    int covered, border; ///< pixels, and sides of pixels between what is covered and what is not
} Remains;

static Remains burn_sheet(float weave) {
    enum { WIDE = 240, HIGH = 240 };
    static float coverage[HIGH * WIDE];
    const PreviewLook look = {.weave = weave};
    const PreviewStart start = {4, 1, A4, QUAD, A4_UV, NULL};
    SingeSurface sheet;
    assert_true(synthetic_make(SYNTHETIC_COLD, 84, 0.04f, &sheet));

    PreviewDef def = above();
    def.width = WIDE, def.height = HIGH, def.samples = 4;
    def.camera.eye[0] = def.camera.target[0] = 0.012f, def.camera.eye[1] = def.camera.target[1] = 0.02f;
    def.camera.fov = 0.22f;
    def.ground_height = -INFINITY;
    def.looks = &look, def.starts = &start, def.sheet_count = 1;
    const PreviewLayers layers = {.coverage = coverage};
    draw_layers(&def, &sheet, NULL, 30, &layers);
    synthetic_free(&sheet);

    Remains remains = {0, 0};
    for (int y = 0; y + 1 < HIGH; y++)
        for (int x = 0; x + 1 < WIDE; x++) {
            const bool here = coverage[y * WIDE + x] > 0.5f;
            remains.covered += here;
            remains.border += here != (coverage[y * WIDE + x + 1] > 0.5f);
            remains.border += here != (coverage[(y + 1) * WIDE + x] > 0.5f);
        }
    return remains;
}

/// Threads of 1.5 mm, 3 pixels, end one by one at the hole: its border is longer than paper's, and most of the cloth is
/// still there.
TEST(burnt_cloth_frays_into_threads) {
    const Remains paper = burn_sheet(0), cloth = burn_sheet(0.0015f);
    print_message("paper: %d pixels, border %d; cloth: %d, %d\n", paper.covered, paper.border, cloth.covered,
                  cloth.border);
    assert_true(paper.border > 100);
    assert_true(cloth.border > 1.5f * (float)paper.border); // 1.46 where holes in burnt cloth were round
    assert_true(cloth.covered < paper.covered && cloth.covered > 0.75f * (float)paper.covered);
}

enum { SEEN = 240, SIDE = 40, GRID = SIDE * SIDE };
static struct Char {
    float position[GRID][3], normal[GRID][3], uv[GRID][2], temperature[GRID], peak[GRID], burn[GRID], rate[GRID],
        charred[GRID], ash[GRID];
    int32_t sheet[GRID];
    uint32_t triangles[2 * GRID][3];
    SingeSurface surface;
} burnt;

/// A flat sheet of char of A4's size, whose vertices triangles share.
static void char_make(float burn) {
    burnt.surface = SURFACE_OF(&burnt, position, peak, GRID, 0);
    for (uint32_t i = 0; i < GRID; i++) {
        const float u = (float)(i % SIDE) / (SIDE - 1), v = (float)(i / SIDE) / (SIDE - 1);
        burnt.position[i][0] = 0.21f * (u - 0.5f), burnt.position[i][1] = 0.297f * (v - 0.5f);
        burnt.position[i][2] = 0;
        burnt.normal[i][2] = 1, burnt.uv[i][0] = u, burnt.uv[i][1] = v;
        burnt.temperature[i] = 293, burnt.peak[i] = 900, burnt.burn[i] = burn;
        if (i % SIDE == SIDE - 1 || i / SIDE == SIDE - 1) continue;
        const uint32_t cell[6] = {i, i + 1, i + SIDE + 1, i, i + SIDE + 1, i + SIDE};
        memcpy(burnt.triangles[burnt.surface.triangle_count], cell, sizeof cell);
        burnt.surface.triangle_count += 2;
    }
}

static float seen[SEEN * SEEN]; ///< cloth's share of pixels
static bool bare[SEEN * SEEN];  ///< pixels that show none

/// Pixels of the hole at a pixel, which is filled.
static int hole_fill(int pixel) {
    static int stack[SEEN * SEEN];
    int size = 0, count = 0;
    bare[pixel] = false;
    for (stack[count++] = pixel; count > 0;) {
        const int at = stack[--count], x = at % SEEN;
        const int near[4] = {at - SEEN, at + SEEN, x > 0 ? at - 1 : -1, x + 1 < SEEN ? at + 1 : -1};
        size++;
        for (int k = 0; k < 4; k++) {
            if (near[k] < 0 || near[k] >= SEEN * SEEN || !bare[near[k]]) continue;
            bare[near[k]] = false;
            stack[count++] = near[k];
        }
    }
    return size;
}

/// Burnt cloth of threads of 0.4 mm, in pixels of 0.8 mm, into `seen` and `bare`.
static void draw_holes(const SingeSurface *surface, float (*glow)[3], float (*beauty)[3]) {
    const PreviewLook look = {.weave = 4e-4f};
    const PreviewStart start = {4, 1, A4, QUAD, A4_UV, NULL};
    PreviewDef def = above();
    def.width = def.height = SEEN, def.samples = 4, def.camera.fov = 0.376f; // 19 cm
    def.looks = &look, def.starts = &start, def.sheet_count = 1, def.ground_height = -INFINITY;
    const PreviewLayers layers = {.coverage = seen, .glow = glow, .beauty = beauty};
    draw_layers(&def, surface, NULL, 30, &layers);
    for (int i = 0; i < SEEN * SEEN; i++) bare[i] = seen[i] < 0.5f;
}

TEST(holes_in_burnt_cloth_are_of_many_sizes) {
    char_make(0.7f);
    draw_holes(&burnt.surface, NULL, NULL);
    int small = 0, large = 0, total = 0; // 2 mm2 and less, 2 cm2 and more
    for (int i = 0; i < SEEN * SEEN; i++) {
        const int size = bare[i] ? hole_fill(i) : 0;
        total += size, small += size > 0 && size <= 3, large += size > 300;
    }
    const double share = 100.0 * total / (SEEN * SEEN);
    print_message("holes: %.1f %%, %d small, %d large\n", share, small, large);
    assert_true(share > 8 && share < 25); // 3.4
    assert_true(small > 80 && large > 2); // none large
    assert_true(small < 170);             // 185: crumbs and pinholes all over
}

/// What each family of threads loses alone ends along the other's threads, in stairs. All of this sheet is as loose as a border,
/// as its triangles share no vertices.
TEST(burnt_borders_of_cloth_have_no_stairs) {
    enum { LONG = 8 };
    SingeSurface sheet;
    assert_true(synthetic_make(SYNTHETIC_COLD, 84, 0.001f, &sheet));
    for (uint32_t i = 0; i < sheet.vertex_count; i++) sheet.burn[i] = 0.7f;
    draw_holes(&sheet, NULL, NULL);
    synthetic_free(&sheet);
    int border = 0, straight = 0;
    for (int axis = 0; axis < 2; axis++)
        for (int y = 0; y + 1 < SEEN; y++)
            for (int x = 0, run = 0; x < SEEN; x++) {
                const int at = axis ? x * SEEN + y : y * SEEN + x, other = at + (axis ? 1 : SEEN);
                const bool side = bare[at] != bare[other];
                border += side, run = side ? run + 1 : 0;
                straight += run == LONG ? LONG : run > LONG;
            }
    const double share = 100.0 * straight / border;
    print_message("sides of %d pixels and more are %.1f %% of a border of %d\n", LONG, share, border);
    assert_true(border > 5000 && share < 8); // 14
}

/// Holes of cloth whose threads no pixel resolves, as of examples/shirt, are round: the mean of cos 4a over the directions a in
/// which cloth ends, over 5 pixels, is 1 where all of them are along the threads, in steps, and 0 where they are any.
TEST(holes_in_burnt_cloth_are_no_lattice) {
    char_make(0.7f);
    draw_holes(&burnt.surface, NULL, NULL);
    double sum = 0, weight = 0;
    for (int y = 2; y + 2 < SEEN; y++)
        for (int x = 2; x + 2 < SEEN; x++) {
            double across = 0, down = 0;
            const float *at = seen + y * SEEN + x;
            for (int k = -2; k <= 2; k++) {
                across += (double)(at[k * SEEN + 2] - at[k * SEEN - 2]);
                down += (double)(at[2 * SEEN + k] - at[-2 * SEEN + k]);
            }
            const double a2 = across * across, d2 = down * down, steep = sqrt(a2 + d2);
            if (steep < 1) continue;
            sum += steep * (1 - 8 * a2 * d2 / ((a2 + d2) * (a2 + d2))), weight += steep;
        }
    print_message("holes end along the threads by %.3f\n", sum / weight);
    assert_true(weight > 1000 && fabs(sum / weight) < 0.06); // 0.15: slits along the threads
}

/// Char that glows does so in lines some centimetres long, along the rims that its holes have and over it, and is black between
/// them: specks of light under 5 mm2, to a square decimetre, and the share of it that glows at all.
TEST(char_of_cloth_glows_in_lines_and_not_in_specks) {
    static float glow[SEEN * SEEN][3];
    char_make(0.7f);
    for (int i = 0; i < GRID; i++) burnt.charred[i] = 0.25f, burnt.rate[i] = 0.4f, burnt.temperature[i] = 1050;
    SingeSurface hot = burnt.surface;
    hot.mass = hot.char_fraction = burnt.charred, hot.ash_fraction = burnt.ash;
    draw_holes(&hot, glow, NULL);
    int specks = 0, glows = 0;
    for (int i = 0; i < SEEN * SEEN; i++) glows += bare[i] = glow[i][0] > 0.25f;
    for (int i = 0; i < SEEN * SEEN; i++) specks += bare[i] && hole_fill(i) < 8;
    const double share = 100.0 * glows / (SEEN * SEEN), area = SEEN * SEEN * 64e-6;
    print_message("%.1f %% glows, in %.0f specks to a square decimetre\n", share, specks / area);
    assert_true(share > 3 && share < 15 && specks < 50 * area); // 31, 105: threads and specks all over
}

/// Ash clings to rims of cold char: its light within 1.6 mm of a hole over that elsewhere.
TEST(rims_of_holes_in_cloth_are_pale) {
    static float beauty[SEEN * SEEN][3];
    char_make(0.7f);
    draw_holes(&burnt.surface, NULL, beauty);
    double light[2] = {0, 0};
    int count[2] = {0, 0};
    for (int y = 2; y + 2 < SEEN; y++)
        for (int x = 2; x + 2 < SEEN; x++) {
            const int at = y * SEEN + x;
            if (seen[at] < 1) continue;
            const bool rim = seen[at - 2] < 1 || seen[at + 2] < 1 || seen[at - 2 * SEEN] < 1 || seen[at + 2 * SEEN] < 1;
            light[rim] += (double)beauty[at][1], count[rim]++;
        }
    const double ratio = light[1] / count[1] / (light[0] / count[0]);
    print_message("rims of holes are %.2f times as bright as other char\n", ratio);
    assert_true(ratio > 1.15); // 1.01
}

/// Cuts a round hole into the middle of the sheet.
static void cut_middle(float radius) {
    uint32_t kept = 0;
    for (uint32_t t = 0; t < burnt.surface.triangle_count; t++) {
        const float *corner = burnt.position[burnt.triangles[t][0]];
        if (hypotf(corner[0], corner[1]) > radius)
            memmove(burnt.triangles[kept++], burnt.triangles[t], sizeof *burnt.triangles);
    }
    burnt.surface.triangle_count = kept;
}

/// The light of a table 5 cm below such a sheet, of paper, as it is seen through a hole of 2 cm in its middle.
static float seen_through(float burn) {
    static float beauty[SEEN * SEEN][3];
    char_make(burn);
    cut_middle(0.010f);
    PreviewDef def = above();
    def.width = def.height = SEEN, def.samples = 4, def.camera.fov = 0.376f, def.ground_height = -0.05f;
    def.sun_direction[1] = 0; // through the hole
    draw_layers(&def, &burnt.surface, NULL, 30, &(PreviewLayers){.beauty = beauty});
    float sum = 0;
    for (int k = -3; k <= 3; k++) sum += beauty[SEEN / 2 * SEEN + SEEN / 2 + k][1] / 7;
    return sum;
}

/// A hole in char is a dark gap, one in fresh paper is not.
TEST(what_lies_behind_char_is_dim) {
    const float fresh = seen_through(0), burnt_sheet = seen_through(0.7f);
    print_message("through a hole in char a table has %.2f of its light\n", (double)(burnt_sheet / fresh));
    assert_true(burnt_sheet < 0.7f * fresh && burnt_sheet > 0.2f * fresh); // 1.0 with no gaps
}

/// What is seen at the rim of a hole is as dim as what is seen through its middle, also where the char around it is itself seen
/// through a larger one, 3 cm before it: the light of what is no char, over that of the middle.
TEST(holes_behind_holes_have_no_bright_rims) {
    static float beauty[SEEN * SEEN][3];
    char_make(0.7f);
    cut_middle(0.014f);
    for (int i = 0; i < GRID; i++)
        if (hypotf(burnt.position[i][0], burnt.position[i][1]) < 0.032f) burnt.position[i][2] = -0.03f;
    PreviewDef def = above();
    def.width = def.height = SEEN, def.samples = 16, def.camera.fov = 0.376f, def.ground_height = -0.5f;
    def.ground = PREVIEW_GROUND_PLAIN;
    const float beside[3] = {1, 0, 0.4f}; // the sun shines on the ground beside the sheet
    memcpy(def.sun_direction, beside, sizeof beside);
    draw_layers(&def, &burnt.surface, NULL, 30, &(PreviewLayers){.beauty = beauty, .coverage = seen});
    float middle = 0, rim = 0, count = 0;
    for (int k = -3; k <= 3; k++) middle += beauty[SEEN / 2 * SEEN + SEEN / 2 + k][1] / 7;
    for (int y = -8; y < 8; y++)
        for (int x = 21; x < 28; x++) {
            const int at = (SEEN / 2 + y) * SEEN + SEEN / 2 + x;
            if (!(seen[at] > 0 && seen[at] < 0.6f)) continue;
            rim += beauty[at][1], count += 1 - seen[at];
        }
    rim /= count;
    print_message("%.1f pixels of its rim show %.2f of the light in the middle of the hole\n", (double)count,
                  (double)(rim / middle));
    assert_true(count > 5 && rim < 1.28f * middle); // 1.42
}

/// The depth of burnt cloth that lies at 0, seen from above, as its root mean square in mm; returns the pixels that show it.
static int char_depth(float ground, double *rms) {
    static float depth[SEEN * SEEN];
    static int32_t sheet[SEEN * SEEN];
    char_make(0.5f);
    const PreviewLook look = {.weave = 4e-4f};
    const PreviewStart start = {4, 1, A4, QUAD, A4_UV, NULL};
    PreviewDef def = above();
    def.width = def.height = SEEN, def.samples = 4, def.camera.fov = 0.376f;
    def.looks = &look, def.starts = &start, def.sheet_count = 1, def.ground_height = ground;
    const PreviewLayers layers = {.depth = depth, .sheet = sheet};
    draw_layers(&def, &burnt.surface, NULL, 30, &layers);
    double sum = 0, squares = 0;
    int count = 0;
    for (int i = 0; i < SEEN * SEEN; i++)
        if (sheet[i] >= 0) sum += (double)depth[i], squares += (double)depth[i] * (double)depth[i], count++;
    *rms = 1000 * sqrt(squares / count - sum / count * (sum / count));
    return count;
}

TEST(char_of_cloth_buckles_and_sinks_into_nothing) {
    double hangs, lies;
    const int free = char_depth(-INFINITY, &hangs), above_ground = char_depth(-0.0008f, &lies);
    print_message("char stands out by %.2f mm, %.2f on the ground, of which %.1f %% is seen\n", hangs, lies,
                  100.0 * above_ground / free);
    assert_true(hangs > 1.5 && hangs < 5 && lies > 0.8); // 0: flat
    assert_true(above_ground > 0.99 * free);
}

/// Cloth browns by and by before a front whose heat falls off to a third in 8 mm: how much of it is neither white nor black, in
/// mm, between 90 and 25 % of the light of what is whole.
TEST(cloth_browns_over_centimetres) {
    enum { ROWS = 60 };
    char_make(0);
    for (int i = 0; i < GRID; i++) {
        const float ahead = burnt.position[i][0] + 0.02f; // of the front
        burnt.peak[i] = 293 + 560 * expf(-fmaxf(ahead, 0) / 0.008f);
        burnt.burn[i] = fminf(fmaxf(-ahead / 0.02f, 0), 0.6f);
    }
    const PreviewLook look = {.weave = 4e-4f};
    const PreviewStart start = {4, 1, A4, QUAD, A4_UV, NULL};
    static float beauty[SEEN * SEEN][3];
    PreviewDef def = above();
    def.width = def.height = SEEN, def.samples = 4, def.camera.fov = 0.376f; // 19 cm
    def.looks = &look, def.starts = &start, def.sheet_count = 1, def.ground_height = -INFINITY;
    const PreviewLayers layers = {.beauty = beauty};
    draw_layers(&def, &burnt.surface, NULL, 30, &layers);
    int brown = 0;
    for (int y = 0; y < ROWS; y++) {
        const float(*row)[3] = beauty + (y + (SEEN - ROWS) / 2) * SEEN;
        for (int x = 0; x < SEEN; x++)
            brown += row[x][1] < 0.9f * row[SEEN - 12][1] && row[x][1] > 0.25f * row[SEEN - 12][1];
    }
    const double mm = brown * 0.8 / ROWS;
    print_message("cloth is brown over %.1f mm\n", mm);
    assert_true(mm > 20 && mm < 50);
}

// Woven cloth: threads that are seen from near, and what a fire leaves of them.

#include "fixture.h"
#include "synthetic.h"

#include <math.h>

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

/// How much brighter what was dark in a sheet's picture is once the sheet is char, of 255.
static float print_on_char(float weave) {
    uint8_t texels[2 * 1 * 3] = {255, 255, 255, 10, 10, 10};
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

/// What is left of a burnt sheet, seen from straight above.
typedef struct Remains {
    int covered, border; ///< pixels, and sides of pixels between what is covered and what is not
} Remains;

static Remains burn_sheet(float weave) {
    enum { WIDE = 240, HIGH = 240 };
    static float coverage[HIGH * WIDE];
    const float corners[12] = {-0.105f, -0.1485f, 0, 0.105f, -0.1485f, 0, 0.105f, 0.1485f, 0, -0.105f, 0.1485f, 0};
    const float uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    const PreviewLook look = {.weave = weave};
    const PreviewStart start = {4, 1, corners, QUAD, uv, NULL};
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

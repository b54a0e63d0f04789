// The outline of flames: what burns may be straight, the flame over it is not.

#include "burning.h"

// what a case works on
static Line gas;
static Burning paper;

enum { FRAMES = 16, PIXEL = 2 }; // mm

/// The variance of `count` values about the line that fits them best.
static float about_line(const float *values, int count) {
    float sum = 0, squares = 0, slope = 0, places = 0;
    for (int i = 0; i < count; i++) {
        const float place = (float)i - 0.5f * (float)(count - 1);
        sum += values[i], squares += values[i] * values[i], slope += place * values[i], places += place * place;
    }
    return (squares - sum * sum / (float)count - slope * slope / places) / (float)count;
}

/// By how many mm the left and the right end of what is bright in each row, from `low` to `high`, lie beside straight lines, in
/// the mean over moments.
static float outline_bends(const SingeSurface *surface, int low, int high) {
    static float fire[W * H][4];
    const float half = 0.5e-3f * H * PIXEL;
    float variance = 0;
    int moments = 0;

    PreviewDef def = aside(0.02f);
    def.camera = (PreviewCamera){.eye = {0, -1, half}, .target = {0, 0, half}, .up = {0, 0, 1}, .fov = 2 * atanf(half)};
    PreviewLayers layers = {.fire = fire};
    for (int k = 0; k < FRAMES; k++) {
        float end[2][H];
        int rows = 0;
        draw_layers(&def, surface, &gas.gas, 0.3 + k / 6.0, &layers);
        for (int row = low; row < high; row++) {
            int first = -1, last = -1;
            for (int x = 0; x < W; x++) {
                if (!(luminance(fire[(H - 1 - row) * W + x]) > 0.1f)) continue;
                first = first < 0 ? x : first, last = x;
            }
            if (first < 0) continue;
            end[0][rows] = (float)first, end[1][rows++] = (float)last;
        }
        if (rows < (high - low) / 2) continue; // a gap
        moments++;
        variance += (about_line(end[0], rows) + about_line(end[1], rows)) / 2;
    }

    assert_true(moments > FRAMES / 2);
    return PIXEL * sqrtf(variance / (float)moments);
}

/// The sides of a fire bulge and draw in, 2 to 10 cm above what burns, where the gas ends in a plane. They were walls with small
/// teeth.
TEST(sides_of_a_fire_bulge) {
    line_make(&gas, 0.003f), burning_make(&paper);
    for (int i = 0; i < COLUMN; i++) // 8 cm, in the middle of the picture
        gas.flame[i] = gas.flame[i] > 0 && i % WIDE >= 3 && i % WIDE < WIDE - 3 ? 5e6f : 0;
    for (int v = 0; v < 4 * WIDE; v++) paper.rate[v] = fabsf(paper.position[v][0]) < 0.04f;
    const float bends = outline_bends(&paper.surface, 10, 50);
    print_message("sides of a fire bend by %.1f mm\n", (double)bends);
    assert_true(bends > 7.2f); // 6.8
}

/// Flames up a rim that hangs straight down billow: they were a strip along it, as wide everywhere.
TEST(flames_up_a_rim_billow) {
    line_make(&gas, 0.003f), burning_make(&paper);
    for (int i = 0; i < COLUMN; i++) {
        const int x = i % WIDE, y = i / WIDE % DEEP;
        gas.flame[i] = x >= WIDE / 2 - 2 && x <= WIDE / 2 + 1 && (y == 1 || y == 2) ? 4e6f : 0;
    }
    for (int v = 0; v < 4 * WIDE; v++) {
        const float along = 0.008f * ((float)(v / 4) + 0.5f - 0.5f * WIDE);
        paper.position[v][0] -= along, paper.position[v][2] += along + 0.06f;
        paper.burn[v] = 0.5f; // else each strip covers those below it
    }
    const float bends = outline_bends(&paper.surface, 8, 60);
    print_message("flames up a rim bend by %.1f mm\n", (double)bends);
    assert_true(bends > 3.3f); // 2.9
}

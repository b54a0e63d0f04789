// What flies from the fire: sparks, flakes and wisps of smoke.

#include "burning.h"

// what a case draws, and the fire's layer of its last picture
static Burning paper;
static float fire[W * H][4];

static void draw_fire(Preview *preview, double time) {
    const PreviewLayers layers = {.fire = fire};
    assert_int_equal(preview_draw_layers(preview, &paper.surface, time, NULL, &layers, NULL), SINGE_OK);
}

/// An ember line throws sparks and loses flakes; what is hot and has no flame sends up a wisp of smoke. A cold sheet does
/// none of these, nor does one of which they are taken away, which is how embers were drawn before.
TEST(embers_throw_sparks_and_smoke) {
    enum { FRAMES = 6, EMBERS, FLAKES, SMOULDERING, COLD, TAKEN_AWAY, CASES };
    for (int kind = EMBERS; kind < CASES; kind++) {
        burning_make(&paper);
        for (int v = 0; v < 4 * WIDE; v++) {
            paper.burn[v] = paper.position[v][1] > 0.004f ? 0.9f : 0.3f;
            paper.temperature[v] = kind == COLD ? 293 : 1050;
            paper.rate[v] = kind == SMOULDERING ? 0 : 1;
        }
        PreviewDef def = aside(0);
        def.camera = (PreviewCamera){
            .eye = {0, -1, H / 2000.0f}, .target = {0, 0, H / 2000.0f}, .up = {0, 0, 1}, .fov = 2 * atanf(H / 2000.0f)};
        if (kind == TAKEN_AWAY || kind == FLAKES) def.sparks = def.wisps = 0;
        def.flakes = kind == COLD || kind == FLAKES;
        OwnPreview *preview = preview_open(&def);
        int sparks = 0, hidden = 0;
        float smoke = 0;
        for (int k = 0; k < FRAMES; k++) {
            draw_fire(preview, k / 6.0);
            for (int i = 0; i < W * (H - 10); i++) {
                sparks += fire[i][0] > 0.05f && fire[i][0] > 2 * fire[i][2];
                smoke = fmaxf(smoke, fire[i][3]);
                hidden += kind != SMOULDERING && fire[i][3] > 0.1f;
            }
        }
        print_message("case %d: %d pixels of sparks, %d hidden by flakes, smoke hides %.3f\n", kind, sparks, hidden,
                      (double)smoke);
        assert_true((hidden > 10) == (kind == FLAKES));
        assert_true((sparks > 10 * FRAMES) == (kind == EMBERS) || kind == FLAKES); // flakes glow, too
        assert_true((smoke > 0.02f) == (kind == SMOULDERING || kind == FLAKES));
        assert_true(kind < COLD || (sparks == 0 && smoke == 0));
    }
}

/// Paper that embers cross, before a camera that sees what rises from it.
static PreviewDef embers_make(void) {
    burning_make(&paper);
    for (int v = 0; v < 4 * WIDE; v++) {
        paper.burn[v] = paper.position[v][1] > 0.004f ? 0.9f : 0.3f;
        paper.temperature[v] = 1050, paper.rate[v] = 1;
    }
    PreviewDef def = aside(0);
    def.camera = (PreviewCamera){.eye = {0, -1, 0.1f}, .target = {0, 0, 0.1f}, .up = {0, 0, 1}, .fov = 0.2f};
    def.flakes = def.wisps = 0;
    return def;
}

/// What a wisp hides around a height: mm of whole hiding; mm, over which it does; the mean share over these.
typedef struct Slice {
    float all, wide, dense;
} Slice;

/// Of pictures with 2 mm to a pixel, rows from `low` up.
static void slice_add(int low, Slice *slice) {
    for (int row = low; row < low + 4; row++) {
        float sum = 0, squares = 0;
        for (int x = 0; x < W; x++) {
            const float hides = fire[(H - 1 - row) * W + x][3];
            sum += hides, squares += hides * hides;
        }
        if (sum > 1e-4f) slice->all += sum, slice->wide += 2 * sum * sum * sum / squares, slice->dense += squares;
    }
}

/// A wisp is a thread at its ember and for some centimetres, no ribbon. Then it breaks into curls and widens, and as it is the
/// same smoke, it is fainter there; but it does not end.
TEST(wisps_are_threads_that_break_and_fade) {
    enum { FRAMES = 48, SLICES = 3 };
    static const int heights[SLICES] = {4, 14, 54};
    PreviewDef def = embers_make();
    for (int v = 0; v < 4 * WIDE; v++) paper.rate[v] = 0, paper.temperature[v] = v / 4 == WIDE / 2 ? 1050 : 293;
    def.sparks = 0, def.wisps = 1;
    def.camera = (PreviewCamera){
        .eye = {0, -1, H / 1000.0f}, .target = {0, 0, H / 1000.0f}, .up = {0, 0, 1}, .fov = 2 * atanf(H / 1000.0f)};
    OwnPreview *preview = preview_open(&def);
    Slice slices[SLICES] = {{0, 0, 0}};
    for (int k = 0; k < FRAMES; k++) {
        draw_fire(preview, k / 2.0);
        for (int n = 0; n < SLICES; n++) slice_add(heights[n], &slices[n]);
    }
    for (int n = 0; n < SLICES; n++) {
        slices[n].wide /= slices[n].all, slices[n].dense /= slices[n].all;
        print_message("%3d mm up a wisp is %5.1f mm wide, hides %.3f there, in all %.2f\n", 2 * heights[n] + 3,
                      (double)slices[n].wide, (double)slices[n].dense, (double)slices[n].all);
    }
    assert_true(slices[0].wide < 8);                   // 16.9, a ribbon
    assert_true(slices[0].all > 0.5f * slices[1].all); // 0.42: a streak that begins in the air
    assert_true(slices[1].wide < 17);                  // 18.3
    assert_true(slices[2].wide > 4 * slices[0].wide);  // 2.5, a tube
    assert_true(slices[2].all > 0.4f * slices[0].all && slices[2].dense < 0.5f * slices[0].dense); // 0.26: it ends
}

/// A spark in a picture.
typedef struct Streak {
    float light;
    int pixels, low[2], high[2];
} Streak;

/// Adds what touches pixel `at` to a spark, and takes it away.
static void take_spark(float (*seen)[4], int at, Streak *streak) {
    if (at < 0 || at >= W * (H - 10) || seen[at][0] < 0.02f) return;
    const int place[2] = {at % W, at / W};
    for (int c = 0; c < 2; c++) {
        if (!streak->pixels || place[c] < streak->low[c]) streak->low[c] = place[c];
        if (!streak->pixels || place[c] > streak->high[c]) streak->high[c] = place[c];
    }
    streak->light += seen[at][0], streak->pixels++;
    seen[at][0] = 0;
    for (int k = 0; k < 9; k++) take_spark(seen, at + W * (k / 3 - 1) + k % 3 - 1, streak);
}

/// Before a wide lens sparks are thin: they looked like capsules. Their width, pixels over the longer side, the mean over
/// their light.
TEST(sparks_are_thin) {
    enum { FRAMES = 24 };
    PreviewDef def = embers_make();
    def.camera.eye[1] = -0.18f, def.camera.fov = 0.4f, def.camera.aperture = 0.01f, def.camera.focus = 0.3f;
    OwnPreview *preview = preview_open(&def);
    float width = 0, light = 0, sparks = 0;
    for (int k = 0; k < FRAMES; k++) {
        draw_fire(preview, k / 6.0);
        for (int i = 0; i < W * (H - 10); i++) {
            Streak streak = {.pixels = 0};
            take_spark(fire, i, &streak);
            const int across = streak.high[0] - streak.low[0], down = streak.high[1] - streak.low[1];
            if (streak.pixels < 4) continue;
            width += streak.light * (float)streak.pixels / (float)(1 + (across > down ? across : down));
            light += streak.light, sparks++;
        }
    }
    width /= light;
    print_message("%.0f sparks are %.2f pixels wide\n", (double)sparks, (double)width);
    assert_true(sparks > FRAMES);
    assert_true(width < 2.5f);
}

/// Sparks are no needles, which are bright from end to end, straight and alike: the share of a spark's length that is nearly as
/// bright as its head, the mean over their light, and how far lengths differ. Nor is any a comet, as long as the picture.
TEST(sparks_taper_and_differ_in_length) {
    enum { FRAMES = 480, PARTS = 8 };
    static float left[W * H][4];
    PreviewDef def = embers_make();
    def.sparks = 0.1f; // so that they do not touch
    def.camera.eye[1] = -0.2f, def.camera.fov = 0.3f, def.shutter = 1 / 48.0f;
    OwnPreview *preview = preview_open(&def);
    float even = 0, light = 0, sparks = 0, sum = 0, squares = 0, longest = 0;
    for (int k = 0; k < FRAMES; k++) {
        draw_fire(preview, k / 6.0);
        memcpy(left, fire, sizeof left);
        for (int i = 0; i < W * (H - 10); i++) {
            Streak streak = {.pixels = 0};
            take_spark(left, i, &streak);
            const int wide = streak.high[0] - streak.low[0], tall = streak.high[1] - streak.low[1];
            const int across = tall > wide, length = 1 + (across ? tall : wide);
            if (length < 7) continue;
            float parts[PARTS] = {0}, high = 0;
            for (int y = streak.low[1]; y <= streak.high[1]; y++)
                for (int x = streak.low[0]; x <= streak.high[0]; x++) {
                    const float l = fire[y * W + x][0], shown = l / (0.2f + l); // as a film lets bright parts
                    parts[(across ? y - streak.low[1] : x - streak.low[0]) * PARTS / length] += shown;
                }
            for (int n = 0; n < PARTS; n++) high = fmaxf(high, parts[n]);
            for (int n = 0; n < PARTS; n++) even += streak.light * (float)(parts[n] > 0.4f * high) / PARTS;
            light += streak.light, sum += (float)length, squares += (float)(length * length), sparks++;
            longest = fmaxf(longest, (float)length);
        }
    }
    const float mean = sum / sparks, varies = sqrtf(squares / sparks - mean * mean) / mean;
    print_message("%.0f sparks: %.2f even, lengths of %.1f pixels vary by %.2f, %.0f at most\n", (double)sparks,
                  (double)(even / light), (double)mean, (double)varies, (double)longest);
    assert_true(sparks > FRAMES / 12);
    assert_true(even < 0.79f * light && varies > 0.28f); // 0.83
    assert_true(longest < 26);                           // 34, half of the picture
}

/// Most flakes are char: before a bright wall they are dark, where pale ones were grey bars. What they reflect over what
/// they hide.
TEST(flakes_are_dark) {
    PreviewDef def = embers_make();
    def.sparks = 0, def.flakes = 4, def.shutter = 1 / 48.0f;
    OwnPreview *preview = preview_open(&def);
    float light = 0, hidden = 0;
    for (int k = 0; k < 24; k++) {
        draw_fire(preview, k / 6.0);
        for (int i = 0; i < W * (H - 10); i++) light += fire[i][2], hidden += fire[i][3];
    }
    print_message("flakes hide %.0f pixels, and reflect %.3f of blue light there\n", (double)hidden,
                  (double)(light / hidden));
    assert_true(hidden > 120 && light < 0.035f * hidden); // 0.047
}

/// Flakes are bent and creased, so that their parts take the light as they lie; flat ones were smudges. How much the light of
/// what they hide varies between neighbouring pixels, over its mean.
TEST(flakes_have_a_form) {
    enum { FRAMES = 48, APART = 6 };
    PreviewDef def = embers_make();
    def.sparks = 0, def.flakes = 30, def.shutter = 0, def.camera.fov = 0.02f;
    def.camera.eye[2] = def.camera.target[2] = 0.04f;
    OwnPreview *preview = preview_open(&def);
    float light = 0, differs = 0;
    int pixels = 0;
    for (int k = 0; k < FRAMES; k++) {
        draw_fire(preview, k / 6.0);
        for (int i = 0; i < W * (H - 10) - APART; i++) {
            if (fire[i][3] < 0.9f || fire[i + APART][3] < 0.9f) continue;
            light += fire[i][2], differs += fabsf(fire[i][2] - fire[i + APART][2]), pixels++;
        }
    }
    print_message("flakes: light differs by %.2f of its mean (%d pixels)\n", (double)(differs / light), pixels);
    assert_true(pixels > 100 && differs > 0.4f * light); // 0.31
}

/// Flames hide the flakes behind and among them, which glow there; drawn over all flames they were black specks. How much of
/// the light of flames is lost where flakes are, by how much of that they hide without flames.
TEST(flames_hide_the_flakes_among_them) {
    enum { FRAMES = 24 };
    static float flakes[W * H][4], flames[W * H][4], both[W * H][4];
    static Line line;
    float lost = 0, hidden = 0;
    line_make(&line, 0);
    for (int k = 0; k < FRAMES; k++) {
        PreviewDef def = embers_make();
        def.sparks = 0, def.flakes = 30, def.shutter = 0;
        draw_layers(&def, &paper.surface, NULL, k / 6.0, &(PreviewLayers){.fire = flakes});
        draw_layers(&def, &paper.surface, &line.gas, k / 6.0, &(PreviewLayers){.fire = both});
        def.flakes = 0;
        draw_layers(&def, &paper.surface, &line.gas, k / 6.0, &(PreviewLayers){.fire = flames});
        for (int i = 0; i < W * (H - 10); i++) {
            if (flames[i][3] < 0.8f) continue;
            hidden += flakes[i][3] * luminance(flames[i]);
            lost += luminance(flames[i]) - luminance(both[i]);
        }
    }
    print_message("flakes hide flames as bright as %.2f pixels, and take %.2f of that\n", (double)hidden,
                  (double)(lost / hidden));
    assert_true(hidden > 10 && lost < 0.2f * hidden); // 0.47
}

/// Of many sparks most are faint, and few give most of the light. Sparks that were alike looked like dashes.
TEST(sparks_differ) {
    enum { FRAMES = 24 };
    PreviewDef def = embers_make();
    OwnPreview *preview = preview_open(&def);
    int sparks = 0;
    float sum = 0, squares = 0;
    for (int k = 0; k < FRAMES; k++) {
        draw_fire(preview, k / 6.0);
        for (int i = 0; i < W * (H - 10); i++) {
            Streak streak = {.pixels = 0};
            take_spark(fire, i, &streak);
            const float light = streak.light;
            sparks += light > 0, sum += light, squares += light * light;
        }
    }
    const float mean = sum / (float)sparks, varies = sqrtf(squares / (float)sparks - mean * mean) / mean;
    print_message("the light of %d sparks varies by %.2f of the mean\n", sparks, (double)varies);
    assert_true(sparks > 3 * FRAMES);
    assert_true(varies > 2.7f); // 1.48, 2.00, 2.45
}

/// Embers crackle: sparks come in bursts, here and there, with none elsewhere. How much their number in a part of the rim
/// varies from moment to moment, over what it would if each came by itself.
TEST(sparks_come_in_bursts) {
    enum { FRAMES = 96, PARTS = 6 };
    PreviewDef def = embers_make();
    OwnPreview *preview = preview_open(&def);
    float sum = 0, squares = 0;
    for (int k = 0; k < FRAMES; k++) {
        float count[PARTS] = {0};
        draw_fire(preview, k / 2.0);
        for (int i = 0; i < W * (H - 10); i++) {
            Streak streak = {.pixels = 0};
            take_spark(fire, i, &streak);
            if (streak.pixels) count[i % W * PARTS / W]++;
        }
        for (int n = 0; n < PARTS; n++) sum += count[n], squares += count[n] * count[n];
    }
    const float mean = sum / (FRAMES * PARTS), over = (squares / (FRAMES * PARTS) - mean * mean) / mean;
    print_message("%.1f sparks to a part, their variance over that is %.2f\n", (double)mean, (double)over);
    assert_true(over > 6.4f); // 5.6
}

/// Sparks are in the fire's plume, and few are beside it: of those of a rim 3 cm long, in slices from 3 to 19 cm up, how far
/// aside they are, by their light. They are dull when they are far up: red over green light low and high.
TEST(sparks_rise_and_cool_in_the_plume) {
    enum { FRAMES = 96 };
    PreviewDef def = embers_make();
    for (int v = 0; v < 4 * WIDE; v++)
        if (v / 16 < 1 || v / 16 > 2) paper.rate[v] = 0, paper.temperature[v] = 293;
    def.sparks = 8;
    OwnPreview *preview = preview_open(&def);
    float light[2] = {0, 0}, green[2] = {0, 0}, aside[2] = {0, 0};
    for (int k = 0; k < FRAMES; k++) {
        draw_fire(preview, k / 3.0);
        for (int i = 0; i < W * (H - 10); i++) {
            const int high = i / W < H / 2;
            light[high] += fire[i][0], green[high] += fire[i][1];
            aside[high] += fire[i][0] * 3.1f * fabsf((float)(i % W) - W / 2);
        }
    }
    for (int high = 0; high < 2; high++)
        print_message("sparks %s: light %.2f, %.0f mm aside, red over green %.2f\n", high ? "high" : "low",
                      (double)light[high], (double)(aside[high] / light[high]), (double)(light[high] / green[high]));
    const float dull = light[1] / green[1] / (light[0] / green[0]);
    assert_true(aside[0] < 24 * light[0] && aside[1] < 29 * light[1]); // 25, 32
    assert_true(dull > 1.25f);                                         // 1.17
}

/// Wisps over embers by night are a bluish grey: the red of embers and the blue of the sky made them purple.
TEST(wisps_are_blue_grey) {
    PreviewDef def = embers_make();
    def.sparks = 0, def.wisps = 1;
    for (int c = 0; c < 3; c++) def.sun_colour[c] = 0, def.sky_colour[c] = 0.02f + 0.004f * (float)c;
    for (int v = 0; v < 4 * WIDE; v++) paper.rate[v] = v / 4 % 4 < 2;
    OwnPreview *preview = preview_open(&def);
    float sum[3] = {0, 0, 0};
    for (int k = 0; k < 6; k++) {
        draw_fire(preview, k / 6.0);
        for (int i = 0; i < W * (H - 10); i++)
            for (int c = 0; c < 3; c++) sum[c] += fire[i][c];
    }
    print_message("wisps: red %.2f, green %.2f, blue %.2f\n", (double)sum[0], (double)sum[1], (double)sum[2]);
    assert_true(sum[2] > 1 && sum[0] < sum[1] && sum[1] < sum[2]);
}

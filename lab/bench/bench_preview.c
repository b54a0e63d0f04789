// singe bench preview: the cost of pictures of a synthetic burning sheet of about 100,000 triangles, and how far they are
// from pictures with 256 samples.
#include "bench/bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/machine.h"
#include "analysis/numbers.h"
#include "formats/formats.h"
#include "preview/preview.h"

enum { CELLS_X = 198, CELLS_Y = 280, ACROSS = CELLS_X + 1, REPEATS = 5 };
static const float sheet_width = 0.210f, sheet_length = 0.297f, hole_radius = 0.04f, front = 0.009f;

static float preview_bench_smooth(float a, float b, float x) {
    float s = fminf(fmaxf((x - a) / (b - a), 0), 1);
    return s * s * (3 - 2 * s);
}

/// Distance outward from the edge of the hole.
static float from_edge(float x, float y) {
    float dx = x - 0.012f, dy = y - 0.02f, angle = atan2f(dy, dx);
    float wobble = 1 + 0.09f * sinf(3 * angle + 1) + 0.06f * sinf(5 * angle + 0.4f) + 0.035f * sinf(11 * angle);
    return sqrtf(dx * dx + dy * dy) - hole_radius * wobble;
}

/// Height of the sheet: it curls where it burns, and one corner is raised.
static float height_at(float x, float y) {
    float s = from_edge(x, y), angle = atan2f(y - 0.02f, x - 0.012f);
    float curl = expf(-fmaxf(s, 0) / 0.016f) * (0.006f + 0.0045f * sinf(6 * angle) + 0.002f * sinf(17 * angle));
    return 0.0015f + fmaxf(curl, 0) + 0.0125f * preview_bench_smooth(0.12f, 0.19f, fabsf(x + 0.35f * y));
}

static bool make_surface(SingeSurface *s) {
    if (!surface_new(s, ACROSS * (CELLS_Y + 1), 2 * CELLS_X * CELLS_Y)) return false;

    s->triangle_count = 0;
    for (uint32_t i = 0; i < s->vertex_count; i++) {
        const float x = sheet_width * ((float)(i % ACROSS) / CELLS_X - 0.5f);
        const float y = sheet_length * ((float)(i / ACROSS) / CELLS_Y - 0.5f);
        const float e = 1e-4f;
        float z = height_at(x, y), zx = (height_at(x + e, y) - z) / e, zy = (height_at(x, y + e) - z) / e;
        float length = sqrtf(1 + zx * zx + zy * zy), edge = from_edge(x, y);
        float burn = 0.95f * (1 - preview_bench_smooth(-0.25f * front, front, edge)),
              ahead = fmaxf(edge - 0.0035f, 0) / 0.0042f;

        s->position[i][0] = s->rest_position[i][0] = x;
        s->position[i][1] = s->rest_position[i][1] = y;
        s->position[i][2] = z;
        s->normal[i][0] = -zx / length;
        s->normal[i][1] = -zy / length;
        s->normal[i][2] = 1 / length;
        s->uv[i][0] = x / sheet_width + 0.5f;
        s->uv[i][1] = y / sheet_length + 0.5f;
        s->velocity[i][1] = 0.1f * z / 0.01f;
        s->temperature[i] = s->temperature_peak[i] = 293 + 830 * expf(-ahead);
        s->burn[i] = burn;
        s->mass[i] = 1;
        s->burn_rate[i] = 0.9f * expf(-powf((edge - 0.001f) / 0.005f, 2));
        s->time_ignited[i] = burn > 0 ? fmaxf(0, 1 - 40 * (front - edge)) : -1;
    }

    for (uint32_t k = 0; k < CELLS_X * CELLS_Y; k++) {
        uint32_t a = k / CELLS_X * ACROSS + k % CELLS_X, b = a + 1, c = b + ACROSS, d = a + ACROSS;
        if (fmaxf(fmaxf(s->burn[a], s->burn[b]), fmaxf(s->burn[c], s->burn[d])) > 0.949f) continue;

        uint32_t(*t)[3] = s->triangles + s->triangle_count;
        t[0][0] = a;
        t[0][1] = b;
        t[0][2] = c;
        t[1][0] = a;
        t[1][1] = c;
        t[1][2] = d;
        s->triangle_count += 2;
    }

    return true;
}

enum { GAS_X = 30, GAS_Y = 42, GAS_Z = 24, GAS_CELLS = GAS_X * GAS_Y * GAS_Z };

/// Gas around the sheet, in cells of 8 mm: it burns above the edge of the hole, less at greater heights, and rises.
typedef struct Flames {
    float temperature[GAS_CELLS], smoke[GAS_CELLS], flame[GAS_CELLS], velocity[GAS_CELLS][3];
    SingeGas gas;
} Flames;

static Flames *make_flames(void) {
    const float cell = 0.008f;
    Flames *f = calloc(1, sizeof *f);
    if (!f) return NULL;

    f->gas = (SingeGas){.size = {GAS_X, GAS_Y, GAS_Z},
                        .cell = cell,
                        .origin = {-0.5f * GAS_X * cell, -0.5f * GAS_Y * cell, 0},
                        .temperature = f->temperature,
                        .smoke = f->smoke,
                        .flame = f->flame,
                        .velocity = (const float(*)[3])f->velocity};
    for (int i = 0; i < GAS_CELLS; i++) {
        float x = ((float)(i % GAS_X) + 0.5f) * cell + f->gas.origin[0];
        float y = ((float)(i / GAS_X % GAS_Y) + 0.5f) * cell + f->gas.origin[1];
        float z = ((float)(i / (GAS_X * GAS_Y)) + 0.5f) * cell, off = from_edge(x, y) / (0.006f + 0.1f * z);
        float burning = expf(-off * off - z / 0.05f);
        f->flame[i] = 3e6f * burning;
        f->smoke[i] = 2e-4f * burning;
        f->temperature[i] = 293 + 1200 * burning;
        f->velocity[i][2] = 0.3f + 6 * z;
    }

    return f;
}

typedef struct Shot {
    const char *name;
    float eye[3], target[3], fov, aperture, shutter;
    bool fire;
} Shot;

static const Shot shots[] = {
    {"table", {0.05f, -0.40f, 0.36f}, {0, -0.012f, 0}, 0.58f, 0, 0, false},
    {"close", {0.03f, -0.16f, 0.15f}, {0.01f, -0.005f, 0}, 0.45f, 0, 0, false},
    {"lens", {0.05f, -0.40f, 0.36f}, {0, -0.012f, 0}, 0.58f, 0.008f, 0.02f, false},
    {"fire", {0.05f, -0.40f, 0.36f}, {0, -0.012f, 0}, 0.58f, 0, 0, true},
    {"firenear", {0.03f, -0.24f, 0.15f}, {0.01f, -0.005f, 0.03f}, 0.5f, 0, 0, true},
    {"lensnear", {0.08f, -0.28f, 0.09f}, {0, 0.02f, 0.005f}, 0.52f, 0.003f, 0.02f, false},
    {"flames", {0.08f, -0.28f, 0.09f}, {0, 0.02f, 0.005f}, 0.52f, 0.003f, 0.02f, true},
};

/// Pictures of a shot in one size. `def` must outlive `preview`.
typedef struct Easel {
    PreviewDef def;
    Preview *preview;
    Flames *flames;
    uint8_t *rgb;
} Easel;

static void easel_end(Easel *easel) {
    preview_destroy(easel->preview);
    free(easel->rgb);
    free(easel->flames);
    *easel = (Easel){.preview = NULL};
}

static SingeResult easel_begin(const BenchOptions *options, const Shot *shot, int width, int samples, Easel *easel,
                               SingeError *error) {
    PreviewDef *def = &easel->def;
    *easel = (Easel){.def = preview_default()};
    memcpy(def->sun_direction, (const float[3]){-0.55f, 0.45f, 0.62f}, sizeof def->sun_direction); // by day
    memcpy(def->sun_colour, (const float[3]){2.2f, 2.05f, 1.85f}, sizeof def->sun_colour);
    memcpy(def->sky_colour, (const float[3]){0.4f, 0.45f, 0.53f}, sizeof def->sky_colour);

    def->width = width;
    def->height = width * 9 / 16;
    def->samples = samples;
    def->thread_count = options->threads;
    memcpy(def->camera.eye, shot->eye, sizeof shot->eye);
    memcpy(def->camera.target, shot->target, sizeof shot->target);

    def->camera.fov = shot->fov;
    def->camera.aperture = shot->aperture;
    def->shutter = shot->shutter;
    def->sky = PREVIEW_SKY_STUDIO;
    easel->rgb = malloc((size_t)def->width * (size_t)def->height * 3);
    if (shot->fire) easel->flames = make_flames();
    if (!easel->rgb || (shot->fire && !easel->flames)) return SINGE_ERROR_MEMORY;

    SingeResult result = preview_create(def, (SingeAllocator){0}, &easel->preview, error);
    if (!result && shot->fire) result = preview_set_gas(easel->preview, &easel->flames->gas, error);
    return result;
}

// ---- the error

enum { SAMPLES = 16, REFERENCE_SAMPLES = 256, PAN_FRAMES = 2 };

/// Draws the shot in the reference's size, the second frame with the camera turned by a third of a pixel. Returns the
/// pictures, one after the other; NULL after an error.
static uint8_t *draw_pan(const BenchOptions *options, const Shot *shot, const SingeSurface *surface, int width,
                         int samples, size_t *bytes, SingeError *error) {
    *bytes = (size_t)width * (size_t)(width * 9 / 16) * 3;
    uint8_t *pictures = malloc(PAN_FRAMES * *bytes);
    SingeResult result = pictures ? SINGE_OK : SINGE_ERROR_MEMORY;
    for (int frame = 0; frame < PAN_FRAMES && !result; frame++) {
        Shot aimed = *shot;
        const float reach = hypotf(aimed.target[1] - aimed.eye[1], aimed.target[2] - aimed.eye[2]);
        aimed.target[0] += (float)frame * reach * aimed.fov * 16 / 9 / (float)width / 3;
        Easel easel;
        result = easel_begin(options, &aimed, width, samples, &easel, error);
        if (!result) result = preview_draw(easel.preview, surface, 1 + frame / 24.0, easel.rgb, error);
        if (!result) memcpy(pictures + (size_t)frame * *bytes, easel.rgb, *bytes);
        easel_end(&easel);
    }

    if (!result) return pictures;
    free(pictures);
    return NULL;
}

static SingeResult shot_measure(const BenchOptions *options, const Shot *shot, const SingeSurface *surface,
                                BenchTable *table, SingeError *error) {
    // seconds of pictures after the first: that one also prepares the table's appearance, which a film does once
    Easel easel;
    double used[REPEATS], passed[REPEATS];
    SingeResult result = easel_begin(options, shot, options->quick ? 320 : 1280, SAMPLES, &easel, error);
    for (int i = -1; i < REPEATS && !result; i++) {
        const double began = machine_cpu_clock(), clock = machine_clock();
        result = preview_draw(easel.preview, surface, i < 0 ? 1 : 1 + i / 24.0, easel.rgb, error);
        if (i < 0) continue;
        used[i] = machine_cpu_clock() - began;
        passed[i] = machine_clock() - clock;
    }

    easel_end(&easel);
    if (result) return result;
    const double cpu = numbers_median(used, REPEATS), min = used[0], wall = numbers_median(passed, REPEATS);

    // e of both frames, and how much it changes between them
    const int width = options->quick ? 160 : 320;
    size_t bytes;
    uint8_t *drawn = draw_pan(options, shot, surface, width, SAMPLES, &bytes, error);
    uint8_t *whole = drawn ? draw_pan(options, shot, surface, width, REFERENCE_SAMPLES, &bytes, error) : NULL;
    double squares = 0, changes = 0;
    for (size_t i = 0; whole && i < bytes; i++) {
        const double first = (double)drawn[i] - whole[i], second = (double)drawn[bytes + i] - whole[bytes + i];
        squares += 0.5 * (first * first + second * second);
        changes += (second - first) * (second - first);
    }

    const bool good = whole;
    free(drawn);
    free(whole);
    if (!good) return error->code ? error->code : SINGE_ERROR_MEMORY;

    table_text(table, "picture", 8, shot->name);
    table_number(table, "triangles", "%.0f", 10, surface->triangle_count);
    table_number(table, "samples", "%.0f", 8, SAMPLES);
    table_number(table, "cpu_s", "%.3f", 8, cpu);
    table_number(table, "min_cpu_s", "%.3f", 12, min);
    table_number(table, "wall_s", "%.3f", 8, wall);
    table_number(table, "rms_error", "%.2f", 10, sqrt(squares / (double)bytes));
    table_number(table, "rms_boil", "%.2f", 10, sqrt(changes / (double)bytes));
    return table_end_row(table);
}

SingeResult bench_preview(const BenchOptions *options, BenchTable *table, SingeError *error) {
    SingeSurface surface;
    SingeResult result = make_surface(&surface) ? SINGE_OK : SINGE_ERROR_MEMORY;
    for (size_t i = 0; i < sizeof shots / sizeof *shots && !result; i++)
        result = shot_measure(options, &shots[i], &surface, table, error);
    singe_surface_free(&surface);
    return result;
}

// singe bench preview: the cost of a picture of a synthetic burning sheet of about 100,000 triangles.
#include "bench/bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/machine.h"
#include "analysis/numbers.h"
#include "preview/preview.h"

enum { PICTURE, TRIANGLES, SAMPLES, SECONDS, MIN, WALL, COLUMNS };

static const BenchColumn columns[COLUMNS] = {
    [PICTURE] = {"picture", NULL, 8, NULL},   [TRIANGLES] = {"triangles", "%.0f", 10, NULL},
    [SAMPLES] = {"samples", "%.0f", 8, NULL}, [SECONDS] = {"cpu_s", "%.3f", 8, NULL},
    [MIN] = {"min_cpu_s", "%.3f", 12, NULL},  [WALL] = {"wall_s", "%.3f", 8, NULL},
};

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

/// All arrays of a surface in one block, which is returned; NULL when out of memory.
static void *preview_bench_reserve(SingeSurface *s, uint32_t vertices, uint32_t triangles) {
    const size_t floats = 3 + 3 + 2 + 3 + 3 + 5, ints = 2;
    float *block = calloc((size_t)vertices * (floats + ints) + 3 * (size_t)triangles, sizeof *block), *at = block;
    if (!block) return NULL;
    *s = (SingeSurface){.vertex_count = vertices};
    s->position = (float(*)[3])(void *)at;
    at += 3 * (size_t)vertices;
    s->normal = (float(*)[3])(void *)at;
    at += 3 * (size_t)vertices;
    s->uv = (float(*)[2])(void *)at;
    at += 2 * (size_t)vertices;
    s->velocity = (float(*)[3])(void *)at;
    at += 3 * (size_t)vertices;
    s->rest_position = (float(*)[3])(void *)at;
    at += 3 * (size_t)vertices;
    float **scalars[] = {&s->temperature, &s->temperature_peak, &s->burn, &s->burn_rate, &s->time_ignited};
    for (int i = 0; i < 5; i++, at += vertices) *scalars[i] = at;
    s->piece = (int32_t *)(void *)at;
    at += vertices;
    s->sheet = (int32_t *)(void *)at;
    at += vertices;
    s->triangles = (uint32_t(*)[3])(void *)at;
    return block;
}

static void *make_surface(SingeSurface *s) {
    void *block = preview_bench_reserve(s, ACROSS * (CELLS_Y + 1), 2 * CELLS_X * CELLS_Y);
    if (!block) return NULL;
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
        s->rest_position[i][2] = 0;
        s->normal[i][0] = -zx / length;
        s->normal[i][1] = -zy / length;
        s->normal[i][2] = 1 / length;
        s->uv[i][0] = x / sheet_width + 0.5f;
        s->uv[i][1] = y / sheet_length + 0.5f;
        s->velocity[i][0] = 0;
        s->velocity[i][1] = 0.1f * z / 0.01f;
        s->velocity[i][2] = 0;
        s->temperature[i] = s->temperature_peak[i] = 293 + 830 * expf(-ahead);
        s->burn[i] = burn, s->burn_rate[i] = 0.9f * expf(-powf((edge - 0.001f) / 0.005f, 2));
        s->time_ignited[i] = burn > 0 ? fmaxf(0, 1 - 40 * (front - edge)) : -1;
        s->piece[i] = s->sheet[i] = 0;
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

    return block;
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
};

static SingeResult preview_bench_measure(const BenchOptions *options, const Shot *shot, const SingeSurface *surface,
                                         BenchTable *table, SingeError *error) {
    PreviewDef def = preview_default();
    def.width = 1280;
    def.height = 720;
    def.samples = 16;
    def.thread_count = options->threads;
    memcpy(def.camera.eye, shot->eye, sizeof shot->eye), memcpy(def.camera.target, shot->target, sizeof shot->target);
    def.camera.fov = shot->fov;
    def.camera.aperture = shot->aperture;
    def.shutter = shot->shutter;
    def.sky = PREVIEW_SKY_STUDIO;
    double cpu[REPEATS], wall[REPEATS];
    uint8_t *rgb = malloc((size_t)def.width * (size_t)def.height * 3);
    Preview *preview = NULL;
    SingeResult result = rgb ? preview_create(&def, (SingeAllocator){0}, &preview, error) : SINGE_ERROR_MEMORY;
    Flames *flames = shot->fire && !result ? make_flames() : NULL;
    if (shot->fire && !result) result = flames ? preview_set_gas(preview, &flames->gas, error) : SINGE_ERROR_MEMORY;

    // the first picture also prepares the table's appearance, which a film does once
    if (!result) result = preview_draw(preview, surface, 1, rgb, error);
    for (int i = 0; i < REPEATS && !result; i++) {
        double began = machine_cpu_clock(), clock = machine_clock();
        result = preview_draw(preview, surface, 1 + i / 24.0, rgb, error);
        cpu[i] = machine_cpu_clock() - began, wall[i] = machine_clock() - clock;
    }

    preview_destroy(preview);
    free(rgb), free(flames);
    if (result) return result;
    double seconds = numbers_median(cpu, REPEATS);
    BenchValue row[COLUMNS] = {
        [PICTURE] = bench_text(shot->name),    [TRIANGLES] = bench_number(surface->triangle_count),
        [SAMPLES] = bench_number(def.samples), [SECONDS] = bench_number(seconds),
        [MIN] = bench_number(cpu[0]),          [WALL] = bench_number(numbers_median(wall, REPEATS))};
    return table_add(table, row) ? SINGE_OK : SINGE_ERROR_MEMORY;
}

SingeResult bench_preview(const BenchOptions *options, BenchTable *table, SingeError *error) {
    *table = table_begin("preview", columns, COLUMNS, table->text);
    SingeSurface surface;
    void *block = make_surface(&surface);
    SingeResult result = block ? SINGE_OK : SINGE_ERROR_MEMORY;
    for (size_t i = 0; i < sizeof shots / sizeof *shots && !result; i++)
        result = preview_bench_measure(options, &shots[i], &surface, table, error);
    free(block);
    return result;
}

// Draws the synthetic scenes into PNG files and prints how long each took: for looking at, and for timing.
// Usage: preview_pictures FOLDER [PICTURE [THREADS]]

#include "common/clock.h"
#include "day.h"
#include "preview/preview.h"
#include "synthetic.h"
#include "synthetic_gas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct Shot {
    const char *name;
    SyntheticKind kind;
    float radius, eye[3], target[3], fov;
    bool ball;
    int samples;
    bool flames;
} Shot;

static const Shot shots[] = {
    {"fresh", SYNTHETIC_FRESH, 0.04f, {0.05f, -0.40f, 0.36f}, {0, -0.012f, 0}, 0.58f, false, 8, false},
    {"flat", SYNTHETIC_FLAT, 0.04f, {0.05f, -0.40f, 0.36f}, {0, -0.012f, 0}, 0.58f, false, 8, false},
    {"close", SYNTHETIC_FLAT, 0.04f, {0.03f, -0.16f, 0.15f}, {0.01f, -0.005f, 0}, 0.45f, false, 16, false},
    {"cold", SYNTHETIC_COLD, 0.06f, {0.03f, -0.25f, 0.24f}, {0.01f, 0.01f, 0}, 0.55f, false, 8, false},
    {"hanging", SYNTHETIC_HANGING, 0.07f, {0.16f, -0.75f, 0.42f}, {0, 0, 0.30f}, 0.60f, false, 8, false},
    {"ball", SYNTHETIC_HANGING, 0.07f, {0.16f, -0.75f, 0.42f}, {0, 0, 0.30f}, 0.60f, true, 8, false},
    {"flames", SYNTHETIC_FLAT, 0.04f, {0.05f, -0.45f, 0.34f}, {0, -0.012f, 0.04f}, 0.58f, false, 16, true},
    {"flames-near", SYNTHETIC_FLAT, 0.04f, {0.05f, -0.30f, 0.16f}, {0, -0.012f, 0.05f}, 0.5f, false, 16, true},
    {"flames-up", SYNTHETIC_HANGING, 0.07f, {0.16f, -0.75f, 0.42f}, {0, 0, 0.30f}, 0.60f, false, 16, true},
};

static SingeResult time_frame(Preview *preview, const SingeSurface *surface, uint8_t *rgb, double *cpu, double *wall,
                              SingeError *error) {
    double begun = clock_seconds();
    clock_t start = clock();
    SingeResult result = preview_draw(preview, surface, 1.0, rgb, error);
    *cpu = (double)(clock() - start) / CLOCKS_PER_SEC, *wall = clock_seconds() - begun;
    return result;
}

static int draw(const Shot *shot, const Image *picture, const char *folder, int threads) {
    SingeSurface surface;
    SingeError error = {0};
    PreviewDef def = by_day();
    const Image *pictures[1] = {picture};
    PreviewShape ball = {.kind = SINGE_COLLIDER_SPHERE,
                         .position = {0.02f, -0.03f, 0.24f},
                         .rotation = {0, 0, 0, 1},
                         .radius = 0.02f,
                         .colour = {0.3f, 0.3f, 0.32f},
                         .temperature = 1250};

    memcpy(def.camera.eye, shot->eye, sizeof shot->eye), memcpy(def.camera.target, shot->target, sizeof shot->target);
    if (shot->flames) def.width = 1280, def.height = 720;
    def.camera.fov = shot->fov, def.samples = shot->samples, def.thread_count = threads;
    const float from_front[3] = {-0.6f, -0.55f, 0.55f};
    if (shot->kind == SYNTHETIC_HANGING) memcpy(def.sun_direction, from_front, sizeof from_front);
    def.pictures = pictures, def.sheet_count = 1, def.shapes = &ball, def.shape_count = shot->ball;
    uint8_t *rgb = malloc((size_t)def.width * (size_t)def.height * 3);
    if (!rgb || !synthetic_make(shot->kind, 66, shot->radius, &surface)) return 1;

    Preview *preview = NULL;
    SyntheticGas gas = {0};
    if (shot->flames && !synthetic_gas_make(&surface, 0.008f, 1, &gas)) return 1;
    SingeResult result = preview_create(&def, (SingeAllocator){0}, &preview, &error);

    // a frame before it, so that the table is known and only the flames differ
    double without = 0, cpu = 0, wall = 0;
    if (!result && shot->flames) result = preview_draw(preview, &surface, 1.0, rgb, &error);
    if (!result && shot->flames) result = time_frame(preview, &surface, rgb, &without, &wall, &error);
    if (!result) result = preview_set_gas(preview, &gas.gas, &error);
    if (!result) result = time_frame(preview, &surface, rgb, &cpu, &wall, &error);
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.png", folder, shot->name);
    if (!result) result = png_write(path, def.width, def.height, rgb, &error);
    if (result) fprintf(stderr, "%s: %s\n", shot->name, error.message);
    else
        printf("%-11s %6u triangles, %d samples: %.3f s, %.3f s of processor", shot->name, surface.triangle_count,
               shot->samples, wall, cpu);
    if (!result && shot->flames) printf(", of which flames %.3f s", cpu - without);
    if (!result) printf("\n");
    preview_destroy(preview);
    synthetic_gas_free(&gas);
    synthetic_free(&surface);
    free(rgb);
    return result != 0;
}

static int load(const char *path, Image *image) {
    Bytes bytes = {0};
    SingeError error = {0};
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, &error);
    if (!result) result = image_read(path, bytes.data, bytes.size, (SingeAllocator){0}, image, &error);
    bytes_free(&bytes);
    if (result) fprintf(stderr, "%s\n", error.message);
    return result != 0;
}

int main(int argc, char **argv) {
    Image image = {0};
    if (argc < 2) {
        fprintf(stderr, "usage: %s FOLDER [PICTURE [THREADS]]\n", argv[0]);
        return 2;
    }
    if (argc > 2 && strcmp(argv[2], "-") && load(argv[2], &image)) return 2;
    int failed = 0, threads = argc > 3 ? atoi(argv[3]) : 1;
    for (size_t i = 0; i < sizeof shots / sizeof *shots; i++)
        failed |= draw(&shots[i], image.rgb ? &image : NULL, argv[1], threads);
    if (image.rgb) image_free(&image);
    return failed;
}

// What a picture shows of its fire: the width of the ember line, and how pale and how flat its flames are.
//
// A pixel glows if its luminance is at least a tenth of that of the brightest hundredth of the glowing pixels. From
// each such pixel, lines in eight directions run both ways to the end of the glow or the sheet. The shortest of the
// eight, measured between its ends in space, is the width of the ember line there; with eight directions its error is
// at most 2 %. The frame's width is the median over its pixels.

#include "preview/internal.h"

#include <stdlib.h>

enum { DIRECTIONS = 8, WALK_LIMIT = 96 };

typedef struct GlowPicture {
    const PreviewLayers *layers;
    Camera camera;
    int width, height;
    float min; ///< min luminance of glow
} GlowPicture;

static float luminance(const GlowPicture *picture, size_t pixel) {
    return picture->layers->sheet[pixel] < 0 ? 0 : float3_luminance(float3_load(picture->layers->glow[pixel]));
}

static Float3 glow_position(const GlowPicture *picture, int x, int y) {
    const Camera *camera = &picture->camera;
    float u = 2 * ((float)x + 0.5f) / (float)picture->width - 1, v = 1 - 2 * ((float)y + 0.5f) / (float)picture->height;
    Float3 ray = float3_mad(float3_mad(camera->forward, camera->right, u), camera->up, v);
    return float3_mad(camera->eye, ray, picture->layers->depth[(size_t)y * (size_t)picture->width + (size_t)x]);
}

static bool glows(const GlowPicture *picture, int x, int y) {
    if (x < 0 || y < 0 || x >= picture->width || y >= picture->height) return false;
    return luminance(picture, (size_t)y * (size_t)picture->width + (size_t)x) >= picture->min;
}

/// The last glowing pixel from (x, y) along (dx, dy).
static void glow_walk(const GlowPicture *picture, int x, int y, float dx, float dy, int end[2]) {
    end[0] = x;
    end[1] = y;
    for (int step = 1; step <= WALK_LIMIT; step++) {
        int to[2] = {x + (int)lroundf((float)step * dx), y + (int)lroundf((float)step * dy)};
        if (!glows(picture, to[0], to[1])) return;
        end[0] = to[0];
        end[1] = to[1];
    }
}

static int glow_ascending(const void *a, const void *b) {
    const float *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

SingeResult preview_glow_width(const PreviewDef *def, const PreviewLayers *layers, double *width, SingeError *error) {
    GlowPicture picture = {.layers = layers, .camera = camera_make(def), .width = def->width, .height = def->height};
    size_t count = (size_t)def->width * (size_t)def->height, lit = 0;
    *width = (double)NAN;
    float *values = malloc(count * sizeof *values);
    if (!values) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory");
    for (size_t i = 0; i < count; i++) {
        float value = luminance(&picture, i);
        if (value > 1e-3f) values[lit++] = value;
    }

    if (!lit) {
        free(values);
        return SINGE_OK;
    }

    qsort(values, lit, sizeof *values, glow_ascending);
    picture.min = 0.1f * values[lit - 1 - lit / 100];

    lit = 0;
    for (size_t pixel = 0; pixel < count; pixel++) {
        int x = (int)(pixel % (size_t)def->width), y = (int)(pixel / (size_t)def->width);
        if (!glows(&picture, x, y)) continue;
        float min = INFINITY;
        for (int k = 0; k < DIRECTIONS; k++) {
            float angle = PI_F * (float)k / DIRECTIONS, dx = cosf(angle), dy = sinf(angle);
            int a[2], b[2];
            glow_walk(&picture, x, y, dx, dy, a);
            glow_walk(&picture, x, y, -dx, -dy, b);

            // between the centres of the end pixels, plus half of each
            Float3 across = float3_sub(glow_position(&picture, a[0], a[1]), glow_position(&picture, b[0], b[1]));
            min = minf(min, float3_length(across) + layers->depth[pixel] * picture.camera.pixel);
        }

        values[lit++] = min;
    }

    qsort(values, lit, sizeof *values, glow_ascending);
    *width = (double)values[lit / 2];
    free(values);
    return SINGE_OK;
}

void preview_flame_shares(const PreviewDef *def, const PreviewLayers *layers, const uint8_t *rgb, FlameShares *shares) {
    enum { FEWEST = 100 }; // pixels of which a share is no noise
    const size_t count = (size_t)def->width * (size_t)def->height;
    size_t flame = 0, pale = 0, lemon = 0;

    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = rgb + 3 * i;
        const float fire = float3_luminance(float3_load(layers->fire[i]));
        if (!pixel_flames(p) || fire < 0.5f * float3_luminance(float3_load(layers->beauty[i]))) continue;
        flame++;
        pale += pixel_is_pale(p);
        lemon += pixel_is_lemon(p);
    }

    const bool enough = flame >= FEWEST;
    shares->pale = enough ? (double)pale / (double)flame : (double)NAN;
    shares->lemon = enough ? (double)lemon / (double)flame : (double)NAN;
}

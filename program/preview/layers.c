// Layers of a frame, for compositors and measurements: sums over a pixel's samples, written when the pixel is done.

#include "preview/block.h"

#include <string.h>

void layers_begin(LayerSum *sum) { *sum = (LayerSum){.depth = INFINITY, .sheet = -1, .piece = -1}; }

void layers_add(const Preview *preview, const Point *point, Float3 fire, float clear, Float3 direction, LayerSum *sum) {
    if (!sum->samples++) {
        sum->depth = point->distance * float3_dot(direction, preview->camera.forward);
        sum->sheet = point->sheet;
        sum->piece = point->piece;
    }
    sum->fire = float3_add(sum->fire, fire);
    sum->fire_hides += 1 - clear;
    if (!point->hit) return;
    sum->hits++;
    sum->glow = float3_mad(sum->glow, point->glow, clear);
    sum->normal = float3_add(sum->normal, point->normal);
    sum->temperature += point->temperature;
    sum->burn += point->burn;
}

static void store(float (*layer)[3], size_t pixel, Float3 value) {
    if (layer) {
        layer[pixel][0] = value.x;
        layer[pixel][1] = value.y;
        layer[pixel][2] = value.z;
    }
}

void layers_write(const Preview *preview, size_t pixel, const LayerSum *sum) {
    const PreviewLayers *layers = &preview->layers;
    float sample = 1 / maxf((float)sum->samples, 1), hit = 1 / maxf((float)sum->hits, 1);
    store(layers->glow, pixel, float3_scale(sum->glow, sample));
    if (layers->fire) {
        const float fire[4] = {sum->fire.x * sample, sum->fire.y * sample, sum->fire.z * sample,
                               sum->fire_hides * sample};
        memcpy(layers->fire[pixel], fire, sizeof fire);
    }
    store(layers->normal, pixel, float3_unit_or(sum->normal, float3(0, 0, 0)));
    if (layers->coverage) layers->coverage[pixel] = (float)sum->hits * sample;
    if (layers->temperature) layers->temperature[pixel] = sum->temperature * hit;
    if (layers->burn) layers->burn[pixel] = sum->burn * hit;
    if (layers->depth) layers->depth[pixel] = sum->depth;
    if (layers->sheet) layers->sheet[pixel] = sum->sheet;
    if (layers->piece) layers->piece[pixel] = sum->piece;
}

void layers_finish(const Preview *preview) {
    size_t count = (size_t)preview->def.width * (size_t)preview->def.height;
    for (size_t i = 0; preview->layers.beauty && i < count; i++) store(preview->layers.beauty, i, preview->picture[i]);
}

// Radiance to bytes.
//
// Film curve: linear but for a short toe, f = x (1 - 0.4 exp(-x / 0.06)), and a shoulder above s = 0.6, s + (1 - s) (1
// - exp(-(f - s) / (1 - s))). White paper in the sun, 0.8, becomes 0.76 (0.89 in sRGB), and the slope there is still
// 0.6, so that its wrinkles are visible. Before it, each channel leaks a little into the others, as in film: very
// bright colours become pale. Then IEC 61966-2-1 and one level of triangular dither.

#include "preview/internal.h"

static float film(float x) {
    const float shoulder = 0.6f, rest = 1 - shoulder;
    float f = x * (1 - 0.4f * expf(-x / 0.06f));
    return f < shoulder ? f : shoulder + rest * (1 - expf((shoulder - f) / rest));
}

static float tonemap_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

void tonemap_fill_linear(float table[256]) {
    for (int i = 0; i < 256; i++) {
        float s = (float)i / 255;
        table[i] = s <= 0.04045f ? s / 12.92f : powf((s + 0.055f) / 1.055f, 2.4f);
    }
}

static uint8_t quantise(float s, uint32_t key) {
    float dither = hash_unit(key) + hash_unit(key ^ 0x68bc21ebu) - 1;
    return (uint8_t)clampf(s * 255 + 0.5f + 0.7f * dither, 0, 255);
}

enum { CURVE_COUNT = 4096 };
#define LEAK 0.03f

/// The curve and the encoding as one table over sqrt(x / CURVE_MAX): film() is slow and smooth.
#define CURVE_MAX 16.0f

static float look_up(const float *curve, float x) {
    float at = sqrtf(clampf(x, 0, CURVE_MAX) / CURVE_MAX) * (CURVE_COUNT - 1);
    int i = (int)at < CURVE_COUNT - 2 ? (int)at : CURVE_COUNT - 2;
    return mixf(curve[i], curve[i + 1], at - (float)i);
}

void tonemap_write(const Preview *preview, uint8_t *rgb) {
    float curve[CURVE_COUNT];
    for (int i = 0; i < CURVE_COUNT; i++) {
        float s = (float)i / (CURVE_COUNT - 1);
        curve[i] = tonemap_encode(film(s * s * CURVE_MAX));
    }
    size_t count = (size_t)preview->def.width * (size_t)preview->def.height;
    for (size_t i = 0; i < count; i++) {
        Float3 c = float3_scale(preview->picture[i], preview->def.exposure);
        float leak = LEAK * (c.x + c.y + c.z) / 3;
        uint32_t key = (uint32_t)i * 3u + preview->def.seed * 0x9e3779b1u;
        rgb[3 * i] = quantise(look_up(curve, (1 - LEAK) * c.x + leak), key);
        rgb[3 * i + 1] = quantise(look_up(curve, (1 - LEAK) * c.y + leak), key + 1);
        rgb[3 * i + 2] = quantise(look_up(curve, (1 - LEAK) * c.z + leak), key + 2);
    }
}

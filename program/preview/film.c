// From radiance to bytes: the halo of a lens, and a film's curve.

#include "preview/internal.h"
#include "preview/share.h"

// ---- the halo

// The halo around overexposed parts: light scattered in a lens.
//
// out = picture + sum of k G(s) * over, with over = max(picture - 1, 0) at a quarter of the resolution and G a Gaussian
// with a width relative to the picture's height. The widest is faint: dust and haze around a fire, that join it to its room.

enum { SHRINK = 4, RADIUS_LIMIT = 800 }; // three widths of the widest, in a picture of 16,384 rows

/// One direction of a separable Gaussian; `step` is the distance between neighbours, `length` their number.
static void blur_line(const Float3 *in, Float3 *out, int length, size_t step, const float *weight, int radius) {
    for (int i = 0; i < length; i++) {
        Float3 sum = float3_scale(in[(size_t)i * step], weight[0]);
        for (int k = 1; k <= radius; k++) {
            if (i - k >= 0) sum = float3_mad(sum, in[(size_t)(i - k) * step], weight[k]);
            if (i + k < length) sum = float3_mad(sum, in[(size_t)(i + k) * step], weight[k]);
        }
        out[(size_t)i * step] = sum;
    }
}

void film_blur(Float3 *image, Float3 *scratch, int w, int h, float sigma) {
    float weight[RADIUS_LIMIT + 1], sum = 0;
    int radius = (int)ceilf(3 * sigma);
    radius = radius < 1 ? 1 : radius > RADIUS_LIMIT ? RADIUS_LIMIT : radius;
    for (int k = 0; k <= radius; k++) {
        weight[k] = expf(-0.5f * (float)(k * k) / (sigma * sigma));
        sum += k ? 2 * weight[k] : weight[k];
    }

    for (int k = 0; k <= radius; k++) weight[k] /= sum;
    for (int y = 0; y < h; y++) {
        size_t row = (size_t)y * (size_t)w;
        blur_line(image + row, scratch + row, w, 1, weight, radius);
    }

    for (int x = 0; x < w; x++) blur_line(scratch + x, image + x, h, (size_t)w, weight, radius);
}

typedef struct Halo {
    Preview *preview;
    const Float3 *glow;
    int w, h;
    float amount;
} Halo;

static void bloom_add(void *context, int part) {
    const Halo *halo = context;
    Preview *preview = halo->preview;
    const Float3 *glow = halo->glow;
    const int w = halo->w, h = halo->h, rows = preview->def.height;
    const float amount = halo->amount / preview->def.exposure;
    for (int y = rows * part / SHARE_PARTS; y < rows * (part + 1) / SHARE_PARTS; y++) {
        float gy = clampf(((float)y + 0.5f) / SHRINK - 0.5f, 0, (float)(h - 1));
        int y0 = (int)gy, y1 = y0 + 1 < h ? y0 + 1 : y0;
        for (int x = 0; x < preview->def.width; x++) {
            float gx = clampf(((float)x + 0.5f) / SHRINK - 0.5f, 0, (float)(w - 1));
            int x0 = (int)gx, x1 = x0 + 1 < w ? x0 + 1 : x0;
            const Float3 *top = glow + (size_t)y0 * (size_t)w, *bottom = glow + (size_t)y1 * (size_t)w;
            Float3 c = float3_mix(float3_mix(top[x0], top[x1], gx - (float)x0),
                                  float3_mix(bottom[x0], bottom[x1], gx - (float)x0), gy - (float)y0);
            Float3 *out = preview->picture + (size_t)y * (size_t)preview->def.width + (size_t)x;
            *out = float3_mad(*out, c, amount);
        }
    }
}

void bloom_apply(Preview *preview) {
    const int width = preview->def.width, height = preview->def.height;
    const float exposure = preview->def.exposure;
    int w = (width + SHRINK - 1) / SHRINK, h = (height + SHRINK - 1) / SHRINK;
    Float3 *glow = preview->glow[0], *scratch = preview->glow[1];
    bool any = false;

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            Float3 sum = {0, 0, 0};
            for (int j = y * SHRINK; j < (y + 1) * SHRINK && j < height; j++)
                for (int i = x * SHRINK; i < (x + 1) * SHRINK && i < width; i++) {
                    Float3 c = float3_scale(preview->picture[(size_t)j * (size_t)width + (size_t)i], exposure);

                    // only glow, not a white sheet in the sun
                    float peak = maxf(c.x, maxf(c.y, c.z)), over = maxf(peak - 1.1f, 0) / maxf(peak, 1e-6f);
                    sum = float3_mad(sum, c, over);
                }
            glow[(size_t)y * (size_t)w + (size_t)x] = float3_scale(sum, 1.0f / (SHRINK * SHRINK));
            any = any || sum.x + sum.y + sum.z > 0;
        }
    if (!any) return;

    static const float halo[3][3] = {
        {0.005f, 0.4f, 0.14f}, {0.022f, 0.8f, 0.10f}, {0.065f, 0.8f, 0.06f}}; // s, its least, k
    for (int k = 0; k < 3; k++) {
        film_blur(glow, scratch, w, h, maxf(halo[k][0] * (float)height / SHRINK, halo[k][1]));
        share_out(preview->def.thread_count, SHARE_PARTS, bloom_add, &(Halo){preview, glow, w, h, halo[k][2]});
    }
}

// ---- the film

// Radiance to bytes.
//
// Film curve: linear but for a short toe, f = x (1 - 0.4 exp(-x / 0.06)), and a long shoulder above s = 0.6, s + (1 - s)
// (1 - (1 + u/p)^-p) with u = (f - s) / (1 - s), p = 0.75. White paper in the sun, 0.8, becomes 0.72 (0.87 in sRGB), and
// the slope there is still 0.4, so that its wrinkles are visible; what is ten times as bright is not yet clipped, so the
// cores of flames are graded. Before it, each channel leaks into the others, as in film: a little where it is dim, and
// more the brighter it is. So the centre of a flame becomes pale, where a curve for each channel alone would clip all of
// it to the same yellow. Then IEC 61966-2-1 and one level of triangular dither.

enum { CURVE_COUNT = 4096 };
#define LEAK 0.02f        ///< of a dim colour
#define LEAK_BRIGHT 0.14f ///< what is added to it in the limit of bright colours
#define LEAK_HALF 3.0f    ///< brightness above 1 at which half of LEAK_BRIGHT is added

/// The curve and the encoding as one table over sqrt(x / CURVE_MAX): the curve is slow and smooth.
#define CURVE_MAX 16.0f

typedef struct Developing {
    const Preview *preview;
    uint8_t *rgb;
    float curve[CURVE_COUNT];
} Developing;

static void develop(void *context, int part) {
    const Developing *developing = context;
    const Preview *preview = developing->preview;
    const float *curve = developing->curve;
    uint8_t *rgb = developing->rgb;
    const size_t count = (size_t)preview->def.width * (size_t)preview->def.height, first = (size_t)part;
    for (size_t i = count * first / SHARE_PARTS; i < count * (first + 1) / SHARE_PARTS; i++) {
        Float3 c = float3_scale(preview->picture[i], preview->def.exposure);
        const float over = maxf(maxf(c.x, maxf(c.y, c.z)) - 1, 0);
        const float leak = LEAK + LEAK_BRIGHT * over * over / (over * over + LEAK_HALF * LEAK_HALF);
        const float mean = (c.x + c.y + c.z) / 3, channel[3] = {c.x, c.y, c.z};
        uint32_t key = (uint32_t)i * 3u + preview->def.seed * 0x9e3779b1u;
        for (uint32_t k = 0; k < 3; k++) {
            float x = mixf(channel[k], mean, leak);
            float at = sqrtf(clampf(x, 0, CURVE_MAX) / CURVE_MAX) * (CURVE_COUNT - 1);
            int j = (int)at < CURVE_COUNT - 2 ? (int)at : CURVE_COUNT - 2;
            float s = mixf(curve[j], curve[j + 1], at - (float)j);
            float dither = hash_unit(key + k) + hash_unit((key + k) ^ 0x68bc21ebu) - 1;
            rgb[3 * i + k] = (uint8_t)clampf(s * 255 + 0.5f + 0.7f * dither, 0, 255);
        }
    }
}

void tonemap_write(const Preview *preview, uint8_t *rgb) {
    const float shoulder = 0.6f, rest = 1 - shoulder;
    Developing developing = {.preview = preview, .rgb = rgb};
    for (int i = 0; i < CURVE_COUNT; i++) {
        float s = (float)i / (CURVE_COUNT - 1), x = s * s * CURVE_MAX;
        float f = x * (1 - 0.4f * expf(-x / 0.06f));
        float over = maxf(f - shoulder, 0) / rest;
        developing.curve[i] = srgb_encode(f < shoulder ? f : shoulder + rest * (1 - powf(1 + over / 0.75f, -0.75f)));
    }

    share_out(preview->def.thread_count, SHARE_PARTS, develop, &developing);
}

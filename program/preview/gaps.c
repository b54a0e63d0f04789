// What is seen through holes of char is darker than what lies beside it.
//
// Firelight and sky reach it through these holes only, smoke hangs there, and a film that is exposed for flames shows none of
// it. A map at a quarter of the resolution holds the share of char and its distance, smoothed over GAP_WIDTH. A point lies in
// a gap as far as char stands before it on opposite sides.

#include "preview/internal.h"

#include <string.h>

#define GAP_WIDTH 0.010f ///< m, at the middle of what burns
#define GAP_NEAR 0.003f  ///< m, from char to what lies so far behind that it is no part of it
#define GAP_FAR 0.02f    ///< and what is as dark as any

static int quarter(int pixels) { return (pixels + 3) / 4; }

/// The map's pixels for GAP_WIDTH.
static float gap_width(const Preview *preview) {
    const PreviewScene *scene = &preview->scene;
    const Float3 middle = float3_scale(float3_add(scene->low, scene->high), 0.5f);
    const float distance = float3_length(float3_sub(middle, preview->camera.eye));
    return clampf(GAP_WIDTH / maxf(4 * preview->camera.pixel * distance, 1e-6f), 1, 16);
}

void gaps_fill(Preview *preview) {
    const int width = preview->def.width, height = preview->def.height, w = quarter(width), h = quarter(height);
    Float3 *map = preview->glow[0];
    memset(map, 0, (size_t)w * (size_t)h * sizeof *map);
    bool any = false;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const Lit *lit = &preview->lit[(size_t)y * (size_t)width + (size_t)x];
            if (!(lit->burnt > 0) || lit->sheet < 0) continue;
            Float3 *sum = &map[(y / 4) * w + x / 4];
            sum->x += lit->burnt / 16;
            sum->y += lit->burnt / 16 * fabsf(lit->distance);
            any = true;
        }
    if (any) film_blur(map, preview->glow[1], w, h, gap_width(preview));
}

/// How much char stands before a point of that distance, as seen so far aside.
static float gap_side(const Preview *preview, float x, float y, float distance) {
    const int w = quarter(preview->def.width), h = quarter(preview->def.height);
    float fx, fy;
    const int i = noise_floor(clampf(x / 4 - 0.5f, 0, (float)(w - 1) - 0.01f), &fx);
    const int j = noise_floor(clampf(y / 4 - 0.5f, 0, (float)(h - 1) - 0.01f), &fy);
    if (i < 0 || j < 0 || i + 1 >= w || j + 1 >= h) return 0; // a picture of one quarter pixel
    const Float3 *at = preview->glow[0] + j * w + i;
    const Float3 char_at = float3_mix(float3_mix(at[0], at[1], fx), float3_mix(at[w], at[w + 1], fx), fy);
    if (char_at.x < 0.02f) return 0;
    return char_at.x * stepf(GAP_NEAR, GAP_FAR, distance - char_at.y / char_at.x);
}

float gap_at(const Preview *preview, int x, int y, const Lit *lit) {
    enum { PAIRS = 4, RINGS = 3 };
    // what cloth hangs on is sooty where it has burnt, however near
    const float distance = fabsf(lit->distance) + (lit->sheet < 0 ? 0.8f * GAP_FAR : 0);
    static const float direction[PAIRS][2] = {{0.92f, 0.38f}, {0.38f, 0.92f}, {-0.38f, 0.92f}, {-0.92f, 0.38f}};
    const float reach = 4 * 1.7f * gap_width(preview);
    float sum = 0;
    for (int k = 0; k < PAIRS; k++) {
        float side[2] = {0, 0};
        for (int s = 0; s < 2; s++)
            for (int ring = 1; ring <= RINGS; ring++) {
                const float far = (s ? -reach : reach) * (0.5f + 0.5f * (float)(ring * ring));
                side[s] = maxf(side[s], gap_side(preview, (float)x + 0.5f + far * direction[k][0],
                                                 (float)y + 0.5f + far * direction[k][1], distance));
            }
        sum += minf(side[0], side[1]);
    }
    return stepf(0.12f, 0.6f, sum / PAIRS);
}

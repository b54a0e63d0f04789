// What is seen through holes of char is darker than what lies beside it.
//
// Firelight and sky reach it through these holes only, smoke hangs there, and a film that is exposed for flames shows none of
// it. A map at a quarter of the resolution holds the share of char and its distance, smoothed over GAP_WIDTH. A point lies in
// a gap as far as char stands before it on opposite sides.

#include "preview/internal.h"

#include <string.h>

#define GAP_WIDTH 0.007f ///< m, at the middle of what burns
#define GAP_NEAR 0.008f  ///< m, from char to what lies so far behind that it is no part of it
#define GAP_FAR 0.03f    ///< and what is as dark as any

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
    int *box = preview->gaps;
    memcpy(box, (const int[4]){width, height, -1, -1}, sizeof preview->gaps);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const Lit *lit = &preview->lit[(size_t)y * (size_t)width + (size_t)x];
            if (!(lit->burnt > 0) || lit->sheet < 0) continue;
            Float3 *sum = &map[(y / 4) * w + x / 4];
            sum->x += lit->burnt / 16;
            sum->y += lit->burnt / 16 * fabsf(lit->distance);
            box[0] = x < box[0] ? x : box[0];
            box[1] = y < box[1] ? y : box[1];
            box[2] = x > box[2] ? x : box[2];
            box[3] = y;
        }
    if (box[3] >= 0) film_blur(map, preview->glow[1], w, h, gap_width(preview));
}

/// Char as seen at a place of the picture: its share, and that times its distance.
static Float3 gap_read(const Preview *preview, float x, float y) {
    const int w = quarter(preview->def.width), h = quarter(preview->def.height);
    float fx, fy;
    const int i = noise_floor(clampf(x / 4 - 0.5f, 0, (float)(w - 1) - 0.01f), &fx);
    const int j = noise_floor(clampf(y / 4 - 0.5f, 0, (float)(h - 1) - 0.01f), &fy);
    if (i < 0 || j < 0 || i + 1 >= w || j + 1 >= h) return float3(0, 0, 0); // a picture of one quarter pixel
    const Float3 *at = preview->glow[0] + j * w + i;
    return float3_mix(float3_mix(at[0], at[1], fx), float3_mix(at[w], at[w + 1], fx), fy);
}

float gap_at(const Preview *preview, int x, int y, const Lit *lit) {
    enum { PAIRS = 4, RINGS = 4 };
    static const float direction[PAIRS][2] = {{0.92f, 0.38f}, {0.38f, 0.92f}, {-0.38f, 0.92f}, {-0.92f, 0.38f}};
    // what cloth hangs on is sooty where it has burnt, however near
    const int *box = preview->gaps;
    if (x < box[0] || y < box[1] || x > box[2] || y > box[3] || lit->burnt > 0.95f) return 0;
    const float distance = fabsf(lit->distance) + (lit->sheet < 0 ? 0.9f * GAP_FAR : 0);
    const float reach = 4 * 1.3f * gap_width(preview), px = (float)x + 0.5f, py = (float)y + 0.5f;
    float first = 0, second = 0; // of the pairs: aslant a hole is narrow one way
    for (int k = 0; k < PAIRS; k++) {
        float most = 0;
        for (int ring = 1; ring <= RINGS; ring++) {
            const float far = reach * (0.5f + 0.5f * (float)(ring * ring)), dx = far * direction[k][0],
                        dy = far * direction[k][1];
            const Float3 a = gap_read(preview, px + dx, py + dy), b = gap_read(preview, px - dx, py - dy);
            const float share = minf(a.x, b.x);
            if (share < 0.02f) continue;
            const float before = 0.5f * (a.y / a.x + b.y / b.x); // of a plane through both
            most = maxf(most, share * stepf(GAP_NEAR, GAP_FAR, distance - before));
        }
        second = maxf(second, minf(first, most));
        first = maxf(first, most);
    }
    return stepf(0.1f, 0.6f, 0.5f * (first + second));
}

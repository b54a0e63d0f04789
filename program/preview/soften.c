// Where lens or shutter blur, a pixel's few samples differ, and it is noisy. But what they spread over many pixels has no
// finer detail: the noise is removed by non-local means (Buades, Coll & Morel 2005), with the variances that the samples
// tell (Rousselle, Knaus & Zwicker 2012). A pixel p becomes the mean of those q around it whose surroundings look alike,
//
//   w(p, q) = exp(-max(0, D)),   D = mean over the patch of ((c_p - c_q)^2 - (V_p + min(V_p, V_q))) / (V_p + V_q + e)
//
// with the colours c as c / (1 + l) and V the variance of a pixel's mean, itself the mean of its neighbours'. The window
// is no wider than the blur.

#include "preview/block.h"

enum { SOFT_REACH = 3, SOFT_PATCH = 1, SOFT_SIDE = BLOCK + 2 * (SOFT_REACH + SOFT_PATCH) };
static const float SOFT_LEAST = 2e-6f; ///< e

typedef struct Window {
    Four shown[SOFT_SIDE][SOFT_SIDE]; ///< the variance last
    float raw[SOFT_SIDE][SOFT_SIDE];
    size_t pixel[SOFT_SIDE][SOFT_SIDE];
} Window;

/// The pixels around a block; beyond the picture's edges those at the edge.
static void window_fill(const Preview *preview, const Block *block, Window *window) {
    const int w = preview->def.width, h = preview->def.height, margin = SOFT_REACH + SOFT_PATCH;
    for (int j = 0; j < SOFT_SIDE; j++)
        for (int i = 0; i < SOFT_SIDE; i++) {
            int x = block->x[0] + i - margin, y = block->y[0] + j - margin;
            x = x < 0 ? 0 : x < w ? x : w - 1;
            y = y < 0 ? 0 : y < h ? y : h - 1;
            const size_t pixel = (size_t)y * (size_t)w + (size_t)x;
            const Lit *lit = &preview->lit[pixel];
            const Float3 c = lit->light[SOFT_SHOWN];
            window->pixel[j][i] = pixel;
            window->raw[j][i] = lit->noise;
            window->shown[j][i] = (Four){c.x, c.y, c.z, lit->noise};
        }

    // variances of few samples are uncertain: the mean of 3 x 3
    for (int j = 1; j < SOFT_SIDE - 1; j++)
        for (int i = 1; i < SOFT_SIDE - 1; i++) {
            float sum = 0;
            for (int k = 0; k < 9; k++) sum += window->raw[j + k / 3 - 1][i + k % 3 - 1];
            window->shown[j][i][3] = sum / 9;
        }
}

/// D of two pixels of the window.
static float difference(const Window *window, float strong, int px, int py, int qx, int qy) {
    float sum = 0;
    for (int j = -SOFT_PATCH; j <= SOFT_PATCH; j++)
        for (int i = -SOFT_PATCH; i <= SOFT_PATCH; i++) {
            const Four p = window->shown[py + j][px + i], q = window->shown[qy + j][qx + i], d = p - q;
            const float square = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * (1.f / 3);
            sum += (square - (p[3] + minf(p[3], q[3]))) / (SOFT_LEAST + strong * strong * (p[3] + q[3]));
        }

    return sum * (1.f / 9);
}

void soften(Preview *preview, Block *block) {
    const int w = preview->def.width, h = preview->def.height, margin = SOFT_REACH + SOFT_PATCH;
    const Lit *first = &preview->lit[(size_t)block->y[0] * (size_t)w + (size_t)block->x[0]];
    if (!(first->blur > 1) || preview->def.samples >= SAMPLES_STILL) return;

    Window window;
    window_fill(preview, block, &window);
    const int reach = (int)minf(first->blur + 0.5f, SOFT_REACH);
    const float strong = 1.2f; // allowed difference, in standard deviations
    for (int lane = 0; lane < LANES; lane++) {
        if (block->x[lane] >= w || block->y[lane] >= h) continue;
        const int px = margin + lane % BLOCK, py = margin + lane / BLOCK;
        Float3 sum = {0, 0, 0};
        float total = 0;
        for (int j = -reach; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const float far = difference(&window, strong, px, py, px + i, py + j), weight = expf(-maxf(far, 0));
                sum = float3_mad(sum, preview->lit[window.pixel[py + j][px + i]].light[SOFT_COLOUR], weight);
                total += weight;
            }

        preview->picture[window.pixel[py][px]] = float3_scale(sum, 1 / total);
    }
}

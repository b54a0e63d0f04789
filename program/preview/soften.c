// Where lens or shutter blur, a pixel's few samples differ, and it is noisy. But what they spread over many pixels has no
// finer detail: the noise is removed by non-local means (Buades, Coll & Morel 2005), with the variances that the samples
// tell (Rousselle, Knaus & Zwicker 2012). A pixel p becomes the mean of those q around it whose surroundings look alike,
//
//   w(p, q) = exp(-max(0, D)),   D = mean over the patch of ((c_p - c_q)^2 - (V_p + min(V_p, V_q))) / (V_p + V_q + e)
//
// with the colours c as c / (1 + l) and V the variance of a pixel's mean, itself the mean of its neighbours'. The window
// is no wider than the blur.

#include "preview/block.h"

#include <string.h>

enum { SOFT_REACH = 3, SOFT_PATCH = 1, SOFT_MARGIN = SOFT_REACH + SOFT_PATCH, SOFT_SIDE = BLOCK + 2 * SOFT_MARGIN };
enum { SOFT_ROW = SOFT_SIDE + 4 };     ///< of a window, padded so that lines can be computed in eights
static const float SOFT_LEAST = 2e-6f; ///< e
static const float SOFT_STRONG = 1.6f; ///< allowed difference, in standard deviations

typedef struct Window {
    float colour[3][SOFT_SIDE][SOFT_ROW], shown[3][SOFT_SIDE][SOFT_ROW];
    float noise[SOFT_SIDE][SOFT_ROW], raw[SOFT_SIDE][SOFT_ROW];
} Window;

/// w(p, q) of all pixels p of the block and those q that lie (i, j) from them.
static void window_compare(const Window *window, int i, int j, float weight[BLOCK][BLOCK]) {
    enum { PATCHES = BLOCK + 2 * SOFT_PATCH, FIRST = SOFT_MARGIN - SOFT_PATCH, WIDE = 8 };
    float term[PATCHES][WIDE], beside[PATCHES][BLOCK];
    for (int y = 0; y < PATCHES; y++) {
        const int p = FIRST + y, q = p + j;
        for (int x = 0; x < WIDE; x++) {
            float square = 0;
            for (int c = 0; c < 3; c++) {
                const float d = window->shown[c][p][FIRST + x] - window->shown[c][q][FIRST + x + i];
                square += d * d;
            }
            const float vp = window->noise[p][FIRST + x], vq = window->noise[q][FIRST + x + i];
            term[y][x] =
                (square * (1.f / 3) - (vp + minf(vp, vq))) / (SOFT_LEAST + SOFT_STRONG * SOFT_STRONG * (vp + vq));
        }
        for (int x = 0; x < BLOCK; x++) beside[y][x] = term[y][x] + term[y][x + 1] + term[y][x + 2];
    }

    for (int y = 0; y < BLOCK; y++)
        for (int x = 0; x < BLOCK; x++) {
            // (1 - D / 16)^16, near enough to exp(-D)
            const float far = (beside[y][x] + beside[y + 1][x] + beside[y + 2][x]) * (1.f / 9);
            float near = clampf(1 - far * (1.f / 16), 0, 1);
            for (int square = 0; square < 4; square++) near *= near;
            weight[y][x] = near;
        }
}

void soften(Preview *preview, Block *block) {
    const int w = preview->def.width, h = preview->def.height;
    const Lit *first = &preview->lit[(size_t)block->y[0] * (size_t)w + (size_t)block->x[0]];
    if (!(first->blur > 1) || is_still(preview)) return;

    // the pixels around the block; beyond the picture's edges those at the edge
    Window window;
    memset(&window, 0, sizeof window);
    for (int j = 0; j < SOFT_SIDE; j++)
        for (int i = 0; i < SOFT_SIDE; i++) {
            int x = block->x[0] + i - SOFT_MARGIN, y = block->y[0] + j - SOFT_MARGIN;
            x = x < 0 ? 0 : x < w ? x : w - 1;
            y = y < 0 ? 0 : y < h ? y : h - 1;
            const Lit *lit = &preview->lit[(size_t)y * (size_t)w + (size_t)x];
            float colour[3], shown[3];
            float3_store(colour, lit->light[SOFT_COLOUR]);
            float3_store(shown, lit->light[SOFT_SHOWN]);
            for (int c = 0; c < 3; c++) {
                window.colour[c][j][i] = colour[c];
                window.shown[c][j][i] = shown[c];
            }
            window.raw[j][i] = lit->noise;
        }

    // variances of few samples are uncertain: the mean of 3 x 3
    for (int j = 1; j < SOFT_SIDE - 1; j++)
        for (int i = 1; i < SOFT_SIDE - 1; i++) {
            float sum = 0;
            for (int k = 0; k < 9; k++) sum += window.raw[j + k / 3 - 1][i + k % 3 - 1];
            window.noise[j][i] = sum / 9;
        }

    const int reach = (int)minf(first->blur + 0.5f, SOFT_REACH);
    float sum[4][BLOCK][BLOCK] = {{{0}}}; // the last is of the weights

    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++) {
            float weight[BLOCK][BLOCK];
            window_compare(&window, i, j, weight);
            for (int y = 0; y < BLOCK; y++)
                for (int x = 0; x < BLOCK; x++) {
                    const int row = SOFT_MARGIN + y + j, column = SOFT_MARGIN + x + i;
                    for (int c = 0; c < 3; c++) sum[c][y][x] += weight[y][x] * window.colour[c][row][column];
                    sum[3][y][x] += weight[y][x];
                }
        }

    for (int k = 0; k < LANES; k++) {
        if (block->x[k] >= w || block->y[k] >= h) continue;
        const int x = k % BLOCK, y = k / BLOCK;
        const Float3 colour = float3(sum[0][y][x], sum[1][y][x], sum[2][y][x]);
        preview->picture[block_pixel(preview, block, k)] = float3_scale(colour, 1 / sum[3][y][x]);
    }
}

// What fire leaves on the ground: the stain where burning sheets lay.
//
// A grid on the ground holds L, how near sheets lay at the start, and per frame W, where they are still whole: triangles
// that have not burnt, drawn by their rest positions, which are those of the start. The stain is L (1 - W), and under
// burnt sheets it is how near they lie now; both smoothed over STAIN_SOFT, as heat and tar spread in the ground. So a
// frame needs no earlier one. Burning sheets draw together while they burn, so L fades towards a sheet's border.

#include "preview/internal.h"

#include <string.h>

enum {
    STAIN_LIMIT = 320, ///< cells along a side
    STAIN_RIM = 14,    ///< of them free around the sheets
    STAIN_REACH = 24,  ///< cells over which a mean is taken, to each side
};
#define STAIN_CELL 0.8e-3f ///< m, the least
#define STAIN_SOFT 2.2e-3f ///< m
#define STAIN_INSET 0.07f  ///< of a sheet's larger side, over which its border fades
#define STAIN_NEAR 1.5e-3f ///< m above the ground: what lies there stains fully
#define STAIN_FAR 9e-3f    ///< and what is as high not at all

/// Raises the cells whose centres lie in the triangle to `value`.
static void stain_triangle(Stain *stain, float *grid, const float *a, const float *b, const float *c, float value) {
    if (value <= 0) return;
    const float *corner[3] = {a, b, c};
    float at[3][2];
    int low[2], high[2];
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 2; d++) at[k][d] = (corner[k][d] - stain->corner[d]) / stain->cell - 0.5f;
    for (int d = 0; d < 2; d++) {
        float limit = (float)stain->size[d];
        low[d] = (int)ceilf(clampf(minf(at[0][d], minf(at[1][d], at[2][d])), 0, limit));
        high[d] = (int)clampf(maxf(at[0][d], maxf(at[1][d], at[2][d])), -1, limit - 1);
    }

    float area = (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]);
    float side = area < 0 ? -1.0f : 1.0f;
    for (int y = low[1]; y <= high[1]; y++)
        for (int x = low[0]; x <= high[0]; x++) {
            bool in = true;
            for (int k = 0; k < 3 && in; k++) {
                const float *p = at[k], *q = at[(k + 1) % 3];
                in = side * ((q[0] - p[0]) * ((float)y - p[1]) - (q[1] - p[1]) * ((float)x - p[0])) >= -1e-3f;
            }
            float *cell = &grid[y * stain->size[0] + x];
            if (in) *cell = maxf(*cell, value);
        }
}

/// How near the triangle lies to the ground, 0 to 1.
static float stain_nearness(const Preview *preview, const float *a, const float *b, const float *c) {
    float height = (a[2] + b[2] + c[2]) / 3 - preview->def.ground_height;
    return height < -STAIN_NEAR ? 0 : 1 - stepf(STAIN_NEAR, STAIN_FAR, height);
}

static size_t stain_count(const Stain *stain) { return (size_t)stain->size[0] * (size_t)stain->size[1]; }

/// Means over a line of cells `step` apart.
static void stain_smooth_line(const float *from, float *to, int count, size_t step, int reach) {
    float sum = 0;
    for (int i = -reach; i < count; i++) {
        if (i + reach < count) sum += from[(size_t)(i + reach) * step];
        if (i - reach > 0) sum -= from[(size_t)(i - reach - 1) * step];
        if (i >= 0) to[(size_t)i * step] = sum / (float)(2 * reach + 1);
    }
}

/// Smooths a grid over about `width` m to each side. Uses the second grid.
static void stain_smooth(Stain *stain, float *grid, float width) {
    const size_t across = (size_t)stain->size[0];
    float *scratch = stain->grids[1];
    int reach = (int)clampf(width / stain->cell + 0.5f, 1, STAIN_REACH);
    for (int pass = 0; pass < 2; pass++) {
        for (int y = 0; y < stain->size[1]; y++)
            stain_smooth_line(grid + (size_t)y * across, scratch + (size_t)y * across, stain->size[0], 1, reach);
        for (int x = 0; x < stain->size[0]; x++)
            stain_smooth_line(scratch + x, grid + x, stain->size[1], across, reach);
    }
}

SingeResult stain_create(Preview *preview, SingeError *error) {
    Stain *stain = &preview->stain;
    const PreviewDef *def = &preview->def;
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    if (!def->starts || !(def->ground_stain > 0) || !isfinite(def->ground_height)) return SINGE_OK;

    for (uint32_t s = 0; s < def->sheet_count; s++)
        for (uint32_t v = 0; v < def->starts[s].vertex_count; v++)
            for (int d = 0; d < 2; d++) {
                low[d] = minf(low[d], def->starts[s].positions[3 * (size_t)v + (size_t)d]);
                high[d] = maxf(high[d], def->starts[s].positions[3 * (size_t)v + (size_t)d]);
            }
    float extent = maxf(high[0] - low[0], high[1] - low[1]);
    if (!(extent > 0 && extent < 1e4f)) return SINGE_OK;

    stain->cell = maxf(extent / (STAIN_LIMIT - 2 * STAIN_RIM), STAIN_CELL);
    for (int d = 0; d < 2; d++) {
        stain->corner[d] = low[d] - STAIN_RIM * stain->cell;
        stain->size[d] = 2 * STAIN_RIM + 1 + (int)((high[d] - low[d]) / stain->cell);
    }

    for (int k = 0; k < 3; k++) {
        stain->grids[k] = allocator_resize(preview->allocator, NULL, 0, stain_count(stain) * sizeof(float));
        if (!stain->grids[k]) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for the ground");
        memset(stain->grids[k], 0, stain_count(stain) * sizeof(float));
    }

    for (uint32_t s = 0; s < def->sheet_count; s++)
        for (uint32_t cell = 0; cell < def->starts[s].cell_count; cell++) {
            const float *p[4];
            for (int k = 0; k < 4; k++)
                p[k] = def->starts[s].positions + 3 * (size_t)def->starts[s].cells[4 * cell + (uint32_t)k];
            for (int k = 0; k < 2; k++)
                stain_triangle(stain, stain->grids[0], p[0], p[k + 1], p[k + 2],
                               stain_nearness(preview, p[0], p[k + 1], p[k + 2]));
        }
    stain_smooth(stain, stain->grids[0], STAIN_INSET * extent);
    for (size_t i = 0; i < stain_count(stain); i++) stain->grids[0][i] = stepf(0.5f, 1, stain->grids[0][i]);
    return SINGE_OK;
}

void stain_fill(Preview *preview) {
    Stain *stain = &preview->stain;
    const PreviewScene *scene = &preview->scene;
    if (!stain->grids[0]) return;
    float *whole = stain->grids[1], *stained = stain->grids[2];
    memset(whole, 0, stain_count(stain) * sizeof *whole);
    memset(stained, 0, stain_count(stain) * sizeof *stained);

    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t *v = scene->triangles[t];
        const PaperVertex *a = &scene->vertices[v[0]], *b = &scene->vertices[v[1]], *c = &scene->vertices[v[2]];
        const float *p = scene->positions[v[0]], *q = scene->positions[v[1]], *r = scene->positions[v[2]];
        float burnt = stepf(0.05f, 0.5f, (a->burn + b->burn + c->burn) / 3);
        stain_triangle(stain, whole, a->rest, b->rest, c->rest, 1 - burnt);
        if (burnt > 0) stain_triangle(stain, stained, p, q, r, 0.8f * burnt * stain_nearness(preview, p, q, r));
    }

    for (size_t i = 0; i < stain_count(stain); i++) stained[i] = maxf(stained[i], stain->grids[0][i] * (1 - whole[i]));

    stain_smooth(stain, stained, STAIN_SOFT);
}

/// One of the grids at a point, 0 outside.
static float stain_read(const Preview *preview, int grid, float x, float y) {
    const Stain *stain = &preview->stain;
    if (!stain->grids[0]) return 0;
    float fx, fy;
    int i = noise_floor((x - stain->corner[0]) / stain->cell - 0.5f, &fx);
    int j = noise_floor((y - stain->corner[1]) / stain->cell - 0.5f, &fy);
    if (i < 0 || j < 0 || i >= stain->size[0] - 1 || j >= stain->size[1] - 1) return 0;
    const float *at = stain->grids[grid] + j * stain->size[0] + i, *above = at + stain->size[0];
    return mixf(mixf(at[0], at[1], fx), mixf(above[0], above[1], fx), fy);
}

bool stain_may_be(const Preview *preview, float x, float y) { return stain_read(preview, 0, x, y) > 0; }

float stain_at(const Preview *preview, float x, float y) { return stain_read(preview, 2, x, y); }

void stain_free(Preview *preview) {
    for (int k = 0; k < 3; k++)
        if (preview->stain.grids[k])
            allocator_resize(preview->allocator, preview->stain.grids[k], stain_count(&preview->stain) * sizeof(float),
                             0);
    preview->stain = (Stain){.size = {0, 0}};
}

// Shared by the tests of fire: pictures of gas, and a line of burning paper with the gas above it.
#pragma once

#include "fixture.h"

/// A camera at the height of the flames, looking along y at nothing but the background.
static inline PreviewDef aside(float background) {
    PreviewDef def = small();
    def.camera = (PreviewCamera){.eye = {0, -0.5f, 0.2f}, .target = {0, 0, 0.2f}, .up = {0, 0, 1}, .fov = 0.5f};
    def.ground_height = -INFINITY;
    for (int c = 0; c < 3; c++) def.background[c] = background;
    return def;
}

static inline float luminance(const float *c) { return 0.21f * c[0] + 0.72f * c[1] + 0.07f * c[2]; }

enum { LONG = 40, WIDE = 16, DEEP = 4, COLUMN = WIDE * DEEP * LONG };

/// A line of fire on a strip of paper at z = 0, 13 cm along x: the whole of a box of cells of 8 mm burns. The paper is
/// `above` m higher than the box's lowest middles. Over the paper the heat falls by e in 2.2 cm, as it does over
/// examples/letter.
typedef struct Line {
    float temperature[COLUMN], smoke[COLUMN], flame[COLUMN], velocity[COLUMN][3];
    SingeGas gas;
} Line;

static inline void line_make(Line *l, float above) {
    const float cell = 0.008f;
    memset(l, 0, sizeof *l);
    l->gas = (SingeGas){.size = {WIDE, DEEP, LONG},
                        .cell = cell,
                        .origin = {-0.5f * WIDE * cell, -0.5f * DEEP * cell, -0.5f * cell - above},
                        .temperature = l->temperature,
                        .smoke = l->smoke,
                        .flame = l->flame,
                        .velocity = (const float(*)[3])l->velocity};
    for (int i = 0; i < COLUMN; i++) {
        int z = i / (WIDE * DEEP), y = i / WIDE % DEEP, x = i % WIDE;
        bool in = (y == 1 || y == 2) && x > 0 && x < WIDE - 1;
        l->temperature[i] = in ? 1400 : 293, l->flame[i] = in ? 5e6f * expf(-0.36f * (float)z) : 0;
        l->velocity[i][2] = 1;
    }
}

typedef struct Burning {
    float position[4 * WIDE][3], normal[4 * WIDE][3], uv[4 * WIDE][2], rest[4 * WIDE][3], temperature[4 * WIDE];
    float burn[4 * WIDE], rate[4 * WIDE];
    int32_t sheet[4 * WIDE];
    uint32_t triangles[2 * WIDE][3];
    SingeSurface surface;
} Burning;

/// Paper that burns along that line: a quad in each cell.
static inline void burning_make(Burning *b) {
    memset(b, 0, sizeof *b);
    for (int k = 0; k < WIDE; k++) {
        Float4 q;
        quad_make(&q, 0.003f, 0);
        for (int i = 0; i < 4; i++) {
            int v = 4 * k + i;
            memcpy(b->position[v], q.position[i], sizeof q.position[i]), memcpy(b->normal[v], q.normal[i], 12);
            b->position[v][0] += 0.008f * ((float)k + 0.5f - 0.5f * WIDE), b->position[v][1] += 0.004f;
            memcpy(b->rest[v], b->position[v], 12);
            b->temperature[v] = 293, b->rate[v] = 1;
        }

        for (int t = 0; t < 2; t++)
            for (int c = 0; c < 3; c++) b->triangles[2 * k + t][c] = q.triangles[t][c] + 4 * (uint32_t)k;
    }

    b->surface = SURFACE_OF(b, rest, temperature, 4 * WIDE, 2 * WIDE);
}

/// The fire's layer of that line from the side; row 0 of `mean` is the paper's height, others are a mm higher each.
static inline void see_line(const SingeSurface *surface, const SingeGas *gas, double time, float (*fire)[4],
                            float (*mean)[4], int rows) {
    PreviewDef def = aside(0.02f);

    // a mm is a pixel
    def.camera = (PreviewCamera){
        .eye = {0, -1, H / 2000.0f}, .target = {0, 0, H / 2000.0f}, .up = {0, 0, 1}, .fov = 2 * atanf(H / 2000.0f)};
    PreviewLayers layers = {.fire = fire};
    draw_layers(&def, surface, gas, time, &layers);
    for (int row = 0; row < rows; row++)
        for (int c = 0; c < 4; c++) {
            mean[row][c] = 0;
            for (int x = 0; x < W; x++) mean[row][c] += fire[(H - 1 - row) * W + x][c] / W;
        }
}

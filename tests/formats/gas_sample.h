// A gas made by formula: a hot column that leans, thicker than a block of cells, in a box of odd sizes.
#pragma once

#include <math.h>
#include <stdlib.h>

#include "formats/formats.h"

typedef struct GasSample {
    SingeGas gas;
    float *temperature, *smoke, *flame;
    float (*velocity)[3];
} GasSample;

/// Arrays come from malloc; free with gas_sample_free.
static inline bool gas_sample_make(GasSample *s, uint32_t nx, uint32_t ny, uint32_t nz) {
    size_t count = (size_t)nx * ny * nz;
    *s = (GasSample){.temperature = malloc(count * sizeof(float)),
                     .smoke = malloc(count * sizeof(float)),
                     .flame = malloc(count * sizeof(float)),
                     .velocity = malloc(count * sizeof(float[3]))};
    if (!s->temperature || !s->smoke || !s->flame || !s->velocity) return false;

    s->gas = (SingeGas){.size = {nx, ny, nz},
                        .origin = {-0.1f, -0.07f, 0.013f},
                        .cell = 0.008f,
                        .temperature = s->temperature,
                        .smoke = s->smoke,
                        .flame = s->flame,
                        .velocity = (const float(*)[3])s->velocity};
    for (size_t i = 0; i < count; i++) {
        float x = (float)(i % nx) - 0.4f * (float)nx, y = (float)(i / nx % ny) - 0.5f * (float)ny;
        float z = (float)(i / nx / ny), across = expf(-0.12f * ((x - 0.2f * z) * (x - 0.2f * z) + y * y));
        s->temperature[i] = 293.15f + 1500 * across * expf(-0.05f * z);
        s->smoke[i] = 1e-4f * across;
        s->flame[i] = 2e6f * across * expf(-0.01f * z * z);
        s->velocity[i][0] = 0.2f * across, s->velocity[i][1] = -0.01f * y, s->velocity[i][2] = 1.5f * across;
    }

    return true;
}

static inline void gas_sample_free(GasSample *s) {
    free(s->temperature), free(s->smoke), free(s->flame), free(s->velocity);
}

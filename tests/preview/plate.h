// A plate of paper: a grid of vertices in the plane, which share their triangles, so that it has borders and a middle.
#pragma once

#include "fixture.h"

/// A sheet of PLATE_SIDE x PLATE_SIDE vertices in the plane, which share their triangles.
enum { PLATE_SIDE = 17, NODES = PLATE_SIDE * PLATE_SIDE };

typedef struct Plate {
    float position[NODES][3], normal[NODES][3], uv[NODES][2], temperature[NODES], peak[NODES], burn[NODES], rate[NODES];
    float ignited[NODES], mass[NODES], charred[NODES], ash[NODES];
    int32_t sheet[NODES];
    uint32_t triangles[2 * (PLATE_SIDE - 1) * (PLATE_SIDE - 1)][3];
    SingeSurface surface;
} Plate;

static inline void plate_make(Plate *plate, float width) {
    memset(plate, 0, sizeof *plate);
    for (int i = 0; i < NODES; i++) {
        plate->position[i][0] = width * ((float)(i % PLATE_SIDE) / (PLATE_SIDE - 1) - 0.5f);
        plate->position[i][1] = width * ((float)(i / PLATE_SIDE) / (PLATE_SIDE - 1) - 0.5f);
        plate->normal[i][2] = 1;
        plate->temperature[i] = plate->peak[i] = 293;
    }

    uint32_t count = 0;
    for (uint32_t i = 0; i + PLATE_SIDE < NODES; i++) {
        if (i % PLATE_SIDE == PLATE_SIDE - 1) continue;
        const uint32_t pair[2][3] = {{i, i + 1, i + PLATE_SIDE + 1}, {i, i + PLATE_SIDE + 1, i + PLATE_SIDE}};
        memcpy(plate->triangles[count], pair, sizeof pair);
        count += 2;
    }
    plate->surface = SURFACE_OF(plate, position, peak, NODES, count);
    plate->surface.time_ignited = plate->ignited;
}

/// What a plate of char burns at: alone, without fuel, or with some in a flame.
static inline void plate_char(Plate *plate, float temperature, float rate, float fuel) {
    for (int i = 0; i < NODES; i++) {
        plate->charred[i] = 0.2f, plate->mass[i] = 0.2f + fuel;
        plate->burn[i] = 0.8f, plate->temperature[i] = plate->peak[i] = temperature, plate->rate[i] = rate;
    }
    plate->surface.mass = plate->mass, plate->surface.char_fraction = plate->charred;
    plate->surface.ash_fraction = plate->ash;
}

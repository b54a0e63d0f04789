// Heat on a still sheet: the grid on which it is measured, and how fast a hot spot spreads.
#pragma once

#include "page/lab.h"

static const double WARM_DIFFUSIVITY = 1e-4, WARM_MEAN = 600, WARM_AMPLITUDE = 300; // m2/s, K, K

/// Insulated, nothing burns; the temperature is WARM_MEAN plus WARM_AMPLITUDE times the field.
LabGrid warm_grid(int across, int along, float cell, SingeHeatOperator operator);

typedef struct SpotMesh {
    const char *name;
    int cells[2];
    float sides[2], jitter;
} SpotMesh;

/// The diffusivity along x and y at which a hot spot spreads, over WARM_DIFFUSIVITY.
SINGE_NODISCARD SingeResult spot_spread(Lab *lab, const SpotMesh *mesh, SingeHeatOperator operator, double ratio[2],
                                        SingeError *error);

// Heights of cells' centres over their corners, in lanes (layer_order.c, height_kernel.h).
#pragma once

#include "shell/field.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Cells of one family: no two share a corner.
typedef struct HeightLanes {
    float *position;             ///< m, quadruples; fourth: inverse mass
    const uint32_t *cells;       ///< of the family
    const uint32_t (*corner)[4]; ///< [cells]
    const uint8_t *flags;        ///< [cells]
    uint32_t first_centre;       ///< the particle that is cell 0's centre
    Field thickness;             ///< m
    float min, gain;             ///< height_min, height_gain
} HeightLanes;

/// Corrects cells [begin, end) of the family. Whether all are twice as high as they must be.
typedef bool HeightRange(const HeightLanes *job, uint32_t begin, uint32_t end);
HeightRange height_range_four, height_range_v3, height_range_v4;

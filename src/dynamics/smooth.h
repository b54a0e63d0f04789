// Internal friction in lanes (smooth.c, smooth_kernel.h).
#pragma once

#include "dynamics/strand/strand_lanes.h"

typedef struct SmoothLanes {
    const StrandSet *set;
    const float *position; ///< [4 particles] m, fourth: inverse mass
    float *velocity;       ///< [4 particles] m/s
    float share;           ///< of a second difference that goes
} SmoothLanes;

/// The strands of a group that is not `apart`.
typedef void SmoothGroup(const SmoothLanes *job, uint32_t group);
SmoothGroup smooth_group_four, smooth_group_v3, smooth_group_v4;

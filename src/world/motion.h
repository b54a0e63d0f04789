// Points that move in straight lines from their positions at one time to positions that a caller sets for another.
#pragma once

#include "common/error.h"
#include "common/float3.h"
#include "common/memory.h"

typedef struct Motion {
    uint32_t count;
    float (*from)[3], (*to)[3]; ///< [count] m; NULL: no motion
    double start, end;          ///< s; at `from` before, at `to` after
} Motion;

/// Creates points at rest at `points`. False when out of memory; nothing stays allocated then.
bool motion_create(Memory *memory, uint32_t count, const float *points, Motion *motion);
void motion_free(Memory *memory, Motion *motion);

/// Moves the points from their positions at `now` to `to` at `time`; at once if that is not later.
void motion_set(Motion *motion, const float *to, double now, double time);

/// Share of the displacement that is completed, 0 to 1.
float motion_share(const Motion *motion, double time);

static inline Float3 motion_point(const Motion *motion, uint32_t i, float share) {
    Float3 from = float3_load(motion->from[i]), to = float3_load(motion->to[i]);
    return share < 1 ? float3_mad(from, float3_sub(to, from), share) : to;
}

/// Fails with the point that is not finite or beyond `max` m.
SingeResult motion_check(uint32_t count, const float *points, float max, const char *owner, SingeError *error);

// The pass over particles between two projections, in vectors (move.c, move_kernel.h).
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Quadruples of all particles, and what is the same for all.
typedef struct MoveLanes {
    float *position;     ///< m; fourth: inverse mass, 0 for what does not move
    float *velocity;     ///< m/s; fourth: 0
    float *predicted;    ///< m
    const float *normal; ///< unit; fourth: 1/m, k of the quadratic drag
    const float *air;    ///< m/s; fourth: 1/s, damping. Of number i & air_mask
    size_t air_mask;     ///< 0: the same for all, as many as a vector holds
    float *start;        ///< m, what the next prediction adds; not used where `share` is 0
    float *given;        ///< m, what the last projection has added to its start
    float share;         ///< of what this projection has added, for the next start, ...
    float share_before;  ///< ... and of what the one before had added
    float h, inverse_h;  ///< s, 1/s
    float keep;          ///< share of the velocity that damping leaves, where it is the same for all
    float fall[4];       ///< m/s, of gravity in a substep; fourth: 0
    bool kept;           ///< `start` is that of the substep that ends already
    bool drags, damps;   ///< some have drag; damping differs
} MoveLanes;

/// Particles [begin, end). What neither closes nor opens a substep keeps their starts.
typedef void MoveRange(const MoveLanes *job, size_t begin, size_t end, bool closes, bool opens);
MoveRange move_range_four, move_range_v3, move_range_v4;

/// Makes normals unit vectors, but those of 0. Their fourth numbers stay.
typedef void UnitRange(float (*normal)[4], uint32_t count);
UnitRange unit_range_four, unit_range_v3, unit_range_v4;

// The grid's cubes.
#pragma once

#include "collision/collision_plan.h"

typedef Float4Mask Cube; ///< three whole numbers

/// Rounds down; positions too far for whole numbers share the last cube.
static inline Cube collision_cube(const CollisionPlan *plan, Float4 p) {
    Float4 max = float4_all(1e9f), q = float4_max(float4_min(p * plan->inverse_edge, max), -max);
    Cube whole = __builtin_convertvector(q, Cube);
    return whole + (__builtin_convertvector(whole, Float4) > q); // a mask is -1
}

/// Number of cubes from one to another; more than `max` also where two of them would have one key, or a position is not
/// finite.
static inline uint64_t collision_cubes(Cube first, Cube last, uint64_t max) {
    uint64_t x = (uint64_t)((int64_t)last[0] - first[0]) + 1, y = (uint64_t)((int64_t)last[1] - first[1]) + 1;
    uint64_t z = (uint64_t)((int64_t)last[2] - first[2]) + 1;
    if (x - 1 > 1022 || y - 1 > 1022 || z - 1 > 510 || x * y * z > max) return max + 1;
    return x * y * z;
}

/// Cubes with the same key are so far apart that no box is in two of them.
static inline uint32_t collision_key(Cube cube) {
    return ((uint32_t)cube[0] & 1023) | ((uint32_t)cube[1] & 1023) << 10 | ((uint32_t)cube[2] & 511) << 20;
}
enum { COLLISION_KEY = (1 << 29) - 1 };

/// Consecutive cubes along x have consecutive buckets: nearby entries are contiguous.
static inline uint32_t collision_bucket(const CollisionPlan *plan, uint32_t key) {
    uint32_t h = key >> 10;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return ((h ^ h >> 16) + (key & 1023)) & (plan->bucket_count - 1);
}

static inline bool quads_meet(Float4 low_a, Float4 high_a, Float4 low_b, Float4 high_b) {
    return !(float4_bits((low_a > high_b) | (low_b > high_a)) & 7);
}

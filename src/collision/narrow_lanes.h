// Four vectors at once, and boxes around a cell's four triangles, sides and lines to its centroid.
#pragma once

#include "common/float4.h"

typedef struct FourVectors {
    Float4 x, y, z;
} FourVectors;

static inline FourVectors four_all(Float4 a) {
    return (FourVectors){float4_all(a[0]), float4_all(a[1]), float4_all(a[2])};
}
static inline FourVectors four_minus(FourVectors a, FourVectors b) {
    return (FourVectors){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline FourVectors four_plus(FourVectors a, FourVectors b) {
    return (FourVectors){a.x + b.x, a.y + b.y, a.z + b.z};
}
/// a + s b
static inline FourVectors four_along(FourVectors a, Float4 s, FourVectors b) {
    return (FourVectors){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
static inline Float4 four_dot(FourVectors a, FourVectors b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline FourVectors four_cross(FourVectors a, FourVectors b) {
    return (FourVectors){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline FourVectors four_min(FourVectors a, FourVectors b) {
    return (FourVectors){float4_min(a.x, b.x), float4_min(a.y, b.y), float4_min(a.z, b.z)};
}
static inline FourVectors four_max(FourVectors a, FourVectors b) {
    return (FourVectors){float4_max(a.x, b.x), float4_max(a.y, b.y), float4_max(a.z, b.z)};
}

static inline FourVectors four_of(const Float4 rows[4]) {
    Float4 q[4] = {rows[0], rows[1], rows[2], rows[3]};
    float4_transpose(q);
    return (FourVectors){q[0], q[1], q[2]};
}

/// 1, 2, 3, 0
static inline FourVectors four_turned(FourVectors a) {
    return (FourVectors){FLOAT4_SHUFFLE(a.x, a.x, 1, 2, 3, 0), FLOAT4_SHUFFLE(a.y, a.y, 1, 2, 3, 0),
                         FLOAT4_SHUFFLE(a.z, a.z, 1, 2, 3, 0)};
}

static inline float float4_smallest(Float4 a) {
    Float4 b = float4_min(a, FLOAT4_SHUFFLE(a, a, 2, 3, 0, 1));
    return float4_min(b, FLOAT4_SHUFFLE(b, b, 1, 0, 3, 2))[0];
}
static inline float float4_largest(Float4 a) {
    Float4 b = float4_max(a, FLOAT4_SHUFFLE(a, a, 2, 3, 0, 1));
    return float4_max(b, FLOAT4_SHUFFLE(b, b, 1, 0, 3, 2))[0];
}
static inline float float4_sum(Float4 a) { return (a[0] + a[1]) + (a[2] + a[3]); }

static inline Float4 four_lane(FourVectors a, int lane) { return (Float4){a.x[lane], a.y[lane], a.z[lane], 0}; }

typedef struct FourBoxes {
    FourVectors low, high;
} FourBoxes;

/// Bit k is set where box k meets the box from `low` to `high`.
static inline unsigned four_meet(const FourBoxes *four, Float4 low, Float4 high) {
    Float4Mask meet = (four->low.x <= float4_all(high[0])) & (four->high.x >= float4_all(low[0]));
    meet &= (four->low.y <= float4_all(high[1])) & (four->high.y >= float4_all(low[1]));
    meet &= (four->low.z <= float4_all(high[2])) & (four->high.z >= float4_all(low[2]));
    return float4_bits(meet);
}

/// Boxes around the sides, the lines to the centroid, and the triangles of a cell whose corners and centroid are somewhere
/// from `low` to `high`.
static inline FourBoxes narrow_sides(FourVectors low, FourVectors high) {
    return (FourBoxes){four_min(low, four_turned(low)), four_max(high, four_turned(high))};
}
static inline FourBoxes narrow_spokes(FourVectors low, FourVectors high, Float4 centroid_low, Float4 centroid_high) {
    return (FourBoxes){four_min(low, four_all(centroid_low)), four_max(high, four_all(centroid_high))};
}
static inline FourBoxes narrow_triangles(FourVectors low, FourVectors high, Float4 centroid_low, Float4 centroid_high) {
    const FourBoxes sides = narrow_sides(low, high);
    return narrow_spokes(sides.low, sides.high, centroid_low, centroid_high);
}

/// Bit k: triangle or side k has one of the corners `bits`.
static inline unsigned narrow_around(unsigned bits) { return (bits | bits << 3 | bits >> 1) & 15; }

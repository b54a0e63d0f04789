// Four vectors at once, and boxes around a cell's four triangles, sides and lines to its middle.
#ifndef COLLISION_NARROW_LANES_H
#define COLLISION_NARROW_LANES_H

#include "common/float4.h"

typedef struct FourVectors {
    Quad x, y, z;
} FourVectors;

static inline FourVectors four_all(Quad a) { return (FourVectors){quad_all(a[0]), quad_all(a[1]), quad_all(a[2])}; }
static inline FourVectors four_plus(FourVectors a, FourVectors b) {
    return (FourVectors){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline FourVectors four_minus(FourVectors a, FourVectors b) {
    return (FourVectors){a.x - b.x, a.y - b.y, a.z - b.z};
}
/// a + s b
static inline FourVectors four_along(FourVectors a, Quad s, FourVectors b) {
    return (FourVectors){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
static inline Quad four_dot(FourVectors a, FourVectors b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline FourVectors four_cross(FourVectors a, FourVectors b) {
    return (FourVectors){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline FourVectors four_min(FourVectors a, FourVectors b) {
    return (FourVectors){quad_min(a.x, b.x), quad_min(a.y, b.y), quad_min(a.z, b.z)};
}
static inline FourVectors four_max(FourVectors a, FourVectors b) {
    return (FourVectors){quad_max(a.x, b.x), quad_max(a.y, b.y), quad_max(a.z, b.z)};
}

static inline FourVectors four_of(const Quad rows[4]) {
    Quad q[4] = {rows[0], rows[1], rows[2], rows[3]};
    quad_transpose(q);
    return (FourVectors){q[0], q[1], q[2]};
}

/// 1, 2, 3, 0
static inline FourVectors four_turned(FourVectors a) {
    return (FourVectors){QUAD_SHUFFLE(a.x, a.x, 1, 2, 3, 0), QUAD_SHUFFLE(a.y, a.y, 1, 2, 3, 0),
                         QUAD_SHUFFLE(a.z, a.z, 1, 2, 3, 0)};
}

static inline float quad_least(Quad a) {
    Quad b = quad_min(a, QUAD_SHUFFLE(a, a, 2, 3, 0, 1));
    return b[0] < b[1] ? b[0] : b[1];
}
static inline float quad_most(Quad a) {
    Quad b = quad_max(a, QUAD_SHUFFLE(a, a, 2, 3, 0, 1));
    return b[0] > b[1] ? b[0] : b[1];
}
static inline float quad_sum(Quad a) { return (a[0] + a[1]) + (a[2] + a[3]); }

typedef struct FourBoxes {
    FourVectors low, high;
} FourBoxes;

/// Bit k is set where box k meets the box from `low` to `high`.
static inline unsigned four_meet(const FourBoxes *four, Quad low, Quad high) {
    QuadMask meet = (four->low.x <= quad_all(high[0])) & (four->high.x >= quad_all(low[0]));
    meet &= (four->low.y <= quad_all(high[1])) & (four->high.y >= quad_all(low[1]));
    meet &= (four->low.z <= quad_all(high[2])) & (four->high.z >= quad_all(low[2]));
    return quad_bits(meet);
}

typedef struct TouchBoxes {
    FourBoxes triangles, sides, spokes;
} TouchBoxes;

/// Of a cell whose corners and middle are somewhere from `low` to `high`.
static inline void touch_boxes(FourVectors low, FourVectors high, Quad middle_low, Quad middle_high, TouchBoxes *out) {
    FourVectors least = four_all(middle_low), most = four_all(middle_high);
    out->sides = (FourBoxes){four_min(low, four_turned(low)), four_max(high, four_turned(high))};
    out->spokes = (FourBoxes){four_min(low, least), four_max(high, most)};
    out->triangles = (FourBoxes){four_min(out->sides.low, least), four_max(out->sides.high, most)};
}

/// Bit k: triangle or side k has one of the corners `bits`.
static inline unsigned touch_around(unsigned bits) { return (bits | bits << 3 | bits >> 1) & 15; }

#endif

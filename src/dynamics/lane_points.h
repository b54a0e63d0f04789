// Points and vectors of every lane, for kernels. A file per instruction set defines the operations on lanes and
// quadruples, as for strand_kernel.h, before it includes this.
#pragma once

#include "common/float3.h"

typedef struct LanePoint {
    Lanes x, y, z;
} LanePoint;

static inline LanePoint points_all(Float3 a) { return (LanePoint){lanes_all(a.x), lanes_all(a.y), lanes_all(a.z)}; }
static inline LanePoint points_of(LaneNode a) { return (LanePoint){a.x, a.y, a.z}; }
static inline LanePoint points_add(LanePoint a, LanePoint b) { return (LanePoint){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline LanePoint points_sub(LanePoint a, LanePoint b) { return (LanePoint){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline LanePoint points_mad(LanePoint a, LanePoint b, Lanes s) {
    return (LanePoint){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
static inline LanePoint points_scale(LanePoint a, Lanes s) { return (LanePoint){a.x * s, a.y * s, a.z * s}; }
static inline Lanes points_dot(LanePoint a, LanePoint b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline LanePoint points_cross(LanePoint a, LanePoint b) {
    return (LanePoint){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The particles of nodes, moved to points: four by four, transposing undoes what float4s_node does.
static inline Float4s points_put(LanePoint point, LaneNode node) {
    Float4s columns, particles;
    FLOAT4S_SET(columns, 0, point.x);
    FLOAT4S_SET(columns, 1, point.y);
    FLOAT4S_SET(columns, 2, point.z);
    FLOAT4S_SET(columns, 3, node.w);
    const LaneNode rows = float4s_node(&columns);
    FLOAT4S_SET(particles, 0, rows.x);
    FLOAT4S_SET(particles, 1, rows.y);
    FLOAT4S_SET(particles, 2, rows.z);
    FLOAT4S_SET(particles, 3, rows.w);
    return particles;
}

/// `yes` where a < b.
static inline LanePoint points_where_less(Lanes a, Lanes b, LanePoint yes, LanePoint no) {
    return (LanePoint){lanes_where_less(a, b, yes.x, no.x), lanes_where_less(a, b, yes.y, no.y),
                       lanes_where_less(a, b, yes.z, no.z)};
}

// A bounding volume hierarchy (BVH) over triangles, and packets of rays against it.
//
// Rays run side by side, as those of a block of pixels see much the same part of it. What is found depends neither
// on the instruction set nor on the number of threads.
#pragma once

#include "common/float3.h"
#include "singe/base.h"

#include <stdbool.h>
#include <stdint.h>

enum { LANES = 16 }; ///< rays in a packet: a block of 4 x 4 pixels

#define BVH_NONE UINT32_MAX

/// Rays. A lane whose `far` lies below its `near` meets nothing.
typedef struct Rays {
    _Alignas(64) float origin[3][LANES], direction[3][LANES];
    float near[LANES], far[LANES];
    float time[LANES]; ///< within the exposure, 0 to 1
} Rays;

/// Where rays meet triangles (p, q, r): at (1 - u - v) p + u q + v r.
typedef struct Hits {
    _Alignas(64) uint32_t triangle[LANES]; ///< BVH_NONE: nothing was met
    float u[LANES], v[LANES];
    float normal[3][LANES]; ///< of any length, to either side
} Hits;

/// Triangles that a BVH is built over. Rays see them between their two positions, at their own time.
typedef struct BvhMesh {
    const float *positions[2]; ///< when the exposure begins and ends; equal if nothing moves
    size_t stride;             ///< floats from a vertex to the next
    const uint32_t (*triangles)[3];
    uint32_t triangle_count;
    int threads; ///< that may build it; 0: one
} BvhMesh;

typedef struct BvhNode {
    float low[3];
    uint32_t first; ///< a leaf's first triangle, or the first of two children that follow each other
    float high[3];
    uint16_t count; ///< triangles of a leaf; 0: two children
    uint16_t axis;  ///< along which the second child lies behind the first
} BvhNode;

typedef struct BvhTriangle {
    float corners[3][3];
    uint32_t triangle; ///< of the mesh
} BvhTriangle;

typedef struct Bvh Bvh;

/// Decides on a ray that meets a triangle: true stops it.
typedef bool BvhStops(void *context, int lane, uint32_t triangle, float u, float v);

/// Rays and what they meet: the nearest triangles, in `hits`, or all, by `stops`, where that is NULL.
typedef struct BvhQuery {
    Rays *rays;
    Hits *hits;
    BvhStops *stops;
    void *context;
} BvhQuery;

typedef void BvhWalk(const Bvh *bvh, const BvhQuery *query);

struct Bvh {
    BvhNode *nodes;
    BvhTriangle *triangles; ///< in the order of the leaves
    float (*ends)[3][3];    ///< the corners when the exposure ends, if anything moves
    uint32_t triangle_count, capacity, end_capacity;
    bool moves;
    BvhWalk *walk; ///< for this machine's instruction set
};

/// Positions must be finite. Returns false, and leaves the BVH empty, when memory runs out. The mesh is not kept.
bool bvh_build(Bvh *bvh, SingeAllocator allocator, const BvhMesh *mesh);
void bvh_free(Bvh *bvh, SingeAllocator allocator);

static inline Float3 rays_origin(const Rays *rays, int lane) {
    return float3(rays->origin[0][lane], rays->origin[1][lane], rays->origin[2][lane]);
}

static inline Float3 rays_direction(const Rays *rays, int lane) {
    return float3(rays->direction[0][lane], rays->direction[1][lane], rays->direction[2][lane]);
}

static inline void aim_ray(Rays *rays, int lane, Float3 origin, Float3 direction, float near, float far, float time) {
    const float o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
    for (int k = 0; k < 3; k++) {
        rays->origin[k][lane] = o[k];
        rays->direction[k][lane] = d[k];
    }
    rays->near[lane] = near;
    rays->far[lane] = far;
    rays->time[lane] = time;
}

static inline void rest_ray(Rays *rays, int lane) { aim_ray(rays, lane, float3(0, 0, 0), float3(0, 0, 1), 0, -1, 0); }

/// The nearest triangle of each ray; moves its `far` there.
void bvh_nearest(const Bvh *bvh, Rays *rays, Hits *hits);

/// Shows `stops` what each ray meets, in any order, until it stops the ray, whose `far` becomes -1.
void bvh_pass(const Bvh *bvh, Rays *rays, BvhStops *stops, void *context);

// Packets of rays against a BVH, for the instruction set of the file that includes it; BVH_WALK names what comes out.
//
// A node's box is tested when the node's turn has come, against what the rays have met until then. Edges are tested by
// their Plücker coordinates with a ray, which are exactly opposite in two triangles that share an edge, so that no ray
// slips through between them (Davidovič et al. 2012, "3D rasterization: a bridge between rasterization and ray casting").
#include "preview/bvh_packets.h"
#include "preview/wide.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    PARTS = LANES / WIDTH,
    PART = (1 << WIDTH) - 1, ///< bits of a part's lanes
    STACK = 96,              ///< deeper than any BVH
};

/// The rays of a part.
typedef struct Part {
    Wide3 origin, direction, inverse;
    Wide near, far, time;
} Part;

typedef struct Packet {
    Part parts[PARTS];
    const Bvh *bvh;
    const BvhQuery *query;
} Packet;

static inline Wide3 wide3_sub(Wide3 a, Wide3 b) { return (Wide3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Wide3 wide3_add(Wide3 a, Wide3 b) { return (Wide3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Wide wide3_dot(Wide3 a, Wide3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Wide3 wide3_cross(Wide3 a, Wide3 b) {
    return (Wide3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// 1 / x, large but finite at 0 so that no 0 times infinity follows.
static inline Wide wide_inverse(Wide x) {
    const WideMask tiny = (x < 1e-12f) & (x > -1e-12f);
    return 1 / wide_select(tiny, wide_all(1e-12f), x);
}

static inline Wide3 wide3_load(float from[3][LANES], int lane) {
    return (Wide3){wide_load(&from[0][lane]), wide_load(&from[1][lane]), wide_load(&from[2][lane])};
}

/// Bits of the rays of a part that pass a box between near and far.
static inline unsigned part_box(const Part *part, const BvhNode *node) {
    const Wide x0 = (node->low[0] - part->origin.x) * part->inverse.x;
    const Wide x1 = (node->high[0] - part->origin.x) * part->inverse.x;
    const Wide y0 = (node->low[1] - part->origin.y) * part->inverse.y;
    const Wide y1 = (node->high[1] - part->origin.y) * part->inverse.y;
    const Wide z0 = (node->low[2] - part->origin.z) * part->inverse.z;
    const Wide z1 = (node->high[2] - part->origin.z) * part->inverse.z;
    const Wide enter = wide_max(wide_max(wide_min(x0, x1), wide_min(y0, y1)), wide_max(wide_min(z0, z1), part->near));
    const Wide leave = wide_min(wide_min(wide_max(x0, x1), wide_max(y0, y1)), wide_min(wide_max(z0, z1), part->far));

    // a distance errs by a few units in its last place
    return wide_bits(enter <= leave * (1 + 8 * FLT_EPSILON));
}

/// A corner from the eye of each ray, at its time.
static inline Wide3 part_corner(const Part *part, const float *from, const float *to) {
    Wide3 corner = {from[0] - part->origin.x, from[1] - part->origin.y, from[2] - part->origin.z};
    if (!to) return corner;
    const Wide3 way = {part->time * (to[0] - from[0]), part->time * (to[1] - from[1]), part->time * (to[2] - from[2])};
    return wide3_add(corner, way);
}

/// The rays of a part against the i-th triangle of the leaves.
static inline void part_triangle(Packet *packet, int index, uint32_t i) {
    Part *part = &packet->parts[index];
    const BvhTriangle *triangle = &packet->bvh->triangles[i];
    const float(*from)[3] = triangle->corners, (*to)[3] = packet->bvh->moves ? packet->bvh->ends[i] : NULL;
    const Wide3 p = part_corner(part, from[0], to ? to[0] : NULL);
    const Wide3 q = part_corner(part, from[1], to ? to[1] : NULL);
    const Wide3 r = part_corner(part, from[2], to ? to[2] : NULL);
    const Wide3 rp = wide3_sub(r, p), pq = wide3_sub(p, q), qr = wide3_sub(q, r);

    // the volumes that a ray spans with the edges have one sign inside
    const Wide u = wide3_dot(wide3_cross(rp, wide3_add(r, p)), part->direction);
    const Wide v = wide3_dot(wide3_cross(pq, wide3_add(p, q)), part->direction);
    const Wide w = wide3_dot(wide3_cross(qr, wide3_add(q, r)), part->direction);
    const Wide sum = u + v + w, error = wide_max(sum, -sum) * FLT_EPSILON;
    const WideMask inside = (wide_min(wide_min(u, v), w) >= -error) | (wide_max(wide_max(u, v), w) <= error);
    if (!wide_bits(inside)) return;

    const Wide3 normal = wide3_cross(rp, pq);
    const Wide slope = wide3_dot(normal, part->direction), distance = wide3_dot(normal, p) / slope;
    const WideMask met = inside & (slope != 0) & (distance > part->near) & (distance <= part->far);
    unsigned bits = wide_bits(met);
    if (!bits) return;

    const Wide share = 1 / sum, us = wide_min(u * share, wide_all(1)), vs = wide_min(v * share, wide_all(1));
    const int lane = WIDTH * index;
    const BvhQuery *query = packet->query;
    if (query->hits) {
        Hits *hits = query->hits;
        const Wide number = (Wide)((WideMask){0} + (int32_t)triangle->triangle);
        part->far = wide_select(met, distance, part->far);
        float *const out[6] = {(float *)(void *)&hits->triangle[lane],
                               &hits->u[lane],
                               &hits->v[lane],
                               &hits->normal[0][lane],
                               &hits->normal[1][lane],
                               &hits->normal[2][lane]};
        const Wide found[6] = {number, us, vs, normal.x, normal.y, normal.z};
        for (int k = 0; k < 6; k++) wide_store(out[k], wide_select(met, found[k], wide_load(out[k])));
        return;
    }

    float at[2][WIDTH], far[WIDTH];
    wide_store(at[0], us);
    wide_store(at[1], vs);
    wide_store(far, part->far);
    for (; bits; bits &= bits - 1) {
        const int k = __builtin_ctz(bits);
        if (query->stops(query->context, lane + k, triangle->triangle, at[0][k], at[1][k])) far[k] = -1;
    }
    part->far = wide_load(far);
}

void BVH_WALK(const Bvh *bvh, const BvhQuery *query) {
    Packet packet;
    packet.bvh = bvh;
    packet.query = query;
    Rays *rays = query->rays;
    uint32_t stack[STACK];
    unsigned live[STACK], wanted = 0;
    int depth = 0;

    for (int k = 0; k < PARTS; k++) {
        Part *part = &packet.parts[k];
        const int lane = WIDTH * k;
        part->origin = wide3_load(rays->origin, lane);
        part->direction = wide3_load(rays->direction, lane);
        part->inverse =
            (Wide3){wide_inverse(part->direction.x), wide_inverse(part->direction.y), wide_inverse(part->direction.z)};
        part->near = wide_load(&rays->near[lane]);
        part->far = wide_load(&rays->far[lane]);
        part->time = wide_load(&rays->time[lane]);
        wanted |= wide_bits(part->near <= part->far) << lane;
    }
    if (!wanted) return;

    // the children nearer to the first ray come first
    const int leader = __builtin_ctz(wanted);
    bool back[3];
    for (int k = 0; k < 3; k++) back[k] = rays->direction[k][leader] < 0;

    stack[0] = 0;
    live[0] = wanted;
    depth = 1;
    while (depth) {
        const BvhNode *node = &bvh->nodes[stack[--depth]];
        unsigned bits = 0;
        for (int k = 0; k < PARTS; k++)
            if (live[depth] >> (WIDTH * k) & PART) bits |= part_box(&packet.parts[k], node) << (WIDTH * k);
        if (!bits) continue;

        if (!node->count) {
            const uint32_t second = back[node->axis] ? 0 : 1;
            stack[depth] = node->first + second;
            stack[depth + 1] = node->first + 1 - second;
            live[depth] = live[depth + 1] = bits;
            depth += 2;
            continue;
        }
        for (uint32_t i = node->first; i < node->first + node->count; i++)
            for (int k = 0; k < PARTS; k++)
                if (bits >> (WIDTH * k) & PART) part_triangle(&packet, k, i);
    }

    for (int k = 0; k < PARTS; k++) wide_store(&rays->far[WIDTH * k], packet.parts[k].far);
}

// Builds a BVH top down, at the cheapest of sixteen planes by the areas of what lies on either side (Wald
// 2007, "On fast construction of SAH-based bounding volume hierarchies").
#include "preview/bvh.h"

#include "common/allocator.h"
#include "preview/render_math.h"
#include "preview/bvh_packets.h"
#include "preview/share.h"

enum {
    BVH_BINS = 16,
    BVH_LEAF = 8,   ///< triangles at most, if they can be parted
    BVH_EVEN = 40,  ///< depth from which nodes are halved by number
    BVH_DEPTH = 80, ///< 2^32 triangles halved from there on
};

typedef struct BvhBox {
    float low[3], high[3];
} BvhBox;

/// A node that waits: its triangles are order[first] up to order[end]. Of n triangles come at most 2 n - 2 nodes below it: so
/// many are kept for them from `below` on, and it does not matter which thread makes them.
typedef struct BvhRange {
    uint32_t node, below, first, end;
    int depth;
} BvhRange;

enum { BVH_PARTS = 64 }; ///< of a BVH, for threads

typedef struct BvhBuild {
    Bvh *bvh;
    BvhBox *boxes;   ///< [triangle_count]
    uint32_t *order; ///< [triangle_count]
    BvhRange parts[BVH_PARTS];
    int part_count;
} BvhBuild;

/// Where to part a range; `axis` < 0: it stays whole.
typedef struct BvhPlane {
    int axis, bin;
    float low, scale; ///< of the bins
} BvhPlane;

static const BvhBox EMPTY = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void box_add(BvhBox *box, const BvhBox *other) {
    for (int k = 0; k < 3; k++) {
        box->low[k] = minf(box->low[k], other->low[k]);
        box->high[k] = maxf(box->high[k], other->high[k]);
    }
}

static float box_area(const BvhBox *box) {
    const float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1], z = box->high[2] - box->low[2];
    return x * y + y * z + z * x;
}

static float box_middle(const BvhBox *box, int axis) { return box->low[axis] + box->high[axis]; }

static int plane_bin(const BvhPlane *plane, const BvhBox *box) {
    const int bin = (int)((box_middle(box, plane->axis) - plane->low) * plane->scale);
    return bin < BVH_BINS ? bin : BVH_BINS - 1;
}

/// The plane of least cost across the widest axis of the middles.
static BvhPlane find_plane(const BvhBuild *build, const BvhRange *range, const BvhBox *bounds) {
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = range->first; i < range->end; i++)
        for (int k = 0; k < 3; k++) {
            const float middle = box_middle(&build->boxes[build->order[i]], k);
            low[k] = minf(low[k], middle);
            high[k] = maxf(high[k], middle);
        }

    BvhPlane plane = {.axis = 0};
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[plane.axis] - low[plane.axis]) plane.axis = k;
    const float extent = high[plane.axis] - low[plane.axis];
    plane.low = low[plane.axis];
    plane.scale = BVH_BINS / extent;
    if (!(extent > 0) || !(plane.scale < INFINITY)) return (BvhPlane){.axis = -1};

    BvhBox boxes[BVH_BINS];
    uint32_t counts[BVH_BINS] = {0};
    for (int b = 0; b < BVH_BINS; b++) boxes[b] = EMPTY;
    for (uint32_t i = range->first; i < range->end; i++) {
        const BvhBox *box = &build->boxes[build->order[i]];
        const int bin = plane_bin(&plane, box);
        counts[bin]++;
        box_add(&boxes[bin], box);
    }

    // costs of what lies behind each plane, then of what lies before it
    float behind[BVH_BINS];
    BvhBox sum = EMPTY;
    uint32_t count = 0;
    for (int b = BVH_BINS - 1; b > 0; b--) {
        box_add(&sum, &boxes[b]);
        count += counts[b];
        behind[b] = count ? box_area(&sum) * (float)count : 0;
    }
    float best = INFINITY;
    sum = EMPTY;
    count = 0;
    for (int b = 0; b < BVH_BINS - 1; b++) {
        box_add(&sum, &boxes[b]);
        count += counts[b];
        const float cost = (count ? box_area(&sum) * (float)count : 0) + behind[b + 1];
        if (!(cost < best)) continue;
        best = cost;
        plane.bin = b;
    }

    // testing a box costs about as much as testing a triangle
    const uint32_t all = range->end - range->first;
    if (all <= BVH_LEAF && !(best + box_area(bounds) < box_area(bounds) * (float)all)) plane.axis = -1;
    return plane;
}

/// Makes a node and those below it. Nodes of at most so many triangles become parts, as long as there is room.
static void build_nodes(BvhBuild *build, BvhRange top, uint32_t most_of_part) {
    BvhRange waiting[BVH_DEPTH];
    int count = 0;
    waiting[count++] = top;

    while (count) {
        const BvhRange range = waiting[--count];
        const uint32_t all = range.end - range.first;
        if (all <= most_of_part && build->part_count < BVH_PARTS) {
            build->parts[build->part_count++] = range;
            continue;
        }
        BvhNode *node = &build->bvh->nodes[range.node];
        BvhBox bounds = EMPTY;
        for (uint32_t i = range.first; i < range.end; i++) box_add(&bounds, &build->boxes[build->order[i]]);
        *node = (BvhNode){.low = {bounds.low[0], bounds.low[1], bounds.low[2]},
                          .high = {bounds.high[0], bounds.high[1], bounds.high[2]}};

        BvhPlane plane = {.axis = -1};
        if (all > 2 && range.depth < BVH_EVEN) plane = find_plane(build, &range, &bounds);
        if (plane.axis < 0 && all <= BVH_LEAF) {
            node->first = range.first;
            node->count = (uint16_t)all;
            continue;
        }

        // what lies before the plane comes to the front; middles that agree are halved by number
        uint32_t middle = plane.axis < 0 ? range.first + all / 2 : range.first;
        for (uint32_t end = range.end; plane.axis >= 0 && middle < end;) {
            const uint32_t triangle = build->order[middle];
            if (plane_bin(&plane, &build->boxes[triangle]) <= plane.bin) {
                middle++;
            } else {
                build->order[middle] = build->order[--end];
                build->order[end] = triangle;
            }
        }
        node->first = range.below;
        node->axis = (uint16_t)(plane.axis < 0 ? 0 : plane.axis);
        const uint32_t below = range.below + 2, beyond = range.below + 2 * (middle - range.first);
        waiting[count++] = (BvhRange){range.below, below, range.first, middle, range.depth + 1};
        waiting[count++] = (BvhRange){range.below + 1, beyond, middle, range.end, range.depth + 1};
    }
}

static void build_part(void *context, int k) {
    BvhBuild *build = context;
    build_nodes(build, build->parts[k], 0);
}

static void corners_of(const BvhMesh *mesh, int end, uint32_t triangle, float corners[3][3]) {
    for (int c = 0; c < 3; c++) {
        const float *position = mesh->positions[end] + mesh->stride * mesh->triangles[triangle][c];
        for (int k = 0; k < 3; k++) corners[c][k] = position[k];
    }
}

bool bvh_build(Bvh *bvh, SingeAllocator allocator, const BvhMesh *mesh) {
    const uint32_t count = mesh->triangle_count;
    const bool moves = mesh->positions[0] != mesh->positions[1];
    bvh->triangle_count = 0;
    if (!count) return true;

    BvhBuild build = {.bvh = bvh};
    build.boxes = allocator_resize(allocator, NULL, 0, count * sizeof *build.boxes);
    build.order = allocator_resize(allocator, NULL, 0, count * sizeof *build.order);
    if (bvh->capacity < count || (moves && bvh->end_capacity < count)) {
        bvh_free(bvh, allocator);
        bvh->nodes = allocator_resize(allocator, NULL, 0, 2 * (size_t)count * sizeof *bvh->nodes);
        bvh->triangles = allocator_resize(allocator, NULL, 0, count * sizeof *bvh->triangles);
        bvh->capacity = count;
        if (moves) bvh->ends = allocator_resize(allocator, NULL, 0, count * sizeof *bvh->ends);
        if (moves) bvh->end_capacity = count;
    }
    const bool room = bvh->nodes && bvh->triangles && (!moves || bvh->ends) && build.boxes && build.order;
    if (!room) bvh_free(bvh, allocator);

    for (uint32_t t = 0; room && t < count; t++) {
        build.order[t] = t;
        build.boxes[t] = EMPTY;
        for (int end = 0; end < (moves ? 2 : 1); end++) {
            float corners[3][3];
            corners_of(mesh, end, t, corners);
            for (int c = 0; c < 3; c++) {
                BvhBox point;
                memcpy(point.low, corners[c], sizeof point.low);
                memcpy(point.high, corners[c], sizeof point.high);
                box_add(&build.boxes[t], &point);
            }
        }
    }

    if (room) {
        bvh->triangle_count = count;
        build_nodes(&build, (BvhRange){0, 1, 0, count, 0}, mesh->threads > 1 ? count / 12 : 0);
        share_out(mesh->threads, build.part_count, build_part, &build);
        for (uint32_t i = 0; i < count; i++) {
            bvh->triangles[i].triangle = build.order[i];
            corners_of(mesh, 0, build.order[i], bvh->triangles[i].corners);
            if (moves) corners_of(mesh, 1, build.order[i], bvh->ends[i]);
        }
        bvh->moves = moves;
        bvh->walk = bvh_walk(SINGE_INSTRUCTIONS_BEST);
    }

    allocator_resize(allocator, build.boxes, count * sizeof *build.boxes, 0);
    allocator_resize(allocator, build.order, count * sizeof *build.order, 0);
    return room;
}

void bvh_free(Bvh *bvh, SingeAllocator allocator) {
    allocator_resize(allocator, bvh->nodes, 2 * (size_t)bvh->capacity * sizeof *bvh->nodes, 0);
    allocator_resize(allocator, bvh->triangles, bvh->capacity * sizeof *bvh->triangles, 0);
    allocator_resize(allocator, bvh->ends, bvh->end_capacity * sizeof *bvh->ends, 0);
    *bvh = (Bvh){0};
}

void bvh_nearest(const Bvh *bvh, Rays *rays, Hits *hits) {
    for (int i = 0; i < LANES; i++) hits->triangle[i] = BVH_NONE;
    if (bvh->triangle_count) bvh->walk(bvh, &(BvhQuery){.rays = rays, .hits = hits});
}

void bvh_pass(const Bvh *bvh, Rays *rays, BvhStops *stops, void *context) {
    if (bvh->triangle_count) bvh->walk(bvh, &(BvhQuery){.rays = rays, .stops = stops, .context = context});
}

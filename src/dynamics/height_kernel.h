// Heights of as many cells' centres over their corners as there are lanes: see layer_order.c. One file per instruction
// set defines the operations on lanes and quadruples, as for strand_kernel.h, and includes this.
#include "dynamics/height.h"
#include "dynamics/lane_points.h"
#include "shell/shell.h"

/// Max correction at once, over the square root of |n|, which is 1.4 cells: otherwise shells thicker than their cells
/// would be thrown about.
#define HEIGHT_MAX 0.05f

/// The cells of the lanes: their nodes, corners and then centres, and what the heights must be.
typedef struct HeightCells {
    uint32_t node[5][LANES]; ///< four times the particle
    float enough[LANES];     ///< m
    float alive[LANES];      ///< 1 or 0
} HeightCells;

/// `count` cells of the family from number `first` on; lanes beyond repeat the last one.
static inline void height_cells(const HeightLanes *job, uint32_t first, uint32_t count, HeightCells *cells) {
    for (uint32_t lane = 0; lane < LANES; lane++) {
        const uint32_t cell = job->cells[first + (lane < count ? lane : count - 1)];
        const uint32_t centre = job->first_centre + cell;
        for (int i = 0; i < 4; i++) cells->node[i][lane] = 4 * job->corner[cell][i];
        cells->node[4][lane] = 4 * centre;
        cells->enough[lane] = job->min * field_at(job->thickness, centre);
        cells->alive[lane] = job->flags[cell] & SINGE_ALIVE;
    }
}

/// 1 where a height is enough, by its square: `above` is the height times |n|, `square` is |n|^2.
static inline Lanes height_is_enough(Lanes above, Lanes square, Lanes enough) {
    const Lanes zero = lanes_all(0), one = lanes_all(1);
    const Lanes far = lanes_where_less(above * above, enough * enough * square, zero, one);
    return lanes_where_less(zero, above, far, zero);
}

/// Moves the lanes' nodes by shares of a correction, where the weight is not 0.
static inline void height_move(const HeightLanes *job, const uint32_t *node, LaneNode at, Lanes weight,
                               LanePoint correction, Lanes share) {
    const LanePoint old = points_of(at), moved = points_mad(old, correction, share);
    const Float4s particles = points_put(points_where_less(lanes_all(0), weight, moved, old), at);
    float4s_scatter(job->position, node, &particles);
}

/// Corrects the cells of the lanes. Whether all are twice as high as they must be.
static inline bool height_lanes(const HeightLanes *job, uint32_t first, uint32_t count) {
    const Lanes zero = lanes_all(0), one = lanes_all(1);
    HeightCells cells;
    LaneNode node[5];
    height_cells(job, first, count, &cells);
    for (int i = 0; i < 5; i++) {
        const Float4s particles = float4s_gather(job->position, cells.node[i]);
        node[i] = float4s_node(&particles);
    }

    // heights
    const LanePoint p0 = points_of(node[0]), p1 = points_of(node[1]), p2 = points_of(node[2]), p3 = points_of(node[3]);
    const LanePoint normal = points_cross(points_sub(p2, p0), points_sub(p3, p1));
    const LanePoint sum = points_add(points_add(p0, p1), points_add(p2, p3));
    const LanePoint off = points_sub(points_of(node[4]), points_scale(sum, lanes_all(0.25f)));
    const Lanes above = points_dot(off, normal), square = points_dot(normal, normal);
    const Lanes enough = lanes_load(cells.enough), alive = lanes_load(cells.alive);
    const Lanes twice = height_is_enough(above, square, lanes_all(2) * enough);
    if (!lanes_any_less(lanes_where_less(zero, alive, twice, one), one)) return true;

    // too low: project them
    const Lanes high = height_is_enough(above, square, enough);
    Lanes weight = node[4].w + (node[0].w + node[1].w + node[2].w + node[3].w) / lanes_all(16);
    weight = lanes_where_less(zero, square, lanes_where_less(zero, alive, weight, zero), zero);
    weight = lanes_where_less(high, one, weight, zero);
    if (!lanes_any_less(zero, weight)) return false;

    const Lanes length = lanes_sqrt(square), missing = enough - above / length;
    const Lanes max = lanes_all(HEIGHT_MAX) * lanes_sqrt(length);
    const Lanes least = lanes_where_less(missing, max, missing, max);
    const LanePoint correction = points_scale(normal, lanes_all(job->gain) * least / (weight * length));
    for (int i = 0; i < 4; i++)
        height_move(job, cells.node[i], node[i], weight, correction, lanes_all(-0.25f) * node[i].w);
    height_move(job, cells.node[4], node[4], weight, correction, node[4].w);
    return false;
}

bool HEIGHT_RANGE(const HeightLanes *given, uint32_t begin, uint32_t end) {
    const HeightLanes local = *given, *job = &local; // of its own, so that stores cannot change it
    bool all_high = true;
    uint32_t k = begin;
    for (; k + LANES <= end; k += LANES) all_high &= height_lanes(job, k, LANES);
#ifdef HEIGHT_NARROWER
    if (k < end) all_high &= HEIGHT_NARROWER(job, k, end);
#else
    if (k < end) all_high &= height_lanes(job, k, end - k);
#endif
    return all_high;
}

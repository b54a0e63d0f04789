// Heights of as many cells' centres over their corners as there are lanes: see layer_order.c. One file per instruction
// set defines the operations on lanes and quadruples, as for strand_kernel.h, and includes this.
#include "dynamics/height.h"
#include "dynamics/lane_points.h"
#include "shell/shell.h"

/// Max correction at once, over the square root of |n|, which is 1.4 cells: otherwise shells thicker than their cells
/// would be thrown about.
#define HEIGHT_MAX 0.05f

/// The cells of the lanes: their nodes, corners and then centres, and what the heights must be, where that varies.
typedef struct HeightCells {
    uint32_t node[5][LANES]; ///< four times the particle
    float enough[LANES];     ///< m
    float alive[LANES];      ///< 1 or 0
} HeightCells;

/// `count` cells of the family from number `first` on; lanes beyond repeat the last one. Whether all are alive.
static inline bool height_cells(const HeightLanes *job, uint32_t first, uint32_t count, HeightCells *cells) {
    uint8_t all = SINGE_ALIVE;
    for (uint32_t lane = 0; lane < LANES; lane++) {
        const uint32_t cell = job->cells[first + (lane < count ? lane : count - 1)];
        const uint32_t centre = job->first_centre + cell;
        for (int i = 0; i < 4; i++) cells->node[i][lane] = 4 * job->corner[cell][i];
        cells->node[4][lane] = 4 * centre;
        if (job->thickness.mask) cells->enough[lane] = job->min * field_at(job->thickness, centre);
        cells->alive[lane] = job->flags[cell] & SINGE_ALIVE;
        all &= job->flags[cell];
    }
    return all;
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
    const Lanes zero = lanes_all(0), ones = lanes_all(1);
    HeightCells cells;
    Float4s p[5];
    const bool all = height_cells(job, first, count, &cells);
    for (int i = 0; i < 5; i++) p[i] = float4s_gather(job->position, cells.node[i]);

    // heights: differences as quadruples, so that three are turned into lanes and not five
    const Float4s one = float4s_sub(&p[2], &p[0]), two = float4s_sub(&p[3], &p[1]);
    const Float4s front = float4s_add(&p[0], &p[1]), back = float4s_add(&p[2], &p[3]), sum = float4s_add(&front, &back);
    const Float4s twice_p = float4s_add(&p[4], &p[4]), four = float4s_add(&twice_p, &twice_p);
    const Float4s off4 = float4s_sub(&four, &sum);
    const LanePoint normal = points_cross(points_of(float4s_node(&one)), points_of(float4s_node(&two)));
    const LanePoint off = points_scale(points_of(float4s_node(&off4)), lanes_all(0.25f));
    const Lanes above = points_dot(off, normal), square = points_dot(normal, normal);
    const Lanes enough =
        job->thickness.mask ? lanes_load(cells.enough) : lanes_all(job->min * field_at(job->thickness, 0));
    const Lanes alive = all ? ones : lanes_load(cells.alive);
    const Lanes twice = height_is_enough(above, square, lanes_all(2) * enough);
    if (!lanes_any_less(lanes_where_less(zero, alive, twice, ones), ones)) return true;

    // too low: project them
    const Lanes there = lanes_where_less(zero, square, alive, zero);
    const Lanes low = lanes_where_less(height_is_enough(above, square, enough), ones, there, zero);
    if (!lanes_any_less(zero, low)) return false;

    LaneNode node[5];
    for (int i = 0; i < 5; i++) node[i] = float4s_node(&p[i]);
    Lanes weight = node[4].w + (node[0].w + node[1].w + node[2].w + node[3].w) / lanes_all(16);
    weight = lanes_where_less(zero, low, weight, zero);
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

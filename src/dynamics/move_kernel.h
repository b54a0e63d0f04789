// Eq 13 of one substep, and eq 8 and 9 of the next, of as many particles at once as a vector holds: see move.c. One file
// per instruction set defines LANES, the vector type Lanes and the operations on it, and includes this. A vector holds
// whole quadruples, and their particles never mix: all instruction sets give the same bytes.
#include "dynamics/move.h"

#include <string.h>

/// The start that a change by the strands gives, which is kept: hardly any where it turns that back.
static inline Lanes move_start(const MoveLanes *job, size_t i, Lanes change) {
    if (job->kept) return lanes_load(job->start + i);
    const Lanes given = change - lanes_load(job->start + i);
    const Lanes start = given * lanes_all(job->share) + lanes_load(job->given + i) * lanes_all(job->share_before);
    const Lanes along = lanes_sums(change * start);
    const Lanes kept = lanes_where_less(along, lanes_all(0), start * lanes_all(0x1p-10f), start);
    lanes_store(job->given + i, given);
    lanes_store(job->start + i, kept);
    return kept;
}

/// Quadruples from number i on, which is that of the first one times four.
static inline void move_lanes(const MoveLanes *job, size_t i, bool closes, bool opens, bool drags, bool damps,
                              bool starts) {
    const Lanes zero = lanes_all(0), one = lanes_all(1), h = lanes_all(job->h);
    const Lanes old_point = lanes_load(job->position + i), old = lanes_load(job->velocity + i);
    const Lanes old_predicted = lanes_load(job->predicted + i), mass = lanes_fourths(old_point);
    Lanes point = old_point, velocity = old;

    // eq 13: velocity of the substep that ends
    if (closes) velocity = velocity + (point - old_predicted) * lanes_all(job->inverse_h);

    // eq 8 and 9: forces and prediction of the next one
    if (opens) {
        Lanes keep = lanes_all(job->keep);
        if (damps) keep = one / (one + h * lanes_fourths(lanes_load(job->air + (i & job->air_mask))));
        velocity = (velocity + lanes_quadruple(job->fall)) * keep;
        if (drags) {
            const Lanes normal = lanes_load(job->normal + i), drag = lanes_fourths(normal);
            const Lanes slip = lanes_sums((velocity - lanes_load(job->air + (i & job->air_mask))) * normal);
            const Lanes k = h * drag * lanes_abs(slip);
            const Lanes slower = lanes_with_fourth(velocity - slip * k / (one + k) * normal, velocity);
            velocity = lanes_where_less(zero, drag, slower, velocity);
        }

        point = point + h * velocity;
        Lanes moved = point;
        if (starts && closes) moved += move_start(job, i, old_point - old_predicted);
        if (starts && !closes) { // a step begins without a start
            lanes_store(job->given + i, zero);
            lanes_store(job->start + i, zero);
        }

        lanes_store(job->position + i, lanes_where_less(zero, mass, moved, old_point));
        lanes_store(job->predicted + i, lanes_where_less(zero, mass, point, old_predicted));
    }

    // what is pinned or gone stays
    lanes_store(job->velocity + i, lanes_where_less(zero, mass, velocity, old));
}

/// The same of four vectors that close and open a substep with drag, without damping or a start: their quotients are
/// computed at once.
static inline void move_dragged(const MoveLanes *job, size_t first) {
    const Lanes zero = lanes_all(0), one = lanes_all(1), h = lanes_all(job->h);
    Lanes point[4], velocity[4], normal[4];
    Float4s slips;
    for (size_t e = 0; e < 4; e++) point[e] = lanes_load(job->position + first + e * LANES);
    const Lanes heaviest = lanes_max(lanes_max(point[0], point[1]), lanes_max(point[2], point[3]));
    if (!lanes_any_less(zero, lanes_fourths(heaviest))) return; // pinned or gone, all of them

    for (size_t e = 0, i = first; e < 4; e++, i += LANES) {
        const Lanes closed =
            lanes_load(job->velocity + i) + (point[e] - lanes_load(job->predicted + i)) * lanes_all(job->inverse_h);
        velocity[e] = (closed + lanes_quadruple(job->fall)) * lanes_all(job->keep);
        normal[e] = lanes_load(job->normal + i);
        const Lanes slip =
            lanes_with_fourth((velocity[e] - lanes_load(job->air + (i & job->air_mask))) * normal[e], normal[e]);
        FLOAT4S_SET(slips, e, slip);
    }

    const LaneNode node = float4s_node(&slips);
    const Lanes slip = node.x + node.y + node.z, k = h * node.w * lanes_abs(slip), slowed = slip * k / (one + k);
    const Lanes share[4] = {LANES_SPREAD(slowed, 0), LANES_SPREAD(slowed, 1), LANES_SPREAD(slowed, 2),
                            LANES_SPREAD(slowed, 3)};
    for (size_t e = 0, i = first; e < 4; e++, i += LANES) {
        const Lanes mass = lanes_fourths(point[e]);
        const Lanes slower = lanes_with_fourth(velocity[e] - share[e] * normal[e], velocity[e]);
        velocity[e] = lanes_where_less(zero, lanes_fourths(normal[e]), slower, velocity[e]);
        const Lanes moved = point[e] + h * velocity[e];
        lanes_store(job->position + i, lanes_where_less(zero, mass, moved, point[e]));
        lanes_store(job->predicted + i, lanes_where_less(zero, mass, moved, lanes_load(job->predicted + i)));
        lanes_store(job->velocity + i, lanes_where_less(zero, mass, velocity[e], lanes_load(job->velocity + i)));
    }
}

/// Makes the normals of as many particles as there are lanes unit vectors. The fourth numbers stay.
static inline void unit_lanes(float *normal) {
    Float4s normals = float4s_load_contiguous(normal, LANES);
    const LaneNode node = float4s_node(&normals);
    const Lanes one = lanes_all(1), length = lanes_sqrt(node.x * node.x + node.y * node.y + node.z * node.z);
    const Lanes scale = lanes_where_less(lanes_all(0), length, one / length, one);
    const Lanes share[4] = {LANES_SPREAD(scale, 0), LANES_SPREAD(scale, 1), LANES_SPREAD(scale, 2),
                            LANES_SPREAD(scale, 3)};
    for (int e = 0; e < 4; e++) {
        const Lanes old = (Lanes)normals.at[e];
        FLOAT4S_SET(normals, e, lanes_with_fourth(old * share[e], old));
    }
    float4s_store_contiguous(normal, LANES, &normals);
}

void UNIT_RANGE(float (*normal)[4], uint32_t count) {
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES) unit_lanes(normal[i]);
#ifdef UNIT_NARROWER
    UNIT_NARROWER(normal + i, count - i);
#else
    float rest[LANES][4] = {{0}};
    memcpy(rest, normal + i, (count - i) * sizeof *rest);
    unit_lanes(rest[0]);
    memcpy(normal + i, rest, (count - i) * sizeof *rest);
#endif
}

void MOVE_RANGE(const MoveLanes *job, size_t begin, size_t end, bool closes, bool opens) {
    const bool drags = job->drags, damps = job->damps, starts = job->share > 0;
    size_t i = 4 * begin;
    const size_t last = 4 * end;

    // each call becomes a loop of its own
    if (closes && opens && drags && !damps && !starts) {
        for (; i + 4 * LANES <= last; i += 4 * LANES) move_dragged(job, i);
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, true, true, false, false);
    } else if (closes && opens && !drags && !damps && !starts)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, true, false, false, false);
    else if (closes && opens)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, true, drags, damps, starts);
    else if (opens)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, false, true, drags, damps, starts);
    else if (closes)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, false, false, false, false);
    else if (starts)
        for (; i + LANES <= last; i += LANES)
            move_start(job, i, lanes_load(job->position + i) - lanes_load(job->predicted + i));
#ifdef MOVE_NARROWER
    if (i < last) MOVE_NARROWER(job, i / 4, end, closes, opens);
#endif
}

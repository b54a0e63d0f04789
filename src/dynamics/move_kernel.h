// Eq 13 of one substep, and eq 8 and 9 of the next, of as many particles at once as a vector holds: see move.c. One file
// per instruction set defines LANES, the vector type Lanes and the operations on it, and includes this. A vector holds
// whole quadruples, and their particles never mix: all instruction sets give the same bytes.
#include "dynamics/move.h"

/// Quadruples from number i on, which is that of the first one times four.
static inline void move_lanes(const MoveLanes *job, size_t i, bool closes, bool opens, bool drags, bool damps) {
    const Lanes zero = lanes_all(0), one = lanes_all(1), h = lanes_all(job->h);
    const Lanes old_point = lanes_load(job->position + i), old = lanes_load(job->velocity + i);
    const Lanes old_predicted = lanes_load(job->predicted + i), mass = lanes_fourths(old_point);
    Lanes point = old_point, velocity = old;

    // eq 13: velocity of the substep that ends
    if (closes) velocity = velocity + (point - old_predicted) * lanes_all(job->inverse_h);

    // eq 8 and 9: forces and prediction of the next one
    if (opens) {
        Lanes keep = lanes_all(job->keep);
        if (damps) keep = one / (one + h * lanes_fourths(lanes_load(job->air + i)));
        velocity = (velocity + lanes_quadruple(job->fall)) * keep;
        if (drags) {
            const Lanes normal = lanes_load(job->normal + i), drag = lanes_fourths(normal);
            const Lanes slip = lanes_sums((velocity - lanes_load(job->air + i)) * normal);
            const Lanes k = h * drag * lanes_abs(slip);
            const Lanes slower = lanes_with_fourth(velocity - slip * k / (one + k) * normal, velocity);
            velocity = lanes_where_less(zero, drag, slower, velocity);
        }

        point = point + h * velocity;
        lanes_store(job->position + i, lanes_where_less(zero, mass, point, old_point));
        lanes_store(job->predicted + i, lanes_where_less(zero, mass, point, old_predicted));
    }

    // what is pinned or gone stays
    lanes_store(job->velocity + i, lanes_where_less(zero, mass, velocity, old));
}

void MOVE_RANGE(const MoveLanes *job, size_t begin, size_t end, bool closes, bool opens) {
    const bool drags = job->drags, damps = job->damps;
    size_t i = 4 * begin;
    const size_t last = 4 * end;

    // each call becomes a loop of its own
    if (closes && opens && drags && !damps)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, true, true, false);
    else if (closes && opens && !drags && !damps)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, true, false, false);
    else if (closes && opens)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, true, drags, damps);
    else if (opens)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, false, true, drags, damps);
    else if (closes)
        for (; i + LANES <= last; i += LANES) move_lanes(job, i, true, false, false, false);
#ifdef MOVE_NARROWER
    if (i < last) MOVE_NARROWER(job, i / 4, end, closes, opens);
#endif
}

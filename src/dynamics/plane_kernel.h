// Contact of as many particles with a plane as there are lanes: see collider_contact.c, whose contact_particle computes
// the same to the bit. One file per instruction set defines the operations on lanes and quadruples, as for
// strand_kernel.h, and includes this.
#include "dynamics/lane_points.h"
#include "dynamics/plane.h"

#include <math.h>

/// Rotates as quat_rotate does; `back` as quat_unrotate.
static inline LanePoint plane_rotate(const float q[4], LanePoint v, bool back) {
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 1) return v;
    const LanePoint axis = points_all(back ? (Float3){-q[0], -q[1], -q[2]} : (Float3){q[0], q[1], q[2]});
    const LanePoint t = points_scale(points_cross(axis, v), lanes_all(2));
    return points_add(points_mad(v, t, lanes_all(q[3])), points_cross(axis, t));
}

/// Positions or velocities of all lanes from number i on.
static inline LaneNode plane_load(const float *from, size_t i) {
    const Float4s float4s = float4s_load_contiguous(from + i, LANES);
    return float4s_node(&float4s);
}

/// The displacement of the plane in the substep at a point in its frame.
static inline LanePoint plane_carries(const PlaneLanes *plane, LanePoint local) {
    const LanePoint end = plane_rotate(plane->after.rotation, local, false);
    const LanePoint start = plane_rotate(plane->before.rotation, local, false);
    return points_sub(points_add(points_all(plane->after.position), end),
                      points_add(points_all(plane->before.position), start));
}

/// The particles whose first has number i, which is that of the first one times four. Returns 1 where they touch.
static inline Lanes plane_lanes(const PlaneLanes *plane, size_t i) {
    const Lanes zero = lanes_all(0), offset = lanes_all(plane->offset);
    const LaneNode node = plane_load(plane->position, i);
    const LanePoint x = points_of(node);
    const LanePoint local = plane_rotate(plane->after.rotation, points_sub(x, points_all(plane->after.position)), true);
    const Lanes distance = lanes_where_less(zero, node.w, local.z, lanes_all(INFINITY));
    if (!lanes_any_less(distance, offset)) return zero;

    // out
    const Lanes depth = offset - local.z;
    const LanePoint up = points_all((Float3){0, 0, 1}), normal = plane_rotate(plane->after.rotation, up, false);
    const LanePoint out = points_sub(points_mad(local, up, depth), local);
    LanePoint after = points_add(x, plane_rotate(plane->after.rotation, out, false));

    // slip, since the substep began
    const LanePoint velocity = points_of(plane_load(plane->velocity, i));
    const LanePoint previous = points_mad(points_of(plane_load(plane->predicted, i)), velocity, lanes_all(-plane->h));
    LanePoint slip = points_sub(after, previous);
    if (!plane->is_still) slip = points_sub(slip, plane_carries(plane, local));
    slip = points_mad(slip, normal, -points_dot(slip, normal));

    // friction
    const Lanes length = lanes_sqrt(points_dot(slip, slip)), max = lanes_all(plane->friction) * depth;
    after = points_mad(after, slip, lanes_where_less(max, length, -max / length, lanes_all(-1)));

    const Float4s moved = points_put(points_where_less(distance, offset, after, x), node);
    float4s_store_contiguous(plane->position + i, LANES, &moved);
    return lanes_where_less(distance, offset, lanes_all(1), zero);
}

uint64_t PLANE_RANGE(const PlaneLanes *given, size_t begin, size_t end) {
    const PlaneLanes plane = *given; // of its own, so that stores cannot change it
    Lanes touching = lanes_all(0);
    size_t i = begin;
    for (; i + LANES <= end; i += LANES) touching = touching + plane_lanes(&plane, 4 * i);

    float counts[LANES];
    uint64_t contacts = 0;
    lanes_store(counts, touching);
    for (int lane = 0; lane < LANES; lane++) contacts += (uint64_t)counts[lane];
#ifdef PLANE_NARROWER
    if (i < end) contacts += PLANE_NARROWER(&plane, i, end);
#endif
    return contacts;
}

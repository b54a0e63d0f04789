// Contact with colliders (section 7), with Coulomb friction. A substep has one projection, of all colours in
// their order, and contact closes it: once a substep, after the colours.
//
// A particle nearer than the collider's offset is moved out along the normal by its depth p. Its slip
// over the collider in this substep, tangential to the surface, is taken back by at most mu p: friction
// as positions (Mueller et al., Position based dynamics, 2007; Macklin et al. 2014).
//
// Depth alone does not tell on which side a particle belongs that has gone through something thin. So where its
// displacement over the collider in this substep is longer than its distance, its path is followed from the start, in
// the collider's frame, by steps that the distance allows (contact_enters); a particle that enters goes back to the
// plane that touches the surface there.
//
// Cells are in contact too. Particles of a layer are a cell apart: a collider smaller than a cell would
// reach through it. So the mean of a cell's corners,
//
//   x = (x_0 + x_1 + x_2 + x_3)/4,
//
// is kept out of colliders like a particle, with friction, and its corners move with it; held corners stay. Cells of
// one family share no corner; families follow each other. Contact of the particles comes after it and has the last
// word.
#include "common/float4.h"
#include "common/real.h"
#include "dynamics/dynamics_plan.h"

#include <string.h>

/// m/s, relative to a collider: a faster particle may pass a collider smaller than its displacement in a substep.
static const float CONTACT_SPEED = 20;

/// Max steps in which a displacement is followed.
enum { CONTACT_STEPS = 128 };

/// A block of particles or cells lists the colliders it may touch: at most CONTACT_LISTED, of more than CONTACT_FEW. Runs of
/// particles whose box meets none are left out.
enum { CONTACT_FEW = 4, CONTACT_LISTED = 256, CONTACT_RUN = 16 };

/// A position this near outside a surface, as a share of the offset or in m, counts as on it.
static const float CONTACT_SKIN = 1.0f / 16, CONTACT_SKIN_MIN = 1e-6f;

MovingCollider contact_collider(const Collider *collider, double before, double after) {
    // shapes whose distance a few operations give; planes have a kernel of their own
    const SingeColliderKind kind = collider->def.kind;
    const bool is_simple =
        kind == SINGE_COLLIDER_SPHERE || kind == SINGE_COLLIDER_BOX || kind == SINGE_COLLIDER_CAPSULE;
    MovingCollider moving = {.collider = collider,
                             .is_simple = is_simple,
                             .before = path_pose(&collider->path, before),
                             .after = path_pose(&collider->path, after)};
    Float3 low, high;
    moving.is_still = memcmp(&moving.before, &moving.after, sizeof moving.before) == 0;
    if (collider->def.kind == SINGE_COLLIDER_DEFORMING) {
        deform_between(&collider->deform, before, after);
        moving.drift = collider->deform.pose->farthest;
    }

    // radius about the collider's origin, for its rotation
    collider_bounds(collider, &low, &high);
    const float ends[3][2] = {{low.x, high.x}, {low.y, high.y}, {low.z, high.z}};
    float size = 0;
    for (int i = 0; i < 3; i++) {
        float far = float_max(fabsf(ends[i][0]), fabsf(ends[i][1]));
        if (isfinite(far)) size += far * far; // a collider without end along an axis is taken not to turn about another
    }

    // the max displacement of any point of the box between the two poses
    float turn = 0, back = 0;
    for (int i = 0; i < 4; i++) {
        float a = moving.after.rotation[i] - moving.before.rotation[i];
        float b = moving.after.rotation[i] + moving.before.rotation[i];
        turn += a * a;
        back += b * b;
    }

    float angle = 2 * sqrtf(float_min(turn, back)) * 1.05f; // the chord of half the angle, in the space of quaternions
    float motion = float3_length(float3_sub(moving.after.position, moving.before.position)) +
                   (angle > 1e-6f ? angle * sqrtf(size) : 0);

    // box in its own frame, widened by the motion in the substep
    float margin = collider->def.offset + CONTACT_SPEED * (float)(after - before) + motion;
    for (int i = 0; i < 3; i++) {
        float unit[3] = {0, 0, 0};
        unit[i] = 1;
        moving.axis[i] = quat_rotate(moving.after.rotation, float3_load(unit));
        moving.low[i] = ends[i][0] - margin;
        moving.high[i] = ends[i][1] + margin;
    }

    while (moving.ends < 2 && isinf(moving.low[moving.ends]) && isinf(moving.high[moving.ends])) moving.ends++;

    // the box along the world's axes; a collider without an end somewhere is near everything
    for (int i = 0; i < 3; i++) {
        float middle = 0, reach = 0;
        for (int k = 0; k < 3; k++) {
            const Float3 a = moving.axis[k];
            const float part = i == 0 ? a.x : i == 1 ? a.y : a.z;
            middle += part * 0.5f * (moving.low[k] + moving.high[k]);
            reach += fabsf(part) * 0.5f * (moving.high[k] - moving.low[k]);
        }
        const float at = i == 0 ? moving.after.position.x : i == 1 ? moving.after.position.y : moving.after.position.z;
        const float slack = 1e-5f * (fabsf(at) + fabsf(middle) + reach); // of rounding, here and in contact_near
        const bool bounded = isfinite(middle) && isfinite(reach);
        moving.world_low[i] = bounded ? at + middle - reach - slack : -INFINITY;
        moving.world_high[i] = bounded ? at + middle + reach + slack : INFINITY;
    }
    moving.world_low[3] = kind == SINGE_COLLIDER_PLANE ? INFINITY : -INFINITY; // planes meet no box: see contact_plane
    moving.world_high[3] = INFINITY;
    return moving;
}

/// Where a trajectory enters a collider, and the normal there.
typedef struct Entry {
    Float3 position, normal;
    float distance;
} Entry;

/// Follows the straight path from `from`, outside, to `to`, in the collider's frame.
static bool contact_enters(const Collider *collider, Float3 from, Float3 to, Entry *entry) {
    float skin = float_max(CONTACT_SKIN * collider->def.offset, CONTACT_SKIN_MIN);
    Float3 displacement = float3_sub(to, from);
    float length = float3_length(displacement), min = float_max(length / CONTACT_STEPS, skin), done = 0;
    while (done < length) {
        Entry next = {.position = float3_mad(from, displacement, done / length)};
        next.distance = collider_distance(collider, next.position, length - done, &next.normal);
        if (next.distance >= length - done) return false; // the rest of the displacement is free
        bool began = done > 0,
             turned = began && entry->distance < min && float3_dot(entry->normal, next.normal) < -0.5f;
        if (next.distance < 0 || turned) return began; // *entry is just outside. Inside from the start: depth tells
        *entry = next;
        if (next.distance <= skin && float3_dot(displacement, next.normal) < 0) return true;

        done += float_max(next.distance, min);
    }

    return false;
}

/// Moves a particle out of a collider, in its frame. Returns the distance, or 0; *normal is the direction.
static float contact_out(const Collider *collider, float offset, Float3 from, Float3 *to, Float3 *normal) {
    float displacement = float3_length(float3_sub(*to, from));
    float distance = collider_distance(collider, *to, offset + displacement, normal);
    Entry entry = {0};

    // behind a plane, at any depth, a particle moves out along the plane's normal
    if (distance < displacement && collider->def.kind != SINGE_COLLIDER_PLANE &&
        contact_enters(collider, from, *to, &entry) &&
        (distance >= offset || float3_dot(entry.normal, *normal) < 0.5f)) {
        float depth = offset - entry.distance - float3_dot(float3_sub(*to, entry.position), entry.normal);
        *to = float3_mad(*to, entry.normal, depth);
        Float3 there;
        float rest = offset - collider_distance(collider, *to, offset, &there);
        if (rest > 0) *to = float3_mad(*to, there, rest);
        *normal = entry.normal;
        return depth;
    }

    if (distance >= offset) return 0;
    *to = float3_mad(*to, *normal, offset - distance);
    return offset - distance;
}

bool contact_particle(const MovingCollider *moving, float offset, Float3 previous, float *position) {
    const Collider *collider = moving->collider;
    Float3 local = pose_unapply(&moving->after, float3_load(position)), out = local, normal;
    Float3 from = pose_unapply(&moving->before, previous), drift = {0, 0, 0};

    // displacement of a deforming mesh's surface near the particle; zero if it is too far for contact
    if (moving->drift != 0) {
        float reach = offset + float3_length(float3_sub(local, from)) + 2 * moving->drift;
        if (collider_distance(collider, local, reach, &normal) < reach) drift = deform_drift(&collider->deform, from);
        from = float3_add(from, drift);
    }

    // out of the collider
    float depth = contact_out(collider, offset, from, &out, &normal);
    if (depth <= 0) return false;

    normal = quat_rotate(moving->after.rotation, normal);
    Float3 x = float3_add(float3_load(position), quat_rotate(moving->after.rotation, float3_sub(out, local)));

    // slip: the particle's displacement less the collider's at this position
    Float3 displacement = float3_sub(x, previous);
    Float3 carried = float3_sub(pose_apply(&moving->after, local), pose_apply(&moving->before, local));
    if (moving->drift > 0) carried = float3_add(carried, quat_rotate(moving->after.rotation, drift));
    Float3 slip = float3_sub(displacement, carried);
    slip = float3_mad(slip, normal, -float3_dot(slip, normal));
    float length = float3_length(slip), max = collider->def.friction * depth;
    x = float3_mad(x, slip, length <= max ? -1 : -max / length);
    float3_store(position, x);
    return true;
}

// ---- four particles at once, for colliders of a simple shape; to the bit what contact_particle computes

/// Four points or vectors, a lane each.
typedef struct Float3s {
    Float4 x, y, z;
} Float3s;

static inline Float3s float3s_add(Float3s a, Float3s b) { return (Float3s){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Float3s float3s_sub(Float3s a, Float3s b) { return (Float3s){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Float3s float3s_mad(Float3s a, Float3s b, Float4 s) {
    return (Float3s){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
static inline Float4 float3s_dot(Float3s a, Float3s b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Float3s float3s_all(Float3 a) { return (Float3s){float4_all(a.x), float4_all(a.y), float4_all(a.z)}; }

static inline Float3s float3s_load(const float (*from)[4], const int particle[4]) {
    Float4 q[4];
    for (int k = 0; k < 4; k++) q[k] = float4_load(from[particle[k]]);
    float4_transpose(q);
    return (Float3s){q[0], q[1], q[2]};
}

/// Rotates as quat_rotate does; `back` as quat_unrotate.
static inline Float3s float3s_rotate(const float q[4], Float3s v, bool back) {
    const float x = back ? -q[0] : q[0], y = back ? -q[1] : q[1], z = back ? -q[2] : q[2];
    if (x == 0 && y == 0 && z == 0 && q[3] == 1) return v;
    Float3s t = {(y * v.z - z * v.y) * 2, (z * v.x - x * v.z) * 2, (x * v.y - y * v.x) * 2};
    Float3s cross = {y * t.z - z * t.y, z * t.x - x * t.z, x * t.y - y * t.x};
    return float3s_add(float3s_mad(v, t, float4_all(q[3])), cross);
}

/// collider_distance, for a simple shape.
static inline Float4 simple_distance(const SingeColliderDef *def, Float3s p, Float3s *normal) {
    const Float4 zero = float4_all(0), one = float4_all(1);
    Float4Mask inside = {0, 0, 0, 0};
    Float4 radius = float4_all(def->radius), deepest = zero;
    Float3s within = {zero, zero, zero}; // the normal inside a box
    switch (def->kind) {
    case SINGE_COLLIDER_BOX: {
        const Float4 q[3] = {p.x, p.y, p.z};
        Float4 out[3], n[3], side[3];
        for (int i = 0; i < 3; i++) {
            out[i] = float4_max(q[i], -q[i]) - def->half_size[i];
            side[i] = float4_select(q[i] < 0, -one, one);
            n[i] = float4_select(out[i] > 0, float4_select(q[i] < 0, -out[i], out[i]), zero);
        }

        inside = ~((out[0] > 0) | (out[1] > 0) | (out[2] > 0));
        Float4Mask second = out[1] > out[0];
        deepest = float4_select(second, out[1], out[0]);
        Float4Mask third = out[2] > deepest;
        deepest = float4_select(third, out[2], deepest);
        within = (Float3s){float4_select(second | third, zero, side[0]), float4_select(second & ~third, side[1], zero),
                           float4_select(third, side[2], zero)};
        p = (Float3s){n[0], n[1], n[2]};
        radius = zero;
        break;
    }
    case SINGE_COLLIDER_CAPSULE: {
        const Float4 half = float4_all(def->height / 2);
        p.z = p.z - float4_min(float4_max(p.z, -half), half);
        break;
    }
    default: break; // a sphere
    }

    const Float4 length = float4_sqrt(float3s_dot(p, p)), inverse = 1 / length;
    const Float4Mask off = length > 0;
    *normal = (Float3s){float4_select(inside, within.x, float4_select(off, p.x * inverse, zero)),
                        float4_select(inside, within.y, float4_select(off, p.y * inverse, zero)),
                        float4_select(inside, within.z, float4_select(off, p.z * inverse, one))};
    return float4_select(inside, deepest, length - radius);
}

/// Whether four points lie in the collider's box: nearer to it than it reaches.
static inline Float4Mask contact_near(const MovingCollider *collider, Float4 x, Float4 y, Float4 z) {
    Float3 origin = collider->after.position;
    Float4 dx = x - origin.x, dy = y - origin.y, dz = z - origin.z;
    Float4Mask near = {-1, -1, -1, -1};

    for (int i = 2; i >= collider->ends; i--) {
        Float3 axis = collider->axis[i];
        Float4 along = dx * axis.x + dy * axis.y + dz * axis.z;
        near &= (along < collider->high[i]) & (along > collider->low[i]);
        if (!float4_bits(near)) break;
    }

    return near;
}

/// A box about positions, m. Their fourth numbers do not count.
typedef struct ContactBox {
    Float4 low, high;
} ContactBox;

static inline ContactBox box_empty(void) { return (ContactBox){float4_all(INFINITY), float4_all(-INFINITY)}; }

/// A position that is not a number changes nothing.
static inline ContactBox box_with(ContactBox box, Float4 x) {
    return (ContactBox){float4_min(x, box.low), float4_max(x, box.high)};
}

static inline bool box_meets(const ContactBox *box, const MovingCollider *moving) {
    return !float4_any((float4_load(moving->world_low) > box->high) | (float4_load(moving->world_high) < box->low));
}

/// The colliders that positions in a box may touch, in their order.
typedef struct Nearby {
    const MovingCollider *all;
    ContactBox box;
    uint32_t count; ///< of colliders; of all if it is not listed
    bool listed;    ///< whether they are in `index`
    uint32_t index[CONTACT_LISTED];
} Nearby;

/// Whether the positions are in the box.
static inline bool nearby_holds(const Nearby *nearby, const Float4 q[3]) {
    Float4Mask in = {-1, -1, -1, -1};
    for (int i = 0; i < 3; i++) in &= (q[i] >= nearby->box.low[i]) & (q[i] <= nearby->box.high[i]);
    return float4_bits(in) == 15;
}

static void nearby_list(Nearby *nearby) {
    const uint32_t all = nearby->count;
    nearby->listed = true;
    nearby->count = 0;
    for (uint32_t c = 0; c < all; c++) {
        if (!box_meets(&nearby->box, &nearby->all[c])) continue;
        nearby->listed = nearby->count < CONTACT_LISTED;
        if (!nearby->listed) {
            nearby->count = all;
            return;
        }
        nearby->index[nearby->count++] = c;
    }
}

/// Whether no position in a part of the box may touch a collider.
static inline bool nearby_misses(const Nearby *nearby, const ContactBox *part) {
    for (uint32_t k = 0; k < nearby->count; k++)
        if (box_meets(part, &nearby->all[nearby->listed ? nearby->index[k] : k])) return false;
    return true;
}

typedef struct Contact {
    const DynamicsPlan *plan;
    uint32_t from, to; ///< colliders of the plan
    float h;
    DynamicsState *dynamics;
} Contact;

/// Where a particle was when the substep began.
static inline Float3 contact_previous(const Contact *job, int i) {
    return float3_mad(float3_load(job->plan->predicted[i]), float3_load(job->dynamics->velocity[i]), -job->h);
}

/// Contact of the particles that `moves` selects, at *x, with a collider of a simple shape. Returns which of them it
/// has moved. Those that may have entered the collider on their way are left to contact_particle: *through.
static inline Float4Mask contact_simple(const Contact *job, const MovingCollider *moving, const int particle[4],
                                        Float4Mask moves, Float3s *x, Float4Mask *through) {
    const SingeColliderDef *def = &moving->collider->def;
    const Float3s origin = float3s_all(moving->after.position);
    const Float3s local = float3s_rotate(moving->after.rotation, float3s_sub(*x, origin), true);
    Float3s normal;
    const Float4 distance = simple_distance(def, local, &normal);
    Float4Mask touches = moves & (distance < def->offset);
    const Float3s velocity = float3s_load((const float(*)[4])job->dynamics->velocity, particle);
    const Float3s previous =
        float3s_mad(float3s_load((const float(*)[4])job->plan->predicted, particle), velocity, float4_all(-job->h));
    const Float3s from =
        float3s_rotate(moving->before.rotation, float3s_sub(previous, float3s_all(moving->before.position)), true);
    const Float3s displacement = float3s_sub(local, from);
    *through = moves & (distance < float4_sqrt(float3s_dot(displacement, displacement)));
    touches &= ~*through;
    if (!float4_bits(touches)) return touches;

    // out
    const Float4 depth = def->offset - distance;
    touches &= depth > 0;
    const Float3s out = float3s_sub(float3s_mad(local, normal, depth), local);
    Float3s after = float3s_add(*x, float3s_rotate(moving->after.rotation, out, false));
    normal = float3s_rotate(moving->after.rotation, normal, false);

    // friction
    Float3s slip = float3s_sub(after, previous);
    if (!moving->is_still) {
        const Float3s end = float3s_add(origin, float3s_rotate(moving->after.rotation, local, false));
        const Float3s start =
            float3s_add(float3s_all(moving->before.position), float3s_rotate(moving->before.rotation, local, false));
        slip = float3s_sub(slip, float3s_sub(end, start));
    }
    slip = float3s_mad(slip, normal, -float3s_dot(slip, normal));
    const Float4 length = float4_sqrt(float3s_dot(slip, slip)), max = def->friction * depth;
    after = float3s_mad(after, slip, float4_select(length <= max, float4_all(-1), -max / length));
    *x = (Float3s){float4_select(touches, after.x, x->x), float4_select(touches, after.y, x->y),
                   float4_select(touches, after.z, x->z)};
    return touches;
}

static inline ContactBox box_about(const float (*position)[4], int begin, int end) {
    ContactBox box = box_empty();
    for (int i = begin; i < end; i++) box = box_with(box, float4_load(position[i]));
    return box;
}

/// Contact with the colliders [from, to) of the job, in their order, of particle after particle.
static uint64_t contact_colliders(const Contact *job, int begin, int end) {
    uint64_t contacts = 0;
    float(*position)[4] = job->dynamics->position;
    Nearby nearby = {.all = job->plan->colliders + job->from, .count = job->to - job->from};
    if (nearby.count > CONTACT_FEW) {
        nearby.box = box_about((const float(*)[4])position, begin, end);
        nearby_list(&nearby);
    }

    for (int first = begin; first < end && nearby.count > 0; first += 4) {
        if ((first - begin) % CONTACT_RUN == 0) {
            const int last = first + CONTACT_RUN < end ? first + CONTACT_RUN : end;
            const ContactBox run = box_about((const float(*)[4])position, first, last);
            if (nearby_misses(&nearby, &run)) {
                first += CONTACT_RUN - 4;
                continue;
            }
        }

        // the last of a block is repeated in lanes without a particle
        int particle[4];
        for (int i = 0; i < 4; i++) particle[i] = first + i < end ? first + i : end - 1;
        Float4 q[4];
        for (int i = 0; i < 4; i++) q[i] = float4_load(position[particle[i]]);
        float4_transpose(q);
        const Float4Mask lane = {0, 1, 2, 3}, moves = (q[3] != 0) & (lane < end - first);
        bool listed = nearby.listed;
        for (uint32_t k = 0, c; k < (listed ? nearby.count : job->to - job->from); k++) {
            c = listed ? nearby.index[k] : k;
            const MovingCollider *collider = &nearby.all[c];
            if (!float4_bits(contact_near(collider, q[0], q[1], q[2]))) continue;
            const uint64_t before = contacts;

            unsigned one_by_one = float4_bits(moves);
            if (collider->is_simple) {
                Float3s x = {q[0], q[1], q[2]};
                Float4Mask through;
                const unsigned touched = float4_bits(contact_simple(job, collider, particle, moves, &x, &through));
                one_by_one = float4_bits(through);
                if (touched) {
                    Float4 row[4] = {x.x, x.y, x.z, q[3]};
                    float4_transpose(row);
                    for (int i = 0; i < 4; i++)
                        if (touched == 15 || touched >> i & 1) float4_store(position[particle[i]], row[i]);
                    contacts += (uint64_t)__builtin_popcount(touched);
                    memcpy(q, &x, sizeof x);
                }
            }

            // along their displacements
            if (one_by_one) {
                float offset = collider->collider->def.offset;
                for (int i = 0; i < 4; i++)
                    if (one_by_one >> i & 1)
                        contacts += contact_particle(collider, offset, contact_previous(job, particle[i]),
                                                     position[particle[i]]);
                for (int i = 0; i < 4; i++) q[i] = float4_load(position[particle[i]]);
                float4_transpose(q);
            }

            // moved out of the box: other colliders may be near, of those that follow
            if (listed && contacts > before && !nearby_holds(&nearby, q)) {
                listed = false;
                k = c;
            }
        }
    }

    return contacts;
}

/// Contact with a plane, in lanes; of what is left over one by one.
static uint64_t contact_plane(const Contact *job, uint32_t c, int begin, int end) {
    const MovingCollider *moving = &job->plan->colliders[c];
    const int whole = end - (end - begin) % 4;
    const PlaneLanes plane = {.position = job->dynamics->position[0],
                              .velocity = job->dynamics->velocity[0],
                              .predicted = job->plan->predicted[0],
                              .h = job->h,
                              .before = moving->before,
                              .after = moving->after,
                              .is_still = moving->is_still,
                              .offset = moving->collider->def.offset,
                              .friction = moving->collider->def.friction};
    uint64_t contacts = job->plan->kernels->plane(&plane, (size_t)begin, (size_t)whole);
    for (int i = whole; i < end; i++) {
        float *position = job->dynamics->position[i];
        if (position[3] != 0) contacts += contact_particle(moving, plane.offset, contact_previous(job, i), position);
    }
    return contacts;
}

static bool contact_is_plane(const Contact *job, uint32_t c) {
    return job->plan->colliders[c].collider->def.kind == SINGE_COLLIDER_PLANE;
}

/// Colliders in their order: planes one by one, those between them together.
static double contact_block(void *task, int begin, int end) {
    const Contact *job = task;
    uint64_t contacts = 0;
    for (uint32_t c = job->from, next; c < job->to; c = next) {
        next = c + 1;
        if (contact_is_plane(job, c)) {
            contacts += contact_plane(job, c, begin, end);
            continue;
        }

        while (next < job->to && !contact_is_plane(job, next)) next++;
        Contact some = *job;
        some.from = c;
        some.to = next;
        contacts += contact_colliders(&some, begin, end);
    }

    return (double)contacts;
}

uint64_t contact_range(const DynamicsPlan *plan, uint32_t collider_count, float h, DynamicsState *dynamics, int begin,
                       int end) {
    Contact job = {plan, 0, collider_count, h, dynamics};
    return (uint64_t)contact_block(&job, begin, end);
}

uint64_t contact_project(DynamicsPlan *plan, uint32_t collider_count, Pool *pool, float h, DynamicsState *dynamics) {
    if (collider_count == 0) return 0;
    Contact job = {plan, 0, collider_count, h, dynamics};
    return (uint64_t)pool_sum(pool, (int)plan->particle_count, contact_block, &job, plan->partial);
}

// ---- cells

/// Share of the offset that cells keep: less than all, so that a sheet on something flat is left to its particles.
static const float CENTROID_SHARE = 0.875f;

typedef struct Centroid {
    const DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    Pool *pool;
    DynamicsState *dynamics;
    const uint32_t *cells; ///< of the family
    uint32_t collider_count;
    float h;
} Centroid;

/// The mean of a cell's corners.
static inline Float4 centroid_at(const Centroid *job, uint32_t cell) {
    const uint32_t *corner = job->shell->cells[cell];
    Float4 sum = {0, 0, 0, 0};
    for (int j = 0; j < 4; j++) sum += float4_load(job->dynamics->position[corner[j]]);
    return sum * 0.25f;
}

/// Which of the cells [first, end), at most four of them, have a centroid that a collider may touch: bits.
static unsigned centroid_touching(const Centroid *job, const Nearby *nearby, int first, int end) {
    Float4 q[4];
    ContactBox box = box_empty();
    for (int i = 0; i < 4; i++) {
        q[i] = centroid_at(job, job->cells[first + i < end ? first + i : first]);
        box = box_with(box, q[i]);
    }
    if (nearby_misses(nearby, &box)) return 0;

    unsigned alive = 0, touching = 0;
    for (int i = 0; i < 4 && first + i < end; i++)
        if (job->ablate->cell_flags[job->cells[first + i]] & SINGE_ALIVE) alive |= 1u << i;
    float4_transpose(q);
    for (uint32_t k = 0; k < nearby->count && touching != alive; k++) {
        const MovingCollider *moving = &nearby->all[nearby->listed ? nearby->index[k] : k];
        const SingeColliderDef *def = &moving->collider->def;
        if (def->kind == SINGE_COLLIDER_PLANE) continue; // no part of one lies between points outside it
        Float4Mask near = contact_near(moving, q[0], q[1], q[2]);
        if (moving->is_simple && float4_bits(near)) {
            const Float3s from = float3s_sub((Float3s){q[0], q[1], q[2]}, float3s_all(moving->after.position));
            Float3s normal;
            near &= simple_distance(def, float3s_rotate(moving->after.rotation, from, true), &normal) <
                    CENTROID_SHARE * def->offset;
        }
        touching |= float4_bits(near) & alive;
    }

    return touching;
}

static void centroid_cells(void *task, int begin, int end) {
    const Centroid *job = task;
    float(*position)[4] = job->dynamics->position;
    Nearby nearby = {.all = job->plan->colliders, .count = job->collider_count};
    if (nearby.count > CONTACT_FEW) {
        nearby.box = box_empty();
        for (int k = begin; k < end; k++) nearby.box = box_with(nearby.box, centroid_at(job, job->cells[k]));
        nearby_list(&nearby);
    }

    unsigned touching = 0; // bit i: cell k + i of four
    for (int k = begin; k < end && nearby.count > 0; k++, touching >>= 1) {
        if ((k - begin) % 64 == 0 && pool_cancelled(job->pool)) return; // which fails the step
        if ((k - begin) % 4 == 0) {
            touching = centroid_touching(job, &nearby, k, end);
            if (!touching) k += 3;
        }
        if (!(touching & 1)) continue;

        const uint32_t *corner = job->shell->cells[job->cells[k]];
        Float3 sum = {0, 0, 0};
        for (int i = 0; i < 4; i++) sum = float3_add(sum, float3_load(position[corner[i]]));
        Float3 mean = float3_scale(sum, 0.25f);
        float point[3];
        bool touched = false;
        float3_store(point, mean);
        for (uint32_t c = 0; c < job->collider_count; c++) {
            const MovingCollider *collider = &job->plan->colliders[c];
            // no part of a plane lies between points outside it
            if (collider->collider->def.kind == SINGE_COLLIDER_PLANE) continue;
            float offset = CENTROID_SHARE * collider->collider->def.offset;

            // only a collider that is nearer to the centroid than its offset
            Float3 from = float3_sub(float3_load(point), collider->after.position), normal;
            bool near = true;
            for (int i = 2; i >= 0 && near; i--) {
                float along = float3_dot(from, collider->axis[i]);
                near = along < collider->high[i] && along > collider->low[i];
            }

            if (!near || !(collider_distance(collider->collider, quat_unrotate(collider->after.rotation, from), offset,
                                             &normal) < offset))
                continue;

            // from where the centroid was when the substep began
            Float3 before = {0, 0, 0};
            for (int i = 0; i < 4; i++)
                before = float3_add(before, float3_mad(float3_load(job->plan->predicted[corner[i]]),
                                                       float3_load(job->dynamics->velocity[corner[i]]), -job->h));
            touched |= contact_particle(collider, offset, float3_scale(before, 0.25f), point);
        }

        if (!touched) continue;

        // its corners move with it
        Float3 moved = float3_sub(float3_load(point), mean);
        for (int i = 0; i < 4; i++) {
            float *x = position[corner[i]];
            if (x[3] > 0) float3_store(x, float3_add(float3_load(x), moved));
        }
    }
}

void contact_centroids(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, uint32_t collider_count,
                       Pool *pool, float h, DynamicsState *dynamics) {
    bool any = false;
    for (uint32_t c = 0; c < collider_count; c++) any |= plan->colliders[c].collider->def.kind != SINGE_COLLIDER_PLANE;

    for (uint32_t f = 0; any && f < shell->cell_family_count; f++) {
        uint32_t first = shell->cell_family_first[f], count = shell->cell_family_first[f + 1] - first;
        Centroid job = {plan, shell, ablate, pool, dynamics, shell->cell_order + first, collider_count, h};
        pool_for(pool, (int)count, POOL_GRAIN, centroid_cells, &job);
    }
}

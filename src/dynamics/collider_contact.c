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
#include "dynamics/dynamics_plan.h"

/// m/s, relative to a collider: a faster particle may pass a collider smaller than its displacement in a substep.
static const float CONTACT_SPEED = 20;

/// Max steps in which a displacement is followed.
enum { CONTACT_STEPS = 128 };

/// A position this near outside a surface, as a share of the offset or in m, counts as on it.
static const float CONTACT_SKIN = 1.0f / 16, CONTACT_SKIN_MIN = 1e-6f;

MovingCollider contact_collider(const Collider *collider, double before, double after) {
    MovingCollider moving = {
        .collider = collider, .before = path_pose(&collider->path, before), .after = path_pose(&collider->path, after)};
    Float3 low, high;
    if (collider->def.kind == SINGE_COLLIDER_DEFORMING) {
        deform_between(&collider->deform, before, after);
        moving.drift = collider->deform.pose->farthest;
    }

    // radius about the collider's origin, for its rotation
    collider_bounds(collider, &low, &high);
    const float ends[3][2] = {{low.x, high.x}, {low.y, high.y}, {low.z, high.z}};
    float size = 0;
    for (int i = 0; i < 3; i++) {
        float far = fmaxf(fabsf(ends[i][0]), fabsf(ends[i][1]));
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

    float angle = 2 * sqrtf(fminf(turn, back)) * 1.05f; // the chord of half the angle, in the space of quaternions
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

    return moving;
}

/// Where a trajectory enters a collider, and the normal there.
typedef struct Entry {
    Float3 position, normal;
    float distance;
} Entry;

/// Follows the straight path from `from`, outside, to `to`, in the collider's frame.
static bool contact_enters(const Collider *collider, Float3 from, Float3 to, Entry *entry) {
    float skin = fmaxf(CONTACT_SKIN * collider->def.offset, CONTACT_SKIN_MIN);
    Float3 displacement = float3_sub(to, from);
    float length = float3_length(displacement), min = fmaxf(length / CONTACT_STEPS, skin), done = 0;
    while (done < length) {
        Entry next = {.position = float3_mad(from, displacement, done / length)};
        next.distance = collider_distance(collider, next.position, length - done, &next.normal);
        if (next.distance >= length - done) return false; // the rest of the displacement is free
        bool began = done > 0,
             turned = began && entry->distance < min && float3_dot(entry->normal, next.normal) < -0.5f;
        if (next.distance < 0 || turned) return began; // *entry is just outside. Inside from the start: depth tells
        *entry = next;
        if (next.distance <= skin && float3_dot(displacement, next.normal) < 0) return true;

        done += fmaxf(next.distance, min);
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

/// Whether any of four particles may be nearer to a collider than it reaches.
static inline bool contact_any_near(const MovingCollider *collider, const Float4 x[4]) {
    Float3 origin = collider->after.position;
    Float4 dx = x[0] - origin.x, dy = x[1] - origin.y, dz = x[2] - origin.z;
    Float4Mask near = {-1, -1, -1, -1};

    for (int i = 2; i >= 0; i--) {
        Float3 axis = collider->axis[i];
        Float4 along = dx * axis.x + dy * axis.y + dz * axis.z;
        near &= (along < collider->high[i]) & (along > collider->low[i]);
        if (!(near[0] | near[1] | near[2] | near[3])) return false;
    }

    return true;
}

uint64_t contact_range(const DynamicsPlan *plan, uint32_t collider_count, float h, DynamicsState *dynamics, int begin,
                       int end) {
    uint64_t contacts = 0;
    float(*position)[4] = dynamics->position;

    for (int first = begin; first < end && collider_count > 0; first += 4) {
        // four particles at once, against boxes
        int count = end - first < 4 ? end - first : 4;
        Float4 x[4];
        for (int i = 0; i < 4; i++) x[i] = float4_load(position[first + (i < count ? i : 0)]);
        float4_transpose(x);
        for (uint32_t c = 0; c < collider_count; c++) {
            const MovingCollider *collider = &plan->colliders[c];
            if (!contact_any_near(collider, x)) continue;

            // each of them, along its displacement
            float offset = collider->collider->def.offset;
            for (int i = first; i < first + count; i++) {
                if (position[i][3] == 0) continue;
                Float3 previous = float3_mad(float3_load(plan->predicted[i]), float3_load(dynamics->velocity[i]), -h);
                contacts += contact_particle(collider, offset, previous, position[i]);
            }
            for (int i = 0; i < 4; i++) x[i] = float4_load(position[first + (i < count ? i : 0)]);
            float4_transpose(x);
        }
    }

    return contacts;
}

typedef struct Contact {
    const DynamicsPlan *plan;
    uint32_t collider_count;
    float h;
    DynamicsState *dynamics;
} Contact;

static double contact_block(void *task, int begin, int end) {
    const Contact *job = task;
    return (double)contact_range(job->plan, job->collider_count, job->h, job->dynamics, begin, end);
}

uint64_t contact_project(DynamicsPlan *plan, uint32_t collider_count, Pool *pool, float h, DynamicsState *dynamics) {
    if (collider_count == 0) return 0;
    Contact job = {plan, collider_count, h, dynamics};
    return (uint64_t)pool_sum(pool, (int)plan->particle_count, contact_block, &job, plan->partial);
}

// ---- cells

/// Share of the offset that cells keep: less than all, so that a sheet on something flat is left to its particles.
static const float CENTROID_SHARE = 0.875f;

typedef struct Centroid {
    const DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    DynamicsState *dynamics;
    const uint32_t *cells; ///< of the family
    uint32_t collider_count;
    float h;
} Centroid;

static void centroid_cells(void *task, int begin, int end) {
    const Centroid *job = task;
    float(*position)[4] = job->dynamics->position;
    for (int k = begin; k < end; k++) {
        const uint32_t *corner = job->shell->cells[job->cells[k]];
        if (!(job->ablate->cell_flags[job->cells[k]] & SINGE_ALIVE)) continue;

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
        Centroid job = {plan, shell, ablate, dynamics, shell->cell_order + first, collider_count, h};
        pool_for(pool, (int)count, POOL_BLOCK, centroid_cells, &job);
    }
}

// Contact with rigid primitives (section 7), with Coulomb friction. A substep has one projection, of all colours in
// their order, and contact closes it: once a substep, after the colours.
//
// A particle nearer than the collider's offset is moved out along the normal by its depth p. Its slip
// over the collider in this substep, tangential to the surface, is taken back by at most mu p: friction
// as positions (Mueller et al., Position based dynamics, 2007; Macklin et al. 2014).
#include "base/quad.h"
#include "dynamics/plan.h"

MovingCollider contact_collider(const Collider *collider, double before, double after) {
    const SingeColliderDef *def = &collider->def;
    MovingCollider moving = {.def = def, .before = path_pose(&collider->path, before),
                             .after = path_pose(&collider->path, after), .reach = def->offset};
    moving.normal = quat_rotate(moving.after.rotation, vec(0, 0, 1));
    switch (def->kind) {
    case SINGE_COLLIDER_PLANE: break;
    case SINGE_COLLIDER_SPHERE: moving.reach += def->radius; break;
    case SINGE_COLLIDER_BOX: moving.reach += vec_length(vec_load(def->half_size)); break;
    case SINGE_COLLIDER_CAPSULE: moving.reach += def->radius + def->height / 2; break;
    }
    moving.reach *= 1 + 1e-6f; // for rounding
    return moving;
}

static bool contact_particle(const MovingCollider *collider, Vec previous, float *position) {
    const SingeColliderDef *def = collider->def;
    Vec x = vec_load(position), local = pose_unapply(&collider->after, x), local_normal;
    float depth = def->offset - collider_distance(def, local, &local_normal);
    if (depth <= 0) return false;
    Vec normal = quat_rotate(collider->after.rotation, local_normal);
    x = vec_mad(x, normal, depth);
    // slip: the particle's way less the collider's way at this place
    Vec way = vec_sub(x, previous);
    Vec carried = vec_sub(pose_apply(&collider->after, local), pose_apply(&collider->before, local));
    Vec slip = vec_sub(way, carried);
    slip = vec_mad(slip, normal, -vec_dot(slip, normal));
    float length = vec_length(slip), most = def->friction * depth;
    x = vec_mad(x, slip, length <= most ? -1 : -most / length);
    vec_store(position, x);
    return true;
}

/// Which of four particles may be nearer to a collider than it reaches.
static inline bool contact_any_near(const MovingCollider *collider, bool plane, const Quad x[4]) {
    Vec centre = collider->after.position, normal = collider->normal;
    Quad dx = x[0] - centre.x, dy = x[1] - centre.y, dz = x[2] - centre.z;
    QuadMask near = plane ? dx * normal.x + dy * normal.y + dz * normal.z < collider->reach
                          : dx * dx + dy * dy + dz * dz < collider->reach * collider->reach;
    return (near[0] | near[1] | near[2] | near[3]) != 0;
}

uint64_t contact_touch(const DynamicsPlan *plan, uint32_t collider_count, float h, DynamicsState *dynamics, int begin,
                       int end) {
    uint64_t contacts = 0;
    float(*position)[4] = dynamics->position;
    for (int first = begin; first < end && collider_count > 0; first += 4) {
        int count = end - first < 4 ? end - first : 4;
        Quad x[4];
        for (int i = 0; i < 4; i++) x[i] = quad_load(position[first + (i < count ? i : 0)]);
        quad_transpose(x);
        for (uint32_t c = 0; c < collider_count; c++) {
            const MovingCollider *collider = &plan->colliders[c];
            if (!contact_any_near(collider, collider->def->kind == SINGE_COLLIDER_PLANE, x)) continue;
            for (int i = first; i < first + count; i++) {
                if (position[i][3] == 0) continue;
                Vec previous = vec_mad(vec_load(plan->predicted[i]), vec_load(dynamics->velocity[i]), -h);
                contacts += contact_particle(collider, previous, position[i]);
            }
            for (int i = 0; i < 4; i++) x[i] = quad_load(position[first + (i < count ? i : 0)]);
            quad_transpose(x);
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
    return (double)contact_touch(job->plan, job->collider_count, job->h, job->dynamics, begin, end);
}

uint64_t contact_project(DynamicsPlan *plan, uint32_t collider_count, Pool *pool, float h, DynamicsState *dynamics) {
    if (collider_count == 0) return 0;
    Contact job = {plan, collider_count, h, dynamics};
    return (uint64_t)pool_sum(pool, (int)plan->particle_count, contact_block, &job, plan->partial);
}

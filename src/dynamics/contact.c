// Contact with rigid primitives (section 7), with Coulomb friction. A substep has one projection, of all colours in
// their order, and contact closes it: once a substep, after the colours.
//
// A particle nearer than the collider's offset is moved out along the normal by its depth p. Its slip
// over the collider in this substep, tangential to the surface, is taken back by at most mu p: friction
// as positions (Mueller et al., Position based dynamics, 2007; Macklin et al. 2014).
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

uint64_t contact_touch(const DynamicsPlan *plan, uint32_t collider_count, float h, DynamicsState *dynamics, int begin,
                       int end) {
    uint64_t contacts = 0;
    for (uint32_t c = 0; c < collider_count; c++) {
        const MovingCollider collider = plan->colliders[c];
        bool plane = collider.def->kind == SINGE_COLLIDER_PLANE;
        float reach = plane ? collider.reach : collider.reach * collider.reach;
        for (int i = begin; i < end; i++) {
            float *x = dynamics->position[i];
            Vec way = vec_sub(vec_load(x), collider.after.position);
            float far = plane ? vec_dot(way, collider.normal) : vec_dot(way, way);
            if (far >= reach || x[3] == 0) continue;
            Vec previous = vec_mad(vec_load(plan->predicted[i]), vec_load(dynamics->velocity[i]), -h);
            contacts += contact_particle(&collider, previous, x);
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

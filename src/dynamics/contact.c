// Contact with rigid primitives (section 7), with Coulomb friction. A substep has one projection, of all colours in
// their order, and contact closes it: once a substep, after the colours.
//
// A particle nearer than the collider's offset is moved out along the normal by its depth p. Its slip
// over the collider in this substep, tangential to the surface, is taken back by at most mu p: friction
// as positions (Mueller et al., Position based dynamics, 2007; Macklin et al. 2014).
#include "dynamics/plan.h"

typedef struct Contact {
    DynamicsPlan *plan;
    uint32_t collider_count;
    float h;
    const DynamicsState *dynamics;
} Contact;

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

static double contact_range(void *task, int begin, int end) {
    Contact *job = task;
    double contacts = 0;
    for (int i = begin; i < end; i++) {
        if (job->plan->inverse_mass[i] == 0) continue;
        Vec previous = vec_mad(vec_load(job->plan->predicted[i]), vec_load(job->dynamics->velocity[i]), -job->h);
        for (uint32_t c = 0; c < job->collider_count; c++)
            contacts += contact_particle(&job->plan->colliders[c], previous, job->dynamics->position[i]);
    }
    return contacts;
}

uint64_t contact_project(DynamicsPlan *plan, uint32_t collider_count, Pool *pool, float h, DynamicsState *dynamics) {
    if (collider_count == 0) return 0;
    Contact job = {plan, collider_count, h, dynamics};
    return (uint64_t)pool_sum(pool, (int)plan->particle_count, contact_range, &job, plan->partial);
}

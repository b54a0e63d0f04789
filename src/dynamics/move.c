// Motion of single particles between two projections: contact with colliders, then eq 13 closes one substep,
//
//   v^ = v~ + (x^ - x~)/h
//
// (not (x^ - x)/h, which would round the whole motion at every substep), and eq 8 and 9 open the next, with the h
// that eq 9 lacks:
//
//   v~ = v + h F_ext / m,   x~ = x + h v~
//
// and attachments hold it. F_ext: gravity, and quadratic drag on the normal velocity relative to the air, taken
// implicitly (v_n <- v_n / (1 + h k |v_n|)), so that no time step makes it overshoot. Damping: v <- v / (1 + h d).
//
// The fourth component: of a position, the inverse mass, which its prediction repeats; of a velocity, 0.
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"

typedef struct Move {
    DynamicsPlan *plan;
    const Shell *shell;
    DynamicsState *dynamics;
    Between between;
    float h;
} Move;

/// Drag on a velocity that already has gravity and damping.
static inline Float4 move_drag(const DynamicsPlan *plan, uint32_t i, float h, Float4 velocity) {
    Float4 normal = float4_load(plan->normal[i]), slips = (velocity - float4_load(plan->air[i])) * normal;
    float slip = slips[0] + slips[1] + slips[2], k = h * plan->drag[i] * fabsf(slip);
    return velocity - slip * k / (1 + k) * normal;
}

/// Particles [begin, end); `plain` where none has drag and damping is the same for all.
static inline void move_particles(const Move *job, int begin, int end, bool closes, bool opens, bool plain) {
    const DynamicsPlan *plan = job->plan;
    const Field damping = job->shell->matter.damping;
    const float *gravity = plan->settings.gravity, *drag = plan->drag;
    float(*restrict position)[4] = job->dynamics->position, (*restrict velocities)[4] = job->dynamics->velocity;
    float(*restrict predicted)[4] = plan->predicted;
    float h = job->h, inverse_h = 1 / h, keep = 1 / (1 + h * field_at(damping, 0));
    Float4 fall = {h * gravity[0], h * gravity[1], h * gravity[2], 0};

    for (int i = begin; i < end; i++) {
        Float4 point = float4_load(position[i]), velocity = float4_load(velocities[i]);
        if (point[3] == 0) continue; // pinned or gone

        // eq 13: velocity of the substep that ends
        if (closes) velocity += (point - float4_load(predicted[i])) * inverse_h;

        // eq 8 and 9: forces and prediction of the next one
        if (opens) {
            if (!plain) keep = 1 / (1 + h * field_at(damping, (uint32_t)i));
            velocity = (velocity + fall) * keep;
            if (!plain && drag[i] > 0) velocity = move_drag(plan, (uint32_t)i, h, velocity);
            point += h * velocity;
            float4_store(position[i], point);
            float4_store(predicted[i], point);
        }

        float4_store(velocities[i], velocity);
    }
}

/// A block of particles stays in the cache during all of this.
static double move_block(void *task, int begin, int end) {
    const Move *job = task;
    DynamicsPlan *plan = job->plan;
    uint64_t contacts = contact_range(plan, job->between.collider_count, job->h, job->dynamics, begin, end);
    bool closes = job->between.closes, opens = job->between.opens;
    const Field drag = job->shell->matter.drag, damping = job->shell->matter.damping;
    bool still = plan->settings.air_density == 0 || (drag.mask == 0 && field_at(drag, 0) == 0);
    bool plain = still && damping.mask == 0;

    // each call becomes a loop of its own
    if (closes && opens && plain) move_particles(job, begin, end, true, true, true);
    else if (closes && opens) move_particles(job, begin, end, true, true, false);
    else if (closes) move_particles(job, begin, end, true, false, true);
    else if (opens) move_particles(job, begin, end, false, true, false);
    if (job->between.attaches)
        attach_range(&plan->attachments, job->shell, plan->kernels->hold, job->dynamics, begin, end);
    return (double)contacts;
}

uint64_t dynamics_move(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h, const Between *between,
                       DynamicsState *dynamics) {
    Move job = {plan, shell, dynamics, *between, h};
    if (between->attaches) attach_position(&plan->attachments, shell, dynamics);
    return (uint64_t)pool_sum(pool, (int)shell->particle_count, move_block, &job, plan->partial);
}

void dynamics_move_pins(DynamicsPlan *plan, const PinList *pins, const AblateState *ablate, double time, float h,
                        DynamicsState *dynamics) {
    for (uint32_t p = 0; p < pins->count; p++) {
        const Pin *pin = &pins->items[p];
        if (pin->generation == 0) continue;

        Pose pose = path_pose(&pin->path, time);
        const float share = motion_share(&pin->motion, time);
        for (uint32_t k = 0; k < pin->count; k++) {
            uint32_t i = pin->particles[k];
            if (!(ablate->particle_flags[i] & SINGE_ALIVE)) continue;
            Float3 point = pin_point(pin, &pose, k, share);
            float3_store(dynamics->velocity[i],
                         float3_scale(float3_sub(point, float3_load(dynamics->position[i])), 1 / h));
            float3_store(dynamics->position[i], point);
            float3_store(plan->predicted[i], point);
        }
    }
}

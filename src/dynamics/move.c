// Motion of single particles between two projections: contact with colliders, then eq 13 closes one substep,
//
//   v^ = v~ + (x^ - x~)/h
//
// (not (x^ - x)/h, which would round the whole motion at every substep), and eq 8 and 9 open the next, with the h
// that eq 9 lacks:
//
//   v~ = v + h F_ext / m,   x~ = x + h v~
//
// in vectors (move_kernel.h), and attachments hold it. Strands begin at x~ + s: forces change little from one substep to
// the next, so strands have less to correct, and leave less strain. With what they gave in the last two substeps,
//
//   s = 2 b g' + b^2 g'',   g' = (x^ - x~ - s)'
//
// a steady force is g (1 + b)^2, and the solver's `start` 1 - 1/(1 + b)^2 of it. The force comes 2 b/(1 + b) substeps late,
// less than the one by which eq 8 and 9 damp, for b < 1. Contact, which only pushes, is not in it; eq 13 is as before.
// Where s turns a displacement back, which is no force, there is hardly a start. F_ext: gravity, and quadratic drag on the
// normal velocity relative to the air, taken implicitly (v_n <- v_n / (1 + h k |v_n|)), so that no time step makes it
// overshoot.
// Damping: v <- v / (1 + h d).
//
// The fourth component: of a position, the inverse mass, which its prediction repeats; of a velocity, 0.
#include "dynamics/dynamics_plan.h"

#include <math.h>

typedef struct Move {
    DynamicsPlan *plan;
    const Shell *shell;
    Pool *pool;
    DynamicsState *dynamics;
    Between between;
    float h;
    MoveLanes lanes;
} Move;

/// Starts, where the solver has a `start`.
static void move_starts(const DynamicsPlan *plan, MoveLanes *lanes) {
    if (!plan->start) return;
    const float beta = 1 / sqrtf(1 - plan->settings.solver.start) - 1;
    lanes->start = plan->start[0];
    lanes->given = plan->given[0];
    lanes->share = 2 * beta;
    lanes->share_before = beta * beta;
}

/// A block of particles stays in the cache during all of this.
static double move_block(void *task, int begin, int end) {
    const Move *job = task;
    DynamicsPlan *plan = job->plan;
    if (job->between.collider_count > 0 && pool_cancelled(job->pool)) return 0; // which fails the step
    uint64_t contacts = contact_range(plan, job->between.collider_count, job->h, job->dynamics, begin, end);
    plan->kernels->move(&job->lanes, (size_t)begin, (size_t)end, job->between.closes, job->between.opens);
    if (job->between.attaches)
        attach_range(&plan->attachments, job->shell, plan->kernels->hold, job->dynamics, begin, end);
    return (double)contacts;
}

uint64_t dynamics_move(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h, const Between *between,
                       DynamicsState *dynamics) {
    const Field drag = shell->matter.drag, damping = shell->matter.damping;
    const float *gravity = plan->settings.gravity;
    Move job = {plan, shell, pool, dynamics, *between, h, {0}};
    job.lanes = (MoveLanes){.position = dynamics->position[0],
                            .velocity = dynamics->velocity[0],
                            .predicted = plan->predicted[0],
                            .normal = plan->normal[0],
                            .air = plan->air[0],
                            .air_mask = plan->air_mask ? SIZE_MAX : 0,
                            .kept = dynamics_keeps_start(plan, between->collider_count),
                            .h = h,
                            .inverse_h = 1 / h,
                            .keep = 1 / (1 + h * field_at(damping, 0)),
                            .fall = {h * gravity[0], h * gravity[1], h * gravity[2], 0},
                            .drags = plan->settings.air_density != 0 && (drag.mask != 0 || field_at(drag, 0) != 0),
                            .damps = damping.mask != 0};
    move_starts(plan, &job.lanes);
    if (between->attaches) attach_position(&plan->attachments, shell, dynamics);
    return (uint64_t)pool_sum(pool, (int)shell->particle_count, move_block, &job, plan->partial);
}

static void keep_block(void *task, int begin, int end) {
    const Move *job = task;
    job->plan->kernels->move(&job->lanes, (size_t)begin, (size_t)end, false, false);
}

void dynamics_keep_start(DynamicsPlan *plan, Pool *pool, DynamicsState *dynamics) {
    Move job = {.plan = plan};
    job.lanes = (MoveLanes){.position = dynamics->position[0], .predicted = plan->predicted[0]};
    move_starts(plan, &job.lanes);
    pool_for(pool, (int)plan->particle_count, POOL_BLOCK, keep_block, &job);
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

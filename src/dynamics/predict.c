// Eq 8 and 9, with the h that eq 9 lacks:
//
//   v~ = v + h F_ext / m,   x~ = x + h v~
//
// F_ext: gravity, and quadratic drag on the normal velocity relative to the air, taken implicitly
// (v_n <- v_n / (1 + h k |v_n|)), so that no time step makes it overshoot. Damping: v <- v / (1 + h d).
#include "dynamics/plan.h"

typedef struct Predict {
    DynamicsPlan *plan;
    const Shell *shell;
    DynamicsState *dynamics;
    float h;
} Predict;

static void predict_particles(void *task, int begin, int end) {
    Predict *job = task;
    DynamicsPlan *plan = job->plan;
    Vec fall = vec_scale(vec_load(plan->settings.gravity), job->h);
    for (int i = begin; i < end; i++) {
        float *x = job->dynamics->position[i], *v = job->dynamics->velocity[i];
        if (plan->inverse_mass[i] == 0) {
            vec_store(plan->predicted[i], vec_load(x));
            continue;
        }
        float damping = job->shell->matter.damping[i];
        Vec velocity = vec_scale(vec_add(vec_load(v), fall), 1 / (1 + job->h * damping));
        Vec normal = vec_load(plan->normal[i]);
        float slip = vec_dot(vec_sub(velocity, vec_load(plan->air[i])), normal);
        float k = job->h * plan->drag[i] * fabsf(slip);
        velocity = vec_mad(velocity, normal, -slip * k / (1 + k));
        vec_store(v, velocity);
        vec_store(x, vec_mad(vec_load(x), velocity, job->h));
        vec_store(plan->predicted[i], vec_load(x));
    }
}

void dynamics_predict(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h, DynamicsState *dynamics) {
    Predict job = {plan, shell, dynamics, h};
    pool_for(pool, (int)shell->particle_count, POOL_BLOCK, predict_particles, &job);
}

void dynamics_place_pins(DynamicsPlan *plan, const PinList *pins, const AblateState *ablate, double time, float h,
                         DynamicsState *dynamics) {
    for (uint32_t p = 0; p < pins->count; p++) {
        const Pin *pin = &pins->items[p];
        if (pin->generation == 0) continue;
        Pose pose = path_pose(&pin->path, time);
        for (uint32_t k = 0; k < pin->count; k++) {
            uint32_t i = pin->particles[k];
            if (!(ablate->particle_flags[i] & SINGE_ALIVE)) continue;
            Vec place = pose_apply(&pose, vec_load(pin->anchors[k]));
            vec_store(dynamics->velocity[i], vec_scale(vec_sub(place, vec_load(dynamics->position[i])), 1 / h));
            vec_store(dynamics->position[i], place);
            vec_store(plan->predicted[i], place);
        }
    }
}

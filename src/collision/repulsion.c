// Contact of sheets with themselves and each other, as positions.
//
// A touch is a point of one cell, P = sum w_i x_i over its corners, and one of another, Q, both taken where the two
// features are nearest as the step opens, and the normal n from Q to P then. In every substep
//
//   C = n . (P - Q) - g < 0   is projected:   x_i += m_i^-1 w_i n lambda,   lambda = -C / sum w_i^2 m_i^-1
//
// one after another. g is the thickness, or, of what is nearer already, so much more than it has that the two part by
// TOUCH_PART m/s. Slip across n since the substep began is taken back by at most mu |C| (Coulomb), as contact with
// colliders does. A virtual centre stands for its four corners by quarters. What lies
// nearer at rest than twice the thickness (the lips of a tear) is kept apart by four times the guard's gap only.
#include "common/clock.h"
#include "collision/collision_plan.h"

/// Takes back slip across the normal, at most `most`.
static void rub(const TouchPush *push, const float (*predicted)[4], float h, float most, float weight,
                DynamicsState *dynamics) {
    float(*x)[4] = dynamics->position;
    Quad slip = {0};
    for (uint32_t i = 0; i < push->count; i++) {
        uint32_t at = push->node[i];
        Quad before = quad_load(predicted[at]) - h * quad_load(dynamics->velocity[at]);
        slip += push->weight[i] * (quad_load(x[at]) - before);
    }
    slip[3] = 0;
    slip -= quad_dot(slip, push->normal) * push->normal;
    float length = sqrtf(quad_dot(slip, slip));
    if (!(length > 0)) return;
    Quad back = (length <= most ? 1 : most / length) / weight * slip;
    for (uint32_t i = 0; i < push->count; i++) {
        Quad place = quad_load(x[push->node[i]]);
        quad_store(x[push->node[i]], place - place[3] * push->weight[i] * back);
    }
}

void touch_push(TouchPlan *plan, const float (*predicted)[4], float h, DynamicsState *dynamics) {
    double start = clock_seconds();
    float(*x)[4] = dynamics->position;
    for (uint32_t k = 0; k < plan->push_count; k++) {
        const TouchPush *push = &plan->pushes[k];
        Quad apart = {0};
        for (uint32_t i = 0; i < push->count; i++) apart += push->weight[i] * quad_load(x[push->node[i]]);
        float height = quad_dot(apart, push->normal) - push->target, weight = 0;
        if (height >= 0) continue;
        for (uint32_t i = 0; i < push->count; i++) weight += push->weight[i] * push->weight[i] * x[push->node[i]][3];
        if (weight <= 0) continue;
        Quad away = -height / weight * push->normal;
        for (uint32_t i = 0; i < push->count; i++) {
            Quad place = quad_load(x[push->node[i]]);
            quad_store(x[push->node[i]], place + place[3] * push->weight[i] * away);
        }
        if (plan->def.friction > 0) rub(push, predicted, h, -plan->def.friction * height, weight, dynamics);
        plan->counters.pushes++;
    }
    plan->counters.seconds += clock_seconds() - start;
}

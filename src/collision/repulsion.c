// Contact of sheets with themselves and each other, by positions.
//
// A contact is a point of one cell, P = sum w_i x_i over its corners, and one of another, Q, both where the two
// features are nearest at the start of the step, and the normal n from Q to P then. In every substep
//
//   C = n . (P - Q) - g < 0   is projected:   x_i += m_i^-1 w_i n lambda,   lambda = -C / sum w_i^2 m_i^-1
//
// one after another. g is the thickness; for points that are nearer at the start, it is their distance plus as much as
// separates them at COLLISION_PART m/s. Slip across n since the substep began is taken back by at most mu |C|
// (Coulomb), as in contact with colliders. A virtual centre is replaced by its four corners, a quarter each. Points
// nearer at rest than twice the thickness (the edges of a tear) are kept apart by four times CCD's gap only.
#include "common/clock.h"
#include "collision/collision_plan.h"

void repulsion_apply(CollisionPlan *plan, const float (*predicted)[4], float h, DynamicsState *dynamics) {
    double start = clock_seconds();
    float(*x)[4] = dynamics->position;
    for (uint32_t k = 0; k < plan->repulsion_count; k++) {
        const Repulsion *repulsion = &plan->repulsions[k];

        // how much too near the two points are
        Float4 separation = {0};
        for (uint32_t i = 0; i < repulsion->count; i++)
            separation += repulsion->weight[i] * float4_load(x[repulsion->node[i]]);
        float height = float4_dot(separation, repulsion->normal) - repulsion->target, weight = 0;
        if (height >= 0) continue;

        for (uint32_t i = 0; i < repulsion->count; i++)
            weight += repulsion->weight[i] * repulsion->weight[i] * x[repulsion->node[i]][3];
        if (weight <= 0) continue;

        // move them apart along the normal
        Float4 away = -height / weight * repulsion->normal;
        for (uint32_t i = 0; i < repulsion->count; i++) {
            Float4 position = float4_load(x[repulsion->node[i]]);
            float4_store(x[repulsion->node[i]], position + position[3] * repulsion->weight[i] * away);
        }

        plan->counters.repulsions++;
        if (!(plan->def.friction > 0)) continue;

        // friction: take back slip across the normal, at most `max`
        const float max = -plan->def.friction * height;
        Float4 slip = {0};
        for (uint32_t i = 0; i < repulsion->count; i++) {
            uint32_t at = repulsion->node[i];
            Float4 before = float4_load(predicted[at]) - h * float4_load(dynamics->velocity[at]);
            slip += repulsion->weight[i] * (float4_load(x[at]) - before);
        }

        slip[3] = 0;
        slip -= float4_dot(slip, repulsion->normal) * repulsion->normal;
        float length = sqrtf(float4_dot(slip, slip));
        if (!(length > 0)) continue;

        Float4 back = (length <= max ? 1 : max / length) / weight * slip;
        for (uint32_t i = 0; i < repulsion->count; i++) {
            Float4 position = float4_load(x[repulsion->node[i]]);
            float4_store(x[repulsion->node[i]], position - position[3] * repulsion->weight[i] * back);
        }
    }

    plan->counters.push_seconds += clock_seconds() - start;
}

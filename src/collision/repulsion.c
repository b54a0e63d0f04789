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
//
// One pass carries a push from a layer to the next. In a crowd, where layers lie on many others, there are more passes, in
// turn forwards and backwards: what they leave is work for CCD, which costs many times more.
#include "common/clock.h"
#include "collision/collision_plan.h"

/// Repulsions per cell from which on there are more passes, and the most passes. Folds and heaps have up to .8, ten layers
/// 2 to 5.
enum { CROWD_FROM = 1, CROWD_PASSES = 8 };

/// The vector between two points: the sum of weight x over `count` vertices.
typedef struct Points {
    uint32_t node[8], count;
    float weight[8];
} Points;

/// Adds the corners of a cell; cells that are connected have some in common.
static void points_add(Points *points, const uint32_t corner[4], const float weight[4], float sign) {
    for (int i = 0; i < 4; i++) {
        if (weight[i] == 0) continue;
        uint32_t k = 0;
        while (k < points->count && points->node[k] != corner[i]) k++;
        if (k == points->count) {
            points->node[points->count] = corner[i];
            points->weight[points->count++] = 0;
        }

        points->weight[k] += sign * weight[i];
    }
}

static inline void repulsion_push(CollisionPlan *plan, const Shell *shell, const Repulsion *repulsion,
                                  const float (*predicted)[4], float h, DynamicsState *dynamics) {
    float(*x)[4] = dynamics->position, wa[4] = {0}, wb[4] = {0};
    const Float4 normal = {repulsion->normal[0], repulsion->normal[1], repulsion->normal[2], 0};
    const CollisionPair *pair = &plan->pairs[repulsion->pair];
    Points points;
    points.count = 0;
    collision_weights(repulsion->kind, repulsion->first, repulsion->second, repulsion->u, repulsion->v, wa, wb);
    points_add(&points, shell->cells[pair->a], wa, 1);
    points_add(&points, shell->cells[pair->b], wb, -1);

    // how much too near the two points are
    Float4 separation = {0};
    for (uint32_t i = 0; i < points.count; i++) separation += points.weight[i] * float4_load(x[points.node[i]]);
    float height = float4_dot(separation, normal) - repulsion->target, weight = 0;
    if (height >= 0) return;

    for (uint32_t i = 0; i < points.count; i++) weight += points.weight[i] * points.weight[i] * x[points.node[i]][3];
    if (weight <= 0) return;

    // move them apart along the normal
    Float4 away = -height / weight * normal;
    for (uint32_t i = 0; i < points.count; i++) {
        Float4 position = float4_load(x[points.node[i]]);
        float4_store(x[points.node[i]], position + position[3] * points.weight[i] * away);
    }

    plan->counters.repulsions++;
    if (!(plan->def.friction > 0)) return;

    // friction: take back slip across the normal, at most `max`
    const float max = -plan->def.friction * height;
    Float4 slip = {0};
    for (uint32_t i = 0; i < points.count; i++) {
        uint32_t at = points.node[i];
        Float4 before = float4_load(predicted[at]) - h * float4_load(dynamics->velocity[at]);
        slip += points.weight[i] * (float4_load(x[at]) - before);
    }

    slip[3] = 0;
    slip -= float4_dot(slip, normal) * normal;
    float length = sqrtf(float4_dot(slip, slip));
    if (!(length > 0)) return;

    Float4 back = (length <= max ? 1 : max / length) / weight * slip;
    for (uint32_t i = 0; i < points.count; i++) {
        Float4 position = float4_load(x[points.node[i]]);
        float4_store(x[points.node[i]], position - position[3] * points.weight[i] * back);
    }
}

void repulsion_apply(CollisionPlan *plan, const Shell *shell, const float (*predicted)[4], float h,
                     DynamicsState *dynamics) {
    const double start = clock_seconds();
    const uint32_t count = plan->repulsion_count, cells = plan->cell_count;
    uint64_t passes = 1;
    if (count > CROWD_FROM * (uint64_t)cells) passes = 1 + 2 * (uint64_t)count / cells;
    if (passes > CROWD_PASSES) passes = CROWD_PASSES;
    for (uint64_t pass = 0; pass < passes; pass++) {
        const uint64_t before = plan->counters.repulsions;
        for (uint32_t k = 0; k < count; k++)
            repulsion_push(plan, shell, &plan->repulsions[pass & 1 ? count - 1 - k : k], predicted, h, dynamics);
        if (plan->counters.repulsions == before) break;
    }

    plan->counters.push_seconds += clock_seconds() - start;
}

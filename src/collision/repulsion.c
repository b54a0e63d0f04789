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
// One pass carries a push from a layer to the next. In a crowd, where layers lie on many others, there are several turns of
// two passes, forwards and backwards: what they leave is work for CCD, which costs many times more. All turns but the last
// push points CROWD_RELAX times as far as they must (over-relaxation), so that a pass carries a push through more layers.
// Between turns the dynamics shorten the sides that pushes have stretched. A crowd's pairs are sorted into stripes across
// its longest axis, each wider than twice what a pair's corners reach from its first corner. So stripes that are not beside
// each other share no vertex: threads take the even ones, then the odd ones. Stripes follow from the positions alone, not
// from the number of threads.
#include "common/clock.h"
#include "common/real.h"
#include "collision/collision_plan.h"

#include <math.h>
#include <string.h>

/// Repulsions per cell from which on there are more turns, and the most turns. Folds and heaps have up to .8, ten layers
/// 2 to 5.
enum { CROWD_FROM = 1, CROWD_TURNS = 3 };
#define CROWD_RELAX 1.7f

typedef struct Push {
    CollisionPlan *plan;
    const Shell *shell;
    const float (*predicted)[4];
    float h;
    DynamicsState *dynamics;
    float relax; ///< pushes go this many times as far as they must
    int odd;     ///< stripes
} Push;

static inline Float4 repulsion_weights(const uint16_t weight[4]) {
    const Float4Mask whole = {weight[0], weight[1], weight[2], weight[3]};
    return __builtin_convertvector(whole, Float4) * (1.0f / REPULSION_ONE);
}

/// The sum of weight x over the corners of two cells. Of cells that are connected, those in common count once.
typedef struct Points {
    uint32_t node[8];
    float weight[8];
} Points;

/// Moves the points by `shift`, each corner according to its weight and inverse mass.
static inline void points_move(const Points *points, float (*x)[4], Float4 shift) {
    for (int i = 0; i < 8; i++) {
        if (points->weight[i] == 0) continue;
        const Float4 position = float4_load(x[points->node[i]]);
        float4_store(x[points->node[i]], position + position[3] * points->weight[i] * shift);
    }
}

/// Returns whether the points were too near.
static inline bool repulsion_push(const Push *push, const Repulsion *repulsion) {
    const CollisionPlan *plan = push->plan;
    const DynamicsState *dynamics = push->dynamics;
    float(*x)[4] = dynamics->position;
    const Float4Mask whole = {repulsion->normal[0], repulsion->normal[1], repulsion->normal[2], 0};
    const Float4 normal = __builtin_convertvector(whole, Float4) * (1.0f / REPULSION_UNIT);
    const float target = (float)repulsion->target * (plan->thickness / REPULSION_FULL);
    const uint32_t *a = push->shell->cells[repulsion->a], *b = push->shell->cells[repulsion->b];
    const Float4 wa = repulsion_weights(repulsion->weight[0]), wb = repulsion_weights(repulsion->weight[1]);

    // most points are far enough apart
    Float4 apart = {0};
    for (int i = 0; i < 4; i++) apart += wa[i] * float4_load(x[a[i]]);
    for (int i = 0; i < 4; i++) apart -= wb[i] * float4_load(x[b[i]]);
    const float height = float4_dot(apart, normal) - target;
    if (height >= 0) return false;

    Points points;
    memcpy(points.node, a, 4 * sizeof *a), memcpy(points.node + 4, b, 4 * sizeof *b);
    float4_store(points.weight, wa), float4_store(points.weight + 4, -wb);

    unsigned same[4];
    collision_same(a, b, same);

    for (int i = 0; i < 4; i++) {
        if (!same[i]) continue;
        const int twin = 4 + __builtin_ctz(same[i]);
        points.weight[i] += points.weight[twin];
        points.weight[twin] = 0;
    }

    // move them apart along the normal
    float weight = 0;
    for (int i = 0; i < 8; i++) weight += points.weight[i] * points.weight[i] * x[points.node[i]][3];
    if (weight <= 0) return false;
    points_move(&points, x, -push->relax * height / weight * normal);
    if (!(plan->def.friction > 0)) return true;

    // friction: take back slip across the normal since the substep began, at most `max`
    const float max = -plan->def.friction * height;
    Float4 slip = {0};
    for (int i = 0; i < 8; i++) {
        const uint32_t at = points.node[i];
        const Float4 before = float4_load(push->predicted[at]) - push->h * float4_load(dynamics->velocity[at]);
        slip += points.weight[i] * (float4_load(x[at]) - before);
    }

    slip[3] = 0;
    slip -= float4_dot(slip, normal) * normal;
    const float length = sqrtf(float4_dot(slip, slip));
    if (length > 0) points_move(&points, x, -(length <= max ? 1 : max / length) / weight * slip);
    return true;
}

static void push_stripes(void *task, int begin, int end) {
    const Push *push = task;
    CollisionPlan *plan = push->plan;
    for (int k = begin; k < end; k++) {
        const int s = 2 * k + push->odd;
        const uint32_t first = plan->stripe_first[s], last = plan->stripe_first[s + 1];
        uint32_t pushed = 0;
        for (uint32_t i = first; i < last; i++) pushed += repulsion_push(push, &plan->repulsions[i]);
        for (uint32_t i = last; i-- > first;) pushed += repulsion_push(push, &plan->repulsions[i]);
        plan->stripe_pushed[s] = pushed;
    }
}

void repulsion_sort(CollisionPlan *plan, const Shell *shell, const float (*x)[4]) {
    const uint32_t count = plan->repulsion_count;
    plan->stripe_count = 0;
    if (count <= CROWD_FROM * (uint64_t)plan->cell_count || count > plan->listed_count) return; // `active` has no room

    // where pairs are, and how far their corners reach
    Float4 low = float4_all(INFINITY), high = -low, reach = {0};
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t *a = shell->cells[plan->repulsions[k].a], *b = shell->cells[plan->repulsions[k].b];
        const Float4 here = float4_load(x[a[0]]);
        low = float4_min(low, here);
        high = float4_max(high, here);
        for (int i = 0; i < 8; i++) {
            const Float4 off = float4_load(x[i < 4 ? a[i] : b[i - 4]]) - here;
            reach = float4_max(reach, float4_max(off, -off));
        }
    }

    int axis = 0;
    for (int d = 1; d < 3; d++)
        if (high[d] - low[d] > high[axis] - low[axis]) axis = d;
    const float length = high[axis] - low[axis];
    const float width = float_max(2.1f * reach[axis], length / (COLLISION_STRIPES - 1));
    if (!(width > 0) || !(length > 3 * width)) return;

    // sort
    uint32_t *first = plan->stripe_first;
    plan->stripe_count = (uint32_t)(length / width) + 1;
    memset(first, 0, sizeof plan->stripe_first);

    for (int turn = 0; turn < 2; turn++) {
        for (uint32_t k = 0; k < count; k++) {
            const float at = x[shell->cells[plan->repulsions[k].a][0]][axis];
            const uint32_t s = (uint32_t)((at - low[axis]) / width);
            if (turn == 0) first[s + 2]++;
            else plan->active[k] = first[s + 1]++;
        }
        for (uint32_t s = 0; turn == 0 && s < plan->stripe_count; s++) first[s + 2] += first[s + 1];
    }
}

int repulsion_turns(const CollisionPlan *plan) {
    const uint64_t count = plan->repulsion_count, cells = plan->cell_count;
    if (count <= CROWD_FROM * cells) return 1;
    const uint64_t turns = 1 + count / cells;
    return turns < CROWD_TURNS ? (int)turns : CROWD_TURNS;
}

bool repulsion_apply(CollisionPlan *plan, const Shell *shell, Pool *pool, const float (*predicted)[4], float h,
                     bool last, DynamicsState *dynamics) {
    const double start = clock_seconds();
    const uint32_t count = plan->repulsion_count;
    Push push = {plan, shell, predicted, h, dynamics, last ? 1 : CROWD_RELAX, 0};
    uint64_t pushed = 0;

    // both passes over a stripe while its vertices are in the processor's cache
    for (push.odd = 0; push.odd < 2 && plan->stripe_count > 0; push.odd++)
        pool_for(pool, (int)(plan->stripe_count + 1 - (uint32_t)push.odd) / 2, 1, push_stripes, &push);
    for (uint32_t s = 0; s < plan->stripe_count; s++) pushed += plan->stripe_pushed[s];

    // or all in turn, back again in a crowd
    const bool crowd = count > CROWD_FROM * (uint64_t)plan->cell_count;
    for (uint32_t k = 0; k < count && plan->stripe_count == 0; k++)
        pushed += repulsion_push(&push, &plan->repulsions[k]);
    for (uint32_t k = count; crowd && plan->stripe_count == 0 && k-- > 0;)
        pushed += repulsion_push(&push, &plan->repulsions[k]);

    plan->counters.repulsions += pushed;
    plan->counters.push_seconds += clock_seconds() - start;
    return pushed > 0;
}

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
#include "base/clock.h"
#include "contact/touch_near.h"
#include "contact/touch_plan.h"

#include <string.h>

/// m/s with which is mended what is too near.
#define TOUCH_PART 0.1f

// ---- touches as the step opens

/// Adds a node's weight to the corners of its cell.
static void add_node(float corner[4], int node, float weight) {
    if (node < 4) {
        corner[node] += weight;
        return;
    }
    for (int i = 0; i < 4; i++) corner[i] += 0.25f * weight;
}

/// Two cells' nodes about the first corner of a.
typedef struct PairNodes {
    Quad a[5], b[5];
} PairNodes;

static void pair_nodes(const Shell *shell, const float (*x)[4], const TouchPair *pair, PairNodes *nodes) {
    Quad origin = quad_load(x[shell->cells[pair->a][0]]);
    touch_nodes(shell->cells[pair->a], x, origin, nodes->a);
    touch_nodes(shell->cells[pair->b], x, origin, nodes->b);
}

/// Points of edges `bit`: weights of the corners of a and of b, and from the second point to the first.
static Quad edge_points(const PairNodes *nodes, int bit, float wa[4], float wb[4]) {
    const uint8_t *k = touch_edge[bit >> 3], *l = touch_edge[bit & 7];
    float s, t;
    Quad apart = touch_from_segment(nodes->a[k[0]], nodes->a[k[1]], nodes->b[l[0]], nodes->b[l[1]], &s, &t);
    add_node(wa, k[0], 1 - s), add_node(wa, k[1], s);
    add_node(wb, l[0], 1 - t), add_node(wb, l[1], t);
    return apart;
}

/// The same of a node and a triangle. *inside is whether the node lies over the triangle, not beside it.
static Quad node_points(const PairNodes *nodes, int bit, float wa[4], float wb[4], bool *inside) {
    bool turned = bit >= 20;
    int own = bit - (turned ? 20 : 0), node = own >> 2;
    const uint8_t *k = touch_triangle[own & 3];
    const Quad *from = turned ? nodes->b : nodes->a, *to = turned ? nodes->a : nodes->b;
    float weight[3], *wn = turned ? wb : wa, *wt = turned ? wa : wb;
    Quad apart = touch_from_triangle(from[node], to[k[0]], to[k[1]], to[k[2]], weight);
    *inside = weight[0] > 0 && weight[1] > 0 && weight[2] > 0;
    add_node(wn, node, 1);
    for (int i = 0; i < 3; i++) add_node(wt, k[i], weight[i]);
    return turned ? -apart : apart;
}

/// Distance at rest of the two points, within one sheet.
static float rest_distance(const Shell *shell, const TouchPair *pair, const float wa[4], const float wb[4]) {
    uint32_t first = shell_centre(shell, pair->a), second = shell_centre(shell, pair->b);
    if (shell->matter.sheet[first] != shell->matter.sheet[second]) return INFINITY;
    Quad apart = {0};
    for (int i = 0; i < 4; i++)
        apart += wa[i] * quad_load(shell->rest_position[shell->cells[pair->a][i]]) -
                 wb[i] * quad_load(shell->rest_position[shell->cells[pair->b][i]]);
    return sqrtf(quad_dot(apart, apart));
}

static void gather(TouchPush *push, const uint32_t corner[4], const float weight[4], float sign) {
    for (int i = 0; i < 4; i++) {
        if (weight[i] == 0) continue;
        uint32_t k = 0;
        while (k < push->count && push->node[k] != corner[i]) k++;
        if (k == push->count) {
            push->node[push->count] = corner[i];
            push->weight[push->count++] = 0;
        }
        push->weight[k] += sign * weight[i];
    }
}

typedef struct Opening {
    TouchPlan *plan;
    const Shell *shell;
    const DynamicsState *dynamics;
    const uint8_t *cell_flags;
} Opening;

/// Whether any points of a pair may have to be pushed in this step.
static bool pair_is_due(const Opening *job, const TouchPair *pair) {
    const TouchPlan *plan = job->plan;
    if (!(pair->nodes | pair->edges)) return false;
    const TouchMotion *a = &plan->motion[pair->a], *b = &plan->motion[pair->b];
    float due = 1.25f * plan->thickness + 1.5f * plan->time_step * touch_differ(a->speed, b->speed);
    if (pair->distance - touch_differ(a->way, b->way) > due) return false;
    return (job->cell_flags[pair->a] & job->cell_flags[pair->b] & SINGE_ALIVE) && !touch_is_tangled(plan, pair);
}

/// What a feature's points need in this step; count 0 for nothing.
static TouchPush open_feature(const Opening *job, const TouchPair *pair, const PairNodes *nodes, bool edges, int bit) {
    const TouchPlan *plan = job->plan;
    const uint32_t *a = job->shell->cells[pair->a], *b = job->shell->cells[pair->b];
    TouchPush push = {.count = 0};
    float wa[4] = {0}, wb[4] = {0}, thickness = plan->thickness;
    bool inside = true;
    Quad apart = edges ? edge_points(nodes, bit, wa, wb) : node_points(nodes, bit, wa, wb, &inside);
    float distance = sqrtf(quad_dot(apart, apart));
    // beside a triangle a node may be over the next one: a normal that stays would make a ridge of the edge between
    if (!inside && distance > thickness) return push;
    const TouchMotion *p = &plan->motion[pair->a], *q = &plan->motion[pair->b];
    if (!(distance > 0) ||
        distance > 1.25f * thickness + 1.5f * plan->time_step * touch_differ(p->speed, q->speed))
        return push;
    push.normal = apart / distance;
    Quad speed = {0};
    for (int i = 0; i < 4; i++)
        speed += wa[i] * quad_load(job->dynamics->velocity[a[i]]) - wb[i] * quad_load(job->dynamics->velocity[b[i]]);
    float toward = -quad_dot(speed, push.normal) * plan->time_step;
    if (distance > 1.25f * thickness + 1.5f * (toward > 0 ? toward : 0)) return push;
    if (rest_distance(job->shell, pair, wa, wb) < 2 * thickness) thickness = fminf(thickness, 4 * plan->gap);
    if (distance > 1.25f * thickness + 1.5f * (toward > 0 ? toward : 0)) return push;
    float parted = distance + TOUCH_PART * plan->time_step;
    push.target = parted < thickness ? parted : thickness;
    gather(&push, a, wa, 1);
    gather(&push, b, wb, -1);
    return push;
}

/// Finds which features of a pair are to be pushed. Returns how many.
static uint32_t look_at_pair(const Opening *job, TouchPair *pair) {
    pair->push_nodes = pair->push_edges = 0;
    if (!pair_is_due(job, pair)) return 0;
    PairNodes nodes;
    uint32_t count = 0;
    pair_nodes(job->shell, (const float(*)[4])job->dynamics->position, pair, &nodes);
    for (int kind = 0; kind < 2; kind++) {
        uint64_t bits = kind ? pair->edges : pair->nodes, found = 0;
        for (int bit = 0; bit < 64 && bits >> bit; bit++) {
            if (!(bits >> bit & 1) || open_feature(job, pair, &nodes, kind, bit).count == 0) continue;
            found |= UINT64_C(1) << bit;
            count++;
        }
        if (kind) pair->push_edges = found;
        else pair->push_nodes = found;
    }
    return count;
}

static uint32_t open_pair(const Opening *job, const TouchPair *pair, uint32_t at) {
    TouchPlan *plan = job->plan;
    PairNodes nodes;
    if (!(pair->push_nodes | pair->push_edges)) return at;
    pair_nodes(job->shell, (const float(*)[4])job->dynamics->position, pair, &nodes);
    for (int kind = 0; kind < 2; kind++) {
        uint64_t bits = kind ? pair->push_edges : pair->push_nodes;
        for (int bit = 0; bit < 64 && bits >> bit && at < plan->push_capacity; bit++)
            if (bits >> bit & 1) plan->pushes[at++] = open_feature(job, pair, &nodes, kind, bit);
    }
    return at;
}

/// Blocks of pairs: counts what each is to push, and then writes it from the block's start on.
static void look_blocks(void *task, int begin, int end) {
    const Opening *job = task;
    TouchPlan *plan = job->plan;
    for (int block = begin; block < end; block++) {
        uint32_t first = (uint32_t)block * TOUCH_BLOCK, last = first + TOUCH_BLOCK, count = 0;
        if (last > plan->listed_count) last = plan->listed_count;
        for (uint32_t k = first; k < last; k++) count += look_at_pair(job, &plan->pairs[k]);
        plan->block_count[block] = count;
    }
}

static void open_blocks(void *task, int begin, int end) {
    const Opening *job = task;
    TouchPlan *plan = job->plan;
    for (int block = begin; block < end; block++) {
        uint32_t first = (uint32_t)block * TOUCH_BLOCK, last = first + TOUCH_BLOCK, at = plan->block_count[block];
        if (last > plan->listed_count) last = plan->listed_count;
        for (uint32_t k = first; k < last; k++) at = open_pair(job, &plan->pairs[k], at);
    }
}

static void open_pushes(Opening *job, Pool *pool) {
    TouchPlan *plan = job->plan;
    uint32_t blocks = (plan->listed_count + TOUCH_BLOCK - 1) / TOUCH_BLOCK;
    pool_for(pool, (int)blocks, 1, look_blocks, job);
    uint64_t count = touch_sum_blocks(plan->block_count, blocks);
    plan->push_count = (uint32_t)(count < plan->push_capacity ? count : plan->push_capacity);
    plan->counters.dropped += count - plan->push_count;
    pool_for(pool, (int)blocks, 1, open_blocks, job);
}

static void way_range(void *task, int begin, int end) {
    const Opening *job = task;
    for (int c = begin; c < end; c++) {
        const uint32_t *corner = job->shell->cells[c];
        Quad vector[4]; // fourths: of places inverse masses, which count for nothing
        touch_ways(job->plan, corner, (const float(*)[4])job->dynamics->position, vector);
        job->plan->motion[c].way = touch_mean(vector);
        for (int i = 0; i < 4; i++) vector[i] = quad_load(job->dynamics->velocity[corner[i]]);
        job->plan->motion[c].speed = touch_mean(vector);
    }
}

/// Notes where cells are and how they move: as since the last search, for what lies trembles; else by their velocities.
static void note_search(TouchPlan *plan, const Shell *shell, const State *state, const DynamicsState *dynamics) {
    bool known = plan->searched && state->step > plan->step;
    float since = known ? (float)(state->step - plan->step) * plan->time_step : 1;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        const uint32_t *at = shell->cells[c];
        Quad sum = {0};
        for (int i = 0; i < 4; i++)
            sum += known ? quad_load(dynamics->position[at[i]]) - quad_load(plan->place[at[i]])
                         : quad_load(dynamics->velocity[at[i]]);
        sum[3] = 0;
        quad_store(plan->speed[c], 0.25f / since * sum);
        plan->alive[c] = state->ablate.cell_flags[c] & SINGE_ALIVE;
    }
    memcpy(plan->place, dynamics->position, plan->vertex_count * sizeof *plan->place);
    plan->step = state->step;
}

void touch_open(TouchPlan *plan, const Shell *shell, const State *state, Pool *pool, const DynamicsState *dynamics) {
    double start = clock_seconds();
    memcpy(plan->start, dynamics->position, plan->vertex_count * sizeof *plan->start);
    if (!plan->searched || plan->restless || state->step < plan->step || state->step - plan->step >= plan->steps) {
        note_search(plan, shell, state, dynamics);
        touch_search(plan, shell, pool);
    }
    Opening job = {plan, shell, dynamics, state->ablate.cell_flags};
    pool_for(pool, (int)plan->cell_count, 512, way_range, &job);
    open_pushes(&job, pool);
    plan->counters.touches += plan->push_count;
    plan->counters.seconds += clock_seconds() - start;
}

// ---- in a substep

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
        float height = -push->target, weight = 0;
        for (uint32_t i = 0; i < push->count; i++) {
            const float *at = x[push->node[i]];
            height += push->weight[i] * quad_dot(quad_load(at), push->normal);
            weight += push->weight[i] * push->weight[i] * at[3];
        }
        if (height >= 0 || weight <= 0) continue;
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

// ---- what is near, for drawing

static bool pair_is_near(const Shell *shell, const float (*x)[4], const TouchPair *pair, float far) {
    PairNodes nodes;
    pair_nodes(shell, x, pair, &nodes);
    for (int kind = 0; kind < 2; kind++) {
        uint64_t bits = kind ? pair->edges : pair->nodes;
        for (int bit = 0; bit < 64 && bits >> bit; bit++) {
            if (!(bits >> bit & 1)) continue;
            float wa[4] = {0}, wb[4] = {0};
            bool inside;
            Quad apart = kind ? edge_points(&nodes, bit, wa, wb) : node_points(&nodes, bit, wa, wb, &inside);
            if (quad_dot(apart, apart) < far * far) return true;
        }
    }
    return false;
}

void touch_mark_near(const TouchPlan *plan, const Shell *shell, const State *state, uint8_t *near) {
    const float(*x)[4] = (const float(*)[4])state->dynamics.position;
    float bulges = 0.25f * plan->cell_size; // two drawn surfaces leave their triangles by a tenth of a cell each
    for (uint32_t k = 0; plan->searched && k < plan->listed_count; k++) {
        const TouchPair *pair = &plan->pairs[k];
        if (!(pair->nodes | pair->edges) || pair->distance > 4 * plan->reach ||
            !(state->ablate.cell_flags[pair->a] & state->ablate.cell_flags[pair->b] & SINGE_ALIVE))
            continue;
        const uint32_t *a = shell->cells[pair->a], *b = shell->cells[pair->b];
        if (pair_is_near(shell, x, pair, bulges))
            for (int i = 0; i < 4; i++) near[a[i]] = near[b[i]] = 1;
    }
}

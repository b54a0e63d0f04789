// What a step opens with: pairs of cells that are near, and what of them its substeps may have to push.
//
// A pair's distance is kept as a bound: it is at least that of the last time it was measured, less what the two cells
// have moved against each other since. Only where the bound does not tell that all features stay apart in this step are
// they looked at. So what is found hangs on the pair's places and speeds alone, not on when it was measured.
#include "common/clock.h"
#include "common/error.h"
#include "collision/narrow_phase.h"
#include "collision/feature_distance.h"

#include <string.h>

/// m/s with which is mended what is too near.
#define TOUCH_PART 0.1f

/// Of the thickness: where a slab as thick parts two cells, their nodes keep them apart well enough without their
/// edges.
#define TOUCH_PARTED 0.6f

typedef struct Opening {
    TouchPlan *plan;
    const Shell *shell;
    const DynamicsState *dynamics;
    const uint8_t *cell_flags;
    bool searched; ///< just now
    bool again;    ///< the pairs' distances are already this step's
} Opening;

// ---- how cells move

/// Whether a cell is as the last step's guard has left, and measured, it.
static bool is_as_left(const TouchPlan *plan, const uint32_t corner[4], const float (*x)[4]) {
    QuadMask moved = {0};
    for (int i = 0; i < 4; i++) moved |= quad_load(x[corner[i]]) != quad_load(plan->end[corner[i]]);
    return !(quad_bits(moved) & 7); // the fourths are inverse masses
}

static void measure_range(void *task, int begin, int end) {
    const Opening *job = task;
    TouchPlan *plan = job->plan;
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    for (int c = begin; c < end; c++) {
        const uint32_t *corner = job->shell->cells[c];
        Quad *motion = plan->motion[c];
        Quad speed[4], node[5];
        for (int i = 0; i < 4; i++) speed[i] = quad_load(job->dynamics->velocity[corner[i]]);
        motion[TOUCH_VELOCITY] = touch_mean(speed);
        bool known = plan->closed && is_as_left(plan, corner, x);
        if (!known || job->searched) motion[TOUCH_WAY] = touch_way(plan, corner, x);
        if (known) continue;
        touch_nodes(corner, x, quad_load(x[corner[0]]), node);
        motion[TOUCH_NORMAL] = touch_normals(node);
    }
}

/// Notes where corners are and how they move: as since the last search, for what lies trembles; else by their
/// velocities.
static void note_search(TouchPlan *plan, const State *state, const DynamicsState *dynamics) {
    bool known = plan->searched && state->step > plan->step;
    float since = known ? (float)(state->step - plan->step) * plan->time_step : 1;
    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        Quad now = quad_load(dynamics->position[v]);
        Quad speed = known ? (now - quad_load(plan->place[v])) / since : quad_load(dynamics->velocity[v]);
        speed[3] = 0;
        quad_store(plan->speed[v], speed);
        quad_store(plan->place[v], now);
    }
    for (uint32_t c = 0; c < plan->cell_count; c++) plan->alive[c] = state->ablate.cell_flags[c] & SINGE_ALIVE;
    plan->step = state->step;
}

// ---- what is near

/// Two cells that are looked at.
typedef struct Look {
    TouchCell a, b;
    Quad speed_a[5], speed_b[5]; ///< m/s, of nodes
    float due; ///< m, distance from which on nothing can touch in this step
} Look;

static inline float least(float a, float b) { return a < b ? a : b; }

/// Distance at which features of two cells that near each other by `approach` m/s may touch.
static inline float due(float thickness, const TouchPlan *plan, float approach) {
    return 1.25f * thickness + 1.5f * plan->time_step * (approach > 0 ? approach : 0);
}

static Quad point_speed(const Look *look, const TouchNear *near) {
    Quad one, two;
    if (near->kind == TOUCH_EDGES) {
        const uint8_t *k = touch_edge[near->first], *l = touch_edge[near->second];
        one = look->speed_a[k[0]] + near->u * (look->speed_a[k[1]] - look->speed_a[k[0]]);
        two = look->speed_b[l[0]] + near->v * (look->speed_b[l[1]] - look->speed_b[l[0]]);
        return one - two;
    }
    bool turned = near->kind == TOUCH_NODE_OF_B;
    const Quad *own = turned ? look->speed_b : look->speed_a, *other = turned ? look->speed_a : look->speed_b;
    const uint8_t *k = touch_triangle[near->second];
    one = own[near->first];
    two = other[k[0]] + near->u * (other[k[1]] - other[k[0]]) + near->v * (other[k[2]] - other[k[0]]);
    return turned ? two - one : one - two;
}

/// Adds a node's weight to the corners of its cell.
static void add_node(float corner[4], int node, float weight) {
    if (node < 4) {
        corner[node] += weight;
        return;
    }
    for (int i = 0; i < 4; i++) corner[i] += 0.25f * weight;
}

/// Weights of the corners of a and of b at two features' points.
static void point_weights(int kind, int first, int second, float u, float v, float wa[4], float wb[4]) {
    if (kind == TOUCH_EDGES) {
        const uint8_t *k = touch_edge[first], *l = touch_edge[second];
        add_node(wa, k[0], 1 - u), add_node(wa, k[1], u);
        add_node(wb, l[0], 1 - v), add_node(wb, l[1], v);
        return;
    }
    float *own = kind == TOUCH_NODE_OF_B ? wb : wa, *other = kind == TOUCH_NODE_OF_B ? wa : wb;
    const uint8_t *k = touch_triangle[second];
    add_node(own, first, 1);
    add_node(other, k[0], 1 - u - v), add_node(other, k[1], u), add_node(other, k[2], v);
}

/// Whether two points of one sheet are nearer at rest than `far`.
static bool near_at_rest(const Opening *job, const TouchPair *pair, const TouchNear *near, float far) {
    const Shell *shell = job->shell;
    Quad apart = job->plan->rest[pair->a] - job->plan->rest[pair->b];
    float most = far + job->plan->rest[pair->a][3] + job->plan->rest[pair->b][3];
    if (quad_dot(apart, apart) > most * most) return false;
    const uint16_t *sheet = shell->matter.sheet;
    if (sheet[shell_centre(shell, pair->a)] != sheet[shell_centre(shell, pair->b)]) return false;
    float wa[4] = {0}, wb[4] = {0};
    point_weights(near->kind, near->first, near->second, near->u, near->v, wa, wb);
    apart = (Quad){0};
    for (int i = 0; i < 4; i++)
        apart += wa[i] * quad_load(shell->rest_position[shell->cells[pair->a][i]]) -
                 wb[i] * quad_load(shell->rest_position[shell->cells[pair->b][i]]);
    return quad_dot(apart, apart) < far * far;
}

/// How far two features are to be kept apart in this step; 0 where they need not be looked after.
static float target(const Opening *job, const TouchPair *pair, const Look *look, const TouchNear *near) {
    const TouchPlan *plan = job->plan;
    float thickness = least(plan->thin[pair->a], plan->thin[pair->b]), distance = near->distance;
    if (!(distance > 0)) return 0;
    float toward = -quad_dot(point_speed(look, near), near->apart) / distance;
    if (distance > due(plan->thickness, plan, toward)) return 0;
    if (near_at_rest(job, pair, near, 2 * thickness)) {
        thickness = least(thickness, 4 * plan->gap);
        if (distance > due(thickness, plan, toward)) return 0;
    }
    float parted = distance + TOUCH_PART * plan->time_step;
    return parted < thickness ? parted : thickness;
}

static void place_speeds(const Opening *job, uint32_t cell, Quad speed[5]) {
    for (int i = 0; i < 4; i++) speed[i] = quad_load(job->dynamics->velocity[job->shell->cells[cell][i]]);
    speed[4] = 0.25f * ((speed[0] + speed[1]) + (speed[2] + speed[3]));
}

/// Measures a pair that may touch, and lists what of it does.
static void measure_pair(const Opening *job, uint32_t k, float due_distance, TouchWriter *writer) {
    TouchPlan *plan = job->plan;
    TouchPair *pair = &plan->pairs[k];
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    Quad origin = quad_load(x[job->shell->cells[pair->a][0]]);
    Look look;
    look.due = due_distance;
    touch_cell_place(plan, job->shell, pair->a, x, origin, &look.a);
    touch_cell_place(plan, job->shell, pair->b, x, origin, &look.b);
    float apart = touch_boxes_apart(&look.a, &look.b) - plan->noise;
    pair->distance = apart > pair->distance ? apart : pair->distance;
    if (pair->distance > look.due) return;
    apart = touch_cells_apart(&look.a, &look.b) - plan->noise;
    pair->distance = apart > pair->distance ? apart : pair->distance;
    if (pair->distance > look.due) return;
    // beside a triangle a node may be over the next one: a normal that stays would make a ridge of the edge between
    TouchFar far = {look.due, look.due, least(plan->thin[pair->a], plan->thin[pair->b]),
                    apart < TOUCH_PARTED * plan->thickness};
    // measuring a little farther, not every step has to look again
    if (far.edges) far.measured += 0.25f * plan->thickness;
    TouchNear near[TOUCH_NEAR];
    float nearest;
    int count = touch_features(job->shell, pair, &look.a, &look.b, &far, near, &nearest);
    float doubt = touch_doubt(&look.a) + touch_doubt(&look.b);
    if (doubt > 0.5f * plan->gap) nearest -= doubt; // the guard leaves a gap itself, which has room for less
    if (far.edges && nearest > pair->distance) pair->distance = nearest;
    if (count == 0) return;
    place_speeds(job, pair->a, look.speed_a);
    place_speeds(job, pair->b, look.speed_b);
    for (int i = 0; i < count; i++) {
        float keep = target(job, pair, &look, &near[i]);
        TouchFound *found = keep > 0 ? touch_list_add(writer) : NULL;
        if (!found) continue;
        *found = (TouchFound){k, near[i].kind, near[i].first, near[i].second, near[i].u, near[i].v, {0}, keep};
        for (int d = 0; d < 3; d++) found->normal[d] = near[i].apart[d] / near[i].distance;
    }
}

/// Looks at four pairs, from `first` on, of which `count` are left.
static void look_at_four(const Opening *job, uint32_t first, uint32_t count, TouchWriter *writer) {
    TouchPlan *plan = job->plan;
    uint32_t number[4];
    for (uint32_t i = 0; i < 4; i++) number[i] = first + (i < count ? i : 0);
    TouchFourPairs four = touch_four_pairs(plan, number);
    unsigned joined = four.bridged;
    if (joined) joined &= quad_bits(touch_four_within(&four, four.a, four.b, TOUCH_CONE));
    Quad due = 1.25f * plan->thickness + 1.5f * plan->time_step * touch_four_differ(&four, TOUCH_VELOCITY);
    Quad left = four.distance;
    if (!job->again) left = quad_max(left - touch_four_differ(&four, TOUCH_WAY) - plan->noise, quad_all(0));
    unsigned near = quad_bits(left <= due) & ~joined;
    for (uint32_t i = 0; i < count && i < 4; i++) plan->pairs[first + i].distance = joined >> i & 1 ? 0 : left[i];
    for (near &= (1u << (count < 4 ? count : 4)) - 1; near; near &= near - 1) {
        int i = __builtin_ctz(near);
        const TouchPair *pair = &plan->pairs[first + (uint32_t)i];
        bool alive = job->cell_flags[pair->a] & job->cell_flags[pair->b] & SINGE_ALIVE;
        if (alive && pair->a != pair->b && !touch_is_tangled(plan, pair))
            measure_pair(job, first + (uint32_t)i, due[i], writer);
    }
}

static void look_block(void *context, TouchList *list, int block) {
    const Opening *job = context;
    TouchWriter writer = touch_list_begin(list, block);
    uint32_t first = (uint32_t)block * TOUCH_BLOCK, last = first + TOUCH_BLOCK;
    if (last > job->plan->listed_count) last = job->plan->listed_count;
    for (uint32_t k = first; k < last; k += 4) look_at_four(job, k, last - k, &writer);
    touch_list_end(&writer);
}

// ---- what is pushed

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

static void open_push(void *context, const void *item, uint32_t number) {
    const Opening *job = context;
    TouchFound found;
    memcpy(&found, item, sizeof found);
    const TouchPair *pair = &job->plan->pairs[found.pair];
    TouchPush *push = &job->plan->pushes[number];
    float wa[4] = {0}, wb[4] = {0};
    point_weights(found.kind, found.first, found.second, found.u, found.v, wa, wb);
    push->normal = (Quad){found.normal[0], found.normal[1], found.normal[2], 0};
    push->target = found.target;
    push->count = 0;
    gather(push, job->shell->cells[pair->a], wa, 1);
    gather(push, job->shell->cells[pair->b], wb, -1);
}

static SingeResult open_pushes(Opening *job, Pool *pool) {
    TouchPlan *plan = job->plan;
    TouchList *list = &plan->found;
    int blocks = (int)touch_look_blocks(plan->listed_count);
    uint64_t count = touch_list_write(list, pool, blocks, plan->sizes.push_most, look_block, job);
    if (!touch_grow_pushes(plan, count)) return SINGE_ERROR_MEMORY;
    job->again = true;
    plan->push_count = touch_list_settle(list, pool, blocks, count, plan->push_capacity, look_block, job);
    plan->counters.dropped += count - plan->push_count;
    touch_list_read(list, pool, blocks, plan->push_count, open_push, job);
    return SINGE_OK;
}

static SingeResult open_step(TouchPlan *plan, const Shell *shell, const State *state, Pool *pool,
                             const DynamicsState *dynamics) {
    bool search = !plan->searched || plan->restless || state->step < plan->step ||
                  state->step - plan->step >= plan->steps;
    Opening job = {plan, shell, dynamics, state->ablate.cell_flags, search, false};
    if (search) {
        note_search(plan, state, dynamics);
        TRY(touch_search(plan, shell, pool));
        memcpy(plan->start, dynamics->position, plan->vertex_count * sizeof *plan->start);
    }
    pool_for(pool, (int)plan->cell_count, 512, measure_range, &job);
    plan->closed = false;
    if (!search) memcpy(plan->start, dynamics->position, plan->vertex_count * sizeof *plan->start);
    TRY(open_pushes(&job, pool));
    plan->counters.pairs += plan->listed_count;
    return SINGE_OK;
}

SingeResult touch_open(TouchPlan *plan, const Shell *shell, const State *state, Pool *pool,
                       const DynamicsState *dynamics) {
    double start = clock_seconds();
    SingeResult result = open_step(plan, shell, state, pool, dynamics);
    if (result) touch_plan_forget(plan);
    plan->counters.seconds += clock_seconds() - start;
    return result;
}

// ---- for drawing

void touch_room(const TouchPlan *plan, const Shell *shell, const State *state, float *room) {
    const float(*x)[4] = (const float(*)[4])state->dynamics.position;
    float looks = 0.25f * plan->cell_size; // two drawn surfaces leave their triangles by a tenth of a cell each
    TouchFar far = {looks, looks, looks, true};
    TouchNear found[TOUCH_NEAR];
    TouchCell p, q;
    for (uint32_t k = 0; plan->searched && k < plan->listed_count; k++) {
        const TouchPair *pair = &plan->pairs[k];
        const uint32_t *a = shell->cells[pair->a], *b = shell->cells[pair->b];
        if (pair->a == pair->b ||
            !(state->ablate.cell_flags[pair->a] & state->ablate.cell_flags[pair->b] & SINGE_ALIVE))
            continue;
        touch_cell_place(plan, shell, pair->a, x, quad_load(x[a[0]]), &p);
        touch_cell_place(plan, shell, pair->b, x, quad_load(x[a[0]]), &q);
        if (pair->bridge != SHELL_NONE && touch_is_within(touch_normals(p.node), touch_normals(q.node), TOUCH_CONE))
            continue;
        float nearest;
        if (touch_cells_apart(&p, &q) > looks || !touch_features(shell, pair, &p, &q, &far, found, &nearest))
            continue;
        for (int i = 0; i < 16; i++)
            if (a[i / 4] == b[i % 4]) nearest = 0; // towards what they share
        for (int i = 0; i < 4; i++) room[a[i]] = fminf(room[a[i]], nearest), room[b[i]] = fminf(room[b[i]], nearest);
    }
}

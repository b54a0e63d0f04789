// Opens a step: finds the nearby pairs of cells, and the pairs of points that its substeps may have to push apart.
//
// A pair's distance is kept as a bound: it is at least the last measured distance, less the relative motion of the two
// cells since. Features are checked only where the bound does not show that all of them stay apart in this step. So the
// result depends on the pair's positions and speeds alone, not on when it was measured.
#include "common/clock.h"
#include "common/error.h"
#include "common/real.h"
#include "collision/narrow_phase.h"
#include "collision/feature_distance.h"

#include <string.h>

/// m/s at which points that are too near move apart.
#define COLLISION_PART 0.1f

/// Fraction of the thickness: if a slab of this thickness separates two cells, their nodes keep them apart well enough
/// without their edges.
#define FEATURE_SEPARATED 0.6f

typedef struct Opening {
    CollisionPlan *plan;
    const Shell *shell;
    const DynamicsState *dynamics;
    const uint8_t *cell_flags;
    bool searched; ///< in this step
    bool again;    ///< the pairs' distances are already this step's
} Opening;

// ---- how cells move

/// Whether a cell is as CCD has left it: then it is measured already.
static inline bool is_known(const CollisionPlan *plan, const uint32_t *corner, const float (*x)[4]) {
    Float4Mask moved = {0};
    for (int i = 0; i < 4; i++) moved |= float4_load(x[corner[i]]) != float4_load(plan->end[corner[i]]);
    return plan->closed && !(float4_bits(moved) & 7); // the fourth components are inverse masses
}

static void measure_range(void *task, int begin, int end) {
    const Opening *job = task;
    CollisionPlan *plan = job->plan;
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;

    for (int c = begin; c < end; c++) {
        const uint32_t *corner = job->shell->cells[c];
        Float4 *motion = plan->motion[c];
        Float4 speed[4], node[5];
        for (int i = 0; i < 4; i++) speed[i] = float4_load(job->dynamics->velocity[corner[i]]);
        motion[COLLISION_VELOCITY] = collision_mean(speed);

        const bool known = is_known(plan, corner, x);
        if (!known || job->searched) motion[COLLISION_DISPLACEMENT] = collision_displacement(plan, corner, x);
        if (known) continue;

        collision_nodes(corner, x, float4_load(x[corner[0]]), node);
        motion[COLLISION_NORMAL] = feature_normals(node);
    }
}

// ---- nearby features

/// Two cells whose features are measured.
typedef struct Look {
    uint32_t first; ///< a's number; the pairs of a cell follow each other
    NarrowCell a, b;
    Float4 speed_a[5], speed_b[5]; ///< m/s, of nodes
} Look;

static inline float open_min(float a, float b) { return a < b ? a : b; }

/// Distance at which features of two cells that approach each other by `approach` m/s may come into contact.
static inline float due(float thickness, const CollisionPlan *plan, float approach) {
    return 1.25f * thickness + 1.5f * plan->h * (approach > 0 ? approach : 0);
}

/// Distance that two features must keep in this step; 0 if they need no repulsion.
static float target(const Opening *job, const CollisionPair *pair, const Look *look, const NearFeatures *near) {
    const CollisionPlan *plan = job->plan;
    float thickness = open_min(plan->thin[pair->a], plan->thin[pair->b]), distance = near->distance;
    if (!(distance > 0)) return 0;

    // velocity of the point of a relative to that of b
    Float4 speed;
    if (near->kind == COLLISION_EDGES) {
        const uint8_t *k = collision_edge[near->first], *l = collision_edge[near->second];
        speed = (look->speed_a[k[0]] + near->u * (look->speed_a[k[1]] - look->speed_a[k[0]])) -
                (look->speed_b[l[0]] + near->v * (look->speed_b[l[1]] - look->speed_b[l[0]]));
    } else {
        bool turned = near->kind == COLLISION_NODE_OF_B;
        const Float4 *own = turned ? look->speed_b : look->speed_a, *other = turned ? look->speed_a : look->speed_b;
        const uint8_t *k = collision_triangle[near->second];
        Float4 there = other[k[0]] + near->u * (other[k[1]] - other[k[0]]) + near->v * (other[k[2]] - other[k[0]]);
        speed = turned ? there - own[near->first] : own[near->first] - there;
    }

    // contact is due where they may be too near at the step's end
    float toward = -float4_dot(speed, near->separation) / distance;
    if (distance > due(plan->thickness, plan, toward)) return 0;

    // points of one sheet that are near at rest need less
    const Shell *shell = job->shell;
    Float4 apart = plan->rest[pair->a] - plan->rest[pair->b];
    const float far = 2 * thickness, max = far + plan->rest[pair->a][3] + plan->rest[pair->b][3];
    const uint16_t *sheet = shell->matter.sheet;
    if (!(float4_dot(apart, apart) > max * max) &&
        sheet[shell_centre(shell, pair->a)] == sheet[shell_centre(shell, pair->b)]) {
        float wa[4] = {0}, wb[4] = {0};
        collision_weights(near->kind, near->first, near->second, near->u, near->v, wa, wb);
        apart = (Float4){0};
        for (int i = 0; i < 4; i++)
            apart += wa[i] * float4_load(shell->rest_position[shell->cells[pair->a][i]]) -
                     wb[i] * float4_load(shell->rest_position[shell->cells[pair->b][i]]);

        if (float4_dot(apart, apart) < far * far) {
            thickness = open_min(thickness, 4 * plan->gap);
            if (distance > due(thickness, plan, toward)) return 0;
        }
    }

    float parted = distance + COLLISION_PART * plan->h;
    return parted < thickness ? parted : thickness;
}

/// The nearest 16-bit numbers; the largest weight of each cell takes what is left to their sum.
static void write_repulsion(const CollisionPlan *plan, const CollisionPair *pair, const NearFeatures *near, float keep,
                            Repulsion *out) {
    float weight[2][4] = {{0}};
    collision_weights(near->kind, near->first, near->second, near->u, near->v, weight[0], weight[1]);

    out->a = pair->a;
    out->b = pair->b;
    for (int c = 0; c < 2; c++) {
        const Float4 share = float4_load(weight[c]);
        const Float4Mask whole =
            __builtin_convertvector(REPULSION_ONE * float4_max(share, float4_all(0)) + 0.5f, Float4Mask);
        const int left = REPULSION_ONE - (whole[0] + whole[1] + whole[2] + whole[3]);
        const int largest = __builtin_ctz(float4_bits(share == float4_all(float4_largest(share))) | 8);
        for (int i = 0; i < 4; i++) out->weight[c][i] = (uint16_t)whole[i];
        out->weight[c][largest] = (uint16_t)(whole[largest] + left);
    }

    const Float4 along = REPULSION_UNIT * near->separation / near->distance;
    const Float4 half = float4_select(along < 0, float4_all(-0.5f), float4_all(0.5f));
    const Float4Mask normal = __builtin_convertvector(along + half, Float4Mask);
    for (int d = 0; d < 3; d++) out->normal[d] = (int16_t)normal[d];

    out->target = (uint16_t)(REPULSION_FULL * (keep / plan->thickness));
}

static void node_velocities(const Opening *job, uint32_t cell, Float4 speed[5]) {
    for (int i = 0; i < 4; i++) speed[i] = float4_load(job->dynamics->velocity[job->shell->cells[cell][i]]);
    speed[4] = 0.25f * ((speed[0] + speed[1]) + (speed[2] + speed[3]));
}

/// Measures a pair that may be in contact, and lists its points that are. `due_distance`: beyond it there is no contact in
/// this step.
static void measure_pair(const Opening *job, CollisionPair *pair, float due_distance, Look *look, BlockWriter *writer) {
    CollisionPlan *plan = job->plan;
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    Float4 origin = float4_load(x[job->shell->cells[pair->a][0]]);
    if (look->first != pair->a) {
        look->first = pair->a;
        narrow_cell_set(plan, job->shell, pair->a, x, origin, &look->a);
        node_velocities(job, pair->a, look->speed_a);
    }

    narrow_cell_set(plan, job->shell, pair->b, x, origin, &look->b);
    float separation = narrow_boxes_distance(&look->a, &look->b) - plan->noise;
    pair->distance = separation > pair->distance ? separation : pair->distance;
    if (pair->distance > due_distance) return;

    separation = narrow_slabs_distance(&look->a, &look->b) - plan->noise;
    pair->distance = separation > pair->distance ? separation : pair->distance;
    if (pair->distance > due_distance) return;

    // a node beside a triangle may be over the next one: a fixed normal would make a ridge of the edge between
    FeatureRange far = {due_distance, due_distance, open_min(plan->thin[pair->a], plan->thin[pair->b]),
                        separation < FEATURE_SEPARATED * plan->thickness};

    // measures a little farther, so that not every step must measure again
    if (far.edges) far.measured += 0.25f * plan->thickness;
    NearFeatures near[NARROW_MAX];
    float nearest;
    int count = narrow_features(job->shell, pair, &look->a, &look->b, &far, near, &nearest);
    if (far.edges) {
        const float doubt = narrow_error_bound(&look->a) + narrow_error_bound(&look->b);
        if (doubt > 0.5f * plan->gap) nearest -= doubt; // CCD keeps a gap, which covers less doubt
        if (nearest > pair->distance) pair->distance = nearest;
    }
    if (count == 0) return;

    node_velocities(job, pair->b, look->speed_b);
    for (int i = 0; i < count; i++) {
        float keep = target(job, pair, look, &near[i]);
        Repulsion *found = keep > 0 ? block_list_add(writer) : NULL;
        if (!found) continue;

        write_repulsion(plan, pair, &near[i], keep, found);
    }
}

static void look_block(void *context, BlockList *list, int block) {
    const Opening *job = context;
    CollisionPlan *plan = job->plan;
    BlockWriter writer = block_list_begin(list, block);
    Look look = {.first = SHELL_NONE};
    uint32_t begin = (uint32_t)block * COLLISION_BLOCK, end = begin + COLLISION_BLOCK;
    if (end > plan->between_count) end = plan->between_count;

    for (uint32_t first = begin; first < end; first += 4) {
        const uint32_t count = end - first < 4 ? end - first : 4;
        uint32_t number[4];
        for (uint32_t i = 0; i < 4; i++) number[i] = first + (i < count ? i : 0);
        CollisionFourPairs four;
        collision_four_pairs(plan, number, &four);

        // connected cells whose normals lie within a cone cannot collide
        unsigned joined = four.bridged;
        if (joined) joined &= float4_bits(collision_four_within(&four, four.a, four.b, FEATURE_CONE));

        // bounds of the distances, and where contact is possible
        Float4 due = 1.25f * plan->thickness + 1.5f * plan->h * collision_four_differ(&four, COLLISION_VELOCITY);
        Float4 left = four.distance;
        if (!job->again)
            left = float4_max(left - collision_four_differ(&four, COLLISION_DISPLACEMENT) - plan->noise, float4_all(0));

        unsigned near = float4_bits(left <= due) & ~joined;
        for (uint32_t i = 0; i < count; i++) plan->pairs[first + i].distance = joined >> i & 1 ? 0 : left[i];

        // measure the pairs that may be in contact
        for (near &= (1u << count) - 1; near; near &= near - 1) {
            int i = __builtin_ctz(near);
            CollisionPair *pair = &plan->pairs[first + (uint32_t)i];
            bool alive = job->cell_flags[pair->a] & job->cell_flags[pair->b] & SINGE_ALIVE;
            if (alive && !initial_is_crossing(plan, pair)) measure_pair(job, pair, due[i], &look, &writer);
        }
    }

    block_list_end(&writer);
}

// ---- repulsions

static void keep_repulsion(void *context, const void *item, uint32_t number) {
    CollisionPlan *plan = ((const Opening *)context)->plan;
    memcpy(&plan->repulsions[plan->stripe_count > 0 ? plan->active[number] : number], item, sizeof(Repulsion));
}

static SingeResult open_step(Memory *memory, CollisionPlan *plan, const Shell *shell, const StateInput *state,
                             Pool *pool, const DynamicsState *dynamics) {
    const bool part = plan->h < plan->time_step;
    bool search = !plan->searched || plan->restless || part || state->step < plan->step ||
                  state->step - plan->step >= plan->steps;
    Opening job = {plan, shell, dynamics, state->ablate->cell_flags, search, false};
    if (search) {
        // where corners are and how they move: as since the last search, as resting corners tremble; else by their
        // velocities
        bool known = plan->searched && !part && plan->restless < 2 && state->step > plan->step;
        float since = known ? (float)(state->step - plan->step) * plan->time_step : 1;
        for (uint32_t v = 0; v < plan->vertex_count; v++) {
            Float4 now = float4_load(dynamics->position[v]);
            Float4 speed = known ? (now - float4_load(plan->position[v])) / since : float4_load(dynamics->velocity[v]);
            speed[3] = 0;
            float4_store(plan->speed[v], speed);
            float4_store(plan->position[v], now);
        }

        for (uint32_t c = 0; c < plan->cell_count; c++) plan->alive[c] = state->ablate->cell_flags[c] & SINGE_ALIVE;
        collision_search_again(plan, state->step);
        TRY(broad_search(memory, plan, shell, pool));
        memcpy(plan->start, dynamics->position, plan->vertex_count * sizeof *plan->start);
    }

    // how cells have moved since the last step began
    pool_for(pool, (int)plan->cell_count, 512, measure_range, &job);
    plan->closed = false;
    if (!search) memcpy(plan->start, dynamics->position, plan->vertex_count * sizeof *plan->start);

    // points that are near, and their repulsions
    BlockList *list = &plan->found;
    const int blocks = (int)collision_look_blocks(plan->between_count);
    uint64_t count = block_list_write(list, pool, blocks, plan->sizes.repulsion_max, look_block, &job);
    if (!collision_grow_repulsions(memory, plan, count)) return SINGE_ERROR_MEMORY;

    job.again = true;
    plan->repulsion_count = block_list_settle(list, pool, blocks, count, plan->repulsion_capacity, look_block, &job);
    plan->counters.dropped += count - plan->repulsion_count;
    plan->stripe_count = 0;
    block_list_read(list, pool, blocks, plan->repulsion_count, keep_repulsion, &job);
    repulsion_sort(plan, shell, (const float(*)[4])dynamics->position);
    if (plan->stripe_count > 0) block_list_read(list, pool, blocks, plan->repulsion_count, keep_repulsion, &job);
    plan->counters.pairs += plan->listed_count;
    return SINGE_OK;
}

SingeResult collision_open(Memory *memory, CollisionPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                           float h, bool first, const DynamicsState *dynamics) {
    double start = clock_seconds();
    plan->h = h;
    if (first) plan->work = 0;
    SingeResult result = open_step(memory, plan, shell, state, pool, dynamics);
    if (result) collision_plan_forget(plan);
    plan->counters.find_seconds += clock_seconds() - start;
    return result;
}

// ---- for drawing

static Float4 clearance_normals(const CollisionPlan *plan, const uint32_t *corner, uint32_t cell, const float (*x)[4]) {
    if (is_known(plan, corner, x)) return plan->motion[cell][COLLISION_NORMAL];
    Float4 node[5];
    collision_nodes(corner, x, float4_load(x[corner[0]]), node);
    return feature_normals(node);
}

void collision_clearance(const CollisionPlan *plan, const Shell *shell, const StateInput *state, float *room) {
    const float(*x)[4] = (const float(*)[4])state->dynamics->position;
    float looks = 0.25f * plan->cell_size; // two drawn surfaces leave their triangles by a tenth of a cell each
    FeatureRange far = {looks, looks, looks, true};
    NearFeatures found[NARROW_MAX];
    NarrowCell p, q;
    Float4 normals = {0};
    uint32_t measured = SHELL_NONE; // the cell of p and `normals`: pairs are sorted by their first one

    for (uint32_t k = 0; plan->searched && k < plan->listed_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        const uint32_t *a = shell->cells[pair->a], *b = shell->cells[pair->b];
        if (pair->a == pair->b ||
            !(state->ablate->cell_flags[pair->a] & state->ablate->cell_flags[pair->b] & SINGE_ALIVE))
            continue;

        // measure the pair, unless it is connected and cannot collide
        if (pair->a != measured) {
            narrow_cell_set(plan, shell, pair->a, x, float4_load(x[a[0]]), &p);
            normals = clearance_normals(plan, a, pair->a, x);
            measured = pair->a;
        }

        if (pair->bridge != SHELL_NONE &&
            feature_is_within(normals, clearance_normals(plan, b, pair->b, x), FEATURE_CONE))
            continue;
        narrow_cell_set(plan, shell, pair->b, x, float4_load(x[a[0]]), &q);

        float nearest;
        if (narrow_slabs_distance(&p, &q) > looks || !narrow_features(shell, pair, &p, &q, &far, found, &nearest))
            continue;

        // the distance is the room of all corners
        for (int i = 0; i < 16; i++)
            if (a[i / 4] == b[i % 4]) nearest = 0; // towards shared corners
        for (int i = 0; i < 4; i++) {
            room[a[i]] = float_min(room[a[i]], nearest);
            room[b[i]] = float_min(room[b[i]], nearest);
        }
    }
}

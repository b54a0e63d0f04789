// Shared declarations of this folder's files.
#pragma once

#include "common/float4.h"
#include "collision/collision.h"
#include "collision/narrow_lanes.h"
#include "collision/block_list.h"

/// Max steps that a search is valid for; it is repeated earlier if cells move differently.
enum { COLLISION_STEPS = 10 };
/// Max slacks that a search tries.
enum { COLLISION_TRIALS = 5 };
/// Buckets, pairs or cells in one work item of a thread.
enum { COLLISION_BUCKETS = 128, COLLISION_BLOCK = 256, COLLISION_OUTSIDE = 16 };
/// The bound of CCD's work in a step: COLLISION_WORK per cell and COLLISION_WORK_MIN. A second or so for a few thousand
/// cells.
enum { COLLISION_WORK = 500, COLLISION_WORK_MIN = 1 << 18 };
/// Items per cell that lists begin with. They grow: entries of the grid up to COLLISION_ENTRIES_MAX, pairs and repulsions
/// to what COLLISION_PAIRS_MAX and COLLISION_REPULSIONS_MAX say, or to COLLISION_LIST_MIN items if that is more. A search
/// that finds more than COLLISION_PAIRS_FAR pairs searches less far.
enum {
    COLLISION_ENTRIES = 5,
    COLLISION_ENTRIES_MAX = 12,
    COLLISION_PAIRS = 6,
    COLLISION_PAIRS_FAR = 40,
    COLLISION_PAIRS_MAX = 320,
    COLLISION_REPULSIONS = 1,
    COLLISION_REPULSIONS_MAX = 192,
    COLLISION_LIST_BEGIN = 4096, ///< more, so that lists of a small sheet do not grow
    COLLISION_LIST_MIN = 1 << 19
};
_Static_assert(COLLISION_ENTRIES_MAX >= 8, "a box overlaps eight cubes of the grid at least");
_Static_assert(COLLISION_OUTSIDE <= COLLISION_BLOCK, "a block of cells outside is a block of pairs at most");

/// Max stripes of a crowd (repulsion.c).
enum { COLLISION_STRIPES = 128 };

/// Max parts of a step.
enum { COLLISION_PARTS = 64 };

/// Kinds of features that collide.
enum { COLLISION_NODE_OF_A, COLLISION_NODE_OF_B, COLLISION_EDGES };

/// A cell's box at the search, in a frame that moves with the mean of its corners' displacements over plan->steps, and
/// that displacement, with the largest deviation of a corner's as fourth. The box includes the deviations.
typedef struct CollisionBox {
    Float4 low, high, displacement;
    Float4 swept_low, swept_high; ///< the region that the widened box passes over
} CollisionBox;

/// A cell's corners at the search and the slab between two planes that holds them, about the first corner.
typedef struct CollisionSlab {
    Float4 x, y, z;
    Float4 normal;   ///< of length 1, or 0
    float low, high; ///< m along it
} CollisionSlab;

/// An entry of the grid: a cell in one of the cubes that its swept box overlaps.
typedef struct CollisionEntry {
    uint32_t cell, key; ///< key: which cube; the highest three bits: whether it is the box's first along x, y, z
} CollisionEntry;

/// Two cells whose boxes meet. Features are nodes of one against triangles of the other, and edges against edges.
typedef struct CollisionPair {
    uint32_t a, b;
    /// the cell by which two are connected: a where they share a side or are one, one that shares a side with each
    /// where they share a corner; else SHELL_NONE
    uint32_t bridge;
    float distance;   ///< m, at least that at plan->start
    float hit;        ///< of the step's displacement, the share after which they meet; 2: never
    uint8_t first[2]; ///< the first features to collide: node of the one and triangle of the other, or edges
    uint8_t kind;     ///< COLLISION_NODE_OF_A, COLLISION_NODE_OF_B or COLLISION_EDGES
} CollisionPair;

_Static_assert(sizeof(CollisionPair) == 24, "five words and three bytes a pair");

/// The same as a search finds them.
typedef struct CollisionFound {
    uint32_t a, b;
    float distance; ///< m, at least that at plan->position
} CollisionFound;

/// Two points of two cells, near as a step opens, that are to be at least `target` apart along `normal`, in 16 bits a
/// number: lists are long, and every pass of a substep reads them.
typedef struct Repulsion {
    uint32_t a, b;
    uint16_t weight[2][4]; ///< of the corners of a and of b, whose sums are REPULSION_ONE
    int16_t normal[3];     ///< from the point of b to that of a, REPULSION_UNIT long
    uint16_t target;       ///< of plan->thickness, REPULSION_FULL
} Repulsion;
enum { REPULSION_ONE = 1 << 15, REPULSION_UNIT = 32767, REPULSION_FULL = 65535 };

_Static_assert(sizeof(Repulsion) == 32, "lists are long");

/// The slightly widened region that a cell passes over in a step.
typedef struct OutsideBox {
    Float4 low, high;
} OutsideBox;

/// An entry of the grid of such regions.
typedef struct OutsideEntry {
    uint32_t outside, key; ///< key: as a CollisionEntry's
    uint32_t next;         ///< of the same bucket, or SHELL_NONE
} OutsideEntry;

/// How a cell moves: mean of its corners' displacements since plan->start in m, and of their velocities as the step
/// opened in m/s, with the largest deviation of one as fourth; and its normals, as of feature_normals.
enum { COLLISION_DISPLACEMENT, COLLISION_VELOCITY, COLLISION_NORMAL, COLLISION_MOTIONS };

/// Initial and max items of the lists.
typedef struct CollisionSizes {
    uint32_t entry_max;       ///< at least 8 a cell
    uint32_t pairs, pair_max; ///< at least 1 a cell
    uint32_t repulsions, repulsion_max;
    uint32_t pair_budget; ///< enough for a search: if there are more it searches less far
} CollisionSizes;

/// Sizes for all but crowds.
CollisionSizes collision_sizes(const Shell *shell);

/// collision_plan_create with other sizes than collision_sizes.
SingeResult collision_plan_create_sized(Memory *memory, const Shell *shell, const SingeContactDef *def, float time_step,
                                        const CollisionSizes *sizes, CollisionPlan **plan);

struct CollisionPlan {
    SingeContactDef def;
    CollisionSizes sizes;
    uint32_t cell_count, vertex_count;
    float time_step; ///< s
    float h;         ///< s, of this step, or of the part of it that is open
    float cell_size; ///< m, of the smallest
    float thickness; ///< m, of contact; at most 2/5 of a sheet's typical cell
    float *thin;     ///< [cells] m, the same; at most 2/5 of this cell's shortest side
    float slack_max; ///< m, max deviation of cells from their trajectories before the search is repeated
    float gap;       ///< m, distance that displacements keep before a collision
    float noise;     ///< m, rounding error of positions

    // the last search: part of a snapshot
    uint32_t searched; ///< 0: never
    /// 1: many cells have left their boxes since: search as the next step opens. More, up to 2 COLLISION_PARTS: so too,
    /// by velocities, and that step has half as many parts
    uint32_t restless;
    uint32_t steps_most;  ///< max steps of it, from what the search before it has served: at most COLLISION_STEPS
    uint32_t narrowed;    ///< how often it has halved the slack, less than COLLISION_TRIALS
    uint64_t step;        ///< it was for displacements from this step's start
    float (*position)[4]; ///< [vertices] m
    float (*speed)[4];    ///< [vertices] m/s
    uint8_t *alive;       ///< [cells]
    /// pairs of cells that intersected or coincided at the start and have not separated since (initial_intersections.c)
    uint32_t *initial_first; ///< [cells + 2]
    uint32_t *initial_other; ///< [initial_capacity]
    uint32_t initial_capacity;
    uint8_t *intersecting; ///< [cells] 1: in one of these pairs

    // the same as it was before the step, for one that fails; arrays are copied after a search alone
    struct {
        bool current; ///< the arrays are those of the last search
        uint32_t searched, restless, steps_most, narrowed;
        uint64_t step;
        float (*position)[4], (*speed)[4];
        uint8_t *alive;
        uint32_t *initial_first;
        uint32_t *initial_other; ///< [initial_capacity]
        CollisionCounters counters;
    } kept;

    // results of the search, and of collision_open
    uint32_t steps;      ///< for which the search is valid
    float slack, reach;  ///< m; reach is thickness + slack
    float edge;          ///< m, the longest of the grid's cubes; 0: there is no grid
    Float4 inverse_edge; ///< 1/m, one over their edges along each axis
    uint32_t entry_count, bucket_count, repulsion_count;
    uint32_t between_count; ///< pairs of two cells that the search has listed
    uint32_t listed_count;  ///< and those of a cell with itself
    uint32_t pair_count;    ///< and those of cells that have left their boxes, in this step
    uint32_t pair_capacity, repulsion_capacity, entry_capacity, outside_capacity;
    /// of these three; more than pair_capacity where memory has run out before all had grown
    uint32_t pairs_length, active_length, around_length;
    CollisionBox *boxes;     ///< [cells]
    CollisionSlab *slabs;    ///< [cells]
    Float4 *rest;            ///< [cells] centroid at rest, and how far a corner is from it
    uint8_t *owned;          ///< [cells] bits 0-3 corners, 4-7 sides that count as this cell's
    uint32_t *owner;         ///< [vertices]
    CollisionEntry *entries; ///< [entry_capacity] by bucket
    uint32_t *bucket_first;  ///< [bucket_count + 2]
    CollisionPair *pairs;    ///< [pairs_length]
    Repulsion *repulsions;   ///< [repulsion_capacity]
    /// a crowd's stripes, or 0: repulsions stripe_first[s] to stripe_first[s + 1] are those of stripe s
    uint32_t stripe_count, stripe_first[COLLISION_STRIPES + 2];
    uint32_t stripe_pushed[COLLISION_STRIPES]; ///< how many of them a pass has pushed apart
    BlockItems items;                          ///< of these two, which are never needed at the same time
    BlockList found_pairs;                     ///< CollisionFound
    BlockList found;                           ///< Repulsion, as they are found

    // the step
    float (*start)[4]; ///< [vertices] m
    float (*end)[4];   ///< [vertices] m, where CCD has left them, if it has run in this step:
    bool closed;
    float (*want)[4];                    ///< [vertices] m, where the step has moved them
    float (*goal)[4];                    ///< [vertices] m, of those in zones: their position without the zone
    Float4 (*motion)[COLLISION_MOTIONS]; ///< [cells]
    uint32_t *zone;                      ///< [vertices] of those that collide: parent in a disjoint set, or SHELL_NONE
    float *share;                        ///< [vertices] at a root: free share of displacements within the zone
    Float4 *drift;                       ///< [vertices] at a root: mean displacement of the zone; fourth: its mass
    uint32_t *stopped;                   ///< [stopped_count] vertices in zones
    uint32_t stopped_count;
    uint8_t *changed;       ///< [cells] 1: moved by the last round
    uint32_t *changed_list; ///< [changed_count] of them
    uint32_t changed_count;
    uint64_t work, work_max; ///< of CCD in this step: pairs checked, and features swept; and its bound
    uint32_t *active;        ///< [active_length] pairs that collide; before CCD, places in lists that are sorted
    uint32_t hit_count;
    uint32_t *pair_first;          ///< [cells + 2] where the pairs of each cell with later ones begin
    uint32_t *around_first;        ///< [cells + 2] where those with earlier ones, and with itself, begin in `around`
    uint32_t *around;              ///< [around_length]
    uint64_t around_search;        ///< which search these are of
    uint8_t *is_outside;           ///< [cells] that have left their boxes
    uint32_t *outside;             ///< [cells] a list of them
    OutsideBox *outside_boxes;     ///< [cells] theirs
    uint32_t *outside_chain;       ///< [bucket_count] first entries
    OutsideEntry *outside_entries; ///< [outside_capacity]
    double *partial;               ///< [collision_partials]
    CollisionCounters counters;
};

/// Divides a crowd, whose vertices are at x, into stripes that threads can share: plan->active says where each repulsion
/// goes.
void repulsion_sort(CollisionPlan *plan, const Shell *shell, const float (*x)[4]);

/// Whether the last search has found so many pairs that layers must lie on many others.
static inline bool collision_is_crowded(const CollisionPlan *plan) {
    return plan->searched && plan->listed_count > plan->sizes.pair_budget / 3;
}

/// Before a search for displacements from the start of this step: it follows from how the last one has served.
static inline void collision_search_again(CollisionPlan *plan, uint64_t step) {
    const bool known = plan->searched && step >= plan->step;
    const uint64_t lasted = known ? step - plan->step : COLLISION_STEPS;
    const uint64_t most = collision_is_crowded(plan) ? lasted + 1 : lasted > 0 ? 2 * lasted : 1;
    const uint32_t budget = plan->sizes.pair_budget;

    plan->steps_most = most < COLLISION_STEPS ? (uint32_t)most : COLLISION_STEPS;
    if (!known) plan->narrowed = 0;
    else if (plan->narrowed > 0 && plan->listed_count < budget / 2) plan->narrowed--;
    else if (plan->narrowed + 1 < COLLISION_TRIALS && plan->listed_count > budget - budget / 16) plan->narrowed++;
    plan->step = step;
}

/// Finds the pairs for plan->position, speed, alive. Their distances are those at plan->position. SINGE_ERROR_MEMORY:
/// then there are none.
SingeResult broad_search(Memory *memory, CollisionPlan *plan, const Shell *shell, Pool *pool);

/// Pairs of cells whose swept boxes meet (broad_grid.c): sorts them into the grid, and writes those that `reach` allows
/// to plan->found_pairs. *count: how many there are, with or without room. SINGE_ERROR_MEMORY.
SingeResult broad_grid_pairs(Memory *memory, CollisionPlan *plan, const Shell *shell, Pool *pool, uint64_t *count);

/// Keeps the first `room` of the `count` pairs that broad_grid_pairs has found, as plan->pairs.
void broad_grid_keep(CollisionPlan *plan, const Shell *shell, Pool *pool, uint64_t count, uint32_t room);

/// Pairs that CCD checks before its work is compared with its bound; and partial sums of these, or of cells.
enum { COLLISION_CHUNK = 256 * POOL_BLOCK };
static inline int collision_partials(const CollisionPlan *plan) {
    const int chunk = pool_blocks(COLLISION_CHUNK), cells = pool_blocks((int)plan->cell_count);
    return cells > chunk ? cells : chunk;
}

/// Number of blocks in which pairs are checked.
static inline uint32_t collision_look_blocks(uint32_t pairs) { return (pairs + COLLISION_BLOCK - 1) / COLLISION_BLOCK; }

/// Makes room for `wanted` pairs or repulsions, or the max if that is less. False when out of memory.
bool collision_grow_pairs(Memory *memory, CollisionPlan *plan, uint64_t wanted);
bool collision_grow_repulsions(Memory *memory, CollisionPlan *plan, uint64_t wanted);

/// Makes room for `wanted` entries of the grid, or of that of cells outside their boxes; their content is lost. False when
/// out of memory.
bool collision_grow_entries(Memory *memory, CollisionPlan *plan, uint64_t wanted);
bool collision_grow_outside(Memory *memory, CollisionPlan *plan, uint64_t wanted);

/// Whether the search has listed two cells, a before b; *distance is a lower bound of their distance at plan->position.
bool collision_is_listed(const CollisionPlan *plan, uint32_t a, uint32_t b, float *distance);

/// See CollisionPair.bridge.
uint32_t collision_bridge(const CollisionPlan *plan, const Shell *shell, uint32_t a, uint32_t b);

/// Lists, after the search's own pairs, those that cells outside their boxes may have met on their displacement from
/// plan->start to `x`. SINGE_ERROR_MEMORY.
SingeResult broad_search_outside(Memory *memory, CollisionPlan *plan, const Shell *shell, Pool *pool,
                                 uint32_t outside_count, const float (*x)[4]);

/// Lists the pairs of cells that intersect: all of them at the first search, later those that have not separated since.
/// SINGE_ERROR_MEMORY: there are none.
SingeResult initial_find(Memory *memory, CollisionPlan *plan, const Shell *shell, bool first);

/// Makes room for `count` such pairs; the previous content is lost. False when out of memory.
bool initial_reserve(Memory *memory, CollisionPlan *plan, uint32_t count);

/// Sets plan->intersecting, and counts the cells.
void initial_mark(CollisionPlan *plan);

/// Mean of four vectors; fourth: the largest deviation from it.
static inline Float4 collision_mean(const Float4 vector[4]) {
    FourVectors four = four_of(vector);
    Float4 mean = {0.25f * float4_sum(four.x), 0.25f * float4_sum(four.y), 0.25f * float4_sum(four.z), 0};
    FourVectors off = four_minus(four, four_all(mean));
    return float4_with(mean, sqrtf(float4_largest(four_dot(off, off))));
}

/// Mean displacement of a cell's corners since plan->start; fourth: the largest deviation.
static inline Float4 collision_displacement(const CollisionPlan *plan, const uint32_t corner[4], const float (*x)[4]) {
    Float4 displacement[4]; // fourth components: of positions inverse masses, which are ignored
    for (int i = 0; i < 4; i++) displacement[i] = float4_load(x[corner[i]]) - float4_load(plan->start[corner[i]]);
    return collision_mean(displacement);
}

/// Four pairs of the list, and the motions of their cells.
typedef struct CollisionFourPairs {
    const Float4 (*motion)[COLLISION_MOTIONS];
    uint32_t a[4], b[4], bridge[4]; ///< bridge is a if there is none
    unsigned bridged;               ///< bits
    Float4 distance;                ///< m
} CollisionFourPairs;

/// Fills in what is there: a copy of it would wait for all of these short stores.
static inline void collision_four_pairs(const CollisionPlan *plan, const uint32_t number[4], CollisionFourPairs *four) {
    four->motion = (const Float4(*)[COLLISION_MOTIONS])plan->motion;
    four->bridged = 0;
    float distance[4];
    for (int i = 0; i < 4; i++) {
        const CollisionPair *pair = &plan->pairs[number[i]];
        bool bridged = pair->bridge != SHELL_NONE;
        four->a[i] = pair->a;
        four->b[i] = pair->b;
        four->bridge[i] = bridged ? pair->bridge : pair->a;
        four->bridged |= (unsigned)bridged << i;
        distance[i] = pair->distance;
    }

    four->distance = (Float4){distance[0], distance[1], distance[2], distance[3]};
}

/// Difference of a motion of cells a and b; *deviations: the sums of the fourth components.
static inline FourVectors collision_four_off(const CollisionFourPairs *four, const uint32_t a[4], const uint32_t b[4],
                                             int motion, Float4 *deviations) {
    const Float4 sign = {0, 0, 0, -0.0f};
    Float4 off[4];
    for (int i = 0; i < 4; i++)
        off[i] = four->motion[a[i]][motion] - (Float4)((Float4Mask)four->motion[b[i]][motion] ^ (Float4Mask)sign);
    float4_transpose(off);
    *deviations = off[3];
    return (FourVectors){off[0], off[1], off[2]};
}

/// The max difference of any points of the cells.
static inline Float4 collision_four_differ(const CollisionFourPairs *four, int motion) {
    Float4 deviations;
    FourVectors off = collision_four_off(four, four->a, four->b, motion, &deviations);
    return float4_sqrt(four_dot(off, off)) + deviations;
}

/// Whether all normals of two cells in shape lie within a cone.
static inline Float4Mask collision_four_within(const CollisionFourPairs *four, const uint32_t a[4], const uint32_t b[4],
                                               float cone) {
    Float4 deviations;
    FourVectors off = collision_four_off(four, a, b, COLLISION_NORMAL, &deviations);
    Float4 left = cone - deviations;
    return (left > 0) & (four_dot(off, off) < left * left);
}

/// A cell's nodes about an origin: corners, then the virtual centre. Fourth numbers are 0.
static inline void collision_nodes(const uint32_t corner[4], const float (*x)[4], Float4 origin, Float4 node[5]) {
    for (int i = 0; i < 4; i++) node[i] = float4_flat(float4_load(x[corner[i]]) - origin);
    node[4] = 0.25f * ((node[0] + node[1]) + (node[2] + node[3]));
}

/// Nodes of a cell's edges 0 to 7: sides, then the lines from the corners to the centre; and of its triangles.
static const uint8_t collision_edge[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
static const uint8_t collision_triangle[4][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

/// Adds a node's weight to the corners of its cell.
static inline void collision_add_node(float corner[4], int node, float weight) {
    if (node < 4) {
        corner[node] += weight;
        return;
    }

    for (int i = 0; i < 4; i++) corner[i] += 0.25f * weight;
}

/// Adds the weights of the corners of a and of b at two features' points.
static inline void collision_weights(int kind, int first, int second, float u, float v, float wa[4], float wb[4]) {
    if (kind == COLLISION_EDGES) {
        const uint8_t *k = collision_edge[first], *l = collision_edge[second];
        collision_add_node(wa, k[0], 1 - u);
        collision_add_node(wa, k[1], u);
        collision_add_node(wb, l[0], 1 - v);
        collision_add_node(wb, l[1], v);
        return;
    }

    float *own = kind == COLLISION_NODE_OF_B ? wb : wa, *other = kind == COLLISION_NODE_OF_B ? wa : wb;
    const uint8_t *k = collision_triangle[second];
    collision_add_node(own, first, 1);
    collision_add_node(other, k[0], 1 - u - v);
    collision_add_node(other, k[1], u);
    collision_add_node(other, k[2], v);
}

/// Bits of same[i]: corners of the second cell that are corner i of the first.
static inline void collision_same(const uint32_t first[4], const uint32_t second[4], unsigned same[4]) {
    Float4Mask other;
    memcpy(&other, second, sizeof other);
    for (int i = 0; i < 4; i++) same[i] = float4_bits(other == (int32_t)first[i]);
}

/// Whether a cell owns node or edge i: features of several cells are checked once.
static inline bool collision_owns_node(const CollisionPlan *plan, uint32_t cell, int i) {
    return i == 4 || (plan->owned[cell] >> i & 1);
}
static inline bool collision_owns_edge(const CollisionPlan *plan, uint32_t cell, int i) {
    return i >= 4 || (plan->owned[cell] >> (4 + i) & 1);
}

/// The index of a pair of cells, a before b, among those that have intersected since the start; SHELL_NONE if it is
/// not.
static inline uint32_t initial_index(const CollisionPlan *plan, uint32_t a, uint32_t b) {
    for (uint32_t k = plan->initial_first[a]; k < plan->initial_first[a + 1]; k++)
        if (plan->initial_other[k] == b) return k;
    return SHELL_NONE;
}

/// Whether two cells intersected at the start and have not separated since.
static inline bool initial_is_crossing(const CollisionPlan *plan, const CollisionPair *pair) {
    if (!plan->intersecting[pair->a] || !plan->intersecting[pair->b]) return false;
    return initial_index(plan, pair->a < pair->b ? pair->a : pair->b, pair->a < pair->b ? pair->b : pair->a) !=
           SHELL_NONE;
}

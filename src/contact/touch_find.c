// The search for cells that are near each other, and for what of them is.
//
// A cell is a box that moves along: its box at the search, widened by half of thickness + slack, on the way that the
// cell was on. Two cells whose boxes do not meet in TOUCH_STEPS steps stay farther apart than the thickness, as long as
// no corner leaves its box by more than half the slack; touch_guard.c watches that.
//
// Swept boxes are sorted into the cubes of a hashed grid (Teschner et al., Optimized spatial hashing, 2003), whose
// edge follows the boxes' mean extent, so the work is linear in the number of cells for any pile. A pair that shares
// several cubes counts in the one where its common region begins. Two passes, one to count and one to write, keep the
// pairs in the order of the buckets whatever the threads do.
#include "contact/touch_near.h"
#include "contact/touch_plan.h"

#include <string.h>

typedef struct Find {
    TouchPlan *plan;
    const Shell *shell;
    bool writing;
} Find;

// ---- boxes

static bool has_corners(const uint32_t cell[4], uint32_t a, uint32_t b) {
    bool first = false, second = false;
    for (int i = 0; i < 4; i++) first |= cell[i] == a, second |= cell[i] == b;
    return first && second;
}

/// A side that a cell across has too belongs to the lower of the two.
static bool owns_side(const TouchPlan *plan, const Shell *shell, uint32_t c, int side) {
    uint32_t across = shell_neighbour(shell, c, side);
    if (across == SHELL_NONE || across > c || !plan->alive[across]) return true;
    return !has_corners(shell->cells[across], shell->cells[c][side], shell->cells[c][(side + 1) & 3]);
}

static void find_owners(TouchPlan *plan, const Shell *shell) {
    for (uint32_t c = plan->cell_count; c-- > 0;)
        for (int i = 0; plan->alive[c] && i < 4; i++) plan->owner[shell->cells[c][i]] = c;
}

static void box_range(void *task, int begin, int end) {
    Find *find = task;
    TouchPlan *plan = find->plan;
    const float(*x)[4] = (const float(*)[4])plan->place;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        if (!plan->alive[c]) continue;
        const uint32_t *corner = find->shell->cells[c];
        Quad low = quad_load(x[corner[0]]), high = low;
        for (int i = 1; i < 4; i++) {
            low = quad_min(low, quad_load(x[corner[i]]));
            high = quad_max(high, quad_load(x[corner[i]]));
        }
        Quad way = quad_load(plan->speed[c]) * ((float)plan->steps * plan->time_step);
        low[3] = high[3] = way[3] = 0;
        plan->boxes[c] = (TouchBox){.low = low, .high = high, .way = way};
        uint8_t owned = 0;
        for (int i = 0; i < 4; i++) {
            owned |= (uint8_t)((plan->owner[corner[i]] == c) << i);
            owned |= (uint8_t)(owns_side(plan, find->shell, c, i) << (4 + i));
        }
        plan->owned[c] = owned;
    }
}

/// Widens the swept boxes for plan->reach.
static void sweep_boxes(void *task, int begin, int end) {
    TouchPlan *plan = ((Find *)task)->plan;
    float wide = 0.5f * plan->reach;
    Quad zero = {0};
    for (int c = begin; c < end; c++) {
        TouchBox *box = &plan->boxes[c];
        box->swept_low = box->low + quad_min(box->way, zero) - wide;
        box->swept_high = box->high + quad_max(box->way, zero) + wide;
    }
}

// ---- grid

typedef struct Cube {
    int32_t x, y, z;
} Cube;

static inline Cube cube_of(Quad p, float inverse_edge) {
    Quad most = quad_all(1e9f), q = quad_max(quad_min(p * inverse_edge, most), -most);
    return (Cube){(int32_t)floorf(q[0]), (int32_t)floorf(q[1]), (int32_t)floorf(q[2])};
}

/// Cubes from one to another, or more than `most`.
static uint64_t cubes_between(Cube first, Cube last, uint64_t most) {
    uint64_t x = (uint64_t)(last.x - first.x) + 1, y = (uint64_t)(last.y - first.y) + 1;
    uint64_t z = (uint64_t)(last.z - first.z) + 1;
    if (x > most || x * y > most) return most + 1;
    return x * y * z;
}

static inline uint32_t cube_key(Cube cube) {
    uint32_t h = (uint32_t)cube.x * 73856093u ^ (uint32_t)cube.y * 19349663u ^ (uint32_t)cube.z * 83492791u;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return h ^ h >> 16;
}

/// The cubes' edge to begin with: twice the boxes' mean longest side. 0 where nothing is left.
static float first_edge(const TouchPlan *plan) {
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        if (!plan->alive[c]) continue;
        Quad size = plan->boxes[c].swept_high - plan->boxes[c].swept_low;
        sum += (double)fmaxf(size[0], fmaxf(size[1], size[2]));
        count++;
    }
    return count ? (float)(1.5 * sum / count) : 0;
}

/// Calls for every cube of every swept box: counts the entries of buckets, or writes them.
static uint64_t fill_grid(TouchPlan *plan, bool writing) {
    float inverse = 1 / plan->edge;
    uint64_t count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        if (!plan->alive[c]) continue;
        const TouchBox *box = &plan->boxes[c];
        Cube first = cube_of(box->swept_low, inverse), last = cube_of(box->swept_high, inverse), at;
        count += cubes_between(first, last, plan->entry_capacity);
        if (count > plan->entry_capacity) return count;
        for (at.x = first.x; at.x <= last.x; at.x++)
            for (at.y = first.y; at.y <= last.y; at.y++)
                for (at.z = first.z; at.z <= last.z; at.z++) {
                    uint32_t key = cube_key(at), bucket = key & (plan->bucket_count - 1);
                    if (writing) plan->entries[plan->bucket_first[bucket + 1]++] = (TouchEntry){c, key};
                    else plan->bucket_first[bucket + 2]++;
                }
    }
    return count;
}

static void sort_into_grid(TouchPlan *plan) {
    plan->entry_count = 0;
    plan->edge = first_edge(plan);
    if (!(plan->edge > 0)) return;
    uint64_t count;
    for (;; plan->edge *= 1.3f) {
        memset(plan->bucket_first, 0, ((size_t)plan->bucket_count + 2) * sizeof *plan->bucket_first);
        count = fill_grid(plan, false);
        if (count <= plan->entry_capacity) break;
    }
    for (uint32_t b = 0; b < plan->bucket_count; b++) plan->bucket_first[b + 2] += plan->bucket_first[b + 1];
    fill_grid(plan, true);
    plan->entry_count = (uint32_t)count;
}

// ---- pairs

static inline bool quads_meet(Quad low_a, Quad high_a, Quad low_b, Quad high_b) {
    QuadMask apart = (low_a > high_b) | (low_b > high_a);
    return !(apart[0] | apart[1] | apart[2]);
}

static inline uint32_t corners_shared(const uint32_t a[4], const uint32_t b[4]) {
    uint32_t shared = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) shared += a[i] == b[j];
    return shared;
}

/// See TouchPair.bridge. Across a tear or a hole two cells may share a corner and yet slide over each other.
static uint32_t find_bridge(const TouchPlan *plan, const Shell *shell, uint32_t a, uint32_t b) {
    uint32_t shared = corners_shared(shell->cells[a], shell->cells[b]);
    if (shared != 1) return shared ? a : SHELL_NONE;
    for (int side = 0; side < 4; side++) {
        uint32_t between = shell_neighbour(shell, a, side);
        if (between != SHELL_NONE && plan->alive[between] &&
            corners_shared(shell->cells[a], shell->cells[between]) > 1 &&
            corners_shared(shell->cells[between], shell->cells[b]) > 1)
            return between;
    }
    return SHELL_NONE;
}

/// Whether b's box, on its way relative to a, comes within reach of a's.
static inline bool boxes_meet(const TouchPlan *plan, uint32_t a, uint32_t b) {
    const TouchBox *p = &plan->boxes[a], *q = &plan->boxes[b];
    Quad way = q->way - p->way, zero = {0};
    return quads_meet(p->low - plan->reach, p->high + plan->reach, q->low + quad_min(way, zero),
                      q->high + quad_max(way, zero));
}

/// Pairs of a bucket from entry `first` to `last`; writes them at `out` where that is not NULL.
static uint32_t bucket_pairs(const Find *find, uint32_t first, uint32_t last, TouchPair *out, uint32_t room) {
    const TouchPlan *plan = find->plan;
    float inverse = 1 / plan->edge;
    uint32_t count = 0;
    for (uint32_t i = first; i < last; i++) {
        uint32_t a = plan->entries[i].cell, key = plan->entries[i].key;
        const TouchBox *p = &plan->boxes[a];
        for (uint32_t j = i + 1; j < last; j++) {
            if (plan->entries[j].key != key) continue;
            uint32_t b = plan->entries[j].cell;
            const TouchBox *q = &plan->boxes[b];
            if (!quads_meet(p->swept_low, p->swept_high, q->swept_low, q->swept_high) || !boxes_meet(plan, a, b))
                continue;
            if (cube_key(cube_of(quad_max(p->swept_low, q->swept_low), inverse)) != key) continue;
            if (out && count < room)
                out[count] = (TouchPair){.a = a, .b = b, .distance = plan->reach, .hit = 2,
                                         .bridge = find_bridge(plan, find->shell, a, b)};
            count++;
        }
    }
    return count;
}

/// Blocks of buckets.
static void pair_blocks(void *task, int begin, int end) {
    const Find *find = task;
    TouchPlan *plan = find->plan;
    for (int block = begin; block < end; block++) {
        uint32_t first = (uint32_t)block * TOUCH_BLOCK, last = first + TOUCH_BLOCK, count = 0;
        if (last > plan->bucket_count) last = plan->bucket_count;
        uint32_t at = find->writing ? plan->block_count[block] : 0;
        uint32_t room = at < plan->pair_capacity ? plan->pair_capacity - at : 0;
        for (uint32_t b = first; b < last; b++)
            count += bucket_pairs(find, plan->bucket_first[b], plan->bucket_first[b + 1],
                                  find->writing && count < room ? plan->pairs + at + count : NULL,
                                  count < room ? room - count : 0);
        if (!find->writing) plan->block_count[block] = count;
    }
}

/// Also a cell with itself: it may fold upon itself.
static void add_cells(TouchPlan *plan) {
    for (uint32_t c = 0; c < plan->cell_count && plan->pair_count < plan->pair_capacity; c++)
        if (plan->alive[c])
            plan->pairs[plan->pair_count++] = (TouchPair){.a = c, .b = c, .distance = 0, .hit = 2, .bridge = c};
}

static void find_pairs(Find *find, Pool *pool) {
    TouchPlan *plan = find->plan;
    uint32_t blocks = (plan->bucket_count + TOUCH_BLOCK - 1) / TOUCH_BLOCK;
    plan->slack = plan->slack_most;
    for (int trial = 0;; trial++) {
        plan->reach = plan->thickness + plan->slack;
        pool_for(pool, (int)plan->cell_count, 512, sweep_boxes, find);
        sort_into_grid(plan);
        plan->pair_count = 0;
        if (plan->entry_count == 0) return;
        find->writing = false;
        pool_for(pool, (int)blocks, 1, pair_blocks, find);
        uint64_t count = touch_sum_blocks(plan->block_count, blocks) + plan->cell_count;
        if (count <= plan->pair_capacity || trial == 4) {
            find->writing = true;
            pool_for(pool, (int)blocks, 1, pair_blocks, find);
            plan->pair_count = (uint32_t)(count - plan->cell_count);
            if (plan->pair_count > plan->pair_capacity) {
                plan->counters.dropped += plan->pair_count - plan->pair_capacity;
                plan->pair_count = plan->pair_capacity;
            }
            add_cells(plan);
            plan->listed_count = plan->pair_count;
            return;
        }
        plan->slack *= 0.5f; // too crowded: look less far
    }
}

// ---- cells that have left their boxes

typedef struct Stray {
    Quad low, high; ///< of the step's way, widened
} Stray;

static Stray stray_box(const TouchPlan *plan, const uint32_t corner[4], const float (*x)[4]) {
    Quad low = quad_load(x[corner[0]]), high = low;
    for (int i = 0; i < 4; i++) {
        Quad start = quad_load(plan->start[corner[i]]), end = quad_load(x[corner[i]]);
        low = quad_min(low, quad_min(start, end)), high = quad_max(high, quad_max(start, end));
    }
    low[3] = high[3] = 0;
    return (Stray){low - 0.5f * plan->reach, high + 0.5f * plan->reach};
}

/// Adds a pair unless the search has listed it.
static void add_stray_pair(TouchPlan *plan, const Shell *shell, uint32_t a, uint32_t b) {
    if (a == b || boxes_meet(plan, a, b)) return;
    if (plan->pair_count == plan->pair_capacity) {
        plan->counters.dropped++;
        return;
    }
    plan->pairs[plan->pair_count++] = (TouchPair){
        .a = a, .b = b, .distance = 0, .hit = 2, .bridge = find_bridge(plan, shell, a, b)};
}

/// Cells in their boxes that a strayed one may have met.
static void stray_against_boxes(TouchPlan *plan, const Shell *shell, uint32_t a, const Stray *box) {
    float inverse = 1 / plan->edge;
    Cube first = cube_of(box->low, inverse), last = cube_of(box->high, inverse), at;
    for (at.x = first.x; at.x <= last.x; at.x++)
        for (at.y = first.y; at.y <= last.y; at.y++)
            for (at.z = first.z; at.z <= last.z; at.z++) {
                uint32_t key = cube_key(at), bucket = key & (plan->bucket_count - 1);
                for (uint32_t k = plan->bucket_first[bucket]; k < plan->bucket_first[bucket + 1]; k++) {
                    uint32_t b = plan->entries[k].cell;
                    if (plan->entries[k].key != key || plan->strayed[b]) continue;
                    const TouchBox *other = &plan->boxes[b];
                    if (!quads_meet(box->low, box->high, other->swept_low, other->swept_high)) continue;
                    if (cube_key(cube_of(quad_max(box->low, other->swept_low), inverse)) == key)
                        add_stray_pair(plan, shell, a, b);
                }
            }
}

void touch_search_strayed(TouchPlan *plan, const Shell *shell, uint32_t stray_count, const float (*x)[4]) {
    plan->pair_count = plan->listed_count;
    for (uint32_t k = 0; k < stray_count; k++) {
        uint32_t a = plan->stray[k];
        Stray box = stray_box(plan, shell->cells[a], x);
        stray_against_boxes(plan, shell, a, &box);
        for (uint32_t l = k + 1; l < stray_count; l++) {
            Stray other = stray_box(plan, shell->cells[plan->stray[l]], x);
            if (quads_meet(box.low, box.high, other.low, other.high))
                add_stray_pair(plan, shell, a, plan->stray[l]);
        }
    }
}

// ---- features

/// Boxes of four things at once: x, y, z of their lower and upper ends.
typedef struct FourBoxes {
    Quad low[3], high[3];
} FourBoxes;

static FourBoxes four_boxes(const Quad low[4], const Quad high[4]) {
    FourBoxes four;
    Quad l[4] = {low[0], low[1], low[2], low[3]}, h[4] = {high[0], high[1], high[2], high[3]};
    quad_transpose(l);
    quad_transpose(h);
    memcpy(four.low, l, sizeof four.low);
    memcpy(four.high, h, sizeof four.high);
    return four;
}

/// Bit k is set where box k meets the box from `low` to `high`.
static inline unsigned which_meet(const FourBoxes *four, Quad low, Quad high) {
    QuadMask meet = {-1, -1, -1, -1};
    for (int k = 0; k < 3; k++) meet &= (four->low[k] <= quad_all(high[k])) & (four->high[k] >= quad_all(low[k]));
    return (unsigned)((meet[0] & 1) | (meet[1] & 2) | (meet[2] & 4) | (meet[3] & 8));
}

/// A cell's nodes, with boxes of its edges and triangles.
typedef struct Nodes {
    Quad at[5], edge_low[8], edge_high[8];
    FourBoxes triangles, edges[2];
    uint32_t id[5];
} Nodes;

static void place_nodes(const Shell *shell, uint32_t cell, const float (*x)[4], Quad origin, Nodes *nodes) {
    touch_nodes(shell->cells[cell], x, origin, nodes->at);
    for (int i = 0; i < 5; i++) nodes->id[i] = touch_id(shell, cell, i);
}

static void place_boxes(Nodes *nodes) {
    Quad low[4], high[4];
    for (int e = 0; e < 8; e++) {
        nodes->edge_low[e] = quad_min(nodes->at[touch_edge[e][0]], nodes->at[touch_edge[e][1]]);
        nodes->edge_high[e] = quad_max(nodes->at[touch_edge[e][0]], nodes->at[touch_edge[e][1]]);
    }
    for (int t = 0; t < 4; t++) {
        low[t] = quad_min(nodes->edge_low[t], nodes->edge_low[4 + t]);
        high[t] = quad_max(nodes->edge_high[t], nodes->edge_high[4 + t]);
    }
    nodes->triangles = four_boxes(low, high);
    nodes->edges[0] = four_boxes(nodes->edge_low, nodes->edge_high);
    nodes->edges[1] = four_boxes(nodes->edge_low + 4, nodes->edge_high + 4);
}

/// Whether two cells lie farther apart than `far` along the normal of the first one's diagonals.
static bool normal_parts(const Nodes *p, const Nodes *q, float far) {
    Quad normal = quad_cross(p->at[2] - p->at[0], p->at[3] - p->at[1]);
    float length = sqrtf(quad_dot(normal, normal)), low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) { // the virtual centre lies between
        float a = quad_dot(normal, p->at[i]), b = quad_dot(normal, q->at[i]);
        low[0] = a < low[0] ? a : low[0], high[0] = a > high[0] ? a : high[0];
        low[1] = b < low[1] ? b : low[1], high[1] = b > high[1] ? b : high[1];
    }
    return low[0] - high[1] > far * length || low[1] - high[0] > far * length;
}

/// Nodes of p that cell a owns against triangles of q that do not have them.
static uint64_t near_nodes(const TouchPlan *plan, uint32_t a, const Nodes *p, const Nodes *q, float far,
                           float *nearest) {
    uint64_t found = 0;
    for (int i = 0; i < 5; i++) {
        if (!touch_owns_node(plan, a, i)) continue;
        unsigned meet = which_meet(&q->triangles, p->at[i] - far, p->at[i] + far);
        for (int j = 0; meet >> j; j++) {
            const uint8_t *k = touch_triangle[j];
            if (!(meet >> j & 1) || p->id[i] == q->id[k[0]] || p->id[i] == q->id[k[1]] || p->id[i] == q->id[k[2]])
                continue;
            float weight[3];
            Quad apart = touch_from_triangle(p->at[i], q->at[k[0]], q->at[k[1]], q->at[k[2]], weight);
            float distance = sqrtf(quad_dot(apart, apart));
            *nearest = distance < *nearest ? distance : *nearest;
            if (distance < far) found |= UINT64_C(1) << (4 * i + j);
        }
    }
    return found;
}

/// Whether two directions are more than 10 degrees apart.
static bool edges_cross(Quad a, Quad b, Quad c, Quad d) {
    Quad u = b - a, v = d - c;
    float uv = quad_dot(u, v);
    return uv * uv < 0.97f * quad_dot(u, u) * quad_dot(v, v);
}

static bool is_near_edge(const Nodes *p, const uint8_t k[2], const Nodes *q, const uint8_t l[2], float far,
                         float *nearest) {
    if (p->id[k[0]] == q->id[l[0]] || p->id[k[0]] == q->id[l[1]] || p->id[k[1]] == q->id[l[0]] ||
        p->id[k[1]] == q->id[l[1]])
        return false;
    float s, t;
    Quad apart = touch_from_segment(p->at[k[0]], p->at[k[1]], q->at[l[0]], q->at[l[1]], &s, &t);
    float distance = sqrtf(quad_dot(apart, apart));
    *nearest = distance < *nearest ? distance : *nearest;
    // where an end is the nearest point, that node's triangles see it too; and edges side by side would make ridges of
    // a flat sheet
    return distance < far && s > 0 && s < 1 && t > 0 && t < 1 &&
           edges_cross(p->at[k[0]], p->at[k[1]], q->at[l[0]], q->at[l[1]]);
}

static uint64_t near_edges(const TouchPlan *plan, const TouchPair *pair, const Nodes *p, const Nodes *q, float far,
                           float *nearest) {
    uint64_t found = 0;
    for (int i = 0; i < 8; i++) {
        if (!touch_owns_edge(plan, pair->a, i)) continue;
        Quad low = p->edge_low[i] - far, high = p->edge_high[i] + far;
        unsigned meet = which_meet(&q->edges[0], low, high) | which_meet(&q->edges[1], low, high) << 4;
        for (int j = 0; meet >> j; j++)
            if (meet >> j & 1 && touch_owns_edge(plan, pair->b, j) &&
                is_near_edge(p, touch_edge[i], q, touch_edge[j], far, nearest))
                found |= UINT64_C(1) << (8 * i + j);
    }
    return found;
}

static void measure_pair(const Find *find, TouchPair *pair) {
    const TouchPlan *plan = find->plan;
    const float(*x)[4] = (const float(*)[4])plan->place;
    Quad origin = quad_load(x[find->shell->cells[pair->a][0]]);
    // as far as the two may meet before the next search
    Quad nearing = plan->boxes[pair->a].way - plan->boxes[pair->b].way;
    float far = plan->reach + sqrtf(quad_dot(nearing, nearing)), nearest = far;
    Nodes p, q;
    place_nodes(find->shell, pair->a, x, origin, &p);
    place_nodes(find->shell, pair->b, x, origin, &q);
    pair->distance = far;
    if (pair->bridge == SHELL_NONE && (normal_parts(&p, &q, far) || normal_parts(&q, &p, far))) return;
    if (pair->bridge != SHELL_NONE && touch_is_unfolded(touch_normals(p.at), touch_normals(q.at), false)) {
        pair->distance = 0;
        return;
    }
    place_boxes(&p);
    place_boxes(&q);
    pair->nodes = near_nodes(plan, pair->a, &p, &q, far, &nearest);
    pair->nodes |= near_nodes(plan, pair->b, &q, &p, far, &nearest) << 20;
    pair->edges = near_edges(plan, pair, &p, &q, far, &nearest);
    pair->distance = nearest;
}

static void measure_range(void *task, int begin, int end) {
    const Find *find = task;
    for (int k = begin; k < end; k++) {
        TouchPair *pair = &find->plan->pairs[k];
        if (pair->a != pair->b) measure_pair(find, pair);
    }
}

// ---- what crosses from the start

/// Whether two cells' triangles pass through each other, other than where they hang together.
static bool cells_cross(const TouchPlan *plan, const Shell *shell, uint32_t a, uint32_t b) {
    const float(*x)[4] = (const float(*)[4])plan->place;
    Quad origin = quad_load(x[shell->cells[a][0]]), p[5], q[5];
    touch_nodes(shell->cells[a], x, origin, p);
    touch_nodes(shell->cells[b], x, origin, q);
    for (int e = 0; e < 8; e++) {
        const uint8_t *k = touch_edge[e];
        uint32_t first = touch_id(shell, a, k[0]), second = touch_id(shell, a, k[1]);
        for (int t = 0; t < 4; t++) {
            const uint8_t *l = touch_triangle[t];
            bool joined = false;
            for (int i = 0; i < 3; i++) {
                uint32_t node = touch_id(shell, b, l[i]);
                joined |= node == first || node == second;
            }
            if (!joined && touch_pierces(p[k[0]], p[k[1]], q[l[0]], q[l[1]], q[l[2]])) return true;
        }
    }
    return false;
}

/// Marks cells that cross another: all of them at the first search, later those that have not parted since.
static void find_tangled(TouchPlan *plan, const Shell *shell, bool first) {
    if (!first && plan->counters.tangled == 0) return;
    enum { WAS = 1, IS = 2 };
    if (first) memset(plan->tangled, WAS, plan->cell_count);
    for (uint32_t k = 0; k < plan->pair_count; k++) {
        const TouchPair *pair = &plan->pairs[k];
        if (!(plan->tangled[pair->a] && plan->tangled[pair->b])) continue;
        const TouchBox *p = &plan->boxes[pair->a], *q = &plan->boxes[pair->b];
        if (!quads_meet(p->low, p->high, q->low, q->high)) continue;
        if (cells_cross(plan, shell, pair->a, pair->b) || cells_cross(plan, shell, pair->b, pair->a))
            plan->tangled[pair->a] |= IS, plan->tangled[pair->b] |= IS;
    }
    plan->counters.tangled = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        plan->tangled[c] = (plan->tangled[c] & IS) != 0;
        plan->counters.tangled += plan->tangled[c];
    }
}

/// Fewer steps where cells move fast against each other: in the mean by a third of a cell at most.
static void choose_steps(TouchPlan *plan) {
    Quad mean = {0};
    double sum = 0, count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->alive[c]) mean += quad_load(plan->speed[c]), count++;
    mean = mean / (float)fmax(count, 1);
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        Quad off = quad_load(plan->speed[c]) - mean;
        if (plan->alive[c]) sum += (double)sqrtf(quad_dot(off, off));
    }
    double step = sum / fmax(count, 1) * (double)plan->time_step, most = (double)plan->cell_size / 3;
    plan->steps = step * TOUCH_STEPS < most ? TOUCH_STEPS : step * 2 > most ? 2 : (uint32_t)(most / step);
}

void touch_search(TouchPlan *plan, const Shell *shell, Pool *pool) {
    Find find = {plan, shell, false};
    plan->listed_count = 0, plan->restless = 0;
    choose_steps(plan);
    find_owners(plan, shell);
    pool_for(pool, (int)plan->cell_count, 512, box_range, &find);
    find_pairs(&find, pool);
    pool_for(pool, (int)plan->pair_count, TOUCH_BLOCK, measure_range, &find);
    find_tangled(plan, shell, plan->searched == 0);
    plan->searched = 1;
    plan->counters.searches++;
}

// Which cells meet on their ways.
//
// Every corner has gone from x0, where the step began, to x1. A pair of cells that were at least d apart at x0 and have
// moved since by less, relative to each other, cannot have met:
//
//   |mean way of a - mean way of b| + deviation of a + deviation of b < d
//
// Cells that share a side or a corner are free where they can be shown not to cross as the step ends, by their normals
// or by a plane between them (feature_distance.c). What is left is swept, feature by feature.
#include "collision/ccd.h"
#include "collision/feature_distance.h"

// ---- sweeping a pair

static void sweep_nodes(const Guard *guard, uint32_t c, Quad origin, Quad mean, Swept *out) {
    const uint32_t *corner = guard->shell->cells[c];
    Quad end[5];
    touch_nodes(corner, (const float(*)[4])guard->plan->start, origin, out->place);
    touch_nodes(corner, (const float(*)[4])guard->dynamics->position, origin + mean, end);
    for (int i = 0; i < 5; i++) {
        out->way[i] = end[i] - out->place[i];
        out->low[i] = quad_min(out->place[i], end[i]);
        out->high[i] = quad_max(out->place[i], end[i]);
    }
    touch_boxes(four_of(out->low), four_of(out->high), out->low[4], out->high[4], &out->boxes);
}

static float sweep_node(const Guard *guard, const Swept *p, int i, const Swept *q, int j) {
    const uint8_t *k = touch_triangle[j];
    TouchSweep sweep = {{p->place[i], q->place[k[0]], q->place[k[1]], q->place[k[2]]},
                        {p->way[i], q->way[k[0]], q->way[k[1]], q->way[k[2]]}, false};
    return touch_sweep(&sweep, guard->plan->gap, guard->plan->noise);
}

static float sweep_edge(const Guard *guard, const Swept *p, int i, const Swept *q, int j) {
    const uint8_t *k = touch_edge[i], *l = touch_edge[j];
    TouchSweep sweep = {{p->place[k[0]], p->place[k[1]], q->place[l[0]], q->place[l[1]]},
                        {p->way[k[0]], p->way[k[1]], q->way[l[0]], q->way[l[1]]}, true};
    return touch_sweep(&sweep, guard->plan->gap, guard->plan->noise);
}

static void note_hit(TouchPair *pair, float hit, int kind, int i, int j) {
    if (!(hit < pair->hit)) return;
    pair->hit = hit;
    pair->kind = (uint8_t)kind;
    pair->first[0] = (uint8_t)i, pair->first[1] = (uint8_t)j;
}

void guard_sweep_cells(const Guard *guard, const TouchPair *pair, Swept *p, Swept *q) {
    uint32_t first = guard->shell->cells[pair->a][0];
    Quad origin = quad_load(guard->plan->start[first]);
    Quad mean = quad_load(guard->dynamics->position[first]) - origin;
    sweep_nodes(guard, pair->a, origin, mean, p);
    sweep_nodes(guard, pair->b, origin, mean, q);
}

/// Nodes that cell c owns, of p, against triangles of q that do not have them; bits of same[i] are the corners of q
/// that are corner i of p.
static void sweep_all_nodes(const Guard *guard, TouchPair *pair, uint32_t c, const Swept *p, const Swept *q,
                            const unsigned same[4], int kind) {
    for (int i = 0; i < 5; i++) {
        if (!touch_owns_node(guard->plan, c, i)) continue;
        // of one cell, the middle is in all triangles
        unsigned meet = i < 4 ? 15 & ~touch_around(same[i]) : pair->a == pair->b ? 0 : 15;
        if (meet) meet &= four_meet(&q->boxes.triangles, p->low[i] - guard->plan->gap, p->high[i] + guard->plan->gap);
        for (; meet; meet &= meet - 1) {
            int j = __builtin_ctz(meet);
            note_hit(pair, sweep_node(guard, p, i, q, j), kind, i, j);
        }
    }
}

static void sweep_all_edges(const Guard *guard, TouchPair *pair, const Swept *p, const Swept *q,
                            const unsigned same[4]) {
    const TouchPlan *plan = guard->plan;
    for (int i = 0; i < 8; i++) {
        if (!touch_owns_edge(plan, pair->a, i)) continue;
        const uint8_t *k = touch_edge[i];
        unsigned corners = same[k[0]] | (k[1] < 4 ? same[k[1]] : 0);
        Quad low = quad_min(p->low[k[0]], p->low[k[1]]) - plan->gap;
        Quad high = quad_max(p->high[k[0]], p->high[k[1]]) + plan->gap;
        unsigned sides = four_meet(&q->boxes.sides, low, high) & plan->owned[pair->b] >> 4 & ~touch_around(corners);
        unsigned spokes = four_meet(&q->boxes.spokes, low, high) & ~corners;
        if (pair->a == pair->b) sides &= 14u << i, spokes = i < 4 ? spokes : 0; // each two once
        for (unsigned meet = sides | spokes << 4; meet; meet &= meet - 1) {
            int j = __builtin_ctz(meet);
            note_hit(pair, sweep_edge(guard, p, i, q, j), TOUCH_EDGES, i, j);
        }
    }
}

/// Finds the share of the step's way that two cells can go before they meet, and what meets.
static void sweep_pair(const Guard *guard, TouchPair *pair) {
    const uint32_t *a = guard->shell->cells[pair->a], *b = guard->shell->cells[pair->b];
    unsigned of_b[4], of_a[4];
    Swept p, q;
    guard_sweep_cells(guard, pair, &p, &q);
    touch_same(a, b, of_b);
    touch_same(b, a, of_a);
    sweep_all_nodes(guard, pair, pair->a, &p, &q, of_b, TOUCH_NODE_OF_A);
    if (pair->a != pair->b) sweep_all_nodes(guard, pair, pair->b, &q, &p, of_a, TOUCH_NODE_OF_B);
    sweep_all_edges(guard, pair, &p, &q, of_b);
}

/// Whether a cell has not passed through itself: it is open and in shape as the step ends, and has moved within itself
/// by less than an eighth of its width. One that is open may have passed through itself on the way: then it is on the
/// wrong side of a cell that shares two sides with it, though it met no feature of that one.
static bool own_is_free(const Guard *guard, uint32_t cell) {
    const Quad *motion = guard->plan->motion[cell];
    const float(*x)[4] = (const float(*)[4])guard->dynamics->position;
    const uint32_t *corner = guard->shell->cells[cell];
    if (!(motion[TOUCH_NORMAL][3] < TOUCH_CONE)) return false;
    Quad one = quad_flat(quad_load(x[corner[2]]) - quad_load(x[corner[0]]));
    Quad two = quad_flat(quad_load(x[corner[3]]) - quad_load(x[corner[1]])), area = quad_cross(one, two);
    float way = 8 * motion[TOUCH_WAY][3];
    return way * way * (quad_dot(one, one) + quad_dot(two, two)) < quad_dot(area, area);
}

/// Of four pairs, those that are free by how far apart they are, or, as they hang together, by their normals, of which
/// feature_distance.c has the proof: bits.
static unsigned four_are_free(const Guard *guard, const uint32_t number[4]) {
    const TouchPlan *plan = guard->plan;
    TouchFourPairs four = touch_four_pairs(plan, number);
    // so far apart that the sweep, which stops a little before the gap, would not stop either
    QuadMask apart = (four.distance > 2 * plan->gap) &
                     (touch_four_differ(&four, TOUCH_WAY) + plan->noise < 0.9f * (four.distance - plan->gap));
    unsigned free = quad_bits(apart), bridged = four.bridged & ~free;
    if (!bridged) return free;
    QuadMask sides = touch_four_within(&four, four.a, four.b, TOUCH_CONE_SIDE);
    QuadMask corners = touch_four_within(&four, four.a, four.bridge, TOUCH_CONE_CORNER) &
                       touch_four_within(&four, four.b, four.bridge, TOUCH_CONE_CORNER);
    for (unsigned i = 0; i < 4; i++) {
        if (!(bridged >> i & 1) || !guard_is_alive(guard, four.bridge[i])) continue;
        bool part = four.a[i] == four.b[i]        ? own_is_free(guard, four.a[i])
                    : four.bridge[i] == four.a[i] ? sides[i] != 0
                                                  : corners[i] != 0;
        free |= (unsigned)part << i;
    }
    return free;
}

/// Cells that hang together, by a plane that parts them at both ends of the step, and has not been turned over: then
/// they have not passed through each other about what they share.
static bool plane_parts(const Guard *guard, const TouchPair *pair) {
    const uint32_t *a = guard->shell->cells[pair->a], *b = guard->shell->cells[pair->b];
    const float(*places[2])[4] = {(const float(*)[4])guard->plan->start, (const float(*)[4])guard->dynamics->position};
    unsigned shared[2] = {0, 0};
    for (int i = 0; i < 16; i++)
        if (a[i >> 2] == b[i & 3]) shared[0] |= 1u << (i >> 2), shared[1] |= 1u << (i & 3);
    if (!shared[0] || pair->a == pair->b) return false;
    Quad p[5], q[5], normal[2];
    for (int k = 0; k < 2; k++) {
        Quad origin = quad_load(places[k][a[0]]);
        touch_nodes(a, places[k], origin, p);
        touch_nodes(b, places[k], origin, q);
        if (!touch_is_parted(p, q, shared, guard->plan->gap, &normal[k])) return false;
    }
    return quad_dot(normal[0], normal[1]) > 0;
}

/// Returns whether a pair meets.
static bool look_at_pair(const Guard *guard, TouchPair *pair) {
    if (!guard_is_alive(guard, pair->a) || !guard_is_alive(guard, pair->b)) return false;
    if (touch_is_tangled(guard->plan, pair)) return false;
    if (!plane_parts(guard, pair)) sweep_pair(guard, pair);
    return pair->hit < 2;
}

/// Looks at the pairs whose numbers are given, four at a time. Returns how many meet.
static uint32_t look_at_four(const Guard *guard, const uint32_t number[4], uint32_t count) {
    TouchPlan *plan = guard->plan;
    uint32_t hits = 0;
    for (uint32_t i = 0; i < count; i++) plan->pairs[number[i]].hit = 2;
    for (unsigned look = ((1u << count) - 1) & ~four_are_free(guard, number); look; look &= look - 1)
        hits += look_at_pair(guard, &plan->pairs[number[__builtin_ctz(look)]]);
    return hits;
}

typedef struct Look {
    const Guard *guard;
    uint32_t first;         ///< pair
    const uint32_t *active; ///< pairs, or NULL for all from the first on
} Look;

static double look_range(void *task, int begin, int end) {
    const Look *look = task;
    double hits = 0;
    for (int k = begin; k < end; k += 4) {
        uint32_t number[4], count = end - k < 4 ? (uint32_t)(end - k) : 4;
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t at = (uint32_t)k + (i < count ? i : 0);
            number[i] = look->active ? look->active[at] : look->first + at;
        }
        hits += look_at_four(look->guard, number, count);
    }
    return hits;
}

uint32_t guard_meet(const Guard *guard, Pool *pool, uint32_t first) {
    TouchPlan *plan = guard->plan;
    Look look = {guard, first, NULL};
    plan->hit_count = 0;
    if (pool_sum(pool, (int)(plan->pair_count - first), look_range, &look, plan->partial) > 0)
        for (uint32_t k = first; k < plan->pair_count; k++)
            if (plan->pairs[k].hit < 2) plan->active[plan->hit_count++] = k;
    return plan->hit_count;
}

uint32_t guard_meet_active(const Guard *guard, Pool *pool, uint32_t count) {
    TouchPlan *plan = guard->plan;
    Look look = {guard, 0, plan->active};
    plan->hit_count = 0;
    if (pool_sum(pool, (int)count, look_range, &look, plan->partial) > 0)
        for (uint32_t k = 0; k < count; k++)
            if (plan->pairs[plan->active[k]].hit < 2) plan->active[plan->hit_count++] = plan->active[k];
    return plan->hit_count;
}

// No way through: continuous detection at the end of a step, and what is done where ways meet.
//
// Every corner has gone from x0, where the step began, to x1. A pair of cells that were at least d apart at x0 and have
// moved since by less, relative to each other, cannot have met:
//
//   |mean way of a - mean way of b| + deviation of a + deviation of b < d
//
// Cells that share a side or a corner are free where they can be shown not to cross as the step ends, by their normals
// or by a plane between them (touch_near.c). What is left is swept, feature by feature. Where it meets, the corners of
// both cells form a zone, with all zones that they touch, and go
//
//   x0 + u + a (x1 - x0 - u),   u the mean way of the zone by mass,
//
// with a the share of the way that was free: the zone keeps its momentum and loses what would have closed it. As other
// cells may now be in the way, this is repeated with what has changed; a zone that meets again halves its share, and
// has 0 from round ZONE_PATIENCE on, when it moves as one piece (the impact zones of Provot, 1997). Both steps only
// ever join zones or lessen shares, so the rounds end. Held corners go their own way.
//
// A corner that has left the box that the search gave its cell may have met what the search did not list: then the
// search is repeated for this step's own ways.
#include "base/clock.h"
#include "contact/touch_near.h"
#include "contact/touch_plan.h"

#include <string.h>

enum { IMPACT_ROUNDS = 64, IMPACT_PART = 3, ZONE_PATIENCE = 4, ZONE_ROUNDS = 128 };

/// The part of all cells that may be outside their boxes before all are searched again; and that from which on the next
/// step begins with a search.
enum { STRAY_MOST = 8, STRAY_PART = 32 };

typedef struct Guard {
    TouchPlan *plan;
    const Shell *shell;
    DynamicsState *dynamics;
    const uint8_t *cell_flags;
    float time;   ///< s since the search
    uint32_t first; ///< look at pairs from this one on, where all are looked at
} Guard;

// ---- how cells have moved

static bool is_alive(const Guard *guard, uint32_t c) { return guard->cell_flags[c] & SINGE_ALIVE; }

static void measure_cell(const Guard *guard, uint32_t c) {
    TouchPlan *plan = guard->plan;
    const uint32_t *corner = guard->shell->cells[c];
    const float(*x)[4] = (const float(*)[4])guard->dynamics->position;
    Quad node[5], stray[4];
    for (int i = 0; i < 4; i++) {
        Quad foreseen = quad_load(plan->place[corner[i]]) + guard->time * quad_load(plan->speed[corner[i]]);
        stray[i] = quad_load(x[corner[i]]) - foreseen;
    }
    FourVectors astray = four_of(stray);
    touch_nodes(corner, x, quad_load(x[corner[0]]), node);
    plan->motion[c][TOUCH_WAY] = touch_way(plan, corner, x);
    plan->motion[c][TOUCH_NORMAL] = touch_normals(node);
    plan->strayed[c] = quad_bits(four_dot(astray, astray) < 0.25f * plan->slack * plan->slack) != 15;
}

static void measure_range(void *task, int begin, int end) {
    const Guard *guard = task;
    for (int c = begin; c < end; c++) {
        if (is_alive(guard, (uint32_t)c)) measure_cell(guard, (uint32_t)c);
        else guard->plan->strayed[c] = 0;
    }
}

static void measure_changed(void *task, int begin, int end) {
    const Guard *guard = task;
    for (int k = begin; k < end; k++) measure_cell(guard, guard->plan->changed_list[k]);
}

// ---- what the last round has changed

static void forget_changed(TouchPlan *plan) {
    for (uint32_t k = 0; k < plan->changed_count; k++) plan->changed[plan->changed_list[k]] = 0;
    plan->changed_count = 0;
}

static void mark_changed(const Guard *guard, uint32_t cell) {
    TouchPlan *plan = guard->plan;
    if (plan->changed[cell] || !is_alive(guard, cell)) return;
    plan->changed[cell] = 1;
    plan->changed_list[plan->changed_count++] = cell;
}

/// Marks the cells around a vertex.
static void mark_around(const Guard *guard, uint32_t v) {
    const Shell *shell = guard->shell;
    for (uint32_t f = shell->fan_first[v]; f < shell->fan_first[v + 1]; f++) mark_changed(guard, shell->fan[f]);
}

/// Marks the cells that have been moved since the guard was here before in this step.
static void mark_moved(const Guard *guard) {
    const TouchPlan *plan = guard->plan;
    forget_changed(guard->plan);
    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        QuadMask moved = quad_load(guard->dynamics->position[v]) != quad_load(plan->end[v]);
        if (quad_bits(moved) & 7) mark_around(guard, v);
    }
}

/// Sorts the search's pairs by their cells, once for each search.
static void sort_around(TouchPlan *plan) {
    if (plan->around_search == plan->counters.searches) return;
    plan->around_search = plan->counters.searches;
    uint32_t *first = plan->around_first;
    memset(first, 0, ((size_t)plan->cell_count + 2) * sizeof *first);
    for (uint32_t k = 0; k < plan->listed_count; k++) {
        const TouchPair *pair = &plan->pairs[k];
        first[pair->a + 2]++;
        first[pair->b + 2] += pair->a != pair->b;
    }
    for (uint32_t c = 0; c < plan->cell_count; c++) first[c + 2] += first[c + 1];
    for (uint32_t k = 0; k < plan->listed_count; k++) {
        const TouchPair *pair = &plan->pairs[k];
        plan->around[first[pair->a + 1]++] = k;
        if (pair->a != pair->b) plan->around[first[pair->b + 1]++] = k;
    }
}

/// Lists the pairs of cells that have changed. Returns how many.
static uint32_t list_changed(TouchPlan *plan) {
    uint32_t count = 0;
    sort_around(plan);
    for (uint32_t l = 0; l < plan->changed_count; l++) {
        uint32_t c = plan->changed_list[l];
        for (uint32_t e = plan->around_first[c]; e < plan->around_first[c + 1]; e++) {
            const TouchPair *pair = &plan->pairs[plan->around[e]];
            uint32_t other = pair->a == c ? pair->b : pair->a;
            if (!plan->changed[other] || other >= c) plan->active[count++] = plan->around[e];
        }
    }
    for (uint32_t k = plan->listed_count; k < plan->pair_count; k++)
        if (plan->changed[plan->pairs[k].a] | plan->changed[plan->pairs[k].b]) plan->active[count++] = k;
    return count;
}

// ---- sweeping a pair

typedef struct Swept {
    Quad place[5], way[5], low[5], high[5]; ///< of nodes
    TouchBoxes boxes;
} Swept;

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

static void sweep_both(const Guard *guard, const TouchPair *pair, Swept *p, Swept *q) {
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
    sweep_both(guard, pair, &p, &q);
    touch_same(a, b, of_b);
    touch_same(b, a, of_a);
    sweep_all_nodes(guard, pair, pair->a, &p, &q, of_b, TOUCH_NODE_OF_A);
    if (pair->a != pair->b) sweep_all_nodes(guard, pair, pair->b, &q, &p, of_a, TOUCH_NODE_OF_B);
    sweep_all_edges(guard, pair, &p, &q, of_b);
}

/// Of four pairs, those that are free by how far apart they are, or, as they hang together, by their normals, of which
/// touch_near.c has the proof: bits.
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
        if (!(bridged >> i & 1) || !is_alive(guard, four.bridge[i])) continue;
        bool part = four.a[i] == four.b[i]        ? touch_is_open(plan->motion[four.a[i]][TOUCH_NORMAL])
                    : four.bridge[i] == four.a[i] ? sides[i] != 0
                                                  : corners[i] != 0;
        free |= (unsigned)part << i;
    }
    return free;
}

/// Cells that hang together, by a plane that parts them at both ends of the step, and has not been turned over: then they have not
/// passed through each other about what they share.
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
    if (!(is_alive(guard, pair->a) && is_alive(guard, pair->b)) || touch_is_tangled(guard->plan, pair)) return false;
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

/// Pairs from guard->first on.
static double sweep_range(void *task, int begin, int end) {
    const Guard *guard = task;
    double hits = 0;
    for (int k = begin; k < end; k += 4) {
        uint32_t number[4], count = end - k < 4 ? (uint32_t)(end - k) : 4;
        for (uint32_t i = 0; i < 4; i++) number[i] = guard->first + (uint32_t)k + (i < count ? i : 0);
        hits += look_at_four(guard, number, count);
    }
    return hits;
}

/// Pairs of plan->active.
static double sweep_active(void *task, int begin, int end) {
    const Guard *guard = task;
    double hits = 0;
    for (int k = begin; k < end; k += 4) {
        uint32_t number[4], count = end - k < 4 ? (uint32_t)(end - k) : 4;
        for (uint32_t i = 0; i < 4; i++) number[i] = guard->plan->active[(uint32_t)k + (i < count ? i : 0)];
        hits += look_at_four(guard, number, count);
    }
    return hits;
}

// ---- impacts

/// Weights of a cell's corners that stand for its nodes.
static void spread(float corner[4], int node, float weight) {
    for (int i = 0; i < 4; i++) corner[i] += node == i ? weight : node == 4 ? 0.25f * weight : 0;
}

/// Where what meets first meets: weights of the corners of a and b, and from the second point to the first.
static Quad impact_points(const TouchPair *pair, const Swept *p, const Swept *q, float wa[4], float wb[4]) {
    const Swept *one = pair->kind == TOUCH_NODE_OF_B ? q : p, *two = pair->kind == TOUCH_NODE_OF_B ? p : q;
    float *w1 = pair->kind == TOUCH_NODE_OF_B ? wb : wa, *w2 = pair->kind == TOUCH_NODE_OF_B ? wa : wb;
    Quad x[5], y[5], apart;
    for (int i = 0; i < 5; i++) {
        x[i] = one->place[i] + pair->hit * one->way[i];
        y[i] = two->place[i] + pair->hit * two->way[i];
    }
    if (pair->kind == TOUCH_EDGES) {
        const uint8_t *k = touch_edge[pair->first[0]], *l = touch_edge[pair->first[1]];
        float s, t;
        apart = touch_from_segment(x[k[0]], x[k[1]], y[l[0]], y[l[1]], &s, &t);
        spread(w1, k[0], 1 - s), spread(w1, k[1], s);
        spread(w2, l[0], 1 - t), spread(w2, l[1], t);
        return apart;
    }
    const uint8_t *k = touch_triangle[pair->first[1]];
    float weight[3];
    apart = touch_from_triangle(x[pair->first[0]], y[k[0]], y[k[1]], y[k[2]], weight);
    spread(w1, pair->first[0], 1);
    for (int i = 0; i < 3; i++) spread(w2, k[i], weight[i]);
    return pair->kind == TOUCH_NODE_OF_B ? -apart : apart;
}

/// What each corner of a side goes of a shift of its point: as its weight and inverse mass say, but that no corner
/// counts as lighter than a quarter of the heaviest. Else a light corner, far from the point, would be thrown far to
/// move it. Returns the point's own inverse mass.
static float impact_lever(const Guard *guard, uint32_t cell, const float w[4], float lever[4]) {
    const uint32_t *corner = guard->shell->cells[cell];
    float least = INFINITY, inverse[4], own = 0, sum = 0;
    for (int i = 0; i < 4; i++) {
        inverse[i] = guard->plan->start[corner[i]][3];
        own += w[i] * w[i] * inverse[i];
        if (w[i] != 0 && inverse[i] > 0) least = fminf(least, inverse[i]);
    }
    for (int i = 0; i < 4; i++) inverse[i] = fminf(inverse[i], 4 * least), sum += w[i] * w[i] * inverse[i];
    for (int i = 0; i < 4; i++) lever[i] = sum > 0 ? fminf(w[i] * inverse[i] / sum, 2) : 0;
    return own;
}

/// Moves the points that meet by `shift` relative to each other, each by what it weighs.
static void impact_move(const Guard *guard, const TouchPair *pair, const float wa[4], const float wb[4], Quad shift) {
    float lever[2][4], a = impact_lever(guard, pair->a, wa, lever[0]), b = impact_lever(guard, pair->b, wb, lever[1]);
    for (int k = 0; a + b > 0 && k < 8; k++) {
        uint32_t v = guard->shell->cells[k < 4 ? pair->a : pair->b][k & 3];
        float go = (k < 4 ? a : -b) / (a + b) * lever[k >> 2][k & 3], *x = guard->dynamics->position[v];
        if (go == 0) continue;
        quad_store(x, quad_load(x) + go * shift);
        mark_around(guard, v);
    }
}

static Quad impact_slip(const Guard *guard, const TouchPair *pair, const float wa[4], const float wb[4],
                        const float (*x)[4]) {
    const uint32_t *a = guard->shell->cells[pair->a], *b = guard->shell->cells[pair->b];
    Quad sum = {0};
    for (int i = 0; i < 4; i++) sum += wa[i] * quad_load(x[a[i]]) - wb[i] * quad_load(x[b[i]]);
    sum[3] = 0;
    return sum;
}

/// An impact without bounce, and with friction: the points part at the end as far as when they met, and a little
/// farther, so that what others push back does not meet again at once: else the rounds are eight times as many.
static void impact(const Guard *guard, const TouchPair *pair) {
    Swept p, q;
    float wa[4] = {0}, wb[4] = {0};
    sweep_both(guard, pair, &p, &q);
    Quad normal = impact_points(pair, &p, &q, wa, wb);
    float distance = sqrtf(quad_dot(normal, normal));
    if (!(distance > 0)) return;
    normal = normal / distance;
    Quad end = impact_slip(guard, pair, wa, wb, (const float(*)[4])guard->dynamics->position);
    Quad slip = end - impact_slip(guard, pair, wa, wb, (const float(*)[4])guard->plan->start);
    // where impacts before this one have changed the ways, these are farther apart by now than where they met
    float push = fminf(distance, 2 * guard->plan->gap) + IMPACT_PART * guard->plan->gap - quad_dot(end, normal);
    if (push <= 0) return;
    slip -= quad_dot(slip, normal) * normal;
    float length = sqrtf(quad_dot(slip, slip)), most = guard->plan->def.friction * push;
    Quad shift = push * normal - (length <= most ? 1 : most / length) * slip;
    impact_move(guard, pair, wa, wb, shift);
}

/// Impacts of all pairs that meet, one after another.
static void impact_all(const Guard *guard) {
    TouchPlan *plan = guard->plan;
    forget_changed(plan);
    for (uint32_t k = 0; k < plan->hit_count; k++) {
        const TouchPair *pair = &plan->pairs[plan->active[k]];
        impact(guard, pair);
        mark_changed(guard, pair->a), mark_changed(guard, pair->b);
    }
}

// ---- zones

static uint32_t zone_root(TouchPlan *plan, uint32_t v) {
    uint32_t *zone = plan->zone;
    while (zone[v] != v) v = zone[v] = zone[zone[v]];
    return v;
}

/// Puts a vertex into a zone of its own, with all of its way, unless it is in one.
static void zone_enter(const Guard *guard, uint32_t v) {
    TouchPlan *plan = guard->plan;
    if (plan->zone[v] != SHELL_NONE) return;
    plan->zone[v] = v;
    plan->share[v] = 1;
    plan->stopped[plan->stopped_count++] = v;
    memcpy(plan->goal[v], guard->dynamics->position[v], sizeof *plan->goal);
}

/// Joins the corners of a pair that meets, and lessens their share of the way.
static void zone_join(const Guard *guard, const TouchPair *pair, int round) {
    TouchPlan *plan = guard->plan;
    const uint32_t *a = guard->shell->cells[pair->a], *b = guard->shell->cells[pair->b];
    uint32_t root = SHELL_NONE;
    float share = 1;
    for (int i = 0; i < 8; i++) {
        uint32_t v = i < 4 ? a[i] : b[i - 4];
        zone_enter(guard, v);
        uint32_t other = zone_root(plan, v);
        share = fminf(share, plan->share[other]);
        if (root == SHELL_NONE) root = other;
        if (other < root) plan->zone[root] = other, root = other;
        else plan->zone[other] = root;
    }
    // in the first round the share is what was free; later the zone's own ways have changed
    float less = round == 0 ? 0.9f * pair->hit : round < ZONE_PATIENCE ? 0.5f * share : 0;
    plan->share[root] = fminf(share, less);
}

/// Mean ways by mass; those of held corners count alone where there are any.
static void zone_drift(const Guard *guard) {
    TouchPlan *plan = guard->plan;
    for (uint32_t k = 0; k < plan->stopped_count; k++) plan->drift[plan->stopped[k]] = (Quad){0};
    for (uint32_t k = 0; k < plan->stopped_count; k++) {
        uint32_t v = plan->stopped[k];
        float inverse = plan->start[v][3], mass = inverse > 0 ? 1 / inverse : 1e6f;
        Quad way = quad_load(plan->goal[v]) - quad_load(plan->start[v]);
        way[3] = 1;
        plan->drift[zone_root(plan, v)] += mass * way;
    }
}

/// Moves what is in zones, and marks the cells around.
static void zone_move(const Guard *guard) {
    TouchPlan *plan = guard->plan;
    zone_drift(guard);
    for (uint32_t k = 0; k < plan->stopped_count; k++) {
        uint32_t v = plan->stopped[k], root = zone_root(plan, v);
        if (plan->start[v][3] == 0) continue;
        Quad drift = plan->drift[root] / plan->drift[root][3], start = quad_load(plan->start[v]);
        Quad way = quad_load(plan->goal[v]) - start;
        Quad end = start + drift + plan->share[root] * (way - drift);
        end[3] = start[3];
        quad_store(guard->dynamics->position[v], end);
    }
    forget_changed(plan);
    for (uint32_t k = 0; k < plan->stopped_count; k++) mark_around(guard, plan->stopped[k]);
}

/// A velocity after a shift at the step's end: what the shift takes or gives, but no more than there was before or has
/// been gone in the step. What the step's last substep has brought in is in the velocity, in the way only by a small
/// part.
static Quad shifted_velocity(Quad before, Quad shift, Quad way, float h) {
    Quad after = before + shift / h, gone = way / h;
    float most = fmaxf(quad_dot(before, before), quad_dot(gone, gone)), square = quad_dot(after, after);
    return square > most ? sqrtf(most / square) * after : after;
}

/// Velocities and centres follow what has been changed; the zones are emptied.
static void close_ways(const Guard *guard, float h) {
    TouchPlan *plan = guard->plan;
    DynamicsState *dynamics = guard->dynamics;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        uint32_t centre = shell_centre(guard->shell, c);
        Quad shift = {0}, way = {0}, place = quad_load(dynamics->position[centre]);
        for (int i = 0; i < 4; i++) {
            uint32_t v = guard->shell->cells[c][i];
            Quad corner = quad_load(dynamics->position[v]);
            shift += 0.25f * (corner - quad_load(plan->want[v]));
            way += 0.25f * (corner - quad_load(plan->start[v]));
        }
        shift[3] = way[3] = 0;
        if (place[3] == 0 || quad_dot(shift, shift) == 0) continue;
        quad_store(dynamics->position[centre], place + shift);
        quad_store(dynamics->velocity[centre],
                   shifted_velocity(quad_load(dynamics->velocity[centre]), shift, way, h));
    }
    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        Quad corner = quad_load(dynamics->position[v]), shift = corner - quad_load(plan->want[v]);
        Quad way = corner - quad_load(plan->start[v]);
        shift[3] = way[3] = 0;
        if (quad_dot(shift, shift) > 0)
            quad_store(dynamics->velocity[v], shifted_velocity(quad_load(dynamics->velocity[v]), shift, way, h));
    }
    for (uint32_t k = 0; k < plan->stopped_count; k++) plan->zone[plan->stopped[k]] = SHELL_NONE;
    plan->stopped_count = 0;
}

// ---- the step's end

/// Searches for the ways of this step.
static void search_again(Guard *guard, const State *state, Pool *pool, float h) {
    TouchPlan *plan = guard->plan;
    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        Quad start = quad_load(plan->start[v]), speed = (quad_load(guard->dynamics->position[v]) - start) / h;
        speed[3] = 0;
        quad_store(plan->place[v], start);
        quad_store(plan->speed[v], speed);
    }
    for (uint32_t c = 0; c < plan->cell_count; c++) plan->alive[c] = guard->cell_flags[c] & SINGE_ALIVE;
    plan->step = state->step;
    guard->time = h;
    touch_search(plan, guard->shell, pool);
}

static void measure(Guard *guard, Pool *pool) {
    pool_for(pool, (int)guard->plan->cell_count, 512, measure_range, guard);
}

/// Sweeps pairs from `first` on, and lists those that meet. Returns how many.
static uint32_t sweep(Guard *guard, Pool *pool, uint32_t first) {
    TouchPlan *plan = guard->plan;
    guard->first = first;
    plan->hit_count = 0;
    if (pool_sum(pool, (int)(plan->pair_count - first), sweep_range, guard, plan->partial) > 0)
        for (uint32_t k = first; k < plan->pair_count; k++)
            if (plan->pairs[k].hit < 2) plan->active[plan->hit_count++] = k;
    return plan->hit_count;
}

/// The same of the pairs of cells that have changed.
static uint32_t sweep_changed(Guard *guard, Pool *pool) {
    TouchPlan *plan = guard->plan;
    pool_for(pool, (int)plan->changed_count, 512, measure_changed, guard);
    uint32_t count = list_changed(plan);
    plan->hit_count = 0;
    if (pool_sum(pool, (int)count, sweep_active, guard, plan->partial) > 0)
        for (uint32_t k = 0; k < count; k++)
            if (plan->pairs[plan->active[k]].hit < 2) plan->active[plan->hit_count++] = plan->active[k];
    return plan->hit_count;
}

static uint32_t list_strayed(TouchPlan *plan) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->strayed[c]) plan->stray[count++] = c;
    return count;
}

/// Lists what cells that have left their boxes may have met; all anew where these are many. Returns the first pair that
/// is new.
static uint32_t follow_strayed(Guard *guard, const State *state, Pool *pool, float h) {
    TouchPlan *plan = guard->plan;
    uint32_t count = list_strayed(plan);
    if (count == 0) return plan->pair_count;
    bool all = count > plan->cell_count / STRAY_MOST || plan->edge <= 0;
    if (all) {
        search_again(guard, state, pool, h);
        measure(guard, pool);
        count = list_strayed(plan);
    }
    touch_search_strayed(plan, guard->shell, pool, count, (const float(*)[4])guard->dynamics->position);
    plan->restless = plan->step < state->step && count > plan->cell_count / STRAY_PART;
    return all ? 0 : plan->listed_count;
}

/// One look at all that may have met, or at what the last round has changed. Returns the number of pairs that have.
static uint32_t look(Guard *guard, const State *state, Pool *pool, float h, bool changed) {
    uint32_t hits;
    if (changed) {
        hits = sweep_changed(guard, pool);
    } else {
        measure(guard, pool);
        hits = sweep(guard, pool, 0);
    }
    return hits > 0 ? hits : sweep(guard, pool, follow_strayed(guard, state, pool, h));
}

void touch_guard(TouchPlan *plan, const Shell *shell, const State *state, Pool *pool, float h,
                 DynamicsState *dynamics) {
    double start = clock_seconds();
    Guard guard = {plan, shell, dynamics, state->ablate.cell_flags,
                   h * (float)(state->step - plan->step + 1), 0};
    bool stopped = false;
    if (plan->closed) mark_moved(&guard);
    for (int round = 0;; round++) {
        uint32_t hits = look(&guard, state, pool, h, stopped || plan->closed);
        if (hits == 0) break;
        if (round == ZONE_ROUNDS) {
            plan->counters.unresolved += hits;
            break;
        }
        if (round == 0) memcpy(plan->want, dynamics->position, plan->vertex_count * sizeof *plan->want);
        plan->counters.stops += hits;
        if (round < IMPACT_ROUNDS) {
            impact_all(&guard);
        } else {
            for (uint32_t k = 0; k < plan->hit_count; k++)
                zone_join(&guard, &plan->pairs[plan->active[k]], round - IMPACT_ROUNDS);
            zone_move(&guard);
        }
        stopped = true;
    }
    plan->pair_count = plan->listed_count;
    if (stopped) close_ways(&guard, h);
    memcpy(plan->end, dynamics->position, plan->vertex_count * sizeof *plan->end);
    plan->closed = true;
    plan->counters.seconds += clock_seconds() - start;
}

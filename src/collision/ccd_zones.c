// What is done where ways meet.
//
// An impact moves the two points that meet apart, each by what it weighs. Where many rounds of impacts have not parted
// all, the corners of both cells form a zone, with all zones that they touch, and go
//
//   x0 + u + a (x1 - x0 - u),   u the mean way of the zone by mass,
//
// with a the share of the way that was free: the zone keeps its momentum and loses what would have closed it. A zone
// that meets again halves its share, and has 0 from round ZONE_PATIENCE on, when it moves as one piece (the impact
// zones of Provot, 1997). Zones are only ever joined, and shares lessened, so the rounds end. Held corners go their own
// way.
#include "collision/ccd.h"
#include "collision/feature_distance.h"

#include <string.h>

/// Gaps by which an impact parts what meets.
enum { IMPACT_PART = 3 };
/// Rounds after which a zone moves as one piece.
enum { ZONE_PATIENCE = 4 };

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
        guard_mark_around(guard, v);
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
    guard_sweep_cells(guard, pair, &p, &q);
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

void guard_impacts(const Guard *guard) {
    TouchPlan *plan = guard->plan;
    guard_forget_changed(plan);
    for (uint32_t k = 0; k < plan->hit_count; k++) {
        const TouchPair *pair = &plan->pairs[plan->active[k]];
        impact(guard, pair);
        guard_mark_changed(guard, pair->a), guard_mark_changed(guard, pair->b);
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
    guard_forget_changed(plan);
    for (uint32_t k = 0; k < plan->stopped_count; k++) guard_mark_around(guard, plan->stopped[k]);
}

void guard_zones(const Guard *guard, int round) {
    const TouchPlan *plan = guard->plan;
    for (uint32_t k = 0; k < plan->hit_count; k++) zone_join(guard, &plan->pairs[plan->active[k]], round);
    zone_move(guard);
}

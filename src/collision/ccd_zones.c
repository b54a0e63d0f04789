// Resolves collisions.
//
// An impact moves the two colliding points apart, each according to its mass. If many rounds of impacts have not
// separated all pairs, the corners of both cells form a zone, merged with all zones that share a corner, and move to
//
//   x0 + u + a (x1 - x0 - u),   u the mean displacement of the zone by mass,
//
// with a the share of the displacement that was free: the zone keeps its momentum and loses the motion that would have
// closed the gap. A zone that collides again halves its share, and has 0 from round ZONE_PATIENCE on, when it moves as
// one piece (the impact zones of Provot, 1997). Zones are only ever joined, and shares only reduced, so the rounds end.
// Held corners keep their own displacement.
#include "common/real.h"
#include "collision/ccd.h"
#include "collision/feature_distance.h"

#include <string.h>

/// Gaps by which an impact separates colliding points.
enum { IMPACT_PART = 3 };
/// Rounds after which a zone moves as one piece.
enum { ZONE_PATIENCE = 4 };

// ---- impacts

/// Weights of a cell's corners that stand for its nodes.
static void zones_spread(float corner[4], int node, float weight) {
    for (int i = 0; i < 4; i++) corner[i] += node == i ? weight : node == 4 ? 0.25f * weight : 0;
}

/// Share of each corner in a shift of its point: by its weight and inverse mass, but no corner counts as lighter than a
/// quarter of the heaviest. Otherwise a light corner, far from the point, would be thrown far to move it. Returns the
/// point's own inverse mass.
static float impact_lever(const Ccd *ccd, uint32_t cell, const float w[4], float lever[4]) {
    const uint32_t *corner = ccd->shell->cells[cell];
    float min = INFINITY, inverse[4], own = 0, sum = 0;
    for (int i = 0; i < 4; i++) {
        inverse[i] = ccd->plan->start[corner[i]][3];
        own += w[i] * w[i] * inverse[i];
        if (w[i] != 0 && inverse[i] > 0) min = float_min(min, inverse[i]);
    }

    for (int i = 0; i < 4; i++) {
        inverse[i] = float_min(inverse[i], 4 * min);
        sum += w[i] * w[i] * inverse[i];
    }

    for (int i = 0; i < 4; i++) lever[i] = sum > 0 ? float_min(w[i] * inverse[i] / sum, 2) : 0;
    return own;
}

static Float4 impact_slip(const Ccd *ccd, const CollisionPair *pair, const float wa[4], const float wb[4],
                          const float (*x)[4]) {
    const uint32_t *a = ccd->shell->cells[pair->a], *b = ccd->shell->cells[pair->b];
    Float4 sum = {0};
    for (int i = 0; i < 4; i++) sum += wa[i] * float4_load(x[a[i]]) - wb[i] * float4_load(x[b[i]]);
    sum[3] = 0;
    return sum;
}

/// An impact without bounce, and with friction: at the end the points are as far apart as when they met, and a little
/// farther, so that reactions of other pairs do not make them collide again at once: otherwise there are eight times as
/// many rounds.
static void impact(const Ccd *ccd, const CollisionPair *pair) {
    Swept p, q;
    float wa[4] = {0}, wb[4] = {0};
    ccd_sweep_cells(ccd, pair, &p, &q);

    // weights of the corners at the points that collide, and the vector from that of b to that of a
    const bool turned = pair->kind == COLLISION_NODE_OF_B;
    const Swept *one = turned ? &q : &p, *two = turned ? &p : &q;
    float *w1 = turned ? wb : wa, *w2 = turned ? wa : wb;
    Float4 here[5], there[5], normal;
    for (int i = 0; i < 5; i++) {
        here[i] = one->position[i] + pair->hit * one->displacement[i];
        there[i] = two->position[i] + pair->hit * two->displacement[i];
    }

    if (pair->kind == COLLISION_EDGES) {
        const uint8_t *k = collision_edge[pair->first[0]], *l = collision_edge[pair->first[1]];
        float s, t;
        normal = feature_from_segment(here[k[0]], here[k[1]], there[l[0]], there[l[1]], &s, &t);
        zones_spread(w1, k[0], 1 - s);
        zones_spread(w1, k[1], s);
        zones_spread(w2, l[0], 1 - t);
        zones_spread(w2, l[1], t);
    } else {
        const uint8_t *k = collision_triangle[pair->first[1]];
        float weight[3];
        normal = feature_from_triangle(here[pair->first[0]], there[k[0]], there[k[1]], there[k[2]], weight);
        zones_spread(w1, pair->first[0], 1);
        for (int i = 0; i < 3; i++) zones_spread(w2, k[i], weight[i]);
        if (turned) normal = -normal;
    }

    float distance = sqrtf(float4_dot(normal, normal));
    if (!(distance > 0)) return;

    normal = normal / distance;
    Float4 end = impact_slip(ccd, pair, wa, wb, (const float(*)[4])ccd->dynamics->position);
    Float4 slip = end - impact_slip(ccd, pair, wa, wb, (const float(*)[4])ccd->plan->start);

    // after previous impacts have changed the displacements, these points are already farther apart than where they met
    float repulsion = float_min(distance, 2 * ccd->plan->gap) + IMPACT_PART * ccd->plan->gap - float4_dot(end, normal);
    if (repulsion <= 0) return;

    slip -= float4_dot(slip, normal) * normal;
    float length = sqrtf(float4_dot(slip, slip)), max = ccd->plan->def.friction * repulsion;
    Float4 shift = repulsion * normal - (length <= max ? 1 : max / length) * slip;

    // each point according to its mass
    float lever[2][4], a = impact_lever(ccd, pair->a, wa, lever[0]), b = impact_lever(ccd, pair->b, wb, lever[1]);
    for (int k = 0; a + b > 0 && k < 8; k++) {
        uint32_t v = ccd->shell->cells[k < 4 ? pair->a : pair->b][k & 3];
        float go = (k < 4 ? a : -b) / (a + b) * lever[k >> 2][k & 3], *x = ccd->dynamics->position[v];
        if (go == 0) continue;

        float4_store(x, float4_load(x) + go * shift);
        ccd_mark_around(ccd, v);
    }
}

void ccd_impacts(const Ccd *ccd) {
    CollisionPlan *plan = ccd->plan;
    ccd_forget_changed(plan);
    for (uint32_t k = 0; k < plan->hit_count; k++) {
        const CollisionPair *pair = &plan->pairs[plan->active[k]];
        impact(ccd, pair);
        ccd_mark_changed(ccd, pair->a);
        ccd_mark_changed(ccd, pair->b);
    }
}

// ---- zones

static uint32_t zone_root(CollisionPlan *plan, uint32_t v) {
    uint32_t *zone = plan->zone;
    while (zone[v] != v) v = zone[v] = zone[zone[v]];
    return v;
}

/// Puts a vertex that is in no zone into one of its own, with all of its displacement.
static void zone_begin(const Ccd *ccd, uint32_t v) {
    CollisionPlan *plan = ccd->plan;
    if (plan->zone[v] != SHELL_NONE) return;

    plan->zone[v] = v;
    plan->share[v] = 1;
    plan->stopped[plan->stopped_count++] = v;
    memcpy(plan->goal[v], ccd->dynamics->position[v], sizeof *plan->goal);
}

static void zones_move(const Ccd *ccd) {
    CollisionPlan *plan = ccd->plan;

    // mean displacements by mass; if there are held corners, only theirs count
    for (uint32_t k = 0; k < plan->stopped_count; k++) plan->drift[plan->stopped[k]] = (Float4){0};
    for (uint32_t k = 0; k < plan->stopped_count; k++) {
        uint32_t v = plan->stopped[k];
        float inverse = plan->start[v][3], mass = inverse > 0 ? 1 / inverse : 1e6f;
        Float4 displacement = float4_load(plan->goal[v]) - float4_load(plan->start[v]);
        displacement[3] = 1;
        plan->drift[zone_root(plan, v)] += mass * displacement;
    }

    // move the vertices, and mark the cells around them
    for (uint32_t k = 0; k < plan->stopped_count; k++) {
        uint32_t v = plan->stopped[k], root = zone_root(plan, v);
        if (plan->start[v][3] == 0) continue;

        Float4 drift = plan->drift[root] / plan->drift[root][3], start = float4_load(plan->start[v]);
        Float4 displacement = float4_load(plan->goal[v]) - start;
        Float4 end = start + drift + plan->share[root] * (displacement - drift);
        end[3] = start[3];
        float4_store(ccd->dynamics->position[v], end);
    }

    ccd_forget_changed(plan);
    for (uint32_t k = 0; k < plan->stopped_count; k++) ccd_mark_around(ccd, plan->stopped[k]);
}

void ccd_zones(const Ccd *ccd, int round) {
    CollisionPlan *plan = ccd->plan;

    // join the corners of colliding pairs, and reduce their share of the displacement
    for (uint32_t k = 0; k < plan->hit_count; k++) {
        const CollisionPair *pair = &plan->pairs[plan->active[k]];
        const uint32_t *a = ccd->shell->cells[pair->a], *b = ccd->shell->cells[pair->b];
        uint32_t root = SHELL_NONE;
        float share = 1;
        for (int i = 0; i < 8; i++) {
            uint32_t v = i < 4 ? a[i] : b[i - 4];
            zone_begin(ccd, v);

            uint32_t other = zone_root(plan, v);
            share = float_min(share, plan->share[other]);
            if (root == SHELL_NONE) root = other;

            if (other < root) {
                plan->zone[root] = other;
                root = other;
            } else plan->zone[other] = root;
        }

        // in the first round the share is the free one; later the displacements of the zone itself have changed
        float less = round == 0 ? 0.9f * pair->hit : round < ZONE_PATIENCE ? 0.5f * share : 0;
        plan->share[root] = float_min(share, less);
    }

    zones_move(ccd);
}

void ccd_halt(const Ccd *ccd) {
    CollisionPlan *plan = ccd->plan;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        for (int i = 0; i < 4 && ccd_is_alive(ccd, c); i++) zone_begin(ccd, ccd->shell->cells[c][i]);

    // one zone for all
    for (uint32_t k = 0; k < plan->stopped_count; k++) plan->zone[plan->stopped[k]] = plan->stopped[0];
    if (plan->stopped_count > 0) plan->share[plan->stopped[0]] = 0;
    zones_move(ccd);
}

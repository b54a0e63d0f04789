// Which cells collide on their displacements.
//
// Every corner has moved from x0, where the step began, to x1. A pair of cells that were at least d apart at x0 and
// have moved since by less, relative to each other, cannot have collided:
//
//   |mean displacement of a - mean displacement of b| + deviation of a + deviation of b < d
//
// Connected cells (that share a side or a corner) are free if their normals, or a plane between them, show that they do
// not cross at the end of the step (feature_distance.c). The other pairs are swept, feature by feature.
#include "collision/ccd.h"
#include "collision/feature_distance.h"

#include <string.h>

// ---- sweeping a pair

static void sweep_nodes(const Ccd *ccd, uint32_t c, Float4 origin, Float4 mean, Swept *out) {
    const uint32_t *corner = ccd->shell->cells[c];
    Float4 end[5];
    collision_nodes(corner, (const float(*)[4])ccd->plan->start, origin, out->position);
    collision_nodes(corner, (const float(*)[4])ccd->dynamics->position, origin + mean, end);

    for (int i = 0; i < 5; i++) out->displacement[i] = end[i] - out->position[i];
}

/// Boxes around what the nodes pass over.
static void sweep_boxes(Swept *cell) {
    for (int i = 0; i < 5; i++) {
        const Float4 end = cell->position[i] + cell->displacement[i];
        cell->low[i] = float4_min(cell->position[i], end);
        cell->high[i] = float4_max(cell->position[i], end);
    }

    const FourVectors low = four_of(cell->low), high = four_of(cell->high);
    cell->triangles = narrow_triangles(low, high, cell->low[4], cell->high[4]);
    cell->sides = narrow_sides(low, high);
    cell->spokes = narrow_spokes(low, high, cell->low[4], cell->high[4]);
}

static void note_hit(CollisionPair *pair, float hit, int kind, int i, int j) {
    if (!(hit < pair->hit)) return;
    pair->hit = hit;
    pair->kind = (uint8_t)kind;
    pair->first[0] = (uint8_t)i;
    pair->first[1] = (uint8_t)j;
}

void ccd_sweep_cells(const Ccd *ccd, const CollisionPair *pair, Swept *p, Swept *q) {
    uint32_t first = ccd->shell->cells[pair->a][0];
    Float4 origin = float4_load(ccd->plan->start[first]);
    Float4 mean = float4_load(ccd->dynamics->position[first]) - origin;
    sweep_nodes(ccd, pair->a, origin, mean, p);
    sweep_nodes(ccd, pair->b, origin, mean, q);
}

/// Nodes of p that cell c owns against triangles of q that do not contain them; bits of same[i] are the corners of q
/// that are corner i of p. Returns how many are swept.
static int sweep_all_nodes(const Ccd *ccd, CollisionPair *pair, uint32_t c, const Swept *p, const Swept *q,
                           const unsigned same[4], int kind, Float4 *plane) {
    int count = 0;
    for (int i = 0; i < 5; i++) {
        if (!collision_owns_node(ccd->plan, c, i)) continue;

        // within one cell, the centroid is in all triangles
        unsigned meet = i < 4 ? 15 & ~narrow_around(same[i]) : pair->a == pair->b ? 0 : 15;
        if (meet) meet &= four_meet(&q->triangles, p->low[i] - ccd->plan->gap, p->high[i] + ccd->plan->gap);
        for (; meet; meet &= meet - 1) {
            int j = __builtin_ctz(meet);
            const uint8_t *k = collision_triangle[j];
            FeatureSweep sweep = {
                {p->position[i], q->position[k[0]], q->position[k[1]], q->position[k[2]]},
                {p->displacement[i], q->displacement[k[0]], q->displacement[k[1]], q->displacement[k[2]]},
                false,
                plane};
            note_hit(pair, feature_sweep(&sweep, ccd->plan->gap, ccd->plan->noise), kind, i, j);
            count++;
        }
    }

    return count;
}

/// Finds the share of the step's displacement after which two cells collide, and the features that do. Returns how many
/// pairs of features it has swept.
static int sweep_pair(const Ccd *ccd, CollisionPair *pair) {
    const uint32_t *a = ccd->shell->cells[pair->a], *b = ccd->shell->cells[pair->b];
    unsigned of_b[4], of_a[4];
    int count = 0;
    Float4 plane = {0}; // that keeps the last features apart is often one for the next
    Swept p, q;
    ccd_sweep_cells(ccd, pair, &p, &q);
    collision_same(a, b, of_b);
    collision_same(b, a, of_a);

    // most pairs that are swept pass each other: a plane shows that for all of their features at once
    if (!(of_b[0] | of_b[1] | of_b[2] | of_b[3])) {
        FeatureHulls hulls = {{four_of(p.position)}, {four_of(q.position)}};
        hulls.a[1] = four_plus(hulls.a[0], four_of(p.displacement));
        hulls.b[1] = four_plus(hulls.b[0], four_of(q.displacement));

        const float margin = 2 * ccd->plan->gap + ccd->plan->noise;
        const Float4 normal[2] = {float4_cross(p.position[2] - p.position[0], p.position[3] - p.position[1]),
                                  float4_cross(q.position[2] - q.position[0], q.position[3] - q.position[1])};
        for (int i = 0; i < 2; i++)
            if (feature_is_apart_along(&hulls, normal[i], margin)) return 0; // layers that lie on each other
        if (feature_is_apart(&hulls, margin, NULL)) return 0;
    }

    sweep_boxes(&p), sweep_boxes(&q);
    count += sweep_all_nodes(ccd, pair, pair->a, &p, &q, of_b, COLLISION_NODE_OF_A, &plane);
    if (pair->a != pair->b) count += sweep_all_nodes(ccd, pair, pair->b, &q, &p, of_a, COLLISION_NODE_OF_B, &plane);

    // edges against edges
    const CollisionPlan *plan = ccd->plan;
    for (int i = 0; i < 8; i++) {
        if (!collision_owns_edge(plan, pair->a, i)) continue;

        const uint8_t *k = collision_edge[i];
        unsigned corners = of_b[k[0]] | (k[1] < 4 ? of_b[k[1]] : 0);
        Float4 low = float4_min(p.low[k[0]], p.low[k[1]]) - plan->gap;
        Float4 high = float4_max(p.high[k[0]], p.high[k[1]]) + plan->gap;
        unsigned sides = four_meet(&q.sides, low, high) & plan->owned[pair->b] >> 4 & ~narrow_around(corners);
        unsigned spokes = four_meet(&q.spokes, low, high) & ~corners;
        if (pair->a == pair->b) { // each pair once
            sides &= 14u << i;
            spokes = i < 4 ? spokes : 0;
        }

        for (unsigned meet = sides | spokes << 4; meet; meet &= meet - 1) {
            int j = __builtin_ctz(meet);
            const uint8_t *l = collision_edge[j];
            FeatureSweep sweep = {
                {p.position[k[0]], p.position[k[1]], q.position[l[0]], q.position[l[1]]},
                {p.displacement[k[0]], p.displacement[k[1]], q.displacement[l[0]], q.displacement[l[1]]},
                true,
                &plane};
            note_hit(pair, feature_sweep(&sweep, plan->gap, plan->noise), COLLISION_EDGES, i, j);
            count++;
        }
    }

    return count;
}

/// Whether a cell turns or stretches by so much of its size that what is true of it at both ends of the step need not be
/// so in between: a side may pass through the cell next to its own, and leave it again.
static bool turns_far(const CollisionPlan *plan, uint32_t cell) {
    return plan->motion[cell][COLLISION_DISPLACEMENT][3] > 0.5f * plan->rest[cell][3];
}

/// Bits of those of four pairs that are free: by their distance or, if connected, by their normals (proof in
/// feature_distance.c).
static unsigned four_are_free(const Ccd *ccd, const uint32_t number[4]) {
    const CollisionPlan *plan = ccd->plan;
    CollisionFourPairs four;
    collision_four_pairs(plan, number, &four);

    // so far apart that the sweep, which stops a little before the gap, would not stop either
    Float4Mask separation =
        (four.distance > 2 * plan->gap) &
        (collision_four_differ(&four, COLLISION_DISPLACEMENT) + plan->noise < 0.9f * (four.distance - plan->gap));
    unsigned free = float4_bits(separation), bridged = four.bridged & ~free;
    if (!bridged) return free;

    Float4Mask sides = collision_four_within(&four, four.a, four.b, FEATURE_CONE_SIDE);
    Float4Mask corners = collision_four_within(&four, four.a, four.bridge, FEATURE_CONE_CORNER) &
                         collision_four_within(&four, four.b, four.bridge, FEATURE_CONE_CORNER);

    for (unsigned i = 0; i < 4; i++) {
        if (!(bridged >> i & 1) || !ccd_is_alive(ccd, four.bridge[i])) continue;
        if (four.a[i] != four.b[i]) {
            const bool flat = four.bridge[i] == four.a[i] ? sides[i] != 0 : corners[i] != 0;
            free |= (unsigned)(flat && !turns_far(plan, four.a[i]) && !turns_far(plan, four.b[i])) << i;
            continue;
        }

        // a cell has not passed through itself if it is unfolded and in shape at the end of the step, and its corners
        // have moved relative to each other by less than an eighth of its width. An unfolded cell may have passed
        // through itself during the step: then it is on the wrong side of a cell that shares two sides with it, though
        // it met no feature of that cell
        const uint32_t cell = four.a[i];
        const Float4 *motion = plan->motion[cell];
        const float(*x)[4] = (const float(*)[4])ccd->dynamics->position;
        const uint32_t *corner = ccd->shell->cells[cell];
        if (!(motion[COLLISION_NORMAL][3] < FEATURE_CONE)) continue;

        Float4 one = float4_flat(float4_load(x[corner[2]]) - float4_load(x[corner[0]]));
        Float4 two = float4_flat(float4_load(x[corner[3]]) - float4_load(x[corner[1]])), area = float4_cross(one, two);
        float displacement = 8 * motion[COLLISION_DISPLACEMENT][3];
        bool still =
            displacement * displacement * (float4_dot(one, one) + float4_dot(two, two)) < float4_dot(area, area);
        free |= (unsigned)still << i;
    }

    return free;
}

/// What a pair that collides adds to the work in a sum of both, which is exact: the work of a chunk is less.
enum { LOOK_HIT = 1 << 26, LOOK_WORK_MAX = 1 + 2 * 5 * 4 + 8 * 8 };
_Static_assert((long long)LOOK_WORK_MAX *COLLISION_CHUNK < LOOK_HIT, "sums are exact");

typedef struct Look {
    const Ccd *ccd;
    uint32_t first;         ///< pair, or its place in `active`
    const uint32_t *active; ///< pairs, or NULL for all from the first on
} Look;

/// Checks pairs, four at a time, and lists those that collide from the range's own place in plan->active on, which no
/// later pair is read from. Returns the work, a unit for each pair and for each two features swept, and LOOK_HIT for each
/// pair that collides.
static double look_range(void *task, int begin, int end) {
    const Look *look = task;
    const Ccd *ccd = look->ccd;
    CollisionPair *pairs = ccd->plan->pairs;
    uint32_t *collides = ccd->plan->active + look->first + begin;
    int work = end - begin, hits = 0;
    for (int k = begin; k < end; k += 4) {
        uint32_t number[4], count = end - k < 4 ? (uint32_t)(end - k) : 4;
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t at = look->first + (uint32_t)k + (i < count ? i : 0);
            number[i] = look->active ? look->active[at] : at;
        }

        // those of the four that are not free
        for (unsigned left = ((1u << count) - 1) & ~four_are_free(ccd, number); left; left &= left - 1) {
            const uint32_t at = number[__builtin_ctz(left)];
            CollisionPair *pair = &pairs[at];
            if (!ccd_is_alive(ccd, pair->a) || !ccd_is_alive(ccd, pair->b)) continue;
            if (initial_is_crossing(ccd->plan, pair)) continue;

            // where a plane separates two connected cells at both ends of the step, and has not turned over, they have
            // not passed through each other around what they share
            const uint32_t *a = ccd->shell->cells[pair->a], *b = ccd->shell->cells[pair->b];
            const float(*positions[2])[4] = {(const float(*)[4])ccd->plan->start,
                                             (const float(*)[4])ccd->dynamics->position};
            unsigned same[4];
            collision_same(a, b, same);
            const unsigned shared[2] = {(same[0] != 0) | (same[1] != 0) << 1 | (same[2] != 0) << 2 |
                                            (same[3] != 0) << 3,
                                        same[0] | same[1] | same[2] | same[3]};

            bool parted =
                shared[0] && pair->a != pair->b && !turns_far(ccd->plan, pair->a) && !turns_far(ccd->plan, pair->b);
            Float4 p[5], q[5], normal[2] = {{0}, {0}};
            for (int t = 0; t < 2 && parted; t++) {
                Float4 origin = float4_load(positions[t][a[0]]);
                collision_nodes(a, positions[t], origin, p);
                collision_nodes(b, positions[t], origin, q);
                parted = feature_is_separated(p, q, shared, ccd->plan->gap, &normal[t]);
            }

            if (parted && float4_dot(normal[0], normal[1]) > 0) continue;

            pair->hit = 2;
            work += sweep_pair(ccd, pair);
            if (pair->hit < 2) collides[hits++] = at;
        }
    }

    return (double)work + (double)LOOK_HIT * hits;
}

/// Checks `count` pairs, and lists those that collide in plan->active, which `look` may read from. Returns how many;
/// none if the work of the step has reached its bound meanwhile.
static uint32_t look_all(Look look, Pool *pool, uint32_t count) {
    CollisionPlan *plan = look.ccd->plan;
    const uint32_t begin = look.first;

    plan->hit_count = 0;
    for (uint32_t done = 0; done < count; done += COLLISION_CHUNK) {
        const uint32_t some = count - done < COLLISION_CHUNK ? count - done : COLLISION_CHUNK;
        look.first = begin + done;
        const uint64_t sum = (uint64_t)pool_sum(pool, (int)some, look_range, &look, plan->partial);
        plan->work += sum % LOOK_HIT;
        if (ccd_is_spent(plan)) return 0;

        // join the lists of the blocks
        for (uint32_t block = 0; block < (uint32_t)pool_blocks((int)some); block++) {
            const uint32_t hits = (uint32_t)((uint64_t)plan->partial[block] / LOOK_HIT);
            memmove(plan->active + plan->hit_count, plan->active + look.first + block * POOL_BLOCK,
                    hits * sizeof *plan->active);
            plan->hit_count += hits;
        }
    }

    return plan->hit_count;
}

uint32_t ccd_meet(const Ccd *ccd, Pool *pool, uint32_t first) {
    return look_all((Look){ccd, first, NULL}, pool, ccd->plan->pair_count - first);
}

uint32_t ccd_meet_active(const Ccd *ccd, Pool *pool, uint32_t count) {
    return look_all((Look){ccd, 0, ccd->plan->active}, pool, count);
}

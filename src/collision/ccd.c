// Continuous collision detection (CCD) at the end of a step: no displacement passes through another cell.
//
// Every corner has moved from x0, where the step began, to x1. Cells that meet on these displacements (ccd_pairs.c) are
// moved differently (ccd_zones.c). As this may put them in the path of other cells, it is repeated for the cells that
// have changed.
//
// The work of a step has a bound, in counts, so that it is the same on every machine: sheets that pass each other at many
// cells a step, or crowds beyond all reason, would take minutes for one. A step that reaches it halts: all cells keep
// the places that they had as it began, up to one displacement in common. So they do not cross in such a step either, but
// where held corners, which go where their pins take them, move differently.
//
// A corner that has left the box that the search gave its cell may have met a cell that the search did not list: then
// the search is repeated for this step's own displacements.
#include "common/assertion.h"
#include "common/clock.h"
#include "common/error.h"
#include "common/real.h"
#include "collision/ccd.h"
#include "collision/feature_distance.h"

#include <string.h>

/// Rounds after which impacts give way to zones, and after which zones leave the rest as it is.
enum { IMPACT_ROUNDS = 64, ZONE_ROUNDS = 64 };

/// Impacts give way to zones earlier if their rounds have checked this many times the number of all pairs: further
/// impacts do not separate a crowd in which each impact makes others, such as a hundred sheets around one line.
enum { IMPACT_LOOKS = 4 };

/// The fraction of all cells that may be outside their boxes before all are searched again, and the same in a crowd, where
/// that costs more; and the fraction from which on the next step begins with a search.
enum { OUTSIDE_MAX = 8, OUTSIDE_CROWD = 3, OUTSIDE_PART = 32 };

// ---- how cells have moved

static void measure_range(void *task, int begin, int end) {
    const Ccd *ccd = task;
    for (int k = begin; k < end; k++) {
        const uint32_t c = ccd->changed ? ccd->plan->changed_list[k] : (uint32_t)k;
        if (!ccd_is_alive(ccd, c)) {
            ccd->plan->is_outside[c] = 0;
            continue;
        }

        CollisionPlan *plan = ccd->plan;
        const uint32_t *corner = ccd->shell->cells[c];
        const float(*x)[4] = (const float(*)[4])ccd->dynamics->position;
        Float4 node[5], outside[4];

        for (int i = 0; i < 4; i++) {
            Float4 foreseen = float4_load(plan->position[corner[i]]) + ccd->time * float4_load(plan->speed[corner[i]]);
            outside[i] = float4_load(x[corner[i]]) - foreseen;
        }

        FourVectors astray = four_of(outside);
        collision_nodes(corner, x, float4_load(x[corner[0]]), node);
        plan->motion[c][COLLISION_DISPLACEMENT] = collision_displacement(plan, corner, x);
        plan->motion[c][COLLISION_NORMAL] = feature_normals(node);
        plan->is_outside[c] = float4_bits(four_dot(astray, astray) < 0.25f * plan->slack * plan->slack) != 15;
    }
}

/// Measures all cells, or those that have changed.
static void ccd_measure(Ccd *ccd, Pool *pool, bool changed) {
    ccd->changed = changed;
    pool_for(pool, (int)(changed ? ccd->plan->changed_count : ccd->plan->cell_count), 512, measure_range, ccd);
}

// ---- cells that the last round has changed

void ccd_forget_changed(CollisionPlan *plan) {
    for (uint32_t k = 0; k < plan->changed_count; k++) plan->changed[plan->changed_list[k]] = 0;
    plan->changed_count = 0;
}

void ccd_mark_changed(const Ccd *ccd, uint32_t cell) {
    CollisionPlan *plan = ccd->plan;
    if (plan->changed[cell] || !ccd_is_alive(ccd, cell)) return;

    plan->changed[cell] = 1;
    plan->changed_list[plan->changed_count++] = cell;
}

void ccd_mark_around(const Ccd *ccd, uint32_t v) {
    const Shell *shell = ccd->shell;
    for (uint32_t f = shell->fan_first[v]; f < shell->fan_first[v + 1]; f++) ccd_mark_changed(ccd, shell->fan[f]);
}

/// Lists pair k of cell c after `count` others, unless its other cell lists it: the pair of two cells that have changed
/// counts once.
static inline uint32_t list_pair(CollisionPlan *plan, uint32_t c, uint32_t k, uint32_t count) {
    const CollisionPair *pair = &plan->pairs[k];
    const uint32_t other = pair->a == c ? pair->b : pair->a;
    if (plan->changed[other] && other < c) return count;
    plan->active[count] = k;
    return count + 1;
}

/// Lists the pairs of cells that have changed. Returns how many.
static uint32_t list_changed(CollisionPlan *plan) {
    uint32_t *first = plan->around_first, count = 0;

    // sort the search's pairs, which lie in the order of their first cells, by their second ones, once for each search
    if (plan->around_search != plan->counters.searches) {
        plan->around_search = plan->counters.searches;
        memset(first, 0, ((size_t)plan->cell_count + 2) * sizeof *first);
        for (uint32_t k = 0; k < plan->listed_count; k++) first[plan->pairs[k].b + 2]++;
        for (uint32_t c = 0; c < plan->cell_count; c++) first[c + 2] += first[c + 1];
        for (uint32_t k = 0; k < plan->listed_count; k++) plan->around[first[plan->pairs[k].b + 1]++] = k;
    }

    // those of cells that have changed, in the list's order: a cell's pair with itself is the last
    for (uint32_t l = 0; l < plan->changed_count; l++) {
        const uint32_t c = plan->changed_list[l], end = first[c + 1];
        uint32_t e = first[c];
        for (; e < end && plan->pairs[plan->around[e]].a != c; e++) count = list_pair(plan, c, plan->around[e], count);
        for (uint32_t k = plan->pair_first[c]; k < plan->pair_first[c + 1]; k++) count = list_pair(plan, c, k, count);
        for (; e < end; e++) count = list_pair(plan, c, plan->around[e], count);
    }

    for (uint32_t k = plan->listed_count; k < plan->pair_count; k++)
        if (plan->changed[plan->pairs[k].a] | plan->changed[plan->pairs[k].b]) plan->active[count++] = k;
    return count;
}

// ---- the step's end

static uint32_t list_out_of_bounds(CollisionPlan *plan) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->is_outside[c]) plan->outside[count++] = c;
    return count;
}

/// Checks all pairs that may have met, or those that the last round has changed; *hits is the number that have.
static SingeResult ccd_look(Ccd *ccd, const StateInput *state, Pool *pool, float h, bool changed, uint32_t *hits) {
    uint32_t first;
    if (changed) {
        ccd_measure(ccd, pool, true);
        uint32_t count = list_changed(ccd->plan);
        ccd->looked += count;
        *hits = ccd_meet_active(ccd, pool, count);
    } else {
        ccd_measure(ccd, pool, false);
        *hits = ccd_meet(ccd, pool, 0);
    }

    if (*hits > 0 || ccd_is_spent(ccd->plan)) return SINGE_OK;

    // pairs that cells outside their boxes may have met; if these are many, all are searched again
    CollisionPlan *plan = ccd->plan;
    uint32_t count = list_out_of_bounds(plan);
    if (count == 0) return SINGE_OK;

    const uint32_t max = plan->cell_count / (collision_is_crowded(plan) ? OUTSIDE_CROWD : OUTSIDE_MAX);
    const bool all = count > max || plan->edge <= 0;
    if (all) {
        for (uint32_t v = 0; v < plan->vertex_count; v++) {
            Float4 start = float4_load(plan->start[v]), speed = (float4_load(ccd->dynamics->position[v]) - start) / h;
            speed[3] = 0;
            float4_store(plan->position[v], start);
            float4_store(plan->speed[v], speed);
        }

        for (uint32_t c = 0; c < plan->cell_count; c++) plan->alive[c] = ccd->cell_flags[c] & SINGE_ALIVE;
        collision_search_again(plan, state->step);
        ccd->time = h;
        TRY(broad_search(ccd->memory, plan, ccd->shell, pool));
        plan->work += plan->pair_count;
        ccd_measure(ccd, pool, false);
        count = list_out_of_bounds(plan);
    }

    TRY(broad_search_outside(ccd->memory, plan, ccd->shell, pool, count, (const float(*)[4])ccd->dynamics->position));
    plan->restless = plan->step < state->step && count > plan->cell_count / OUTSIDE_PART;
    first = all ? 0 : plan->listed_count;
    *hits = ccd_meet(ccd, pool, first);
    return SINGE_OK;
}

/// A velocity after a shift at the step's end: changed by the shift, but not beyond the larger of the previous velocity
/// and the step's displacement over h. The velocity contains all of the change in the last substep, the displacement
/// only a small part of it.
static Float4 shifted_velocity(Float4 before, Float4 shift, Float4 displacement, float h) {
    Float4 after = before + shift / h, gone = displacement / h;
    float max = float_max(float4_dot(before, before), float4_dot(gone, gone)), square = float4_dot(after, after);
    return square > max ? sqrtf(max / square) * after : after;
}

/// Velocities and centres follow the changed positions. A step that halts leaves what it has moved with the velocities of
/// its displacements: what would have been too fast for it is too fast for the next one as well.
static void close_trajectories(const Ccd *ccd, float h, bool halted) {
    CollisionPlan *plan = ccd->plan;
    DynamicsState *dynamics = ccd->dynamics;

    // centres follow the mean shift of their corners
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        uint32_t centre = shell_centre(ccd->shell, c);
        Float4 shift = {0}, displacement = {0}, position = float4_load(dynamics->position[centre]);
        for (int i = 0; i < 4; i++) {
            uint32_t v = ccd->shell->cells[c][i];
            Float4 corner = float4_load(dynamics->position[v]);
            shift += 0.25f * (corner - float4_load(plan->want[v]));
            displacement += 0.25f * (corner - float4_load(plan->start[v]));
        }

        shift[3] = displacement[3] = 0;
        if (position[3] == 0 || float4_dot(shift, shift) == 0) continue;
        float4_store(dynamics->position[centre], position + shift);
        const Float4 before = float4_load(dynamics->velocity[centre]);
        float4_store(dynamics->velocity[centre],
                     halted ? displacement / h : shifted_velocity(before, shift, displacement, h));
    }

    // velocities of the corners
    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        Float4 corner = float4_load(dynamics->position[v]), shift = corner - float4_load(plan->want[v]);
        Float4 displacement = corner - float4_load(plan->start[v]);
        shift[3] = displacement[3] = 0;
        if (float4_dot(shift, shift) == 0) continue;
        const Float4 before = float4_load(dynamics->velocity[v]);
        float4_store(dynamics->velocity[v],
                     halted ? displacement / h : shifted_velocity(before, shift, displacement, h));
    }
}

static SingeResult close_step(Memory *memory, CollisionPlan *plan, const Shell *shell, const StateInput *state,
                              Pool *pool, float h, DynamicsState *dynamics) {
    Ccd ccd = {memory, plan, shell, dynamics, state->ablate->cell_flags, h * (float)(state->step - plan->step + 1),
               0,      false};
    bool stopped = false, halted = false;
    SINGE_ASSERT(plan->stopped_count == 0); // ccd_apply has emptied the zones of the last run

    // where CCD has run in this step before, only what has moved since counts
    if (plan->closed) ccd_forget_changed(plan);
    for (uint32_t v = 0; v < plan->vertex_count && plan->closed; v++) {
        Float4Mask moved = float4_load(dynamics->position[v]) != float4_load(plan->end[v]);
        if (float4_bits(moved) & 7) ccd_mark_around(&ccd, v);
    }

    // stop colliding cells until there are none: impacts one by one, then zones
    for (int impacts = 0, zones = 0;;) {
        uint32_t hits;
        if (pool_cancelled(pool)) return SINGE_ERROR_CANCELLED;
        TRY(ccd_look(&ccd, state, pool, h, stopped || plan->closed, &hits));

        const bool spent = ccd_is_spent(plan);
        if (hits == 0 && !spent) break;
        if (!spent && zones == ZONE_ROUNDS) {
            plan->counters.unresolved += hits;
            break;
        }

        if (!stopped) memcpy(plan->want, dynamics->position, plan->vertex_count * sizeof *plan->want);
        plan->counters.stops += hits;
        plan->counters.rounds++;
        stopped = true;

        if (spent) {
            plan->counters.halts++;
            halted = true;
            ccd_halt(&ccd);
            ccd_measure(&ccd, pool, false);
            break;
        }

        bool crowd = ccd.looked > (uint64_t)IMPACT_LOOKS * plan->pair_count;
        if (zones > 0 || impacts == IMPACT_ROUNDS || crowd) {
            ccd_zones(&ccd, zones++);
        } else {
            ccd_impacts(&ccd);
            impacts++;
        }
    }

    // remember where the step has ended, for the next one
    plan->counters.looks += ccd.looked;
    if (stopped) close_trajectories(&ccd, h, halted);
    memcpy(plan->end, dynamics->position, plan->vertex_count * sizeof *plan->end);
    plan->closed = true;
    return SINGE_OK;
}

// ---- parts

/// A step has parts if the last one has moved cells by PARTS_FROM and more, as many as leave PARTS_MOTION for each, up to
/// COLLISION_PARTS. The numbers are the mean, over the cells of the block where that is largest, of how far a corner has
/// moved relative to the cell's mean, over its distance from the centroid. It stays below .05 in folds and heaps, and is
/// .3 to 1 where 15 m/s of wind shake cells of 2 mm 240 times a second: then layers pass through dozens of others in a
/// step, and what CCD makes of that is far too long. A mean, because a few cells at a burnt edge that tremble must not
/// decide for all: substeps of another length leave another strain, so that each change of the parts shakes the whole
/// sheet. Displacements and not velocities, which a strained sheet has from its last substep: it trembles on the spot, and
/// the shorter its substeps are, the faster.
#define PARTS_FROM 0.15f
#define PARTS_MOTION 0.075f

/// Sum of cells' relative motions in the step, or the part of it.
static double motion_sum(void *task, int begin, int end) {
    const Ccd *ccd = task;
    const CollisionPlan *plan = ccd->plan;
    double sum = 0;
    for (int c = begin; c < end; c++)
        if (ccd_is_alive(ccd, (uint32_t)c))
            sum += (double)(plan->motion[c][COLLISION_DISPLACEMENT][3] / plan->rest[c][3]);
    return sum;
}

SingeResult ccd_apply(Memory *memory, CollisionPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                      float h, DynamicsState *dynamics) {
    double start = clock_seconds();
    const uint64_t halts = plan->counters.halts;
    SingeResult result = close_step(memory, plan, shell, state, pool, h, dynamics);

    // how this step has moved the cells of the block where that is most
    Ccd ccd = {.plan = plan, .cell_flags = state->ablate->cell_flags};
    double largest = 0;
    pool_sum(pool, (int)plan->cell_count, motion_sum, &ccd, plan->partial);
    for (int block = 0; block < pool_blocks((int)plan->cell_count); block++)
        largest = double_max(largest, plan->partial[block]);
    const float cells = plan->cell_count < POOL_BLOCK ? (float)plan->cell_count : POOL_BLOCK;
    const float motion = plan->time_step / plan->h * (float)largest / cells;

    // the next one has half as many parts as this one at least, and four times as many if this one has halted
    const uint32_t parts = (uint32_t)(plan->time_step / plan->h + 0.5f), max = COLLISION_PARTS;
    uint32_t next = plan->counters.halts > halts ? 4 * parts : parts / 2, asked = 1;
    if (motion >= PARTS_FROM) asked = motion < max * PARTS_MOTION ? (uint32_t)ceilf(motion / PARTS_MOTION) : max;
    if (asked > next) next = asked;
    if (next > 1 || parts > 1) plan->restless = next < max ? 2 * next : 2 * max;

    plan->pair_count = plan->listed_count;
    for (uint32_t k = 0; k < plan->stopped_count; k++) plan->zone[plan->stopped[k]] = SHELL_NONE;
    plan->stopped_count = 0;
    if (result) collision_plan_forget(plan);
    plan->counters.stop_seconds += clock_seconds() - start;
    return result;
}

bool ccd_is_busy(const CollisionPlan *plan) { return plan->work > plan->work_max / 4; }

// No way through: continuous detection at the end of a step.
//
// Every corner has gone from x0, where the step began, to x1. What meets on these ways (ccd_pairs.c) goes otherwise
// (ccd_zones.c). As other cells may then be in the way, this is repeated with what has changed.
//
// A corner that has left the box that the search gave its cell may have met what the search did not list: then the
// search is repeated for this step's own ways.
#include "common/clock.h"
#include "common/error.h"
#include "collision/ccd.h"
#include "collision/feature_distance.h"

#include <string.h>

/// Rounds after which impacts give way to zones, and zones to what is.
enum { IMPACT_ROUNDS = 64, ZONE_ROUNDS = 64 };

/// Impacts give way to zones earlier where rounds have looked at this many times all pairs: a crowd in which each
/// impact makes others, such as a hundred sheets around one line, is not parted by more of them.
enum { IMPACT_LOOKS = 4 };

/// The part of all cells that may be outside their boxes before all are searched again; and that from which on the next
/// step begins with a search.
enum { STRAY_MOST = 8, STRAY_PART = 32 };

// ---- how cells have moved

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
        if (guard_is_alive(guard, (uint32_t)c)) measure_cell(guard, (uint32_t)c);
        else guard->plan->strayed[c] = 0;
    }
}

static void measure_changed(void *task, int begin, int end) {
    const Guard *guard = task;
    for (int k = begin; k < end; k++) measure_cell(guard, guard->plan->changed_list[k]);
}

// ---- what the last round has changed

void guard_forget_changed(TouchPlan *plan) {
    for (uint32_t k = 0; k < plan->changed_count; k++) plan->changed[plan->changed_list[k]] = 0;
    plan->changed_count = 0;
}

void guard_mark_changed(const Guard *guard, uint32_t cell) {
    TouchPlan *plan = guard->plan;
    if (plan->changed[cell] || !guard_is_alive(guard, cell)) return;
    plan->changed[cell] = 1;
    plan->changed_list[plan->changed_count++] = cell;
}

void guard_mark_around(const Guard *guard, uint32_t v) {
    const Shell *shell = guard->shell;
    for (uint32_t f = shell->fan_first[v]; f < shell->fan_first[v + 1]; f++) guard_mark_changed(guard, shell->fan[f]);
}

/// Marks the cells that have been moved since the guard was here before in this step.
static void mark_moved(const Guard *guard) {
    const TouchPlan *plan = guard->plan;
    guard_forget_changed(guard->plan);
    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        QuadMask moved = quad_load(guard->dynamics->position[v]) != quad_load(plan->end[v]);
        if (quad_bits(moved) & 7) guard_mark_around(guard, v);
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

// ---- the step's end

/// Searches for the ways of this step.
static SingeResult search_again(Guard *guard, const State *state, Pool *pool, float h) {
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
    return touch_search(plan, guard->shell, pool);
}

static void measure(Guard *guard, Pool *pool) {
    pool_for(pool, (int)guard->plan->cell_count, 512, measure_range, guard);
}

/// Looks at the pairs of cells that the last round has changed. Returns how many meet.
static uint32_t meet_changed(Guard *guard, Pool *pool) {
    pool_for(pool, (int)guard->plan->changed_count, 512, measure_changed, guard);
    uint32_t count = list_changed(guard->plan);
    guard->looked += count;
    return guard_meet_active(guard, pool, count);
}

static uint32_t list_strayed(TouchPlan *plan) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->strayed[c]) plan->stray[count++] = c;
    return count;
}

/// Lists what cells that have left their boxes may have met; all anew where these are many. *first is the first pair
/// that is new.
static SingeResult follow_strayed(Guard *guard, const State *state, Pool *pool, float h, uint32_t *first) {
    TouchPlan *plan = guard->plan;
    uint32_t count = list_strayed(plan);
    *first = plan->pair_count;
    if (count == 0) return SINGE_OK;
    bool all = count > plan->cell_count / STRAY_MOST || plan->edge <= 0;
    if (all) {
        TRY(search_again(guard, state, pool, h));
        measure(guard, pool);
        count = list_strayed(plan);
    }
    TRY(touch_search_strayed(plan, guard->shell, pool, count, (const float(*)[4])guard->dynamics->position));
    plan->restless = plan->step < state->step && count > plan->cell_count / STRAY_PART;
    *first = all ? 0 : plan->listed_count;
    return SINGE_OK;
}

/// One look at all that may have met, or at what the last round has changed; *hits is the number of pairs that have.
static SingeResult look(Guard *guard, const State *state, Pool *pool, float h, bool changed, uint32_t *hits) {
    uint32_t first;
    if (changed) {
        *hits = meet_changed(guard, pool);
    } else {
        measure(guard, pool);
        *hits = guard_meet(guard, pool, 0);
    }
    if (*hits > 0) return SINGE_OK;
    TRY(follow_strayed(guard, state, pool, h, &first));
    *hits = guard_meet(guard, pool, first);
    return SINGE_OK;
}

/// A velocity after a shift at the step's end: what the shift takes or gives, but no more than there was before or has
/// been gone in the step. What the step's last substep has brought in is in the velocity, in the way only by a small
/// part.
static Quad shifted_velocity(Quad before, Quad shift, Quad way, float h) {
    Quad after = before + shift / h, gone = way / h;
    float most = fmaxf(quad_dot(before, before), quad_dot(gone, gone)), square = quad_dot(after, after);
    return square > most ? sqrtf(most / square) * after : after;
}

/// Velocities and centres follow what has been changed.
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
}

static void empty_zones(TouchPlan *plan) {
    for (uint32_t k = 0; k < plan->stopped_count; k++) plan->zone[plan->stopped[k]] = SHELL_NONE;
    plan->stopped_count = 0;
}

static SingeResult close_step(TouchPlan *plan, const Shell *shell, const State *state, Pool *pool, float h,
                              DynamicsState *dynamics) {
    Guard guard = {plan, shell, dynamics, state->ablate.cell_flags,
                   h * (float)(state->step - plan->step + 1), 0};
    bool stopped = false;
    if (plan->closed) mark_moved(&guard);
    for (int impacts = 0, zones = 0;;) {
        uint32_t hits;
        TRY(look(&guard, state, pool, h, stopped || plan->closed, &hits));
        if (hits == 0) break;
        if (zones == ZONE_ROUNDS) {
            plan->counters.unresolved += hits;
            break;
        }
        if (!stopped) memcpy(plan->want, dynamics->position, plan->vertex_count * sizeof *plan->want);
        plan->counters.stops += hits;
        stopped = true;
        bool crowd = guard.looked > (uint64_t)IMPACT_LOOKS * plan->pair_count;
        if (zones > 0 || impacts == IMPACT_ROUNDS || crowd) guard_zones(&guard, zones++);
        else guard_impacts(&guard), impacts++;
    }
    plan->counters.looks += guard.looked;
    if (stopped) close_ways(&guard, h);
    memcpy(plan->end, dynamics->position, plan->vertex_count * sizeof *plan->end);
    plan->closed = true;
    return SINGE_OK;
}

SingeResult touch_guard(TouchPlan *plan, const Shell *shell, const State *state, Pool *pool, float h,
                        DynamicsState *dynamics) {
    double start = clock_seconds();
    SingeResult result = close_step(plan, shell, state, pool, h, dynamics);
    plan->pair_count = plan->listed_count;
    empty_zones(plan);
    if (result) touch_plan_forget(plan);
    plan->counters.seconds += clock_seconds() - start;
    return result;
}

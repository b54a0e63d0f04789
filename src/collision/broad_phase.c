// The search for cells that are near each other.
//
// A cell is a box that moves along: its box at the search, widened by half of thickness + slack, on the way that its
// corners were on. Two cells whose boxes do not meet in plan->steps steps stay farther apart than the thickness, as
// long as no corner leaves its way by more than half the slack; ccd.c watches that.
#include "common/error.h"
#include "collision/collision_plan.h"

typedef struct Find {
    TouchPlan *plan;
    const Shell *shell;
} Find;

// ---- what a cell counts as its own

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

static uint8_t owned(const TouchPlan *plan, const Shell *shell, uint32_t c) {
    uint8_t bits = 0;
    for (int i = 0; i < 4; i++) {
        bits |= (uint8_t)((plan->owner[shell->cells[c][i]] == c) << i);
        bits |= (uint8_t)(owns_side(plan, shell, c, i) << (4 + i));
    }
    return bits;
}

// ---- boxes

static TouchBox moving_box(const Quad place[4], const Quad way[4]) {
    TouchBox box = {.way = touch_mean(way)};
    for (int i = 0; i < 4; i++) {
        Quad end = place[i] + (way[i] - box.way);
        Quad low = quad_min(place[i], end), high = quad_max(place[i], end);
        box.low = i ? quad_min(box.low, low) : low;
        box.high = i ? quad_max(box.high, high) : high;
    }
    box.low = quad_flat(box.low), box.high = quad_flat(box.high);
    return box;
}

static TouchSlab slab(const Quad place[4]) {
    Quad corner[4] = {place[0], place[1], place[2], place[3]}, normal = quad_cross(place[2] - place[0],
                                                                                   place[3] - place[1]);
    float length = sqrtf(quad_dot(normal, normal));
    TouchSlab slab = {.normal = length > 0 ? normal / length : (Quad){0}};
    for (int i = 1; i < 4; i++) {
        float along = quad_dot(slab.normal, place[i] - place[0]);
        slab.low = along < slab.low ? along : slab.low;
        slab.high = along > slab.high ? along : slab.high;
    }
    quad_transpose(corner);
    slab.x = corner[0], slab.y = corner[1], slab.z = corner[2];
    return slab;
}

static void box_range(void *task, int begin, int end) {
    Find *find = task;
    TouchPlan *plan = find->plan;
    float time = (float)plan->steps * plan->time_step;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        if (!plan->alive[c]) continue;
        const uint32_t *corner = find->shell->cells[c];
        Quad place[4], way[4];
        for (int i = 0; i < 4; i++) {
            place[i] = quad_flat(quad_load(plan->place[corner[i]]));
            way[i] = time * quad_load(plan->speed[corner[i]]);
        }
        plan->boxes[c] = moving_box(place, way);
        plan->slabs[c] = slab(place);
        plan->owned[c] = owned(plan, find->shell, c);
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

// ---- the search

/// Also a cell with itself: it may fold upon itself.
static void add_cells(TouchPlan *plan) {
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        if (!plan->alive[c]) continue;
        plan->pairs[plan->pair_count++] = (TouchPair){.a = c, .b = c, .hit = 2, .bridge = c};
    }
}

static SingeResult find_pairs(Find *find, Pool *pool) {
    enum { TRIALS = 5 };
    TouchPlan *plan = find->plan;
    uint64_t count;
    plan->slack = plan->slack_most;
    for (int trial = 1;; trial++) {
        plan->reach = plan->thickness + plan->slack;
        pool_for(pool, (int)plan->cell_count, 512, sweep_boxes, find);
        count = touch_grid_pairs(plan, find->shell, pool);
        if (count + plan->cell_count <= plan->sizes.pair_budget || trial == TRIALS) break;
        plan->slack *= 0.5f; // too crowded: look less far
    }
    if (!touch_grow_pairs(plan, count + plan->cell_count)) return SINGE_ERROR_MEMORY;
    touch_grid_keep(plan, find->shell, pool, count, plan->pair_capacity - plan->cell_count);
    plan->counters.dropped += count - plan->pair_count;
    add_cells(plan);
    plan->listed_count = plan->pair_count;
    return SINGE_OK;
}

/// Fewer steps where corners move fast against each other: in the mean by a third of a cell at most.
static void choose_steps(TouchPlan *plan, const Shell *shell) {
    Quad mean = {0};
    double sum = 0, count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->alive[c]) mean += quad_load(plan->speed[shell->cells[c][0]]), count++;
    mean = mean / (float)fmax(count, 1);
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        Quad off = quad_load(plan->speed[shell->cells[c][0]]) - mean;
        if (plan->alive[c]) sum += (double)sqrtf(quad_dot(off, off));
    }
    double step = sum / fmax(count, 1) * (double)plan->time_step, most = (double)plan->cell_size / 2;
    plan->steps = step * TOUCH_STEPS < most ? TOUCH_STEPS : step * 2 > most ? 2 : (uint32_t)(most / step);
}

SingeResult touch_search(TouchPlan *plan, const Shell *shell, Pool *pool) {
    Find find = {plan, shell};
    plan->listed_count = plan->pair_count = 0, plan->restless = 0;
    choose_steps(plan, shell);
    find_owners(plan, shell);
    pool_for(pool, (int)plan->cell_count, 512, box_range, &find);
    TRY(find_pairs(&find, pool));
    touch_find_tangled(plan, shell, plan->searched == 0);
    plan->searched = 1;
    plan->counters.searches++;
    return SINGE_OK;
}

// The search for nearby cells.
//
// A cell is a moving box: its box at the search, widened by half of thickness + slack, along the trajectory that its
// corners were on. Two cells whose boxes do not meet in plan->steps steps stay farther apart than the thickness, as
// long as no corner deviates from its trajectory by more than half the slack; ccd.c watches that.
#include "common/assertion.h"
#include "common/error.h"
#include "common/real.h"
#include "collision/collision_plan.h"

typedef struct Find {
    CollisionPlan *plan;
    const Shell *shell;
} Find;

// ---- features that a cell owns

/// Bits of the corners and sides that a cell owns. A side shared by two cells belongs to the lower of the two.
static uint8_t owned(const CollisionPlan *plan, const Shell *shell, uint32_t c) {
    const uint32_t *corner = shell->cells[c];
    uint8_t bits = 0;
    for (int i = 0; i < 4; i++) {
        bits |= (uint8_t)((plan->owner[corner[i]] == c) << i);
        const uint32_t across = shell_neighbour(shell, c, i);
        bool first = false, second = false; // the one across has the side's corners
        for (int k = 0; k < 4 && across != SHELL_NONE && across <= c && plan->alive[across]; k++) {
            first |= shell->cells[across][k] == corner[i];
            second |= shell->cells[across][k] == corner[(i + 1) & 3];
        }

        bits |= (uint8_t)(!(first && second) << (4 + i));
    }

    return bits;
}

// ---- boxes

static CollisionSlab slab(const Float4 position[4]) {
    Float4 corner[4] = {position[0], position[1], position[2], position[3]},
           normal = float4_cross(position[2] - position[0], position[3] - position[1]);
    float length = sqrtf(float4_dot(normal, normal));
    CollisionSlab slab = {.normal = length > 0 ? normal / length : (Float4){0}};

    for (int i = 1; i < 4; i++) {
        float along = float4_dot(slab.normal, position[i] - position[0]);
        slab.low = along < slab.low ? along : slab.low;
        slab.high = along > slab.high ? along : slab.high;
    }

    float4_transpose(corner);
    slab.x = corner[0];
    slab.y = corner[1];
    slab.z = corner[2];
    return slab;
}

static void box_range(void *task, int begin, int end) {
    Find *find = task;
    CollisionPlan *plan = find->plan;
    float time = (float)plan->steps * plan->h;

    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        if (!plan->alive[c]) continue;

        const uint32_t *corner = find->shell->cells[c];
        Float4 position[4], displacement[4];
        for (int i = 0; i < 4; i++) {
            position[i] = float4_flat(float4_load(plan->position[corner[i]]));
            displacement[i] = time * float4_load(plan->speed[corner[i]]);
        }

        // the box of its displacements without their mean
        CollisionBox box = {.displacement = collision_mean(displacement)};
        for (int i = 0; i < 4; i++) {
            Float4 last = position[i] + (displacement[i] - box.displacement);
            Float4 low = float4_min(position[i], last), high = float4_max(position[i], last);
            box.low = i ? float4_min(box.low, low) : low;
            box.high = i ? float4_max(box.high, high) : high;
        }

        box.low = float4_flat(box.low);
        box.high = float4_flat(box.high);
        plan->boxes[c] = box;
        plan->slabs[c] = slab(position);
        plan->owned[c] = owned(plan, find->shell, c);
    }
}

/// Widens the swept boxes for plan->reach.
static void sweep_boxes(void *task, int begin, int end) {
    CollisionPlan *plan = ((Find *)task)->plan;
    float wide = 0.5f * plan->reach;
    Float4 zero = {0};
    for (int c = begin; c < end; c++) {
        CollisionBox *box = &plan->boxes[c];
        box->swept_low = box->low + float4_min(box->displacement, zero) - wide;
        box->swept_high = box->high + float4_max(box->displacement, zero) + wide;
    }
}

// ---- the search

SingeResult broad_search(Memory *memory, CollisionPlan *plan, const Shell *shell, Pool *pool) {
    Find find = {plan, shell};
    plan->between_count = plan->listed_count = plan->pair_count = plan->repulsion_count = 0; // repulsions name pairs
    plan->restless = 0;
    plan->kept.current = false;

    // fewer steps where corners move fast relative to each other: on average by at most a third of a cell
    Float4 mean = {0};
    double sum = 0, cells = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->alive[c]) {
            mean += float4_load(plan->speed[shell->cells[c][0]]);
            cells++;
        }
    mean = mean / (float)double_max(cells, 1);

    for (uint32_t c = 0; c < plan->cell_count; c++) {
        Float4 off = float4_load(plan->speed[shell->cells[c][0]]) - mean;
        if (plan->alive[c]) sum += (double)sqrtf(float4_dot(off, off));
    }

    double step = sum / double_max(cells, 1) * (double)plan->h, max = (double)plan->cell_size / 2;

    // a step that is not finite, as with positions that overflow, gets the fewest
    plan->steps = step * COLLISION_STEPS < max ? COLLISION_STEPS : step * 2 <= max ? (uint32_t)(max / step) : 2;

    // and not many more than the last search has served: where layers land on each other, boxes for more list pairs that
    // nothing comes of
    if (plan->steps / 2 > plan->steps_most / 2) plan->steps = plan->steps_most;
    if (plan->h < plan->time_step) plan->steps = 1; // a part of a step

    // boxes; a vertex is owned by its lowest cell
    for (uint32_t c = plan->cell_count; c-- > 0;)
        for (int i = 0; plan->alive[c] && i < 4; i++) plan->owner[shell->cells[c][i]] = c;
    pool_for(pool, (int)plan->cell_count, 512, box_range, &find);

    // pairs whose swept boxes meet; where they are too crowded, search less far
    uint64_t count;
    for (;; plan->narrowed++) {
        plan->slack = plan->slack_max / (float)(1 << plan->narrowed);
        plan->reach = plan->thickness + plan->slack;
        pool_for(pool, (int)plan->cell_count, 512, sweep_boxes, &find);
        TRY(broad_grid_pairs(memory, plan, shell, pool, &count));
        if (count + plan->cell_count <= plan->sizes.pair_budget || plan->narrowed + 1 == COLLISION_TRIALS) break;
    }

    if (!collision_grow_pairs(memory, plan, count + plan->cell_count)) return SINGE_ERROR_MEMORY;
    broad_grid_keep(plan, shell, pool, count, plan->pair_capacity - plan->cell_count);
    plan->counters.dropped += count - plan->pair_count;

    // a cell may fold onto itself
    plan->between_count = plan->pair_count;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->alive[c]) plan->pairs[plan->pair_count++] = (CollisionPair){.a = c, .b = c, .hit = 2, .bridge = c};
    plan->listed_count = plan->pair_count;
    SINGE_ASSERT(plan->pair_count <= plan->pair_capacity);

    TRY(initial_find(memory, plan, shell, plan->searched == 0));
    plan->searched = 1;
    plan->counters.searches++;
    return SINGE_OK;
}

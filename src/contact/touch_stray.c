// Cells that have left the boxes that the search foresaw: what they may have met in this step.
#include "contact/touch_grid.h"

typedef struct Strays {
    TouchPlan *plan;
    const Shell *shell;
    const float (*x)[4];
    uint32_t count;
} Strays;

static TouchStray stray_box(const Strays *job, uint32_t cell) {
    const TouchPlan *plan = job->plan;
    const uint32_t *corner = job->shell->cells[cell];
    Quad low = quad_load(job->x[corner[0]]), high = low;
    for (int i = 0; i < 4; i++) {
        Quad start = quad_load(plan->start[corner[i]]), end = quad_load(job->x[corner[i]]);
        low = quad_min(low, quad_min(start, end)), high = quad_max(high, quad_max(start, end));
    }
    low[3] = high[3] = 0;
    return (TouchStray){low - 2 * plan->gap, high + 2 * plan->gap};
}

static void box_range(void *task, int begin, int end) {
    const Strays *job = task;
    for (int k = begin; k < end; k++) job->plan->stray_boxes[k] = stray_box(job, job->plan->stray[k]);
}

/// Adds a pair unless the search has listed it.
static void add_pair(const Strays *job, uint32_t a, uint32_t b, TouchWriter *writer) {
    float distance;
    if (a > b) {
        uint32_t c = a;
        a = b, b = c;
    }
    if (a == b || touch_is_listed(job->plan, a, b, &distance)) return;
    TouchPair *pair = touch_list_add(writer);
    if (pair) *pair = (TouchPair){.a = a, .b = b, .hit = 2, .bridge = touch_bridge(job->plan, job->shell, a, b)};
}

/// Cells in their boxes that a strayed one may have met.
static void against_boxes(const Strays *job, uint32_t a, const TouchStray *box, TouchWriter *writer) {
    const TouchPlan *plan = job->plan;
    float inverse = 1 / plan->edge;
    Cube first = touch_cube(box->low, inverse), last = touch_cube(box->high, inverse), at = first;
    for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[2] = first[2]; at[2] <= last[2]; at[2]++) {
                uint32_t key = touch_key(at), bucket = touch_bucket(plan, key), begun = quad_bits(at == first) & 7;
                for (uint32_t k = plan->bucket_first[bucket]; k < plan->bucket_first[bucket + 1]; k++) {
                    const TouchEntry *entry = &plan->entries[k];
                    if ((entry->key & TOUCH_KEY) != key || (begun | entry->key >> 29) != 7) continue;
                    if (plan->strayed[entry->cell]) continue;
                    const TouchBox *other = &plan->boxes[entry->cell];
                    if (quads_meet(box->low, box->high, other->swept_low, other->swept_high))
                        add_pair(job, a, entry->cell, writer);
                }
            }
}

static void stray_block(void *context, TouchList *list, int block) {
    const Strays *job = context;
    TouchWriter writer = touch_list_begin(list);
    uint32_t first = (uint32_t)block * TOUCH_STRAYS, last = first + TOUCH_STRAYS;
    for (uint32_t k = first; k < last && k < job->count; k++) {
        uint32_t a = job->plan->stray[k];
        const TouchStray *box = &job->plan->stray_boxes[k];
        against_boxes(job, a, box, &writer);
        for (uint32_t l = k + 1; l < job->count; l++) {
            const TouchStray *other = &job->plan->stray_boxes[l];
            if (quads_meet(box->low, box->high, other->low, other->high))
                add_pair(job, a, job->plan->stray[l], &writer);
        }
    }
    touch_list_end(&writer, block);
}

static void keep_pair(void *context, const void *item, uint32_t number) {
    TouchPlan *plan = ((const Strays *)context)->plan;
    memcpy(&plan->pairs[plan->listed_count + number], item, sizeof(TouchPair));
}

void touch_search_strayed(TouchPlan *plan, const Shell *shell, Pool *pool, uint32_t stray_count, const float (*x)[4]) {
    Strays job = {plan, shell, x, stray_count};
    int blocks = (int)((stray_count + TOUCH_STRAYS - 1) / TOUCH_STRAYS);
    pool_for(pool, (int)stray_count, TOUCH_STRAYS, box_range, &job);
    uint32_t room = plan->pair_capacity - plan->listed_count;
    uint64_t count = touch_list_write(&plan->found_pairs, pool, blocks, plan->pair_capacity, stray_block, &job);
    uint32_t kept = (uint32_t)(count < room ? count : room);
    plan->counters.dropped += count - kept;
    touch_list_read(&plan->found_pairs, pool, blocks, kept, keep_pair, &job);
    plan->pair_count = plan->listed_count + kept;
}

// Cells that have left the boxes that the search foresaw: what they may have met in this step.
#include "collision/broad_grid.h"

typedef struct Strays {
    TouchPlan *plan;
    const Shell *shell;
    const float (*x)[4];
    uint32_t count;
    uint32_t entry_count; ///< of the strays' own grid
    bool crowded;         ///< it has no room for all: strays are held against all others
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

static void against_box(const Strays *job, uint32_t a, const TouchStray *box, uint32_t b, TouchWriter *writer) {
    const TouchBox *other = &job->plan->boxes[b];
    if (!job->plan->strayed[b] && quads_meet(box->low, box->high, other->swept_low, other->swept_high))
        add_pair(job, a, b, writer);
}

/// Cells in their boxes that a strayed one may have met.
static void against_boxes(const Strays *job, uint32_t a, const TouchStray *box, TouchWriter *writer) {
    const TouchPlan *plan = job->plan;
    float inverse = 1 / plan->edge;
    Cube first = touch_cube(box->low, inverse), last = touch_cube(box->high, inverse), at = first;
    if (touch_cubes(first, last, plan->sizes.entries) > plan->sizes.entries) { // thrown far: more cubes than cells
        for (uint32_t b = 0; b < plan->cell_count; b++)
            if (plan->alive[b]) against_box(job, a, box, b, writer);
        return;
    }
    for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[2] = first[2]; at[2] <= last[2]; at[2]++) {
                uint32_t key = touch_key(at), bucket = touch_bucket(plan, key), begun = quad_bits(at == first) & 7;
                for (uint32_t k = plan->bucket_first[bucket]; k < plan->bucket_first[bucket + 1]; k++) {
                    const TouchEntry *entry = &plan->entries[k];
                    if ((entry->key & TOUCH_KEY) != key || (begun | entry->key >> 29) != 7) continue;
                    against_box(job, a, box, entry->cell, writer);
                }
            }
}

// ---- strays among each other: a grid of the same cubes, buckets as chains

static void chain_strays(Strays *job) {
    TouchPlan *plan = job->plan;
    float inverse = 1 / plan->edge;
    memset(plan->stray_chain, 0xff, plan->bucket_count * sizeof *plan->stray_chain);
    for (uint32_t k = job->count; k-- > 0;) {
        const TouchStray *box = &plan->stray_boxes[k];
        Cube first = touch_cube(box->low, inverse), last = touch_cube(box->high, inverse), at = first;
        uint64_t cubes = touch_cubes(first, last, plan->sizes.entries);
        job->crowded |= cubes > plan->sizes.entries - job->entry_count;
        if (job->crowded) return;
        for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
            for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
                for (at[2] = first[2]; at[2] <= last[2]; at[2]++) {
                    uint32_t key = touch_key(at), *chain = &plan->stray_chain[touch_bucket(plan, key)];
                    plan->stray_entries[job->entry_count] =
                        (TouchChain){k, key | (quad_bits(at == first) & 7) << 29, *chain};
                    *chain = job->entry_count++;
                }
    }
}

static void add_stray_pair(const Strays *job, uint32_t k, uint32_t l, TouchWriter *writer) {
    const TouchStray *box = &job->plan->stray_boxes[k], *other = &job->plan->stray_boxes[l];
    if (quads_meet(box->low, box->high, other->low, other->high))
        add_pair(job, job->plan->stray[k], job->plan->stray[l], writer);
}

static void against_strays(const Strays *job, uint32_t k, TouchWriter *writer) {
    const TouchPlan *plan = job->plan;
    if (job->crowded) {
        for (uint32_t l = k + 1; l < job->count; l++) add_stray_pair(job, k, l, writer);
        return;
    }
    const TouchStray *box = &plan->stray_boxes[k];
    float inverse = 1 / plan->edge;
    Cube first = touch_cube(box->low, inverse), last = touch_cube(box->high, inverse), at = first;
    for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[2] = first[2]; at[2] <= last[2]; at[2]++) {
                uint32_t key = touch_key(at), begun = quad_bits(at == first) & 7, e;
                for (e = plan->stray_chain[touch_bucket(plan, key)]; e != SHELL_NONE; e = plan->stray_entries[e].next) {
                    const TouchChain *entry = &plan->stray_entries[e];
                    if (entry->stray > k && (entry->key & TOUCH_KEY) == key && (begun | entry->key >> 29) == 7)
                        add_stray_pair(job, k, entry->stray, writer);
                }
            }
}

static void stray_block(void *context, TouchList *list, int block) {
    const Strays *job = context;
    TouchWriter writer = touch_list_begin(list, block);
    uint32_t first = (uint32_t)block * TOUCH_STRAYS, last = first + TOUCH_STRAYS;
    for (uint32_t k = first; k < last && k < job->count && !touch_list_is_full(&writer); k++) {
        against_boxes(job, job->plan->stray[k], &job->plan->stray_boxes[k], &writer);
        against_strays(job, k, &writer);
    }
    touch_list_end(&writer);
}

static void keep_pair(void *context, const void *item, uint32_t number) {
    TouchPlan *plan = ((const Strays *)context)->plan;
    memcpy(&plan->pairs[plan->listed_count + number], item, sizeof(TouchPair));
}

SingeResult touch_search_strayed(TouchPlan *plan, const Shell *shell, Pool *pool, uint32_t stray_count,
                                 const float (*x)[4]) {
    Strays job = {plan, shell, x, stray_count, 0, false};
    plan->pair_count = plan->listed_count;
    if (stray_count == 0 || !(plan->edge > 0)) return SINGE_OK;
    int blocks = (int)((stray_count + TOUCH_STRAYS - 1) / TOUCH_STRAYS);
    pool_for(pool, (int)stray_count, TOUCH_STRAYS, box_range, &job);
    chain_strays(&job);
    TouchList *list = &plan->found_pairs;
    uint64_t count = touch_list_write(list, pool, blocks, plan->sizes.pair_most, stray_block, &job);
    if (!touch_grow_pairs(plan, plan->listed_count + count)) return SINGE_ERROR_MEMORY;
    uint32_t room = plan->pair_capacity - plan->listed_count;
    uint32_t kept = touch_list_settle(list, pool, blocks, count, room, stray_block, &job);
    plan->counters.dropped += count - kept;
    touch_list_read(list, pool, blocks, kept, keep_pair, &job);
    plan->pair_count = plan->listed_count + kept;
    return SINGE_OK;
}

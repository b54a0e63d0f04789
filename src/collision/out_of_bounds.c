// Cells that have left their boxes of the search: pairs that they may have met in this step.
#include "collision/broad_grid.h"

typedef struct OutsideSearch {
    CollisionPlan *plan;
    const Shell *shell;
    const float (*x)[4];
    uint32_t count;
    uint32_t entry_count; ///< of the grid of cells out of bounds
    bool crowded;         ///< it has no room for all: cells out of bounds are checked against all others
} OutsideSearch;

/// The slightly widened regions that cells out of bounds pass over.
static void box_range(void *task, int begin, int end) {
    const OutsideSearch *job = task;
    const CollisionPlan *plan = job->plan;
    for (int k = begin; k < end; k++) {
        const uint32_t *corner = job->shell->cells[plan->outside[k]];
        Float4 low = float4_load(job->x[corner[0]]), high = low;
        for (int i = 0; i < 4; i++) {
            Float4 from = float4_load(plan->start[corner[i]]), to = float4_load(job->x[corner[i]]);
            low = float4_min(low, float4_min(from, to));
            high = float4_max(high, float4_max(from, to));
        }

        low[3] = high[3] = 0;
        plan->outside_boxes[k] = (OutsideBox){low - 2 * plan->gap, high + 2 * plan->gap};
    }
}

/// Adds a pair unless the search has listed it.
static void add_pair(const OutsideSearch *job, uint32_t a, uint32_t b, BlockWriter *writer) {
    float distance;
    if (a > b) {
        uint32_t c = a;
        a = b;
        b = c;
    }

    if (a == b || collision_is_listed(job->plan, a, b, &distance)) return;
    CollisionFound *found = block_list_add(writer);
    if (found) *found = (CollisionFound){.a = a, .b = b};
}

static void against_box(const OutsideSearch *job, uint32_t a, const OutsideBox *box, uint32_t b, BlockWriter *writer) {
    const CollisionBox *other = &job->plan->boxes[b];
    if (!job->plan->is_outside[b] && quads_meet(box->low, box->high, other->swept_low, other->swept_high))
        add_pair(job, a, b, writer);
}

static void add_outside_pair(const OutsideSearch *job, uint32_t k, uint32_t l, BlockWriter *writer) {
    const OutsideBox *box = &job->plan->outside_boxes[k], *other = &job->plan->outside_boxes[l];
    if (quads_meet(box->low, box->high, other->low, other->high))
        add_pair(job, job->plan->outside[k], job->plan->outside[l], writer);
}

/// Pairs of cells out of bounds, each with the cells in their boxes that it may have met and the later ones out of
/// bounds.
static void outside_block(void *context, BlockList *list, int block) {
    const OutsideSearch *job = context;
    const CollisionPlan *plan = job->plan;
    BlockWriter writer = block_list_begin(list, block);
    uint32_t first = (uint32_t)block * COLLISION_OUTSIDE, last = first + COLLISION_OUTSIDE;

    for (uint32_t k = first; k < last && k < job->count && !block_list_is_full(&writer); k++) {
        const OutsideBox *box = &plan->outside_boxes[k];
        const uint32_t a = plan->outside[k];
        Cube low = collision_cube(plan, box->low), high = collision_cube(plan, box->high), at = low;

        // thrown far: more cubes than cells
        const bool far = collision_cubes(low, high, plan->sizes.entry_max) > plan->sizes.entry_max;
        for (uint32_t b = 0; far && b < plan->cell_count; b++)
            if (plan->alive[b]) against_box(job, a, box, b, &writer);

        // else entries of the search's grid
        for (at[0] = low[0]; !far && at[0] <= high[0]; at[0]++)
            for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
                for (at[2] = low[2]; at[2] <= high[2]; at[2]++) {
                    uint32_t key = collision_key(at), bucket = collision_bucket(plan, key),
                             begun = float4_bits(at == low) & 7;
                    for (uint32_t e = plan->bucket_first[bucket]; e < plan->bucket_first[bucket + 1]; e++) {
                        const CollisionEntry *entry = &plan->entries[e];
                        if ((entry->key & COLLISION_KEY) != key || (begun | entry->key >> 29) != 7) continue;
                        against_box(job, a, box, entry->cell, &writer);
                    }
                }

        // all others out of bounds, or those in the entries of their grid
        for (uint32_t l = k + 1; job->crowded && l < job->count; l++) add_outside_pair(job, k, l, &writer);
        for (at[0] = low[0]; !job->crowded && at[0] <= high[0]; at[0]++)
            for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
                for (at[2] = low[2]; at[2] <= high[2]; at[2]++) {
                    uint32_t key = collision_key(at), begun = float4_bits(at == low) & 7, e;
                    for (e = plan->outside_chain[collision_bucket(plan, key)]; e != SHELL_NONE;
                         e = plan->outside_entries[e].next) {
                        const OutsideEntry *entry = &plan->outside_entries[e];
                        if (entry->outside > k && (entry->key & COLLISION_KEY) == key &&
                            (begun | entry->key >> 29) == 7)
                            add_outside_pair(job, k, entry->outside, &writer);
                    }
                }
    }

    block_list_end(&writer);
}

static void keep_pair(void *context, const void *item, uint32_t number) {
    const OutsideSearch *job = context;
    const CollisionFound *found = item;
    const uint32_t bridge = collision_bridge(job->plan, job->shell, found->a, found->b);
    job->plan->pairs[job->plan->listed_count + number] =
        (CollisionPair){.a = found->a, .b = found->b, .hit = 2, .bridge = bridge};
}

SingeResult broad_search_outside(Memory *memory, CollisionPlan *plan, const Shell *shell, Pool *pool,
                                 uint32_t outside_count, const float (*x)[4]) {
    OutsideSearch job = {plan, shell, x, outside_count, 0, false};
    plan->pair_count = plan->listed_count;
    if (outside_count == 0 || !(plan->edge > 0)) return SINGE_OK;

    int blocks = (int)((outside_count + COLLISION_OUTSIDE - 1) / COLLISION_OUTSIDE);
    pool_for(pool, (int)outside_count, COLLISION_OUTSIDE, box_range, &job);

    // cells out of bounds among each other: a grid of the same cubes, buckets as chains
    memset(plan->outside_chain, 0xff, plan->bucket_count * sizeof *plan->outside_chain);

    for (uint32_t k = job.count; k-- > 0;) {
        const OutsideBox *box = &plan->outside_boxes[k];
        Cube first = collision_cube(plan, box->low), last = collision_cube(plan, box->high), at = first;
        uint64_t cubes = collision_cubes(first, last, plan->sizes.entry_max);
        job.crowded |= cubes > plan->sizes.entry_max - job.entry_count;
        if (job.crowded) break;
        if (!collision_grow_outside(memory, plan, job.entry_count + cubes)) return SINGE_ERROR_MEMORY;

        for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
            for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
                for (at[2] = first[2]; at[2] <= last[2]; at[2]++) {
                    uint32_t key = collision_key(at), *chain = &plan->outside_chain[collision_bucket(plan, key)];
                    plan->outside_entries[job.entry_count] =
                        (OutsideEntry){k, key | (float4_bits(at == first) & 7) << 29, *chain};
                    *chain = job.entry_count++;
                }
    }

    BlockList *list = &plan->found_pairs;
    uint64_t count = block_list_write(list, pool, blocks, plan->sizes.pair_max, outside_block, &job);
    if (!collision_grow_pairs(memory, plan, plan->listed_count + count)) return SINGE_ERROR_MEMORY;

    uint32_t room = plan->pair_capacity - plan->listed_count;
    uint32_t kept = block_list_settle(list, pool, blocks, count, room, outside_block, &job);
    plan->counters.dropped += count - kept;
    block_list_read(list, pool, blocks, kept, keep_pair, &job);
    plan->pair_count = plan->listed_count + kept;
    return SINGE_OK;
}

// The plan: its memory, sizes, snapshot and invariants.
//
// The lists of pairs and repulsions have room for flat sheets; where these fold, lie on each other or crowd they grow as
// needed, up to a max that only sheets lying within each other reach. Items beyond that are dropped and counted. The size
// of a list does not affect results: any sufficient size gives the same items, so that a run continued from a snapshot,
// where lists begin small again, has the same bytes.
#include "common/error.h"
#include "common/real.h"
#include "collision/collision_plan.h"

#include <string.h>

static uint32_t capped(uint64_t count) { return count < UINT32_MAX / 2 ? (uint32_t)count : UINT32_MAX / 2; }

CollisionSizes collision_sizes(const Shell *shell) {
    uint64_t cells = shell->cell_count;
    const uint64_t pairs = COLLISION_PAIRS_MAX * cells, repulsions = COLLISION_REPULSIONS_MAX * cells;
    const uint64_t least = COLLISION_LIST_MIN;
    return (CollisionSizes){.entry_max = capped(COLLISION_ENTRIES_MAX * cells + 64),
                            .pairs = capped(COLLISION_PAIRS * cells + COLLISION_LIST_BEGIN),
                            .pair_max = capped(pairs > least ? pairs : least),
                            .repulsions = capped(COLLISION_REPULSIONS * cells + COLLISION_LIST_BEGIN / 2),
                            .repulsion_max = capped(repulsions > least ? repulsions : least),
                            .pair_budget = capped(COLLISION_PAIRS_FAR * cells + 64)};
}

typedef struct Array {
    void *at; ///< the plan's pointer
    size_t count, size;
} Array;

enum { ARRAYS = 40 };

/// The plan's arrays, to create and to free them.
static void list_arrays(CollisionPlan *plan, Array list[ARRAYS]) {
    size_t cells = plan->cell_count, vertices = plan->vertex_count;
#define ARRAY(name, length) \
    { &plan->name, (length), sizeof *plan->name }
    const Array all[ARRAYS] = {
        ARRAY(thin, cells),
        ARRAY(position, vertices),
        ARRAY(speed, vertices),
        ARRAY(alive, cells),
        ARRAY(initial_first, cells + 2),
        ARRAY(intersecting, cells),
        ARRAY(kept.position, vertices),
        ARRAY(kept.speed, vertices),
        ARRAY(kept.alive, cells),
        ARRAY(kept.initial_first, cells + 2),
        ARRAY(boxes, cells),
        ARRAY(slabs, cells),
        ARRAY(rest, cells),
        ARRAY(owned, cells),
        ARRAY(owner, vertices),
        ARRAY(entries, plan->entry_capacity),
        ARRAY(bucket_first, (size_t)plan->bucket_count + 2),
        ARRAY(pairs, plan->pairs_length),
        ARRAY(repulsions, plan->repulsion_capacity),
        ARRAY(start, vertices),
        ARRAY(want, vertices),
        ARRAY(end, vertices),
        ARRAY(goal, vertices),
        ARRAY(motion, cells),
        ARRAY(zone, vertices),
        ARRAY(share, vertices),
        ARRAY(drift, vertices),
        ARRAY(stopped, vertices),
        ARRAY(changed, cells),
        ARRAY(changed_list, cells),
        ARRAY(active, plan->active_length),
        ARRAY(pair_first, cells + 2),
        ARRAY(around_first, cells + 2),
        ARRAY(around, plan->around_length),
        ARRAY(is_outside, cells),
        ARRAY(outside, cells),
        ARRAY(outside_boxes, cells),
        ARRAY(outside_chain, plan->bucket_count),
        ARRAY(outside_entries, plan->outside_capacity),
        ARRAY(partial, (size_t)collision_partials(plan)),
    };
#undef ARRAY
    memcpy(list, all, sizeof all);
}

void collision_plan_free(Memory *memory, CollisionPlan *plan) {
    if (!plan) return;

    Array list[ARRAYS];
    list_arrays(plan, list);
    for (int k = 0; k < ARRAYS; k++) memory_free(memory, list[k].at, list[k].count, list[k].size);
    FREE(memory, plan->initial_other, plan->initial_capacity);
    FREE(memory, plan->kept.initial_other, plan->initial_capacity);
    block_list_free(memory, &plan->found_pairs);
    block_list_free(memory, &plan->found);
    block_items_free(memory, &plan->items);
    FREE(memory, plan, 1);
}

SingeResult collision_plan_create(Memory *memory, const Shell *shell, const SingeContactDef *def, float time_step,
                                  CollisionPlan **out) {
    CollisionSizes sizes = collision_sizes(shell);
    return collision_plan_create_sized(memory, shell, def, time_step, &sizes, out);
}

/// Centroids at rest, and the thickness of cells: cells far smaller than the rest of their sheet would be torn apart by
/// the contact of their own corners.
static void measure_rest(CollisionPlan *plan, const Shell *shell) {
    float min = plan->cell_size;

    for (uint32_t c = 0; c < plan->cell_count; c++) {
        Float4 position[4];
        float shortest = INFINITY;

        for (int i = 0; i < 4; i++) position[i] = float4_load(shell->rest_position[shell->cells[c][i]]);
        for (int i = 0; i < 4; i++) {
            Float4 side = position[(i + 1) & 3] - position[i];
            shortest = float_min(shortest, float4_dot(side, side));
        }

        plan->rest[c] = collision_mean(position);
        shortest = sqrtf(shortest);
        plan->thin[c] = float_min(plan->thickness, 0.4f * shortest);
        min = float_min(min, 4 * shortest);
    }

    plan->gap = 5e-3f * min + 4 * plan->noise;
}

SingeResult collision_plan_create_sized(Memory *memory, const Shell *shell, const SingeContactDef *def, float time_step,
                                        const CollisionSizes *sizes, CollisionPlan **out) {
    CollisionPlan *plan;
    *out = NULL;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;

    plan->def = *def;
    plan->time_step = plan->h = time_step;
    plan->vertex_count = shell->vertex_count;
    plan->cell_count = shell->cell_count;
    plan->sizes = *sizes;
    plan->steps_most = COLLISION_STEPS;
    plan->pair_capacity = plan->pairs_length = plan->active_length = plan->around_length = sizes->pairs;
    plan->repulsion_capacity = sizes->repulsions;
    plan->entry_capacity = COLLISION_ENTRIES * plan->cell_count + COLLISION_LIST_BEGIN;
    plan->outside_capacity = COLLISION_LIST_BEGIN;
    for (plan->bucket_count = 256; plan->bucket_count < 2 * (uint64_t)plan->cell_count;) plan->bucket_count *= 2;

    // lengths that follow from the sheets
    plan->cell_size = INFINITY;
    float far = 0;
    for (uint32_t s = 0; s < shell->sheet_count; s++)
        plan->cell_size = float_min(plan->cell_size, shell->sheets[s].cell_size);
    for (uint32_t v = 0; v < shell->vertex_count; v++)
        for (int k = 0; k < 3; k++) far = float_max(far, fabsf(shell->rest_position[v][k]));

    plan->thickness = float_min(plan->def.thickness, 0.4f * plan->cell_size);
    plan->slack_max = float_max(0.3f * plan->cell_size, plan->thickness);
    plan->noise = 4e-7f * far;

    // arrays
    Array list[ARRAYS];
    list_arrays(plan, list);
    bool done = true;
    for (int k = 0; k < ARRAYS && done; k++) {
        void *block = memory_new(memory, list[k].count, list[k].size);
        done = block != NULL;
        memcpy(list[k].at, &block, sizeof block);
    }

    uint32_t buckets = plan->bucket_count / COLLISION_BUCKETS + 1, blocks = plan->cell_count / COLLISION_OUTSIDE + 1;
    if (buckets < blocks) buckets = blocks;

    if (!done ||
        !block_list_create(memory, &plan->found_pairs, &plan->items, sizeof(CollisionFound), plan->pair_capacity,
                           buckets) ||
        !block_list_create(memory, &plan->found, &plan->items, sizeof(Repulsion), plan->repulsion_capacity,
                           collision_look_blocks(plan->pair_capacity))) {
        collision_plan_free(memory, plan);
        return SINGE_ERROR_MEMORY;
    }

    for (uint32_t v = 0; v < plan->vertex_count; v++) plan->zone[v] = SHELL_NONE;
    plan->work_max = COLLISION_WORK_MIN + (uint64_t)COLLISION_WORK * plan->cell_count;

    measure_rest(plan, shell);
    *out = plan;
    return SINGE_OK;
}

/// Repeats the search of which the input is there.
static SingeResult search_again(Memory *memory, CollisionPlan *plan, const Shell *shell) {
    initial_mark(plan);
    plan->closed = false;
    const uint32_t restless = plan->restless;
    TRY(broad_search(memory, plan, shell, NULL));
    plan->restless = restless;

    // how far pairs have moved since is unknown
    for (uint32_t k = 0; k < plan->listed_count; k++) plan->pairs[k].distance = 0;
    return SINGE_OK;
}

SingeResult collision_plan_stream(Memory *memory, CollisionPlan *plan, const Shell *shell, const uint8_t *cell_flags,
                                  Stream *stream) {
    if (stream->mode == STREAM_READ) plan->kept.current = false;
    STREAM(stream, plan->searched);
    STREAM(stream, plan->restless);
    STREAM(stream, plan->steps_most);
    STREAM(stream, plan->narrowed);
    STREAM(stream, plan->step);
    stream_data(stream, plan->position, plan->vertex_count * sizeof *plan->position);
    stream_data(stream, plan->speed, plan->vertex_count * sizeof *plan->speed);
    stream_data(stream, plan->alive, plan->cell_count);

    // pairs that have intersected since the start: the count of each cell, then their other cells
    uint32_t *first = plan->initial_first, count = first[plan->cell_count];
    STREAM(stream, count);
    stream_data(stream, first, ((size_t)plan->cell_count + 1) * sizeof *first);

    if (stream->mode == STREAM_READ) {
        bool fits =
            !stream->failed && first[0] == 0 && first[plan->cell_count] == count && count <= plan->sizes.pair_max;
        for (uint32_t c = 0; c < plan->cell_count && fits; c++) fits = first[c] <= first[c + 1];
        if (!fits || count > (stream->size - stream->offset) / sizeof *first) {
            memset(first, 0, ((size_t)plan->cell_count + 2) * sizeof *first);
            stream->failed = true;
            count = 0;
        } else if (!initial_reserve(memory, plan, count)) return SINGE_ERROR_MEMORY;
    }

    stream_data(stream, plan->initial_other, count * sizeof *plan->initial_other);

    if (stream->mode != STREAM_READ) return SINGE_OK;

    // whether the data read back may be that of a search; cells that are alive now were alive then
    if (plan->searched > 1 || plan->restless > 2 * COLLISION_PARTS || plan->steps_most > COLLISION_STEPS ||
        plan->narrowed >= COLLISION_TRIALS)
        stream->failed = true;
    for (uint32_t v = 0; v < plan->vertex_count; v++)
        for (int k = 0; k < 3; k++)
            if (!isfinite(plan->position[v][k]) || !isfinite(plan->speed[v][k])) stream->failed = true;

    for (uint32_t c = 0; c < plan->cell_count; c++) {
        if (plan->alive[c] > 1) stream->failed = true;

        for (uint32_t k = plan->initial_first[c]; k < plan->initial_first[c + 1]; k++)
            if (plan->initial_other[k] < c || plan->initial_other[k] >= plan->cell_count) stream->failed = true;
        if (plan->searched && (cell_flags[c] & SINGE_ALIVE) && !plan->alive[c]) stream->failed = true;
    }

    if (stream->failed || !plan->searched) return SINGE_OK;

    return search_again(memory, plan, shell);
}

/// Copies the last search's input, to the copy or back from it.
static void copy_search(CollisionPlan *plan, bool back) {
    const size_t points = plan->vertex_count * sizeof *plan->position;
    const size_t cells = plan->cell_count, first = (cells + 2) * sizeof *plan->initial_first;
    const size_t others = plan->initial_capacity * sizeof *plan->initial_other;
#define COPY(name, size) memcpy(back ? plan->name : plan->kept.name, back ? plan->kept.name : plan->name, size)
    COPY(position, points);
    COPY(speed, points);
    COPY(alive, cells);
    COPY(initial_first, first);
    if (others) COPY(initial_other, others);
#undef COPY
}

void collision_plan_keep(CollisionPlan *plan) {
    if (!plan->kept.current) copy_search(plan, false);
    plan->kept.current = true;
    plan->kept.searched = plan->searched;
    plan->kept.restless = plan->restless;
    plan->kept.steps_most = plan->steps_most;
    plan->kept.narrowed = plan->narrowed;
    plan->kept.step = plan->step;
    plan->kept.counters = plan->counters;
}

void collision_plan_restore(Memory *memory, CollisionPlan *plan, const Shell *shell) {
    if (!plan->kept.current) copy_search(plan, true);
    plan->searched = plan->kept.searched;
    plan->restless = plan->kept.restless;
    plan->steps_most = plan->kept.steps_most;
    plan->narrowed = plan->kept.narrowed;
    plan->step = plan->kept.step;
    plan->h = plan->time_step;
    plan->closed = false;
    if (!plan->searched) initial_mark(plan);
    else if (search_again(memory, plan, shell)) collision_plan_forget(plan);
    plan->counters = plan->kept.counters;
}

// a search from a later step than the present one counts as none
void collision_plan_forget(CollisionPlan *plan) {
    plan->step = UINT64_MAX;
    plan->closed = false;
}

int collision_parts(const CollisionPlan *plan) { return plan->restless < 2 ? 1 : (int)(plan->restless / 2); }

CollisionCounters collision_counters(const CollisionPlan *plan) { return plan->counters; }

// ---- growth

/// Makes an array of *length elements as long as `wanted`; new ones are not initialised. False when out of memory.
static bool grow_array(Memory *memory, void *at, uint32_t *length, uint32_t wanted, size_t size) {
    if (wanted <= *length) return true;
    if (!memory_grow(memory, at, *length, wanted, size)) return false;
    *length = wanted;
    return true;
}

/// A quarter more than needed, so that lists do not grow at every step.
static uint32_t with_margin(uint64_t wanted, uint32_t max) {
    wanted += wanted / 4;
    return wanted < max ? (uint32_t)wanted : max;
}

bool collision_grow_pairs(Memory *memory, CollisionPlan *plan, uint64_t wanted) {
    uint32_t before = plan->pair_capacity, after = with_margin(wanted, plan->sizes.pair_max);
    if (wanted <= before || before >= plan->sizes.pair_max) return true;

    BlockList *pairs = &plan->found_pairs, *repulsions = &plan->found;
    if (!block_list_grow(memory, pairs, after, pairs->block_count) ||
        !block_list_grow(memory, repulsions, repulsions->capacity, collision_look_blocks(after)) ||
        !grow_array(memory, &plan->pairs, &plan->pairs_length, after, sizeof *plan->pairs) ||
        !grow_array(memory, &plan->active, &plan->active_length, after, sizeof *plan->active) ||
        !grow_array(memory, &plan->around, &plan->around_length, after, sizeof *plan->around))
        return false;

    plan->pair_capacity = after;
    return true;
}

bool collision_grow_repulsions(Memory *memory, CollisionPlan *plan, uint64_t wanted) {
    uint32_t before = plan->repulsion_capacity, after = with_margin(wanted, plan->sizes.repulsion_max);
    if (wanted <= before || before >= plan->sizes.repulsion_max) return true;

    return block_list_grow(memory, &plan->found, after, plan->found.block_count) &&
           grow_array(memory, &plan->repulsions, &plan->repulsion_capacity, after, sizeof *plan->repulsions);
}

bool collision_grow_entries(Memory *memory, CollisionPlan *plan, uint64_t wanted) {
    return wanted <= plan->entry_capacity ||
           grow_array(memory, &plan->entries, &plan->entry_capacity, with_margin(wanted, plan->sizes.entry_max),
                      sizeof *plan->entries);
}

bool collision_grow_outside(Memory *memory, CollisionPlan *plan, uint64_t wanted) {
    return wanted <= plan->outside_capacity ||
           grow_array(memory, &plan->outside_entries, &plan->outside_capacity,
                      with_margin(wanted, plan->sizes.entry_max), sizeof *plan->outside_entries);
}

// ---- invariants, for assertions and tests

const char *collision_validate(const CollisionPlan *plan) {
    if (!plan->searched) return NULL;

    if (plan->listed_count > plan->pair_count && plan->pair_count) return "the step has fewer pairs than its search";
    if (plan->pair_count > plan->pair_capacity || plan->listed_count > plan->pair_capacity)
        return "there are more pairs than room for them";
    if (plan->pair_capacity > plan->sizes.pair_max) return "the list of pairs is larger than its limit";

    for (uint32_t k = 0; k < plan->listed_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        if (pair->a >= plan->cell_count || pair->b >= plan->cell_count || pair->a > pair->b)
            return "a pair's cells are out of order or do not exist";
        if (pair->bridge != SHELL_NONE && pair->bridge >= plan->cell_count) return "a pair's bridge is not a cell";
        if (!(pair->distance >= 0)) return "a pair has a negative distance, or none";
    }

    if (plan->repulsion_count > plan->repulsion_capacity) return "there are more repulsions than room for them";
    if (plan->repulsion_capacity > plan->sizes.repulsion_max) return "the list of repulsions is larger than its limit";

    for (uint32_t k = 0; k < plan->repulsion_count; k++) {
        const Repulsion *repulsion = &plan->repulsions[k];
        if (repulsion->a >= repulsion->b || repulsion->b >= plan->cell_count)
            return "a repulsion's cells are out of order or do not exist";
        for (int c = 0; c < 2; c++) {
            const uint16_t *weight = repulsion->weight[c];
            if (weight[0] + weight[1] + weight[2] + weight[3] != REPULSION_ONE)
                return "the weights of a repulsion's point do not add up";
        }
    }

    return NULL;
}

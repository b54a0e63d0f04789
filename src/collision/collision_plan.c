// The plan: what it is made of, how long it is remembered.
#include "common/error.h"
#include "collision/feature_distance.h"
#include "collision/collision_plan.h"

#include <string.h>

SingeResult touch_check(const SingeContactDef *def, SingeError *error) {
    const char *what = NULL;
    if (!(def->thickness > 0 && def->thickness <= 1)) what = "thickness must be above 0, at most 1 m";
    if (!(def->friction >= 0 && def->friction <= 1e3f)) what = "friction must be between 0 and 1000";
    return what ? error_set(error, SINGE_ERROR_ARGUMENT, "contact", -1, "%s", what) : SINGE_OK;
}

static uint32_t capped(uint64_t count) { return count < UINT32_MAX / 2 ? (uint32_t)count : UINT32_MAX / 2; }

static uint32_t most_room(uint32_t capacity) {
    uint64_t most = (uint64_t)TOUCH_GROWTH * capacity;
    return capped(most > TOUCH_LEAST ? most : TOUCH_LEAST);
}

TouchSizes touch_sizes(const Shell *shell) {
    uint64_t cells = shell->cell_count;
    TouchSizes sizes = {.entries = capped(TOUCH_ENTRIES * cells + 64), .pairs = capped(TOUCH_PAIRS * cells + 64),
                        .pushes = capped(TOUCH_PUSHES * cells + 64)};
    sizes.pair_most = most_room(sizes.pairs), sizes.push_most = most_room(sizes.pushes);
    sizes.pair_budget = sizes.pairs;
    return sizes;
}

/// Finds the sizes of lists and lengths that follow from the shell.
static void size_plan(TouchPlan *plan, const Shell *shell, const TouchSizes *sizes) {
    uint64_t cells = shell->cell_count;
    plan->vertex_count = shell->vertex_count, plan->cell_count = shell->cell_count;
    plan->sizes = *sizes;
    plan->pair_capacity = sizes->pairs, plan->push_capacity = sizes->pushes;
    for (plan->bucket_count = 256; plan->bucket_count < 2 * cells;) plan->bucket_count *= 2;
    plan->cell_size = INFINITY;
    float far = 0;
    for (uint32_t s = 0; s < shell->sheet_count; s++)
        plan->cell_size = fminf(plan->cell_size, shell->sheets[s].cell_size);
    for (uint32_t v = 0; v < shell->vertex_count; v++)
        for (int k = 0; k < 3; k++) far = fmaxf(far, fabsf(shell->rest_position[v][k]));
    plan->thickness = fminf(plan->def.thickness, 0.4f * plan->cell_size);
    plan->slack_most = fmaxf(0.3f * plan->cell_size, plan->thickness);
    plan->noise = 4e-7f * far;
}

typedef struct Array {
    void *at; ///< the plan's pointer
    size_t count, size;
} Array;

enum { ARRAYS = 34 };

/// The plan's arrays, for what makes and what frees them.
static void list_arrays(TouchPlan *plan, Array list[ARRAYS]) {
    size_t cells = plan->cell_count, vertices = plan->vertex_count;
#define ARRAY(name, length) {&plan->name, (length), sizeof *plan->name}
    const Array all[ARRAYS] = {
        ARRAY(thin, cells), ARRAY(place, vertices), ARRAY(speed, vertices), ARRAY(alive, cells), ARRAY(tangled, cells),
        ARRAY(boxes, cells), ARRAY(slabs, cells), ARRAY(rest, cells), ARRAY(owned, cells), ARRAY(owner, vertices),
        ARRAY(entries, plan->sizes.entries), ARRAY(bucket_first, (size_t)plan->bucket_count + 2),
        ARRAY(pairs, plan->pair_capacity), ARRAY(pushes, plan->push_capacity), ARRAY(start, vertices),
        ARRAY(want, vertices), ARRAY(end, vertices), ARRAY(goal, vertices), ARRAY(motion, cells),
        ARRAY(zone, vertices), ARRAY(share, vertices), ARRAY(drift, vertices),
        ARRAY(stopped, vertices), ARRAY(changed, cells), ARRAY(changed_list, cells),
        ARRAY(active, plan->pair_capacity), ARRAY(around_first, cells + 2),
        ARRAY(around, 2 * (size_t)plan->pair_capacity), ARRAY(strayed, cells), ARRAY(stray, cells),
        ARRAY(stray_boxes, cells),
        ARRAY(stray_chain, plan->bucket_count), ARRAY(stray_entries, plan->sizes.entries),
        ARRAY(partial, (size_t)pool_blocks((int)plan->pair_capacity)),
    };
#undef ARRAY
    memcpy(list, all, sizeof all);
}

static bool allocate(Memory *memory, TouchPlan *plan) {
    Array list[ARRAYS];
    list_arrays(plan, list);
    for (int k = 0; k < ARRAYS; k++) {
        void *block = memory_new(memory, list[k].count, list[k].size);
        if (!block) return false;
        memcpy(list[k].at, &block, sizeof block);
    }
    uint32_t most = plan->pair_capacity, blocks = touch_look_blocks(most);
    uint32_t buckets = plan->bucket_count / TOUCH_BUCKETS + 1, strays = plan->cell_count / TOUCH_STRAYS + 1;
    if (buckets < strays) buckets = strays;
    return touch_list_create(memory, &plan->found_pairs, sizeof(TouchPair), most, buckets) &&
           touch_list_create(memory, &plan->found, sizeof(TouchFound), plan->push_capacity, blocks);
}

void touch_plan_free(Memory *memory, TouchPlan *plan) {
    if (!plan) return;
    Array list[ARRAYS];
    list_arrays(plan, list);
    for (int k = 0; k < ARRAYS; k++) memory_free(memory, list[k].at, list[k].count, list[k].size);
    touch_list_free(memory, &plan->found_pairs);
    touch_list_free(memory, &plan->found);
    FREE(memory, plan, 1);
}

/// Where cells are at rest, and how thick they may be: those far smaller than the rest of their sheet would be torn
/// apart by what keeps their own corners apart.
static void measure_cells(TouchPlan *plan, const Shell *shell) {
    float least = plan->cell_size;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        Quad place[4];
        float shortest = INFINITY;
        for (int i = 0; i < 4; i++) place[i] = quad_load(shell->rest_position[shell->cells[c][i]]);
        for (int i = 0; i < 4; i++) {
            Quad side = place[(i + 1) & 3] - place[i];
            shortest = fminf(shortest, quad_dot(side, side));
        }
        plan->rest[c] = touch_mean(place);
        shortest = sqrtf(shortest);
        plan->thin[c] = fminf(plan->thickness, 0.4f * shortest);
        least = fminf(least, 4 * shortest);
    }
    plan->gap = 5e-3f * least + 4 * plan->noise;
}

SingeResult touch_plan_create(Memory *memory, const Shell *shell, const SingeContactDef *def, float time_step,
                              TouchPlan **out) {
    TouchSizes sizes = touch_sizes(shell);
    return touch_plan_create_sized(memory, shell, def, time_step, &sizes, out);
}

SingeResult touch_plan_create_sized(Memory *memory, const Shell *shell, const SingeContactDef *def, float time_step,
                                    const TouchSizes *sizes, TouchPlan **out) {
    TouchPlan *plan;
    *out = NULL;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;
    plan->memory = memory;
    plan->def = *def;
    plan->time_step = time_step;
    size_plan(plan, shell, sizes);
    if (!allocate(memory, plan)) {
        touch_plan_free(memory, plan);
        return SINGE_ERROR_MEMORY;
    }
    for (uint32_t v = 0; v < plan->vertex_count; v++) plan->zone[v] = SHELL_NONE;
    measure_cells(plan, shell);
    *out = plan;
    return SINGE_OK;
}

/// Whether what was read back is what a search may have been for; cells that are left now were left then.
static bool touch_fits(const TouchPlan *plan, const uint8_t *cell_flags) {
    if (plan->searched > 1 || plan->restless > 1) return false;
    for (uint32_t v = 0; v < plan->vertex_count; v++)
        for (int k = 0; k < 3; k++)
            if (!isfinite(plan->place[v][k]) || !isfinite(plan->speed[v][k])) return false;
    uint8_t groups = 0; // numbered in the order of their lowest cells
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        if (plan->alive[c] > 1 || plan->tangled[c] > groups + 1) return false;
        if (plan->tangled[c] > groups) groups = plan->tangled[c];
        if (plan->searched && (cell_flags[c] & SINGE_ALIVE) && !plan->alive[c]) return false;
    }
    return true;
}

SingeResult touch_plan_stream(TouchPlan *plan, const Shell *shell, const uint8_t *cell_flags, Stream *stream) {
    STREAM(stream, plan->searched);
    STREAM(stream, plan->restless);
    STREAM(stream, plan->step);
    stream_data(stream, plan->place, plan->vertex_count * sizeof *plan->place);
    stream_data(stream, plan->speed, plan->vertex_count * sizeof *plan->speed);
    stream_data(stream, plan->alive, plan->cell_count);
    stream_data(stream, plan->tangled, plan->cell_count);
    if (stream->mode == STREAM_READ && !touch_fits(plan, cell_flags)) stream->failed = true;
    if (stream->mode != STREAM_READ || stream->failed || !plan->searched) return SINGE_OK;
    plan->counters.tangled = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) plan->counters.tangled += plan->tangled[c] != 0;
    plan->closed = false;
    uint32_t restless = plan->restless;
    TRY(touch_search(plan, shell, NULL));
    plan->restless = restless;
    // how far pairs have moved since is not known
    for (uint32_t k = 0; k < plan->listed_count; k++) plan->pairs[k].distance = 0;
    return SINGE_OK;
}

// a search from a later step than the present one counts as none
void touch_plan_forget(TouchPlan *plan) { plan->step = UINT64_MAX, plan->closed = false; }

TouchCounters touch_counters(const TouchPlan *plan) { return plan->counters; }

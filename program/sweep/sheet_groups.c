// The rows of method `sheets`: sheets that can meet are in one row, those that cannot are in different ones.
//
// Two sheets can meet if their boxes at the start are at most a margin apart. Distances along gravity count as zero: a
// sheet above may fall. This is a guess; the report checks the caches (sheet_clearance.c).
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/job.h"
#include "sweep/box.h"
#include "sweep/sweep_plan.h"

typedef struct Groups {
    uint32_t count; ///< of sheets
    Box *boxes;
    uint32_t *group; ///< [count] the lowest sheet of each sheet's group
} Groups;

static double larger_diagonal(const Box *a, const Box *b) { return fmax(box_diagonal(a), box_diagonal(b)); }

/// The distance of two boxes, ignoring the axes along which gravity acts.
static double level_gap(const Box *a, const Box *b, const float gravity[3]) {
    Box low = *a, high = *b;
    for (int k = 0; k < 3; k++)
        if (gravity[k] != 0) low.min[k] = high.min[k] = low.max[k] = high.max[k] = 0;
    return box_gap(&low, &high);
}

static void join(Groups *groups, uint32_t a, uint32_t b) {
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (uint32_t i = 0; i < groups->count && low != high; i++)
        if (groups->group[i] == high) groups->group[i] = low;
}

static void find_groups(const Plan *plan, const Job *job, Groups *groups) {
    for (uint32_t i = 0; i < groups->count; i++) {
        const Mesh *mesh = &job->assets.meshes[i];
        groups->group[i] = i;
        groups->boxes[i] = box_empty();
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            box_add(&groups->boxes[i], mesh->positions + 3 * (size_t)v, (double[3]){0});
    }
    for (uint32_t i = 0; i < groups->count; i++)
        for (uint32_t j = 0; j < i; j++) {
            const Box *a = &groups->boxes[i], *b = &groups->boxes[j];
            const double margin = plan->margin >= 0 ? plan->margin : larger_diagonal(a, b);
            if (level_gap(a, b, job->scene->sim.gravity) <= margin) join(groups, groups->group[i], groups->group[j]);
        }
}

/// "[0, 3]": the sheets of a group.
static char *group_text(Plan *plan, const Groups *groups, uint32_t group) {
    char *text = NULL, *kept = NULL, *between = "[";
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    for (uint32_t i = 0; file && i < groups->count; i++) {
        if (groups->group[i] != group) continue;
        fprintf(file, "%s%u", between, i);
        between = ", ";
    }
    if (file) fputc(']', file);
    if (file && fclose(file) == 0 && text) kept = arena_text(plan->arena, text, size);
    free(text);
    return kept;
}

static bool make_rows(Plan *plan, const Groups *groups) {
    static const char key[] = "only_sheets";
    plan->parameters = arena_new(plan->arena, 1, sizeof *plan->parameters);
    plan->values = arena_new(plan->arena, groups->count, sizeof *plan->values);
    if (!plan->parameters || !plan->values) return false;
    plan->parameters[0] = (PlanParameter){.key = arena_text(plan->arena, key, sizeof key - 1)};
    plan->parameter_count = 1;
    plan->row_count = 0;
    for (uint32_t i = 0; i < groups->count; i++) {
        if (groups->group[i] != i) continue;
        char *text = group_text(plan, groups, i);
        if (!text) return false;
        plan->values[plan->row_count++] = text;
    }
    return plan->parameters[0].key != NULL;
}

ExitCode plan_split_sheets(Plan *plan, Console *console) {
    SetList sets = {0};
    Job job;
    for (uint32_t i = 0; i < plan->set_count; i++) set_add(&sets, plan->sets[i]);
    ExitCode code = job_open(&job, console, plan->scene, &sets, 1);
    set_free(&sets);
    if (code) return code;

    Groups groups = {.count = job.scene->sheet_count};
    groups.boxes = malloc(groups.count * sizeof *groups.boxes);
    groups.group = malloc(groups.count * sizeof *groups.group);
    bool good = groups.boxes && groups.group;
    if (good) {
        find_groups(plan, &job, &groups);
        good = make_rows(plan, &groups);
    }
    if (!good) console_error(console, "out of memory");
    else if (plan->row_count == 1) console_warn(console, "%s: all sheets can meet: there is one row", plan->scene);
    free(groups.boxes), free(groups.group);
    job_close(&job);
    return good ? EXIT_GOOD : EXIT_FAILED;
}

// Scratch of the ablate stage, and the mesh's boundary.
#include "ablate/ablate_plan.h"

#include <string.h>

static void mark_rim(AblatePlan *plan, const Shell *shell) {
    plan->split_count = shell->split_count;
    memset(plan->rim, 0, plan->vertex_count);
    for (uint32_t c = 0; c < shell->cell_count; c++)
        for (int i = 0; i < 4; i++)
            if (shell_neighbour(shell, c, i) == SHELL_NONE)
                plan->rim[shell->cells[c][i]] = plan->rim[shell->cells[c][(i + 1) & 3]] = 1;
}

void ablate_plan_follow(AblatePlan *plan, const Shell *shell) {
    if (plan->split_count != shell->split_count) mark_rim(plan, shell);
}

static SurfaceKeys number_keys(const Shell *shell) {
    SurfaceKeys keys = {.centre = shell->vertex_count, .blue = shell->particle_count};
    keys.red = keys.blue + shell->springs[SINGE_BLUE].count;
    keys.count = keys.red + shell->springs[SINGE_RED].count;
    return keys;
}

/// Lays out the scratch; the widest elements first, so that all are aligned.
static bool allocate_scratch(Memory *memory, AblatePlan *plan) {
    size_t particles = plan->particle_count, pieces = particles * (sizeof *plan->area + 3 * sizeof *plan->root + 1);
    size_t surface = plan->keys.count * sizeof *plan->output;
    plan->scratch_size = pieces > surface ? pieces : surface;
    if (!(plan->scratch = memory_new(memory, plan->scratch_size, 1))) return false;
    plan->area = plan->scratch;
    plan->root = (uint32_t *)(plan->area + particles);
    plan->size = plan->root + particles;
    plan->heir = plan->size + particles;
    plan->mark = (uint8_t *)(plan->heir + particles);
    plan->output = plan->scratch;
    return true;
}

SingeResult ablate_plan_create(Memory *memory, const Shell *shell, AblatePlan **plan_out) {
    AblatePlan *plan;
    *plan_out = NULL;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;
    size_t particles = plan->particle_count = shell->particle_count;
    size_t vertices = plan->vertex_count = shell->vertex_count;
    plan->keys = number_keys(shell);
    if (!NEW(memory, plan->level, particles) || !NEW(memory, plan->rim, vertices) || !allocate_scratch(memory, plan)) {
        ablate_plan_free(memory, plan);
        return SINGE_ERROR_MEMORY;
    }
    mark_rim(plan, shell);
    *plan_out = plan;
    return SINGE_OK;
}

void ablate_plan_free(Memory *memory, AblatePlan *plan) {
    if (!plan) return;
    size_t particles = plan->particle_count, vertices = plan->vertex_count;
    FREE(memory, plan->level, particles);
    FREE(memory, plan->rim, vertices);
    memory_free(memory, (void *)&plan->scratch, plan->scratch_size, 1);
    FREE(memory, plan, 1);
}

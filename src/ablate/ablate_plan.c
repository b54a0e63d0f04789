// Scratch of the ablate stage and the neighbours it looks at.
#include "ablate/ablate_plan.h"

#include <string.h>

static void mark_rim(AblatePlan *plan, const Shell *shell) {
    for (uint32_t c = 0; c < shell->cell_count; c++)
        for (int i = 0; i < 4; i++)
            if (shell_neighbour(shell, c, i) == SHELL_NONE)
                plan->rim[shell->cells[c][i]] = plan->rim[shell->cells[c][(i + 1) & 3]] = 1;
}

static SurfaceKeys number_keys(const Shell *shell) {
    SurfaceKeys keys = {.centre = shell->vertex_count, .blue = shell->particle_count};
    keys.red = keys.blue + shell->springs[SINGE_BLUE].count;
    keys.count = keys.red + shell->springs[SINGE_RED].count;
    return keys;
}

SingeResult ablate_plan_create(Memory *memory, const Shell *shell, AblatePlan **plan_out) {
    AblatePlan *plan;
    *plan_out = NULL;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;
    size_t particles = plan->particle_count = shell->particle_count;
    size_t vertices = plan->vertex_count = shell->vertex_count;
    plan->keys = number_keys(shell);
    if (!NEW(memory, plan->level, particles) || !NEW(memory, plan->rim, vertices)
        || !NEW(memory, plan->root, particles) || !NEW(memory, plan->size, particles)
        || !NEW(memory, plan->area, particles) || !NEW(memory, plan->mark, particles)
        || !NEW(memory, plan->heir, particles) || !NEW(memory, plan->output, plan->keys.count)) {
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
    FREE(memory, plan->root, particles);
    FREE(memory, plan->size, particles);
    FREE(memory, plan->area, particles);
    FREE(memory, plan->mark, particles);
    FREE(memory, plan->heir, particles);
    FREE(memory, plan->output, plan->keys.count);
    FREE(memory, plan, 1);
}

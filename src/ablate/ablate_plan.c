// Scratch of the ablate stage, the mesh's boundary, and the level set of section 6:
//
//   m' = m - m_loss
//
// The sheet is left where it is not negative. A sheet that is not ablated is inside everywhere.
#include "ablate/ablate_plan.h"

SingeResult ablate_plan_create(Memory *memory, const Shell *shell, AblatePlan **plan_out) {
    AblatePlan *plan;
    *plan_out = NULL;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;

    size_t particles = plan->particle_count = shell->particle_count;
    plan->vertex_count = shell->vertex_count;
    plan->split_count = SHELL_NONE; // of no shell yet
    if (!NEW(memory, plan->level, particles) || !NEW(memory, plan->rim, plan->vertex_count) ||
        !NEW(memory, plan->area, particles) || !NEW(memory, plan->root, particles) ||
        !NEW(memory, plan->size, particles) || !NEW(memory, plan->heir, particles) ||
        !NEW(memory, plan->mark, particles)) {
        ablate_plan_free(memory, plan);
        return SINGE_ERROR_MEMORY;
    }

    *plan_out = plan;
    return SINGE_OK;
}

void ablate_plan_free(Memory *memory, AblatePlan *plan) {
    if (!plan) return;

    FREE(memory, plan->level, plan->particle_count);
    FREE(memory, plan->rim, plan->vertex_count);
    FREE(memory, plan->area, plan->particle_count);
    FREE(memory, plan->root, plan->particle_count);
    FREE(memory, plan->size, plan->particle_count);
    FREE(memory, plan->heir, plan->particle_count);
    FREE(memory, plan->mark, plan->particle_count);
    FREE(memory, plan, 1);
}

float ablate_level(const Shell *shell, const State *state, uint32_t particle) {
    const Matter *matter = &shell->matter;
    if (!shell->sheets[matter->sheet[particle]].material.ablate) return 1;
    return state->burn.mass[particle] - field_at(matter->mass_loss, particle);
}

static void level_fill(AblatePlan *plan, const Shell *shell, const float *mass, bool ablate, uint32_t first,
                       uint32_t count) {
    const Field mass_loss = shell->matter.mass_loss;
    for (uint32_t i = first; i < first + count; i++) plan->level[i] = ablate ? mass[i] - field_at(mass_loss, i) : 1;
}

const float *ablate_levels(AblatePlan *plan, const Shell *shell, const BurnState *burn) {
    // the boundary of a shell that has torn
    if (plan->split_count != shell->split_count) {
        plan->split_count = shell->split_count;
        memset(plan->rim, 0, plan->vertex_count);
        for (uint32_t c = 0; c < shell->cell_count; c++)
            for (int i = 0; i < 4; i++)
                if (shell_neighbour(shell, c, i) == SHELL_NONE)
                    plan->rim[shell->cells[c][i]] = plan->rim[shell->cells[c][(i + 1) & 3]] = 1;
    }

    // levels, sheet by sheet
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        level_fill(plan, shell, burn->mass, sheet->material.ablate, sheet->vertex_first, sheet->vertex_count);
        level_fill(plan, shell, burn->mass, sheet->material.ablate, shell_centre(shell, sheet->cell_first),
                   sheet->cell_count);
    }

    return plan->level;
}

const uint8_t *ablate_rim(const AblatePlan *plan) { return plan->rim; }

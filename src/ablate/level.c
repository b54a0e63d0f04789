// The level set of section 6:
//
//   m' = m - m_loss
//
// The sheet is left where it is not negative. A sheet that is not ablated is inside everywhere.
#include "ablate/ablate_plan.h"

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

void ablate_levels(AblatePlan *plan, const Shell *shell, const BurnState *burn) {
    ablate_plan_follow(plan, shell);
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        level_fill(plan, shell, burn->mass, sheet->material.ablate, sheet->vertex_first, sheet->vertex_count);
        level_fill(plan, shell, burn->mass, sheet->material.ablate, shell_centre(shell, sheet->cell_first),
                   sheet->cell_count);
    }
}

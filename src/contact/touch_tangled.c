// What crosses, or lies in the same place, from the start: it is left alone until it has parted. Sheets in one place
// have no side to be kept on.
#include "contact/touch_feature.h"
#include "contact/touch_grid.h"
#include "shell/cross.h"

#include <string.h>

/// Whether two cells that do not hang together are as near as rounding can tell.
static bool cells_coincide(const TouchPlan *plan, const Shell *shell, const TouchPair *pair) {
    if (pair->bridge != SHELL_NONE) return false;
    const float(*x)[4] = (const float(*)[4])plan->place;
    Quad origin = quad_load(x[shell->cells[pair->a][0]]);
    TouchFar far = {4 * plan->noise, 0, 0, true};
    TouchNear near[TOUCH_NEAR];
    TouchCell a, b;
    float nearest;
    touch_cell_place(plan, shell, pair->a, x, origin, &a);
    touch_cell_place(plan, shell, pair->b, x, origin, &b);
    if (touch_cells_apart(&a, &b) > far.measured) return false;
    touch_features(shell, pair, &a, &b, &far, near, &nearest);
    return nearest < far.measured;
}

void touch_find_tangled(TouchPlan *plan, const Shell *shell, bool first) {
    if (!first && plan->counters.tangled == 0) return;
    enum { WAS = 1, IS = 2 };
    if (first) memset(plan->tangled, WAS, plan->cell_count);
    for (uint32_t k = 0; k < plan->pair_count; k++) {
        const TouchPair *pair = &plan->pairs[k];
        if (!(plan->tangled[pair->a] && plan->tangled[pair->b])) continue;
        const TouchBox *p = &plan->boxes[pair->a], *q = &plan->boxes[pair->b];
        if (!quads_meet(p->low, p->high, q->low, q->high)) continue;
        if (cross_cells(shell, (const float(*)[4])plan->place, pair->a, pair->b) || cells_coincide(plan, shell, pair))
            plan->tangled[pair->a] |= IS, plan->tangled[pair->b] |= IS;
    }
    plan->counters.tangled = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        plan->tangled[c] = (plan->tangled[c] & IS) != 0;
        if (plan->tangled[c] && plan->counters.tangled == 0) plan->counters.tangled_first = c;
        plan->counters.tangled += plan->tangled[c];
    }
}

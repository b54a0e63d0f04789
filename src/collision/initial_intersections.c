// What crosses, or lies in the same position, from the start: it is left alone until it has parted. Sheets in one place
// have no side to be kept on. Cells that cross one another, or are joined by others that do, are a group: pairs within
// a group are left alone, pairs of two groups are not.
#include "collision/narrow_phase.h"
#include "collision/broad_grid.h"
#include "shell/cross.h"

#include <string.h>

enum { GROUP_MAX = UINT8_MAX }; // groups beyond count as the last

/// Whether two cells that are not connected are as near as rounding can tell.
static bool cells_coincide(const CollisionPlan *plan, const Shell *shell, const CollisionPair *pair) {
    if (pair->bridge != SHELL_NONE) return false;
    const float(*x)[4] = (const float(*)[4])plan->position;
    Float4 origin = float4_load(x[shell->cells[pair->a][0]]);
    FeatureRange far = {4 * plan->noise, 0, 0, true};
    NearFeatures near[NARROW_MAX];
    NarrowCell a, b;
    float nearest;
    narrow_cell_set(plan, shell, pair->a, x, origin, &a);
    narrow_cell_set(plan, shell, pair->b, x, origin, &b);
    if (narrow_slabs_distance(&a, &b) > far.measured) return false;
    narrow_features(shell, pair, &a, &b, &far, near, &nearest);
    return nearest < far.measured;
}

static uint32_t group_root(uint32_t *joined, uint32_t cell) {
    while (joined[cell] != cell) cell = joined[cell] = joined[joined[cell]];
    return cell;
}

static void group_join(uint32_t *joined, uint32_t a, uint32_t b) {
    if (joined[a] == SHELL_NONE) joined[a] = a;
    if (joined[b] == SHELL_NONE) joined[b] = b;
    a = group_root(joined, a), b = group_root(joined, b);
    if (a < b) joined[b] = a;
    else joined[a] = b;
}

/// Numbers the groups in the order of their lowest cells, without gaps. After the first search they stay what they
/// were, as what crosses moves from cell to cell; cells that have parted leave them.
static void number_groups(CollisionPlan *plan, uint32_t *joined, bool first) {
    uint8_t now[GROUP_MAX + 1] = {0}; // by the number that it had
    uint32_t groups = 0;
    plan->counters.intersecting = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        uint8_t *group = &plan->intersecting[c];
        uint32_t root = joined[c] == SHELL_NONE ? SHELL_NONE : group_root(joined, c);
        bool opens = first ? root == c : !now[*group];
        if (root == SHELL_NONE) {
            *group = 0;
            continue;
        }
        if (opens && groups < GROUP_MAX) groups++;
        if (first) *group = opens ? (uint8_t)groups : plan->intersecting[root];
        else *group = now[*group] = opens ? (uint8_t)groups : now[*group];
        if (plan->counters.intersecting++ == 0) plan->counters.intersecting_first = c;
    }
}

void initial_find(CollisionPlan *plan, const Shell *shell, bool first) {
    uint32_t *joined = plan->outside; // free until CCD: of a cell that crosses one of its group, no higher than it
    if (!first && plan->counters.intersecting == 0) return;
    memset(joined, 0xff, plan->cell_count * sizeof *joined);
    for (uint32_t k = 0; k < plan->pair_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        if (!first && !initial_is_crossing(plan, pair)) continue;
        const CollisionBox *p = &plan->boxes[pair->a], *q = &plan->boxes[pair->b];
        if (!quads_meet(p->low, p->high, q->low, q->high)) continue;
        if (cross_cells(shell, (const float(*)[4])plan->position, pair->a, pair->b) ||
            cells_coincide(plan, shell, pair))
            group_join(joined, pair->a, pair->b);
    }
    number_groups(plan, joined, first);
}

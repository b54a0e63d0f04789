// Cells that intersect or coincide at the start have no side on which to keep each other. Such a pair is ignored until
// it has separated; then it is in contact as usual, and each of its cells is always in contact with all other cells. So
// a pair that never crossed is protected, whatever else its cells cross.
//
// The pairs (a, b), a <= b, are stored by a: those of cell a are initial_other[initial_first[a]] up to
// initial_other[initial_first[a + 1]].
#include "collision/narrow_phase.h"
#include "collision/broad_grid.h"
#include "shell/cross.h"

#include <string.h>

/// Marks an entry of initial_other, which is a cell's number: there are fewer than 2^31.
#define KEPT (1u << 31)

/// Whether two cells cross or, if they are not connected, coincide within rounding.
static bool pair_intersects(const CollisionPlan *plan, const Shell *shell, const CollisionPair *pair) {
    const CollisionBox *p = &plan->boxes[pair->a], *q = &plan->boxes[pair->b];
    const float(*x)[4] = (const float(*)[4])plan->position;
    if (!quads_meet(p->low, p->high, q->low, q->high)) return false;
    if (cross_cells(shell, x, pair->a, pair->b)) return true;
    if (pair->bridge != SHELL_NONE) return false;

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

void initial_mark(CollisionPlan *plan) {
    CollisionCounters *counters = &plan->counters;

    // flag the cells of all pairs
    memset(plan->intersecting, 0, plan->cell_count);
    for (uint32_t a = 0; a < plan->cell_count; a++)
        for (uint32_t k = plan->initial_first[a]; k < plan->initial_first[a + 1]; k++)
            plan->intersecting[a] = plan->intersecting[plan->initial_other[k]] = 1;

    // count them
    counters->intersecting = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++)
        if (plan->intersecting[c] && counters->intersecting++ == 0) counters->intersecting_first = c;
}

bool initial_reserve(Memory *memory, CollisionPlan *plan, uint32_t count) {
    FREE(memory, plan->initial_other, plan->initial_capacity);
    FREE(memory, plan->kept.initial_other, plan->initial_capacity);
    plan->initial_capacity = 0;
    if (count == 0) return true;
    if (!NEW(memory, plan->initial_other, count)) return false;
    if (!NEW(memory, plan->kept.initial_other, count)) {
        FREE(memory, plan->initial_other, count);
        return false;
    }

    plan->initial_capacity = count;
    return true;
}

SingeResult initial_find(Memory *memory, CollisionPlan *plan, const Shell *shell, bool first) {
    if (!first && plan->counters.intersecting == 0) return SINGE_OK;
    uint32_t *cell_first = plan->initial_first;

    // the first search lists all pairs that intersect. plan->active is free until CCD, and marks them
    if (first) {
        uint32_t count = 0;

        // find them, and count those of each cell
        memset(cell_first, 0, ((size_t)plan->cell_count + 2) * sizeof *cell_first);
        for (uint32_t k = 0; k < plan->pair_count; k++) {
            const CollisionPair *pair = &plan->pairs[k];
            plan->active[k] = pair_intersects(plan, shell, pair);
            if (!plan->active[k]) continue;

            cell_first[pair->a + 2]++;
            count++;
        }

        if (!initial_reserve(memory, plan, count)) {
            memset(cell_first, 0, ((size_t)plan->cell_count + 2) * sizeof *cell_first);
            return SINGE_ERROR_MEMORY;
        }

        // sort them by their first cell; cell_first[a + 1] is where the next of cell a goes
        for (uint32_t c = 0; c < plan->cell_count; c++) cell_first[c + 2] += cell_first[c + 1];
        for (uint32_t k = 0; k < plan->pair_count; k++)
            if (plan->active[k]) plan->initial_other[cell_first[plan->pairs[k].a + 1]++] = plan->pairs[k].b;
    } else {
        uint32_t kept = 0, begin = 0;

        // a later one keeps those that still intersect, in their order. Pairs that the search has not listed have
        // separated
        for (uint32_t k = 0; k < plan->pair_count; k++) {
            const CollisionPair *pair = &plan->pairs[k];
            const uint32_t at = initial_index(plan, pair->a, pair->b);
            if (at != SHELL_NONE && pair_intersects(plan, shell, pair)) plan->initial_other[at] |= KEPT;
        }

        // close the gaps
        for (uint32_t a = 0; a < plan->cell_count; a++) {
            const uint32_t end = cell_first[a + 1];
            for (uint32_t k = begin; k < end; k++)
                if (plan->initial_other[k] & KEPT) plan->initial_other[kept++] = plan->initial_other[k] & ~KEPT;
            begin = end;
            cell_first[a + 1] = kept;
        }
    }

    initial_mark(plan);
    return SINGE_OK;
}

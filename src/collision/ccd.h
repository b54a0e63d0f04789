// What the files of the guard share: ccd.c has the whole, ccd_pairs.c what meets, ccd_zones.c what is done
// about it.
#ifndef COLLISION_CCD_H
#define COLLISION_CCD_H

#include "collision/collision_plan.h"

typedef struct Guard {
    TouchPlan *plan;
    const Shell *shell;
    DynamicsState *dynamics;
    const uint8_t *cell_flags;
    float time; ///< s since the search
    uint64_t looked; ///< pairs, in all rounds but the first
} Guard;

static inline bool guard_is_alive(const Guard *guard, uint32_t c) { return guard->cell_flags[c] & SINGE_ALIVE; }

/// Forgets what has changed; marks a cell, or those around a vertex, as changed.
void guard_forget_changed(TouchPlan *plan);
void guard_mark_changed(const Guard *guard, uint32_t cell);
void guard_mark_around(const Guard *guard, uint32_t v);

/// Nodes of a cell on their way through the step.
typedef struct Swept {
    Quad place[5], way[5], low[5], high[5]; ///< of nodes
    TouchBoxes boxes;
} Swept;

/// Nodes of the pair's cells, in a frame that goes with the first corner of a.
void guard_sweep_cells(const Guard *guard, const TouchPair *pair, Swept *a, Swept *b);

/// Looks at pairs from `first` on, or at the `count` ones of plan->active: where two meet, notes after what share of
/// the step's way, and what meets. Lists them in plan->active; returns how many.
uint32_t guard_meet(const Guard *guard, Pool *pool, uint32_t first);
uint32_t guard_meet_active(const Guard *guard, Pool *pool, uint32_t count);

/// Impacts of all pairs that meet, one after another.
void guard_impacts(const Guard *guard);

/// Joins pairs that meet into zones, in the round of this number, and moves these.
void guard_zones(const Guard *guard, int round);

#endif

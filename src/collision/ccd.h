// Shared declarations of continuous collision detection: ccd.c is the algorithm, ccd_pairs.c finds collisions,
// ccd_zones.c resolves them.
#pragma once

#include "collision/collision_plan.h"

typedef struct Ccd {
    Memory *memory;
    CollisionPlan *plan;
    const Shell *shell;
    DynamicsState *dynamics;
    const uint8_t *cell_flags;
    float time;      ///< s since the search
    uint64_t looked; ///< pairs, in all rounds but the first
    bool changed;    ///< only cells that have changed are measured
} Ccd;

static inline bool ccd_is_alive(const Ccd *ccd, uint32_t c) { return ccd->cell_flags[c] & SINGE_ALIVE; }

/// Forgets all changed cells; marks a cell, or those around a vertex, as changed.
void ccd_forget_changed(CollisionPlan *plan);
void ccd_mark_changed(const Ccd *ccd, uint32_t cell);
void ccd_mark_around(const Ccd *ccd, uint32_t v);

/// Nodes of a cell on their displacement through the step.
typedef struct Swept {
    Float4 position[5], displacement[5]; ///< of nodes
    Float4 low[5], high[5];              ///< boxes around what they pass over (ccd_pairs.c)
    FourBoxes triangles, sides, spokes;
} Swept;

/// Nodes of the pair's cells, in a frame that moves with the first corner of a.
void ccd_sweep_cells(const Ccd *ccd, const CollisionPair *pair, Swept *a, Swept *b);

/// Whether the work of the step has reached its bound.
static inline bool ccd_is_spent(const CollisionPlan *plan) { return plan->work > plan->work_max; }

/// Checks pairs from `first` on, or the `count` ones of plan->active: where two collide, stores after what share of the
/// step's displacement, and which features. Lists them in plan->active; returns how many, or 0 if the work is spent.
uint32_t ccd_meet(const Ccd *ccd, Pool *pool, uint32_t first);
uint32_t ccd_meet_active(const Ccd *ccd, Pool *pool, uint32_t count);

/// Impacts of all pairs that collide, one after another.
void ccd_impacts(const Ccd *ccd);

/// Joins pairs that collide into zones, in the iteration of this number, and moves these.
void ccd_zones(const Ccd *ccd, int round);

/// Moves all cells as one zone that keeps nothing of its displacements but their mean.
void ccd_halt(const Ccd *ccd);

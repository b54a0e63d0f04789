// What projects the springs of a substep: strands (strand/strand_solver.c), or one of the paper's methods
// (paper_solver.c). A step has one path, in dynamics.c, and asks the plan's solver for the parts that differ. Nothing
// outside src/dynamics includes this.
#pragma once

#include "dynamics/dynamics.h"

/// A substep after its prediction.
typedef struct Substep {
    const Shell *shell;
    const StateInput *state;
    Pool *pool;
    uint32_t collider_count; ///< in plan->colliders
    float h;                 ///< s
    DynamicsState *dynamics; ///< at x~, v~
    DynamicsCounters *counters;
    SingeError *error;
} Substep;

/// All but `project` may be NULL: then there is nothing to do.
typedef struct Solver {
    /// What the method needs, in the plan. False when out of memory; `release` frees what is there then, too.
    bool (*create)(Memory *memory, const Shell *shell, DynamicsPlan *plan);
    void (*release)(Memory *memory, const Shell *shell, DynamicsPlan *plan);

    /// Once a step: weights and target lengths.
    void (*prepare)(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                    const DynamicsState *dynamics);

    /// Projects a substep: springs, heights of centres, contact.
    SingeResult (*project)(DynamicsPlan *plan, const Substep *substep);

    /// Once a step: the springs' forces, from which sheets tear (plan->patches.pull). NULL: sheets do not tear.
    void (*gather)(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h);

    /// After the substeps: shortens what is left far too long. True if it has found any. NULL: it is shown as it is.
    bool (*limit)(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool, DynamicsState *dynamics);

    /// Contact of particles with colliders, eq 13 and attachments are left to the pass between two projections (move.c);
    /// otherwise `project` ends with v^.
    bool leaves_closing;

    /// A violent step may be taken in parts (collision_parts). The paper's methods take it whole, as the paper does.
    bool takes_parts;
} Solver;

extern const Solver strand_solver, paper_solver;

/// Which solver each method has: ROW(method, solver).
#define SOLVERS(ROW)                              \
    ROW(SINGE_SOLVER_STRAND, strand_solver)       \
    ROW(SINGE_SOLVER_PAPER, paper_solver)         \
    ROW(SINGE_SOLVER_PAPER_LITERAL, paper_solver) \
    ROW(SINGE_SOLVER_ALL_AT_ONCE, paper_solver)   \
    ROW(SINGE_SOLVER_MASS_SPRING, paper_solver)

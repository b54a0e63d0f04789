// The solvers other than strands: the paper's (eq 16 to 19, section 7.1), also literally and in one system, and the
// mass-spring model of section 8. All run on a Network, in double precision. Nothing outside src/dynamics includes
// this.
#ifndef DYNAMICS_PAPER_SOLVER_H
#define DYNAMICS_PAPER_SOLVER_H

#include "reference/spring_network.h"
#include "dynamics/dynamics_plan.h"

static inline bool paper_needed(SingeSolverMethod method) { return method != SINGE_SOLVER_STRAND; }

/// Only for the methods that need it. On failure (out of memory) *paper is NULL.
SingeResult paper_create(Memory *memory, const Shell *shell, const DynamicsSettings *settings, Paper **paper);
void paper_free(Memory *memory, Paper *paper);

/// Masses, weights and target lengths of a step; after dynamics_prepare.
void paper_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool);

/// From x~, v~ to x^, v^ in a substep of h seconds: eq 12, 13 and 18, with contacts in each projection.
SingeResult paper_project(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, uint32_t collider_count,
                          Pool *pool, float h, DynamicsState *dynamics, DynamicsCounters *counters, SingeError *error);

#endif

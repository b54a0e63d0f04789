// The sheets of the comparisons of `singe paper`, through the public headers only.
#pragma once

#include "singe/singe.h"

typedef enum PaperState {
    PAPER_SWING, ///< 1 m x 1 m of 0.1 kg/m2, 1 mm thick, held at two corners, released from level; no drag or damping
    /// the same sheet free in space, burning everywhere at one rate until lengths are 0.8 of their initial values
    PAPER_SHRINK,
    PAPER_STATE_COUNT
} PaperState;

extern const char *const paper_state_names[PAPER_STATE_COUNT];

/// The time step of Table 2, s.
static const float PAPER_TIME_STEP = 0.002f;

/// A committed sheet of cells x cells. Errors are in *error.
SINGE_NODISCARD SingeResult paper_sim(PaperState state, int cells, const SingeSolverDef *solver, int threads,
                                      SingeSim **sim, SingeError *error);

/// The springs of a sheet as a network at its current positions, or at those after eq 8 and 9. The sets are the colours
/// red, green, blue, yellow; with `one_set` all springs are one set, whose conjugate gradients end after as many
/// iterations as there are unknowns. Others end after `cap` iterations, if it is not 0.
SINGE_NODISCARD SingeResult paper_network(const SingeSim *sim, PaperState state, bool one_set, double regularisation,
                                          int cap, SingeNetwork **network, SingeError *error);

/// |C| of the four colours, and their sum; `sets` is 4, or 1 for a network of one set, which is the sum.
double paper_errors(const SingeNetwork *network, uint32_t sets, double *errors);

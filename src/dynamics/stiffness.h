// Compliances that give a sheet its material's stiffness for any cells and step (docs/equations/stiffness.md).
#pragma once

#include "shell/shell.h"

/// Max substeps per step that are asked for here.
enum { STIFFNESS_MAX = 1000 };

/// The springs of a colour for the solver.
typedef struct Stiffness {
    const Shell *shell;
    SingeColour colour;
    uint32_t (*braces)[2]; ///< ends of braces, whose springs these are then; NULL: the colour's
    bool isotropic;        ///< green springs share bending with braces
    float softness;        ///< s2, of the solver itself; over a particle's mass it is a compliance
    float red_softness[2]; ///< s2, that of red springs in transverse shear, and in twist
    uint32_t sheet;        ///< of the last spring asked for
    float mass;            ///< kg, of its particles
    float own;             ///< m/N, of its springs without any compliance
} Stiffness;

/// What the projections of a step give of the springs' forces, in the mean: starts, which the first has none of, the rest.
static inline float stiffness_given(const SingeSolverDef *solver) {
    return 1 - solver->start * (float)(solver->substeps - 1) / (float)solver->substeps;
}

/// For substeps of h seconds, or 0 for a solver without a numerical compliance.
void stiffness_begin(const Shell *shell, SingeColour colour, float h, const SingeSolverDef *solver,
                     Stiffness *stiffness);

/// Compliance of a spring, m/N.
float stiffness_compliance(Stiffness *stiffness, uint32_t spring);

/// The smallest number of substeps in a step of h seconds for which sheets carry what a plume asks of them.
int stiffness_carrying(const Shell *shell, float h);

/// The smallest number, at least that, for which all red springs of this regularisation can be as stiff as they should.
int stiffness_substeps(const Shell *shell, float h, float regularisation);

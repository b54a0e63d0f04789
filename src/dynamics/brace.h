// Springs between centres across vertices, with which bending is isotropic (brace.c).
#pragma once

#include "dynamics/dynamics.h"
#include "dynamics/strand/strand_lanes.h"

typedef struct Braces {
    SpringSet springs;
    uint32_t (*green)[4]; ///< [springs.count] the green springs around the vertex that each crosses
    StrandSet set;
} Braces;

/// All but compliances. False when out of memory; braces_free frees what is there then, too.
bool braces_create(Memory *memory, const Shell *shell, Braces *braces);
void braces_free(Memory *memory, Braces *braces);

/// Once a step: weights and target lengths.
void braces_prepare(Braces *braces, const DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                    const DynamicsState *dynamics);

/// Whether the sheet is whole around its vertex.
bool brace_is_there(const Braces *braces, const AblateState *ablate, uint32_t brace);

/// m, of the present masses and creases.
float brace_length(const Braces *braces, const DynamicsPlan *plan, const Shell *shell, const StateInput *state,
                   const DynamicsState *dynamics, uint32_t brace);

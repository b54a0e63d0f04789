// Energy of the springs: W C^2/(2 c), with eq 10's C over the length of its gradient, c what a spring gives in all, the
// material's compliance or, where the solver is softer, its own (stiffness.c). A spring without compliance stores none.
#include "dynamics/dynamics_plan.h"
#include "dynamics/stiffness.h"

#include <math.h>

typedef struct Elastic {
    const DynamicsPlan *plan;
    const float (*position)[4];
    Field weight;
    Stiffness stiffness;
} Elastic;

static double spring_energy(Elastic *elastic, const uint32_t *ends, uint32_t spring, double length) {
    const float(*x)[4] = elastic->position;
    const Float3 d = float3_sub(float3_load(x[ends[1]]), float3_load(x[ends[0]]));
    const double square = (double)float3_dot(d, d);
    const double c = (double)stiffness_compliance(&elastic->stiffness, spring) + (double)elastic->stiffness.own;
    if (!(square > 0 && c > 0)) return 0;
    const double longer = (square - length * length) / (2 * sqrt(square));
    return (double)dynamics_weight(elastic->weight, elastic->plan->soft, ends[0], ends[1]) * longer * longer / (2 * c);
}

double dynamics_elastic_energy(const DynamicsPlan *plan, const Shell *shell, const State *state) {
    const SingeSolverDef *solver = &plan->settings.solver;
    const bool strands = solver->method == SINGE_SOLVER_STRAND;
    const float h = strands ? plan->settings.time_step / (float)solver->substeps : 0;
    Elastic elastic = {.plan = plan, .position = (const float(*)[4])state->dynamics.position};
    double energy = 0;

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        const Field material = shell->matter.compliance[colour];
        if (material.mask == 0 && !(field_at(material, 0) > 0)) continue; // rigid

        elastic.weight = shell->matter.weight[colour];
        stiffness_begin(shell, (SingeColour)colour, h, solver, &elastic.stiffness);
        for (uint32_t k = 0; k < springs->count; k++) {
            const uint32_t *ends = springs->ends[k];
            if (!(state->ablate.spring_flags[colour][k] & SINGE_ALIVE)) continue;
            if (!(field_at(material, ends[0]) + field_at(material, ends[1]) > 0)) continue;
            float length = state->burn.spring_length[colour][k];
            if (colour == SINGE_GREEN) length *= crease_factor(plan, shell, STATE_INPUT(state), &state->dynamics, k);
            energy += spring_energy(&elastic, ends, k, (double)length);
        }

        if (colour != SINGE_GREEN || !plan->braces) continue;
        const Braces *braces = plan->braces;
        elastic.stiffness.braces = braces->springs.ends;
        for (uint32_t k = 0; k < braces->springs.count; k++)
            if (brace_is_there(braces, &state->ablate, k))
                energy +=
                    spring_energy(&elastic, braces->springs.ends[k], k,
                                  (double)brace_length(braces, plan, shell, STATE_INPUT(state), &state->dynamics, k));
    }

    return energy;
}

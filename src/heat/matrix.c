// The matrix of the heat equation: rows of conductances, kept in step with what ablation removes.
#include <string.h>

#include "heat/plan.h"

/// Counts entries per row into first[i + 1], or fills them when `fill` holds each row's next place.
static void matrix_scatter(HeatPlan *plan, const Shell *shell, uint32_t *fill) {
    HeatMatrix *matrix = &plan->matrix;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < shell->springs[c].count; k++) {
            uint32_t spring = plan->spring_first[c] + k;
            if (plan->conductance[spring] == 0) continue;
            for (int end = 0; end < 2; end++) {
                uint32_t row = shell->springs[c].ends[k][end];
                if (!fill) {
                    matrix->first[row + 1]++;
                    continue;
                }
                matrix->column[fill[row]] = shell->springs[c].ends[k][!end];
                matrix->spring[fill[row]++] = spring;
            }
        }
}

/// Values of one row. A spring conducts while it and both its ends are alive
/// (bit 0 of their flags). Where an obtuse angle makes a
/// conductance negative, it is safe only in the company of all the others at its ends: it goes with the first of them.
static void matrix_row(HeatPlan *plan, uint32_t row) {
    HeatMatrix *matrix = &plan->matrix;
    float sum = 0;
    for (uint32_t k = matrix->first[row]; k < matrix->first[row + 1]; k++) {
        uint32_t spring = matrix->spring[k], other = matrix->column[k];
        float c = plan->conductance[spring];
        bool conducts = plan->spring_alive[spring] & plan->alive[row] & plan->alive[other] & 1 &&
                        (c >= 0 || (plan->dead[row] == 0 && plan->dead[other] == 0));
        matrix->value[k] = conducts ? c : 0;
        sum += matrix->value[k];
    }
    matrix->sum[row] = sum;
}

/// Rows of a particle and of all its neighbours.
static void matrix_around(HeatPlan *plan, uint32_t row) {
    matrix_row(plan, row);
    for (uint32_t k = plan->matrix.first[row]; k < plan->matrix.first[row + 1]; k++)
        matrix_row(plan, plan->matrix.column[k]);
}

SingeResult heat_matrix_create(Memory *memory, HeatPlan *plan, const Shell *shell) {
    HeatMatrix *matrix = &plan->matrix;
    uint32_t n = plan->particles, *fill;
    if (!NEW(memory, matrix->first, (size_t)n + 1) || !NEW(memory, matrix->sum, n)) return SINGE_ERROR_MEMORY;
    matrix_scatter(plan, shell, NULL);
    for (uint32_t i = 0; i < n; i++) matrix->first[i + 1] += matrix->first[i];
    matrix->entries = matrix->first[n];
    if (!NEW(memory, matrix->column, matrix->entries) || !NEW(memory, matrix->spring, matrix->entries) ||
        !NEW(memory, matrix->value, matrix->entries) || !NEW(memory, fill, n))
        return SINGE_ERROR_MEMORY;
    memcpy(fill, matrix->first, n * sizeof *fill);
    matrix_scatter(plan, shell, fill);
    FREE(memory, fill, n);
    memset(plan->spring_alive, 1, plan->springs);
    for (uint32_t i = 0; i < n; i++) plan->alive[i] = plan->measure[i] > 0 && shell->matter.area[i] > 0;
    for (uint32_t i = 0; i < n; i++) matrix_row(plan, i);
    return SINGE_OK;
}

void heat_matrix_free(Memory *memory, HeatPlan *plan) {
    HeatMatrix *matrix = &plan->matrix;
    FREE(memory, matrix->first, (size_t)plan->particles + 1);
    FREE(memory, matrix->sum, plan->particles);
    FREE(memory, matrix->column, matrix->entries);
    FREE(memory, matrix->spring, matrix->entries);
    FREE(memory, matrix->value, matrix->entries);
}

void heat_matrix_follow(HeatPlan *plan, const Shell *shell, const AblateState *ablate) {
    // flags first, rows after: a row looks at the flags of its neighbours
    for (int pass = 0; pass < 2; pass++) {
        for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
            const uint8_t *flags = ablate->spring_flags[c];
            uint8_t *known = plan->spring_alive + plan->spring_first[c];
            for (uint32_t k = 0; k < shell->springs[c].count; k++) {
                // bit 1 marks a change between the two passes
                if (pass == 0 && (flags[k] & SINGE_ALIVE) != known[k]) {
                    known[k] ^= 1;
                    for (int end = 0; end < 2; end++) plan->dead[shell->springs[c].ends[k][end]] += known[k] ? -1 : 1;
                    known[k] |= 2;
                } else if (pass == 1 && known[k] & 2) {
                    known[k] &= 1;
                    for (int end = 0; end < 2; end++) matrix_around(plan, shell->springs[c].ends[k][end]);
                }
            }
        }
        for (uint32_t i = 0; i < plan->particles; i++) {
            bool alive = ablate->particle_flags[i] & SINGE_ALIVE && plan->measure[i] > 0 && shell->matter.area[i] > 0;
            if (pass == 0 && alive != plan->alive[i]) plan->alive[i] = alive | 2;
            else if (pass == 1 && plan->alive[i] & 2) {
                plan->alive[i] &= 1;
                matrix_around(plan, i);
            }
        }
    }
}

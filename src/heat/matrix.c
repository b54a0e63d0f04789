// The matrix of the heat equation: rows of conductances. Springs and particles are removed and never come back: the
// entries of a removed spring become 0, and the springs themselves need not be stored.
#include <math.h>
#include <string.h>

#include "common/real.h"
#include "heat/heat_plan.h"

/// Counts the entries of every row in `length`, or fills them in if `fill` is set. If tears have given a vertex more
/// springs than its row has room for, the last ones conduct nothing.
static void matrix_scatter(HeatPlan *plan, const Shell *shell, uint32_t *length, bool fill) {
    HeatMatrix *matrix = &plan->matrix;
    matrix->full = false;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < shell->springs[c].count; k++) {
            float conductance = plan->conductance[plan->spring_first[c] + k];
            if (conductance == 0) continue;
            const uint32_t *ends = shell->springs[c].ends[k];
            bool full = fill && (length[ends[0]] >= heat_row_width(matrix, ends[0]) ||
                                 length[ends[1]] >= heat_row_width(matrix, ends[1]));
            matrix->full |= full;
            if (full) continue;
            for (int end = 0; end < 2; end++) {
                uint32_t row = shell->springs[c].ends[k][end], entry = length[row]++;
                if (!fill) continue;
                matrix->column[heat_entry(matrix, row, entry)] = shell->springs[c].ends[k][!end];
                matrix->value[heat_entry(matrix, row, entry)] = conductance;
            }
        }
}

/// Reserves room for tears: a second copy of an edge at every vertex, all springs that a spare vertex may get, and the
/// springs of a cell that conduct nothing until a tear changes their weights.
static void matrix_reserve(const HeatPlan *plan, const Shell *shell, uint32_t *length) {
    enum { SPARE = 16 };
    const float *blue = plan->conductance + plan->spring_first[SINGE_BLUE];
    const float *yellow = plan->conductance + plan->spring_first[SINGE_YELLOW];

    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        if (sheet->spare_count == 0) continue;

        uint32_t ordinary = sheet->vertex_count - sheet->spare_count;
        for (uint32_t v = 0; v < sheet->vertex_count; v++) {
            uint32_t *room = &length[sheet->vertex_first + v];
            if (v < ordinary) ++*room;
            else *room = SPARE;
        }

        if (sheet->material.heat_operator != SINGE_HEAT_SURFACE) continue;
        for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++) {
            const CellSprings *springs = &shell->cell_springs[c];
            if (!heat_operator_may_change(shell, c)) continue;
            for (int k = 0; k < 4; k++)
                length[shell->cells[c][k]] += (blue[springs->blue[k]] == 0) + (blue[springs->blue[(k + 3) & 3]] == 0) +
                                              (yellow[springs->yellow[k & 1]] == 0);
        }
    }
}

/// Gives every entry its row as column; rows past the end get the last row.
static void matrix_fill_up(HeatMatrix *matrix, uint32_t rows) {
    for (uint32_t slice = 0; slice < matrix->slices; slice++)
        for (uint32_t e = matrix->first[slice]; e < matrix->first[slice + 1]; e++) {
            uint32_t row = slice * HEAT_ROWS + (e - matrix->first[slice]) % HEAT_ROWS;
            matrix->column[e] = row < rows ? row : rows - 1;
        }
}

static float matrix_sum(const HeatPlan *plan, uint32_t row) {
    const HeatMatrix *matrix = &plan->matrix;
    float sum = 0;
    for (uint32_t k = 0; k < heat_row_width(matrix, row); k++) sum += matrix->value[heat_entry(matrix, row, k)];
    return sum;
}

/// The inverse of a row's diagonal.
static void matrix_invert(HeatPlan *plan, uint32_t row) {
    HeatMatrix *matrix = &plan->matrix;
    float diagonal = plan->measure[row] + matrix->dt * matrix_sum(plan, row);
    matrix->inverse[row] = diagonal > 0 && plan->alive[row] ? 1 / diagonal : 0;
}

/// Lists the springs that share both ends with another one, in order, or only counts them.
static uint32_t matrix_twins(const HeatPlan *plan, const Shell *shell, HeatTwin *twins) {
    const HeatMatrix *matrix = &plan->matrix;
    uint32_t count = 0;

    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < shell->springs[c].count; k++) {
            const uint32_t *ends = shell->springs[c].ends[k];
            uint32_t spring = plan->spring_first[c] + k;

            // a row has several entries in a column if several springs join the same two particles
            uint32_t own = plan->conductance[spring] != 0, entries = 0;
            for (uint32_t j = 0; j < heat_row_width(matrix, ends[0]); j++)
                entries += matrix->column[heat_entry(matrix, ends[0], j)] == ends[1];
            if (ends[0] == ends[1] || entries == own) continue;
            if (twins) twins[count] = (HeatTwin){spring, plan->conductance[spring]};
            count++;
        }

    return count;
}

/// Marks all springs and particles of the shell as alive, as at the start.
static void matrix_revive(HeatPlan *plan, const Shell *shell) {
    memset(plan->spring_alive, 1, plan->springs);
    for (uint32_t i = 0; i < plan->particles; i++) plan->alive[i] = plan->measure[i] > 0 && shell->matter.area[i] > 0;
}

float heat_matrix_stiffness(const HeatPlan *plan, const Shell *shell) {
    float most = 0;
    for (uint32_t s = 0; s < shell->sheet_count; s++)
        if (shell->sheets[s].material.heat_operator != SINGE_HEAT_SURFACE) return INFINITY;
    for (uint32_t i = 0; i < plan->particles; i++)
        if (plan->alive[i]) most = float_max(most, matrix_sum(plan, i) / plan->measure[i]);
    return most;
}

SingeResult heat_matrix_create(Memory *memory, HeatPlan *plan, const Shell *shell) {
    HeatMatrix *matrix = &plan->matrix;
    uint32_t n = plan->particles, *length = NULL;
    matrix->slices = n / HEAT_ROWS + (n % HEAT_ROWS > 0);

    // count the entries of each row; a slice is as wide as its longest row
    bool ok = NEW(memory, matrix->first, (size_t)matrix->slices + 1) && NEW(memory, matrix->inverse, n) &&
              NEW(memory, length, n);
    if (ok) {
        matrix_scatter(plan, shell, length, false);
        matrix_reserve(plan, shell, length);

        for (uint32_t slice = 0; slice < matrix->slices; slice++) {
            uint32_t widest = 0;
            for (uint32_t i = slice * HEAT_ROWS; i < n && i < (slice + 1) * HEAT_ROWS; i++)
                widest = length[i] > widest ? length[i] : widest;
            matrix->first[slice + 1] = matrix->first[slice] + HEAT_ROWS * widest;
        }

        matrix->entries = matrix->first[matrix->slices];
        ok = NEW(memory, matrix->column, matrix->entries) && NEW(memory, matrix->value, matrix->entries);
    }

    // fill in the entries
    if (ok) {
        memset(length, 0, n * sizeof *length);
        matrix_fill_up(matrix, n);
        matrix_scatter(plan, shell, length, true);
    }

    FREE(memory, length, n);
    if (!ok) return SINGE_ERROR_MEMORY;

    // pairs of springs between the same two particles
    matrix_revive(plan, shell);
    matrix->twin_count = matrix->twin_capacity = matrix_twins(plan, shell, NULL);
    if (!NEW(memory, matrix->twins, matrix->twin_count)) return SINGE_ERROR_MEMORY;

    matrix_twins(plan, shell, matrix->twins);
    return SINGE_OK;
}

void heat_matrix_rebuild(HeatPlan *plan, const Shell *shell, uint32_t *length) {
    HeatMatrix *matrix = &plan->matrix;
    memset(length, 0, plan->particles * sizeof *length);
    memset(matrix->value, 0, matrix->entries * sizeof *matrix->value);
    matrix_fill_up(matrix, plan->particles);
    matrix_scatter(plan, shell, length, true);
    matrix_revive(plan, shell);
    matrix->dt = 0;                         // all diagonals are computed again
    if (matrix->twin_capacity == 0) return; // separating cells makes no twins

    matrix->twin_count = matrix_twins(plan, shell, NULL);
    if (matrix->twin_count > matrix->twin_capacity) matrix->twin_count = 0;
    else matrix_twins(plan, shell, matrix->twins);
}

/// Inserts a number into a list in ascending order, unless it is there.
static uint32_t matrix_insert(uint32_t *list, uint32_t count, uint32_t number) {
    uint32_t k = count;
    while (k > 0 && list[k - 1] > number) k--;
    if (k > 0 && list[k - 1] == number) return count;
    memmove(list + k + 1, list + k, (count - k) * sizeof *list);
    list[k] = number;
    return count + 1;
}

bool heat_matrix_row(HeatPlan *plan, const Shell *shell, uint32_t row, uint32_t *list) {
    HeatMatrix *matrix = &plan->matrix;
    const uint32_t *first = plan->spring_first;
    uint32_t count = 0, width = heat_row_width(matrix, row), filled = 0;

    // a centre: red and green springs of its cell
    if (row >= shell->vertex_count) {
        const CellSprings *springs = &shell->cell_springs[row - shell->vertex_count];
        for (int k = 0; k < 4; k++) {
            count = matrix_insert(list, count, first[SINGE_RED] + springs->red[k]);
            if (springs->green[k] != SHELL_NONE)
                count = matrix_insert(list, count, first[SINGE_GREEN] + springs->green[k]);
        }
    } else {
        // a vertex: the springs at its corner in each cell of its fan
        for (uint32_t f = shell->fan_first[row]; f < shell->fan_first[row + 1]; f++) {
            const CellSprings *springs = &shell->cell_springs[shell->fan[f]];
            int i = 0;
            while (shell->cells[shell->fan[f]][i] != row) i++;
            count = matrix_insert(list, count, first[SINGE_RED] + springs->red[i]);
            count = matrix_insert(list, count, first[SINGE_YELLOW] + springs->yellow[i & 1]);
            count = matrix_insert(list, count, first[SINGE_BLUE] + springs->blue[i]);
            count = matrix_insert(list, count, first[SINGE_BLUE] + springs->blue[(i + 3) & 3]);
        }
    }

    // their conductances
    for (uint32_t k = 0; k < count; k++) {
        float conductance = plan->conductance[list[k]];
        if (conductance == 0) continue;
        if (filled == width) return false;

        int colour = 0;
        while (list[k] >= plan->spring_first[colour + 1]) colour++;

        const uint32_t *ends = shell->springs[colour].ends[list[k] - plan->spring_first[colour]];
        uint32_t other = ends[ends[0] == row], entry = heat_entry(matrix, row, filled++);
        bool conducts = plan->spring_alive[list[k]] && plan->alive[row] && plan->alive[other];
        matrix->column[entry] = other;
        matrix->value[entry] = conducts ? conductance : 0;
    }

    // the rest of the row is padding
    for (; filled < width; filled++) {
        uint32_t entry = heat_entry(matrix, row, filled);
        matrix->column[entry] = row;
        matrix->value[entry] = 0;
    }

    matrix_invert(plan, row);
    return true;
}

void heat_matrix_free(Memory *memory, HeatPlan *plan) {
    HeatMatrix *matrix = &plan->matrix;
    FREE(memory, matrix->first, (size_t)matrix->slices + 1);
    FREE(memory, matrix->inverse, plan->particles);
    FREE(memory, matrix->column, matrix->entries);
    FREE(memory, matrix->value, matrix->entries);
    FREE(memory, matrix->twins, matrix->twin_capacity);
}

/// Clears the two entries of a spring that is gone. Twins are distinguished by their values; equal ones need not be.
static void matrix_lose_spring(HeatPlan *plan, const uint32_t ends[2], uint32_t spring) {
    HeatMatrix *matrix = &plan->matrix;
    plan->spring_alive[spring] = 0;
    if (ends[0] == ends[1]) return; // a spare one

    // the spring among the twins, if it is one
    uint32_t low = 0, high = matrix->twin_count;
    while (low < high) {
        uint32_t mid = low + (high - low) / 2;
        if (matrix->twins[mid].spring < spring) low = mid + 1;
        else high = mid;
    }

    bool is_twin = low < matrix->twin_count && matrix->twins[low].spring == spring;

    for (int end = 0; end < 2; end++) {
        uint32_t row = ends[end], width = heat_row_width(matrix, row);
        for (uint32_t k = 0; k < width; k++) {
            uint32_t entry = heat_entry(matrix, row, k);
            if (matrix->column[entry] != ends[!end]) continue;
            if (is_twin && matrix->value[entry] != matrix->twins[low].conductance) continue;
            matrix->value[entry] = 0;
            break;
        }
    }

    for (int end = 0; end < 2; end++) matrix_invert(plan, ends[end]);
}

/// Whether any of particles [first, last) has died since.
static bool matrix_lost_any(const uint8_t *known, const uint8_t *flags, uint32_t first, uint32_t last) {
    uint8_t lost = 0;
    for (uint32_t i = first; i < last; i++) lost |= known[i] & (flags[i] ^ SINGE_ALIVE);
    return lost & SINGE_ALIVE;
}

void heat_matrix_follow(HeatPlan *plan, const Shell *shell, const AblateState *ablate, float dt) {
    enum { LOOK = 1024 }; // compared at once, as a loss is rare
    HeatMatrix *matrix = &plan->matrix;
    uint32_t count = plan->particles, last;

    if (matrix->dt != dt) { // the first step, or a step of another length
        matrix->dt = dt;
        for (uint32_t i = 0; i < count; i++) matrix_invert(plan, i);
    }

    // particles that are gone since the last step
    for (uint32_t first = 0; first < count; first = last) {
        last = count - first < LOOK ? count : first + LOOK;
        if (!matrix_lost_any(plan->alive, ablate->particle_flags, first, last)) continue;

        for (uint32_t i = first; i < last; i++) {
            if (!plan->alive[i] || ablate->particle_flags[i] & SINGE_ALIVE) continue;
            plan->alive[i] = 0;

            // clear all its remaining entries
            for (uint32_t k = 0; k < heat_row_width(matrix, i); k++) {
                uint32_t entry = heat_entry(matrix, i, k), other = matrix->column[entry];
                matrix->value[entry] = 0;
                for (uint32_t j = 0; j < heat_row_width(matrix, other); j++) {
                    uint32_t back = heat_entry(matrix, other, j);
                    if (matrix->column[back] == i) matrix->value[back] = 0;
                }

                matrix_invert(plan, other);
            }

            matrix_invert(plan, i);
        }
    }

    // springs that are gone
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        const uint8_t *flags = ablate->spring_flags[c], *known = plan->spring_alive + plan->spring_first[c];
        count = shell->springs[c].count;
        for (uint32_t first = 0; first < count; first = last) {
            last = count - first < LOOK ? count : first + LOOK;
            if (!matrix_lost_any(known, flags, first, last)) continue;
            for (uint32_t k = first; k < last; k++)
                if (known[k] && !(flags[k] & SINGE_ALIVE))
                    matrix_lose_spring(plan, shell->springs[c].ends[k], plan->spring_first[c] + k);
        }
    }
}

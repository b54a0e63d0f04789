// Memory of the stage.
#include "heat/heat_plan.h"

/// More is an error in the material: on cells of a millimetre its front would be a nanometre thick.
static const float PLAN_THICKENING_MAX = 1e6f;
/// m2/s; times a step and a temperature it still fits a float.
static const float PLAN_CONDUCTANCE_MAX = 1e20f;

/// Computes F of every sheet from the means of its parameters; fails if a material needs more than
/// PLAN_THICKENING_MAX.
static SingeResult plan_thicken(HeatPlan *plan, const Shell *shell, SingeError *error) {
    const Matter *matter = &shell->matter;
    for (uint32_t s = 0; s < plan->sheets; s++) {
        const Sheet *sheet = &shell->sheets[s];
        double diffusivity = 0, rate = 0, heating = 0, ignition = 0, ceiling = 0, factor = 0, energy = 0, count = 0;
        for (uint32_t i = 0; i < shell->particle_count; i++) {
            if (matter->sheet[i] != s || !(matter->area[i] > 0)) continue;

            diffusivity += field_at(matter->diffusivity, i);
            rate += field_at(matter->mass_rate, i);
            heating += field_at(matter->heating, i);
            ignition += field_at(matter->ignition_temperature, i);
            ceiling += field_at(matter->rate_ceiling, i);
            factor += field_at(matter->pre_exponential, i);
            energy += field_at(matter->activation_energy, i);
            count++;
        }

        plan->thickening[s] = 1;
        if (count == 0) continue;

        FrontMatter front = {(float)(diffusivity / count), (float)(rate / count),    (float)(heating / count),
                             (float)(ignition / count),    (float)(ceiling / count), (float)(factor / count),
                             (float)(energy / count)};
        plan->thickening[s] = heat_thickening_for(sheet->material.thickening, &front,
                                                  plan->settings.ambient_temperature, sheet->cell_size);

        bool by_hand = sheet->material.thickening > 0;
        if (!by_hand && !(plan->thickening[s] <= PLAN_THICKENING_MAX))
            return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1,
                             "sheet '%s': its fire's front is more than 1000000 times thinner than a cell; lower "
                             "mass_rate, raise diffusivity or set thickening",
                             sheet->name);
    }

    return SINGE_OK;
}

SingeResult heat_plan_create(Memory *memory, const Shell *shell, const HeatSettings *settings, HeatPlan **out,
                             SingeError *error) {
    *out = NULL;
    HeatPlan *plan;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;

    plan->settings = *settings;
    plan->particles = shell->particle_count;
    plan->sheets = shell->sheet_count;
    plan->blocks = pool_blocks((int)shell->particle_count);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        plan->spring_first[c + 1] = plan->spring_first[c] + shell->springs[c].count;
    plan->springs = plan->spring_first[SINGE_COLOUR_COUNT];

    // arrays; those of the scratch are read in whole slices
    float **arrays[] = {&plan->flux,
                        &plan->source_conductance,
                        &plan->source_temperature,
                        &plan->star,
                        &plan->delta,
                        &plan->correction,
                        &plan->residual,
                        &plan->search,
                        &plan->product,
                        &plan->next};
    enum { ARRAYS = sizeof arrays / sizeof *arrays };
    size_t n = plan->particles, stride = (n / HEAT_ROWS + 1) * HEAT_ROWS;
    size_t needed = ARRAYS * stride * sizeof(float), min = settings->scratch_min;
    plan->scratch_size = needed > min ? needed : min;
    if (!NEW(memory, plan->thickening, plan->sheets) || !NEW(memory, plan->measure, n) ||
        !NEW(memory, plan->conductance, plan->springs) || !NEW(memory, plan->spring_alive, plan->springs) ||
        !NEW(memory, plan->alive, n) || !(plan->scratch = memory_new(memory, plan->scratch_size, 1)) ||
        !NEW(memory, plan->partial, (size_t)plan->blocks) || !NEW(memory, plan->weight, plan->sheets)) {
        heat_plan_free(memory, plan);
        return SINGE_ERROR_MEMORY;
    }

    for (size_t k = 0; k < ARRAYS; k++) *arrays[k] = (float *)plan->scratch + k * stride;
    plan->put_out = plan->product; // until conduction

    // thickening, then conductances, which must stay finite in a step
    SingeResult result = plan_thicken(plan, shell, error);
    if (!result) heat_operator(plan, shell, NULL);
    for (uint32_t s = 0; s < shell->sheet_count; s++)
        plan->live |= shell->sheets[s].material.heat_operator == SINGE_HEAT_UMBRELLA_LIVE;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < shell->springs[c].count && !result; k++)
            if (!(plan->conductance[plan->spring_first[c] + k] <= PLAN_CONDUCTANCE_MAX))
                result = error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1,
                                   "sheet '%s': its diffusivity, or its layer_exchange, is too large for its cells and "
                                   "thickening",
                                   shell->sheets[shell->matter.sheet[shell->springs[c].ends[k][0]]].name);

    // the matrix; after it only tears and `live` need the conductances
    if (!result) {
        result = heat_matrix_create(memory, plan, shell);
        if (!result) plan->stiffness = heat_matrix_stiffness(plan, shell);
        if (shell->spare_count == 0 && !plan->live) FREE(memory, plan->conductance, plan->springs);
        if (!result) result = heat_rest_create(memory, plan);
        if (!result) result = smother_create(memory, shell, &plan->smother);
    }

    if (result) heat_plan_free(memory, plan);
    else *out = plan;
    return result;
}

/// Follows a few splits by local updates, which give the same as a full rebuild, to the bit (heat_torn). False if that
/// is not possible.
static bool follow_splits(HeatPlan *plan, const Shell *shell, const StateInput *state, uint32_t first) {
    const ShellSplit *splits = state->tear->splits;
    uint32_t last = shell->split_count, ordinary = shell->springs[SINGE_BLUE].count - shell->edge_spare_count;

    if (plan->matrix.full || plan->matrix.twin_capacity > 0 || last - first > shell->cell_count / 64 + 1) return false;

    for (uint32_t s = 0; s < shell->sheet_count; s++)
        if (shell->sheets[s].material.heat_operator != SINGE_HEAT_SURFACE) return false;

    // conductances of the cells around the vertices
    for (uint32_t k = 2 * first; k < 2 * last; k++) {
        uint32_t vertex = k & 1 ? splits[k / 2].spare : splits[k / 2].vertex;
        heat_operator_torn_vertex(plan, shell, vertex);

        for (uint32_t f = shell->fan_first[vertex]; f < shell->fan_first[vertex + 1]; f++) {
            uint32_t cell = shell->fan[f];
            heat_operator_torn_cell(plan, shell, cell);

            // a spring that was spare, and counted as gone, is alive; if it is not, heat_matrix_follow will find out
            for (int i = 0; i < 4; i++)
                if (shell->cell_springs[cell].blue[i] >= ordinary)
                    plan->spring_alive[plan->spring_first[SINGE_BLUE] + shell->cell_springs[cell].blue[i]] = 1;
        }

        if (k & 1) plan->alive[vertex] = plan->measure[vertex] > 0;
    }

    // rows of their particles, which may have no room
    for (uint32_t k = 2 * first; k < 2 * last; k++) {
        uint32_t vertex = k & 1 ? splits[k / 2].spare : splits[k / 2].vertex;
        for (uint32_t f = shell->fan_first[vertex]; f < shell->fan_first[vertex + 1]; f++) {
            for (int i = 0; i < 4; i++)
                if (!heat_matrix_row(plan, shell, shell->cells[shell->fan[f]][i], plan->scratch)) return false;
            if (!heat_matrix_row(plan, shell, shell_centre(shell, shell->fan[f]), plan->scratch)) return false;
        }
    }

    // groups that conduct with one another
    for (uint32_t k = 2 * first; k < 2 * last; k++) {
        uint32_t vertex = k & 1 ? splits[k / 2].spare : splits[k / 2].vertex;
        for (uint32_t f = shell->fan_first[vertex]; f < shell->fan_first[vertex + 1]; f++) {
            for (int i = 0; i < 4; i++)
                heat_rest_update(plan, shell->cells[shell->fan[f]][i] / HEAT_GROUP, plan->scratch);
            heat_rest_update(plan, shell_centre(shell, shell->fan[f]) / HEAT_GROUP, plan->scratch);
        }
    }

    return true;
}

void heat_plan_follow(HeatPlan *plan, const Shell *shell, const StateInput *state) {
    uint32_t first = plan->split_count;
    plan->split_count = shell->split_count;
    const bool torn = first != shell->split_count;
    if (!plan->live && (!torn || follow_splits(plan, shell, state, first))) return;

    // rebuild everything; the step's scratch is free, as the step has not begun
    for (uint32_t k = 0; k < plan->springs; k++) plan->conductance[k] = 0;
    for (uint32_t i = 0; i < plan->particles; i++) plan->measure[i] = 0;
    heat_operator(plan, shell, state);
    heat_matrix_rebuild(plan, shell, plan->scratch);
    if (torn) heat_rest_rebuild(plan, plan->scratch);
    for (uint32_t k = 0; plan->live && k < plan->springs; k++)
        plan->spring_alive[k] = plan->conductance[k] > 0; // the others are not in the matrix, to be taken out of it
}

void heat_plan_free(Memory *memory, HeatPlan *plan) {
    if (!plan) return;

    size_t n = plan->particles, springs = plan->springs;
    smother_free(memory, &plan->smother);
    heat_rest_free(memory, plan);
    heat_matrix_free(memory, plan);

    FREE(memory, plan->thickening, plan->sheets);
    FREE(memory, plan->measure, n);
    FREE(memory, plan->conductance, springs);
    FREE(memory, plan->spring_alive, springs);
    FREE(memory, plan->alive, n);
    memory_free(memory, (void *)&plan->scratch, plan->scratch_size, 1);
    FREE(memory, plan->partial, (size_t)plan->blocks);
    FREE(memory, plan->weight, plan->sheets);
    FREE(memory, plan, 1);
}

void *heat_scratch(HeatPlan *plan) { return plan->scratch; }

float heat_thickening(const HeatPlan *plan, uint32_t sheet) { return plan->thickening[sheet]; }

void heat_plan_set_pace(HeatPlan *plan, float pace) { plan->settings.pace = pace; }

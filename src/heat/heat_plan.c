// Memory of the stage.
#include "common/assertion.h"
#include "heat/heat_plan.h"

/// More is an error in the material: on cells of a millimetre its front would be a nanometre thick.
static const float PLAN_THICKENING_MAX = 1e6f;
/// m2/s; times a step and a temperature it still fits a float.
static const float PLAN_CONDUCTANCE_MAX = 1e20f;

/// Means of a sheet's parameters over its particles, for the front thickening.
static float plan_thickening(const Shell *shell, uint32_t s, float ambient) {
    const Sheet *sheet = &shell->sheets[s];
    const Matter *matter = &shell->matter;
    double diffusivity = 0, rate = 0, heating = 0, ignition = 0, ceiling = 0, factor = 0, energy = 0, count = 0;

    // sums over the sheet
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
    if (count == 0) return 1;

    // their means give the front's thickness
    FrontMatter front = {(float)(diffusivity / count), (float)(rate / count),    (float)(heating / count),
                         (float)(ignition / count),    (float)(ceiling / count), (float)(factor / count),
                         (float)(energy / count)};
    return heat_thickening_for(sheet->material.thickening, &front, ambient, sheet->cell_size);
}

static bool plan_allocate_scratch(Memory *memory, HeatPlan *plan) {
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
    size_t slices = plan->particles / HEAT_ROWS + 1, stride = slices * HEAT_ROWS; // whole slices can be read
    size_t needed = ARRAYS * stride * sizeof(float), min = plan->settings.scratch_min;
    plan->scratch_size = needed > min ? needed : min;
    if (!(plan->scratch = memory_new(memory, plan->scratch_size, 1))) return false;
    for (size_t k = 0; k < ARRAYS; k++) *arrays[k] = (float *)plan->scratch + k * stride;
    return true;
}

static bool plan_allocate(Memory *memory, HeatPlan *plan) {
    size_t n = plan->particles, springs = plan->springs;
    return NEW(memory, plan->thickening, plan->sheets) && NEW(memory, plan->measure, n) &&
           NEW(memory, plan->conductance, springs) && NEW(memory, plan->spring_alive, springs) &&
           NEW(memory, plan->alive, n) && plan_allocate_scratch(memory, plan) &&
           NEW(memory, plan->partial, (size_t)plan->blocks);
}

/// Computes F of every sheet; fails if a material needs more than PLAN_THICKENING_MAX.
static SingeResult plan_thicken(HeatPlan *plan, const Shell *shell, SingeError *error) {
    for (uint32_t s = 0; s < plan->sheets; s++) {
        float needed = plan_thickening(shell, s, plan->settings.ambient_temperature);
        bool by_hand = shell->sheets[s].material.thickening > 0;
        if (!by_hand && !(needed <= PLAN_THICKENING_MAX))
            return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1,
                             "sheet '%s': its fire's front is more than 1000000 times thinner than a cell; lower "
                             "mass_rate, raise diffusivity or set thickening",
                             shell->sheets[s].name);
        plan->thickening[s] = needed;
    }
    return SINGE_OK;
}

/// Refuses conductances that would not stay finite in a step.
static SingeResult plan_check(const HeatPlan *plan, const Shell *shell, SingeError *error) {
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < shell->springs[c].count; k++)
            if (!(plan->conductance[plan->spring_first[c] + k] <= PLAN_CONDUCTANCE_MAX))
                return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1,
                                 "sheet '%s': its diffusivity, or its layer_exchange, is too large for its cells and "
                                 "thickening",
                                 shell->sheets[shell->matter.sheet[shell->springs[c].ends[k][0]]].name);
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

    // memory, thickening, conductances, their matrix
    SingeResult result = plan_allocate(memory, plan) ? SINGE_OK : SINGE_ERROR_MEMORY;
    if (!result) {
        result = plan_thicken(plan, shell, error);
    }
    if (!result) {
        heat_operator(plan, shell);
        result = plan_check(plan, shell, error);
    }
    if (!result) {
        result = heat_matrix_create(memory, plan, shell);
        if (shell->spare_count == 0) FREE(memory, plan->conductance, plan->springs);
        if (!result) result = heat_rest_create(memory, plan);
    }
    if (result) heat_plan_free(memory, plan);
    else *out = plan;
    return result;
}

/// Rebuilds operator, matrix and groups. The step's scratch is free, as the step has not begun.
static void plan_rebuild(HeatPlan *plan, const Shell *shell) {
    for (uint32_t k = 0; k < plan->springs; k++) plan->conductance[k] = 0;
    for (uint32_t i = 0; i < plan->particles; i++) plan->measure[i] = 0;
    heat_operator(plan, shell);
    heat_matrix_rebuild(plan, shell, plan->scratch);
    heat_rest_rebuild(plan, plan->scratch);
}

/// Updates the conductances of the cells around a vertex that was split, or is new.
static void follow_operator(HeatPlan *plan, const Shell *shell, uint32_t vertex) {
    SINGE_ASSERT(vertex < shell->vertex_count);
    uint32_t ordinary = shell->springs[SINGE_BLUE].count - shell->edge_spare_count;
    heat_operator_torn_vertex(plan, shell, vertex);
    for (uint32_t f = shell->fan_first[vertex]; f < shell->fan_first[vertex + 1]; f++) {
        uint32_t cell = shell->fan[f];
        heat_operator_torn_cell(plan, shell, cell);
        // a spring that was spare, and counted as gone, is alive; if it is not, heat_matrix_follow will find out
        for (int k = 0; k < 4; k++)
            if (shell->cell_springs[cell].blue[k] >= ordinary)
                plan->spring_alive[plan->spring_first[SINGE_BLUE] + shell->cell_springs[cell].blue[k]] = 1;
    }
}

/// Rewrites the rows of all particles around a vertex. False if one has no room.
static bool follow_rows(HeatPlan *plan, const Shell *shell, uint32_t vertex) {
    SINGE_ASSERT(vertex < shell->vertex_count);
    for (uint32_t f = shell->fan_first[vertex]; f < shell->fan_first[vertex + 1]; f++) {
        for (int k = 0; k < 4; k++)
            if (!heat_matrix_row(plan, shell, shell->cells[shell->fan[f]][k], plan->scratch)) return false;
        if (!heat_matrix_row(plan, shell, shell_centre(shell, shell->fan[f]), plan->scratch)) return false;
    }
    return true;
}

static void follow_rest(HeatPlan *plan, const Shell *shell, uint32_t vertex) {
    SINGE_ASSERT(vertex < shell->vertex_count);
    for (uint32_t f = shell->fan_first[vertex]; f < shell->fan_first[vertex + 1]; f++) {
        for (int k = 0; k < 4; k++) heat_rest_update(plan, shell->cells[shell->fan[f]][k] / HEAT_GROUP, plan->scratch);
        heat_rest_update(plan, shell_centre(shell, shell->fan[f]) / HEAT_GROUP, plan->scratch);
    }
}

/// Follows a few splits by local updates, which give the same as a full rebuild, to the bit (heat_torn). False if that
/// is not possible.
static bool follow_splits(HeatPlan *plan, const Shell *shell, const StateInput *state, uint32_t first) {
    const ShellSplit *splits = state->tear->splits;
    uint32_t last = shell->split_count;
    if (plan->matrix.full || plan->matrix.twin_capacity > 0 || last - first > shell->cell_count / 64 + 1) return false;
    for (uint32_t s = 0; s < shell->sheet_count; s++)
        if (shell->sheets[s].material.heat_operator == SINGE_HEAT_UMBRELLA) return false;
    for (uint32_t k = first; k < last; k++) {
        follow_operator(plan, shell, splits[k].vertex);
        follow_operator(plan, shell, splits[k].spare);
        plan->alive[splits[k].spare] = plan->measure[splits[k].spare] > 0;
    }
    for (uint32_t k = first; k < last; k++)
        if (!follow_rows(plan, shell, splits[k].vertex) || !follow_rows(plan, shell, splits[k].spare)) return false;
    for (uint32_t k = first; k < last; k++) {
        follow_rest(plan, shell, splits[k].vertex);
        follow_rest(plan, shell, splits[k].spare);
    }
    return true;
}

void heat_plan_follow(HeatPlan *plan, const Shell *shell, const StateInput *state) {
    uint32_t first = plan->split_count;
    plan->split_count = shell->split_count;
    if (first < shell->split_count && !follow_splits(plan, shell, state, first)) plan_rebuild(plan, shell);
}

void heat_plan_free(Memory *memory, HeatPlan *plan) {
    if (!plan) return;
    size_t n = plan->particles, springs = plan->springs;
    heat_rest_free(memory, plan);
    heat_matrix_free(memory, plan);
    FREE(memory, plan->thickening, plan->sheets);
    FREE(memory, plan->measure, n);
    FREE(memory, plan->conductance, springs);
    FREE(memory, plan->spring_alive, springs);
    FREE(memory, plan->alive, n);
    memory_free(memory, (void *)&plan->scratch, plan->scratch_size, 1);
    FREE(memory, plan->partial, (size_t)plan->blocks);
    FREE(memory, plan, 1);
}

void *heat_scratch(HeatPlan *plan) { return plan->scratch; }

float heat_thickening(const HeatPlan *plan, uint32_t sheet) { return plan->thickening[sheet]; }

void heat_plan_set_pace(HeatPlan *plan, float pace) { plan->settings.pace = pace; }

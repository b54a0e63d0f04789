// Matter of the particles. A parameter that has one value on all sheets stays one value; where it varies over a
// sheet, or from one to the next, every particle gets its own.
//
//   mass      m = (grammage/2) A [kg], heat capacity = m c_p [J/K]
//
// Each layer carries half of the sheet's mass.
#include "shell/matter.h"

#include <string.h>

/// The Field of a parameter; NULL for those that masses and capacities are made of.
static Field *matter_field(Matter *matter, int param) {
    if (param >= PARAM_COMPLIANCE) return &matter->compliance[param - PARAM_COMPLIANCE];
    if (param >= PARAM_WEIGHT) return &matter->weight[param - PARAM_WEIGHT];
    Field *const fields[PARAM_WEIGHT] = {
        [PARAM_THICKNESS] = &matter->thickness,
        [PARAM_DIFFUSIVITY] = &matter->diffusivity,
        [PARAM_TEMPERATURE] = &matter->temperature,
        [PARAM_IGNITION] = &matter->ignition_temperature,
        [PARAM_HEATING] = &matter->heating,
        [PARAM_MASS_RATE] = &matter->mass_rate,
        [PARAM_ASH_EXPONENT] = &matter->ash_exponent,
        [PARAM_MASS_MIN] = &matter->mass_min,
        [PARAM_MASS_LOSS] = &matter->mass_loss,
        [PARAM_ASH_DENSITY] = &matter->ash_density,
        [PARAM_SHRINK] = &matter->shrink,
        [PARAM_LAYER_EXCHANGE] = &matter->layer_exchange,
        [PARAM_CONVECTION] = &matter->convection,
        [PARAM_EMISSIVITY] = &matter->emissivity,
        [PARAM_LOSS_MASS_FLOOR] = &matter->loss_mass_floor,
        [PARAM_RATE_CEILING] = &matter->rate_ceiling,
        [PARAM_CHAR_WEIGHT] = &matter->char_weight,
        [PARAM_DRAG] = &matter->drag,
        [PARAM_DAMPING] = &matter->damping,
    };
    return fields[param];
}

static bool matter_is_uniform(const SheetSource *sources, uint32_t count, int param) {
    for (uint32_t s = 0; s < count; s++)
        if (sources[s].values[param] || sources[s].value[param] != sources[0].value[param]) return false;
    return true;
}

/// Copies one sheet's values of a parameter to its particles.
static void matter_place(const Shell *shell, const Sheet *sheet, const SheetSource *source, int param, Field *field) {
    uint32_t centre = shell_centre(shell, sheet->cell_first);
    for (uint32_t v = 0; v < sheet->vertex_count; v++)
        field->values[sheet->vertex_first + v] = sheet_param(source, param, v);
    for (uint32_t c = 0; c < sheet->cell_count; c++)
        field->values[centre + c] = sheet_param(source, param, sheet->vertex_count + c);
}

bool matter_create(Memory *memory, Shell *shell, const SheetSource *sources) {
    Matter *matter = &shell->matter;
    uint32_t particles = shell->particle_count, sheets = shell->sheet_count;
    bool weighs_evenly = true;
    for (int p = 0; p < PARAM_COUNT; p++) {
        Field *field = matter_field(matter, p);
        bool uniform = matter_is_uniform(sources, sheets, p);
        if (!field) {
            for (uint32_t s = 0; s < sheets; s++) weighs_evenly &= sources[s].values[p] == NULL;
            continue;
        }
        if (!field_create(memory, field, sources[0].value[p])) return false;
        if (uniform) continue;
        if (!field_vary(memory, field, particles)) return false;
        for (uint32_t s = 0; s < sheets; s++) matter_place(shell, &shell->sheets[s], &sources[s], p, field);
    }
    if (!field_create(memory, &matter->capacity_ratio, 1)) return false;
    if (!weighs_evenly && !field_vary(memory, &matter->capacity_ratio, particles)) return false;
    return NEW(memory, matter->area, particles) && NEW(memory, matter->mass, particles) &&
           NEW(memory, matter->capacity, particles);
}

void matter_free(Memory *memory, Shell *shell) {
    Matter *matter = &shell->matter;
    for (int p = 0; p < PARAM_COUNT; p++) {
        Field *field = matter_field(matter, p);
        if (field) field_free(memory, field, shell->particle_count);
    }
    field_free(memory, &matter->capacity_ratio, shell->particle_count);
    FREE(memory, matter->area, shell->particle_count);
    FREE(memory, matter->mass, shell->particle_count);
    FREE(memory, matter->capacity, shell->particle_count);
}

static double matter_per_area(const SheetSource *source, uint32_t i) {
    return (double)sheet_param(source, PARAM_GRAMMAGE, i) * (double)sheet_param(source, PARAM_SPECIFIC_HEAT, i);
}

static void matter_weigh_sheet(Shell *shell, const Sheet *sheet, const SheetSource *source) {
    Matter *matter = &shell->matter;
    uint32_t total = sheet->vertex_count + sheet->cell_count;
    double sum = 0;
    for (uint32_t i = 0; i < total; i++) sum += matter_per_area(source, i);
    for (uint32_t i = 0; i < total; i++) {
        bool corner = i < sheet->vertex_count;
        uint32_t cell = sheet->cell_first + i - sheet->vertex_count;
        uint32_t p = corner ? sheet->vertex_first + i : shell_centre(shell, cell);
        if (matter->capacity_ratio.mask)
            matter->capacity_ratio.values[p] = (float)(matter_per_area(source, i) / (sum / total));
        matter->mass[p] = sheet_param(source, PARAM_GRAMMAGE, i) / 2 * matter->area[p];
        matter->capacity[p] = matter->mass[p] * sheet_param(source, PARAM_SPECIFIC_HEAT, i);
    }
}

void matter_weigh(Shell *shell, const SheetSource *sources) {
    for (uint32_t s = 0; s < shell->sheet_count; s++) matter_weigh_sheet(shell, &shell->sheets[s], &sources[s]);
}

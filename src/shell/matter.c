// Matter of the particles. A parameter that has one value on all sheets is stored once; if it varies over a sheet or
// between sheets, every particle gets its own value.
//
//   mass      m = (grammage/2) A [kg], heat capacity = m c_p [J/K]
//
// Each layer carries half of the sheet's mass. Some properties of a particle come from several parameters:
//
//   diffusivity, layer exchange,
//   mass rate, char rate = stated value * g_0/g                       g grammage, g_0 that of the stated values
//   heating   eta = s H/c_p [K]                                       H heat of combustion [J/kg], s the share that
//   gas_heat  (1 - s) H [J/kg]                                        stays in the sheet
//   char_heating  H_c/c_p [K]                                         H_c heat of glowing char [J/kg]
//   char_yield    max(nu, m_min)                                      nu <= m_min: no char
//   compliance of green springs   t^2/D - c_blue, if D > 0            D bending stiffness [N m], t thickness
//
// The first four model effects of the gas next to a sheet: heat conducted along it (W/K) and oxygen that reaches it
// (kg/(m2 s K)) are the same next to a thick sheet and a thin one, but the thin one has less mass to heat and burn.
// Losses and sources are fluxes divided by the capacity per area, so they scale by themselves. So every rate changes
// with g in the same proportion: t' = t g_0/g gives the old equations. The front's speed is proportional to 1/g, its
// thickness and temperature are the same.
#include "shell/matter.h"

#include "common/real.h"

/// The Field of a parameter, or of the quantity computed from it (matter_value); NULL for those from which masses and
/// capacities are computed.
static Field *matter_field(Matter *matter, int param) {
    Field *const fields[PARAM_COUNT] = {
#define MATTER(field) &matter->field
#define MATTER_NONE NULL
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) [number] = field,
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text)                                       \
    [number] = &matter->name[0], [number + 1] = &matter->name[1], [number + 2] = &matter->name[2], \
    [number + 3] = &matter->name[3],
#include "singe/material.def"
    };
    return fields[param];
}

/// Whether the particles' values of a parameter differ within the sheet.
static bool matter_varies(const SheetSource *source, int param) {
    float *const *values = source->values;
    switch (param) {
    case PARAM_DIFFUSIVITY:
    case PARAM_LAYER_EXCHANGE:
    case PARAM_MASS_RATE:
    case PARAM_CHAR_RATE:
        return values[param] || (values[PARAM_GRAMMAGE] && source->sheet.material.reference_grammage > 0);
    case PARAM_HEAT_SHARE: return values[param] || values[PARAM_HEAT_OF_COMBUSTION] || values[PARAM_SPECIFIC_HEAT];
    case PARAM_HEAT_OF_COMBUSTION: return values[param] || values[PARAM_HEAT_SHARE];
    case PARAM_CHAR_HEAT: return values[param] || values[PARAM_SPECIFIC_HEAT];
    case PARAM_CHAR_YIELD: return values[param] || values[PARAM_MASS_MIN];
    case PARAM_COMPLIANCE + SINGE_GREEN:
        return values[param] || values[PARAM_BENDING] || values[PARAM_THICKNESS] ||
               values[PARAM_COMPLIANCE + SINGE_BLUE];
    default: return values[param] != NULL;
    }
}

float matter_value(const SheetSource *source, int param, uint32_t i) {
    float value = sheet_param(source, param, i), reference = source->sheet.material.reference_grammage;
    switch (param) {
    case PARAM_DIFFUSIVITY:
    case PARAM_LAYER_EXCHANGE:
    case PARAM_MASS_RATE:
    case PARAM_CHAR_RATE: return reference > 0 ? value * (reference / sheet_param(source, PARAM_GRAMMAGE, i)) : value;
    case PARAM_HEAT_SHARE:
        return value * sheet_param(source, PARAM_HEAT_OF_COMBUSTION, i) / sheet_param(source, PARAM_SPECIFIC_HEAT, i);
    case PARAM_CHAR_HEAT: return value / sheet_param(source, PARAM_SPECIFIC_HEAT, i);
    case PARAM_CHAR_YIELD: return float_max(value, sheet_param(source, PARAM_MASS_MIN, i));
    case PARAM_HEAT_OF_COMBUSTION: return value * (1 - sheet_param(source, PARAM_HEAT_SHARE, i));
    case PARAM_COMPLIANCE + SINGE_GREEN: {
        // both layers are in series: t^2/(c_green + c_blue) is D
        const float bending = sheet_param(source, PARAM_BENDING, i), t = sheet_param(source, PARAM_THICKNESS, i);
        if (!(bending > 0)) return value;
        return float_max(0, t * t / bending - sheet_param(source, PARAM_COMPLIANCE + SINGE_BLUE, i));
    }
    default: return value;
    }
}

bool matter_create(Memory *memory, Shell *shell, const SheetSource *sources) {
    Matter *matter = &shell->matter;
    uint32_t particles = shell->particle_count, sheets = shell->sheet_count;
    bool weighs_evenly = true;

    for (int p = 0; p < PARAM_COUNT; p++) {
        Field *field = matter_field(matter, p);
        if (!field) {
            for (uint32_t s = 0; s < sheets; s++) weighs_evenly &= sources[s].values[p] == NULL;
            continue;
        }

        // one value for all, unless it varies over a sheet or between sheets
        float first = matter_value(&sources[0], p, 0);
        bool uniform = true;
        for (uint32_t s = 0; s < sheets; s++)
            uniform = uniform && !matter_varies(&sources[s], p) && matter_value(&sources[s], p, 0) == first;
        if (!field_create(memory, field, first)) return false;
        if (uniform) continue;
        if (!field_vary(memory, field, particles)) return false;

        for (uint32_t s = 0; s < sheets; s++) {
            const Sheet *sheet = &shell->sheets[s];
            uint32_t centre = shell_centre(shell, sheet->cell_first), vertices = sources[s].sheet.vertex_count;
            for (uint32_t v = 0; v < sheet->vertex_count; v++)
                field->values[sheet->vertex_first + v] = matter_value(&sources[s], p, v < vertices ? v : 0);
            for (uint32_t c = 0; c < sheet->cell_count; c++)
                field->values[centre + c] = matter_value(&sources[s], p, vertices + c);
        }
    }

    // heat capacity: uniform unless mass or specific heat varies
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

void matter_weigh(Shell *shell, const SheetSource *sources) {
    Matter *matter = &shell->matter;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        const SheetSource *source = &sources[s];
        uint32_t vertices = source->sheet.vertex_count, total = vertices + sheet->cell_count;
        double sum = 0;
        for (uint32_t i = 0; i < total; i++) sum += matter_per_area(source, i);

        for (uint32_t i = 0; i < total; i++) {
            uint32_t cell = sheet->cell_first + i - vertices;
            uint32_t p = i < vertices ? sheet->vertex_first + i : shell_centre(shell, cell);
            if (matter->capacity_ratio.mask)
                matter->capacity_ratio.values[p] = (float)(matter_per_area(source, i) / (sum / total));
            matter->mass[p] = sheet_param(source, PARAM_GRAMMAGE, i) / 2 * matter->area[p];
            matter->capacity[p] = matter->mass[p] * sheet_param(source, PARAM_SPECIFIC_HEAT, i);
        }
    }
}

void matter_split(Shell *shell, uint32_t from, uint32_t to, float area) {
    Matter *matter = &shell->matter;
    for (int p = 0; p < PARAM_COUNT; p++) {
        Field *field = matter_field(matter, p);
        if (field && field->mask) field->values[to] = field->values[from];
    }

    if (matter->capacity_ratio.mask) matter->capacity_ratio.values[to] = matter->capacity_ratio.values[from];
    float share = area / matter->area[from];
    float *const shared[] = {matter->area, matter->mass, matter->capacity};
    for (int k = 0; k < 3; k++) {
        shared[k][to] = shared[k][from] * share;
        shared[k][from] -= shared[k][to];
    }
}

// Changes by the caller while the simulation runs: gravity, pace, ambient temperature, velocities, materials.
//
// Gravity, pace and velocities are read anew in every step. Plans are built from the ambient temperature and the
// materials (the operator of heat, the front's thickening, springs' weights): these are changed in the description, and
// the simulation is rebuilt from it as by a load, so that it equals a load of its snapshot at once.
#include "sim/objects.h"

#include "common/def_table.h"
#include "common/real.h"

#include <string.h>

// ---- read in every step

/// The axis along which gravity is largest, 1 to 3, with the sign of gravity: the gas has room at one end of it.
static int gravity_axis(const float gravity[3]) {
    int up = 2;
    for (int d = 0; d < 3; d++)
        if (fabsf(gravity[d]) > fabsf(gravity[up])) up = d;
    return gravity[up] > 0 ? -(up + 1) : up + 1;
}

SingeResult call_set_gravity(SingeSim *sim, const float gravity[3]) {
    TRY(def_check_field(&sim_table, "gravity", gravity, "gravity", &sim->error));
    if (sim->gas && gravity_axis(gravity) != gravity_axis(sim->def.gravity))
        return sim_fail(sim, SINGE_ERROR_STATE, "gravity", -1,
                        "gravity must stay largest along the same axis, as the gas grid was laid along it");
    memcpy(sim->def.gravity, gravity, sizeof sim->def.gravity);
    if (sim->dynamics) dynamics_plan_set_gravity(sim->dynamics, gravity);
    if (sim->gas) gas_plan_set_gravity(sim->gas, gravity);
    return SINGE_OK;
}

SingeResult call_set_pace(SingeSim *sim, float pace) {
    TRY(def_check_field(&sim_table, "pace", &pace, "pace", &sim->error));
    sim->def.pace = pace;
    if (sim->heat) heat_plan_set_pace(sim->heat, pace);
    if (sim->gas) gas_plan_set_pace(sim->gas, pace);
    return SINGE_OK;
}

SingeResult call_set_velocity(SingeSim *sim, SingeSheetId id, uint32_t first, uint32_t count, const float *velocity) {
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "velocity", -1,
                        "call singe_sim_commit first; the velocity at the start is in the sheet's Def");
    if (id.generation != 1 || id.index >= sim->sheet_count) return object_stale(sim, "velocity", id.index);

    const Sheet *sheet = &sim->shell.sheets[id.index];
    if (count > sheet->vertex_count || first > sheet->vertex_count - count)
        return error_set(&sim->error, SINGE_ERROR_ARGUMENT, "velocity", first,
                         "sheet '%s' has only %u vertices, including its reserve", sheet->name, sheet->vertex_count);
    if (count && !velocity) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "velocity", -1, "velocity is NULL");

    for (size_t k = 0; k < 3 * (size_t)count; k++)
        if (!float_within(velocity[k], -1e4f, 1e4f))
            return error_set(&sim->error, SINGE_ERROR_ARGUMENT, "velocity", (int64_t)(first + k / 3),
                             "the velocity of vertex %zu must be between -10000 and 10000 m/s", first + k / 3);

    float(*now)[4] = sim->state.dynamics.velocity;
    const uint32_t begin = sheet->vertex_first + first;

    // a cell's centre changes by the mean of its corners' changes
    for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++)
        for (int i = 0; i < 4; i++) {
            const uint32_t v = sim->shell.cells[c][i];
            if (v < begin || v - begin >= count) continue;
            float *centre = now[shell_centre(&sim->shell, c)];
            for (int k = 0; k < 3; k++)
                centre[k] += 0.25f * (velocity[3 * (size_t)(v - begin) + (size_t)k] - now[v][k]);
        }

    for (uint32_t v = 0; v < count; v++) memcpy(now[begin + v], velocity + 3 * (size_t)v, 3 * sizeof *velocity);
    dynamics_plan_velocity_changed(sim->dynamics);
    return SINGE_OK;
}

// ---- part of the plans

/// Rebuilds the simulation from its description, with its State and objects. On failure nothing has changed.
static SingeResult sim_rebuild(SingeSim *sim) {
    SingeSim *fresh;
    if (!sim->committed) return SINGE_OK;

    TRY(call_clone(sim, &fresh));
    fresh->timers = sim->timers;
    fresh->intersecting_warned = sim->intersecting_warned;
    fresh->crossing_warned = sim->crossing_warned;
    fresh->crowd_warned = sim->crowd_warned;
    fresh->heat_warned = sim->heat_warned;
    fresh->tear_warned = sim->tear_warned;
    fresh->def.record = sim->def.record;

    const SingeSim swap = *sim;
    *sim = *fresh;
    *fresh = swap;
    sim->recorder = fresh->recorder;
    fresh->recorder = NULL;
    singe_sim_destroy(fresh);
    return SINGE_OK;
}

SingeResult call_set_ambient_temperature(SingeSim *sim, float temperature) {
    TRY(def_check_field(&sim_table, "ambient_temperature", &temperature, "ambient", &sim->error));
    const float before = sim->def.ambient_temperature;
    const double start = sim->heat_start, stored = sim->committed ? sim_enthalpy(sim) : 0;
    sim->def.ambient_temperature = temperature;
    if (sim->committed) sim->heat_start += sim_enthalpy(sim) - stored; // enthalpy has a new reference

    SingeResult result = sim_rebuild(sim);
    if (result) {
        sim->def.ambient_temperature = before;
        sim->heat_start = start;
    }

    return result;
}

/// Parameters that determined the sheet's mass, shape or start: these stay.
static bool material_stays(int param) {
    return param == PARAM_GRAMMAGE || param == PARAM_SPECIFIC_HEAT || param == PARAM_THICKNESS ||
           param == PARAM_TEMPERATURE || param == PARAM_MOISTURE;
}

/// A sheet's parameters, as SheetSource has them.
typedef struct MaterialValues {
    float value[PARAM_COUNT];
    float *values[PARAM_COUNT];
} MaterialValues;

/// Interpolates between two sheets' parameters; false when out of memory.
static bool material_mix(SingeSim *sim, const SheetSource *old, const SheetSource *other, const float *share,
                         MaterialValues *mixed) {
    const uint32_t vertices = old->sheet.vertex_count, total = vertices + old->sheet.cell_count;
    for (int p = 0; p < PARAM_COUNT; p++) {
        if (material_stays(p)) continue;

        float *values = NEW(&sim->memory, mixed->values[p], total);
        if (!values) return false;

        for (uint32_t i = 0; i < total; i++) {
            const float from = sheet_param(old, p, i), to = sheet_param(other, p, i);
            float s = share && i < vertices ? share[i] : 1;
            if (share && i >= vertices) { // a centre has the mean of its corners
                float sum = 0;
                for (int k = 0; k < 4; k++) sum += share[old->cells[i - vertices][k]];
                s = 0.25f * sum;
            }
            values[i] = s <= 0 ? from : s >= 1 || from == to ? to : from + s * (to - from);
        }

        // keep a single value if all are equal bit by bit
        mixed->value[p] = values[0];
        if (memcmp(values, values + 1, (total - 1) * sizeof *values) == 0) FREE(&sim->memory, mixed->values[p], total);
    }

    return true;
}

static void material_swap(SheetSource *source, MaterialValues *with) {
    for (int p = 0; p < PARAM_COUNT; p++) {
        if (material_stays(p)) continue;
        const float value = source->value[p];
        float *values = source->values[p];
        source->value[p] = with->value[p];
        source->values[p] = with->values[p];
        with->value[p] = value;
        with->values[p] = values;
    }
}

SingeResult call_set_material(SingeSim *sim, SingeSheetId id, const SingeMaterialDef *given, const float *share) {
    if (id.generation != 1 || id.index >= sim->sheet_count) return object_stale(sim, "material", id.index);

    SingeMaterialDef material;
    OBJECT_DEF(sim, "material", material, given, singe_default_material);

    SheetSource *source = &sim->sheets[id.index], other;
    const uint32_t total = source->sheet.vertex_count + source->sheet.cell_count;
    for (uint32_t v = 0; share && v < source->sheet.vertex_count; v++)
        if (!float_within(share[v], 0, 1))
            return error_set(&sim->error, SINGE_ERROR_ARGUMENT, "material", v,
                             "the share of vertex %u must be between 0 and 1", v);

    // evaluate the new material on the present sheet, and mix it with the old
    SingeSheetDef def = singe_default_sheet();
    def.name = source->sheet.name;
    def.vertex_count = source->sheet.vertex_count;
    def.positions = (const float *)source->position;
    def.cell_count = source->sheet.cell_count;
    def.cells = (const uint32_t *)source->cells;
    def.uv = (const float *)source->uv;
    def.corner_uv = (const float *)source->corner_uv;
    def.material = material;
    TRY(sheet_source_create(&sim->memory, &def, &other, &sim->error));

    MaterialValues values = {0};
    Memory before = sim->memory; // a rebuilt simulation counts its own
    SingeResult result = SINGE_OK;
    if (!material_mix(sim, source, &other, share, &values))
        result = sim_fail(sim, SINGE_ERROR_MEMORY, "material", -1, "out of memory");
    sheet_source_free(&sim->memory, &other);

    // rebuild with the values, which then are those to free
    if (!result) {
        material_swap(source, &values);
        result = sheet_source_check(source, &sim->error);
        if (!result) result = sim_rebuild(sim);
        if (result) material_swap(source, &values);
    }

    Memory *memory = !result && sim->committed ? &before : &sim->memory;
    for (int p = 0; p < PARAM_COUNT; p++) FREE(memory, values.values[p], total);
    return result;
}

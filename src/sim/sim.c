// A simulation's life: create, add sheets, commit, destroy.
#include "common/def_table.h"
#include "common/real.h"
#include "common/store.h"
#include "shell/shell_validate.h"
#include "sim/calls.h"

#include <stddef.h>
#include <string.h>

SingeResult sim_fail(SingeSim *sim, SingeResult code, const char *stage, int64_t element, const char *message) {
    return error_set(&sim->error, code, stage, element, "%s", message);
}

const SingeError *singe_sim_error(const SingeSim *sim) { return &sim->error; }

SingeResult sim_check_def(const SingeSimDef *def, SingeError *error) {
    TRY(def_check(&sim_table, def, error));
    TRY(def_check(&solver_table, &def->solver, error));
    TRY(def_check(&gas_table, &def->gas, error));
    TRY(def_check(&contact_table, &def->contact, error));
    TRY(def_check(&wind_table, &def->wind, error));

    // what concerns several fields
    bool seen[SINGE_COLOUR_COUNT] = {false};
    for (int i = 0; i < SINGE_COLOUR_COUNT; i++) {
        if (seen[def->solver.order[i]])
            return error_set(error, SINGE_ERROR_ARGUMENT, "simulation", -1, "solver.order must name each colour once");
        seen[def->solver.order[i]] = true;
    }

    if (def->solver.isotropic && def->solver.method != SINGE_SOLVER_STRAND)
        return error_set(error, SINGE_ERROR_ARGUMENT, "simulation", -1, "solver.isotropic needs the method strand");
    if (def->tasks.enqueue && !def->tasks.finish)
        return error_set(error, SINGE_ERROR_ARGUMENT, "simulation", -1, "tasks.enqueue needs tasks.finish");

    return SINGE_OK;
}

bool sim_read_def(void *def, size_t size, const void *given, size_t given_size) {
    size_t known;
    if (!given || given_size < sizeof known) return false;
    memcpy(&known, given, sizeof known);
    if (!struct_size_is_possible(known) || known > given_size) return false;
    memcpy(def, given, known < size ? known : size);
    memcpy(def, &size, sizeof size);
    return true;
}

// Wind, solver, gas and contact lie inside and grow separately, so the field after each is found by the size that the
// caller's header gave it.
bool sim_read_sim_def(const SingeSimDef *given, SingeSimDef *def) {
    const size_t head = offsetof(SingeSimDef, wind);
    const char *bytes = (const char *)given;
    *def = singe_default_sim();
    if (!given || !struct_size_is_possible(given->struct_size)) return false;

    size_t rest = given->struct_size, wind, solver, gas, contact;
    memcpy(def, bytes, rest < head ? rest : head);
    def->struct_size = sizeof *def;
    if (rest <= head) return true;

    // the Defs inside, each of its own size
    bytes += head;
    rest -= head;
    if (!sim_read_def(&def->wind, sizeof def->wind, bytes, rest)) return false;

    memcpy(&wind, bytes, sizeof wind);
    bytes += wind;
    rest -= wind;
    if (rest == 0) return true;
    if (!sim_read_def(&def->solver, sizeof def->solver, bytes, rest)) return false;

    memcpy(&solver, bytes, sizeof solver);
    bytes += solver;
    rest -= solver;
    if (rest == 0) return true;
    if (!sim_read_def(&def->gas, sizeof def->gas, bytes, rest)) return false;

    memcpy(&gas, bytes, sizeof gas);
    bytes += gas;
    rest -= gas;
    if (rest == 0) return true;
    if (!sim_read_def(&def->contact, sizeof def->contact, bytes, rest)) return false;

    memcpy(&contact, bytes, sizeof contact);
    bytes += contact;
    rest -= contact;
    if (rest == 0) return true;
    if (rest < sizeof def->record) return false;

    memcpy(&def->record, bytes, sizeof def->record);
    bytes += sizeof def->record;
    rest -= sizeof def->record;
    if (rest == 0) return true;
    if (rest < sizeof def->cancel) return false;

    memcpy(&def->cancel, bytes, sizeof def->cancel);
    return true;
}

SingeResult sim_make(const SingeSimDef *given, SingeSim **out, SingeError *error) {
    *out = NULL;
    SingeSimDef def;
    if (!sim_read_sim_def(given, &def))
        return error_set(error, SINGE_ERROR_ARGUMENT, "simulation", -1, STRUCT_SIZE_UNKNOWN(singe_default_sim));

    TRY(sim_check_def(&def, error));
    if (!dynamics_runs_here(def.instructions))
        return error_set(error, SINGE_ERROR_LIMIT, "simulation", -1, "this processor lacks the requested instructions");

    // memory and threads
    Memory memory = memory_make(def.allocator);
    SingeSim *sim = memory_new(&memory, 1, sizeof *sim);
    if (!sim) return error_set(error, SINGE_ERROR_MEMORY, "simulation", -1, "out of memory");

    sim->memory = memory;
    sim->def = def;
    sim->next_generation = 1;
    if (pool_create(&sim->memory, def.tasks, def.thread_count, &sim->pool)) {
        singe_sim_destroy(sim);
        return error_set(error, SINGE_ERROR_MEMORY, "simulation", -1, "out of memory");
    }

    *out = sim;
    return SINGE_OK;
}

SingeResult singe_sim_create(const SingeSimDef *def, SingeSim **sim, SingeError *error) {
    TRY(sim_make(def, sim, error));
    SingeResult result = sim_record(*sim, NULL, 0, error);
    if (!result) return SINGE_OK;
    singe_sim_destroy(*sim);
    *sim = NULL;
    return result;
}

SingeResult sim_record(SingeSim *sim, const uint8_t *bytes, size_t size, SingeError *error) {
#ifdef SINGE_WITHOUT_RECORDING
    (void)sim, (void)bytes, (void)size, (void)error;
    return SINGE_OK;
#else
    if (!sim->def.record.write) return SINGE_OK;
    sim->recorder = recorder_open(&sim->def, bytes, size);
    if (sim->recorder) return SINGE_OK;
    return error_set(error, SINGE_ERROR_MEMORY, "simulation", -1, "out of memory");
#endif
}

/// Frees what sim_build made, also so that a failed commit can be tried again.
static void sim_unbuild(SingeSim *sim) {
    Memory *memory = &sim->memory;
    heat_plan_free(memory, sim->heat);
    ablate_plan_free(memory, sim->ablate);
    dynamics_plan_free(memory, &sim->shell, sim->dynamics);
    gas_plan_free(memory, sim->gas);
    tear_plan_free(memory, sim->tear);

    sim->heat = NULL;
    sim->ablate = NULL;
    sim->dynamics = NULL;
    sim->gas = NULL;
    sim->tear = NULL;
    FREE(memory, sim->thickening, sim->shell.sheet_count);

    burn_air_free(memory, &sim->air);
    FREE(memory, sim->partial, pool_blocks((int)sim->shell.particle_count));
    FREE(memory, sim->sample, sim->shell.springs[SINGE_BLUE].count);
    sim->events = (EventList){0};
    FREE(memory, sim->gathered.items, sim->gathered.capacity);
    sim->gathered = (EventList){0}, sim->gathers = false;
    memory_free(memory, (void *)&sim->backup, sim->state.basic_size, 1);
    state_free(memory, &sim->state);
    shell_free(memory, &sim->shell);
}

void singe_sim_destroy(SingeSim *sim) {
    if (!sim) return;

    Memory *memory = &sim->memory;
    recorder_close(sim_recorder(sim));
    pool_destroy(memory, sim->pool);
    for (uint32_t i = 0; i < sim->sources.count; i++) sim_free_source(sim, &sim->sources.items[i]);
    for (uint32_t i = 0; i < sim->colliders.count; i++) collider_free(memory, &sim->colliders.items[i]);
    for (uint32_t i = 0; i < sim->pins.count; i++) sim_free_pin(sim, &sim->pins.items[i]);
    for (uint32_t i = 0; i < sim->render_mesh_count; i++) render_mesh_free(memory, sim->render_meshes[i]);

    FREE(memory, sim->render_meshes, sim->render_mesh_count);
    FREE(memory, sim->sources.items, sim->sources.capacity);
    FREE(memory, sim->colliders.items, sim->colliders.capacity);
    FREE(memory, sim->pins.items, sim->pins.capacity);
    sim_unbuild(sim);
    for (uint32_t i = 0; i < sim->sheet_count; i++) sheet_source_free(memory, &sim->sheets[i]);
    FREE(memory, sim->sheets, sim->sheet_capacity);

    Memory last = *memory;
    FREE(&last, sim, 1);
}

void *sim_slot(SingeSim *sim, void *items_pointer, uint32_t *count, uint32_t *capacity, size_t size, uint32_t *index) {
    char *items;
    memcpy(&items, items_pointer, sizeof items);

    uint32_t i = 0;
    for (; i < *count; i++) {
        uint32_t generation;
        memcpy(&generation, items + i * size, sizeof generation);
        if (generation == 0) break;
    }

    if (i == *capacity) {
        uint32_t grown = *capacity ? 2 * *capacity : 4;
        if (!memory_grow(&sim->memory, items_pointer, *capacity, grown, size)) return NULL;
        *capacity = grown;
        memcpy(&items, items_pointer, sizeof items);
    }

    *index = i;
    return memset(items + i * size, 0, size);
}

SingeResult call_add_sheet(SingeSim *sim, const SingeSheetDef *def, SingeSheetId *id) {
    if (id) *id = (SingeSheetId){0, 0};
    if (sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "sheet", -1, "sheets must be added before singe_sim_commit");
    if (sim->sheet_count == UINT16_MAX) return sim_fail(sim, SINGE_ERROR_LIMIT, "sheet", -1, "more than 65535 sheets");

    if (sim->sheet_count == sim->sheet_capacity) {
        uint32_t grown = sim->sheet_capacity ? 2 * sim->sheet_capacity : 1;
        if (!memory_grow(&sim->memory, &sim->sheets, sim->sheet_capacity, grown, sizeof *sim->sheets))
            return sim_fail(sim, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory");
        sim->sheet_capacity = grown;
    }

    SheetSource source = {0};
    TRY(sheet_source_create(&sim->memory, def, &source, &sim->error));
    sim->sheets[sim->sheet_count] = source;
    if (id) *id = (SingeSheetId){sim->sheet_count, 1};
    sim->sheet_count++;
    return SINGE_OK;
}

SingeResult sim_build(SingeSim *sim) {
    const SingeSimDef *def = &sim->def;
    Memory *memory = &sim->memory;
    Shell *shell = &sim->shell;

    // vertices in reserve for tears: half as many as a sheet's own, and some more for small sheets
    const bool tears = def->solver.tearing && def->solver.method == SINGE_SOLVER_STRAND;
    for (uint32_t s = 0; s < sim->sheet_count; s++) {
        Sheet *sheet = &sim->sheets[s].sheet;
        sheet->spare_count = tears ? sheet->vertex_count / 2 + 16 : 0;
    }

    TRY(shell_create(memory, sim->sheets, sim->sheet_count, shell, &sim->error));
    shell->creases = def->solver.creases && def->solver.method == SINGE_SOLVER_STRAND;

    // a particle ignites once; a hole has a cell of its own, and so has every piece
    size_t events = shell->particle_count + 2 * (size_t)shell->cell_count;
    HeatSettings heat = {.ambient_temperature = def->ambient_temperature,
                         .tolerance = def->heat_tolerance,
                         .pace = def->pace,
                         .scratch_min = events * sizeof *sim->events.items};
    GasSettings gas = {.def = def->gas,
                       .gravity = {def->gravity[0], def->gravity[1], def->gravity[2]},
                       .ambient_temperature = def->ambient_temperature,
                       .time_step = def->time_step,
                       .pace = def->pace,
                       .instructions = def->instructions};
    DynamicsSettings dynamics = {.gravity = {def->gravity[0], def->gravity[1], def->gravity[2]},
                                 .air_density = def->air_density,
                                 .solver = def->solver,
                                 .plume = tears && def->gas.enabled,
                                 .contact = def->contact,
                                 .time_step = def->time_step,
                                 .instructions = def->instructions,
                                 .thread_count = def->tasks.enqueue ? 64 : def->thread_count};
    bool ok = state_create(memory, shell, &sim->state) == SINGE_OK;
    ok = ok && (sim->backup = memory_new(memory, sim->state.basic_size, 1)) != NULL;

    SingeResult result = ok ? heat_plan_create(memory, shell, &heat, &sim->heat, &sim->error) : SINGE_ERROR_MEMORY;
    if (result && result != SINGE_ERROR_MEMORY) return result;

    ok = !result;
    ok = ok && ablate_plan_create(memory, shell, &sim->ablate) == SINGE_OK;
    ok = ok && dynamics_plan_create(memory, shell, &dynamics, &sim->dynamics) == SINGE_OK;
    ok = ok && dynamics_plan_reserve(memory, sim->dynamics, sim->colliders.count);
    ok = ok && (!def->gas.enabled || gas_plan_create(memory, shell, &gas, &sim->gas, &sim->state.gas) == SINGE_OK);

    float h_sub = ok ? def->time_step / (float)dynamics_plan_substeps(sim->dynamics) : 0;
    ok = ok && (shell->spare_count == 0 || tear_plan_create(memory, shell, h_sub, &sim->tear) == SINGE_OK);
    ok = ok && NEW(memory, sim->thickening, shell->sheet_count);
    ok = ok && burn_air_create(memory, shell, &sim->air) == SINGE_OK;
    ok = ok && NEW(memory, sim->partial, pool_blocks((int)shell->particle_count));
    ok = ok && NEW(memory, sim->sample, shell->springs[SINGE_BLUE].count);
    if (!ok) return sim_fail(sim, SINGE_ERROR_MEMORY, "commit", -1, "out of memory");

    // events are written after the heat stage and are gone when the next one begins
    sim->events = (EventList){.items = heat_scratch(sim->heat), .capacity = events};
    for (uint32_t s = 0; s < shell->sheet_count; s++) sim->thickening[s] = heat_thickening(sim->heat, s);
    return SINGE_OK;
}

SingeResult call_commit(SingeSim *sim) {
    if (sim->committed) return sim_fail(sim, SINGE_ERROR_STATE, "commit", -1, "the simulation is committed already");
    if (sim->sheet_count == 0) return sim_fail(sim, SINGE_ERROR_STATE, "commit", -1, "there is no sheet");

    SingeResult result = sim_build(sim);
    if (result) {
        sim_unbuild(sim);
        return result;
    }

    // the first ablation: pieces are labelled before anything burns
    StepContext context = sim_context(sim, NULL);
    context.state.ablate = NULL;
    ablate_step(sim->ablate, &context, &sim->state.ablate);
    sim->events.count = 0;
    result = sim_settle_objects(sim);
    if (result) {
        sim_unbuild(sim);
        return result;
    }

    sim->heat_start = sim_enthalpy(sim);
    sim->committed = true;
    shell_assert(&sim->shell, &sim->state);
    sim_log_commit(sim);
    if (sim_recorder(sim)) recorder_state(sim_recorder(sim), &sim->shell, &sim->state);
    return SINGE_OK;
}

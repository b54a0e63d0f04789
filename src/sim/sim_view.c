// Read-only views, events, timers, counts and the drawn surface.
#include "common/real.h"
#include "sim/calls.h"
#include "surface/surface.h"

void singe_sim_read_view(const SingeSim *sim, SingeView *out, size_t struct_size) {
    const Shell *shell = &sim->shell;
    const State *state = &sim->state;
    SingeView view = {
        .struct_size = struct_size < sizeof view ? struct_size : sizeof view,
        .time = state->time,
        .step = state->step,
        .topology_version = state->ablate.topology_version,
        .particle_count = shell->particle_count,
        .vertex_count = shell->vertex_count,
        .cell_count = shell->cell_count,
        .position = (const float(*)[4])state->dynamics.position,
        .velocity = (const float(*)[4])state->dynamics.velocity,
        .rest_position = (const float(*)[4])shell->rest_position,
        .uv = (const float(*)[2])shell->uv,
        .area = shell->matter.area,
        .mass = state->burn.mass,
        .fuel = state->burn.fuel,
        .temperature = state->heat.temperature,
        .temperature_peak = state->heat.temperature_peak,
        .burn_rate = state->burn.burn_rate,
        .time_ignited = state->burn.time_ignited,
        .time_burnt = state->burn.time_burnt,
        .piece = state->ablate.piece,
        .particle_flags = state->ablate.particle_flags,
        .cell_flags = state->ablate.cell_flags,
        .cells = (const uint32_t(*)[4])shell->cells,
        .line_force = shell->spare_count ? (const float(*)[6])state->tear.line_force : NULL,
        .source_vertex = shell->source_vertex,
    };

    // springs by colour
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        view.spring_count[colour] = shell->springs[colour].count;
        view.springs[colour] = (const uint32_t(*)[2])shell->springs[colour].ends;
        view.spring_length[colour] = state->burn.spring_length[colour];
        view.spring_rest[colour] = shell->springs[colour].rest;
        view.spring_flags[colour] = state->ablate.spring_flags[colour];
    }
    sim_write_result(out, struct_size, &view, sizeof view);
}

void singe_sim_read_sheet_range(const SingeSim *sim, SingeSheetId id, SingeSheetRange *range, size_t struct_size) {
    SingeSheetRange ours = {.struct_size = struct_size};
    if (sim->committed && id.generation == 1 && id.index < sim->sheet_count) {
        const Sheet *sheet = &sim->shell.sheets[id.index];
        ours.vertex_first = sheet->vertex_first;
        ours.vertex_count = sheet->vertex_count - sheet->spare_count;
        ours.reserve_count = sheet->spare_count;
        ours.torn_count = sheet->spare_used;
        ours.cell_first = sheet->cell_first;
        ours.cell_count = sheet->cell_count;
        ours.centre_first = shell_centre(&sim->shell, sheet->cell_first);
    }
    sim_write_result(range, struct_size, &ours, sizeof ours);
}

const SingeEvent *singe_sim_events(const SingeSim *sim, size_t *count) {
    const EventList *events = sim->gathers ? &sim->gathered : &sim->events;
    *count = events->count;
    return events->items;
}

void singe_sim_read_gas(const SingeSim *sim, SingeGas *gas, size_t struct_size) {
    const SingeGas ours = sim->gas ? gas_view(sim->gas) : (SingeGas){0};
    sim_write_result(gas, struct_size, &ours, sizeof ours);
}

void singe_sim_read_timers(const SingeSim *sim, SingeTimers *timers, size_t struct_size) {
    sim_write_result(timers, struct_size, &sim->timers, sizeof sim->timers);
}

void singe_sim_read_counts(const SingeSim *sim, SingeCounts *out, size_t struct_size) {
    const Shell *shell = &sim->shell;
    SingeCounts counts = {.cells = shell->cell_count, .memory = sim->memory.held};
    counts.instructions = dynamics_instructions(sim->def.instructions);

    double springs = 0, strands = 0, size = 0;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        counts.springs[colour] = shell_strand_springs(shell, colour);
        counts.strands[colour] = shell->springs[colour].strand_count;
        counts.families[colour] = shell->springs[colour].family_count;
        springs += counts.springs[colour];
        strands += shell->springs[colour].strand_count;
    }

    counts.mean_strand_length = strands > 0 ? springs / strands : 0;
    for (uint32_t s = 0; s < shell->sheet_count; s++) size += (double)shell->sheets[s].cell_size / shell->sheet_count;
    counts.cell_size = (float)size;
    for (uint32_t i = 0; i < shell->particle_count; i++) counts.particles += shell->matter.area[i] > 0;
    sim_write_result(out, struct_size, &counts, sizeof counts);
}

/// The surface's max distance from flat triangles: less than half of the distance that contact keeps between surfaces,
/// where it does not report them as near.
static float bulge_max(const SingeSim *sim) {
    float cell = INFINITY;
    for (uint32_t s = 0; s < sim->shell.sheet_count; s++) cell = float_min(cell, sim->shell.sheets[s].cell_size);
    return sim->def.contact.enabled ? 0.45f * float_min(sim->def.contact.thickness, 0.4f * cell) : 0;
}

void singe_init_render_mesh(SingeRenderMeshDef *def, size_t struct_size) {
    if (struct_size < sizeof struct_size) return;
    memset(def, 0, struct_size);
    memcpy(def, &struct_size, sizeof struct_size);
}

SingeResult singe_sim_add_render_mesh(SingeSim *sim, SingeSheetId id, const SingeRenderMeshDef *given) {
    SingeRenderMeshDef def = singe_default_render_mesh();
    if (!sim_read_def(&def, sizeof def, given, SIZE_MAX))
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "render mesh", -1,
                        "struct_size is that of no version; start from singe_default_render_mesh()");
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "render mesh", -1, "singe_sim_commit must come before a render mesh");
    if (id.generation != 1 || id.index >= sim->sheet_count)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "render mesh", id.index, "there is no such sheet");

    // its vertices are numbered after those of the sheets and of other meshes
    const Sheet *sheet = &sim->shell.sheets[id.index], *last = &sim->shell.sheets[sim->sheet_count - 1];
    const uint64_t first = (uint64_t)last->source_first + last->source_count + (uint64_t)sim->render_vertex_count;
    if (first + def.vertex_count > INT32_MAX)
        return sim_fail(sim, SINGE_ERROR_LIMIT, "render mesh", -1, "more vertices than can be numbered");

    const RenderSheet bound = {.source = &sim->sheets[id.index],
                               .cell_first = sheet->cell_first,
                               .cell_size = sheet->cell_size,
                               .bulge_max = bulge_max(sim),
                               .number_first = (int32_t)first};
    RenderMesh *mesh;
    TRY(render_mesh_create(&sim->memory, sim->pool, &bound, &def, &mesh, &sim->error));

    const uint32_t count = sim->render_mesh_count;
    if (!memory_grow(&sim->memory, &sim->render_meshes, count, count + 1, sizeof(RenderMesh *))) {
        render_mesh_free(&sim->memory, mesh);
        return sim_fail(sim, SINGE_ERROR_MEMORY, "render mesh", -1, "out of memory for the render mesh");
    }

    sim->render_meshes[count] = mesh;
    sim->render_mesh_count = count + 1;
    sim->render_vertex_count += (int32_t)def.vertex_count;
    const RenderFlaws flaws = render_mesh_flaws(mesh);
    sim_log_render_mesh(sim, id.index, flaws.left_out, flaws.odd_edges);
    return SINGE_OK;
}

SingeResult call_draw(SingeSim *sim, SingeSurface *surface, size_t struct_size) {
    if (struct_size < sizeof *surface)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "surface", -1, "struct_size is smaller than a SingeSurface");
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "surface", -1, "singe_sim_commit must come before the surface");

    SurfaceDetail detail = {.size = sim->def.surface_detail,
                            .raggedness = sim->def.surface_raggedness,
                            .seed = (uint32_t)sim->def.seed,
                            .bulge_max = bulge_max(sim),
                            .meshes = sim->render_meshes,
                            .mesh_count = sim->render_mesh_count};
    const bool coarse = !(detail.size > 0);
    if (coarse && detail.mesh_count == 0)
        return surface_draw(sim->ablate, &sim->shell, &sim->state, surface, &sim->error);

    if (coarse) { // cells are not refined
        detail.size = INFINITY;
        detail.raggedness = 0;
    }

    float *room;
    if (!NEW(&sim->memory, room, sim->shell.vertex_count))
        return sim_fail(sim, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface");

    dynamics_plan_clearance(sim->dynamics, &sim->shell, &sim->state, room);
    detail.room = room;
    SingeResult result = surface_draw_fine(sim->ablate, &sim->shell, &sim->state, &detail, &sim->memory, sim->pool,
                                           surface, &sim->error);
    FREE(&sim->memory, room, sim->shell.vertex_count);
    return result;
}

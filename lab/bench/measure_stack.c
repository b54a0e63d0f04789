// Sheets that fall over a sphere: a stack, which is a crowd, in which every layer lies on the next; and one alone.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/machine.h"
#include "bench/timing.h"

enum { FPS = 24 };
static const float apart = 0.01f; // m

/// What falls.
typedef struct Fall {
    float side, ball, lowest; ///< m: of the sheets, the sphere's radius, the height of the lowest sheet
    double seconds;
    uint32_t cells, sheets; ///< unless asked for others
} Fall;
static const Fall pile = {0.35f, 0.1f, 0.21f, 1, 70, 10}, alone = {1, 0.3f, 0.61f, 2, 100, 1};

static SingeResult stack_fill(SingeSim *sim, const Fall *fall, uint32_t sheets, uint32_t cells, SingeError *error) {
    SingeGridDef grid = singe_default_grid();
    SingeSheetDef def = singe_default_sheet();
    SingeSheetId id;
    if (singe_material_preset("cotton", &def.material, error)) return error->code;

    def.material.mass_loss = singe_param(0);
    grid.size[0] = grid.size[1] = fall->side;
    grid.cells[0] = grid.cells[1] = cells;

    // grids lie in the x-y plane about the origin; no two are the same
    for (uint32_t k = 0; k < sheets; k++) {
        SingeMesh *mesh;
        grid.seed = k + 1;
        if (singe_mesh_create_grid(&grid, &mesh, error)) return error->code;

        singe_mesh_fill_sheet(mesh, &def);
        float *lifted = malloc(3 * (size_t)def.vertex_count * sizeof *lifted);
        for (size_t i = 0; lifted && i < 3 * (size_t)def.vertex_count; i++)
            lifted[i] = def.positions[i] + (i % 3 == 2 ? fall->lowest + apart * (float)k : 0);
        def.positions = lifted;
        const SingeResult result = lifted ? singe_sim_add_sheet(sim, &def, &id) : SINGE_ERROR_MEMORY;
        free(lifted);
        singe_mesh_destroy(mesh);
        if (result) return result;
    }

    SingeResult result = singe_sim_commit(sim);

    // the ground, and the sphere on it
    SingeColliderDef solid = singe_default_collider();
    SingePoseKey key = {.rotation = {0, 0, 0, 1}};
    SingeColliderId collider;

    solid.path_count = 1;
    solid.path = &key;
    if (!result) result = singe_sim_add_collider(sim, &solid, &collider);
    solid.kind = SINGE_COLLIDER_SPHERE;
    solid.radius = key.position[2] = fall->ball;
    if (!result) result = singe_sim_add_collider(sim, &solid, &collider);
    return result;
}

static SingeResult stack_measure(const BenchOptions *options, const Fall *fall, uint32_t sheets, uint32_t cells,
                                 BenchTable *table, SingeError *error) {
    const int of_frame = options_steps(options);
    MachineHeld held = {0};
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;

    def.allocator = (SingeAllocator){machine_resize, &held};
    def.thread_count = options->threads;
    def.time_step = 1.0f / (float)(of_frame * FPS);
    def.contact.enabled = true;
    def.solver.substeps = options_substeps(options);
    if (singe_sim_create(&def, &sim, error)) return error->code;
    SingeResult result = stack_fill(sim, fall, sheets, cells, error);

    const double time = options->time > 0 ? options->time : fall->seconds;
    const int steps = (int)fmax(1, time * of_frame * FPS);
    const double begun = machine_clock(), processor = machine_cpu_clock();
    double worst = 0, worst_p99 = 0;
    for (int step = 0; step < steps && !result; step++) {
        const double before = machine_clock();
        result = singe_sim_step(sim);
        worst = fmax(worst, machine_clock() - before);
        if (step % of_frame == 0 && !result) worst_p99 = fmax(worst_p99, singe_sim_stats(sim).strain_p99);
    }

    const double wall = machine_clock() - begun, busy = machine_cpu_clock() - processor;
    const size_t max = held.max;
    uint64_t crossing = 0;
    if (result && !error->code) *error = *singe_sim_error(sim);
    if (!result) result = geometry_crossings(sim, &crossing, error);

    if (!result) {
        const SingeTimers t = singe_sim_timers(sim);
        const SingeStats stats = singe_sim_stats(sim);
        const double a_step = 1.0 / steps;

        table_number(table, "sheets", "%.0f", 6, sheets);
        table_number(table, "cells", "%.0f", 5, cells);
        table_number(table, "springs", "%.0f", 8, timing_springs(sim));
        table_number(table, "threads", "%.0f", 7, options->threads);
        table_number(table, "frame_ms", "%.4g", 8,
                     1e3 * a_step * of_frame * busy); // of all threads, the mean of a frame
        table_number(table, "step_ms", "%.4g", 8, 1e3 * a_step * wall);
        table_number(table, "worst_ms", "%.4g", 8, 1e3 * worst);
        table_number(table, "cpu_ms", "%.4g", 8, 1e3 * a_step * busy); // of all threads, the mean of a step
        table_number(table, "find_ms", "%.4g", 8, 1e3 * a_step * t.contact_find_seconds); // contact, the mean of a step
        table_number(table, "push_ms", "%.4g", 8, 1e3 * a_step * t.contact_push_seconds);
        table_number(table, "stop_ms", "%.4g", 8, 1e3 * a_step * t.contact_stop_seconds);
        table_number(table, "rounds_step", "%.2f", 11, a_step * (double)t.contact_rounds);
        table_number(table, "looks_step", "%.0f", 10, a_step * (double)t.contact_looks);
        table_number(table, "pairs_step", "%.0f", 10, a_step * (double)t.contact_pairs);
        table_number(table, "halts", "%.0f", 5, (double)t.contact_halts);

        table_parts(table, "strain_pct", "%.3g", 20, "max/p99/mean", strain_of(&stats));
        table_number(table, "worst_p99_pct", "%.3g", 13, 100 * worst_p99); // of all frames
        table_number(table, "crossing", "%.0f", 8, (double)crossing);      // pairs of drawn triangles
        table_number(table, "speed", "%.4f", 8, stats.speed_rms_unburnt);
        table_number(table, "max_mb", "%.1f", 8, 1e-6 * (double)max);
        result = table_end_row(table);
    }

    singe_sim_destroy(sim);
    return result;
}

static SingeResult stack_rows(const BenchOptions *options, const Fall *fall, BenchTable *table, SingeError *error) {
    BenchList sheets = bench_list(&options->sheets, 1, (const double[]){fall->sheets});
    BenchList cells = bench_list(&options->cells, 1, (const double[]){fall->cells});
    SingeResult result = SINGE_OK;
    for (int i = 0; i < sheets.count && !result; i++)
        for (int k = 0; k < cells.count && !result; k++)
            result = stack_measure(options, fall, (uint32_t)sheets.values[i], (uint32_t)cells.values[k], table, error);
    return result;
}

SingeResult bench_stack(const BenchOptions *options, BenchTable *table, SingeError *error) {
    return stack_rows(options, &pile, table, error);
}

SingeResult bench_drop(const BenchOptions *options, BenchTable *table, SingeError *error) {
    return stack_rows(options, &alone, table, error);
}

// A stack of sheets that falls over a sphere: the cost of a crowd, in which every layer lies on the next.
#include <math.h>
#include <stdlib.h>

#include "analysis/crossings.h"
#include "bench/bench.h"
#include "bench/machine.h"

enum { STEPS_FRAME = 20, FPS = 24 };
static const float side = 0.35f, ball = 0.1f, lowest = 0.21f, apart = 0.01f; // m
static const double seconds = 1;

enum {
    SHEETS,
    CELLS,
    SPRINGS,
    THREADS,
    STEP_MEAN,
    STEP_WORST,
    STEP_CPU,
    FIND,
    PUSH,
    STOP,
    ROUNDS,
    LOOKS,
    PAIRS,
    HALTS,
    STRAIN,
    STRAIN_WORST,
    CROSSINGS,
    SPEED,
    MEGABYTES,
    COLUMNS
};

static const BenchColumn columns[COLUMNS] = {
    [SHEETS] = {"sheets", "%.0f", 6, NULL},
    [CELLS] = {"cells", "%.0f", 5, NULL},
    [SPRINGS] = {"springs", "%.0f", 8, NULL},
    [THREADS] = {"threads", "%.0f", 7, NULL},
    [STEP_MEAN] = {"step_ms", "%.4g", 8, NULL},
    [STEP_WORST] = {"worst_ms", "%.4g", 8, NULL},
    [STEP_CPU] = {"cpu_ms", "%.4g", 8, NULL}, // of all threads, the mean of a step
    [FIND] = {"find_ms", "%.4g", 8, NULL},    // contact, the mean of a step
    [PUSH] = {"push_ms", "%.4g", 8, NULL},
    [STOP] = {"stop_ms", "%.4g", 8, NULL},
    [ROUNDS] = {"rounds_step", "%.2f", 11, NULL},
    [LOOKS] = {"looks_step", "%.0f", 10, NULL},
    [PAIRS] = {"pairs_step", "%.0f", 10, NULL},
    [HALTS] = {"halts", "%.0f", 5, NULL},
    [STRAIN] = {"strain_pct", "%.3g", 20, "max/p99/mean"},
    [STRAIN_WORST] = {"worst_p99_pct", "%.3g", 13, NULL}, // of all frames
    [CROSSINGS] = {"crossing", "%.0f", 8, NULL},          // pairs of drawn triangles
    [SPEED] = {"speed", "%.4f", 8, NULL},
    [MEGABYTES] = {"max_mb", "%.1f", 8, NULL},
};

static SingeResult stack_fill(SingeSim *sim, uint32_t sheets, uint32_t cells, SingeError *error) {
    SingeGridDef grid = singe_default_grid();
    SingeSheetDef def = singe_default_sheet();
    SingeSheetId id;
    if (singe_material_preset("cotton", &def.material, error)) return error->code;
    def.material.mass_loss = singe_param(0);
    grid.size[0] = grid.size[1] = side;
    grid.cells[0] = grid.cells[1] = cells;

    // grids lie in the x-y plane about the origin; no two are the same
    for (uint32_t k = 0; k < sheets; k++) {
        SingeMesh *mesh;
        grid.seed = k + 1;
        if (singe_mesh_create_grid(&grid, &mesh, error)) return error->code;
        singe_mesh_fill_sheet(mesh, &def);
        float *lifted = malloc(3 * (size_t)def.vertex_count * sizeof *lifted);
        for (size_t i = 0; lifted && i < 3 * (size_t)def.vertex_count; i++)
            lifted[i] = def.positions[i] + (i % 3 == 2 ? lowest + apart * (float)k : 0);
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
    solid.radius = key.position[2] = ball;
    if (!result) result = singe_sim_add_collider(sim, &solid, &collider);
    return result;
}

static SingeResult stack_measure(const BenchOptions *options, uint32_t sheets, uint32_t cells, BenchTable *table,
                                 SingeError *error) {
    MachineHeld held = {0};
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;
    def.allocator = (SingeAllocator){machine_resize, &held};
    def.thread_count = options->threads;
    def.time_step = 1.0f / (STEPS_FRAME * FPS);
    def.contact.enabled = true;
    def.solver.substeps = options_substeps(options);
    if (singe_sim_create(&def, &sim, error)) return error->code;
    SingeResult result = stack_fill(sim, sheets, cells, error);

    const double time = options->time > 0 ? options->time : seconds;
    const int steps = (int)fmax(1, time * STEPS_FRAME * FPS);
    const double begun = machine_clock(), processor = machine_cpu_clock();
    double worst = 0, worst_p99 = 0;
    for (int step = 0; step < steps && !result; step++) {
        const double before = machine_clock();
        result = singe_sim_step(sim);
        worst = fmax(worst, machine_clock() - before);
        if (step % STEPS_FRAME == 0 && !result) worst_p99 = fmax(worst_p99, singe_sim_stats(sim).strain_p99);
    }

    const double wall = machine_clock() - begun, busy = machine_cpu_clock() - processor;
    const size_t max = held.max;
    SingeSurface surface = {0};
    uint64_t crossing = 0;
    float at[3];
    if (!result) result = singe_sim_surface(sim, &surface);
    if (result && !error->code) *error = *singe_sim_error(sim);
    if (!result && !crossings_count(&surface, &crossing, at)) result = SINGE_ERROR_MEMORY;
    if (!result) {
        const SingeTimers t = singe_sim_timers(sim);
        const SingeCounts counts = singe_sim_counts(sim);
        const SingeStats stats = singe_sim_stats(sim);
        const double a_step = 1.0 / steps;
        double springs = 0;
        for (int c = 0; c < SINGE_COLOUR_COUNT; c++) springs += counts.springs[c];
        BenchValue row[COLUMNS] = {
            [SHEETS] = bench_number(sheets),
            [CELLS] = bench_number(cells),
            [SPRINGS] = bench_number(springs),
            [THREADS] = bench_number(options->threads),
            [STEP_MEAN] = bench_number(1e3 * a_step * wall),
            [STEP_WORST] = bench_number(1e3 * worst),
            [STEP_CPU] = bench_number(1e3 * a_step * busy),
            [FIND] = bench_number(1e3 * a_step * t.contact_find_seconds),
            [PUSH] = bench_number(1e3 * a_step * t.contact_push_seconds),
            [STOP] = bench_number(1e3 * a_step * t.contact_stop_seconds),
            [ROUNDS] = bench_number(a_step * (double)t.contact_rounds),
            [LOOKS] = bench_number(a_step * (double)t.contact_looks),
            [PAIRS] = bench_number(a_step * (double)t.contact_pairs),
            [HALTS] = bench_number((double)t.contact_halts),
            [STRAIN] = {.number = {100 * stats.strain_max, 100 * stats.strain_p99, 100 * stats.strain_mean}},
            [STRAIN_WORST] = bench_number(100 * worst_p99),
            [CROSSINGS] = bench_number((double)crossing),
            [SPEED] = bench_number(stats.speed_rms_unburnt),
            [MEGABYTES] = bench_number(1e-6 * (double)max),
        };
        if (!table_add(table, row)) result = SINGE_ERROR_MEMORY;
    }

    singe_surface_free(&surface);
    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_stack(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList sheets = bench_list(&options->sheets, 1, (const double[]){10});
    BenchList cells = bench_list(&options->cells, 1, (const double[]){70});
    SingeResult result = SINGE_OK;
    *table = table_begin("stack", columns, COLUMNS, table->text);
    for (int i = 0; i < sheets.count && !result; i++)
        for (int k = 0; k < cells.count && !result; k++)
            result = stack_measure(options, (uint32_t)sheets.values[i], (uint32_t)cells.values[k], table, error);
    return result;
}

// A sheet held at two corners in gusts: what contact costs where cells move far in a step. The lightest wind comes first;
// its processor time is the unit of the others.
#include <math.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/machine.h"

enum { STEPS = 40, STEPS_SECOND = 240 };
static const float side = 0.1f; // m
static const double speeds[] = {5, 15, 30};

static SingeResult wind_fill(SingeSim *sim, uint32_t cells, float speed, SingeError *error) {
    SingeGridDef grid = singe_default_grid();
    SingeSheetDef sheet = singe_default_sheet();
    SingePinDef pin = singe_default_pin();
    SingeWindDef wind = singe_default_wind();
    SingePinId pin_id;
    SingeMesh *mesh;

    grid.size[0] = grid.size[1] = side;
    grid.cells[0] = grid.cells[1] = cells;
    if (singe_mesh_create_grid(&grid, &mesh, error)) return error->code;

    singe_mesh_fill_sheet(mesh, &sheet);
    SingeResult result = singe_sim_add_sheet(sim, &sheet, &pin.sheet);
    singe_mesh_destroy(mesh);
    if (!result) result = singe_sim_commit(sim);

    const float corners[] = {-side / 2, -side / 2, 0, side / 2, -side / 2, 0};
    pin.point_count = 2;
    pin.points = corners;
    pin.radius = 0.5f * side / (float)cells;
    if (!result) result = singe_sim_add_pin(sim, &pin, &pin_id);

    wind.velocity[0] = wind.gust = speed;
    return result ? result : singe_sim_set_wind(sim, &wind);
}

/// Adds the row of a speed; *first is the processor time of the first one.
static SingeResult wind_measure(const BenchOptions *options, uint32_t cells, float speed, double *first,
                                BenchTable *table, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;

    def.thread_count = options->threads;
    def.time_step = 1.0f / STEPS_SECOND;
    def.contact.enabled = true;
    def.solver.substeps = options_substeps(options);
    if (singe_sim_create(&def, &sim, error)) return error->code;

    const int steps = options->time > 0 ? (int)fmax(1, options->time * STEPS_SECOND) : STEPS;
    SingeResult result = wind_fill(sim, cells, speed, error);
    const double begun = machine_cpu_clock();
    for (int step = 0; step < steps && !result; step++) result = singe_sim_step(sim);
    const double busy = machine_cpu_clock() - begun;
    if (*first == 0) *first = busy;

    uint64_t crossing = 0;
    if (result && !error->code) *error = *singe_sim_error(sim);
    if (!result) result = geometry_crossings(sim, &crossing, error);

    if (!result) {
        const SingeTimers timers = singe_sim_timers(sim);
        const SingeStats stats = singe_sim_stats(sim);

        table_number(table, "cells", "%.0f", 5, cells);
        table_number(table, "wind_m_s", "%.0f", 8, (double)speed); // mean, and of gusts
        table_number(table, "steps", "%.0f", 5, steps);
        table_number(table, "cpu_s", "%.3g", 8, busy);
        table_number(table, "of_first", "%.3g", 8, busy / *first);
        table_number(table, "rounds_step", "%.2f", 11, (double)timers.contact_rounds / steps);
        table_number(table, "looks_step", "%.0f", 10, (double)timers.contact_looks / steps);
        table_number(table, "halts", "%.0f", 5, (double)timers.contact_halts);

        table_parts(table, "strain_pct", "%.3g", 20, "max/p99/mean", strain_of(&stats));
        table_number(table, "crossing", "%.0f", 8, (double)crossing); // pairs of drawn triangles
        result = table_end_row(table);
    }

    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_wind(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList cells = bench_list(&options->cells, 1, (const double[]){60});
    SingeResult result = SINGE_OK;
    for (int i = 0; i < cells.count && !result; i++) {
        double first = 0;
        for (size_t k = 0; k < sizeof speeds / sizeof *speeds && !result; k++)
            result = wind_measure(options, (uint32_t)cells.values[i], (float)speeds[k], &first, table, error);
    }
    return result;
}

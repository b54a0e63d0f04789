// The cost of self-contact while a sheet falls, lands and lies: an upright cloth falls over a sphere and onto the
// ground in folds, and a ball of paper, a closed mesh, collapses.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/hung_sheet.h"
#include "bench/machine.h"
#include "bench/timing.h"
#include "analysis/numbers.h"

enum { ROOM = 4096 };
static const float side = 1;                    // m
static const float sphere = 0.12f, lift = 0.3f; // m
static const float ball = 0.1f;                 // m, radius of the closed mesh
static const double seconds = 3, collapse_seconds = 0.3;

/// A cloth in the x-z plane with slight waves, so that it folds instead of standing.
static SingeResult add_cloth(SingeSim *sim, int n) {
    uint32_t row = (uint32_t)n + 1;
    float *x = malloc(3 * (size_t)row * row * sizeof *x), cell = side / (float)n;
    uint32_t *cells = malloc(4 * (size_t)n * (size_t)n * sizeof *cells);
    SingeResult result = x && cells ? SINGE_OK : SINGE_ERROR_MEMORY;

    for (uint32_t v = 0; v < row * row && !result; v++) {
        float i = (float)(v % row) / (float)n, j = (float)(v / row) / (float)n;
        x[3 * v] = side * (i - 0.5f);
        x[3 * v + 1] = 0.02f * sinf(19 * j) + 0.01f * sinf(13 * i);
        x[3 * v + 2] = lift + side * j;
    }

    if (!result) {
        geometry_grid((uint32_t)n, (uint32_t)n, cells);
        SingeSheetDef def = singe_default_sheet();
        SingeSheetId id;

        def.vertex_count = row * row;
        def.positions = x;
        def.cell_count = (uint32_t)(n * n);
        def.cells = cells;
        def.material.thickness = singe_param(0.8f * cell);
        result = singe_sim_add_sheet(sim, &def, &id);
    }

    free(x), free(cells);
    return result;
}

static SingeResult add_ball(SingeSim *sim, int cells_a_side) {
    uint32_t n = (uint32_t)cells_a_side;
    SingeSheetDef def = singe_default_sheet();
    SingeSheetId id;

    def.vertex_count = 6 * n * n + 2;
    def.cell_count = 6 * n * n;

    float *x = malloc(3 * (size_t)def.vertex_count * sizeof *x);
    uint32_t *cells = malloc(4 * (size_t)def.cell_count * sizeof *cells);
    SingeResult result = x && cells ? SINGE_OK : SINGE_ERROR_MEMORY;
    if (!result) {
        // the six faces of a cube of n x n cells each, projected to a sphere that lies on the ground
        for (uint32_t c = 0; c < 6 * n * n; c++) {
            uint32_t axis = c / (2 * n * n), upper = c / (n * n) % 2, i = c / n % n, j = c % n;
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t at[3], turn = upper ? k : 3 - k;
                at[axis] = upper * n;
                at[(axis + 1) % 3] = i + (turn == 1 || turn == 2);
                at[(axis + 2) % 3] = j + turn / 2;

                // its index: (n + 1) x (n + 1) points at the bottom and the top of the cube, and rings in between
                const uint32_t row = n + 1;
                uint32_t v = (at[2] ? row * row : 0) + at[1] * row + at[0];
                if (at[2] > 0 && at[2] < n) {
                    const uint32_t ring = at[1] == 0   ? at[0]
                                          : at[0] == n ? n + at[1]
                                          : at[1] == n ? 3 * n - at[0]
                                                       : 4 * n - at[1];
                    v = 2 * row * row + (at[2] - 1) * 4 * n + ring;
                }
                cells[4 * c + k] = v;

                float square = 0, *p = x + 3 * (size_t)v;
                for (int d = 0; d < 3; d++) {
                    p[d] = tanf(0.785398f * (2 * (float)at[d] / (float)n - 1));
                    square += p[d] * p[d];
                }

                for (int d = 0; d < 3; d++) p[d] = ball / sqrtf(square) * p[d] + (d == 2 ? ball + 2e-3f : 0);
            }
        }

        def.positions = x;
        def.cells = cells;
        result = singe_sim_add_sheet(sim, &def, &id);
    }

    free(x), free(cells);
    return result;
}

static SingeResult heap_build(const BenchOptions *options, int cells, bool closed, SingeSim **sim, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = options->threads;
    def.time_step = (float)(1 / (24.0 * options_steps(options)));
    def.contact.enabled = true;
    if (!closed) def.contact.thickness = 1e-3f; // of a cloth
    def.solver.substeps = options_substeps(options);
    SingeResult result = singe_sim_create(&def, sim, error);
    if (result) return result;

    result = closed ? add_ball(*sim, cells) : add_cloth(*sim, cells);
    if (!result) result = singe_sim_commit(*sim);

    // the ground, and a sphere
    SingeColliderDef solid = singe_default_collider();
    SingePoseKey key = {.rotation = {0, 0, 0, 1}};
    SingeColliderId id;

    solid.path_count = 1;
    solid.path = &key;
    solid.friction = 0.4f;
    solid.offset = 1e-3f;
    if (!result) result = singe_sim_add_collider(*sim, &solid, &id);

    solid.kind = SINGE_COLLIDER_SPHERE;
    solid.radius = sphere;
    key.position[2] = sphere;
    if (!result && !closed) result = singe_sim_add_collider(*sim, &solid, &id);
    return result ? bench_give_up(sim, result, error) : SINGE_OK;
}

static SingeResult heap_measure(const BenchOptions *options, int cells, bool closed, BenchTable *table,
                                SingeError *error) {
    SingeSim *sim;
    double frame_ms[ROOM];
    double time = options->time > 0 ? options->time : closed ? collapse_seconds : seconds;
    int frames = (int)fmin(ROOM, fmax(1, 24 * time));

    if (heap_build(options, cells, closed, &sim, error)) return error->code;
    SingeResult result = SINGE_OK;
    for (int f = 0; f < frames && !result; f++) {
        double begun = machine_clock();
        for (int step = 0; step < options_steps(options) && !result; step++) result = singe_sim_step(sim);
        frame_ms[f] = 1e3 * (machine_clock() - begun);
    }

    if (result) {
        *error = *singe_sim_error(sim);
    } else {
        SingeTimers t = singe_sim_timers(sim);
        SingeStats stats = singe_sim_stats(sim);
        double springs = timing_springs(sim), a_frame = 1e3 / frames, steps = (double)t.steps;
        double mean = numbers_mean(frame_ms, frames), median = numbers_median(frame_ms, frames);

        table_number(table, "cells", "%.0f", 5, cells);
        table_number(table, "springs", "%.0f", 8, springs);
        table_number(table, "threads", "%.0f", 7, options->threads);
        table_number(table, "frame_ms", "%.4g", 8, median);
        table_number(table, "max_ms", "%.4g", 8, frame_ms[frames - 1]);
        table_number(table, "step_ms", "%.4g", 8, mean * frames / steps);
        table_number(table, "heat_ms", "%.3g", 8, a_frame * t.seconds[SINGE_STAGE_HEAT]);
        table_number(table, "burn_ms", "%.3g", 8, a_frame * t.seconds[SINGE_STAGE_BURN]);
        table_number(table, "ablate_ms", "%.3g", 9, a_frame * t.seconds[SINGE_STAGE_ABLATE]);
        table_number(table, "dynamics_ms", "%.4g", 11, a_frame * t.seconds[SINGE_STAGE_DYNAMICS]);
        table_number(table, "projection_ms", "%.4g", 13, a_frame * t.projection_seconds);
        table_number(table, "contact_ms", "%.4g", 10, a_frame * t.contact_seconds);
        table_number(table, "contact_100k_ms", "%.3g", 15,
                     1e3 * t.contact_seconds / steps * 1e5 / springs); // a step, for 100,000 springs
        table_number(table, "searches_step", "%.2f", 13, (double)t.contact_searches / steps);
        table_number(table, "pairs_step", "%.0f", 10, (double)t.contact_pairs / steps);
        table_number(table, "repulsions_substep", "%.0f", 14,
                     (double)t.contact_repulsions / steps / options_substeps(options));
        table_number(table, "stops_step", "%.1f", 10, (double)t.contact_stops / steps);
        table_number(table, "crossing", "%.0f", 8, (double)(t.contact_unresolved + t.contact_dropped));

        table_parts(table, "strain_pct", "%.3g", 20, "max/p99/mean", strain_of(&stats));
        table_number(table, "inverted", "%.0f", 8, stats.inverted_cells);
        table_number(table, "speed", "%.3f", 8, stats.speed_rms_unburnt);
        result = table_end_row(table);
    }

    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_heap(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList cells = bench_list(&options->cells, 2, (const double[]){100, 200});
    SingeResult result = SINGE_OK;
    for (int i = 0; i < cells.count && !result; i++)
        result = heap_measure(options, (int)cells.values[i], false, table, error);
    return result;
}

SingeResult bench_collapse(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList cells = bench_list(&options->cells, 2, (const double[]){40, 102});
    SingeResult result = SINGE_OK;
    for (int i = 0; i < cells.count && !result; i++)
        result = heap_measure(options, (int)cells.values[i], true, table, error);
    return result;
}

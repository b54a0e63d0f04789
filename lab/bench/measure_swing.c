// Trajectories: swing and hang-and-shrink.
//
// The correct motion of `swing` held at two corners is that to which all solvers converge with finer time steps: the
// centre of mass at .33, .50 and .67 s. A sheet that looks stiff because it barely falls is wrong. Inextensible means,
// for `swing` over at least .67 s (see `bars`): strain of the mesh's edges of at most .5 %, and .05 % at the 99th
// percentile; 5 % and .5 % if one corner bears all; with two corners also the correct motion within 2 cm.
#include <math.h>

#include "bench/bench.h"
#include "bench/trajectory.h"

/// Steps per frame of the shrinking sheet; the swinging one, where nothing burns, takes one step of more substeps. A
/// sheet held at one corner whips, so from 100 cells on the substeps grow with the cells.
/// The solver's start, which leaves as little strain with 38 substeps as 60 do without it.
static const float SWING_START = 0.63f;
enum { DEFAULT_STEPS = 20, SWING_SUBSTEPS = 38, ONE_CORNER_SUBSTEPS = 84, ONE_CORNER_CELLS = 100 };

/// Whether the sheet is inextensible and moves correctly; "-" if unknown.
static const char *bars_held(const BenchSetup *setup, const Trajectory *t, double off) {
    const double scale = setup->pins == 1 ? 10 : 1, max = 0.5 * scale, p99 = 0.05 * scale, off_max = 2;
    const BenchValue blue = strain_percent(&t->strain[SINGE_BLUE]);
    if (setup->state != BENCH_SWING) return "-";
    if (t->diverged) return "missed";
    if (isnan(t->fall[TRAJECTORY_MARKS - 1])) return "-";
    return blue.number[0] <= max && blue.number[1] <= p99 && !(off > off_max) ? "held" : "missed";
}

static SingeResult run_all(const BenchOptions *options, BenchSetup *setup, int steps, double seconds,
                           const BenchList *cells, const BenchList *thickness, BenchTable *table, SingeError *error) {
    if (options->steps) steps = options->steps;
    const int frames = (int)fmax(1, round((options->time > 0 ? options->time : seconds) * BENCH_FPS));

    setup->pins = options->pins ? options->pins : 2;
    setup->time_step = 1.0f / (float)(BENCH_FPS * steps);
    for (int c = 0; c < cells->count; c++)
        for (int t = 0; t < thickness->count; t++) {
            setup->cells = (int)cells->values[c];
            setup->thickness = (float)thickness->values[t];
            if (steps == 1 && !options->substeps && !options->steps) {
                const int fine = setup->cells > ONE_CORNER_CELLS ? setup->cells : ONE_CORNER_CELLS;
                const int whip = ONE_CORNER_SUBSTEPS * fine / ONE_CORNER_CELLS;
                setup->solver.substeps = setup->pins == 1 ? whip : SWING_SUBSTEPS;
            }

            Trajectory *trajectory = trajectory_run(setup, frames, steps, INFINITY, error);
            if (!trajectory) return error->code;

            const double off = trajectory_off(setup, trajectory);
            table_number(table, "cells", "%.0f", 5, setup->cells);
            table_number(table, "thickness_mm", "%.3g", 12, 1e3 * (double)setup->thickness);
            table_number(table, "substeps", "%.0f", 8, steps * setup->solver.substeps);
            table_number(table, "cpu_ms", "%.2f", 8, trajectory->cpu_median);
            table_number(table, "mean_ms", "%.2f", 8, trajectory->cpu_mean);
            table_number(table, "dynamics_ms", "%.2f", 11, trajectory->dynamics_ms);
            table_parts(table, "blue_pct", "%.3g", 20, "max/p99/mean", strain_percent(&trajectory->strain[SINGE_BLUE]));
            table_parts(table, "red_pct", "%.3g", 20, "max/p99/mean", strain_percent(&trajectory->strain[SINGE_RED]));
            table_parts(table, "green_pct", "%.3g", 20, "max/p99/mean",
                        strain_percent(&trajectory->strain[SINGE_GREEN]));
            table_parts(table, "yellow_pct", "%.3g", 20, "max/p99/mean",
                        strain_percent(&trajectory->strain[SINGE_YELLOW]));
            table_parts(table, "fall_m", "%.3f", 20, "0.33/0.50/0.67",
                        (BenchValue){.number = {trajectory->fall[0], trajectory->fall[1], trajectory->fall[2]}});
            table_number(table, "off_cm", "%.1f", 6, off);
            table_number(table, "speed", "%.2f", 9, trajectory->speed_max);
            table_number(table, "inverted", "%.0f", 8, trajectory->inverted);
            table_text(table, "bars", 6, bars_held(setup, trajectory, off));
            table_text(table, "result", 8, trajectory->diverged ? "diverged" : "ok");
            trajectory_free(trajectory);
            if (table_end_row(table)) return SINGE_ERROR_MEMORY;
        }

    return SINGE_OK;
}

SingeResult bench_swing(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList cells = bench_list(&options->cells, 4, (const double[]){32, 50, 100, 150});
    BenchList thickness = bench_list(&options->thickness, 3, (const double[]){1e-3, 2e-3, 5e-3});
    BenchSetup setup = sheet_setup(options, BENCH_SWING, DEFAULT_STEPS);
    if (options->smoothing < 0) setup.solver.smoothing = 0; // no damping of any kind
    bool standard = setup.solver.method == SINGE_SOLVER_STRAND && !options->steps && !options->substeps;
    if (standard && options->start < 0) setup.solver.start = SWING_START;
    return run_all(options, &setup, standard ? 1 : DEFAULT_STEPS, 1, &cells, &thickness, table, error);
}

SingeResult bench_hang_and_shrink(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList cells = bench_list(&options->cells, 2, (const double[]){50, 100});
    BenchList thickness = bench_list(&options->thickness, 3, (const double[]){1e-3, 2e-3, 5e-3});
    BenchSetup setup = sheet_setup(options, BENCH_SHRINK, DEFAULT_STEPS);
    return run_all(options, &setup, DEFAULT_STEPS, 2, &cells, &thickness, table, error);
}

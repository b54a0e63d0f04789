// The stage dynamics and its projection, by size: time, arithmetic and memory traffic relative to the machine's peaks.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/peaks.h"
#include "bench/hung_sheet.h"
#include "bench/geometry.h"
#include "bench/timing.h"

static SingeResult dynamics_add_row(BenchTable *table, const BenchSetup *setup, const Peaks *peaks, const SingeSim *sim,
                                    const Timing *timing) {
    Strain *strain = malloc(2 * sizeof *strain);
    if (!strain) return SINGE_ERROR_MEMORY;

    SingeView view = singe_sim_view(sim);
    strain_clear(&strain[0]), strain_clear(&strain[1]);
    strain_add(&strain[0], &view, SINGE_BLUE);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) strain_add(&strain[1], &view, (SingeColour)colour);

    const SingeTimers *t = &timing->total;
    double springs = timing_springs(sim), seconds = t->projection_seconds;
    double sweeps = (double)t->springs_projected / springs;
    if (sweeps == 0) sweeps = (double)timing->steps * setup->solver.substeps * setup->solver.projections; // not counted

    double working_set = t->projection_bytes / sweeps; // of one sweep over all springs
    double gflops = 1e-9 * t->projection_flops / seconds, gb_s = 1e-9 * t->projection_bytes / seconds;
    if (t->projection_flops == 0) gflops = NAN;
    if (t->projection_bytes == 0) gb_s = NAN;
    table_number(table, "springs", "%.0f", 8, springs);
    table_text(table, "solver", 11, enum_words.SingeSolverMethod[setup->solver.method]);

    table_number(table, "threads", "%.0f", 7, setup->threads);
    table_number(table, "step_ms", "%.4g", 8, timing_median(timing, SINGE_STAGE_DYNAMICS));
    table_number(table, "min_ms", "%.4g", 8, timing_min(timing, SINGE_STAGE_DYNAMICS));
    table_number(table, "projection_ms", "%.4g", 13, timing_median(timing, TIMED_PROJECTION));
    table_number(table, "min_proj_ms", "%.4g", 13, timing_min(timing, TIMED_PROJECTION));
    table_number(table, "sweeps", "%.0f", 6, sweeps / timing->steps);
    table_number(table, "ns_spring_sweep", "%.2f", 15, 1e9 * seconds / (sweeps * springs));
    table_number(table, "gflops", "%.2f", 7, gflops);
    table_number(table, "of_peak_pct", "%.1f", 11, 100 * gflops / peaks->gflops);
    table_number(table, "gb_s", "%.2f", 7, gb_s);
    table_number(table, "of_stream_pct", "%.1f", 13, 100 * gb_s / peaks_stream(peaks, working_set / setup->threads));
    table_number(table, "bytes_spring", "%.1f", 12, (double)singe_sim_counts(sim).memory / springs);

    table_parts(table, "blue_pct", "%.3g", 20, "max/p99/mean", strain_percent(&strain[0]));
    table_parts(table, "all_pct", "%.3g", 20, "max/p99/mean", strain_percent(&strain[1]));
    free(strain);
    return table_end_row(table);
}

SingeResult bench_dynamics(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList springs = bench_list(&options->springs, 5, (const double[]){1e3, 4e3, 16e3, 1e5, 1e6});
    BenchSetup setup = sheet_setup(options, options->state, 20);
    Peaks peaks;
    if (!peaks_measure(&peaks, options->threads, options->quick ? 0.1 : 1)) return SINGE_ERROR_MEMORY;
    peaks_tell(&peaks, table);

    SingeResult result = SINGE_OK;
    for (int i = 0; i < springs.count && !result; i++) {
        SingeSim *sim;
        Timing timing = {0};
        setup.cells = options_cells(springs.values[i]);
        if (sheet_build(&setup, &sim, error)) return error->code;

        double count = timing_springs(sim);
        int steps = options->steps ? options->steps : timing_steps(count, 5, 200);
        result = timing_measure(&timing, sim, NULL, timing_steps(count, 5, 240), steps);
        if (result) *error = *singe_sim_error(sim);
        else result = dynamics_add_row(table, &setup, &peaks, sim, &timing);
        timing_free(&timing);
        singe_sim_destroy(sim);
    }

    return result;
}

// Whole burning steps, stage by stage.
#include "bench/bench.h"
#include "bench/hung_sheet.h"
#include "bench/timing.h"

#include <math.h>

enum { WARM_UP = 40 };

/// Compares the step with the limit of the reference machine, scaled by the yardstick's time on this machine.
static SingeResult stages_judge(const BenchOptions *options, const Timing *timing, BenchTable *table,
                                SingeError *error) {
    double step = timing_median(timing, TIMED_SCALED), limit = options->limit_ms;
    double slowness = fmax(1, timing_median(timing, TIMED_YARDSTICK) / timing_yardstick_reference());
    if (limit <= 0) return SINGE_OK;

    if (table->text)
        fprintf(table->text,
                "%.2f ms at the pace of the reference machine (this one is %.2f times slower); "
                "limit %.4g ms\n",
                step, slowness, limit);
    if (step <= limit) return SINGE_OK;

    return refuse(error, SINGE_ERROR_LIMIT, "", -1,
                  "%.2f ms per step at the pace of the reference machine, above the limit of %.4g ms", step, limit);
}

static SingeResult stages_measure(const BenchOptions *options, double springs, Yardstick *yardstick, BenchTable *table,
                                  SingeError *error) {
    SingeSim *sim;
    Timing timing = {0};
    if (burning_build(options, NULL, springs, 1, &sim, error)) return error->code;

    int steps = options->steps ? options->steps : timing_steps(springs, 10, 200);
    SingeResult result = timing_measure(&timing, sim, yardstick, WARM_UP, steps);
    if (result) {
        *error = *singe_sim_error(sim);
    } else {
        const double actual = timing_springs(sim), step = timing_median(&timing, TIMED_STEP);
        table_number(table, "springs", "%.0f", 8, actual);
        table_text(table, "solver", 11, enum_words.SingeSolverMethod[options->solver]);

        table_number(table, "curvature_max", "%.0f", 13, options->curvature.values[0]);
        table_number(table, "threads", "%.0f", 7, options->threads);
        table_number(table, "step_ms", "%.4g", 8, step);
        table_number(table, "min_ms", "%.4g", 8, timing_min(&timing, TIMED_STEP));
        table_number(table, "heat_ms", "%.4g", 8, timing_median(&timing, SINGE_STAGE_HEAT));
        table_number(table, "burn_ms", "%.4g", 8, timing_median(&timing, SINGE_STAGE_BURN));
        table_number(table, "ablate_ms", "%.4g", 9, timing_median(&timing, SINGE_STAGE_ABLATE));
        table_number(table, "dynamics_ms", "%.4g", 11, timing_median(&timing, SINGE_STAGE_DYNAMICS));
        table_number(table, "gas_ms", "%.4g", 8, timing_median(&timing, SINGE_STAGE_GAS));
        table_number(table, "projection_ms", "%.4g", 13, timing_median(&timing, TIMED_PROJECTION));
        table_number(table, "ns_spring", "%.2f", 9, 1e6 * step / actual);
        table_number(table, "heat_iterations", "%.1f", 15, (double)timing.total.heat_iterations / timing.steps);
        table_number(table, "contacts", "%.0f", 8, (double)timing.total.contacts / timing.steps);
        table_number(table, "burnt_pct", "%.2f", 9, 100 * singe_sim_stats(sim).burnt_fraction);
        table_number(table, "bytes_spring", "%.1f", 12, (double)singe_sim_counts(sim).memory / actual);
        table_number(table, "yardstick_ms", "%.2f", 12, timing_median(&timing, TIMED_YARDSTICK));

        result = table_end_row(table);
        if (!result) result = stages_judge(options, &timing, table, error);
    }

    timing_free(&timing);
    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_step(const BenchOptions *options, BenchTable *table, SingeError *error) {
    const double default_limit = (double)singe_default_material().curvature_max.value;
    BenchList springs = bench_list(&options->springs, 1, (const double[]){1e5});
    BenchList limits = bench_list(&options->curvature, 1, &default_limit);
    Yardstick *yardstick = yardstick_create();
    SingeResult result = yardstick ? SINGE_OK : SINGE_ERROR_MEMORY;
    for (int i = 0; i < springs.count; i++)
        for (int l = 0; l < limits.count && !result; l++) {
            BenchOptions limited = *options;
            limited.curvature = (BenchList){.count = 1, .values = {limits.values[l]}};
            result = stages_measure(&limited, springs.values[i], yardstick, table, error);
        }

    yardstick_destroy(yardstick);
    return result;
}

// Whole burning steps, and the stages heat and ablate of them.
#include "bench/bench.h"
#include "bench/burning.h"
#include "bench/timing.h"

#include <math.h>

enum { WARM_UP = 40 };

enum {
    SPRINGS,
    SOLVER,
    LIMIT,
    THREADS,
    STEP_MEDIAN,
    STEP_MIN,
    HEAT,
    BURN,
    ABLATE,
    DYNAMICS,
    GAS,
    PROJECTION,
    NS,
    ITERATIONS,
    CONTACTS,
    BURNT,
    MEMORY,
    YARDSTICK,
    STEP_COLUMNS
};

static const BenchColumn step_columns[STEP_COLUMNS] = {
    [SPRINGS] = {"springs", "%.0f", 8, NULL},      [SOLVER] = {"solver", NULL, 11, NULL},
    [LIMIT] = {"curvature_max", "%.0f", 13, NULL}, [THREADS] = {"threads", "%.0f", 7, NULL},
    [STEP_MEDIAN] = {"step_ms", "%.4g", 8, NULL},  [STEP_MIN] = {"min_ms", "%.4g", 8, NULL},
    [HEAT] = {"heat_ms", "%.4g", 8, NULL},         [BURN] = {"burn_ms", "%.4g", 8, NULL},
    [ABLATE] = {"ablate_ms", "%.4g", 9, NULL},     [DYNAMICS] = {"dynamics_ms", "%.4g", 11, NULL},
    [GAS] = {"gas_ms", "%.4g", 8, NULL},           [PROJECTION] = {"projection_ms", "%.4g", 13, NULL},
    [NS] = {"ns_spring", "%.2f", 9, NULL},         [ITERATIONS] = {"heat_iterations", "%.1f", 15, NULL},
    [CONTACTS] = {"contacts", "%.0f", 8, NULL},    [BURNT] = {"burnt_pct", "%.2f", 9, NULL},
    [MEMORY] = {"bytes_spring", "%.1f", 12, NULL}, [YARDSTICK] = {"yardstick_ms", "%.2f", 12, NULL},
};

enum { STAGE_SPRINGS, STAGE_THREADS, STAGE_MEDIAN, STAGE_MIN, STAGE_NS, STAGE_ITERATIONS, STAGE_GONE, STAGE_COLUMNS };

static const BenchColumn stage_columns[STAGE_COLUMNS] = {
    [STAGE_SPRINGS] = {"springs", "%.0f", 8, NULL},    [STAGE_THREADS] = {"threads", "%.0f", 7, NULL},
    [STAGE_MEDIAN] = {"stage_ms", "%.4g", 9, NULL},    [STAGE_MIN] = {"min_ms", "%.4g", 9, NULL},
    [STAGE_NS] = {"ns_spring", "%.3f", 9, NULL},       [STAGE_ITERATIONS] = {"heat_iterations", "%.1f", 15, NULL},
    [STAGE_GONE] = {"springs_gone", "%.0f", 12, NULL},
};

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
    *error = (SingeError){.code = SINGE_ERROR_LIMIT, .element = -1};
    snprintf(error->message, sizeof error->message,
             "%.2f ms per step at the pace of the reference machine, above the limit of %.4g ms", step, limit);
    return SINGE_ERROR_LIMIT;
}

/// `stage` is one of the stages, or TIMED_STEP for a row of them all.
static SingeResult stages_measure(const BenchOptions *options, int stage, double springs, Yardstick *yardstick,
                                  BenchTable *table, SingeError *error) {
    SingeSim *sim;
    Timing timing = {0};
    BenchValue row[STEP_COLUMNS] = {0};
    const float pace = stage == SINGE_STAGE_ABLATE ? 20 : 1; // so that much is removed while it is timed

    if (burning_build(options, NULL, springs, pace, &sim, error)) return error->code;
    int steps = options->steps ? options->steps : timing_steps(springs, 10, 200);
    SingeResult result = timing_measure(&timing, sim, yardstick, WARM_UP, steps);
    if (result) {
        *error = *singe_sim_error(sim);
    } else {
        if (stage == TIMED_STEP) {
            double actual = timing_springs(sim), step = timing_median(&timing, TIMED_STEP);
            row[SPRINGS] = bench_number(actual);
            row[SOLVER] = bench_text(enum_words.SingeSolverMethod[options->solver]);
            row[LIMIT] = bench_number(options->curvature.values[0]);
            row[THREADS] = bench_number(options->threads);
            row[STEP_MEDIAN] = bench_number(step);
            row[STEP_MIN] = bench_number(timing_min(&timing, TIMED_STEP));
            row[HEAT] = bench_number(timing_median(&timing, SINGE_STAGE_HEAT));
            row[BURN] = bench_number(timing_median(&timing, SINGE_STAGE_BURN));
            row[ABLATE] = bench_number(timing_median(&timing, SINGE_STAGE_ABLATE));
            row[DYNAMICS] = bench_number(timing_median(&timing, SINGE_STAGE_DYNAMICS));
            row[GAS] = bench_number(timing_median(&timing, SINGE_STAGE_GAS));
            row[PROJECTION] = bench_number(timing_median(&timing, TIMED_PROJECTION));
            row[NS] = bench_number(1e6 * step / actual);
            row[ITERATIONS] = bench_number((double)timing.total.heat_iterations / timing.steps);
            row[CONTACTS] = bench_number((double)timing.total.contacts / timing.steps);
            row[BURNT] = bench_number(100 * singe_sim_stats(sim).burnt_fraction);
            row[MEMORY] = bench_number((double)singe_sim_counts(sim).memory / actual);
            row[YARDSTICK] = bench_number(timing_median(&timing, TIMED_YARDSTICK));
        } else {
            double actual = timing_springs(sim), median = timing_median(&timing, stage);
            row[STAGE_SPRINGS] = bench_number(actual);
            row[STAGE_THREADS] = bench_number(options->threads);
            row[STAGE_MEDIAN] = bench_number(median);
            row[STAGE_MIN] = bench_number(timing_min(&timing, stage));
            row[STAGE_NS] = bench_number(1e6 * median / actual);
            row[STAGE_ITERATIONS] = bench_number((double)timing.total.heat_iterations / timing.steps);
            row[STAGE_GONE] = bench_number(actual - singe_sim_stats(sim).springs);
        }

        result = table_add(table, row) ? stages_judge(options, &timing, table, error) : SINGE_ERROR_MEMORY;
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
    *table = table_begin("step", step_columns, STEP_COLUMNS, table->text);
    for (int i = 0; i < springs.count; i++)
        for (int l = 0; l < limits.count && !result; l++) {
            BenchOptions limited = *options;
            limited.curvature = (BenchList){.count = 1, .values = {limits.values[l]}};
            result = stages_measure(&limited, TIMED_STEP, springs.values[i], yardstick, table, error);
        }
    yardstick_destroy(yardstick);
    return result;
}

static SingeResult bench_stage(const char *name, int stage, const BenchOptions *options, BenchTable *table,
                               SingeError *error) {
    BenchList springs = bench_list(&options->springs, 5, (const double[]){1e3, 4e3, 16e3, 1e5, 1e6});
    SingeResult result = SINGE_OK;
    *table = table_begin(name, stage_columns, STAGE_COLUMNS, table->text);
    for (int i = 0; i < springs.count && !result; i++)
        result = stages_measure(options, stage, springs.values[i], NULL, table, error);
    return result;
}

SingeResult bench_heat(const BenchOptions *options, BenchTable *table, SingeError *error) {
    return bench_stage("heat", SINGE_STAGE_HEAT, options, table, error);
}

SingeResult bench_ablate(const BenchOptions *options, BenchTable *table, SingeError *error) {
    return bench_stage("ablate", SINGE_STAGE_ABLATE, options, table, error);
}

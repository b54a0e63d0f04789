// Whole burning steps, stage by stage.
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
    COLUMNS
};

static const BenchColumn columns[COLUMNS] = {
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
        const BenchValue row[COLUMNS] = {
            [SPRINGS] = bench_number(actual),
            [SOLVER] = bench_text(enum_words.SingeSolverMethod[options->solver]),
            [LIMIT] = bench_number(options->curvature.values[0]),
            [THREADS] = bench_number(options->threads),
            [STEP_MEDIAN] = bench_number(step),
            [STEP_MIN] = bench_number(timing_min(&timing, TIMED_STEP)),
            [HEAT] = bench_number(timing_median(&timing, SINGE_STAGE_HEAT)),
            [BURN] = bench_number(timing_median(&timing, SINGE_STAGE_BURN)),
            [ABLATE] = bench_number(timing_median(&timing, SINGE_STAGE_ABLATE)),
            [DYNAMICS] = bench_number(timing_median(&timing, SINGE_STAGE_DYNAMICS)),
            [GAS] = bench_number(timing_median(&timing, SINGE_STAGE_GAS)),
            [PROJECTION] = bench_number(timing_median(&timing, TIMED_PROJECTION)),
            [NS] = bench_number(1e6 * step / actual),
            [ITERATIONS] = bench_number((double)timing.total.heat_iterations / timing.steps),
            [CONTACTS] = bench_number((double)timing.total.contacts / timing.steps),
            [BURNT] = bench_number(100 * singe_sim_stats(sim).burnt_fraction),
            [MEMORY] = bench_number((double)singe_sim_counts(sim).memory / actual),
            [YARDSTICK] = bench_number(timing_median(&timing, TIMED_YARDSTICK)),
        };
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
    *table = table_begin("step", columns, COLUMNS, table->text);
    for (int i = 0; i < springs.count; i++)
        for (int l = 0; l < limits.count && !result; l++) {
            BenchOptions limited = *options;
            limited.curvature = (BenchList){.count = 1, .values = {limits.values[l]}};
            result = stages_measure(&limited, springs.values[i], yardstick, table, error);
        }
    yardstick_destroy(yardstick);
    return result;
}

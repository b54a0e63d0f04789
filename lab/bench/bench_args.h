// The command lines of `singe bench`.
#ifndef BENCH_ARGS_H
#define BENCH_ARGS_H

#include "bench/options.h"
#include "cli/args.h"

/// The options of all measurements.
extern const ArgOption bench_all_options[];
typedef enum BenchOption {
    BENCH_OPT_CELLS,
    BENCH_OPT_SHEETS,
    BENCH_OPT_THICKNESS,
    BENCH_OPT_PINS,
    BENCH_OPT_TIME,
    BENCH_OPT_SUBSTEPS,
    BENCH_OPT_STEPS,
    BENCH_OPT_SMOOTHING,
    BENCH_OPT_THREADS,
    BENCH_OPT_SOLVER,
    BENCH_OPT_INSTRUCTIONS,
    BENCH_OPT_PROJECTIONS,
    BENCH_OPT_SPRINGS,
    BENCH_OPT_STATE,
    BENCH_OPT_LIMIT,
    BENCH_OPT_QUICK,
    BENCH_OPT_TIMED,
    BENCH_OPT_MATERIAL,
    BENCH_OPT_CURVATURE,
    BENCH_OPT_SEEDS,
    BENCH_OPT_OUTLINE,
    BENCH_OPT_CREASES,
    BENCH_OPT_RED,
    BENCH_OPT_JSON,
    BENCH_OPT_CSV,
    BENCH_OPT_SVG,
    BENCH_OPT_COUNT
} BenchOption;

#define BENCH_BIT(option) (1u << BENCH_OPT_##option)

typedef struct BenchRequest {
    BenchOptions options;
    bool json;
    const char *csv;       ///< path, or NULL
    const char *svg;       ///< path, or NULL
    const char *materials; ///< "office-paper,./mine.yaml", or NULL for all that are built in
} BenchRequest;

/// Reads the options in `accepted` (bits) of the measurement `name` ("bench swing"). ARG_END, ARG_HELP or ARG_ERROR.
int bench_args_read(const char *name, const char *summary, unsigned accepted, int argc, char **argv,
                    BenchRequest *request);

#endif

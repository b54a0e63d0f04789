// The command lines of `singe bench`.
#pragma once

#include "bench/options.h"
#include "cli/args.h"

/// The options of all measurements.
enum { BENCH_OPTION_COUNT = 25 };
extern const ArgOption bench_all_options[BENCH_OPTION_COUNT];

typedef struct BenchRequest {
    BenchOptions options;
    bool json;
    const char *csv;       ///< path, or NULL
    const char *svg;       ///< path, or NULL
    const char *materials; ///< "office-paper,./mine.yaml", or NULL for all that are built in
} BenchRequest;

/// Whether a measurement takes an option: `accepted` has its name between spaces, " cells time ".
bool bench_takes(const char *accepted, const char *option);

/// Reads the command line of the measurement `name` ("swing"), as args_read does.
bool bench_args_read(const char *name, const char *summary, const char *accepted, int argc, char **argv,
                     BenchRequest *request, ExitCode *code);

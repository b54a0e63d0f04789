// `singe paper`: a file per table or figure.
#ifndef CLI_PAPER_H
#define CLI_PAPER_H

#include "cli/cli.h"
#include "singe/singe.h"

#include <stdbool.h>

typedef struct PaperOptions {
    const char *folder; ///< where figures go
    bool quick;
    int threads;
} PaperOptions;

ExitCode paper_table1(const PaperOptions *options);
ExitCode paper_table2(const PaperOptions *options);
ExitCode paper_fig8(const PaperOptions *options);
ExitCode paper_all_at_once(const PaperOptions *options);

/// Prints the error and returns the exit code that goes with it.
ExitCode paper_fail(const SingeError *error);

#endif

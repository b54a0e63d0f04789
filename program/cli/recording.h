// The file that `singe run --record` writes.
#pragma once

#include <stdio.h>

#include "cli/cli.h"
#include "cli/console.h"

typedef struct Recording {
    const char *path; ///< NULL: none
    FILE *file;
    int reason; ///< errno of the first write that failed, or 0
} Recording;

/// Creates or empties the file. Prints the error.
ExitCode recording_open(Recording *recording, const char *path, Console *console);

/// Writes to the file at once, so that a crash loses nothing.
SingeRecord recording_hook(Recording *recording);

/// Closes it, if there is one. Prints the error if not all has been written; returns EXIT_FAILED in place of EXIT_GOOD.
ExitCode recording_close(Recording *recording, ExitCode code, Console *console);

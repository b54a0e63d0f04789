// The three standard descriptors, and whether printed output has arrived.
#ifndef CLI_STREAMS_H
#define CLI_STREAMS_H

#include <stdio.h>

#include "cli/cli.h"
#include "cli/console.h"

/// Call this before anything else is opened. It fills closed descriptors 0 to 2, so that none of our files becomes one
/// of them and receives messages. Printing to a closed standard output fails; messages to a closed standard error are
/// lost. Returns 0, or -1 on failure.
int streams_open(void);

/// Checks that printed output has arrived: a full disk, a closed pipe or a closed output is a failure. Returns the
/// command's exit code, or EXIT_FAILED in place of EXIT_GOOD.
int streams_finish(int code);

/// Writes the output of `print`, the table of `--csv`. A file is replaced whole or not at all; a pipe or a device
/// receives it directly. A pipe without a reader is a failure: opening it would wait forever. Prints the error.
ExitCode streams_write(Console *console, const char *path, void (*print)(FILE *file, const void *context),
                       const void *context);

#endif

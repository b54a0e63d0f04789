// The three descriptors that a program is started with, and whether what was printed has arrived.
#ifndef CLI_STREAMS_H
#define CLI_STREAMS_H

#include <stdio.h>

#include "cli/cli.h"
#include "cli/console.h"

/// Before anything else is opened: descriptors 0 to 2 that are closed are taken, so that no file of ours becomes one
/// of them and gets messages written into it. What is printed to a standard output that was closed fails; messages to
/// a standard error that was closed are lost. Returns 0, or -1 where that cannot be done.
int streams_open(void);

/// What was printed must have arrived: a full disk, a closed pipe or no output at all is a failure. Returns the
/// command's exit code, EXIT_FAILED in place of EXIT_GOOD.
int streams_finish(int code);

/// Writes what `print` prints, the table of `--csv`: a file is whole or as it was, and a pipe or a device gets it as it
/// comes. A pipe that nobody reads from is a failure: it would be waited for without end. Prints the error.
ExitCode streams_write(Console *console, const char *path, void (*print)(FILE *file, const void *context),
                       const void *context);

#endif

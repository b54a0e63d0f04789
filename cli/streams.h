// The three descriptors that a program is started with, and whether what was printed has arrived.
#ifndef CLI_STREAMS_H
#define CLI_STREAMS_H

#include <stdio.h>

/// Before anything else is opened: descriptors 0 to 2 that are closed are taken, so that no file of ours becomes one
/// of them and gets messages written into it. What is printed to a standard output that was closed fails; messages to
/// a standard error that was closed are lost. Returns 0, or -1 where that cannot be done.
int streams_open(void);

/// What was printed must have arrived: a full disk, a closed pipe or no output at all is a failure. Returns the
/// command's exit code, EXIT_FAILED in place of EXIT_GOOD.
int streams_finish(int code);

/// Opens a table of `--csv` for writing, in place of what was there; NULL and errno where that fails. A pipe that
/// nobody reads from fails with ENXIO: it would be waited for without end.
FILE *streams_create(const char *path);

#endif

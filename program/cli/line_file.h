// Files that grow by whole lines with the frames: stats.csv, events.csv, probes.csv. A resumed run truncates them to
// the state of its checkpoint.
#ifndef CLI_LINE_FILE_H
#define CLI_LINE_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "singe/base.h"

typedef struct LineFile {
    int fd; ///< -1 when closed
    const char *path;
    int64_t size; ///< bytes of whole lines
} LineFile;
#define LINE_FILE_CLOSED \
    { .fd = -1 }

/// Opens the file and changes nothing in it. A link, a pipe or a device in its place is refused. `path` is kept.
SINGE_NODISCARD SingeResult lines_open(LineFile *file, const char *path, SingeError *error);
/// Empties the file and writes the header, which has its line end.
SINGE_NODISCARD SingeResult lines_begin(LineFile *file, const char *header, SingeError *error);
/// Appends whole lines; if they do not fit on the disk, none is left.
SINGE_NODISCARD SingeResult lines_append(LineFile *file, const char *text, size_t size, SingeError *error);
/// Whether a line (from 0, after the header) is as expected. The length excludes its end.
typedef bool LineCheck(uint64_t line, const char *text, size_t size, void *context);
/// Truncates the file to the header and `count` lines, which must exist and pass the check (NULL: none). `what` is for
/// the message: "frames 1 to 12".
SINGE_NODISCARD SingeResult lines_cut(LineFile *file, const char *header, uint64_t count, LineCheck *check,
                                      void *context, const char *what, SingeError *error);
/// Asks the system to put the lines on the disk, as a checkpoint relies on them.
SINGE_NODISCARD SingeResult lines_sync(LineFile *file, SingeError *error);
void lines_close(LineFile *file);

#endif

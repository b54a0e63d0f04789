// Files that grow by whole lines beside the frames, and that a resumption cuts back to what its checkpoint stands for:
// stats.csv, events.csv, probes.csv.
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
/// Appends whole lines; what does not fit on the disk is taken back.
SINGE_NODISCARD SingeResult lines_append(LineFile *file, const char *text, size_t size, SingeError *error);
/// Whether a line, from 0 behind the header, is what it must be. Its end is not counted.
typedef bool LineCheck(uint64_t line, const char *text, size_t size, void *context);
/// Cuts the file behind the header and `count` lines, which must be there and pass the check (NULL: any do). `what` is
/// for the message: "frames 1 to 12".
SINGE_NODISCARD SingeResult lines_cut(LineFile *file, const char *header, uint64_t count, LineCheck *check,
                                      void *context, const char *what, SingeError *error);
/// Asks the system to put the lines on the disk, as a checkpoint relies on them.
SINGE_NODISCARD SingeResult lines_sync(LineFile *file, SingeError *error);
void lines_close(LineFile *file);

#endif

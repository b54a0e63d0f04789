// DIR/stats.csv: a header, then one line per frame, on the disk as soon as the frame is.
#ifndef CLI_STATS_FILE_H
#define CLI_STATS_FILE_H

#include "cli/folder.h"
#include "cli/totals.h"

typedef struct StatsFile {
    int fd; ///< -1 when closed
    const char *path;
    int64_t size; ///< bytes of whole lines
} StatsFile;

/// What a frame took (ms) and drew.
typedef struct FrameCost {
    double stage[SINGE_STAGE_COUNT], surface, output; ///< output is with the surface
    uint64_t triangles, fine_triangles;
} FrameCost;

/// Opens the file and changes nothing in it. A link, a pipe or a device in its place is refused.
SINGE_NODISCARD SingeResult stats_open(StatsFile *file, const Folder *folder, SingeError *error);
/// Empties the file and writes the header.
SINGE_NODISCARD SingeResult stats_begin(StatsFile *file, SingeError *error);
/// Cuts the file behind the lines of so many frames, which must be there.
SINGE_NODISCARD SingeResult stats_cut(StatsFile *file, int frames_kept, SingeError *error);
/// Appends a line; a line that does not fit on the disk is taken back whole.
SINGE_NODISCARD SingeResult stats_write(StatsFile *file, int frame, const SingeStats *stats, const Totals *totals,
                                        const FrameCost *cost, SingeError *error);
/// Asks the system to put the lines on the disk, as a checkpoint relies on them.
SINGE_NODISCARD SingeResult stats_sync(StatsFile *file, SingeError *error);
void stats_close(StatsFile *file);

#endif

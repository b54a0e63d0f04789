// DIR/stats.csv: a header, then one line per frame, on the disk as soon as the frame is.
#ifndef CLI_STATS_FILE_H
#define CLI_STATS_FILE_H

#include "cli/line_file.h"
#include "cli/totals.h"

/// The times of a frame (ms) and its triangles.
typedef struct FrameCost {
    double stage[SINGE_STAGE_COUNT], surface, output; ///< output includes the surface
    uint64_t triangles, fine_triangles;
} FrameCost;

/// Empties the file and writes the header.
SINGE_NODISCARD SingeResult stats_begin(LineFile *file, SingeError *error);
/// Truncates the file after the lines of so many frames, which must exist.
SINGE_NODISCARD SingeResult stats_cut(LineFile *file, int frames_kept, SingeError *error);
/// Appends a line; nothing of it is left if it does not fit on the disk.
SINGE_NODISCARD SingeResult stats_write(LineFile *file, int frame, const SingeStats *stats, const Totals *totals,
                                        const FrameCost *cost, SingeError *error);

#endif

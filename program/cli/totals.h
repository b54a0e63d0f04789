// Totals of a run since its first frame, over all resumptions.
#ifndef CLI_TOTALS_H
#define CLI_TOTALS_H

#include "singe/sim.h"

enum { TOTAL_SURFACE, TOTAL_PLY, TOTAL_PREVIEW, TOTAL_CHECKPOINT, TOTAL_OUTPUT_COUNT };

/// Fixed layout without padding: it is part of the checkpoint.
typedef struct Totals {
    double stage_seconds[SINGE_STAGE_COUNT];
    double output_seconds[TOTAL_OUTPUT_COUNT];
    double wall_seconds;
    uint64_t steps, heat_iterations, strands_projected, contacts;
    uint64_t ignited, holes_opened, pieces_freed;
    uint64_t crossed; ///< pairs of triangles of the first frame
    double hottest;   ///< K, of all frames
} Totals;

#endif

// What `singe verify` counts in a frame, and the checks that do it (docs/cli.md).
#ifndef ANALYSIS_FINDINGS_H
#define ANALYSIS_FINDINGS_H

#include "analysis/cache.h"
#include "analysis/initial.h"

typedef enum Fault {
    FAULT_CROSSING,     ///< pairs of triangles
    FAULT_INVERTED,     ///< cells, as stats.csv has them
    FAULT_STRETCHED,    ///< edges
    FAULT_NON_MANIFOLD, ///< edges of more than two triangles
    FAULT_WINDING,      ///< edges whose two triangles run the same way along them
    FAULT_DEGENERATE,   ///< triangles without area
    FAULT_DUPLICATE,    ///< triangles of the same three vertices as another
    FAULT_NOT_FINITE,   ///< values
    FAULT_MISSING,      ///< properties
    FAULT_INDEX,        ///< triangles with a corner that names no vertex
    FAULT_STATS,        ///< values of stats.csv that the frame contradicts
    FAULT_COUNT
} Fault;

typedef struct Findings {
    void (*report)(void *context, bool fault, const char *message); ///< of a fault, or of what else there is to say
    void *context;
    const char *file; ///< the frame's path, for messages
    double stretch;   ///< edges longer than this many times their length at rest count
    uint64_t count[FAULT_COUNT];
    uint64_t near;             ///< of the crossings, those of triangles side by side at rest
    bool begins;               ///< this is the first frame of the run: what crosses in it crosses from the start
    Initial initial;           ///< what did, to be freed
    uint64_t from_start;       ///< crossings of what did; no fault
    uint64_t folded;           ///< edges whose triangles lie on one another; no fault
    int reported[FAULT_COUNT]; ///< messages so far
} Findings;

/// Counts a fault, and reports it when it is one of the first of its kind.
void findings_add(Findings *findings, Fault fault, const char *format, ...) SINGE_PRINTF(3, 4);

/// Values that are not finite, missing properties, indices out of range.
void check_values(const CacheFrame *frame, Findings *findings);

/// All that edges and triangles have. False when out of memory.
bool check_surface(const CacheFrame *frame, Findings *findings);

/// Takes what crosses in the first frame of the run, and counts and tells nothing. False when out of memory.
bool check_start(const CacheFrame *frame, Findings *findings);

#endif

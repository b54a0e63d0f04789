// The faults that `singe verify` counts in a frame, and the checks that find them (docs/cli.md).
#pragma once

#include "analysis/cache.h"

typedef enum Fault {
    FAULT_CROSSING,     ///< pairs of triangles
    FAULT_INVERTED,     ///< cells, as in stats.csv
    FAULT_STRETCHED,    ///< edges
    FAULT_NON_MANIFOLD, ///< edges of more than two triangles
    FAULT_WINDING,      ///< edges whose two triangles run the same way along them
    FAULT_DEGENERATE,   ///< triangles without area
    FAULT_DUPLICATE,    ///< triangles with the same three vertices as another
    FAULT_NOT_FINITE,   ///< values
    FAULT_MISSING,      ///< properties
    FAULT_INDEX,        ///< triangles with a corner that names no vertex
    FAULT_STATS,        ///< values of stats.csv that the frame contradicts
    FAULT_COUNT
} Fault;

/// A triangle that crosses another in the first frame: it has no side to be kept on.
typedef struct InitialTriangle {
    float at[3]; ///< m, the triangle's centre at rest
    float reach; ///< m
    int32_t sheet;
} InitialTriangle;

typedef struct Initial {
    InitialTriangle *triangles; ///< in ascending order of x
    size_t count;
    float reach; ///< m, the largest
} Initial;

typedef struct Findings {
    void (*report)(void *context, bool fault, const char *message); ///< reports a fault, or other information
    void *context;
    const char *file; ///< the frame's path, for messages
    double stretch;   ///< edges longer than this many times their length at rest are faults
    uint64_t count[FAULT_COUNT];
    uint64_t near;             ///< crossings of triangles that are next to each other at rest
    bool begins;               ///< this is the first frame of the run: its crossings are initial
    Initial initial;           ///< the initial crossings, to be freed
    uint64_t from_start;       ///< pairs of `initial` that cross; no fault
    uint64_t folded;           ///< edges whose triangles are folded onto each other; no fault
    int reported[FAULT_COUNT]; ///< messages so far
} Findings;

/// Counts a fault, and reports it when it is one of the first of its kind.
void findings_add(Findings *findings, Fault fault, const char *format, ...) SINGE_PRINTF(3, 4);

void initial_free(Initial *initial);

/// Checks for values that are not finite, missing properties, and indices out of range.
void check_values(const CacheFrame *frame, Findings *findings);

/// Checks for all faults of edges and triangles. False when out of memory.
bool check_surface(const CacheFrame *frame, Findings *findings);

/// Records the crossings in the first frame of the run; counts and reports nothing. False when out of memory.
bool check_start(const CacheFrame *frame, Findings *findings);

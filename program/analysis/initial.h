// The triangles that cross others in the first frame of a cache: these have no side to be kept on.
#ifndef ANALYSIS_INITIAL_H
#define ANALYSIS_INITIAL_H

#include "analysis/cache.h"
#include "analysis/crossings.h"
#include "singe/sim.h"

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

/// Records the triangles of pairs that cross. False when out of memory. Free it, after failure too.
bool initial_take(Initial *initial, const CacheFrame *frame, const uint32_t (*pairs)[2], size_t count);
void initial_free(Initial *initial);

/// Counts the crossing pairs of triangles of a surface; `at` gets a corner of the first, m. False when out of memory.
bool initial_count(const SingeSurface *surface, uint64_t *pairs, float at[3]);

/// Whether both triangles are near an initial crossing.
bool initial_has(const Initial *initial, const CacheFrame *frame, uint32_t a, uint32_t b);

#endif

// Pairs of triangles of a surface that cross (docs/cli.md, verify), found without any code of the solver.
#ifndef ANALYSIS_CROSSINGS_H
#define ANALYSIS_CROSSINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct CrossingList {
    size_t count;         ///< pairs
    uint32_t (*pairs)[2]; ///< [count] the lower number first, in ascending order
    size_t capacity;
    uint64_t tested; ///< pairs whose boxes overlapped
} CrossingList;

/// Finds the pairs of triangles that cross, by triangle_pair.h or hinges.h. Corners must be finite and not on a line.
/// False when out of memory. Free the list, after failure too.
bool crossings_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t count, CrossingList *list);
void crossings_free(CrossingList *list);

#endif

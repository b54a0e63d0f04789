// Pairs of triangles of a surface that go through each other (docs/cli.md, verify), found without any of the solver.
#ifndef ANALYSIS_CROSSINGS_H
#define ANALYSIS_CROSSINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct CrossingList {
    size_t count;         ///< pairs
    uint32_t (*pairs)[2]; ///< [count] the lower number first, in ascending order
    size_t capacity;
    uint64_t tested; ///< pairs whose boxes met
} CrossingList;

/// Finds the pairs that cross among triangles of finite corners that are not on a line: by triangle_pair.h or hinges.h.
/// False when out of memory. The list is to be freed, after failure too.
bool crossings_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t count, CrossingList *list);
void crossings_free(CrossingList *list);

#endif

// Pairs of triangles of a surface that cross (docs/cli.md, verify), found without any code of the solver.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "singe/sim.h"

typedef struct CrossingList {
    size_t count;         ///< pairs
    uint32_t (*pairs)[2]; ///< [count] the lower number first, in ascending order
    size_t capacity;
    uint64_t tested; ///< pairs whose boxes overlapped
} CrossingList;

/// Finds the pairs of triangles that cross. Corners must be finite and not on a line. False when out of memory. Free the
/// list, after failure too.
bool crossings_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t count, CrossingList *list);
void crossings_free(CrossingList *list);

/// Counts the crossing pairs of triangles of a surface; `at` gets a corner of the first, m. False when out of memory.
bool crossings_count(const SingeSurface *surface, uint64_t *pairs, float at[3]);

// ---- the two ways to cross

typedef const float *Corners[3]; ///< three points of three finite coordinates, not on a line

/// Whether the interiors of the two, without edges and corners, have a point in common. So triangles that only touch do
/// not cross, be it at a corner or along an edge, shared or not; triangles in one plane cross if they overlap in an
/// area. *touch: whether an edge of one lies in the plane of the other, so that they may still cross there (hinges_find).
bool triangles_cross(const Corners a, const Corners b, bool *touch);

/// At contacts surfaces may cross along an edge that lies exactly in the other's plane. No two triangles' interiors meet
/// there; only the next triangle shows on which side the surface continues.
///
/// Keeps the pairs whose surfaces cross at an edge of one that has two triangles and runs through the other or along an
/// edge of it; *count gets their number. The two triangles at an edge share its vertices, or have their own at the same
/// positions, as at a seam. Each crossing is kept for the lower triangle on either side. Pairs that cross otherwise
/// must not be in the list. False when out of memory.
bool hinges_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t triangle_count,
                 uint32_t (*pairs)[2], size_t *count);

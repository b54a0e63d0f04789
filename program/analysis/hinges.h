// Crossings at contacts: surfaces that cross along an edge that lies exactly in the other's plane. No two triangles'
// interiors meet there (triangle_pair.h); only the next triangle shows on which side the surface continues.
#ifndef ANALYSIS_HINGES_H
#define ANALYSIS_HINGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Keeps the pairs whose surfaces cross at an edge of one that has two triangles and runs through the other or along an
/// edge of it; *count gets their number. The two triangles at an edge share its vertices, or have their own at the same
/// positions, as at a seam. Each crossing is kept for the lower triangle on either side. Pairs that cross otherwise
/// must not be in the list. False when out of memory.
bool hinges_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t triangle_count,
                 uint32_t (*pairs)[2], size_t *count);

#endif

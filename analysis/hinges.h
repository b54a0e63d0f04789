// Crossings that touch: surfaces that go through each other along an edge that lies exactly in the other's plane. No
// two triangles' insides meet there (triangle_pair.h), and which way the surface goes on only the next triangle tells.
#ifndef ANALYSIS_HINGES_H
#define ANALYSIS_HINGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Keeps those of the pairs whose surfaces cross at an edge of one, and of two triangles there, that runs through the
/// other or along an edge of it, and returns their number in *count. The two triangles at an edge have its vertices, or
/// two of their own at the same positions, as at a seam. Each crossing is kept for the lower triangle of either side.
/// Pairs that cross otherwise must not be among them. False when out of memory.
bool hinges_find(const float (*position)[3], const uint32_t (*triangles)[3], uint32_t triangle_count,
                 uint32_t (*pairs)[2], size_t *count);

#endif

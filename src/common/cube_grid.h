// A hashed grid of cubes (Teschner et al., Optimized spatial hashing, 2003) of members that reach no farther than a cube:
// all that reach a position lie in the 27 cubes about it.
#pragma once

#include "common/float3.h"
#include "common/memory.h"

#include <stdint.h>

#define CUBE_GRID_END UINT32_MAX

typedef struct CubeGrid {
    uint32_t count, mask; ///< members, and slots less one
    uint32_t *first;      ///< [mask + 1] the member of a slot that was added last, or CUBE_GRID_END
    uint32_t *next;       ///< [count] the one of its slot that was added before it, or CUBE_GRID_END
    float cube;           ///< side of the cubes, m
} CubeGrid;

/// An empty grid of up to `count` members. False when out of memory; then cube_grid_free is still to be called.
bool cube_grid_create(Memory *memory, uint32_t count, CubeGrid *grid);
void cube_grid_free(Memory *memory, CubeGrid *grid);

/// Takes all members out, and makes the cubes as large as what is farthest from a member that reaches it.
void cube_grid_clear(CubeGrid *grid, float cube);
void cube_grid_add(CubeGrid *grid, uint32_t member, const float position[3]);

/// The heads of the lists of the 27 cubes about a position. Two may be the same.
void cube_grid_around(const CubeGrid *grid, Float3 position, uint32_t first[27]);

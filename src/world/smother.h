// Sheets that keep air from others.
#pragma once

#include "common/cube_grid.h"
#include "common/pool.h"
#include "shell/shell.h"

/// Cells that keep air from other sheets, in a grid.
typedef struct Smother {
    uint32_t count;    ///< 0: none, and no arrays
    uint32_t *cells;   ///< [count]
    float (*balls)[4]; ///< [count] centroid, and how far about it the cell reaches, m
    CubeGrid grid;     ///< of those that are left
    float thickness;   ///< m, the largest of any sheet
} Smother;

/// Lists the cells that keep air from other sheets. SINGE_ERROR_MEMORY; then smother_free is still to be called.
SingeResult smother_create(Memory *memory, const Shell *shell, Smother *smother);
void smother_free(Memory *memory, Smother *smother);

/// Fills the grid with the cells where they are now. False: none of them is left, and nothing is covered.
bool smother_place(Smother *smother, const Shell *shell, const StateInput *state, Pool *pool);

/// Whether another sheet keeps air from a particle, after smother_place.
bool smother_covers(const Smother *smother, const Shell *shell, const StateInput *state, uint32_t particle);

// Meshes for tests that results do not depend on a mesh's orientation: squares and discs cut from a rotated grid.
#pragma once

#include "mesh/to_quads.h"

typedef struct TurnedGrid {
    double size;   ///< m, side of the square or diameter of the disc, centred at the origin in the x-y plane
    double across; ///< m, the other side of a rectangle; 0: the same
    int cells;     ///< along size
    bool disc;
    double angle;  ///< rad, of the grid's lines against x; the outline stays
    GridWear wear; ///< of the grid before it is cut
} TurnedGrid;

/// Makes the cells whose centroid lies a quarter of a cell or more within the outline. Their vertices beyond it move
/// onto it: a side that cuts across cells has teeth of at most half a cell. uv goes from (0,0) at (-x,-y) to (1,1) on
/// the outline.
SINGE_NODISCARD SingeResult turned_grid(const TurnedGrid *cut, Mesh *mesh, SingeError *error);

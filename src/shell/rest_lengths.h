// Rest measures of cells, particles and springs.
#pragma once

#include "common/float3.h"
#include "shell/shell.h"

typedef struct CellShape {
    double centre[3];         ///< m, mean of the corners
    double normal[3];         ///< unit, towards the front; zero if the vector area is
    double vector_area;       ///< m2, length of half the cross product of the diagonals
    double area;              ///< m2, of the four triangles around the centre
    double corner_area[4];    ///< m2, each corner's share; sums to `area`
    double shortest, longest; ///< m, sides
} CellShape;

CellShape cell_shape(const float *const corners[4]);

/// Fills the centres' rest positions, and areas; corners are in place.
void measure_particles(Shell *shell);

/// Fills the rest lengths of all springs and each sheet's cell size. Fails with SINGE_ERROR_MESH if a spring has no
/// length, as when neighbouring centres coincide.
SingeResult measure_springs(Shell *shell, SingeError *error);

/// cos 2(angle to the cell's fibres) of a direction in its plane, times the square of the share of `along` that lies in it.
float cell_grain(const Shell *shell, uint32_t cell, Float3 along);

/// Fills the springs' `grain` where a sheet shrinks more in one direction; rest positions and lengths are in place.
/// False when out of memory.
bool measure_fibres(Memory *memory, Shell *shell);

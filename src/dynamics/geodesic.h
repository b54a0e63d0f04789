// Geodesic distances on the shell's surface.
#pragma once

#include "shell/shell.h"

/// Scratch for one search, over the vertices of all sheets.
typedef struct Geodesic {
    uint32_t *heap;     ///< [vertex_count] vertices waiting, nearest first
    uint32_t *position; ///< [vertex_count] in the heap, or GEODESIC_FAR or GEODESIC_DONE
    uint32_t waiting;
} Geodesic;

bool geodesic_create(Memory *memory, uint32_t vertex_count, Geodesic *search);
void geodesic_free(Memory *memory, uint32_t vertex_count, Geodesic *search);

/// Distances from `source` to the vertices [first, last) of its sheet over the cells that are alive, with the springs'
/// target lengths as metric, but between held vertices at least their actual distance; INFINITY where there is no path.
void geodesic_from(Geodesic *search, const Shell *shell, const StateInput *state, uint32_t source, uint32_t first,
                   uint32_t last, float *distance);

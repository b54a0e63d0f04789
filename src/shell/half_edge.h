// Adjacency of the cells of a quad mesh.
//
// Half-edge 4 c + i is side i of cell c, from its corner i to corner i + 1. Its twin is the same edge in the
// neighbouring cell, with the opposite direction.
#pragma once

#include "common/assertion.h"
#include "shell/shell.h"

typedef struct HalfEdges {
    const Shell *shell;  ///< whose vertices and cells these are
    uint32_t *twin;      ///< [4 * cell_count], or SHELL_NONE at the boundary
    uint32_t *fan_start; ///< [vertex_count] half-edge leaving the vertex, first in turning order
    uint32_t *fan_size;  ///< [vertex_count] cells around the vertex
    uint32_t fan_longest;
    uint32_t edge_count;
    uint32_t shared_count; ///< edges with two cells
} HalfEdges;

/// Matches the sides of the cells, checks that they form a manifold with consistent orientation, and numbers edges:
/// fills blue and green (one for each shared edge) of shell->cell_springs.
SingeResult half_edge_build(Memory *memory, Shell *shell, HalfEdges *mesh, SingeError *error);
void half_edge_free(Memory *memory, HalfEdges *mesh);

static inline uint32_t half_edge_previous(uint32_t half) { return (half & ~3u) | ((half + 3) & 3); }

/// The half-edge that leaves the same vertex one cell further counter-clockwise, or SHELL_NONE.
static inline uint32_t half_edge_turn(const HalfEdges *mesh, uint32_t half) {
    return mesh->twin[half_edge_previous(half)];
}

/// The cell across side i of a cell that has one there.
static inline uint32_t half_edge_across(const HalfEdges *mesh, uint32_t cell, int i) {
    SINGE_ASSERT(cell < mesh->shell->cell_count);
    return mesh->twin[4 * cell + (uint32_t)i] / 4;
}

/// True if the cells around the vertex form a closed ring.
static inline bool half_edge_is_inside(const HalfEdges *mesh, uint32_t vertex) {
    SINGE_ASSERT(vertex < mesh->shell->vertex_count);
    return mesh->fan_size[vertex] && mesh->twin[mesh->fan_start[vertex]] != SHELL_NONE;
}

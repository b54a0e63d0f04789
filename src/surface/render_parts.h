// What the making, the binding and the drawing of a render mesh have in common. Nothing outside src/surface includes
// this.
#pragma once

#include "surface/surface_fine.h"

struct RenderMesh {
    uint32_t cell_first, cell_count; ///< of its sheet
    bool beside;                     ///< the sheet is drawn, too
    uint32_t left_out, odd_edges;    ///< of RenderFlaws
    uint32_t vertex_count, vertex_capacity;
    RenderVertex *vertices;
    uint32_t triangle_count, triangle_capacity;
    uint32_t (*triangles)[3];
    uint32_t (*triangle_edges)[3]; ///< [triangle_count] from corner i to the next one
    uint32_t edge_count, edge_capacity;
    uint32_t (*edges)[2];
};

/// Finds the position of the sheet at rest that is nearest to `offset`, m, of the vertices from `first` on, or the one
/// that has their uv: their feet. `fine` has the sheet's surface at rest, and cells from 0. Vertices farther than `reach`
/// (m) are refused.
SingeResult render_find_feet(const Fine *fine, bool by_uv, float reach, uint32_t first, RenderMesh *mesh,
                             SingeError *error);

/// Fills what the vertices keep from their feet: offsets and normals in the frames there, from `rest` and from the
/// normals in space; by uv these are first those of the sheet at the feet.
void render_bind(const Fine *fine, bool by_uv, RenderMesh *mesh);

// Meshes that are drawn in place of a sheet: finer than its cells, thick, with hems, seams and buttons. A mesh is bound
// to a sheet once, by positions at rest, and drawn with it. Only the sheet is simulated.
#pragma once

#include "surface/surface.h"

/// Where a mesh is bound.
typedef struct RenderSheet {
    const SheetSource *source; ///< the sheet as it was added, so that tears do not change what is bound where
    uint32_t cell_first;       ///< of its cells
    float cell_size;           ///< m, median edge
    float bulge_max;           ///< m, of SurfaceDetail
    int32_t number_first;      ///< of the mesh's vertices, in the drawn surface
} RenderSheet;

/// Checks a mesh, divides edges that are too long, and binds it. SINGE_ERROR_MESH: damaged, or too far from the sheet;
/// `element` is the vertex or triangle. SINGE_ERROR_ARGUMENT, SINGE_ERROR_LIMIT, SINGE_ERROR_MEMORY.
SingeResult render_mesh_create(Memory *memory, Pool *pool, const RenderSheet *sheet, const SingeRenderMeshDef *def,
                               RenderMesh **mesh, SingeError *error);
void render_mesh_free(Memory *memory, RenderMesh *mesh);

/// What is wrong with a mesh that is drawn all the same.
typedef struct RenderFlaws {
    uint32_t left_out;  ///< triangles without an area, or with the corners of an earlier one
    uint32_t odd_edges; ///< of more than two triangles, or of two that are wound against each other
} RenderFlaws;

RenderFlaws render_mesh_flaws(const RenderMesh *mesh);

/// Whether a cell is not drawn because the mesh is.
bool render_hides(const RenderMesh *mesh, uint32_t cell);

// The drawn surface: marching triangles along the level set of ablation (section 6). A drawing changes nothing of the
// simulation. Its scratch comes from an allocator and is freed before it returns.
#pragma once

#include "ablate/ablate.h"

/// Draws every remaining cell as four triangles. Grows `surface` through its allocator; empties it on failure.
SingeResult surface_draw(AblatePlan *plan, const Shell *shell, const State *state, SingeSurface *surface,
                         SingeError *error);

/// A mesh that is drawn in place of a sheet (render_mesh.h).
typedef struct RenderMesh RenderMesh;

/// How finely the surface is drawn near the front.
typedef struct SurfaceDetail {
    float size;                ///< m, distance of the points of the level set, > 0
    float raggedness;          ///< m, max depth of the raggedness of burnt edges, >= 0
    uint32_t seed;             ///< of the noise; each sheet has its own
    const float *room;         ///< [vertices] m, distance of another surface, or INFINITY; NULL: none is near
    float bulge_max;           ///< m, max distance of the surface from flat triangles; 0: only by the cells' size
    RenderMesh *const *meshes; ///< [mesh_count] drawn in place of their sheets
    uint32_t mesh_count;
} SurfaceDetail;

/// The same, refined near the front. Scratch comes from `memory`.
SingeResult surface_draw_fine(AblatePlan *plan, const Shell *shell, const State *state, const SurfaceDetail *detail,
                              Memory *memory, Pool *pool, SingeSurface *surface, SingeError *error);

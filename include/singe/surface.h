/// Singe: the results of a simulation for renderers: the surface of its sheets, and the gas.
///
/// What it does not do: it has no colours and no light. Temperature, `burn` and what is left of char and ash say how a
/// vertex should look; program/preview is one way. Vertices have no identity from frame to frame but `source_vertex`.
#ifndef SINGE_SURFACE_H
#define SINGE_SURFACE_H

#include "singe/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The drawn mesh: cells as four triangles around a virtual centre, cut by the level set m - m_loss
/// (eq 7, Fig 6). With a `surface_detail`, cells near the front are refined, burnt edges are ragged by noise fixed to
/// the sheet, and the mesh lies on a smooth surface (docs/equations/surface.md). Vertices of the input keep their
/// `source_vertex`. The surface owns all arrays.
typedef struct SingeSurface {
    uint32_t vertex_count, triangle_count;
    uint32_t fine_triangle_count; ///< triangles in refined cells
    float (*position)[3];         ///< m
    float (*normal)[3];           ///< unit length; area-weighted means if the surface is not smooth
    float (*uv)[2];               ///< 0 if the sheet has none
    float (*velocity)[3];         ///< m/s, displacement over time since the last frame (`velocity_steps` of the Def)
    float (*rest_position)[3];    ///< m
    float *temperature;           ///< K
    float *temperature_peak;      ///< K, highest so far; it decides how brown paper is
    float *mass;                  ///< fraction
    float *burn_rate;             ///< 1/s
    float *char_fraction;         ///< of the initial mass: black char that can still glow
    float *ash_fraction;          ///< of the initial mass: grey ash, which neither pyrolyses nor glows
    float *burn;                  ///< burn progress (1 - m)/(1 - m_min), 0 fresh to 1 ash
    float *time_ignited;          ///< s, -1 never
    int32_t *piece;               ///< id
    /// vertex of the input mesh (numbered over all sheets, then over all render meshes), -1: new; several vertices on a
    /// seam may share it
    int32_t *source_vertex;
    int32_t *sheet;                              ///< index of the sheet, in the order added
    uint32_t (*triangles)[3];                    ///< counter-clockwise seen from the front
    uint32_t vertex_capacity, triangle_capacity; ///< allocated
    SingeAllocator allocator;                    ///< of the arrays
    float *water;                                ///< over the mass before it burns; 0 where no sheet holds water
    bool wet;                                    ///< a sheet held water at the start
} SingeSurface;

/// Frees a surface's arrays and zeroes its `struct_size` bytes, the caller's sizeof; NULL is allowed.
SINGE_API void singe_surface_release(SingeSurface *surface, size_t struct_size);

static inline void singe_surface_free(SingeSurface *surface) { singe_surface_release(surface, sizeof *surface); }

/// A mesh that is drawn in place of a sheet: finer than its cells, thick, with hems, seams and buttons. Each vertex is
/// bound to the position of the sheet at rest that is nearest to it, and keeps its distance from there, along the sheet
/// and along its normal. The mesh burns and tears with the sheet and has its temperature, char and all else; nothing of
/// the mesh acts on the simulation (src/surface/render_mesh.c).
///
/// Defaults: 0 or NULL.
typedef struct SingeRenderMeshDef {
    size_t struct_size;
    uint32_t vertex_count;
    uint32_t triangle_count;
    const float *positions;    ///< [3 * vertex_count] m, where the sheet is at rest
    const float *uv;           ///< [2 * vertex_count], or NULL: the sheet's
    const uint32_t *triangles; ///< [3 * triangle_count] counter-clockwise seen from outside
    float reach;               ///< m, 0 to 1e4; largest distance of a vertex from the sheet; 0: the side of a cell
    /// m, 0 to 1e4; longer edges are halved until none is longer; 0: half the side of a cell, which is also the maximum
    float edge_max;
    float rigid; ///< m, 0 to 1e4; connected parts up to this size keep their shape, as buttons do; 0: none
    bool beside; ///< yes: the sheet is drawn as well
    /// yes: each vertex lies where the sheet has the same uv, and its position in the file is ignored; for meshes that
    /// were modelled elsewhere or in another pose. reach and rigid do not matter then
    bool by_uv;
} SingeRenderMeshDef;

/// Fills a Def with the defaults: `struct_size` bytes, the caller's sizeof.
SINGE_API void singe_init_render_mesh(SingeRenderMeshDef *def, size_t struct_size);

static inline SingeRenderMeshDef singe_default_render_mesh(void) {
    SingeRenderMeshDef def;
    singe_init_render_mesh(&def, sizeof def);
    return def;
}

/// The hot gas around the sheets, on a grid of cubes of side `cell` along the axes, x fastest. Cell (i, j, k) is entry
/// i + size[0] (j + size[1] k) and spans origin + cell (i..i+1, j..j+1, k..k+1). Values hold at its centre.
typedef struct SingeGas {
    uint32_t size[3];           ///< cells; all 0 if the simulation has no gas
    float origin[3];            ///< m, lower corner of cell (0, 0, 0)
    float cell;                 ///< m
    const float *temperature;   ///< K
    const float *smoke;         ///< kg/m3 of soot
    const float *flame;         ///< W/m3, heat release rate
    const float (*velocity)[3]; ///< m/s
} SingeGas;

#ifdef __cplusplus
}
#endif
#endif

/// Singe: converts meshes of triangles and polygons to the quads of a sheet (docs/meshes.md). These functions are in
/// libsinge_input, a second library. They need no simulation.
///
/// What they do not do: they read no files, make no uv, and change no resolution: cells are as large as the faces, and
/// with SINGE_MESH_SPLIT their sides are half as long.
/// Parts of a mesh that cross each other stay so.
#ifndef SINGE_MESH_H
#define SINGE_MESH_H

#include "singe/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/// How faces that are not quads become quads.
typedef enum SingeMeshQuads {
    SINGE_MESH_PAIR = 0,  ///< triangles are joined two by two; cells are about as large as the faces
    SINGE_MESH_SPLIT = 1, ///< every face of n corners becomes n quads; its sides are halved
} SingeMeshQuads;

/// A mesh whose faces have three corners or more, counter-clockwise seen from the front. The caller may free its arrays
/// after the call.
///
/// Defaults: quads SINGE_MESH_PAIR, smallest 0.02; all else 0 or NULL.
typedef struct SingeMeshDef {
    size_t struct_size;
    const char *name; ///< for messages; NULL is "mesh"
    uint32_t vertex_count;
    const float *positions;     ///< [3 * vertex_count] m, finite
    uint32_t face_count;        ///< at least 1
    const uint32_t *face_sizes; ///< [face_count] corners of each face, 3 to 4096; NULL: all have 3
    const uint32_t *corners;    ///< [sum of face_sizes] vertices, face after face
    const float *uv;            ///< [2 * vertex_count], or NULL
    const float *corner_uv;     ///< [2 * corners] instead of uv where a mesh has seams, or NULL
    uint32_t attribute_count;
    const SingeAttribute *attributes; ///< [attribute_count] of the vertices; interpolated to the new mesh
    /// how triangles and polygons become quads: pair joins triangles two by two; split cuts every face of n corners
    /// into n quads with sides half as long
    SingeMeshQuads quads;
    /// m, >= 0; vertices on open edges of the mesh that are this close are merged, whatever their uv; 0: 1/100000 of
    /// its size
    float weld;
    float smallest;           ///< 0 to 1; sides below this share of the median side are collapsed; 0: none
    SingeAllocator allocator; ///< zeroed: libc's
    SingeLog log;             ///< receives a summary of the mesh and each repair; zeroed: none
} SingeMeshDef;

SINGE_API void singe_init_mesh(SingeMeshDef *def, size_t struct_size);

static inline SingeMeshDef singe_default_mesh(void) {
    SingeMeshDef def;
    singe_init_mesh(&def, sizeof def);
    return def;
}

/// A flat rectangle of cells about the origin of the x-y plane, front upwards, with uv from (0, 0) at its lowest x and
/// y.
///
/// Defaults: size {0.2, 0.2}, cells {50, 50}, jitter 0.15, seed 1; all else 0 or NULL.
typedef struct SingeGridDef {
    size_t struct_size;
    float size[2];     ///< m, 1e-6 to 1e4; along x and y
    uint32_t cells[2]; ///< 1 to 20000; number of cells along x and y
    /// 0 to 0.3; displacement of vertices off the grid, in cells, so that folds and fronts follow no grid lines; at
    /// most twice as much of the width of slim cells; 0 is regular
    float jitter;
    float displacement; ///< m, 0 to 1e3; root mean square displacement of the rest shape by smooth waves; 0 is flat
    uint32_t seed;      ///< seed of jitter and displacement
    SingeAllocator allocator; ///< zeroed: libc's
} SingeGridDef;

SINGE_API void singe_init_grid(SingeGridDef *def, size_t struct_size);

static inline SingeGridDef singe_default_grid(void) {
    SingeGridDef def;
    singe_init_grid(&def, sizeof def);
    return def;
}

/// Quads, ready for a sheet.
typedef struct SingeMesh SingeMesh;

/// Converts a mesh to quads. Vertices are welded; faults are repaired or refused. A mesh of quads without faults keeps
/// its vertices, its cells and their order. Free the result by singe_mesh_destroy. On failure *mesh is NULL and *error
/// (may be NULL) says why: SINGE_ERROR_MESH with the face or vertex in `element`, SINGE_ERROR_ARGUMENT,
/// SINGE_ERROR_LIMIT or SINGE_ERROR_MEMORY.
SINGE_API SINGE_NODISCARD SingeResult singe_mesh_create(const SingeMeshDef *def, SingeMesh **mesh, SingeError *error);

/// Makes a grid. Errors as singe_mesh_create.
SINGE_API SINGE_NODISCARD SingeResult singe_mesh_create_grid(const SingeGridDef *def, SingeMesh **mesh,
                                                             SingeError *error);

/// Frees a mesh; NULL is allowed.
SINGE_API void singe_mesh_destroy(SingeMesh *mesh);

/// The mesh in the form of a sheet's Def. The mesh owns the arrays.
typedef struct SingeMeshView {
    size_t struct_size;
    uint32_t vertex_count, cell_count, attribute_count;
    uint32_t source_count;               ///< vertices of the SingeMeshDef; 0 without source_vertex
    const float *positions;              ///< [3 * vertex_count] m
    const uint32_t *cells;               ///< [4 * cell_count]
    const float *uv;                     ///< [2 * vertex_count], or NULL
    const float *corner_uv;              ///< [8 * cell_count], or NULL: those of the vertices
    const SingeAttribute *attributes;    ///< [attribute_count]
    const int32_t *source_vertex;        ///< [vertex_count] of the SingeMeshDef, -1 for a new one; NULL: the same
    const int32_t *corner_source_vertex; ///< [4 * cell_count] the same of the cells' corners, or NULL
    const uint32_t
        *became; ///< [source_count] what each vertex of the SingeMeshDef is now, UINT32_MAX: of no face; NULL
                 ///< with source_vertex
} SingeMeshView;

/// Fills `struct_size` bytes of a view, the caller's sizeof. Its fields that this library does not know become 0.
SINGE_API void singe_mesh_read(const SingeMesh *mesh, SingeMeshView *view, size_t struct_size);

static inline SingeMeshView singe_mesh_view(const SingeMesh *mesh) {
    SingeMeshView view;
    singe_mesh_read(mesh, &view, sizeof view);
    return view;
}

/// Points a sheet's Def at the mesh, which must outlive the call of singe_sim_add_sheet. The rest of the Def stays.
static inline void singe_mesh_fill_sheet(const SingeMesh *mesh, SingeSheetDef *sheet) {
    const SingeMeshView view = singe_mesh_view(mesh);
    sheet->vertex_count = view.vertex_count;
    sheet->positions = view.positions;
    sheet->cell_count = view.cell_count;
    sheet->cells = view.cells;
    sheet->uv = view.uv;
    sheet->corner_uv = view.corner_uv;
    sheet->attribute_count = view.attribute_count;
    sheet->attributes = view.attributes;
    sheet->source_vertex = view.source_vertex;
    sheet->source_count = view.source_count;
    sheet->corner_source_vertex = view.corner_source_vertex;
}

/// The new index of a vertex of the SingeMeshDef, for pins; UINT32_MAX: no face uses the vertex, or the index is out of
/// range.
static inline uint32_t singe_mesh_vertex(const SingeMesh *mesh, uint32_t vertex) {
    const SingeMeshView view = singe_mesh_view(mesh);
    if (view.became) return vertex < view.source_count ? view.became[vertex] : UINT32_MAX;
    return vertex < view.vertex_count ? vertex : UINT32_MAX;
}

#ifdef __cplusplus
}
#endif
#endif

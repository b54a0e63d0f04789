// Makes the quads of a sheet from the polygons of a file (docs/meshes.md): vertices are welded, faults are repaired or
// refused, and triangles and polygons become quads. The core accepts only quads.
#pragma once

#include "mesh/polygons.h"
#include "singe/mesh.h"

/// A sheet's mesh: quads.
typedef struct Mesh {
    uint32_t vertex_count, cell_count, attribute_count;
    float *positions;       ///< [3 * vertex_count], m or file units
    float *uv;              ///< [2 * vertex_count] or NULL; on a seam, the uv of one of its charts
    float *corner_uv;       ///< [8 * cell_count] of each cell's corners if there are seams; else NULL
    uint32_t *cells;        ///< [4 * cell_count]
    uint32_t *cell_lines;   ///< [cell_count] the file's line of each, from 1 (OBJ), or NULL
    uint32_t *cell_faces;   ///< [cell_count] the file's face of each, or NULL if the numbers are the same
    int32_t *source;        ///< [vertex_count] the file's vertex, -1 for a new one; NULL if the numbers are the same
    int32_t *corner_source; ///< [4 * cell_count] the same for the cells' corners if the file had several; else NULL
    uint32_t source_count;  ///< vertices of the file
    uint32_t *became;       ///< [source_count] the vertex that each of the file's became, UINT32_MAX if it is left out;
                            ///< NULL if source is NULL
    SingeAttribute *attributes; ///< of the vertices
    SingeAllocator allocator;
} Mesh;

/// The default Defs, from the rows of singe/grid.def and mesh.def.
SingeGridDef mesh_grid_default(void);
SingeMeshDef mesh_default(void);

/// A flat grid of cells_x × cells_y cells of the given size (m), centred at the origin in the x-y plane,
/// uv from (0,0) at (-x,-y) to (1,1).
SINGE_NODISCARD SingeResult mesh_grid(float size_x, float size_y, uint32_t cells_x, uint32_t cells_y,
                                      SingeAllocator allocator, Mesh *mesh, SingeError *error);
/// Imperfections of a grid, as in SingeGridDef.
typedef struct GridWear {
    float jitter, displacement;
    uint32_t seed;
} GridWear;

/// Moves the vertices of a mesh_grid off its lines, so that folds and fronts have no lines to follow, and up and down
/// in smooth waves about half as long as the shorter side. The outline from above and the meaning of uv stay.
void mesh_grid_wear(Mesh *mesh, uint32_t cells_x, uint32_t cells_y, const GridWear *wear);
void mesh_free(Mesh *mesh);

// ---- from polygons to quads

/// As in SingeMeshDef.
typedef struct MeshOptions {
    SingeMeshQuads quads;
    float weld;     ///< distance (in units of positions) within which vertices on open edges are merged; 0: MESH_WELD
    float smallest; ///< sides below this share of the median side collapse to a point; 0: none
} MeshOptions;

#define MESH_WELD 1e-5f ///< share of the diagonal of the box around the mesh

/// Changes to a mesh.
typedef enum MeshRepair {
    MESH_UNUSED,     ///< vertices of no face, left out
    MESH_WELDED,     ///< vertices merged with another at their position
    MESH_SHRUNK,     ///< very short sides whose ends became one vertex
    MESH_REPEATED,   ///< faces that named a vertex twice
    MESH_SPIKE,      ///< faces that doubled back along themselves
    MESH_CONCAVE,    ///< faces with a hole or a notch, cut into triangles
    MESH_DEGENERATE, ///< faces without area, left out
    MESH_DUPLICATE,  ///< faces with the same corners as another, left out
    MESH_JUNCTION,   ///< vertices inserted into sides that they lie on
    MESH_TURNED,     ///< faces wound against their neighbours, flipped
    MESH_INSIDE_OUT, ///< closed surfaces that were inside out, flipped
    MESH_CUT,        ///< sides of more than two faces, split
    MESH_ONE_SIDED,  ///< sides at which a one-sided surface was cut
    MESH_BOW_TIE,    ///< copies of vertices whose faces met only there
    MESH_PAIRED,     ///< pairs of triangles that became a quad
    MESH_HALVED,     ///< sides that got a vertex at their midpoint, so that their triangles became quads
    MESH_SPLIT,      ///< faces split into quads
    MESH_REPAIRS
} MeshRepair;

typedef struct MeshReport {
    uint32_t faces, vertices;            ///< of the file
    uint32_t triangles, quads, polygons; ///< of its faces
    uint32_t seam_vertices;              ///< with more than one uv
    uint32_t components;
    uint32_t count[MESH_REPAIRS];
    uint32_t first[MESH_REPAIRS]; ///< line, or else number from 0, of the first face or vertex that was changed
    bool lines;                   ///< faces are reported by line
} MeshReport;

MeshOptions mesh_default_options(void);

/// Makes the quads. `name` is the file's, for messages. A mesh of quads without faults keeps its vertices, cells and
/// their order. SINGE_ERROR_MESH if the mesh cannot be repaired; the message has the line or number of the face.
SINGE_NODISCARD SingeResult mesh_make(const char *name, const Polygons *polygons, const MeshOptions *options,
                                      SingeAllocator allocator, Mesh *mesh, MeshReport *report, SingeError *error);

/// Writes the index-th sentence about the mesh to `text`: first a summary, then the changes. False if there is none.
bool mesh_report_line(const MeshReport *report, int index, char *text, size_t size);

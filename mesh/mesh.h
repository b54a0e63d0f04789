// From the polygons of a file to the quads of a sheet (docs/meshes.md): vertices are welded, what is broken is repaired
// or refused, and triangles and polygons become quads. The core knows quads alone.
#ifndef MESH_MESH_H
#define MESH_MESH_H

#include "formats/formats.h"

/// A sheet's mesh: quads.
typedef struct Mesh {
    uint32_t vertex_count, cell_count, attribute_count;
    float *positions;       ///< [3 * vertex_count], m or file units
    float *uv;              ///< [2 * vertex_count] or NULL; on a seam that of one of its charts
    float *corner_uv;       ///< [8 * cell_count] of each cell's corners, where there are seams; else NULL
    uint32_t *cells;        ///< [4 * cell_count]
    uint32_t *cell_lines;   ///< [cell_count] the file's line of each, from 1 (OBJ), or NULL
    uint32_t *cell_faces;   ///< [cell_count] the file's face of each, or NULL where they are the same
    int32_t *source;        ///< [vertex_count] the file's vertex, -1 for a new one; NULL where they are the same
    int32_t *corner_source; ///< [4 * cell_count] the same of the cells' corners, where the file had several; else NULL
    uint32_t source_count;  ///< vertices of the file
    uint32_t *became; ///< [source_count] the vertex that the file's vertex is now, UINT32_MAX where it is left out;
                      ///< NULL with source
    SingeAttribute *attributes; ///< of the vertices
    SingeAllocator allocator;
} Mesh;

/// A flat grid of cells_x × cells_y cells of the given size (m), centred at the origin in the x-y plane,
/// uv from (0,0) at (-x,-y) to (1,1).
SINGE_NODISCARD SingeResult mesh_grid(float size_x, float size_y, uint32_t cells_x, uint32_t cells_y,
                                      SingeAllocator allocator, Mesh *mesh, SingeError *error);
/// What keeps a grid from being perfect.
typedef struct GridWear {
    float jitter;       ///< of a cell, how far vertices lie off the grid at most, 0 to 0.3
    float displacement; ///< m, root mean square height of the waves in which the sheet lies, >= 0
    uint32_t seed;
} GridWear;

/// Moves the vertices of a mesh_grid: off its lines, so that folds and fronts find none to follow, and up and down
/// in smooth waves about half as long as the shorter side. The outline from above, and what uv means, stay.
void mesh_grid_wear(Mesh *mesh, uint32_t cells_x, uint32_t cells_y, const GridWear *wear);
void mesh_free(Mesh *mesh);

// ---- from polygons to quads

/// How faces that are not quads become quads.
typedef enum MeshQuads {
    MESH_QUADS_PAIR = 0, ///< triangles are joined two by two; cells are as large as the file's
    MESH_QUADS_SPLIT,    ///< every face of n corners becomes n quads; the file's sides are halved
} MeshQuads;

typedef struct MeshOptions {
    MeshQuads quads;
    float weld;     ///< distance (as positions) at which vertices on open edges are one; 0: MESH_WELD of the size
    float smallest; ///< sides below this share of the median side shrink to a point; 0: none
} MeshOptions;

#define MESH_WELD 1e-5f     ///< of the diagonal of the box around the mesh
#define MESH_SMALLEST 0.02f ///< of the median side

/// What may be done to a mesh.
typedef enum MeshRepair {
    MESH_UNUSED,     ///< vertices of no face left out
    MESH_WELDED,     ///< vertices joined to another one at their position
    MESH_SHRUNK,     ///< very short sides whose ends became one vertex
    MESH_REPEATED,   ///< faces that named a vertex twice
    MESH_SPIKE,      ///< faces that went out and came back the same way
    MESH_CONCAVE,    ///< faces with a hole or a bay cut into triangles
    MESH_DEGENERATE, ///< faces without area left out
    MESH_DUPLICATE,  ///< faces left out whose corners another face has
    MESH_JUNCTION,   ///< vertices put into sides that they lie on
    MESH_TURNED,     ///< faces wound against their neighbours turned over
    MESH_INSIDE_OUT, ///< closed surfaces turned inside out
    MESH_CUT,        ///< sides of more than two faces cut apart
    MESH_ONE_SIDED,  ///< sides at which a surface came back to itself the other way round cut apart
    MESH_BOW_TIE,    ///< copies of vertices whose faces met in that point alone
    MESH_PAIRED,     ///< pairs of triangles that became a quad
    MESH_HALVED,     ///< sides that got a vertex in their centre so that the triangles at them became quads
    MESH_SPLIT,      ///< faces split into quads
    MESH_REPAIRS
} MeshRepair;

typedef struct MeshReport {
    uint32_t faces, vertices;            ///< of the file
    uint32_t triangles, quads, polygons; ///< of its faces
    uint32_t seam_vertices;              ///< with more than one uv
    uint32_t components;
    uint32_t count[MESH_REPAIRS];
    uint32_t first[MESH_REPAIRS]; ///< line, or else number from 0, of the first face or vertex it was done to
    bool lines;                   ///< faces are reported by line
} MeshReport;

MeshOptions mesh_default_options(void);

/// Makes the quads. `name` is the file's, for messages. A mesh of quads without faults keeps its vertices, cells and
/// their order. SINGE_ERROR_MESH where the mesh cannot be repaired: the message has the line or number of the face.
SINGE_NODISCARD SingeResult mesh_make(const char *name, const Polygons *polygons, const MeshOptions *options,
                                      SingeAllocator allocator, Mesh *mesh, MeshReport *report, SingeError *error);

/// Whether the index-th sentence about the mesh could be written to `text`: first what it is, then what was done.
bool mesh_report_line(const MeshReport *report, int index, char *text, size_t size);

#endif

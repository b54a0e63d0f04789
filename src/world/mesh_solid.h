// A solid inside a closed triangle mesh.
#pragma once

#include "common/error.h"
#include "common/memory.h"
#include "common/float4.h"
#include "common/float3.h"

/// Triangles at a leaf of the tree, and children of a node.
enum { SOLID_WIDE = 4 };

/// Four triangles side by side: a corner and the edges from it. Unused lanes repeat the last triangle.
typedef struct SolidLeaf {
    Float4 a[3], ab[3], ac[3];
} SolidLeaf;

/// Four boxes side by side, and their contents: node `child`, or leaf ~child. An empty one is infinitely far.
typedef struct SolidNode {
    Float4 low[3], high[3];
    int32_t child[SOLID_WIDE];
} SolidNode;

typedef struct MeshSolid {
    uint32_t vertex_count, triangle_count;
    uint32_t room; ///< capacity of the arrays: the triangles given, plus one
    float (*vertices)[3];
    uint32_t (*triangles)[3];
    // derived from them
    uint32_t (*neighbours)[3];  ///< across edge k, which runs from corner k to the next
    float (*vertex_normals)[3]; ///< weighted by angles, not normalised; NULL if vertices move
    uint32_t *order;            ///< [triangles] in the order of the leaves
    uint32_t leaf_count, node_count;
    SolidLeaf *leaves;
    SolidNode *nodes;
    Float3 low, high; ///< of the vertices
    float cell;       ///< m, side of the cells of the grid
    int32_t cells[3];
    Float3 origin;
    float *coarse; ///< signed distances at the centres of the cells; NULL if vertices move
    bool turned;   ///< the given mesh was inside out
} MeshSolid;

/// Checks and copies a mesh, and builds the data for its distances. Vertices at the same position are merged, and
/// triangles that this makes degenerate are removed; a mesh that is inside out is flipped. Errors name the triangle or
/// vertex.
SingeResult mesh_solid_create(Memory *memory, uint32_t vertex_count, const float *vertices, uint32_t triangle_count,
                              const uint32_t *triangles, MeshSolid *solid, SingeError *error);

/// The same for a mesh whose vertices will move: without a grid of distances and vertex normals, which would have to be
/// rebuilt.
SingeResult mesh_solid_create_moving(Memory *memory, uint32_t vertex_count, const float *vertices,
                                     uint32_t triangle_count, const uint32_t *triangles, MeshSolid *solid,
                                     SingeError *error);
void mesh_solid_free(Memory *memory, MeshSolid *solid);

/// See collider_distance.
float mesh_solid_distance(const MeshSolid *solid, Float3 p, float limit, Float3 *normal);

// mesh_check.c
/// Fills in vertices, triangles and neighbours.
SingeResult mesh_solid_take(Memory *memory, uint32_t vertex_count, const float *vertices, uint32_t triangle_count,
                            const uint32_t *triangles, MeshSolid *solid, SingeError *error);

// mesh_tree.c
/// Fills in order, leaves and nodes; false when out of memory.
bool mesh_tree_create(Memory *memory, MeshSolid *solid);

/// Updates the leaves, the boxes, `low` and `high` after vertices have moved.
void mesh_tree_refit(MeshSolid *solid);

/// The triangle nearest to p among those nearer than sqrt(*square), which becomes its squared distance; UINT32_MAX:
/// none.
uint32_t mesh_tree_nearest(const MeshSolid *solid, Float3 p, float *square);

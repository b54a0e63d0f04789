// A mesh while it is repaired: what the files of this folder share.
#pragma once

#include "common/float3.h"
#include "mesh/to_quads.h"

#define MESH_NONE UINT32_MAX
/// A face is degenerate if twice its area is at most this times the square of its longest side. The core's limit is
/// half of this (src/shell/sheet.c).
#define FACE_THIN 4e-6

/// Memory that is freed all at once.
typedef struct WorkBlock {
    struct WorkBlock *next;
} WorkBlock;

/// Faces with contiguous corners. A half-edge has the number of the corner at which it begins.
typedef struct Faces {
    uint32_t count, corner_count;
    uint32_t capacity, corner_capacity;
    uint32_t *first;  ///< [count + 1]
    uint32_t *corner; ///< [corner_count] vertex
    float (*uv)[2];   ///< [corner_count] or NULL
    int32_t *id;      ///< [corner_count] vertex of the file, -1 for a new one
    uint32_t *origin; ///< [count] face of the file
} Faces;

typedef struct Work {
    const char *name;
    const Polygons *file;
    MeshReport *report;
    SingeError *error;
    WorkBlock *blocks;
    bool no_memory;
    bool shrunk; ///< faces vanish because their sides collapsed, which is already reported
    uint32_t vertex_count, vertex_capacity, attribute_count;
    double (*position)[3];
    int32_t *source;   ///< vertex of the file, -1 for a new one
    uint32_t *became;  ///< [file's vertices] the vertex that each became
    float *attributes; ///< [vertex_capacity * attribute_count]
    Faces faces;
    uint32_t *face;  ///< [corner_count] the corner's face (work_edges)
    uint32_t *twin;  ///< [corner_count] the same side in the other face; MESH_NONE (work_edges)
    double weld;     ///< distance within which vertices are merged
    double smallest; ///< sides below this share of the median side collapse
} Work;

/// Zeroed memory; NULL, and work->no_memory is set, when out of memory.
void *work_new(Work *work, size_t count, size_t size);
void work_free(Work *work);

/// Empty faces with these capacities; with uv if the mesh has it.
Faces work_faces(Work *work, uint32_t faces, uint32_t corners);
/// Makes room for more faces and corners. False when out of memory.
bool work_faces_room(Work *work, Faces *faces, uint32_t more_faces, uint32_t more_corners);
/// Appends a corner to the face that is being made, with the uv of corner `from` of `old`.
void faces_push(Faces *faces, uint32_t vertex, const Faces *old, uint32_t from);
/// Appends a corner of a new vertex, with the uv between those of corners `a` and `b` of `old`.
void faces_push_between(Faces *faces, uint32_t vertex, const Faces *old, uint32_t a, uint32_t b);
/// Ends the face that is being made.
void faces_end(Faces *faces, uint32_t origin);

/// A new vertex at the mean of others; MESH_NONE when out of memory.
uint32_t work_vertex(Work *work, const uint32_t *of, uint32_t count);
/// A copy of a vertex, with its number in the file.
uint32_t work_copy(Work *work, uint32_t vertex);

static inline uint32_t faces_next(const Faces *faces, const uint32_t *face, uint32_t half) {
    return half + 1 < faces->first[face[half] + 1] ? half + 1 : faces->first[face[half]];
}
static inline uint32_t faces_previous(const Faces *faces, const uint32_t *face, uint32_t half) {
    return half > faces->first[face[half]] ? half - 1 : faces->first[face[half] + 1] - 1;
}

/// Half-edges in the order of their lower and then their higher end, those of an edge in their own order.
uint32_t *work_sorted_edges(Work *work);
/// How many half-edges of `order` from `at` on are the same edge.
uint32_t work_edge_size(const Work *work, const uint32_t *order, uint32_t at);
/// Fills work->face and twin; an edge of more than two faces has no twins.
void work_edges(Work *work);

/// Counts a change to a face or vertex of the file.
void work_did(Work *work, MeshRepair repair, uint32_t count, uint32_t first);
/// The line of a face of the file, or its number.
uint32_t work_face_name(const Work *work, uint32_t origin);
/// Fails at a face of the file.
SingeResult work_refuse(const Work *work, uint32_t origin, const char *what);

static inline uint32_t sets_find(uint32_t *set, uint32_t i) {
    while (set[i] != i) i = set[i] = set[set[i]];
    return i;
}
/// The smaller number stays.
static inline bool sets_join(uint32_t *set, uint32_t a, uint32_t b) {
    a = sets_find(set, a);
    b = sets_find(set, b);
    if (a < b) set[b] = a;
    else set[a] = b;
    return a != b;
}
uint32_t *work_sets(Work *work, uint32_t count);

double distance3(const double *a, const double *b);
/// Twice the area times the normal.
void face_area(const Work *work, uint32_t face, double normal[3]);

/// Replaces each vertex v by to[v], in the corners and in work->became.
void work_rename(Work *work, const uint32_t *to);

/// Marks the vertices on open edges; work->twin is filled.
void work_mark_open(const Work *work, uint8_t *open);

/// A hash table of vertices by their box in a grid (weld.c).
typedef struct Positions {
    double size;
    uint32_t slots;
    uint32_t *head, *next; ///< [slots] and [vertices], MESH_NONE at the end
} Positions;

Positions positions_make(Work *work, double size);
void positions_add(const Work *work, Positions *positions, uint32_t vertex);
void positions_box(const Positions *positions, const double *position, int64_t box[3]);
uint32_t positions_slot(const Positions *positions, const int64_t box[3]);

// ---- the steps, each of which makes new faces

/// Merges vertices on open edges within work->weld of each other (weld.c).
void mesh_weld(Work *work);
/// Merges the ends of sides shorter than work->smallest times the median side (collapse.c).
SingeResult mesh_shrink(Work *work);
/// Leaves out faces without area and duplicates; splits faces that touch themselves or are not visible from their
/// centroid (clean.c).
SingeResult mesh_clean(Work *work);
/// Leaves out faces with the same corners as an earlier one (clean.c).
void mesh_leave_out_copies(Work *work);
/// Inserts vertices into the open sides that they lie on (junction.c).
SingeResult mesh_junctions(Work *work);
/// Splits edges of more than two faces, makes the winding consistent, outwards on closed surfaces, and gives every fan
/// of faces its own vertex (manifold.c).
void mesh_manifold(Work *work);
/// Cuts polygons into triangles and joins these to quads (pair.c, match.c). False if some triangle stays single.
bool mesh_pair(Work *work);

/// A mesh keeps its order if at least this share of its sides has ends with consecutive numbers.
#define MESH_IN_ORDER 0.25
/// A mesh with fewer cells keeps its order.
#define MESH_ORDER_MIN 256
/// Numbers vertices and quads row by row, unless the mesh keeps its order (renumber.c).
void mesh_order(Work *work);

/// Grows `mate` to a maximum matching of a graph: a largest set of edges that share no node (match.c). Node v's edges
/// are arc_to[arc_first[v]] up to arc_first[v + 1]; mate is MESH_NONE for a single node. `open` nodes may stay single,
/// and do so in preference to others.
void match_grow(Work *work, uint32_t count, const uint32_t *arc_first, const uint32_t *arc_to, const uint8_t *open,
                uint32_t *mate);

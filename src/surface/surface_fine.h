// The drawn surface refined near the front: shared declarations of the files fine_*.c.
#pragma once

#include "common/float3.h"
#include "common/float4.h"
#include "surface/render_mesh.h"
#include "surface/surface_parts.h"

/// A cell's side is split into at most this many parts.
enum { FINE_SPLITS_MAX = 16 };

/// Flags of a cell.
enum {
    FINE_NEAR = 1,       ///< near the front: its points are numbered
    FINE_SPLIT = 2,      ///< the level changes sign in it
    FINE_EVEN = 4,       ///< no refinement: uniform mass, and level not negative
    FINE_WHOLE = 8,      ///< no cell around it is gone
    FINE_TEAR_EDGE = 16, ///< at a tear
};

/// The fields that are drawn smoothly.
typedef enum SplineField {
    SPLINE_LEVEL,
    SPLINE_WHOLE,
    SPLINE_MASS,
    SPLINE_FUEL,
    SPLINE_TEMPERATURE,
    SPLINE_PEAK,
    SPLINE_RATE,
    SPLINE_TEAR_EDGE,
    SPLINE_COUNT
} SplineField;

/// One such field: the coefficients of a C1 quadratic spline over the cells' triangles (fine_spline.c).
typedef struct Spline {
    float *edge;   ///< [blue springs]
    float *corner; ///< [vertices]
} Spline;

/// A position on the sheet: a triangle of a cell and the weights of its corners side, side + 1 and the cell's centre.
typedef struct FineLocation {
    uint32_t cell;
    uint8_t side;
    float weight[3];
} FineLocation;

/// Level and mass at a position.
typedef struct FineValue {
    float level, mass;
} FineValue;

/// A vertex of a render mesh, or a cut of one: bound to a position on its sheet (render_mesh.c).
typedef struct RenderVertex {
    FineLocation foot;          ///< where it is bound
    float offset[3], normal[3]; ///< from there, m, and unit length: along the foot's frame (fine_frame)
    float slack;                ///< 1, or by how much more the sheet must bend than at rest until it presses the offset
    float rest[3];              ///< m, as it was given
    float uv[2];                ///< the sheet's is drawn without has_uv
    int32_t source;             ///< number in the drawn surface, or -1 for a new one
    bool has_uv;
    bool rigid; ///< of a part that keeps its shape
} RenderVertex;

/// A vertex to draw.
typedef struct FineVertex {
    FineLocation location;
    float mass;
    uint32_t source;            ///< vertex of the input, or SHELL_NONE
    const RenderVertex *render; ///< what is drawn there in place of the sheet, or NULL
} FineVertex;

/// How a sheet's cells near the front are split.
typedef struct FineSheet {
    int splits;    ///< k: a side becomes k fine ones
    float reach;   ///< m, max depth to which noise erodes the edge
    int octaves;   ///< of the noise
    uint32_t seed; ///< of its first octave
} FineSheet;

/// A drawing in progress. Points are numbered: vertices, cells' centres, points on split sides of cells near the front,
/// points within these cells.
typedef struct Fine {
    const Shell *shell;
    const State *state;
    const float *level; ///< [particles] m'
    const uint8_t *rim; ///< [vertices] 1 at the mesh's boundary
    Memory *memory;
    Pool *pool;
    const float *room; ///< [vertices] m, of SurfaceDetail
    float bulge_max;   ///< m, of SurfaceDetail
    FineSheet *sheets; ///< [sheets]
    Spline splines[SPLINE_COUNT];
    float *raw_level;     ///< [particles] m'; below 0 for particles that are gone
    float *cell_value;    ///< [cells] scratch of the splines
    float (*least)[2];    ///< [vertices] no level below 0 is less in the cells around it, and in their quarters there
    float (*axes)[2];     ///< [cells] m, lengths of a cell's two axes at rest
    uint8_t *flags;       ///< [cells] FINE_NEAR and the like
    uint32_t *cell_point; ///< [cells] first of its points; where FINE_NEAR
    uint32_t *side_point; ///< [blue springs] first of the points on a side, or SHELL_NONE
    uint32_t *near;       ///< [near_count] the cells near the front
    uint32_t *side_owner; ///< [side_count] 4 cell + side, in which a numbered side's points are evaluated
    uint8_t *bent;        ///< [cells] parts of a side that show a cell's bending, if it is not split
    uint32_t *bent_point; ///< [cells] as cell_point, for points of bent cells
    uint32_t *bent_side;  ///< [blue springs] as side_point, for bent cells; swapped with it once cells are settled
    uint8_t *splits;      ///< [cells] k of the cell as it is drawn
    uint8_t *parts;       ///< [blue springs] parts of a side as drawn: the max of its cells'
    uint32_t near_count, side_count, point_count;
    FineValue *values;  ///< [point_count]
    uint32_t *drawn;    ///< [point_count] 1 + index of the vertex drawn there, 0 for none
    uint32_t *side_cut; ///< [blue springs] first of the side's entries in `cuts`
    uint32_t *cuts;     ///< [cut_count] 1 + index of the vertex that cuts a fine side, 0 for none
    uint32_t cut_count;
    float (*normal)[3]; ///< [particles] unit, or 0
    float *max;         ///< [vertices] m, max displacement from the flat triangles there
    float *share;       ///< [vertices] fraction of the displacement to the patches that is applied
    float (*corner)[4]; ///< [vertices] m, corners of the flat triangles
    uint8_t *sound;     ///< [cells] 1: alive and not torn
    float (*bend)[4];   ///< [vertices] 1/m, the largest curvature around, concave on the normal's side and on the other
    float *mesh_room;   ///< [vertices] m, as `room`, farther for render meshes
    float *valence;     ///< [vertices] n of fine_patch.c
    float *regular;     ///< [vertices] 1 where the patches around meet with the same derivatives, else 0
    float (*inner)[4][3]; ///< [cells] m, points of the patches beside the corners,
    float (*rail)[2][3];  ///< [blue springs] on sides, in the order of their ends,
    float (*limit)[3];    ///< [vertices] and at the corners
    float (*shift)[3];    ///< [vertices] m, added to inner and rail where they are used; limit includes it
    FineVertex *vertices; ///< [vertex_capacity]
    uint32_t vertex_count, vertex_capacity;
    uint32_t *cell_triangle; ///< [cells + 1] first of a cell's triangles, where the sheets have seams; else NULL
    RenderMesh *const *meshes;
    uint32_t mesh_count;
    struct RenderDrawing *renders;            ///< [mesh_count]
    uint64_t extra_vertices, extra_triangles; ///< max numbers that the render meshes add
    SingeSurface *surface;
} Fine;

/// Axes at a position of the drawn surface: along its cell's first axis, across it, and the normal.
typedef struct FineFrame {
    Float3 axis[3];
} FineFrame;

// ---- surface_fine.c

/// Allocates a drawing's arrays and finds where its surface is. The shell, state, memory and surface are set.
SingeResult fine_open(Fine *fine, const SurfaceDetail *detail, SingeError *error);
/// Frees what a drawing has allocated.
void fine_close(Fine *fine);

/// Interpolates between the corners of a cell's triangle.
Float3 fine_blend(const uint32_t at[4], const FineLocation *location, const float (*field)[4]);

// ---- fine_spline.c

/// Fills the coefficients of a field with a value at every particle.
void fine_spline(const Fine *fine, const float *values, Spline *spline);

/// The same for a field that is 1 in remaining cells and -1 in others.
void fine_spline_cells(const Fine *fine, Spline *spline);

/// The min and max coefficient of a cell: the spline lies between them.
void fine_spline_bounds(const Shell *shell, const Spline *spline, uint32_t cell, float *low, float *high);

/// The least coefficient about each corner of a cell: of the quarter of the cell that the corner has.
Float4 fine_spline_quarters(const Shell *shell, const Spline *spline, uint32_t cell);

float fine_spline_at(const Shell *shell, const Spline *spline, const FineLocation *location);

/// The position displaced by (x, y) from another one, in sides of its cell along the cell's own axes (corner 0 to 1,
/// corner 0 to 3), at most half a cell along each. Beyond the sheet's border, the nearest point on it.
void fine_walk(const Shell *shell, const FineLocation *location, float x, float y, FineLocation *there);

/// The same by a displacement in space at rest, m.
FineLocation fine_move(const Shell *shell, const FineLocation *location, Float3 displacement);

/// A position in its cell's own coordinates: corners at (-1/2, -1/2), (1/2, -1/2), (1/2, 1/2), (-1/2, 1/2).
void fine_coordinates(const FineLocation *location, float *x, float *y);

/// The level of this spline. It turns negative slightly inside the remaining cells, along smooth curves where the
/// cells' sides have corners, so that the sides are never visible.
static inline float fine_whole_level(float whole) { return 0.5f * (whole - 0.25f); }

// ---- fine_level.c

/// The number of octaves of the noise that points with this spacing (m) can resolve.
int fine_octaves(float spacing);

/// Fills SPLINE_TEAR_EDGE where sheets have torn, and marks the cells there. Their other flags are in place.
void fine_tear_edges(Fine *fine);

/// The level and the mass at a position.
FineValue fine_value(const Fine *fine, const FineLocation *location);

// ---- fine_points.c

/// Finds the cells near the front and numbers their points; then evaluates all points that may be drawn, and decides
/// which cells are split.
SingeResult fine_points(Fine *fine, SingeError *error);

/// Point i of a cell's side that is in `parts` parts.
uint32_t fine_side_point(const Fine *fine, uint32_t cell, int side, int parts, int i);

/// Point (i, j) of a cell's triangle: i of k along the side, j of k towards the centre.
uint32_t fine_point(const Fine *fine, uint32_t cell, int side, int splits, int i, int j);
FineLocation fine_point_location(uint32_t cell, int side, int splits, int i, int j);

static inline bool fine_is_split(const Fine *fine, uint32_t cell) { return fine->flags[cell] & FINE_SPLIT; }

static inline int fine_splits(const Fine *fine, uint32_t cell) {
    return fine->sheets[fine->shell->matter.sheet[shell_centre(fine->shell, cell)]].splits;
}

/// The parts in which a side of a cell is drawn.
static inline int fine_parts(const Fine *fine, uint32_t cell, int side) {
    return fine->parts[fine->shell->cell_springs[cell].blue[side]];
}

// ---- fine_march.c

/// Draws the triangles and lists their vertices.
SingeResult fine_march(Fine *fine, SingeError *error);

/// Whether a cell's triangle is left out.
bool fine_is_torn(const Fine *fine, uint32_t cell, int side);

/// Adds the polygon of `count` vertices, each its number plus 1, as triangles of the surface around the first. The last may
/// be the first again.
void fine_fan(Fine *fine, const uint32_t *polygon, int count);

// ---- fine_patch.c

/// A cell's points b_ij: i along side 0, j along side 3 backwards.
typedef struct FinePatch {
    Float4 net[4][4]; ///< fourth: 0
} FinePatch;

/// A point of a patch and its derivatives.
typedef struct FinePoint {
    Float3 position, along_u, along_v;
} FinePoint;

/// Finds the sound cells.
void fine_find_sound(Fine *fine);

/// Computes the points of all patches. Sound cells, corners, normals, `share` and `max` are in place.
void fine_patches(Fine *fine);

FinePatch fine_patch(const Fine *fine, uint32_t cell);
FinePoint fine_patch_at(const FinePatch *patch, float u, float v);

// ---- fine_position.c

/// Computes where the surface is, and how finely bent cells are drawn.
void fine_position(Fine *fine);

/// Position and unit normal at a location; `patch` is that of its cell.
void fine_position_at(const Fine *fine, const FinePatch *patch, const FineLocation *location, float position[3],
                      float normal[3]);

/// The frame at a cell's position that has this normal.
FineFrame fine_frame(const Fine *fine, uint32_t cell, Float3 normal);

// ---- render_bind.c

/// Fills `mesh_room` up to `reach`, m.
SingeResult render_rooms(Fine *fine, float reach, SingeError *error);

// ---- render_draw.c

/// Fills `bend`. The normals are in place.
void render_bends(Fine *fine);
/// How far from the sheet an offset along its normal may go for the sheet's bending at a foot, m.
float render_bend_room(const Fine *fine, const FineLocation *foot, float offset);
/// Finds which vertices of the render meshes are drawn, and sets the max numbers that they add.
SingeResult render_levels(Fine *fine, SingeError *error);
/// Draws their triangles and lists their vertices.
void render_march(Fine *fine);
/// Puts vertex v of the surface, which lies at its foot, where the render mesh has it.
void render_place(const Fine *fine, const FineVertex *vertex, uint32_t v);
void render_release(Fine *fine);

// The drawn surface refined near the front: shared declarations of the files fine_*.c.
#ifndef SURFACE_SURFACE_FINE_H
#define SURFACE_SURFACE_FINE_H

#include "common/check.h"
#include "ablate/ablate_plan.h"
#include "common/float3.h"

/// A fine triangle has at most this part of its cell's sides.
enum { FINE_SPLITS_MAX = 16 };

/// Flags of a cell.
enum {
    FINE_NEAR = 1,       ///< near the front: its points are numbered
    FINE_SPLIT = 2,      ///< the level changes sign in it
    FINE_EVEN = 4,       ///< nothing to draw finely: one mass, and not negative
    FINE_WHOLE = 8,      ///< nothing around it has gone
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

/// One of them: the coefficients of a C1 quadratic spline over the cells' triangles (fine_spline.c).
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

/// What a position is drawn by.
typedef struct FineValue {
    float level, mass;
} FineValue;

/// A vertex to be.
typedef struct FineVertex {
    FineLocation location;
    float mass;
    uint32_t source; ///< vertex of the input, or SHELL_NONE
} FineVertex;

/// How a sheet's cells near the front are split.
typedef struct FineSheet {
    int splits;    ///< k: a side becomes k fine ones
    float reach;   ///< m, how far noise eats into the edge at most
    int octaves;   ///< of the noise
    uint32_t seed; ///< of its first octave
} FineSheet;

/// A drawing in progress. Points are numbered: vertices, cells' centres, points on split sides of cells near the front,
/// points within these cells.
typedef struct Fine {
    const AblatePlan *plan;
    const Shell *shell;
    const State *state;
    Memory *memory;
    Pool *pool;
    const float *room; ///< [vertices] m, of SurfaceDetail
    float bulge_max;   ///< m, of SurfaceDetail
    FineSheet *sheets; ///< [sheets]
    Spline splines[SPLINE_COUNT];
    float *raw_level;     ///< [particles] m'; below 0 for what is gone
    float *cell_value;    ///< [cells] scratch of the splines
    float *low;           ///< [cells] the level's smallest coefficient
    float (*axes)[2];     ///< [cells] m, lengths of a cell's two axes at rest
    uint8_t *flags;       ///< [cells] FINE_NEAR and the like
    uint32_t *cell_point; ///< [cells] first of its points; where FINE_NEAR
    uint32_t *side_point; ///< [blue springs] first of the points on a side, or SHELL_NONE
    uint32_t *near;       ///< [near_count] the cells near the front
    uint32_t *side_owner; ///< [side_count] 4 cell + side, which the points of a numbered side are evaluated in
    uint8_t *bent;        ///< [cells] parts of a side that show how a cell is bent, if it is not split
    uint32_t *bent_point; ///< [cells] as cell_point, of points for that
    uint32_t *bent_side;  ///< [blue springs] as side_point; those of a split cell's sides once cells are settled
    uint8_t *splits;      ///< [cells] k of the cell as it is drawn
    uint8_t *parts;       ///< [blue springs] of a side as it is drawn: the more of its cells'
    uint32_t near_count, side_count, point_count;
    FineValue *values;  ///< [point_count]
    uint32_t *drawn;    ///< [point_count] 1 + index of the vertex drawn there, 0 for none
    uint32_t *side_cut; ///< [blue springs] first of the side's entries in `cuts`
    uint32_t *cuts;     ///< [cut_count] 1 + index of the vertex that cuts a fine side, 0 for none
    uint32_t cut_count;
    float (*normal)[3];   ///< [particles] unit, or 0
    float *max;           ///< [vertices] m, how far the surface leaves flat triangles there
    float *share;         ///< [vertices] of its way to the patches that it goes there
    float (*corner)[4];   ///< [vertices] m, of the flat triangles
    uint8_t *sound;       ///< [cells] 1: it is there and not torn
    float *valence;       ///< [vertices] n of fine_patch.c
    float *regular;       ///< [vertices] 1 where the patches around meet with the same derivatives, else 0
    float (*inner)[4][3]; ///< [cells] m, points of the patches beside the corners,
    float (*rail)[2][3];  ///< [blue springs] on sides, in the order of their ends,
    float (*limit)[3];    ///< [vertices] and at the corners
    float (*shift)[3];    ///< [vertices] m, by which the first two are moved; the third is
    FineVertex *vertices; ///< [vertex_capacity]
    uint32_t vertex_count, vertex_capacity;
    uint32_t *cell_triangle; ///< [cells + 1] first of a cell's triangles, where the sheets have seams; else NULL
    SingeSurface *surface;
} Fine;

// ---- fine_spline.c

/// Fills the coefficients of a field with a value at every particle.
void fine_spline(const Fine *fine, const float *values, Spline *spline);

/// The same for what is 1 in cells that are left and -1 in others.
void fine_spline_cells(const Fine *fine, Spline *spline);

/// The smallest and the greatest coefficient of a cell: the spline lies between them.
void fine_spline_bounds(const Shell *shell, const Spline *spline, uint32_t cell, float *low, float *high);

float fine_spline_at(const Shell *shell, const Spline *spline, FineLocation location);

/// The position that lies (x, y) from another one, in sides of its cell along the cell's own axes (corner 0 to 1,
/// corner 0 to 3), at most half a cell either way. Where the sheet ends, the nearest point along its border.
FineLocation fine_walk(const Shell *shell, FineLocation location, float x, float y);

/// A position in its cell's own coordinates: corners at (-1/2, -1/2), (1/2, -1/2), (1/2, 1/2), (-1/2, 1/2).
void fine_coordinates(FineLocation location, float *x, float *y);

/// The level that this spline stands for: below 0 from a little within the cells that are left outwards, in smooth
/// curves where their sides have corners, so that the sides are nowhere to be seen.
static inline float fine_whole_level(float whole) { return 0.5f * (whole - 0.25f); }

// ---- fine_noise.c

/// How many octaves of the noise points with this spacing (m) can show.
int fine_octaves(float spacing);

/// The level and the mass that a position is drawn by.
FineValue fine_value(const Fine *fine, FineLocation location);

/// A rest position, and a vector rotated out of every plane that sheets and their grids may lie in.
Float3 fine_rest(const Shell *shell, FineLocation location);
Float3 fine_askew(Float3 p);

// ---- fine_tears.c

/// Fills SPLINE_TEAR_EDGE where sheets have torn, and marks the cells there, which have their other flags.
void fine_tear_edges(Fine *fine);

/// The level that tears give a position in a marked cell: below 0 is not drawn.
float fine_tear_level(const Fine *fine, FineLocation location);

// ---- fine_points.c

/// Finds the cells near the front and numbers their points; then evaluates all points that may be drawn, and decides
/// which cells are split.
SingeResult fine_points(Fine *fine, SingeError *error);

/// Point i of a cell's side, of `parts` that it is in.
uint32_t fine_side_point(const Fine *fine, uint32_t cell, int side, int parts, int i);

/// Point (i, j) of a cell's triangle: i of k along the side, j of k towards the centre.
uint32_t fine_point(const Fine *fine, uint32_t cell, int side, int splits, int i, int j);
FineLocation fine_point_location(uint32_t cell, int side, int splits, int i, int j);

static inline bool fine_is_split(const Fine *fine, uint32_t cell) { return fine->flags[cell] & FINE_SPLIT; }

static inline int fine_splits(const Fine *fine, uint32_t cell) {
    SINGE_ASSERT(cell < fine->shell->cell_count);
    return fine->sheets[fine->shell->matter.sheet[shell_centre(fine->shell, cell)]].splits;
}

/// The parts in which a side of a cell is drawn.
static inline int fine_parts(const Fine *fine, uint32_t cell, int side) {
    SINGE_ASSERT(cell < fine->shell->cell_count);
    SINGE_ASSERT(side >= 0 && side < 4);
    return fine->parts[fine->shell->cell_springs[cell].blue[side]];
}

// ---- fine_march.c

/// Draws the triangles and lists their vertices.
SingeResult fine_march(Fine *fine, SingeError *error);

/// Whether a cell's triangle is left out.
bool fine_is_torn(const Fine *fine, uint32_t cell, int side);

// ---- fine_patch.c

/// A cell's points b_ij: i along side 0, j along side 3 backwards.
typedef struct FinePatch {
    Float3 net[4][4];
} FinePatch;

/// A point of a patch and its derivatives.
typedef struct FinePoint {
    Float3 position, along_u, along_v;
} FinePoint;

/// Finds the sound cells.
void fine_find_sound(Fine *fine);

/// Works out the points of all patches. Sound cells, corners, normals, shares and most are in place.
void fine_patches(Fine *fine);

FinePatch fine_patch(const Fine *fine, uint32_t cell);
FinePoint fine_patch_at(const FinePatch *patch, float u, float v);

// ---- fine_position.c

/// Works out where the surface is, and how finely bent cells are to be drawn.
void fine_position(Fine *fine);

/// Position and unit normal at a position, with the patch of its cell.
void fine_position_at(const Fine *fine, const FinePatch *patch, const FineLocation *location, float position[3],
                      float normal[3]);

// ---- fine_vertices.c

/// Fills the surface's vertices.
void fine_vertices(const Fine *fine);

#endif

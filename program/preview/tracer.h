// What rays meet: the sheets of a frame, and shapes.
#pragma once

#include "preview/bvh.h"
#include "preview/light.h"
#include "preview/noise_cell.h"
#include "preview/paper_look.h"
#include "preview/point.h"

/// A flat part of a crumpled sheet (crumple.c).
typedef struct CrumpleFacet {
    uint32_t key; ///< 0: none
    Float3 sum;   ///< of the normals, times areas
} CrumpleFacet;

enum { CRUMPLE_FACETS = 4096 }; ///< room for them: beyond that sheets are smooth

/// The sheets that are drawn, and the lamps.
/// A side of a triangle: its vertices, and its length at rest (m).
typedef struct SurfaceSide {
    uint32_t ends[2];
    float length;
} SurfaceSide;

typedef struct PreviewScene {
    Bvh bvh;
    PaperVertex *vertices;
    float (*positions)[4]; ///< in the centre of the exposure
    float (*moved[2])[4];  ///< at its beginning and end; not used without a shutter
    uint32_t (*triangles)[3];
    SurfaceSide *sides; ///< scratch, of triangles that burn
    float *edges;       ///< scratch, m, of each vertex the distance from the nearest border so far
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_capacity, position_capacity, moved_capacity[2], triangle_capacity, side_capacity, edge_capacity;
    Float3 low, high; ///< bounds of the drawn triangles
    float epsilon;    ///< m, distance by which secondary rays leave a surface
    CrumpleFacet facets[CRUMPLE_FACETS];
    NoiseCell *cell; ///< for this machine's instruction set
    EmberLights lights;
    int light_count, flames[2]; ///< the first of the flames, and behind the last
    Float3 flame_points[FLAME_POINTS];
} PreviewScene;

/// How a shape faces a ray that meets it.
typedef struct Facing {
    Float3 normal; ///< outward
    float bent;    ///< 1/m, how much that turns nearby
} Facing;

/// The data of a PreviewSolid for rays.
typedef struct Facets {
    const PreviewSolid *solid;
    Bvh bvh;
    Float3 *normals;          ///< [3 * triangle_count] of each triangle's corners
    Float3 bounds[2], centre; ///< in its own frame
    float extent;             ///< m, from the centre
    float *bent;              ///< [triangle_count] 1/m, how much its normals turn
    float round;              ///< m, over the mean of that by area: a ball's radius, and more of what is mostly flat
    uint32_t triangle_count;
    bool passing; ///< freed when no shape uses it any more
    struct Facets *next;
} Facets;

// crumple.c
/// Gathers the facets of crumpled sheets. The vertices have been loaded.
void crumple_load(Preview *preview);

/// How crumpled a sheet is that is bent so much (1/m), 0 to 1.
float crumple_amount(float bent);

/// Turns the normal towards that of the facet.
void crumple_shade(const PreviewScene *scene, const PaperState *state, float amount, Point *point);

// mesh_in.c
/// Fills the scene's vertices and triangles, for what traces no rays; tracer_load also makes it ready for rays.
SingeResult mesh_load(Preview *preview, const SingeSurface *surface, SingeError *error);
SingeResult tracer_load(Preview *preview, const SingeSurface *surface, SingeError *error);
void tracer_free(Preview *preview);

// rumple.c
/// Moves the scene's vertices of burnt cloth, once their fields are known.
void rumple_char(Preview *preview);

// tracer.c
SingeResult tracer_build(Preview *preview, SingeError *error);

/// Whether the ray comes nearer than `margin` to a box, from its lower to its upper corner, before `far`.
bool bounds_near(const Float3 bounds[2], Float3 origin, Float3 direction, float far, float margin);

/// The same of the surface's bounds.
bool tracer_near(const PreviewScene *scene, Float3 origin, Float3 direction, float far, float margin);

/// Nearest hits of the lanes that are valid; moves their `far` there.
void tracer_intersect(const Preview *preview, const int *valid, Rays *rays, Hits *hits);

/// What rays meet first.
typedef struct Met {
    const PreviewShape *shape[LANES]; ///< NULL: none before the sheets
    float distance[LANES];            ///< to the shape or the sheet
    Facing facing[LANES];             ///< the shape's
} Met;

/// The shapes before the hits of valid lanes.
void tracer_meet_shapes(const Preview *preview, const int *valid, const Rays *rays, const Hits *hits, Met *met);

/// clear[i] is the transmittance along the ray of a valid lane, shapes included; for other lanes, whose `far` must be
/// -1, it is 1. Changes `far`.
void tracer_occlude(const Preview *preview, const int *valid, Rays *rays, float clear[LANES]);

// facets.c
/// Finds or creates those of a solid.
SingeResult facets_get(Preview *preview, const PreviewSolid *solid, const Facets **facets, SingeError *error);

/// Frees the data of passing solids that no shape uses.
void facets_drop(Preview *preview);
void facets_free(Preview *preview);

/// Distance along a ray in the solid's frame, in (near, far), or -1.
float facets_intersect(const Facets *facets, Float3 origin, Float3 direction, float near, float far, Facing *facing);

// shape.c
/// Distance to the shape in (near, far), or -1.
float shape_intersect(const PreviewShape *shape, float moment, Float3 origin, Float3 direction, float near, float far,
                      Facing *facing);

/// Centre of a sphere around the shape at the middle of the exposure.
Float3 shape_centre(const PreviewShape *shape);

/// Radius of a sphere around that centre that contains the shape while the shutter is open.
float shape_extent(const PreviewShape *shape, float shutter);

/// Whether a ray that comes nearer than `near` to the shape's centre comes as near to its box, if it is a solid, before
/// `far`.
bool shape_near(const PreviewShape *shape, Float3 origin, Float3 direction, float far, float near);

// shade_shape.c
void shape_shade(const Preview *preview, const PreviewShape *shape, float moment, Point *point);

// What the files of the preview share: a Preview, what it draws, and the point that is shaded.
#pragma once

#include "common/allocator.h"
#include "common/store.h"
#include "preview/fire.h"
#include "preview/lens.h"
#include "preview/light.h"
#include "preview/noise.h"
#include "preview/paper_look.h"
#include "preview/preview.h"
#include "preview/bvh.h"

enum {
    BLOCK = 4,        ///< pixels along a block's side
    TILE = FIRE_TILE, ///< pixels along a tile's side, the unit of work of a thread
    MIP_LIMIT = 15,
    THREAD_LIMIT = 64,
    SIZE_LIMIT = 16384,
};

/// A sheet's picture with its smaller copies. Level 0 is the caller's.
typedef struct Texture {
    const uint8_t *levels[MIP_LIMIT];
    int width[MIP_LIMIT], height[MIP_LIMIT], count;
    float texels_per_metre; ///< of level 0, measured on the surface
} Texture;

/// Ash that lies on the table at a pixel if it is stained.
typedef struct Ash {
    float cover;   ///< share of the table that it and its shadow hide
    float albedo;  ///< times the share that it hides
    float tilt[2]; ///< what it adds to the slope
    float from[2]; ///< m: to the middle of the leaf, times cover: all of a leaf lies there or none
} Ash;

/// The table at a pixel.
typedef struct Table {
    Float3 albedo;
    float tilt[2]; ///< slope of its surface along x and y
    float polish;  ///< its reflectance
    Ash ash;
} Table;

/// A point of a piece of wood.
typedef struct Plank {
    float along, across, deep; ///< m, from its own corner, from its middle, and above its face
    float width, edge;         ///< m, its own, and to the nearest joint
    float tone, hue, shift;    ///< its own, 0 to 1, 0 to 1, and m
} Plank;

/// A flat part of a crumpled sheet (crumple.c).
typedef struct CrumpleFacet {
    uint32_t key; ///< 0: none
    Float3 sum;   ///< of the normals, times areas
} CrumpleFacet;

enum { CRUMPLE_FACETS = 4096 }; ///< room for them: beyond that sheets are smooth

/// The sheets that are drawn, and the lamps.
typedef struct PreviewScene {
    Bvh bvh;
    PaperVertex *vertices;
    float (*positions)[4]; ///< in the centre of the exposure
    float (*moved[2])[4];  ///< at its beginning and end; not used without a shutter
    uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_capacity, position_capacity, moved_capacity[2], triangle_capacity;
    Float3 low, high; ///< bounds of the drawn triangles
    float epsilon;    ///< m, distance by which secondary rays leave a surface
    CrumpleFacet facets[CRUMPLE_FACETS];
    EmberLights lights;
    int light_count, flames[2]; ///< the first of the flames, and behind the last
    Float3 flame_points[FLAME_POINTS];
} PreviewScene;

/// What burning sheets leave on the ground (stain.c).
typedef struct Stain {
    int size[2]; ///< cells
    float corner[2], cell;
    float *grids[3]; ///< [size[1] * size[0]] where sheets lay; what is whole of them, and the stain; NULL: none
} Stain;

/// What the ground mirrors of sheets, shapes and fire, or what metal mirrors, in a block of pixels.
typedef struct Mirrored {
    Float3 light;
    float share; ///< of the sky behind, which it hides; of the block, which is metal
} Mirrored;

/// The data of a PreviewSolid for rays.
typedef struct Facets {
    const PreviewSolid *solid;
    Bvh bvh;
    Float3 *normals;          ///< [3 * triangle_count] of each triangle's corners
    Float3 bounds[2], centre; ///< in its own frame
    float extent;             ///< m, from the centre
    float thick;              ///< m, three times its volume over its area: a ball's radius
    uint32_t triangle_count;
    bool passing; ///< freed when no shape uses it any more
    struct Facets *next;
} Facets;

struct Preview {
    PreviewDef def;
    SingeAllocator allocator;
    Camera camera;
    Float3 sun, sun_right, sun_up; ///< unit, towards the light, and a frame across it
    Float3 sun_light;              ///< its reflection by white paper
    Sky sky;
    Float3 wall_along; ///< horizontal and unit, to the right of who faces the wall
    float sun_spread;  ///< tangent of the light's apparent radius
    PreviewShape *shapes;
    uint32_t shape_count;
    Facets *facets;    ///< of the solids drawn so far
    Texture *textures; ///< [2 * def.sheet_count], of pictures, then of backs
    Weave *weaves;     ///< [def.sheet_count]
    float linear[256]; ///< sRGB byte to linear
    Float3 blackbody[BLACKBODY_COUNT];
    Float3 *picture;          ///< [height * width] radiance
    Lit *lit;                 ///< [height * width]
    float (*seen)[LIT_KINDS]; ///< [height * width] visible shares, smoothed along rows
    Table *table;             ///< [height * width], once `table_known`
    bool table_known;
    struct Veil *veil; ///< [height * width] sparks and wisps
    uint8_t *mask;     ///< [mask_size] for each block, whether a sheet or a shape may touch it
    Float3 *glow[2];   ///< [quarter height * quarter width] for the bloom
    PreviewScene scene;
    Fire fire;
    Stain stain;
    Mirrored *mirrored[2]; ///< [mask_size] for each block, and the same while it is smoothed; NULL: the ground is dull
    Mirrored *glints[2];   ///< the same of metal
    PreviewLayers layers;  ///< being drawn
    double time;
};

/// A point to be lit. All normals face the viewer.
typedef struct Point {
    Float3 position, normal, geometric, view; ///< view: unit, towards the eye
    Float3 albedo, glow;                      ///< glow: its own emission
    float transmission;                       ///< share of the light from behind that is transmitted
    Float3 through;                           ///< and its colour, over the albedo
    bool back;                                ///< of a sheet, where its picture is mirrored
    float bent;                               ///< 1/m, of a sheet, how much it bends
    float gloss, shininess;                   ///< Blinn-Phong lobe of the sun
    float mirror;                             ///< reflectance for the blurred sky
    float fuzz;          ///< cosine by which lamps light more of what is round: fibres scatter light
    Float3 shine, brush; ///< of a shape: what it mirrors seen from above, and along its scratches
    float rough[2];      ///< widths of that lobe along them and across
    Float3 across[2];    ///< unit, across the warp and the weft of woven sheets
    Mirrored mirrored;   ///< in front of the sky
    bool glints;         ///< its mirror image is traced, and no lobe holds flames and sky
    float footprint;     ///< m, a pixel's size here
    float fade;          ///< 0 visible to 1 faded into the background
    bool lit;            ///< false: glow only
    float distance;      ///< m, from the lens; infinite: nothing
    float temperature, burn;
    float moved;          ///< m, its way across the view while the shutter is open
    int32_t sheet, piece; ///< -1: none
    bool hit;             ///< a sheet or a shape
} Point;

// preview.c
/// Fills *error and returns `code`.
#define preview_fail(error, code, element, ...) refuse(error, code, "preview", element, __VA_ARGS__)

// texture.c
SingeResult texture_create(Preview *preview, Texture *texture, const Image *image, SingeError *error);
void texture_free(const Preview *preview, Texture *texture);

/// Linear colour; `texels` is a sample's width in texels of level 0.
Float3 texture_sample(const Preview *preview, const Texture *texture, float u, float v, float texels);

// crumple.c
/// Gathers the facets of crumpled sheets. The vertices have been loaded.
void crumple_load(PreviewScene *scene);

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
    Float3 normal[LANES];             ///< the shape's
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

/// Distance along a ray in the solid's frame, in (near, far), or -1; *normal points outward.
float facets_intersect(const Facets *facets, Float3 origin, Float3 direction, float near, float far, Float3 *normal);

// shape.c
/// Seconds from the centre of the exposure, for a ray's time in [0, 1].
static inline float shutter_moment(const Preview *preview, float time) { return (time - 0.5f) * preview->def.shutter; }

/// Distance to the shape in (near, far), or -1; *normal points outward.
float shape_intersect(const PreviewShape *shape, float moment, Float3 origin, Float3 direction, float near, float far,
                      Float3 *normal);

/// Centre of a sphere around the shape at the middle of the exposure.
Float3 shape_centre(const PreviewShape *shape);

/// Radius of a sphere around that centre that contains the shape while the shutter is open.
float shape_extent(const PreviewShape *shape, float shutter);

/// Whether a ray that comes nearer than `near` to the shape's centre comes as near to its box, if it is a solid, before
/// `far`.
bool shape_near(const PreviewShape *shape, Float3 origin, Float3 direction, float far, float near);

// shade_shape.c
void shape_shade(const Preview *preview, const PreviewShape *shape, float moment, Point *point);

// mask.c
size_t mask_size(const Preview *preview);
void mask_fill(Preview *preview);

/// Whether a sheet or a shape may be seen in the block of this pixel.
bool mask_covers(const Preview *preview, int x, int y);

/// And whether lens or shutter may blur it there.
bool mask_blurs(const Preview *preview, int x, int y);

// stain.c
SingeResult stain_create(Preview *preview, SingeError *error);
void stain_free(Preview *preview);

/// Computes the frame's stain. The surface has been loaded.
void stain_fill(Preview *preview);

/// Whether a sheet lay there at the start.
bool stain_may_be(const Preview *preview, float x, float y);

/// The stain at a point of the ground, 0 to 1.
float stain_at(const Preview *preview, float x, float y);

// mirror.c
/// Maps of the blocks of a picture, for the ground or for metal.
SingeResult mirror_create(Preview *preview, SingeError *error);
void mirror_free(Preview *preview);

/// Smooths a map across, and so many times down. The second map is scratch.
void mirror_smooth(const Preview *preview, Mirrored *const maps[2], int times);

/// What a map mirrors at a point of the picture, in pixels.
Mirrored mirror_see(const Preview *preview, const Mirrored *map, float x, float y);

// glints.c
/// Whether there is metal.
bool glints_any(const Preview *preview);

/// Whether a shape's mirror image is traced where a pixel is that large (m).
bool glints_may_be(const PreviewShape *shape, float footprint);

// shade_wood.c
/// (x, y): where its wear and its fibres are counted from.
void wood_look(const Plank *plank, float x, float y, uint32_t seed, float footprint, Table *table);

/// Whether details of that size are seen, 0 to 1.
static inline float visible(float metres, float footprint) { return clampf(1.5f - 0.9f * footprint / metres, 0, 1); }

// shade_ash.c
#define SCRAP_FLAT 0.5f ///< of its size: no part of a scrap is as high

/// How far a point of the plane is inside a scrap of burnt paper, in units of its size, half of its length: below 0 outside.
/// It is torn off along lines, bitten and frayed. `key`: which scrap.
float scrap_depth(float x, float y, uint32_t key);

/// Its height at the point, in units of its size: it is bent across, and creased.
float scrap_height(float x, float y, uint32_t key);

/// What lies on the ground at a point of it, where a pixel sees `footprint` m.
void ash_look(const Preview *preview, Float3 position, float footprint, Ash *ash);

/// Lays it on a point of the ground if its leaf has come down.
void ash_lay(const Preview *preview, const Ash *ash, Point *point);

// shade_ground.c
void ground_look(const Preview *preview, Float3 position, float cosine, float distance, Table *table);
void ground_shade(const Preview *preview, float distance, const Table *table, Point *point);
Float3 background_colour(const Preview *preview, Float3 direction);

// shade_wall.c
/// Distance to the wall along a ray; infinite: it is not met.
float wall_hit(const Preview *preview, Float3 origin, Float3 direction);

/// The share of the sun's disc that the wall, which has no end, leaves to the scene before it.
float wall_clears(const Preview *preview);
void wall_look(const Preview *preview, Float3 position, float footprint, Table *table);
void wall_shade(const Preview *preview, const Table *table, Point *point);

// film.c
void bloom_apply(Preview *preview);
void tonemap_write(const Preview *preview, uint8_t *rgb);

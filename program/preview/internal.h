// Shared by the files of the preview.
#ifndef PREVIEW_INTERNAL_H
#define PREVIEW_INTERNAL_H

#include "common/allocator.h"
#include "preview/fire.h"
#include "preview/noise.h"
#include "preview/preview.h"
#include "preview/trace.h"

enum {
    LANES = 16,       ///< rays in a packet: a block of 4 x 4 pixels
    BLOCK = 4,        ///< pixels along a block's side
    TILE = FIRE_TILE, ///< pixels along a tile's side, the unit of work of a thread
    LIGHT_LIMIT = 16, ///< ember clusters that cast light
    MIP_LIMIT = 15,
    BLACKBODY_COUNT = 160, ///< table from BLACKBODY_MIN in steps of BLACKBODY_STEP
    THREAD_LIMIT = 64,
    SIZE_LIMIT = 16384,
};
#define BLACKBODY_MIN 780.0f
#define BLACKBODY_STEP 10.0f
#define PI_F 3.14159265f
/// Exposed for white paper: a sun of 2.2 and a sky of 0.4 bring it to about 0.8.
#define FILM_SPEED 0.45f

/// The data of a vertex for shading.
typedef struct PaperVertex {
    float normal[3];
    float rest[3]; ///< m
    float uv[2];
    float temperature;   ///< K
    float peak;          ///< K, peak so far
    float burn;          ///< apparent burnt share, 0 to 1
    float burn_rate;     ///< 1/s
    float flaming;       ///< 1/s, the part of it that feeds a flame: 0 where char glows
    float gradient;      ///< 1/m, of burn in rest space
    int32_t sheet;       ///< -1: none
    float rim;           ///< 1 on the border of a piece, 0 inside
    float slope[3];      ///< 1/m, gradient of burn in rest space, of which `gradient` is the length
    float warming[3];    ///< K/m, the same for the peak temperature
    float heat_gradient; ///< K/m
    float spacing;       ///< m, size of the surrounding triangles at rest
    float age;           ///< s of the fire's real time since ignition; 0: not yet
    int32_t piece;
} PaperVertex;

/// A sheet's picture with its smaller copies. Level 0 is the caller's.
typedef struct Texture {
    const uint8_t *levels[MIP_LIMIT];
    int width[MIP_LIMIT], height[MIP_LIMIT], count;
    float texels_per_metre; ///< of level 0, measured on the surface
} Texture;

/// Point sources. Those beyond the count have softness 1 and are black.
typedef struct EmberLights {
    float x[LIGHT_LIMIT], y[LIGHT_LIMIT], z[LIGHT_LIMIT];
    float softness[LIGHT_LIMIT];    ///< m2, added to the distance squared
    float extent[LIGHT_LIMIT];      ///< m, extent of the light
    float power[LIGHT_LIMIT];       ///< luminance of the strength
    float strength[3][LIGHT_LIMIT]; ///< linear colour; radiance times area over 2 pi: divide by distance squared
} EmberLights;

/// The light of the sky and its reflection by the ground, seen from a point in the open.
enum { SKY_ACROSS = 48, SKY_DOWN = 24 };
typedef struct Sky {
    Float3 radiance[SKY_DOWN][SKY_ACROSS]; ///< latitudes from the top
    Float3 blurred[SKY_DOWN][SKY_ACROSS];  ///< as reflected by a dull surface
    Float3 ambient[9];                     ///< spherical harmonics of the light reflected by white paper
} Sky;

/// The light of embers and flames in a pixel, before occlusion.
typedef struct Lamp {
    Float3 light;   ///< as it reaches the eye
    Float3 normal;  ///< of the last sample
    float distance; ///< m, the same
    float seen;     ///< visible share, by few rays
    int32_t sheet;
} Lamp;

/// The table at a pixel.
typedef struct Table {
    Float3 albedo;
    float tilt[2]; ///< slope of its surface along x and y
    float polish;  ///< its reflectance
} Table;

typedef struct Camera {
    Float3 eye, right, up, forward; ///< right and up reach the border of the picture at distance 1
    Float3 lens_right, lens_up;     ///< the lens' radius
    float lens, focus;              ///< m, its radius and the distance in focus
    float pixel;                    ///< size of a pixel at distance 1
    float reach;                    ///< m, eye to target
} Camera;

typedef struct PreviewScene {
    RTCScene embree; ///< NULL when there is no triangle
    PaperVertex *vertices;
    float (*positions)[4]; ///< in the centre of the exposure
    float (*moved[2])[4];  ///< at its beginning and end; not used without a shutter
    uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_capacity, position_capacity, moved_capacity[2], triangle_capacity;
    Float3 low, high; ///< bounds of the drawn triangles
    float epsilon;    ///< m, distance by which secondary rays leave a surface
    EmberLights lights;
    int light_count;
} PreviewScene;

/// The data of a PreviewSolid for rays.
typedef struct Facets {
    const PreviewSolid *solid;
    RTCScene embree;
    Float3 *normals; ///< [3 * triangle_count] of each triangle's corners
    Float3 centre;   ///< of its bounds, in its own frame
    float extent;    ///< m, from the centre
    uint32_t triangle_count;
    bool passing; ///< freed when no shape uses it any more
    struct Facets *next;
} Facets;

struct Preview {
    PreviewDef def;
    SingeAllocator allocator;
    RTCDevice device;
    Camera camera;
    Float3 sun, sun_right, sun_up; ///< unit, towards the light, and a frame across it
    Float3 sun_light;              ///< its reflection by white paper
    Sky sky;
    float sun_spread; ///< tangent of the light's apparent radius
    PreviewShape *shapes;
    uint32_t shape_count;
    Facets *facets;    ///< of the solids drawn so far
    Texture *textures; ///< [def.sheet_count]
    float linear[256]; ///< sRGB byte to linear
    Float3 blackbody[BLACKBODY_COUNT];
    Float3 *picture; ///< [height * width] radiance
    Lamp *lamps;     ///< [height * width]
    float *seen;     ///< [height * width] of the lamps, smoothed along rows
    Table *table;    ///< [height * width], once `table_known`
    bool table_known;
    uint8_t *mask;   ///< [mask_size] for each block, whether a sheet or a shape may touch it
    Float3 *glow[2]; ///< [quarter height * quarter width] for the bloom
    PreviewScene scene;
    Fire fire;
    PreviewLayers layers; ///< being drawn
    double time;
};

/// A point to be lit. All normals face the viewer.
typedef struct Point {
    Float3 position, normal, geometric, view; ///< view: unit, towards the eye
    Float3 albedo, glow;                      ///< glow: its own emission
    float transmission;                       ///< share of the light from behind that is transmitted
    float gloss, shininess;                   ///< Blinn-Phong lobe of the sun
    float mirror;                             ///< reflectance for the blurred sky
    float footprint;                          ///< m, a pixel's size here
    float fade;                               ///< 0 visible to 1 faded into the background
    bool lit;                                 ///< false: glow only
    float distance;                           ///< m, from the lens; infinite: nothing
    float temperature, burn;
    int32_t sheet, piece; ///< -1: none
    bool hit;             ///< a sheet or a shape
} Point;

// preview.c
SingeResult preview_fail(SingeError *error, SingeResult code, int64_t element, const char *format, ...)
    SINGE_PRINTF(4, 5);

// lens.c
Camera camera_make(const PreviewDef *def);
/// A ray through a point of the lens, `disc` within the unit circle.
void camera_ray(const Camera *camera, float x, float y, const float disc[2], Float3 *origin, Float3 *direction);
/// Radius, in pixels, over which a point at that depth is spread.
float camera_blur(const Camera *camera, float depth);
/// Point `index` of a low-discrepancy sequence in the square, turned by (a, b).
void sample_square(uint32_t index, float a, float b, float out[2]);
/// The same for the lens, and a number for the time, by a pixel's key, independent of the others.
void sample_lens(uint32_t index, uint32_t key, float out[2]);
float sample_time(uint32_t index, uint32_t key);
/// A pixel's own random number.
uint32_t sample_key(int x, int y, uint32_t seed);
/// Two numbers for a pixel that differ strongly from its neighbours'.
void sample_pixel(int x, int y, uint32_t seed, float out[2]);
Float3 sample_cosine(Float3 normal, const float square[2]);
void sample_disc(const float square[2], float out[2]);

// texture.c
SingeResult texture_create(Preview *preview, Texture *texture, const Image *image, SingeError *error);
void texture_free(const Preview *preview, Texture *texture);
/// Linear colour; `texels` is a sample's width in texels of level 0.
Float3 texture_sample(const Preview *preview, const Texture *texture, float u, float v, float texels);

// mesh_in.c
SingeResult tracer_load(Preview *preview, const SingeSurface *surface, SingeError *error);
void tracer_free(Preview *preview);

// embree.c, or without_embree.c
SingeResult tracer_open(Preview *preview, SingeError *error);
void tracer_close(Preview *preview);
SingeResult tracer_build(Preview *preview, SingeError *error);
void tracer_release(Preview *preview);
/// Whether the ray comes nearer than `margin` to the surface's bounds before `far`.
bool tracer_near(const PreviewScene *scene, Float3 origin, Float3 direction, float far, float margin);
/// Nearest hits of the lanes with valid = -1; `geomID` is RTC_INVALID_GEOMETRY_ID where there is none.
void tracer_intersect(const Preview *preview, const int *valid, struct RTCRayHit16 *rays);
/// clear[i] is the transmittance along the ray of a lane with valid = -1, shapes included; for other lanes it is 1.
/// Changes `valid`. A ray's id is its lane.
void tracer_occlude(const Preview *preview, int *valid, struct RTCRay16 *rays, float clear[LANES]);

// environment.c
void sky_fill(Preview *preview);
/// The reflection by white paper with that normal of all light except the sun's.
Float3 sky_ambient(const Sky *sky, Float3 normal);
Float3 sky_mirrored(const Sky *sky, Float3 direction);

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

// mask.c
size_t mask_size(const Preview *preview);
void mask_fill(Preview *preview);
/// Whether a sheet or a shape may be seen in the block of this pixel.
bool mask_covers(const Preview *preview, int x, int y);

// light.c
void light_gather(Preview *preview);

// blackbody.c
void blackbody_fill(Float3 table[BLACKBODY_COUNT]);
Float3 blackbody_glow(const Float3 table[BLACKBODY_COUNT], float temperature);

// shade_paper.c
/// The interpolated fields that determine the appearance of a hit.
typedef struct PaperState {
    Float3 rest;
    float uv[2], temperature, peak, burn, burn_rate, gradient, heat_gradient, rim, spacing;
    float glowing; ///< 1/s, the part of burn_rate due to char without fuel
    float age;     ///< s of the fire's real time since ignition; 0: not yet
    int32_t sheet, piece;
} PaperState;
/// The sheet's fields at a point in a triangle.
void paper_state(const PreviewScene *scene, uint32_t triangle, float u, float v, PaperState *state);
/// Whether the burnt sheet has a hole there at the picture's scale. Only where burn > PAPER_WHOLE.
bool paper_is_hole(const PaperState *state, float footprint);
/// Share of the light on one side of a fresh sheet that is transmitted to the other.
float paper_transmittance(const Preview *preview, int32_t sheet);
#define PAPER_WHOLE 0.35f
/// False at a hole.
bool paper_shade(const Preview *preview, const PaperState *state, Point *point);

// shade_ember.c
/// Width of the glowing line, m, and the burn value at its centre.
#define EMBER_WIDTH 0.00042f
#define EMBER_BURN 0.74f
/// The burn value of a leaf of char until it glows away: below that of the embers.
#define CHAR_LEAF 0.64f
#define EMBER_GAIN 3.4f
/// The glowing skin is hotter than the simulation's mean over the sheet's thickness.
static inline float ember_temperature(float mean) { return mean + 110; }
/// Strength of a point's glow, 0 to 1, from its burn rate (1/s).
static inline float ember_activity(float burn_rate) { return burn_rate > 0 ? burn_rate / (burn_rate + 0.12f) : 0; }
/// The varying air supply of a point, about 1.
float ember_air(const Preview *preview, Float3 position);

// shade_ground.c
void ground_look(const Preview *preview, Float3 position, float cosine, float distance, Table *table);
void ground_shade(const Preview *preview, float distance, const Table *table, Point *point);
Float3 background_colour(const Preview *preview, Float3 direction);
void shape_shade(const Preview *preview, const PreviewShape *shape, float moment, Point *point);

// bloom.c, tonemap.c
void bloom_apply(Preview *preview);
void tonemap_fill_linear(float table[256]);
void tonemap_write(const Preview *preview, uint8_t *rgb);

#endif

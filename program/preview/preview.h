// Preview: a small renderer for surfaces. It depends on surfaces, not on simulations.
#pragma once

#include "formats/formats.h"

typedef struct PreviewCamera {
    float eye[3], target[3], up[3]; ///< m
    float fov;                      ///< vertical, radians
    float aperture;                 ///< m, diameter of the lens; 0: everything is sharp
    float focus;                    ///< m, distance in focus along the view; 0: the target's
} PreviewCamera;

/// A closed surface of triangles, counter-clockwise from outside. It must not change while a Preview draws it, and must
/// outlive the Preview.
typedef struct PreviewSolid {
    uint32_t vertex_count, triangle_count;
    float *vertices;     ///< [3 * vertex_count] m
    uint32_t *triangles; ///< [3 * triangle_count]
    bool passing;        ///< one of many that a shape has in turn: its data is freed with the next shapes
} PreviewSolid;

/// What a shape is made of.
typedef enum PreviewSurface {
    PREVIEW_SURFACE_MATT,
    PREVIEW_SURFACE_WOOD,
    PREVIEW_SURFACE_METAL,
    PREVIEW_SURFACE_CLOTH,
    PREVIEW_SURFACE_CORD, ///< twisted along x; of holders
} PreviewSurface;

/// A rigid shape: one of the scene's colliders and hot balls at the frame's time.
typedef struct PreviewShape {
    SingeColliderKind kind;
    float position[3], rotation[4], radius, half_size[3], height;
    float velocity[3]; ///< m/s, for motion blur
    PreviewSurface surface;
    float colour[3];             ///< linear albedo; of metal, what it mirrors
    float temperature;           ///< K; glows by black-body colour above about 800 K
    const PreviewSolid *solid;   ///< of a heightfield or a mesh, in the shape's frame
    const struct Facets *facets; ///< the preview's own; NULL
    bool grips;                  ///< wood that holds a sheet at its origin, and is singed where that burns
    float singed;                ///< the preview's own, 0 to 1
} PreviewShape;

/// What holds a sheet at its edge, with its word in scenes.
#define PREVIEW_HOLDERS(ROW) ROW(NONE, "none") ROW(PEG, "peg") ROW(CLIP, "clip") ROW(RING, "ring")
#define ROW(NAME, word) PREVIEW_HOLDER_##NAME,
typedef enum PreviewHolder { PREVIEW_HOLDERS(ROW) } PreviewHolder;
#undef ROW

/// A part of an edge that is held. Axes are unit.
typedef struct PreviewHeld {
    float at[3];                     ///< m, its middle
    float along[3], over[3], out[3]; ///< along the edge, across the sheet's face, and away from the sheet
    float width;                     ///< m, along the edge
    float scale;                     ///< 1: real sizes
    float reach;                     ///< m, how far cords and rods go on
    float rod, drop;                 ///< m, of a ring: radius of its rod, and the distance of `at` from the rod's axis
    float gape;                      ///< m, of a clip: from the first of the sheets between its jaws to the last
} PreviewHeld;

/// A drawn part: a shape whose solid is this one, with arrays from malloc. Without triangles: none.
typedef struct PreviewHolderPart {
    PreviewShape shape;
    PreviewSolid solid;
} PreviewHolderPart;

enum { PREVIEW_HOLDER_PARTS = 2 };

/// What grips a part of a sheet; it moves with that. Rings are around the origin of their shape, whose x points away from what
/// hangs from it, and y along the rod. `number` tells one from the other. False without memory.
bool preview_holder_grip(PreviewHolder holder, const PreviewHeld *held, uint32_t number,
                         PreviewHolderPart parts[PREVIEW_HOLDER_PARTS]);

/// The cord or the rod that they share; `held` are in order along it. False without memory.
bool preview_holder_line(PreviewHolder holder, const PreviewHeld *held, uint32_t count, PreviewHolderPart *part);

/// Ambient light with mean `sky_colour`.
typedef enum PreviewSky {
    PREVIEW_SKY_EVEN,    ///< the same from everywhere above
    PREVIEW_SKY_STUDIO,  ///< a dim room with a tall window, a lamp behind and a pale ceiling
    PREVIEW_SKY_OPEN,    ///< outdoors: pale towards the horizon and around the sun
    PREVIEW_SKY_PICTURE, ///< `sky_picture`
} PreviewSky;

/// The material of the table.
typedef enum PreviewGround {
    PREVIEW_GROUND_WOOD,
    PREVIEW_GROUND_STONE,
    PREVIEW_GROUND_PLAIN,
} PreviewGround;

/// The material of the wall.
typedef enum PreviewWall {
    PREVIEW_WALL_PLASTER,
    PREVIEW_WALL_BRICK,
    PREVIEW_WALL_PLAIN,
} PreviewWall;

/// Of office paper, 80 g/m2: with its albedo about a sixth comes through, an opacity of 93 % by ISO 2471.
#define PREVIEW_TRANSMITTANCE 0.19f

/// The quads of a sheet at the start, in the world.
typedef struct PreviewStart {
    uint32_t vertex_count, cell_count;
    const float *positions; ///< [3 * vertex_count] m
    const uint32_t *cells;  ///< [4 * cell_count] vertices
    const float *uv;        ///< [2 * vertex_count], or NULL; threads are counted along it
    const float *corner_uv; ///< [8 * cell_count] of each cell's corners, in place of `uv`, or NULL
} PreviewStart;

/// What a material looks like before it burns.
typedef struct PreviewLook {
    float weave; ///< m from one thread of the cloth to the next, along u and along v; 0: paper
    float
        coating; ///< 0 bare paper to 1 the plastic of a photo print, which mirrors, and blisters before the paper chars
} PreviewLook;

typedef struct PreviewDef {
    int width, height, samples; ///< samples a pixel, >= 1
    int thread_count;
    bool (*stop)(void); ///< asked from all threads now and then: once true, drawing fails with SINGE_ERROR_STATE. May
                        ///< be NULL
    PreviewCamera camera;
    float sun_direction[3]; ///< towards the light, any length > 0
    float sun_angle;        ///< radians, apparent radius: how soft shadows are
    float sun_colour[3];    ///< of about 2.2 with a sky of 0.4, white paper comes to 230 of 255
    float lamp_position[3]; ///< m, of a near lamp
    float lamp_radius;      ///< m, > 0: how soft its shadows are
    float lamp_colour[3];   ///< of its light at 1 m; 0: none
    float sky_colour[3];    ///< ambient light from above
    PreviewSky sky;
    const Image *sky_picture; ///< latitudes from the top, longitudes around z; its centre is towards +y
    float sky_turn;           ///< radians around z, seen from above
    float ground_height;      ///< m, z of the ground; -INFINITY for none
    PreviewGround ground;
    float ground_colour[3]; ///< linear
    float ground_gloss;     ///< factor on what the ground mirrors; 0: it is dull, and no reflections are traced
    float ground_stain;     ///< how dark burning sheets stain the ground they lay on; 0: they do not
    float wall_distance;    ///< m, of a vertical wall from the z axis; -INFINITY for none
    PreviewWall wall;
    float wall_turn;      ///< radians around z, seen from above; 0: the wall is towards +y
    float wall_colour[3]; ///< linear
    float background[3];
    float exposure; ///< multiplies before tone mapping
    float sparks;   ///< how many embers throw, relative to the usual
    float flakes;   ///< how many burning borders lose, relative to the usual
    float wisps;    ///< how dense the smoke of embers is, relative to the usual
    float hottest;  ///< K; what is hotter is drawn as hot as this
    bool plain;     ///< sheets are drawn as if nothing had burnt, to show their shapes
    float shutter;  ///< s, exposure, centred at the frame's time; 0: no blur
    float pace;     ///< speed of the fire relative to a real one, to convert ages
    uint32_t seed;
    const Image *const
        *pictures; ///< [sheet_count] on the side from which it reads, of cloth on both; NULL entries are white
    const Image *const *backs;   ///< [sheet_count] on the other side; NULL: none
    const float (*colours)[3];   ///< [sheet_count] tint of each sheet, linear
    const float *transmittances; ///< [sheet_count] share of light transmitted; NULL: PREVIEW_TRANSMITTANCE
    const PreviewLook *looks;    ///< [sheet_count]; NULL: paper
    const PreviewStart
        *starts; ///< [sheet_count] for the stain and the threads of cloth; NULL: none of them. Read while
                 ///< the preview is created
    uint32_t sheet_count;
    uint32_t shape_count;
    const PreviewShape *shapes;
} PreviewDef;

/// A picture by the rows of preview.def, of 960 x 540 pixels, on one thread, with a ground at 0.
PreviewDef preview_default(void);

typedef struct Preview Preview;

/// `def`'s pointers must outlive the Preview.
SINGE_NODISCARD SingeResult preview_create(const PreviewDef *def, SingeAllocator allocator, Preview **preview,
                                           SingeError *error);

/// Replaces the camera. The picture of the ground is prepared again for it, so a camera that moves costs more.
SINGE_NODISCARD SingeResult preview_set_camera(Preview *preview, const PreviewCamera *camera, SingeError *error);

/// Replaces the shapes (they move from frame to frame); the array is copied.
SINGE_NODISCARD SingeResult preview_set_shapes(Preview *preview, const PreviewShape *shapes, uint32_t count,
                                               SingeError *error);

/// Replaces the gas (it changes from frame to frame); flame, smoke, velocity and temperature, which may be NULL, are used,
/// and copied as needed. NULL or size 0: none.
SINGE_NODISCARD SingeResult preview_set_gas(Preview *preview, const SingeGas *gas, SingeError *error);

enum { PREVIEW_BAKE_MAX = 4 };

/// The current gas on cells `detail` times as fine along each side, with the tongues and streaks that pictures add by
/// noise. `surface` is that of its frame. smoke and flame are [detail^3 * the gas's cells], x fastest: extinction in
/// 1/m, and the flame's light as a share of a bright flame's (407 times that of white paper per metre); the palest cores
/// of flames reach 1.8.
SINGE_NODISCARD SingeResult preview_bake_gas(Preview *preview, const SingeSurface *surface, double time, int detail,
                                             float *smoke, float *flame, SingeError *error);

/// Draws one frame into rgb[height * width * 3], 8-bit sRGB, rows from the top. `time` drives flicker. The picture
/// depends neither on the number of threads nor on earlier frames. Triangles of a piece must share their vertices,
/// which shows its borders.
SINGE_NODISCARD SingeResult preview_draw(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb,
                                         SingeError *error);

enum { PREVIEW_MATTES = 4 };

/// What a piece of a sheet covers of a pixel.
typedef struct PreviewMatte {
    int32_t sheet, piece;
    float share; ///< of the samples; 0: none, and none after it
} PreviewMatte;

/// Additional pictures, [height * width], rows from the top. NULL: not wanted. *Mean* is over all samples of a pixel,
/// *of hits* over those that hit a sheet or a shape (0 if none did), *first* of one sample.
typedef struct PreviewLayers {
    float (*beauty)[3];                     ///< mean; linear Rec. 709, before halo, exposure and film
    float (*glow)[3];                       ///< mean; the part of beauty emitted by hot surfaces
    float *coverage;                        ///< share of the samples that are hits
    float (*normal)[3];                     ///< of hits, in the world's axes, towards the eye
    float *temperature;                     ///< of hits, K
    float *burn;                            ///< of hits, 0 fresh to 1 ash; 0 on shapes
    float *depth;                           ///< first, m along the camera's view; infinite if there is nothing
    int32_t *sheet, *piece;                 ///< first; -1 if there is none
    float (*fire)[4];                       ///< mean; light of flame and smoke, and their opacity
    PreviewMatte (*mattes)[PREVIEW_MATTES]; ///< mean; the first pieces that the samples hit
} PreviewLayers;

/// As preview_draw, and fills the layers. `rgb` may be NULL.
SINGE_NODISCARD SingeResult preview_draw_layers(Preview *preview, const SingeSurface *surface, double time,
                                                uint8_t *rgb, const PreviewLayers *layers, SingeError *error);

/// Median width in m of the glowing line on the sheets (fire_measure.c), from a frame's glow, depth and sheet, drawn with
/// a sharp lens; NaN if nothing glows.
SINGE_NODISCARD SingeResult preview_glow_width(const PreviewDef *def, const PreviewLayers *layers, double *width,
                                               SingeError *error);

/// Of a pixel's bytes: whether it may be a flame's, and then whether that is pale, nearly white, or one clipped yellow.
static inline bool pixel_flames(const uint8_t *p) { return p[0] >= 200 && p[1] >= 110; }
static inline bool pixel_is_pale(const uint8_t *p) { return p[1] > 225 && p[2] > 150; }
static inline bool pixel_is_lemon(const uint8_t *p) { return p[0] > 247 && p[1] > 225 && p[2] < 110; }

/// Of the pixels in which a flame is brighter than what else is seen there: how many are pale, and how many lemon. NaN if
/// they are fewer than 100.
typedef struct FlameShares {
    double pale, lemon; ///< 0 to 1
} FlameShares;

/// From a frame's fire, beauty and pixels (fire_measure.c).
void preview_flame_shares(const PreviewDef *def, const PreviewLayers *layers, const uint8_t *rgb, FlameShares *shares);

/// How far the feet of flames are in the picture from what gives off fuel, m: the median and the 90th percentile; and the
/// share of the flames before whole paper that stand on nothing. NaN where there is none.
typedef struct FlameFeet {
    double median, most, astray;
} FlameFeet;

/// From a frame's fire, beauty, depth, burn, sheet and pixels (fire_measure.c), and its surface.
SINGE_NODISCARD SingeResult preview_flame_feet(const PreviewDef *def, const PreviewLayers *layers, const uint8_t *rgb,
                                               const SingeSurface *surface, FlameFeet *feet, SingeError *error);

/// A frame for a renderer elsewhere (pack.c has the layout): the sheets' fields as they are shaded here, the gas that is
/// seen, the lamps. No ray is traced. Set its shapes and gas before. Free *bytes, from malloc.
SINGE_NODISCARD SingeResult preview_pack(Preview *preview, const SingeSurface *surface, double time, uint8_t **bytes,
                                         size_t *size, SingeError *error);

/// Stretch of the surface at a vertex: the largest principal stretch against the rest shape, less one, as the mean of the
/// triangles around it by area. 0 if there is none.
float preview_stretch(const SingeSurface *surface, uint32_t vertex);

/// What a renderer elsewhere needs of the light, on the film's scale: the reflection by white paper of the sun, and of
/// all other light as spherical harmonics of order 2 (environment.c).
void preview_light(const Preview *preview, float sun[3], float towards[3], float ambient[9][3]);

void preview_destroy(Preview *preview);

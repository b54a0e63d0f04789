// What the files of the preview share: a Preview, its maps, and the steps of a picture.
#pragma once

#include "common/allocator.h"
#include "common/store.h"
#include "preview/fire.h"
#include "preview/lens.h"
#include "preview/light.h"
#include "preview/noise.h"
#include "preview/paper_look.h"
#include "preview/preview.h"
#include "preview/tracer.h"

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

/// What burning sheets leave on the ground (stain.c).
typedef struct Stain {
    int size[2]; ///< cells
    float corner[2], cell;
    float *grids[3]; ///< [size[1] * size[0]] where sheets lay; what is whole of them, and the stain; NULL: none
} Stain;

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
    struct Table *table;      ///< [height * width], once `table_known`
    bool table_known;
    struct Veil *veil; ///< [height * width] sparks and wisps
    int gaps[4];       ///< pixels of the box around char, in which it may have holes
    uint8_t *mask;     ///< [mask_size] for each block, whether a sheet or a shape may touch it
    Float3 *glow[2];   ///< [quarter height * quarter width] for gaps, then for the bloom
    PreviewScene scene;
    Fire fire;
    Stain stain;
    Mirrored *mirrored[2]; ///< [mask_size] for each block, and the same while it is smoothed; NULL: the ground is dull
    Glint *glints;         ///< by blocks
    PreviewLayers layers;  ///< being drawn
    double time;
};

/// Seconds from the centre of the exposure, for a ray's time in [0, 1].
static inline float shutter_moment(const Preview *preview, float time) { return (time - 0.5f) * preview->def.shutter; }

// preview.c
/// Fills *error and returns `code`.
#define preview_fail(error, code, element, ...) refuse(error, code, "preview", element, __VA_ARGS__)

// texture.c
SingeResult texture_create(Preview *preview, Texture *texture, const Image *image, SingeError *error);
void texture_free(const Preview *preview, Texture *texture);

/// Linear colour; `texels` is a sample's width in texels of level 0.
Float3 texture_sample(const Preview *preview, const Texture *texture, float u, float v, float texels);

// mask.c
size_t mask_size(const Preview *preview);
void mask_fill(Preview *preview);

/// Whether a sheet or a shape may be seen in the block of this pixel.
bool mask_covers(const Preview *preview, int x, int y);

/// The same, in it or the blocks around: hot gas bends rays to what is seen there.
bool mask_nears(const Preview *preview, int x, int y);

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
/// Maps of the blocks of a picture, for the ground and for metal.
SingeResult mirror_create(Preview *preview, SingeError *error);
void mirror_free(Preview *preview);

/// Smooths a map across, and so many times down. The second map is scratch.
void mirror_smooth(const Preview *preview, Mirrored *const maps[2], int times);

/// What metal mirrors at a point of the picture, in pixels: the mean of nearby blocks that see metal which faces the same way.
/// False if there are none.
bool mirror_see_glints(const Preview *preview, Float3 normal, float x, float y, Float3 *light);

/// What a map mirrors at a point of the picture, in pixels.
Mirrored mirror_see(const Preview *preview, const Mirrored *map, float x, float y);

// glints.c
/// Whether there is metal.
bool glints_any(const Preview *preview);

/// Whether a shape's mirror image is traced where a pixel is that large (m).
bool glints_may_be(const PreviewShape *shape, float footprint);

// shade_wood.c
/// Finds how far the sheets that wood grips have burnt. The surface has been loaded.
void wood_singe(Preview *preview);

// gaps.c
/// Finds where pictures of char surround what lies behind it. The light has been written.
void gaps_fill(Preview *preview);

/// How deep in a hole of char a pixel's point lies, 0 to 1.
float gap_at(const Preview *preview, int x, int y, const Lit *lit);

// film.c
/// Smooths a picture by a Gaussian of `sigma` pixels.
void film_blur(Float3 *image, Float3 *scratch, int w, int h, float sigma);
void bloom_apply(Preview *preview);
void tonemap_write(const Preview *preview, uint8_t *rgb);

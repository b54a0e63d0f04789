// A block of pixels in the renderer: the points that its 16 lanes see, and the light there.
#pragma once

#include "preview/internal.h"

#define SAME_FACING 0.8f ///< least cosine between the normals of one face

/// Sums for the layers of a pixel.
typedef struct LayerSum {
    Float3 normal, glow, fire;
    Float3 facing; ///< of the first sample's face
    float fire_hides, temperature, burn, depth;
    int hits, samples;
    int behind; ///< how many more samples of other faces lie behind the first one than before it
    bool ends;  ///< they met several sheets, or one at distances that differ
    bool mixed; ///< that, or a crease
    int32_t sheet, piece;
    PreviewMatte mattes[PREVIEW_MATTES]; ///< their shares are numbers of samples
} LayerSum;

typedef struct Block {
    Rays rays, shadow;
    Hits hits;
    int valid[LANES];
    int x[LANES], y[LANES];
    float turn[LANES][2];
    uint32_t key[LANES];
    Float3 origin[LANES], direction[LANES], sum[LANES];
    float time[LANES]; ///< of the ray within the exposure, 0 to 1
    Point point[LANES];
    bool mirrored;  ///< the rays are those that the ground mirrors: they see no pixel of the table
    FireTile *tile; ///< flame and smoke; NULL: none
    float bend[LANES], bend_at[LANES],
        bend_to[LANES][2]; ///< angle, m, and how far to the right and up: of rays in hot gas
    float low[LANES], high[LANES];
    float shown[LANES], squares[LANES]; ///< sums of the samples' luminance, as l / (1 + l), and of its square
    float clear[LANES];                 ///< of a shadow ray
    bool corner;                        ///< the wall ends in it: it gets all samples
    bool hidden;                        ///< whether a part of the rays to sun or sky was blocked
    bool settled[LIT_KINDS];            ///< whether all or none of a kind's rays were: no more are needed
    float spread;                 ///< pixels over which lens and shutter spread what is seen, the largest of the points
    Float3 lit[LIT_KINDS][LANES]; ///< light before occlusion, summed over samples
    Float3 lit_other[LIT_KINDS][LANES]; ///< the part of it that samples of other faces than the first have added
    float lit_seen[LIT_KINDS][LANES], lit_asked[LIT_KINDS][LANES];      ///< luminance found visible, and tested
    Float3 lamp_position[LANES], lamp_normal[LANES], lamp_white[LANES]; ///< where lamps were last gathered; on white
    LayerSum layer[LANES];
} Block;

/// Lamps are gathered anew: what a lane has kept is of another block, and which one that was depends on threads.
static inline void block_forget_lamps(Block *block, int lane) { block->lamp_position[lane] = float3(INFINITY, 0, 0); }

/// In place of a sample's number: the centre of the sun and an open sky, if nothing can occlude them.
enum { SAMPLE_CENTRE = -1 };

enum {
    SAMPLES_FIRST = 4,  ///< that every pixel gets
    SAMPLES_STILL = 64, ///< of a still: every pixel gets all of them, and only what lamps and sky light is smoothed
};

static inline bool is_still(const Preview *preview) { return preview->def.samples >= SAMPLES_STILL; }

// points.c
/// A sample's position in the pixel: a tent of radius 0.9 pixel, softer than a box and without ringing.
void sample_offset(int sample, float at[2]);

/// Rays of a sample through the pixels, each with its position on the lens and its time: SAMPLE_CENTRE of both.
void block_aim(const Preview *preview, Block *block, int sample, const float at[2]);

/// The same in each `step`-th of the lanes.
void block_aim_each(const Preview *preview, Block *block, int sample, const float at[2], int step);

/// Distance to the ground along a ray; infinite: it is not met.
float ground_hit(const Preview *preview, Float3 origin, Float3 direction);

/// The same to the ground or the wall.
float backdrop_hit(const Preview *preview, Float3 origin, Float3 direction);

/// The point of a lane's ray where nothing is in front of ground and wall: one of them, or the background.
void block_see_backdrop(const Preview *preview, Block *block, int lane);

/// The nearest points of the rays of active lanes; widens block->spread.
void block_find_points(const Preview *preview, Block *block, const int *active);

size_t block_pixel(const Preview *preview, const Block *block, int lane);

// shimmer.c
/// Finds how hot gas bends the rays of active lanes, up to what their pixels' middles show.
void shimmer_find(const Preview *preview, Block *block, const int *active);

/// Bends a lane's ray in a sample.
void shimmer_bend(const Preview *preview, Block *block, int lane, int sample);

// samples.c
/// Adds the colour of block->point in one sample and its layers. In lanes of `ask` rays test what lights it.
void block_add_light(const Preview *preview, Block *block, const int *active, int sample, const int *ask);

/// Takes as many samples of the pixels as they need, and writes the picture and its layers.
void block_draw(Preview *preview, Block *block);

// lighting.c
/// Reflected share of the light along l, per unit of irradiance: diffuse and a Blinn-Phong lobe.
Float3 light_reflect(const Point *point, Float3 l);

/// The light along l that a shape's lobe sends to the eye, per unit of what white paper reflects of it at normal incidence.
/// `wide`: the square of the light's apparent size.
Float3 light_shine(const Point *point, Float3 l, float wide);

/// The same of all lamps.
Float3 light_shine_of_lamps(const PreviewScene *scene, const Point *point);

/// What a shape's lobe reflects of what it mirrors of the view.
Float3 light_fresnel(const Point *point);

/// The share of the light along the mirrored view that the point reflects.
float light_mirrored(const Point *point);

/// Whether the point that the lane sees is lit.
bool light_reaches(const Block *block, const int *active, int lane);

/// Adds the light of sun and sky that reaches the eye from block->point, times `through`, before occlusion, and tests its
/// visibility by a ray per lane of `ask`.
void light_add_sun(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES],
                   const int *ask);
void light_add_sky(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES],
                   const int *ask);

/// Counts what the rays of a kind have met: the luminance that each lane asked for, and the open share of it.
void light_count(Block *block, int kind, const float asked[LANES], const float open[LANES]);

/// Whether anything could occlude sun or sky at any of the points.
bool light_may_be_hidden(const Preview *preview, const Block *block, const int *active);

// lamps.c
/// The same for the light of flames and embers.
void lamps_add(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES],
               const int *ask);

// seen.c
/// Writes the light of a pixel with that many samples. `mixed`: it shows several faces.
void seen_write(const Preview *preview, size_t pixel, const Block *block, int lane, int samples, bool mixed);

/// Called per block once all blocks are written: first smooths the visible shares along rows; then, for all blocks,
/// along columns, and adds the light to the picture.
void seen_smooth(Preview *preview, Block *block);
void seen_finish(Preview *preview, Block *block);

// soften.c
/// Smooths the noise that is left where lens and shutter blur. Called per block once the light has been added.
void soften(Preview *preview, Block *block);

// mirror.c
/// Of one of the 4 x 4 blocks of pixels that are traced at once, of which `block` is the first.
size_t mirror_block(const Preview *preview, const Block *block, int lane);

/// Sets its time, its random numbers and the ray through its middle. False outside the picture.
bool mirror_aim(const Preview *preview, Block *block, int lane, Float3 *origin, Float3 *direction);

// glints.c
/// Traces what metal mirrors in the 4 x 4 blocks of which this is the first.
void glints_draw(Preview *preview, Block *block);

/// Adds it to the points of active lanes.
void glints_add(const Preview *preview, Block *block, const int *active);

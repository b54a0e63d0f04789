// A block of pixels in the renderer: the points that its 16 lanes see, and the light there.
#ifndef PREVIEW_BLOCK_H
#define PREVIEW_BLOCK_H

#include "preview/internal.h"

/// Sums for the layers of a pixel.
typedef struct LayerSum {
    Float3 normal, glow, fire;
    float fire_hides, temperature, burn, depth;
    int hits, samples;
    int32_t sheet, piece;
} LayerSum;

typedef struct Block {
    struct RTCRayHit16 rays;
    struct RTCRay16 shadow;
    _Alignas(64) int valid[LANES];
    int x[LANES], y[LANES];
    float turn[LANES][2];
    uint32_t key[LANES];
    Float3 origin[LANES], direction[LANES], light[LANES], sum[LANES];
    float time[LANES]; ///< of the ray within the exposure, 0 to 1
    Point point[LANES];
    FireTile *tile;                         ///< flame and smoke; NULL: none
    float fire_from[LANES], fire_to[LANES]; ///< distances for which the next two are valid
    Float3 fire_light[LANES];
    float fire_clear[LANES];
    float low[LANES], high[LANES];
    float clear[LANES]; ///< of a shadow ray
    float sun_seen;     ///< sum over rays to the sun
    int sun_asked;
    float open[LANES], sky_seen[LANES]; ///< visible share of the sky, of a sample and summed
    int sky_asked[LANES];
    bool clouded;        ///< whether anything hid sky
    bool sunlit, shaded; ///< whether any ray reached the sun, and whether any was blocked
    Float3 lamp[LANES];  ///< light of flames and embers, summed over samples, without occlusion
    Float3 lamp_position[LANES], lamp_normal[LANES],
        lamp_white[LANES];                     ///< where it was last computed, and its value on white
    float lamp_seen[LANES], lamp_asked[LANES]; ///< luminance that rays found visible, and luminance that they tested
    LayerSum layer[LANES];
} Block;

static inline void aim_ray(struct RTCRay16 *ray, int lane, Float3 origin, Float3 direction, float near, float far,
                           float time) {
    ray->org_x[lane] = origin.x;
    ray->org_y[lane] = origin.y;
    ray->org_z[lane] = origin.z;
    ray->dir_x[lane] = direction.x;
    ray->dir_y[lane] = direction.y;
    ray->dir_z[lane] = direction.z;
    ray->tnear[lane] = near;
    ray->tfar[lane] = far;
    ray->time[lane] = time;
    ray->mask[lane] = ~0u;
    ray->id[lane] = (unsigned)lane;
    ray->flags[lane] = 0;
}

static inline void rest_ray(struct RTCRay16 *ray, int lane) {
    aim_ray(ray, lane, float3(0, 0, 0), float3(0, 0, 1), 0, -1, 0);
}

/// In place of a sample's number: the centre of the sun and an open sky, if nothing can occlude them.
enum { SAMPLE_CENTRE = -1 };

// lighting.c
/// Reflected share of the light along l, per unit of irradiance: diffuse and a Blinn-Phong lobe.
Float3 light_reflect(const Point *point, Float3 l);

/// Whether the point that the lane sees is lit.
bool light_reaches(const Block *block, const int *active, int lane);

/// Adds the light of the sun and the sky that reaches the eye from block->point: the sun by `rays` rays each, the sky
/// by one, or by earlier results if no rays are to be traced.
void light_add_sun(const Preview *preview, Block *block, const int *active, int sample, int rays);
void light_add_sky(const Preview *preview, Block *block, const int *active, int sample, bool ask);

/// Whether anything could occlude sun or sky at any of the points.
bool light_may_be_hidden(const Preview *preview, const Block *block, const int *active);

// lamps.c
/// Adds the light of flames and embers that reaches block->point, times `through`, and tests its visibility.
void lamps_add(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES]);
void lamps_write(const Preview *preview, size_t pixel, const Block *block, int lane, int samples);

/// Called per block once all blocks are written: first smooths along rows; then, for all blocks, along columns, and
/// adds the result to the picture.
void lamps_smooth(Preview *preview, Block *block);
void lamps_finish(Preview *preview, Block *block);

#endif

// A block of pixels on its way through the renderer: what its 16 lanes see, and the light that falls there.
#ifndef PREVIEW_BLOCK_H
#define PREVIEW_BLOCK_H

#include "preview/internal.h"

/// What the layers of a pixel are made of.
typedef struct LayerSum {
    V3 normal, glow, fire;
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
    V3 origin[LANES], direction[LANES], light[LANES], sum[LANES];
    float time[LANES]; ///< of the ray within the exposure, 0 to 1
    Point point[LANES];
    FireTile *tile;                     ///< flame and smoke; NULL: none
    float fire_from[LANES], fire_to[LANES]; ///< distances for which the next two are known
    V3 fire_light[LANES];
    float fire_clear[LANES];
    float low[LANES], high[LANES];
    bool blocked[LANES];
    LayerSum layer[LANES];
} Block;

static inline void aim_ray(struct RTCRay16 *ray, int lane, V3 origin, V3 direction, float near, float far,
                           float time) {
    ray->org_x[lane] = origin.x, ray->org_y[lane] = origin.y, ray->org_z[lane] = origin.z;
    ray->dir_x[lane] = direction.x, ray->dir_y[lane] = direction.y, ray->dir_z[lane] = direction.z;
    ray->tnear[lane] = near, ray->tfar[lane] = far;
    ray->time[lane] = time, ray->mask[lane] = ~0u, ray->id[lane] = (unsigned)lane, ray->flags[lane] = 0;
}

static inline void rest_ray(struct RTCRay16 *ray, int lane) { aim_ray(ray, lane, v3(0, 0, 0), v3(0, 0, 1), 0, -1, 0); }

/// Instead of a sample's number: the middle of the sun and an open sky, for where nothing can hide them.
enum { SAMPLE_MIDDLE = -1 };

// layers.c
void layers_begin(LayerSum *sum);
/// `fire` is the light of flame and smoke before the point, `clear` what they leave of its own.
void layers_add(const Preview *preview, const Point *point, V3 fire, float clear, V3 direction, LayerSum *sum);
void layers_write(const Preview *preview, size_t pixel, V3 colour, const LayerSum *sum);

// lighting.c
/// Adds the light of the sun and the sky that reaches the eye from block->point, by one ray each.
void light_add_sun(const Preview *preview, Block *block, const int *active, int sample);
void light_add_sky(const Preview *preview, Block *block, const int *active, int sample);
/// Whether anything could keep sun or sky from any of the points.
bool light_may_be_hidden(const Preview *preview, const Block *block, const int *active);
/// Light of the embers first, first + stride, ... times stride.
V3 light_embers(const Scene *scene, const Point *point, int first, int stride);

#endif

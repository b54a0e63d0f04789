// What embers give to the air: sparks (sparks.c) and wisps of smoke (wisps.c). They are drawn over the picture (airborne.c).
//
// A picture depends on no earlier frame. So a spark or a wisp is known by the place on the sheet that it comes from and
// by the moment at which it left: the same hash of both gives the same flight in every frame that shows it.
#pragma once

#include "preview/block.h"

enum {
    SITE_LIMIT = 512, ///< a power of two
    SIGHT_POINTS = LANES,
};

/// The embers within one cell of a lattice over a sheet at rest.
typedef struct EmberSite {
    uint32_t key;    ///< of the cell and its sheet; 0: none
    float length;    ///< m of glowing line
    float flaming;   ///< m of it under flames
    float smoulder;  ///< m2 of what is hot and has no flame
    float level;     ///< 1 on level sheets, 0 on upright ones
    float weight;    ///< of `position`, a mean
    Float3 position; ///< m
    Float3 ember;    ///< m, of these the nearest to it
    Float3 ends[2];  ///< m, and the two that are furthest apart along a direction of the site
} EmberSite;

/// What is drawn over the picture at a pixel: light, and the depth of the smoke.
typedef struct Veil {
    Float3 light;
    float depth;
} Veil;

/// Gathers the embers in cells of `size` (m).
Float3 ember_across(uint32_t key);
void ember_sites(const Preview *preview, float size, EmberSite sites[SITE_LIMIT]);

/// The light that smoke at p scatters towards the eye, per optical depth, of the key light more the more it comes from
/// behind (Henyey & Greenstein 1941), of the sky and of the lamps.
Float3 smoke_light(const Preview *preview, Float3 p);

/// Where a point is seen: in pixels, and its depth in m along the view. False behind the camera.
bool airborne_project(const Preview *preview, Float3 p, float at[2], float *depth);

/// Whether points are seen, 0 hidden to 1; count <= SIGHT_POINTS.
void airborne_sight(const Preview *preview, const Float3 *points, int count, float seen[SIGHT_POINTS]);

/// The light of flames before points, and the transmittance to each: the veil lies over all flames, so that what is drawn
/// into it adds its share of that light, and has its own through that. count <= SIGHT_POINTS.
void airborne_flames(const Preview *preview, const Float3 *points, int count, Float3 light[SIGHT_POINTS],
                     float clear[SIGHT_POINTS]);

/// Adds to the veil around a pixel what is spread over a soft disc: `light` and `depth` times pixels^2.
void airborne_dot(Preview *preview, const float at[2], float radius, Float3 light, float depth);

/// Draws sparks, flakes and wisps into the veil. It needs nothing of the picture.
void airborne_draw(Preview *preview);

/// Lays the veil over a block of the picture, which is finished but for the halo and the film.
void airborne_lay(Preview *preview, Block *block);

void sparks_draw(Preview *preview);
void wisps_draw(Preview *preview);
void flakes_draw(Preview *preview);

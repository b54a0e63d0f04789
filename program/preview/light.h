// Light: the sky, the lamps that embers, flames and hot shapes are, and the colour of what glows.
#pragma once

#include "preview/render_math.h"

#include <stdint.h>

typedef struct Preview Preview;
struct PreviewScene;

enum {
    LIGHT_LIMIT = 16,      ///< lamps
    FLAME_POINTS = 160,    ///< of the light of flames
    BLACKBODY_COUNT = 160, ///< table from BLACKBODY_MIN in steps of BLACKBODY_STEP
};
#define BLACKBODY_MIN 780.0f
#define BLACKBODY_STEP 10.0f

/// Exposed for white paper: a sun of 2.2 and a sky of 0.4 bring it to about 0.8.
#define FILM_SPEED 0.45f
#define FIRE_MOST 1.3f ///< light of flames and embers on white paper that none reaches

/// Point sources. Those beyond the count have softness 1 and are black.
typedef struct EmberLights {
    float x[LIGHT_LIMIT], y[LIGHT_LIMIT], z[LIGHT_LIMIT];
    float softness[LIGHT_LIMIT];                            ///< m2, added to the distance squared
    float extent[LIGHT_LIMIT];                              ///< m, extent of the light
    float power[LIGHT_LIMIT];                               ///< luminance of the strength
    int first_point[LIGHT_LIMIT], point_count[LIGHT_LIMIT]; ///< of PreviewScene.flame_points; 0: of no flame
    float strength[3][LIGHT_LIMIT]; ///< linear colour; radiance times area over 2 pi: divide by distance squared
} EmberLights;

/// The light of the sky and its reflection by the ground, seen from a point in the open.
enum { SKY_ACROSS = 48, SKY_DOWN = 24 };

typedef struct Sky {
    Float3 radiance[SKY_DOWN][SKY_ACROSS]; ///< latitudes from the top
    Float3 blurred[SKY_DOWN][SKY_ACROSS];  ///< as reflected by a dull surface
    Float3 ambient[9];                     ///< spherical harmonics of the light reflected by white paper
} Sky;

/// Light whose visibility rays test.
enum { LIT_SUN, LIT_SKY, LIT_LAMPS, LIT_KINDS };

/// What Lit.light holds once the light has been added to the picture: the colour, and as c / (1 + l).
enum { SOFT_COLOUR, SOFT_SHOWN };

/// The light of a pixel by its kind, before occlusion.
typedef struct Lit {
    Float3 light[LIT_KINDS]; ///< as it reaches the eye
    Float3 other[LIT_KINDS]; ///< the part of it that comes from other faces than the first
    float seen[LIT_KINDS];   ///< visible share, by few rays; -1: none were traced
    Float3 normal;           ///< of the last sample
    float distance;          ///< m, the same; negative: the pixel shows several faces, and the first is at minus that
    float noise;             ///< variance of the mean of the samples, as l / (1 + l)
    float blur;              ///< pixels over which lens and shutter spread what is seen here
    float burnt;             ///< share of the samples that is char
    bool before;             ///< of a pixel of several faces, whether the first lies before the others
    int32_t sheet;
} Lit;

// environment.c
void sky_fill(Preview *preview);

/// The reflection by white paper with that normal of all light except the sun's.
Float3 sky_ambient(const Sky *sky, Float3 normal);
Float3 sky_mirrored(const Sky *sky, Float3 direction);

// lamps.c
/// Gathers the lamps of the frame.
void light_gather(Preview *preview);
void light_add(struct PreviewScene *scene, Float3 position, Float3 strength, float softness, float extent);

// flame_lamps.c
/// Adds at most that many lamps for the flames. Returns their luminance.
float flame_lamps_add(Preview *preview, int most);

// blackbody.c
void blackbody_fill(Float3 table[BLACKBODY_COUNT]);
Float3 blackbody_glow(const Float3 table[BLACKBODY_COUNT], float temperature);

// Flame and smoke in the renderer.
#pragma once

#include "preview/render_math.h"
#include "singe/sim.h"

#include <stddef.h>
#include <stdint.h>

enum {
    FIRE_BORDER = 4,  ///< empty cells around the gas: eddies move flames there, and interpolation needs no bounds
    FIRE_BEYOND = 4,  ///< floats that may be read behind the last cell
    FIRE_BRICK = 2,   ///< cells along the side of a brick, the unit of empty space that is skipped
    FIRE_STEPS = 128, ///< max steps of a ray outside empty bricks
    FIRE_RUNS = 8,    ///< max parts of a ray that are near flames
    FIRE_NOISE = 16,  ///< cells along the side of the lattice of noise, a power of two: there it repeats
    FIRE_CORNERS = FIRE_NOISE + 1,
    FIRE_COLOURS = 64,
    FIRE_LANES = 16, ///< flames that are looked up together
};

/// The values of a cell. Four floats, interpolated together.
typedef struct FireCell {
    float flame; ///< 0 none to 1 burning fully, logarithmic (fire.c)
    float rise;  ///< m times flame: height of the flame above the paper
    float smoke; ///< 1/m, extinction
    float glow;  ///< light of the flames that reaches the smoke, per unit of albedo
} FireCell;

/// The light of what is at a position, or the mean over a step, per metre.
typedef struct Matter {
    Float3 light;
    float dense; ///< 1/m, extinction
} Matter;

/// The smoke at a position. Its folds are thinner than the places where it is looked up are apart, so each of these knows
/// how far it is from a fold.
typedef struct Smoke {
    Float3 light; ///< radiance that it scatters, per unit of extinction
    float dense;  ///< 1/m, extinction in the middle of a fold
    float fold;   ///< 0 there
    float old;    ///< 0 at the fire to 1 far from it, where folds have spread
} Smoke;

/// The steps of a ray from `from` to `distance`: after a step, `light` has been added and `clear` is the transmittance.
typedef struct FireView {
    int count, run_count;
    float from[FIRE_STEPS], distance[FIRE_STEPS], clear[FIRE_STEPS];
    Float3 light[FIRE_STEPS];
    float hot[FIRE_STEPS][2]; ///< m, the length in hot gas; m2, the mean distance of that, times it
    float runs[FIRE_RUNS][2]; ///< m, where flames are near it
} FireView;

/// Flames have no edges as sharp as a sheet's: one ray for each second pixel across and down, through the corners that
/// four of them share, and pixels take the mean of the four surrounding rays, weighted by nearness. In a still each pixel's
/// corners have one: thin filaments across pixels were rows of beads. Where four rays at twice that distance see nearly the
/// same, there are none between them.
enum {
    FIRE_EVERY = 2,    ///< pixels from ray to ray in a video
    FIRE_SQUARES = 16, ///< between the rays of a tile's side
    FIRE_TILE = FIRE_EVERY * FIRE_SQUARES,
    FIRE_ACROSS = FIRE_SQUARES + 1,
    FIRE_COARSE = FIRE_SQUARES / 2,
};

/// Smoke is known at places of a few of the rays, `length` apart, and linear between them.
enum { SMOKE_ACROSS = FIRE_COARSE + 1, SMOKE_PLACES = 192 };

typedef struct FireTile {
    FireView views[FIRE_ACROSS * FIRE_ACROSS];
    Float3 rays[FIRE_ACROSS * FIRE_ACROSS]; ///< unit
    float pixel;                            ///< m, its size where the gas ends
    int apart;                              ///< rays from one with smoke to the next; 0: each looks for itself
    int first;                              ///< number of the place nearest to the eye
    float length;                           ///< m
    Smoke smoke[SMOKE_ACROSS * SMOKE_ACROSS][SMOKE_PLACES];
    bool smoke_known[SMOKE_ACROSS * SMOKE_ACROSS][SMOKE_PLACES];
    int every;                            ///< pixels from ray to ray
    bool fine[FIRE_COARSE * FIRE_COARSE]; ///< whether squares of 2 x 2 have rays at all corners
    bool empty;                           ///< no ray meets anything
} FireTile;

typedef struct Fire Fire;
typedef struct FirePlaces FirePlaces;
typedef struct FirePoints FirePoints;

/// The flames at `count` positions. Those of the arrays beyond, up to a multiple of the width, are to be finite.
typedef void FireLook(const Fire *fire, int count, const FirePlaces *places, FirePoints *points);

struct Fire {
    int size[3];   ///< cells with their border; all 0 if there is no gas
    bool visible;  ///< whether any of it is seen
    float cell;    ///< m
    Float3 origin; ///< m, centre of cell (0, 0, 0), border included
    FireCell *cells;
    float *flames; ///< [cells + FIRE_BEYOND] the cells' flames alone, of which four are read at once
    size_t cell_capacity;
    int bricks[3];
    uint8_t *seen;      ///< [bricks] FIRE_FLAME and FIRE_SMOKE that eddies may bring there
    float (*source)[4]; ///< [cells] displacement of the gas along x and y as it rises by one; its flame; its rise, m/s
    float (*roots)[4];  ///< [cells] rate at which paper burns around, and its place in cells times that
    float *apart;       ///< [cells] m, how far aside of flames that stand on what burns
    float (*sway)[4]; ///< [cells] m, how far eddies move a flame along x and y; its height above the paper; 1 where it
                      ///< burns, one more for each cell from there, 0 beyond
    uint8_t *burns;   ///< [cells] whether flame may be within reach of the small eddies
    size_t brick_capacity;
    float fading;      ///< m/s: what flames lose as they rise by a cell, times their speed
    float scale;       ///< of flames, 1 over cells of 8 to 10 mm: what burns over wider cells has larger tongues
    float moment;      ///< s, time for which the eddies have risen
    Float3 daylight;   ///< of sun and sky, per unit of the smoke's albedo
    Float3 low, high;  ///< m, bounds of the bricks that are not empty
    FireTile *tiles;   ///< [def.thread_count] work area of each thread; NULL before the first gas
    float (*noise)[4]; ///< [FIRE_CORNERS^3] four numbers from -1 to 1 at every corner; NULL before the first gas
    Float3 colours[FIRE_COLOURS + 1]; ///< radiance of a thick flame from its coolest to its hottest; one is read beyond
    FireLook *look;                   ///< by the instructions of this machine
};

#define FIRE_SCALE_CELL 0.010f ///< m, cells above which flames are larger, in proportion
#define FIRE_FINE_CELL 0.008f  ///< m, cells below which flames are smaller, in proportion
#define FLAMES_FROM 0.02f      ///< 1/s, rate at which paper burns, from which on it gives flames
#define FLAME_SEEN 0.15f       ///< a smaller value is outside of all flames
#define FLAME_HEIGHT 0.08f     ///< m, typical height of tongues
#define FLAME_END 0.30f        ///< m, max height of a flame
#define RISE_MOST 0.55f        ///< m/s, which rising gas reaches
#define EDDY_RATE 8.0f         ///< 1/s, eddies that pass a height
#define SOOT_DENSE 198.0f      ///< 1/m, extinction: what glows also hides, by Kirchhoff's law
#define FLAME_DIM 0.26f        ///< radiance of a thick flame at its coolest and its hottest
#define FLAME_BRIGHT 5.9f
#define TAPER 0.55f     ///< what is added to it above a flame's height
#define FLAME_MOST 2.0f ///< what eddies feed is more than a full flame, and is drawn elsewhere up to so much

// m, max displacement by eddies
#define FIRE_SWAY 0.027f
#define FIRE_WARP_WIDE 0.0062f
#define FIRE_WARP_FINE 0.0018f
#define SMOKE_WARP 0.0234f
#define SMOKE_THIN 0.2f ///< 1/m, extinction from which on smoke is seen

enum { FIRE_FLAME = 1, FIRE_SMOKE = 2 };

typedef struct Preview Preview;

/// Corner (x, y, z) of the noise, each from 0 to FIRE_NOISE.
static inline size_t fire_noise_at(int x, int y, int z) { return (size_t)(x + FIRE_CORNERS * (y + FIRE_CORNERS * z)); }

// fire_feet.c
/// Finds what feeds flames that are seen, and how far aside of these each cell is.
void fire_find_feet(Preview *preview);

/// What a flame loses where it is so far aside (m) of those that stand on what burns.
float fire_leans(const Fire *fire, float apart);

// fire.c
void fire_free(Preview *preview);

/// Computes the height of each flame above the paper, and the visible regions. The surface has been loaded.
void fire_raise(Preview *preview);

/// Computes the light on smoke, from daylight and flames. The lights have been gathered.
void fire_light_smoke(Preview *preview);

/// The flame at a position. Its light comes from a shell inside its edge, thinner than steps are long, so
/// that a step needs both of its ends.
typedef struct FirePoint {
    Float3 soot, root; ///< radiance per metre of the shell where it is brightest: yellow soot, blue root
    float depth;       ///< m inside the flame's edge, negative outside
    float profile;     ///< light there relative to the shell's brightest
    float shell;       ///< m, integral of that from the edge to the depth
    float opaque;      ///< 1/m, extinction of the shell
} FirePoint;

#define FIRE_OUTSIDE (-0.006f) ///< m, depth of what is far outside of flames

struct FirePlaces {
    float x[FIRE_LANES], y[FIRE_LANES], z[FIRE_LANES], blur[FIRE_LANES]; ///< m, over which the picture resolves no edge
};

static inline void fire_place(FirePlaces *places, int k, Float3 p, float blur) {
    places->x[k] = p.x;
    places->y[k] = p.y;
    places->z[k] = p.z;
    places->blur[k] = blur;
}

enum { FIRE_VALUES = 9 };

/// As FirePoint: what lies behind its depth has a value only where that is positive.
struct FirePoints {
    float depth[FIRE_LANES];
    float values[FIRE_VALUES][FIRE_LANES]; ///< soot, root, profile, shell, opaque
};

static inline FirePoint fire_point(const FirePoints *points, int k) {
    const float(*from)[FIRE_LANES] = points->values;
    if (!(points->depth[k] > 0)) return (FirePoint){.depth = points->depth[k]};
    return (FirePoint){.soot = {from[0][k], from[1][k], from[2][k]},
                       .root = {from[3][k], from[4][k], from[5][k]},
                       .depth = points->depth[k],
                       .profile = from[6][k],
                       .shell = from[7][k],
                       .opaque = from[8][k]};
}

// fire_shade.c
void fire_fill_colours(Preview *preview);

/// The colour of the light that flames cast, of luminance 1.
Float3 fire_cast_colour(const Preview *preview);

/// sway[0] and [1]: how far the widest eddies move a flame along x and y, m, at a height above the paper.
void fire_sway(const Fire *fire, Float3 p, float height, float sway[2]);

/// How far to the right and up the eddies of hot gas at p turn a ray, from -1 to 1.
void fire_turns(const Fire *fire, Float3 p, float turn[2]);

/// A flame at p, at a height above the paper, as it is fed there: more than elsewhere or less.
float fire_feed(const Fire *fire, Float3 p, float height, float flame);

/// Adds the mean of the flame over a step between two points.
void fire_between(const FirePoint *a, const FirePoint *b, float step, Matter *matter);
Smoke fire_smoke_at(const Fire *fire, Float3 p);

/// The mean of the smoke between two places. blur: m, over which the picture resolves nothing.
Matter fire_smoke_between(const Fire *fire, const Smoke *a, const Smoke *b, float blur);

// fire_march.c
/// Fills a tile whose upper left pixel is (x, y).
void fire_see(const Preview *preview, int x, int y, FireTile *tile);

/// Pixels from ray to ray; tiles of fire_see have FIRE_SQUARES times as many to a side.
int fire_every(const Preview *preview);

/// Where a ray leaves the bounds of all that is seen of the fire, m.
float fire_leaves(const Fire *fire, Float3 origin, Float3 direction);

/// The light of the fire along `count` rays, at most FIRE_LANES, up to a distance each, and the transmittance. `coarse`: times
/// as long as usual are their steps.
void fire_along(const Preview *preview, int count, const Float3 *origin, const Float3 *direction, const float *distance,
                float coarse, Float3 *light, float *clear);

/// The light of the fire up to `distance` for a pixel of the tile, and the transmittance.
void fire_until(const FireTile *tile, int x, int y, float distance, Float3 *light, float *clear);

/// Whether something is seen through hot gas around the 4 x 4 pixels of which this is the first.
bool fire_is_hot(const FireTile *tile, int x, int y);

/// The length of a pixel's ray in hot gas up to a distance, m, and where that is in the mean.
float fire_heats(const FireTile *tile, int x, int y, float distance, float *where);

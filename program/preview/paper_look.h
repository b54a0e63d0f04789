// The appearance of burning paper (shade_paper.c): the fields of the sheet, and its holes, char, ash and embers.
#pragma once

#include "formats/ember.h"
#include "preview/render_math.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct Point Point;
typedef struct Preview Preview;
typedef struct PreviewScene PreviewScene;
typedef struct PreviewDef PreviewDef;

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
    float feeds;         ///< 1/s, of that, what feeds a flame that no sheet covers
    float starved;       ///< 1/s, that part where there is char, which the flame keeps from air
    float gradient;      ///< 1/m, of burn in rest space
    int32_t sheet;       ///< -1: none
    float rim;           ///< 1 on the border of a piece, 0 inside
    float slope[3];      ///< 1/m, gradient of burn in rest space, of which `gradient` is the length
    float warming[3];    ///< K/m, the same for the peak temperature
    float heat_gradient; ///< K/m
    float spacing;       ///< m, size of the surrounding triangles at rest
    float age;           ///< s of the fire's real time since ignition; 0: not yet
    int32_t piece;
    float water;    ///< over the mass before it burns
    float bent;     ///< 1/m, how much its normals differ from its neighbours'
    uint32_t facet; ///< key of that in which it lies where it is bent sharply; 0: nowhere
    float
        edge; ///< m at rest, to the nearest border of a piece where it burns: at most PAPER_EDGE, or CLOTH_EDGE threads
} PaperVertex;

#define PAPER_EDGE 0.018f ///< m
#define CLOTH_EDGE 24.0f
#define BURNT_EDGE 0.175f ///< the burn value from which `edge` is counted
#define CLOTH_WARM 293.5f ///< K, peak above which cloth may yellow

/// The interpolated fields that determine the appearance of a hit.
typedef struct PaperState {
    Float3 rest;
    float uv[2], temperature, peak, burn, burn_rate, gradient, heat_gradient, rim, spacing;
    float glowing; ///< 1/s, the part of burn_rate due to char without fuel
    float starved; ///< 1/s, the part where char has fuel, whose flame keeps it from air
    float age;     ///< s of the fire's real time since ignition; 0: not yet
    int32_t sheet, piece;
    float water; ///< over the mass before it burns
    float edge;  ///< m, to the nearest border of a piece, at most PAPER_EDGE or CLOTH_EDGE threads
} PaperState;

/// The sheet's fields at a point in a triangle.
void paper_state(const PreviewScene *scene, uint32_t triangle, float u, float v, PaperState *state);

/// Whether the burnt sheet has a hole there at the picture's scale. Only where burn > PAPER_WHOLE.
bool paper_is_hole(const Preview *preview, const PaperState *state, float footprint);

/// Share of the light on one side of a fresh sheet that is transmitted to the other.
float paper_transmittance(const Preview *preview, int32_t sheet);
#define PAPER_WHOLE 0.35f

// ---- cloth (shade_cloth.c)

/// How a sheet is woven.
typedef struct Weave {
    float pitch;      ///< m from thread to thread; 0: it is not
    float threads[2]; ///< in a unit of u, and of v
} Weave;

/// The threads at a point: the warp, which is crossed along u, and the weft.
typedef struct Cloth {
    float shown;     ///< 1 where a pixel resolves threads, 0 where it does not
    float burnt;     ///< 0 whole cloth, 1 char or ash
    float at[2];     ///< threads from the origin of uv, as the burnt ones lie
    float across[2]; ///< from the middle of each thread, -1 and 1 at its sides
    float tone[2];   ///< of each thread, -0.5 to 0.5
    float left;      ///< to where cloth ends, but for strands that stand out there
    bool gone[2];
    int top; ///< the thread that is seen
} Cloth;

/// Counts the threads of a sheet at the start.
void cloth_count(const PreviewDef *def, uint32_t sheet, Weave *weave);

/// NULL if the sheet is not woven.
const Weave *cloth_weave(const Preview *preview, int32_t sheet);

/// The directions across the threads where a ray has hit.
void cloth_frame(const PreviewScene *scene, uint32_t triangle, Point *point);
void cloth_find(const Weave *weave, const PaperState *state, float burn, float footprint, Cloth *cloth);
bool cloth_is_hole(const Cloth *cloth);

/// Tilts the normal; returns a factor on the albedo.
float cloth_shade(const Weave *weave, const PaperState *state, const Cloth *cloth, Point *point);

/// How brown it is, 0 to 1. Its dye fades.
float cloth_scorch(const Weave *weave, const PaperState *state, Point *point);

/// Char and ash in its bundles of threads; returns how deep it lies there, 0 to 1. `threads`: from cloth_shade.
float cloth_char(const Weave *weave, const PaperState *state, const Cloth *cloth, float burn, float threads,
                 Point *point);

/// What glows of it.
void cloth_glow(const Preview *preview, const Weave *weave, const PaperState *state, const Cloth *cloth, float deep,
                Point *point);

/// False at a hole.
bool paper_shade(const Preview *preview, const PaperState *state, Point *point);

#define EMBER_WIDTH 0.00042f ///< m, of the glowing line
#define EMBER_GAIN 3.4f
#define EMBER_MOST 6.0f       ///< radiance of the brightest channel, which none reaches
#define LEAF_LIT 0.014f       ///< a leaf's mean radiance, of one that glows all over at its temperature
#define LEAF_BORDER_LIT 0.13f ///< the same along its border
#define LEAF_FED_LIT 0.35f    ///< of that, what is left where it feeds a flame
#define LEAF_BORDER 0.003f    ///< m
#define CLOTH_LIT 0.027f      ///< the same of cloth

/// The glowing skin is hotter than the simulation's mean over the sheet's thickness.
static inline float ember_temperature(float mean) { return mean + 110; }

/// The varying air supply of a point, about 1.
float ember_air(const Preview *preview, Float3 position);

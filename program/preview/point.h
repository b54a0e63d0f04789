// A point of a picture that is to be lit.
#pragma once

#include "common/curves.h"
#include "preview/preview.h"
#include "preview/render_math.h"

/// What the ground mirrors of sheets, shapes and fire in a block of pixels.
typedef struct Mirrored {
    Float3 light;
    float share; ///< of the sky behind, which it hides
} Mirrored;

/// What the metal in the middle of a block of pixels mirrors.
typedef struct Glint {
    Float3 light, normal; ///< normal: zero without metal
} Glint;

/// A point to be lit. All normals face the viewer.
typedef struct Point {
    Float3 position, normal, geometric, view; ///< view: unit, towards the eye
    Float3 albedo, glow;                      ///< glow: its own emission
    float transmission;                       ///< share of the light from behind that is transmitted
    Float3 through;                           ///< its colour, divided by the albedo
    bool back;                                ///< of a sheet, where its picture is mirrored
    float bent;                               ///< 1/m, how much it bends
    float gloss, shininess;                   ///< Blinn-Phong lobe of the sun
    float mirror;                             ///< reflectance for the blurred sky
    float fuzz;          ///< added to the cosine of lamps on round things: their fibres scatter light
    Float3 shine, brush; ///< of a shape: what it mirrors seen from above, and along its scratches
    float rough[2];      ///< widths of that lobe along them and across
    Float3 across[2];    ///< unit, across the warp and the weft of woven sheets
    Mirrored mirrored;   ///< in front of the sky
    bool glints;         ///< its mirror image is traced, and no lobe holds flames and sky
    float footprint;     ///< m, a pixel's size here
    float fade;          ///< 0 visible to 1 faded into the background
    bool lit;            ///< false: glow only
    float distance;      ///< m, from the lens; infinite: nothing
    float temperature, burn;
    float moved;          ///< m that it moves across the view while the shutter is open
    int32_t sheet, piece; ///< -1: none
    bool hit;             ///< a sheet or a shape
} Point;

/// Whether details of that size are seen, 0 to 1.
static inline float visible(float metres, float footprint) { return clampf(1.5f - 0.9f * footprint / metres, 0, 1); }

// Burning paper at the picture's scale: the parts of its appearance.
#ifndef PREVIEW_SHADE_PAPER_H
#define PREVIEW_SHADE_PAPER_H

#include "preview/internal.h"

/// The paper at a hit, at the picture's scale.
typedef struct Bent {
    Float3 position;               ///< for noise
    float burn, temperature, peak; ///< b', T' and P'
    float coarse, medium, fine;    ///< the noise that perturbed them, [-1, 1]
} Bent;

/// Noise whose features are `millimetres` wide, 0 where a pixel no longer resolves it.
static inline float paper_noise(Float3 position, float millimetres, float footprint, uint32_t seed) {
    float visible = 1.6f - footprint * 1000 / millimetres * 0.8f;
    if (visible <= 0) return 0;
    return minf(visible, 1) * noise3(float3_scale(position, 1000 / millimetres), seed);
}

/// Thin lines where noise changes sign. 1 on the line.
static inline float ridge(float n, float width) { return 1 - stepf(0, width, fabsf(n)); }

/// Lines between scattered scales, of varying width. 1 on a line.
float paper_cracks(const Bent *bent, float millimetres, float width, float footprint);
/// Tilts the normal by the gradient of noise of that size, as crumpling does.
void paper_crumple(Float3 position, float millimetres, float height, uint32_t seed, Point *point);
/// The same with sharp folds between faces that are nearly flat.
void paper_fold(Float3 position, float millimetres, float height, uint32_t seed, Point *point);

// shade_ash.c
/// The share of ash, 0 to 1.
float ash_amount(const Bent *bent);
/// Noise that wears ash to lace: holes above 0.7.
float ash_lace(const Bent *bent, float footprint);
void ash_shade(const PaperState *state, const Bent *bent, float ink, Point *point);

// shade_ember.c
void ember_shade(const Preview *preview, const PaperState *state, const Bent *bent, Point *point);

#endif

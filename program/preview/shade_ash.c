// Ash: the remaining leaf of mineral fibres, thin enough to transmit light. It is sooty at first and pales within about
// ten seconds, in patches; veins and the rims of holes are palest. Print remains on it as a change of tone.

#include "preview/shade_paper.h"

float ash_amount(const Bent *bent) {
    return stepf(0.78f, 0.94f, bent->burn + 0.06f * bent->coarse) * (1 - 0.75f * stepf(760, 1000, bent->temperature));
}

float ash_lace(const Bent *bent, float footprint) {
    return paper_noise(bent->position, 2.6f, footprint, 15) + 0.25f * bent->fine - 0.45f * bent->coarse;
}

/// Fibres lie along a direction that wanders over the sheet. 1 on a fibre.
static float fibres(Float3 position, float footprint) {
    float wander = 2.4f * noise3(float3_scale(position, 110), 11), c = cosf(wander), s = sinf(wander);
    Float3 along = float3(0.16f * (c * position.x + s * position.y), c * position.y - s * position.x, position.z);
    float visible = clampf(1.6f - footprint * 1400, 0, 1);
    return visible * ridge(noise3(float3_scale(along, 2100), 12), 0.5f);
}

/// Creases of the shrinking leaf: long, fine and forking. 1 on a vein.
static float veins(const Bent *bent, float footprint) {
    Float3 bowed = float3_mad(bent->position, float3(bent->medium, bent->coarse, bent->fine), 1.1e-3f);
    float large = ridge(paper_noise(bowed, 8.5f, footprint, 14), 0.10f);
    float small =
        ridge(paper_noise(float3_mad(bowed, float3(1, -1, 1), 2e-3f * bent->coarse), 3.4f, footprint, 18), 0.13f);
    return maxf(large, 0.55f * small);
}

void ash_shade(const PaperState *state, const Bent *bent, float ink, Point *point) {
    float amount = ash_amount(bent);
    if (amount <= 0.01f) return;
    float size = point->footprint, vein = veins(bent, size), fibre = fibres(bent->position, size);
    float cloud = paper_noise(bent->position, 14, size, 19) + 0.5f * bent->coarse + 0.2f * bent->medium;
    float pale = stepf(1, 16, state->age + 5 * cloud), rim = stepf(0.25f, 0.6f, ash_lace(bent, size));
    float value = mixf(0.034f, 0.20f, pale) + (0.010f + 0.06f * pale) * cloud + (0.02f + 0.06f * pale) * vein;
    value += (0.006f + 0.022f * pale) * fibre + 0.006f * bent->fine;
    value += (0.03f + 0.07f * pale) * maxf(rim, stepf(0.35f, 0.95f, state->rim + 0.25f * bent->fine));
    Float3 tone = float3_mix(float3(0.98f, 0.99f, 1.03f), float3(1.03f, 1.0f, 0.95f), pale);
    Float3 grey = float3_scale(tone, clampf(value * (1 - 0.4f * ink), 0.02f, 0.5f));
    point->albedo = float3_mix(point->albedo, grey, amount);
    point->gloss *= 1 - 0.8f * amount;
    point->mirror = mixf(point->mirror, 0.55f - 0.25f * pale, amount);
    point->transmission = mixf(point->transmission, 0.28f, amount);
    Float3 bowed = float3_mad(bent->position, float3(bent->coarse, bent->medium, -bent->coarse), 0.8e-3f);
    paper_fold(bowed, 8.5f, 0.55f * amount, 16, point);
    paper_fold(bowed, 3.4f, 0.26f * amount, 17, point);
}

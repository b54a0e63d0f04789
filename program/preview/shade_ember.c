// Glow: the line where char turns to ash, a Gaussian of the distance to the isoline b' = EMBER_BURN,
//
//     d = (b' - EMBER_BURN) / |grad b|,   glow = blackbody(T') exp(-(d / w)^2),   w about EMBER_WIDTH,
//
// steep towards the char, slower to fade towards the ash. It is thinned, thickened and broken by noise that crawls
// along the paper, brighter where the air supply varies, and flickers. Sparks creep behind it: a spot of the ash glows
// again for a moment when the time since its ignition passes a delay given by noise, so that lines of equal delay
// wander over the ash.

#include "preview/shade_paper.h"

static float seconds(const Preview *preview) { return (float)fmod(preview->time, 4096.0); }

float ember_air(const Preview *preview, Float3 p) {
    float t = seconds(preview);
    float slow = noise3(float3(21 * p.x + 0.8f * t, 21 * p.y - 0.5f * t, 21 * p.z - 1.7f * t), 51);
    float quick = noise3(float3(55 * p.x, 55 * p.y, 55 * p.z - 7.0f * t), 52);
    return clampf(1 + 0.42f * slow + 0.22f * quick, 0.3f, 1.7f);
}

/// Activity of the line at a point, 0 (dead) to 1.
static float line_life(const Preview *preview, const Bent *bent) {
    float t = seconds(preview);
    Float3 drift = float3_add(float3_scale(bent->position, 190), float3(0.5f * t, -0.35f * t, 0.8f * t));
    Float3 patch = float3_add(float3_scale(bent->position, 62), float3(-0.12f * t, 0.2f * t, 0.15f * t));
    return stepf(-0.22f, 0.62f,
                 0.75f * noise3(drift, 21) + 0.5f * noise3(patch, 22) + 0.35f * bent->medium + 0.2f * bent->fine);
}

static Float3 ember_line(const Preview *preview, const PaperState *state, const Bent *bent, float air,
                         float footprint) {
    float activity = ember_activity(state->burn_rate);
    if (activity < 0.02f || state->temperature < BLACKBODY_MIN) return float3(0, 0, 0);
    float life = line_life(preview, bent) * minf(air, 1.2f);
    float distance = (bent->burn - EMBER_BURN) / maxf(state->gradient, 20.0f);
    float width = EMBER_WIDTH * (0.42f + 0.66f * life), x = fabsf(distance) / width;
    float profile = distance > 0 ? 0.72f * expf(-0.5f * x * x) + 0.28f * expf(-0.8f * x) : expf(-x * x);
    float temperature = ember_temperature(state->temperature) + 210 * (life - 0.6f) + 60 * bent->fine;
    if (distance > 0) temperature -= 45 * minf(x, 3);
    float strength = activity * profile * (0.05f + 0.95f * life * life) * (0.85f + 0.4f * bent->fine) * air;
    // red-hot cracks in the char next to it
    float near = 0.10f * activity * life * expf(-0.05f * x * x);
    if (near > 0.003f) strength += near * paper_cracks(bent, 1.6f, 0.12f, footprint);
    return float3_scale(blackbody_glow(preview->blackbody, temperature), EMBER_GAIN * maxf(strength, 0));
}

/// A leaf of char that glows away, at its own temperature where it burns. Its heat spreads over a cell or two, but real
/// ember lines are thinner: they follow threads of noise, and break.
static Float3 leaf(const Preview *preview, const PaperState *state, const Bent *bent, float air) {
    float activity = ember_activity(state->glowing);
    if (activity < 0.02f || ember_temperature(state->temperature) < BLACKBODY_MIN) return float3(0, 0, 0);
    float life = line_life(preview, bent) * minf(air, 1.2f);
    float temperature =
        ember_temperature(state->temperature) + 130 * (life - 0.5f) + 70 * bent->fine + 40 * bent->medium;
    float strength = activity * (0.15f + 0.85f * life) * air;
    return float3_scale(blackbody_glow(preview->blackbody, temperature), EMBER_GAIN * strength);
}

static Float3 sparks(const Preview *preview, const PaperState *state, const Bent *bent, float air, float footprint) {
    float warm = stepf(420, 640, state->temperature) * stepf(0.76f, 0.86f, bent->burn);
    if (warm <= 0 || state->age <= 0) return float3(0, 0, 0);
    float patch = stepf(0.10f, 0.55f, noise3(float3_scale(bent->position, 85), 24) + 0.3f * bent->medium);
    if (patch <= 0) return float3(0, 0, 0);
    float delay = noise3(float3_scale(bent->position, 240), 23) + 0.5f * bent->medium + 0.25f * bent->fine;
    float late = (state->age - 3.2f) * 0.28f - delay;
    float glow = warm * patch * air * expf(-70 * late * late) * clampf(1.6f - footprint * 900, 0.3f, 1);
    return float3_scale(blackbody_glow(preview->blackbody, 1035 + 50 * bent->fine), 1.5f * glow);
}

void ember_shade(const Preview *preview, const PaperState *state, const Bent *bent, Point *point) {
    if (state->burn < 0.2f || state->temperature < 420) return;
    float air = ember_air(preview, point->position);
    point->glow = float3_add(ember_line(preview, state, bent, air, point->footprint),
                             sparks(preview, state, bent, air, point->footprint));
    point->glow = float3_add(point->glow, leaf(preview, state, bent, air));
}

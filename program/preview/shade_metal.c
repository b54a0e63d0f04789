// Metal: brushed, tempered by heat, or glowing under scale.

#include "preview/shape_look.h"

/// What a film of oxide that grew at that temperature leaves of the light that the metal mirrors.
static Float3 temper_colour(float temperature) {
    enum { STOPS = 8 };
    static const float stop[STOPS][4] = {
        {460, 1.00f, 1.00f, 1.00f}, {500, 1.00f, 0.86f, 0.56f}, {530, 0.88f, 0.58f, 0.33f}, {553, 0.62f, 0.36f, 0.52f},
        {578, 0.30f, 0.40f, 0.78f}, {605, 0.46f, 0.62f, 0.80f}, {640, 0.62f, 0.66f, 0.68f}, {800, 0.42f, 0.42f, 0.44f}};
    int i = 1;
    while (i < STOPS - 1 && temperature > stop[i][0]) i++;
    const float f = clampf((temperature - stop[i - 1][0]) / (stop[i][0] - stop[i - 1][0]), 0, 1);
    return float3_mix(float3_load(stop[i - 1] + 1), float3_load(stop[i] + 1), f);
}

void shape_metal(const Place *place, Point *point) {
    const PreviewShape *shape = place->shape;
    const bool turned = shape->kind == SINGE_COLLIDER_SPHERE || shape->kind == SINGE_COLLIDER_CAPSULE;
    const float footprint = point->footprint;

    // streaks along the scratches of a brush, from 1.6 mm to a fifth of one across
    float streaks = 0, wide = 0.0016f, weight = 0.6f;
    for (uint32_t octave = 0; octave < 4; octave++, wide *= 0.5f, weight *= 0.8f) {
        const float shown = visible(wide, footprint), fine = 1 / wide, coarse = fine / 40;
        if (shown <= 0) break;
        const Float3 q = turned ? float3(coarse * place->p.x, coarse * place->p.y, fine * place->p.z)
                                : float3(coarse * place->p.x, fine * place->p.y, fine * place->p.z);
        streaks += shown * weight * noise3(q, 401 + octave);
    }

    const float worn = noise3(float3_scale(place->p, 48), 411) + 0.5f * noise3(float3_scale(place->p, 130), 412);
    const float patina = stepf(0.45f, 1.15f, worn),
                grime = visible(0.004f, footprint) * noise3(float3_scale(place->p, 420), 413);

    // single scratches, in any direction
    Float3 q = float3(300 * place->p.x + 90 * place->p.y, 20 * place->p.y - 30 * place->p.z, 260 * place->p.z);
    const float scratch = visible(0.0012f, footprint) * (1 - stepf(0.01f, 0.05f, fabsf(noise3(q, 414)))) *
                          stepf(0.1f, 0.5f, noise3(float3_scale(place->p, 75), 415));

    Float3 shine = point->albedo;
    if (shape->temperature > 460) {
        // it cools upwards, from what heats it
        const float height = shape->facets ? (place->p.z - shape->facets->centre.z) / shape->facets->extent : -1;
        const float grown = shape->temperature - 330 * clampf(height + 0.33f, 0, 1) + 14 * worn + 5 * grime;
        shine = float3_mul(shine, float3_mix(float3(1, 1, 1), temper_colour(grown), 0.7f)); // it is worn
    }

    point->shine =
        float3_scale(shine, clampf(1 + 0.25f * streaks - 0.15f * patina + 0.08f * grime + 0.5f * scratch, 0.3f, 1.6f));
    point->albedo =
        float3_mul(point->albedo, float3_mix(float3(0.07f, 0.07f, 0.07f), float3(0.20f, 0.14f, 0.11f), patina));
    point->rough[0] = 0.035f + 0.05f * patina + 0.015f * grime + 0.01f * worn;
    point->rough[1] = point->rough[0] + 0.05f;
    // what turns within a pixel mirrors as much more
    const float turns = minf(0.5f * footprint * point->bent, 0.5f);
    for (int k = 0; k < 2; k++) point->rough[k] = sqrtf(point->rough[k] * point->rough[k] + turns * turns);
    point->gloss = point->mirror = 0;
    point->glints = glints_may_be(shape, footprint);

    const Float3 along = turned ? float3_unit_or(float3(-place->p.y, place->p.x, 0), float3(1, 0, 0)) : float3(1, 0, 0);
    point->brush = quat_rotate(shape->rotation, along);
    const Float3 across = float3_unit_or(float3_cross(place->normal, along), place->normal);
    Float3 dents = noise3_gradient(float3_scale(place->p, 36), noise3(float3_scale(place->p, 36), 416), 416);
    shape_lean(place, float3_mad(float3_scale(dents, 0.020f), across, 0.06f * streaks + 0.2f * scratch), point);
}

// ---- heat

// What glows is drawn as bright as lets its colours differ: a glow is wide, so a film that is set for what it lights would
// show it as a white disc. Its middle is nearly that; air takes heat from its limb and, as it rises, most below, and a rod is
// cooler towards the end by which it is held, that of its +z. Scale, which is thin and cooler than the metal, lies where
// that is cool, and has come off elsewhere but for a few flakes.

#define SHAPE_GAIN 0.265f
#define SHAPE_MIDDLE 80.0f  ///< K, by which the middle is drawn hotter: the film shows what is bright paler
#define SHAPE_LIMB 330.0f   ///< K, by which the limb is cooler than the middle
#define SHAPE_BELOW 150.0f  ///< K, by which what faces down is cooler than the middle
#define SHAPE_HELD 480.0f   ///< K, by which a rod is cooler where it is held
#define SHAPE_NECK 130.0f   ///< K, by which all of a rod is cooler than what is as hot
#define SCALE_COOLER 200.0f ///< K, scale over metal

void shape_glow(const Preview *preview, const Place *place, Point *point) {
    const PreviewShape *shape = place->shape;
    const float unit = 3.5f / maxf(place->size, 1e-6f);
    const Float3 p = float3_scale(place->p, unit);
    const Float3 aslant =
        float3(0.8f * p.x + 0.6f * p.y, 0.64f * p.y - 0.48f * p.x + 0.6f * p.z, 0.8f * p.z + 0.36f * p.x - 0.48f * p.y);
    const float middle = noise3(float3_scale(aslant, 1.4f), 42), broad = noise3(float3_scale(p, 0.45f), 41);
    const float small = visible(0.3f / unit, point->footprint) * noise3(float3_scale(aslant, 4.3f), 43);
    const float fine = visible(0.12f / unit, point->footprint) * noise3(float3_scale(p, 10), 44);

    const bool rod = shape->kind == SINGE_COLLIDER_CAPSULE;
    Float3 view = quat_unrotate(shape->rotation, point->view);
    if (rod) view = float3_unit_or(float3(view.x, view.y, 0), view); // one that points at the eye has a middle, too
    const float facing = clampf(float3_dot(place->normal, view), 0, 1), aside = 1 - facing;
    const float end = rod ? clampf(0.5f + place->p.z / (shape->height + 2 * shape->radius), 0, 1) : 0;
    const float cold =
        SHAPE_HELD * end * sqrtf(end) + (rod ? SHAPE_NECK : 0) - SHAPE_BELOW * minf(point->normal.z, 0.2f);
    const float lies = 0.55f * middle + 0.6f * small + 0.4f * fine; // scale lies where it is high
    const float scale = stepf(0.36f, 0.42f, lies + 0.0012f * cold);
    const float temperature = shape->temperature * (1 + 0.02f * broad + 0.012f * middle + 0.006f * small) - cold -
                              SHAPE_LIMB * aside * sqrtf(aside) + SHAPE_MIDDLE * facing * facing - SCALE_COOLER * scale;
    Float3 glow = blackbody_glow(preview->blackbody, temperature);
    point->glow = float3_scale(glow, SHAPE_GAIN * (0.45f + 0.55f * facing));
    point->albedo = float3_scale(float3(0.045f, 0.042f, 0.040f), 0.6f + 0.4f * scale);
    point->gloss = 0;
    point->mirror = 0.15f;
    point->shine = float3(0.05f, 0.05f, 0.05f);
    point->rough[0] = point->rough[1] = 0.42f;
}

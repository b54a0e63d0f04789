// Balls, boxes, capsules and solids: matt when cold; hot, they glow like metal, with cooler and darker scale, and a
// slightly dimmer limb because rough oxide emits less at grazing angles.

#include "preview/internal.h"

#define SHAPE_GAIN 1.35f

void shape_shade(const Preview *preview, const PreviewShape *shape, float moment, Point *point) {
    point->albedo = float3_load(shape->colour);
    point->gloss = 0.12f;
    point->shininess = 40;
    point->mirror = 0.5f;
    if (!(shape->temperature > BLACKBODY_MIN)) return;
    float size = shape->kind == SINGE_COLLIDER_BOX ? shape->half_size[0] : shape->radius;
    if (shape->facets) size = 0.5f * shape->facets->extent;
    Float3 centre = float3_mad(float3_load(shape->position), float3_load(shape->velocity), moment);
    Float3 local = float3_rotate(shape->rotation, float3_sub(point->position, centre), -1);
    Float3 p = float3_scale(local, 3.5f / maxf(size, 1e-6f));
    float scale =
        0.6f * noise3(p, 41) + 0.3f * noise3(float3_scale(p, 2.7f), 42) + 0.2f * noise3(float3_scale(p, 7.1f), 43);
    float facing = clampf(float3_dot(point->normal, point->view), 0, 1), limb = 0.52f + 0.48f * sqrtf(facing);
    float temperature = shape->temperature * (1 + 0.04f * scale) - 90 * (1 - facing) * (1 - facing);
    Float3 glow = blackbody_glow(preview->blackbody, temperature);
    point->glow = float3_scale(glow, SHAPE_GAIN * limb * (1 + 0.25f * scale));
    point->albedo = float3_scale(point->albedo, 0.45f);
    point->mirror = 0.15f;
}

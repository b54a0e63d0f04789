// The appearance of balls, boxes, capsules and solids.
//
// Patterns are counted in the shape's own frame, so that they stay on it while it moves. Wood is cut from one piece: its
// grain runs along the longest side, and its rings go through it. Metal is brushed, along the longest side or around
// what is round: what it mirrors is drawn out across the scratches. Where a fire has heated it, it wears the colours of a
// film of oxide, straw to blue to grey, and when it glows, scale, which is cooler and has come off in places. Cloth is
// stretched over what is below it, with seams along what is round.

#include "preview/shape_look.h"

void shape_lean(const Place *place, Float3 slope, Point *point) {
    slope = quat_rotate(place->shape->rotation, slope);
    slope = float3_mad(slope, point->normal, -float3_dot(slope, point->normal));
    Float3 tilted = float3_unit_or(float3_sub(point->normal, slope), point->normal);
    if (float3_dot(tilted, point->view) > 0.02f) point->normal = tilted;
}

/// A box's edges are worn round.
static void round_edges(Place *place, float radius, Point *point) {
    const float *half = place->shape->half_size;
    const float p[3] = {place->p.x, place->p.y, place->p.z};
    float n[3];
    for (int k = 0; k < 3; k++) {
        const float r = minf(radius, 0.5f * half[k]), beyond = maxf(fabsf(p[k]) - half[k] + r, 0) / r;
        n[k] = copysignf(beyond * beyond, p[k]);
    }
    place->normal = float3_unit_or(float3_load(n), place->normal);
    Float3 turned = quat_rotate(place->shape->rotation, place->normal);
    if (float3_dot(turned, point->view) > 0.02f) point->normal = turned;
}

void shape_shade(const Preview *preview, const PreviewShape *shape, float moment, Point *point) {
    point->albedo = float3_load(shape->colour);
    point->gloss = 0.12f;
    point->shininess = 40;
    point->mirror = 0.5f;
    const bool glows = shape->temperature > BLACKBODY_MIN;
    if (!glows && shape->surface == PREVIEW_SURFACE_MATT) return;

    Float3 centre = float3_mad(float3_load(shape->position), float3_load(shape->velocity), moment);
    Place place = {.shape = shape,
                   .p = quat_unrotate(shape->rotation, float3_sub(point->position, centre)),
                   .normal = quat_unrotate(shape->rotation, point->normal),
                   .size = shape->kind == SINGE_COLLIDER_BOX ? shape->half_size[0] : shape->radius};
    if (shape->facets) place.size = 0.5f * shape->facets->extent;
    if (shape->kind == SINGE_COLLIDER_BOX && shape->surface != PREVIEW_SURFACE_MATT)
        round_edges(&place, 0.0018f, point);
    if (glows) shape_glow(preview, &place, point);
    else if (shape->surface == PREVIEW_SURFACE_WOOD) shape_wood(preview, &place, point);
    else if (shape->surface == PREVIEW_SURFACE_METAL) shape_metal(&place, point);
    else if (shape->surface == PREVIEW_SURFACE_CORD) shape_cord(&place, point);
    else shape_cloth(&place, point);
}

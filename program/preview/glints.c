// What metal mirrors: sheets, other shapes, the ground and flames, by rays.
//
// Brushed metal is rough, and so is its mirror image. As for the ground (mirror.c) a few rays are traced for each block of
// 4 x 4 pixels, spread along the scratches and across as its lobe is, and read as the mean of neighbouring blocks whose metal faces the
// same way. What is too small for that mirrors the lamps' lobes alone.

#include "preview/block.h"

#include <string.h>

#define GLINT_BLOCKS 3.0f ///< blocks of pixels that fit into what is large enough

bool glints_any(const Preview *preview) {
    for (uint32_t k = 0; k < preview->shape_count; k++)
        if (preview->shapes[k].surface == PREVIEW_SURFACE_METAL) return true;
    return false;
}

/// Whether a block of pixels sees a part of the shape that is nearly flat.
bool glints_may_be(const PreviewShape *shape, float footprint) {
    const float size = shape->facets ? shape->facets->round : shape->radius;
    return shape->surface == PREVIEW_SURFACE_METAL && shape->kind != SINGE_COLLIDER_CAPSULE &&
           !(shape->temperature > BLACKBODY_MIN) &&
           (shape->kind == SINGE_COLLIDER_BOX || size > GLINT_BLOCKS * BLOCK * footprint);
}

/// Finds the metal that the middles of the blocks see. Returns whether there is any.
static bool find_metal(const Preview *preview, Block *block, int *active, Point *seen) {
    bool any = false;
    for (int i = 0; i < LANES; i++) {
        active[i] = 0;
        block->origin[i] = preview->camera.eye;
        block->direction[i] = preview->camera.forward;
        if (!mirror_aim(preview, block, i, &block->origin[i], &block->direction[i])) continue;
        preview->glints[mirror_block(preview, block, i)] = (Glint){.light = {0, 0, 0}};
        if (!mask_covers(preview, block->x[0] + BLOCK * (i % BLOCK), block->y[0] + BLOCK * (i / BLOCK))) continue;
        active[i] = -1;
        any = true;
    }

    if (!any) return false;
    block_find_points(preview, block, active);
    any = false;
    for (int i = 0; i < LANES; i++) {
        active[i] = active[i] && block->point[i].glints ? -1 : 0;
        seen[i] = block->point[i];
        any = any || active[i];
    }
    return any;
}

void glints_draw(Preview *preview, Block *block) {
    enum { RAYS = 24, APART = BLOCK * BLOCK };
    if (block->x[0] % APART || block->y[0] % APART || !glints_any(preview)) return;
    int active[LANES];
    const int unasked[LANES] = {0};
    Point seen[LANES];
    block->tile = NULL;
    if (!find_metal(preview, block, active, seen)) return;
    for (int i = 0; i < LANES; i++) block_forget_lamps(block, i);

    for (int s = 0; s < RAYS; s++) {
        memset(block->lit, 0, sizeof block->lit);
        for (int i = 0; i < LANES; i++) {
            float square[2], disc[2];
            sample_square((uint32_t)s, block->turn[i][0], block->turn[i][1], square);
            sample_disc(square, disc);
            block->sum[i] = float3(0, 0, 0);
            if (!active[i]) continue;
            block->origin[i] = float3_mad(seen[i].position, seen[i].geometric, preview->scene.epsilon);

            // on its side of the surface
            const Point *point = &seen[i];
            const Float3 n = point->geometric, aside = float3_unit_or(float3_cross(n, point->brush), n);
            Float3 half = float3_mad(n, point->brush, point->rough[0] * disc[0]);
            half = float3_unit_or(float3_mad(half, aside, point->rough[1] * disc[1]), n);
            Float3 ray = float3_mad(float3_scale(point->view, -1), half, 2 * float3_dot(half, point->view));
            const float out = float3_dot(ray, n);
            block->direction[i] = float3_unit_or(out < 0.02f ? float3_mad(ray, n, 0.02f - out) : ray, n);
        }
        block_find_points(preview, block, active);
        int hit[LANES];
        for (int i = 0; i < LANES; i++) hit[i] = active[i] && isfinite(block->point[i].distance) ? -1 : 0;
        block_add_light(preview, block, hit, SAMPLE_CENTRE, unasked);

        Float3 from[LANES], along[LANES], fire[LANES] = {{0, 0, 0}};
        float far[LANES], clear[LANES];
        int count = 0;
        for (int i = 0; i < LANES; i++) {
            clear[i] = 1;
            if (!active[i]) continue;
            from[count] = block->origin[i];
            along[count] = block->direction[i];
            far[count++] = block->point[i].distance;
        }
        if (preview->fire.visible) fire_along(preview, count, from, along, far, 1, fire, clear);

        for (int i = 0, ray = 0; i < LANES; i++) {
            if (!active[i]) continue;
            Glint *glint = &preview->glints[mirror_block(preview, block, i)];
            for (int k = 0; k < LIT_KINDS; k++) block->sum[i] = float3_add(block->sum[i], block->lit[k][i]);
            const Float3 light = hit[i] ? block->sum[i] : sky_mirrored(&preview->sky, block->direction[i]);
            glint->light = float3_mad(glint->light, float3_mad(fire[ray], light, clear[ray]), 1.0f / RAYS);
            glint->normal = seen[i].geometric;
            ray++;
        }
    }
}

void glints_add(const Preview *preview, Block *block, const int *active) {
    for (int i = 0; i < LANES; i++) {
        Point *point = &block->point[i];
        if (!active[i] || !point->glints) continue;
        Float3 light;
        point->glints = mirror_see_glints(preview, point->geometric, (float)block->x[i], (float)block->y[i], &light);
        if (point->glints) point->glow = float3_add(point->glow, float3_mul(light, light_fresnel(point)));
    }
}

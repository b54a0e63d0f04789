// What metal mirrors: sheets, other shapes, the ground and flames, by rays.
//
// Brushed metal is rough, and so is its mirror image. As for the ground (mirror.c) a few rays are traced for each block of
// 4 x 4 pixels, spread along the scratches and across as its lobe is; here they are smoothed over neighbouring blocks that
// see metal as well, and read in between. What is too small for that mirrors the lamps' lobes alone.

#include "preview/block.h"

#include <string.h>

#define GLINT_BLOCKS 3.0f ///< blocks of pixels that fit into what is large enough

static bool is_metal(const Preview *preview) {
    for (uint32_t k = 0; k < preview->shape_count; k++)
        if (preview->shapes[k].surface == PREVIEW_SURFACE_METAL) return true;
    return false;
}

/// Whether a block of pixels sees a part of the shape that is nearly flat.
bool glints_may_be(const PreviewShape *shape, float footprint) {
    const float size = shape->facets ? shape->facets->thick : shape->radius;
    return shape->surface == PREVIEW_SURFACE_METAL && shape->kind != SINGE_COLLIDER_CAPSULE &&
           !(shape->temperature > BLACKBODY_MIN) &&
           (shape->kind == SINGE_COLLIDER_BOX || size > GLINT_BLOCKS * BLOCK * footprint);
}

SingeResult glints_create(Preview *preview, SingeError *error) {
    for (int k = 0; k < 2; k++) {
        const size_t size = mask_size(preview) * sizeof(Glint);
        preview->glints[k] = allocator_resize(preview->allocator, NULL, 0, size);
        if (!preview->glints[k])
            return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for what metal mirrors");
        memset(preview->glints[k], 0, size);
    }
    return SINGE_OK;
}

void glints_free(Preview *preview) {
    for (int k = 0; k < 2; k++)
        if (preview->glints[k])
            allocator_resize(preview->allocator, preview->glints[k], mask_size(preview) * sizeof(Glint), 0);
}

static size_t glints_across(const Preview *preview) { return (size_t)((preview->def.width + BLOCK - 1) / BLOCK); }

/// The block of one of the 16 that are traced at once.
static Glint *glint_of(const Preview *preview, const Block *block, int lane) {
    const size_t x = (size_t)(block->x[0] / BLOCK + lane % BLOCK), y = (size_t)(block->y[0] / BLOCK + lane / BLOCK);
    return &preview->glints[0][y * glints_across(preview) + x];
}

/// Finds the metal that the middles of the blocks see. Returns whether there is any.
static bool find_metal(const Preview *preview, Block *block, int *active, Point *seen) {
    bool any = false;
    for (int i = 0; i < LANES; i++) {
        const int x = block->x[0] + BLOCK * (i % BLOCK), y = block->y[0] + BLOCK * (i / BLOCK);
        active[i] = 0;
        block->time[i] = 0.5f;
        block->origin[i] = preview->camera.eye;
        block->direction[i] = preview->camera.forward;
        if (x >= preview->def.width || y >= preview->def.height) continue;
        sample_pixel(x / BLOCK, y / BLOCK, preview->def.seed, block->turn[i]);
        *glint_of(preview, block, i) = (Glint){.share = 0};
        if (!mask_covers(preview, x, y)) continue;
        camera_ray(&preview->camera, 2 * ((float)x + 0.5f * BLOCK) / (float)preview->def.width - 1,
                   1 - 2 * ((float)y + 0.5f * BLOCK) / (float)preview->def.height, (const float[2]){0, 0},
                   &block->origin[i], &block->direction[i]);
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
    enum { RAYS = 6, APART = BLOCK * BLOCK };
    if (block->x[0] % APART || block->y[0] % APART || !is_metal(preview)) return;
    int active[LANES];
    const int unasked[LANES] = {0};
    Point seen[LANES];
    block->tile = NULL;
    if (!find_metal(preview, block, active, seen)) return;

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

        for (int i = 0; i < LANES; i++) {
            if (!active[i]) continue;
            Glint *glint = glint_of(preview, block, i);
            for (int k = 0; k < LIT_KINDS; k++) block->sum[i] = float3_add(block->sum[i], block->lit[k][i]);
            Float3 light = hit[i] ? block->sum[i] : sky_mirrored(&preview->sky, block->direction[i]), fire = {0, 0, 0};
            float clear = 1;
            if (preview->fire.visible)
                fire_along(preview, block->origin[i], block->direction[i], block->point[i].distance, &fire, &clear);
            glint->light = float3_mad(glint->light, float3_mad(fire, light, clear), 1.0f / RAYS);
            glint->share = 1;
        }
    }
}

/// Replaces each of a line of blocks by a quarter, a half and a quarter of its neighbours and itself.
static void smooth_line(const Glint *from, Glint *to, size_t count, size_t step) {
    for (size_t i = 0; i < count; i++) {
        const Glint *here = from + i * step, *before = i ? here - step : here,
                    *after = i + 1 < count ? here + step : here;
        to[i * step].light = float3_mix(here->light, float3_mix(before->light, after->light, 0.5f), 0.5f);
        to[i * step].share = mixf(here->share, mixf(before->share, after->share, 0.5f), 0.5f);
    }
}

void glints_smooth(Preview *preview) {
    if (!is_metal(preview)) return;
    const size_t across = glints_across(preview), down = mask_size(preview) / across;
    Glint *map = preview->glints[0], *scratch = preview->glints[1];
    for (size_t y = 0; y < down; y++) smooth_line(map + y * across, scratch + y * across, across, 1);
    for (size_t x = 0; x < across; x++) smooth_line(scratch + x, map + x, down, across);
}

void glints_add(const Preview *preview, Block *block, const int *active) {
    const int across = (int)glints_across(preview), down = (int)(mask_size(preview) / (size_t)across);
    for (int i = 0; i < LANES; i++) {
        Point *point = &block->point[i];
        if (!active[i] || !point->glints) continue;
        float fx, fy;
        const int x = noise_floor(clampf(((float)block->x[i] + 0.5f) / BLOCK - 0.5f, 0, (float)across - 1), &fx);
        const int y = noise_floor(clampf(((float)block->y[i] + 0.5f) / BLOCK - 0.5f, 0, (float)down - 1), &fy);
        const Glint *at = &preview->glints[0][y * across + x], *below = y + 1 < down ? at + across : at;
        const int right = x + 1 < across;
        const float share =
            mixf(mixf(at[0].share, at[right].share, fx), mixf(below[0].share, below[right].share, fx), fy);
        point->glints = share > 0.05f;
        if (!point->glints) continue;
        Float3 light = float3_mix(float3_mix(at[0].light, at[right].light, fx),
                                  float3_mix(below[0].light, below[right].light, fx), fy);
        point->glow = float3_add(point->glow, float3_scale(float3_mul(light, light_fresnel(point)), 1 / share));
    }
}

// What a glossy ground and metal mirror: sheets, embers, other shapes and flames.
//
// A ground that is oiled or honed is rough, so reflections are soft: draw.c traces a few rays for each block of pixels,
// spread by the roughness, and so does glints.c for metal; here they are smoothed over neighbouring blocks and read in
// between. The sky is not among what the ground mirrors: that follows from its direction alone (environment.c), less what
// they hide.

#include "preview/block.h"

#include <string.h>

static int mirror_across(const Preview *preview) { return (preview->def.width + BLOCK - 1) / BLOCK; }

SingeResult mirror_create(Preview *preview, SingeError *error) {
    if (preview->def.ground_gloss > 0 && isfinite(preview->def.ground_height))
        for (int k = 0; k < 2; k++) {
            preview->mirrored[k] = allocator_resize(preview->allocator, NULL, 0, mask_size(preview) * sizeof(Mirrored));
            if (!preview->mirrored[k])
                return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for what the ground mirrors");
            memset(preview->mirrored[k], 0, mask_size(preview) * sizeof(Mirrored));
        }
    const size_t size = mask_size(preview) * sizeof *preview->glints;
    preview->glints = allocator_resize(preview->allocator, NULL, 0, size);
    if (!preview->glints) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for what metal mirrors");
    memset(preview->glints, 0, size);
    return SINGE_OK;
}

void mirror_free(Preview *preview) {
    for (int k = 0; k < 2; k++)
        if (preview->mirrored[k])
            allocator_resize(preview->allocator, preview->mirrored[k], mask_size(preview) * sizeof(Mirrored), 0);
    if (preview->glints)
        allocator_resize(preview->allocator, preview->glints, mask_size(preview) * sizeof *preview->glints, 0);
}

size_t mirror_block(const Preview *preview, const Block *block, int lane) {
    const int x = block->x[0] / BLOCK + lane % BLOCK, y = block->y[0] / BLOCK + lane / BLOCK;
    return (size_t)(y * mirror_across(preview) + x);
}

bool mirror_aim(const Preview *preview, Block *block, int lane, Float3 *origin, Float3 *direction) {
    const int x = block->x[0] + BLOCK * (lane % BLOCK), y = block->y[0] + BLOCK * (lane / BLOCK);
    block->time[lane] = 0.5f;
    sample_pixel(x / BLOCK, y / BLOCK, preview->def.seed, block->turn[lane]);
    if (x >= preview->def.width || y >= preview->def.height) return false;
    camera_ray(&preview->camera, 2 * ((float)x + 0.5f * BLOCK) / (float)preview->def.width - 1,
               1 - 2 * ((float)y + 0.5f * BLOCK) / (float)preview->def.height, (const float[2]){0, 0}, origin,
               direction);
    return true;
}

/// (1 - s) a + s b
static Mirrored mirror_mix(Mirrored a, Mirrored b, float s) {
    return (Mirrored){float3_mix(a.light, b.light, s), mixf(a.share, b.share, s)};
}

/// Replaces each of a line of blocks `step` apart by a quarter, a half and a quarter of its neighbours and itself.
static void smooth_line(const Mirrored *from, Mirrored *to, int count, size_t step) {
    for (int i = 0; i < count; i++) {
        const Mirrored *here = from + (size_t)i * step;
        const Mirrored *before = i ? here - step : here, *after = i + 1 < count ? here + step : here;
        to[(size_t)i * step] = mirror_mix(*here, mirror_mix(*before, *after, 0.5f), 0.5f);
    }
}

void mirror_smooth(const Preview *preview, Mirrored *const maps[2], int times) {
    const size_t across = (size_t)mirror_across(preview);
    const int down = (int)(mask_size(preview) / across);
    Mirrored *map = maps[0], *scratch = maps[1];
    for (int y = 0; y < down; y++) smooth_line(map + (size_t)y * across, scratch + (size_t)y * across, (int)across, 1);
    for (int k = 0; k < times; k++) {
        if (k) memcpy(scratch, map, mask_size(preview) * sizeof *map);
        for (size_t x = 0; x < across; x++) smooth_line(scratch + x, map + x, down, across);
    }
}

Mirrored mirror_see(const Preview *preview, const Mirrored *map, float x, float y) {
    const int across = mirror_across(preview), down = (int)(mask_size(preview) / (size_t)across);
    float fx, fy;
    int i = noise_floor(clampf((x + 0.5f) / BLOCK - 0.5f, 0, (float)across - 1), &fx);
    int j = noise_floor(clampf((y + 0.5f) / BLOCK - 0.5f, 0, (float)down - 1), &fy);
    const Mirrored *at = &map[j * across + i], *below = j + 1 < down ? at + across : at;
    const int right = i + 1 < across;
    return mirror_mix(mirror_mix(at[0], at[right], fx), mirror_mix(below[0], below[right], fx), fy);
}

bool mirror_see_glints(const Preview *preview, Float3 normal, float x, float y, Float3 *light) {
    enum { NEAR = 4 };
    const int across = mirror_across(preview), down = (int)(mask_size(preview) / (size_t)across);
    float fx, fy, total = 0;
    const int left = noise_floor((x + 0.5f) / BLOCK - 0.5f, &fx) - 1;
    const int top = noise_floor((y + 0.5f) / BLOCK - 0.5f, &fy) - 1;
    *light = float3(0, 0, 0);
    for (int k = 0; k < NEAR * NEAR; k++) {
        const int i = left + k % NEAR, j = top + k / NEAR;
        if (i < 0 || j < 0 || i >= across || j >= down) continue;
        const Glint *glint = &preview->glints[j * across + i];
        const float alike = maxf(float3_dot(glint->normal, normal), 0), dx = (float)(k % NEAR - 1) - fx,
                    dy = (float)(k / NEAR - 1) - fy;
        const float near = maxf(1 - 0.25f * (dx * dx + dy * dy), 0);
        float weight = alike * alike;
        for (int p = 0; p < 3; p++) weight *= weight;               // alike^16: a tenth at thirty degrees
        weight = (weight + (alike > 0 ? 0.002f : 0)) * near * near; // narrow faces have no block of their own
        total += weight;
        *light = float3_mad(*light, glint->light, weight);
    }
    if (total > 0) *light = float3_scale(*light, 1 / total);
    return total > 0;
}

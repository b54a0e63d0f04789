// What a glossy ground mirrors: sheets, embers, shapes and flames.
//
// A ground that is oiled or honed is rough, so reflections are soft: draw.c traces a few rays for each block of pixels,
// spread by the roughness; here they are smoothed over neighbouring blocks and read in between. The sky is not among
// them: it is mirrored by its direction alone (environment.c), less what they hide.

#include "preview/internal.h"

#include <string.h>

static int mirror_across(const Preview *preview) { return (preview->def.width + BLOCK - 1) / BLOCK; }

SingeResult mirror_create(Preview *preview, SingeError *error) {
    if (!(preview->def.ground_gloss > 0) || !isfinite(preview->def.ground_height)) return SINGE_OK;
    for (int k = 0; k < 2; k++) {
        const size_t size = mask_size(preview) * sizeof(Mirrored);
        preview->mirrored[k] = allocator_resize(preview->allocator, NULL, 0, size);
        if (!preview->mirrored[k])
            return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for what the ground mirrors");
        memset(preview->mirrored[k], 0, size);
    }
    return SINGE_OK;
}

void mirror_free(Preview *preview) {
    for (int k = 0; k < 2; k++)
        if (preview->mirrored[k])
            allocator_resize(preview->allocator, preview->mirrored[k], mask_size(preview) * sizeof(Mirrored), 0);
}

Mirrored *mirror_block(const Preview *preview, int x, int y) {
    if (!preview->mirrored[0]) return NULL;
    return &preview->mirrored[0][y / BLOCK * mirror_across(preview) + x / BLOCK];
}

/// (1 - s) a + s b
static Mirrored mirror_mix(Mirrored a, Mirrored b, float s) {
    return (Mirrored){float3_mix(a.light, b.light, s), mixf(a.hides, b.hides, s)};
}

/// Replaces each of a line of blocks `step` apart by a quarter, a half and a quarter of its neighbours and itself.
static void mirror_smooth_line(const Mirrored *from, Mirrored *to, int count, size_t step) {
    for (int i = 0; i < count; i++) {
        const Mirrored *here = from + (size_t)i * step;
        const Mirrored *before = i ? here - step : here, *after = i + 1 < count ? here + step : here;
        to[(size_t)i * step] = mirror_mix(*here, mirror_mix(*before, *after, 0.5f), 0.5f);
    }
}

void mirror_smooth(Preview *preview) {
    if (!preview->mirrored[0]) return;
    const size_t across = (size_t)mirror_across(preview);
    const int down = (int)(mask_size(preview) / across);
    for (int pass = 0; pass < 2; pass++) {
        Mirrored *map = preview->mirrored[0], *scratch = preview->mirrored[1];
        for (int y = 0; y < down; y++)
            mirror_smooth_line(map + (size_t)y * across, scratch + (size_t)y * across, (int)across, 1);
        // twice as far down: what is rough draws lights out towards the eye
        for (size_t x = 0; x < across; x++) mirror_smooth_line(scratch + x, map + x, down, across);
        memcpy(scratch, map, mask_size(preview) * sizeof *map);
        for (size_t x = 0; x < across; x++) mirror_smooth_line(scratch + x, map + x, down, across);
    }
}

Mirrored mirror_see(const Preview *preview, int x, int y) {
    if (!preview->mirrored[0]) return (Mirrored){.hides = 0};
    const int across = mirror_across(preview), down = (int)(mask_size(preview) / (size_t)across);
    float fx, fy;
    int i = noise_floor(clampf(((float)x + 0.5f) / BLOCK - 0.5f, 0, (float)across - 1), &fx);
    int j = noise_floor(clampf(((float)y + 0.5f) / BLOCK - 0.5f, 0, (float)down - 1), &fy);
    const Mirrored *at = &preview->mirrored[0][j * across + i], *below = j + 1 < down ? at + across : at;
    const int right = i + 1 < across;
    return mirror_mix(mirror_mix(at[0], at[right], fx), mirror_mix(below[0], below[right], fx), fy);
}

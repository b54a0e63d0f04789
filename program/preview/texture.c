// Pictures on sheets, with smaller copies so that print does not shimmer: each level halves the previous one, averaged
// in linear light.

#include "preview/internal.h"

static size_t level_size(const Texture *texture, int level) {
    return (size_t)texture->width[level] * (size_t)texture->height[level] * 3;
}

SingeResult texture_create(Preview *preview, Texture *texture, const Image *image, SingeError *error) {
    *texture = (Texture){0};
    if (!image) return SINGE_OK;
    texture->levels[0] = image->rgb;
    texture->width[0] = image->width;
    texture->height[0] = image->height;
    texture->count = 1;

    while (texture->count < MIP_LIMIT) {
        int level = texture->count, w = texture->width[level - 1], h = texture->height[level - 1];
        if (w == 1 && h == 1) break;
        texture->width[level] = (w + 1) / 2;
        texture->height[level] = (h + 1) / 2;
        uint8_t *out = allocator_resize(preview->allocator, NULL, 0, level_size(texture, level));
        if (!out) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a picture's smaller copies");
        texture->levels[level] = out;
        texture->count++;

        // each pixel averages four samples
        const uint8_t *in = texture->levels[level - 1];
        for (int y = 0; y < texture->height[level]; y++) {
            int y0 = 2 * y < h ? 2 * y : h - 1, y1 = y0 + 1 < h ? y0 + 1 : y0;
            const uint8_t *row0 = in + (size_t)y0 * (size_t)w * 3, *row1 = in + (size_t)y1 * (size_t)w * 3;
            for (int x = 0; x < texture->width[level]; x++) {
                int x0 = 2 * x < w ? 2 * x : w - 1, x1 = x0 + 1 < w ? x0 + 1 : x0;
                for (int c = 0; c < 3; c++) {
                    float sum = preview->linear[row0[3 * x0 + c]] + preview->linear[row0[3 * x1 + c]] +
                                preview->linear[row1[3 * x0 + c]] + preview->linear[row1[3 * x1 + c]];
                    out[((size_t)y * (size_t)texture->width[level] + (size_t)x) * 3 + (size_t)c] =
                        (uint8_t)(clampf(srgb_encode(0.25f * sum), 0, 1) * 255 + 0.5f);
                }
            }
        }
    }

    return SINGE_OK;
}

void texture_free(const Preview *preview, Texture *texture) {
    for (int level = 1; level < texture->count; level++)
        allocator_resize(preview->allocator, (void *)texture->levels[level], level_size(texture, level), 0);
    *texture = (Texture){0};
}

Float3 texture_sample(const Preview *preview, const Texture *texture, float u, float v, float texels) {
    int level = 0;
    for (; level + 1 < texture->count && texels > 1.0f; level++) texels *= 0.5f;
    int w = texture->width[level], h = texture->height[level];
    float x = clampf(u, 0, 1) * (float)w - 0.5f, y = (1 - clampf(v, 0, 1)) * (float)h - 0.5f;
    x = clampf(x, 0, (float)(w - 1));
    y = clampf(y, 0, (float)(h - 1));
    int x0 = (int)x, y0 = (int)y, x1 = x0 + 1 < w ? x0 + 1 : x0, y1 = y0 + 1 < h ? y0 + 1 : y0;
    const uint8_t *row0 = texture->levels[level] + (size_t)y0 * (size_t)w * 3;
    const uint8_t *row1 = texture->levels[level] + (size_t)y1 * (size_t)w * 3;
    const uint8_t *a = row0 + x0 * 3, *b = row0 + x1 * 3, *c = row1 + x0 * 3, *d = row1 + x1 * 3;
    const float *linear = preview->linear;
    float out[3];

    for (int i = 0; i < 3; i++)
        out[i] = mixf(mixf(linear[a[i]], linear[b[i]], x - (float)x0), mixf(linear[c[i]], linear[d[i]], x - (float)x0),
                      y - (float)y0);

    return float3(out[0], out[1], out[2]);
}

// Which blocks of the picture a sheet or a shape may touch: the rest needs no rays from the camera.
//
// A triangle marks the rectangle around its three corners in the picture, a ball, a box or a capsule that of the sphere around
// it, widened by the reach of a pixel's samples. Anything that reaches behind the camera marks all blocks. What lens or
// shutter blur marks blocks as blurred.

#include "preview/internal.h"

#include <string.h>

enum { MASK_SHARP = 1, MASK_BLURRED = 2 };

/// In pixels.
typedef struct Rectangle {
    float low[2], high[2];
} Rectangle;

static const Rectangle nowhere = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
static const Rectangle everywhere = {{-INFINITY, -INFINITY}, {INFINITY, INFINITY}};

static int blocks_across(const Preview *preview) { return (preview->def.width + BLOCK - 1) / BLOCK; }
static int blocks_down(const Preview *preview) { return (preview->def.height + BLOCK - 1) / BLOCK; }

size_t mask_size(const Preview *preview) { return (size_t)blocks_across(preview) * (size_t)blocks_down(preview); }

/// Widens the rectangle to hold a point as the lens spreads it. Behind the camera or too near: everything.
static void include(const Preview *preview, Float3 p, Rectangle *r) {
    const Camera *camera = &preview->camera;
    Float3 d = float3_sub(p, camera->eye);
    float depth = float3_dot(d, camera->forward);

    if (!(depth > 1e-3f * camera->reach + camera->lens)) {
        *r = everywhere;
        return;
    }

    float x = float3_dot(d, camera->right) / (float3_dot(camera->right, camera->right) * depth);
    float y = float3_dot(d, camera->up) / (float3_dot(camera->up, camera->up) * depth);
    float at[2] = {(0.5f + 0.5f * x) * (float)preview->def.width, (0.5f - 0.5f * y) * (float)preview->def.height};
    float blur = camera_blur(camera, depth);
    for (int c = 0; c < 2; c++) {
        r->low[c] = minf(r->low[c], at[c] - blur);
        r->high[c] = maxf(r->high[c], at[c] + blur);
    }
}

/// Widens the rectangle to hold another; returns the longer side of that.
static float join(const Rectangle *other, Rectangle *r) {
    for (int c = 0; c < 2; c++) {
        r->low[c] = minf(r->low[c], other->low[c]);
        r->high[c] = maxf(r->high[c], other->high[c]);
    }

    return maxf(other->high[0] - other->low[0], other->high[1] - other->low[1]);
}

/// `blur`: pixels over which lens and shutter spread a point of what is in the rectangle.
static void mark(Preview *preview, const Rectangle *r, float blur) {
    const float reach = 1.5f; // pixels; a sample lies up to 0.9 from the centre of its pixel
    const uint8_t kind = blur > 4 ? MASK_BLURRED : MASK_SHARP;
    int across = blocks_across(preview), down = blocks_down(preview);
    int x0 = (int)clampf((r->low[0] - reach) / BLOCK, 0, (float)across);
    int y0 = (int)clampf((r->low[1] - reach) / BLOCK, 0, (float)down);
    int x1 = (int)clampf((r->high[0] + reach) / BLOCK, -1, (float)(across - 1));
    int y1 = (int)clampf((r->high[1] + reach) / BLOCK, -1, (float)(down - 1));
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            uint8_t *block = &preview->mask[(size_t)y * (size_t)across + (size_t)x];
            if (*block < kind) *block = kind;
        }
}

void mask_fill(Preview *preview) {
    const PreviewScene *scene = &preview->scene;
    bool moves = preview->def.shutter > 0;
    memset(preview->mask, 0, mask_size(preview));

    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        Rectangle r = nowhere;
        float blur = 0;
        for (int k = 0; k < 3; k++) {
            Rectangle point = nowhere;
            uint32_t v = scene->triangles[t][k];
            for (int end = 0; moves && end < 2; end++) include(preview, float3_load(scene->moved[end][v]), &point);
            if (!moves) include(preview, float3_load(scene->positions[v]), &point);
            blur = maxf(blur, join(&point, &r));
        }

        mark(preview, &r, blur);
    }

    // the triangles of a solid, which may be long and thin; of others the cube around the sphere around them
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        const PreviewShape *shape = &preview->shapes[k];
        const float around = shape_extent(shape, 0), extent = shape_extent(shape, preview->def.shutter);
        const float far = extent > around ? INFINITY : 0, half = shape->facets ? extent - around : extent;
        const PreviewSolid *solid = shape->facets ? shape->solid : NULL;
        for (uint32_t t = 0; t < (solid ? solid->triangle_count : 1); t++) {
            Rectangle r = nowhere;
            float blur = far;
            for (int v = 0; v < (solid ? 3 : 1); v++) {
                Float3 centre = shape_centre(shape);
                if (solid) {
                    const float *vertex = solid->vertices + 3 * (size_t)solid->triangles[3 * (size_t)t + (size_t)v];
                    centre =
                        float3_add(float3_load(shape->position), quat_rotate(shape->rotation, float3_load(vertex)));
                }
                for (int corner = 0; corner < 8; corner++) {
                    Rectangle point = nowhere;
                    include(preview,
                            float3(centre.x + (corner & 1 ? half : -half), centre.y + (corner & 2 ? half : -half),
                                   centre.z + (corner & 4 ? half : -half)),
                            &point);
                    blur = maxf(blur, join(&point, &r));
                }
            }
            mark(preview, &r, blur);
        }
    }
}

static int mask_at(const Preview *preview, int x, int y) {
    return preview->mask[(size_t)(y / BLOCK) * (size_t)blocks_across(preview) + (size_t)(x / BLOCK)];
}

bool mask_covers(const Preview *preview, int x, int y) { return mask_at(preview, x, y) != 0; }
bool mask_blurs(const Preview *preview, int x, int y) { return mask_at(preview, x, y) == MASK_BLURRED; }

bool mask_nears(const Preview *preview, int x, int y) {
    for (int k = 0; k < 9; k++) {
        const int i = x + BLOCK * (k % 3 - 1), j = y + BLOCK * (k / 3 - 1);
        const bool inside = i >= 0 && j >= 0 && i < preview->def.width && j < preview->def.height;
        if (inside && mask_at(preview, i, j)) return true;
    }
    return false;
}

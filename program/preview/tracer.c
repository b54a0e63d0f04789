// Rays of a picture against its sheets and shapes.
#include "preview/internal.h"

/// Shadow rays on their way.
typedef struct Passage {
    const Preview *preview;
    float *clear; ///< [LANES] transmittance along each
} Passage;

/// Lets shadow rays pass through the holes drawn in a burnt sheet, and partly through the sheet.
static bool stops_at_sheet(void *context, int lane, uint32_t triangle, float u, float v) {
    const Passage *passage = context;
    const Preview *preview = passage->preview;
    const PreviewScene *scene = &preview->scene;
    const float footprint = preview->camera.pixel * preview->camera.reach;

    const uint32_t *t = scene->triangles[triangle];
    const PaperVertex *vertices = scene->vertices;
    const float burn = maxf(vertices[t[0]].burn, maxf(vertices[t[1]].burn, vertices[t[2]].burn));
    if (burn > PAPER_WHOLE) {
        PaperState state;
        paper_state(scene, triangle, u, v, &state);
        if (paper_is_hole(preview, &state, footprint)) return false;
    }

    // what a sheet transmits straight: most of the light through it is scattered
    const float straight = 0.5f * paper_transmittance(preview, vertices[t[0]].sheet);
    float *clear = &passage->clear[lane];
    *clear *= straight * (1 - stepf(0.08f, PAPER_WHOLE, burn));
    return *clear <= 0.01f;
}

SingeResult tracer_build(Preview *preview, SingeError *error) {
    PreviewScene *scene = &preview->scene;
    const bool moves = preview->def.shutter > 0;
    float(*const *ends)[4] = scene->moved;
    BvhMesh mesh = {.positions = {*(moves ? ends[0] : scene->positions), *(moves ? ends[1] : scene->positions)},
                    .stride = 4,
                    .triangles = (const uint32_t(*)[3])scene->triangles,
                    .triangle_count = scene->triangle_count};
    if (bvh_build(&scene->bvh, preview->allocator, &mesh)) return SINGE_OK;
    return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a surface of %u triangles",
                        scene->triangle_count);
}

/// 1 / x, large but finite at 0 so that no 0 times infinity follows.
static float inverse(float x) { return fabsf(x) > 1e-12f ? 1 / x : 1e12f; }

bool bounds_near(const Float3 bounds[2], Float3 o, Float3 d, float far, float margin) {
    const Float3 low = bounds[0], high = bounds[1];
    float ix = inverse(d.x), iy = inverse(d.y), iz = inverse(d.z);
    float x0 = (low.x - margin - o.x) * ix, x1 = (high.x + margin - o.x) * ix;
    float y0 = (low.y - margin - o.y) * iy, y1 = (high.y + margin - o.y) * iy;
    float z0 = (low.z - margin - o.z) * iz, z1 = (high.z + margin - o.z) * iz;
    float enter = maxf(maxf(minf(x0, x1), minf(y0, y1)), maxf(minf(z0, z1), 0));
    float leave = minf(minf(maxf(x0, x1), maxf(y0, y1)), minf(maxf(z0, z1), far));
    return !(enter > leave);
}

bool tracer_near(const PreviewScene *scene, Float3 o, Float3 d, float far, float margin) {
    return bounds_near((const Float3[]){scene->low, scene->high}, o, d, far, margin);
}

void tracer_intersect(const Preview *preview, const int *valid, Rays *rays, Hits *hits) {
    const PreviewScene *scene = &preview->scene;
    Rays wanted = *rays;
    bool any = false;

    for (int i = 0; i < LANES; i++) {
        hits->triangle[i] = BVH_NONE;
        if (valid[i] && tracer_near(scene, rays_origin(rays, i), rays_direction(rays, i), rays->far[i], 0)) any = true;
        else wanted.far[i] = -1;
    }

    if (!any) return;
    bvh_nearest(&scene->bvh, &wanted, hits);
    for (int i = 0; i < LANES; i++)
        if (hits->triangle[i] != BVH_NONE) rays->far[i] = wanted.far[i];
}

void tracer_occlude(const Preview *preview, const int *valid, Rays *rays, float clear[LANES]) {
    const PreviewScene *scene = &preview->scene;
    bool any = false;

    for (int i = 0; i < LANES; i++) {
        clear[i] = 1;
        if (!valid[i]) rays->far[i] = -1;
        if (!valid[i]) continue;
        Float3 o = rays_origin(rays, i), d = rays_direction(rays, i), normal;
        float moment = shutter_moment(preview, rays->time[i]);
        for (uint32_t k = 0; k < preview->shape_count && clear[i] > 0; k++)
            if (shape_intersect(&preview->shapes[k], moment, o, d, scene->epsilon, rays->far[i], &normal) > 0)
                clear[i] = 0;
        if (clear[i] <= 0 || !tracer_near(scene, o, d, rays->far[i], 0)) rays->far[i] = -1;
        any = any || rays->far[i] >= 0;
    }

    if (!any) return;
    Passage passage = {preview, clear};
    bool asked[LANES];
    for (int i = 0; i < LANES; i++) asked[i] = rays->far[i] >= 0;
    bvh_pass(&scene->bvh, rays, stops_at_sheet, &passage);
    for (int i = 0; i < LANES; i++)
        if (asked[i] && rays->far[i] < 0) clear[i] = 0;
}

// Rays of a picture against its sheets and shapes.
#include "common/float4.h"
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
                    .triangle_count = scene->triangle_count,
                    .threads = preview->def.thread_count};
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

/// Bits of the rays that may meet a shape: those that come near the sphere around it.
static unsigned shape_near_rays(const Preview *preview, const PreviewShape *shape, const Rays *rays) {
    const Float3 centre = shape_centre(shape);
    const float extent = 1.001f * shape_extent(shape, preview->def.shutter) + 1e-5f; // beyond the error of a distance
    unsigned near = 0;
    for (int i = 0; i < LANES; i += 4) {
        const Float4 dx = float4_load(rays->direction[0] + i), x = centre.x - float4_load(rays->origin[0] + i);
        const Float4 dy = float4_load(rays->direction[1] + i), y = centre.y - float4_load(rays->origin[1] + i);
        const Float4 dz = float4_load(rays->direction[2] + i), z = centre.z - float4_load(rays->origin[2] + i);
        const Float4 along = x * dx + y * dy + z * dz;
        const Float4 ax = x - along * dx, ay = y - along * dy, az = z - along * dz;
        near |= float4_bits((ax * ax + ay * ay + az * az <= extent * extent) & (along >= -extent) &
                            (along <= float4_load(rays->far + i) + extent))
                << i;
    }
    return near;
}

void tracer_meet_shapes(const Preview *preview, const int *valid, const Rays *rays, const Hits *hits, Met *met) {
    unsigned wanted = 0;
    for (int i = 0; i < LANES; i++) {
        wanted |= (valid[i] ? 1u : 0u) << i;
        met->shape[i] = NULL;
        met->distance[i] = hits->triangle[i] != BVH_NONE ? rays->far[i] : INFINITY;
    }

    for (uint32_t k = 0; k < preview->shape_count; k++) {
        const PreviewShape *shape = &preview->shapes[k];
        for (unsigned near = wanted & shape_near_rays(preview, shape, rays); near; near &= near - 1) {
            const int i = __builtin_ctz(near);
            Facing facing = {{0, 0, 1}, 0};
            const float t = shape_intersect(shape, shutter_moment(preview, rays->time[i]), rays_origin(rays, i),
                                            rays_direction(rays, i), 0, met->distance[i], &facing);
            if (!(t > 0)) continue;
            met->distance[i] = t;
            met->shape[i] = shape;
            met->facing[i] = facing;
        }
    }
}

void tracer_occlude(const Preview *preview, const int *valid, Rays *rays, float clear[LANES]) {
    const PreviewScene *scene = &preview->scene;
    bool any = false;
    unsigned open = 0; // bits of the rays that no shape blocks
    for (int i = 0; i < LANES; i++) open |= (valid[i] ? 1u : 0u) << i;
    for (uint32_t k = 0; k < preview->shape_count && open; k++) {
        const PreviewShape *shape = &preview->shapes[k];
        for (unsigned near = shape_near_rays(preview, shape, rays) & open; near; near &= near - 1) {
            const int i = __builtin_ctz(near);
            Facing facing;
            if (shape_intersect(shape, shutter_moment(preview, rays->time[i]), rays_origin(rays, i),
                                rays_direction(rays, i), scene->epsilon, rays->far[i], &facing) > 0)
                open &= ~(1u << i);
        }
    }

    for (int i = 0; i < LANES; i++) {
        clear[i] = valid[i] && !(open >> i & 1) ? 0 : 1;
        if (!valid[i] || clear[i] <= 0 ||
            !tracer_near(scene, rays_origin(rays, i), rays_direction(rays, i), rays->far[i], 0))
            rays->far[i] = -1;
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

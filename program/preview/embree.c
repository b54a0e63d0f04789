// The device, the acceleration structure and packets of rays, on Embree.
//
// One builder thread: the tree, and with it the order in which equal hits are met, must not depend on the number of
// threads. Debian's Embree checks its arguments: unused lanes must hold a valid ray.

#include "preview/internal.h"

/// The transmittance along a packet of shadow rays.
typedef struct Passage {
    TraceContext context; ///< first: Embree hands it back
    float clear[LANES];
} Passage;

SingeResult tracer_open(Preview *preview, SingeError *error) {
    preview->device = rtcNewDevice("threads=1,set_affinity=0");
    return preview->device ? SINGE_OK : preview_fail(error, SINGE_ERROR_STATE, -1, "Embree cannot create a device");
}

void tracer_close(Preview *preview) {
    if (preview->device) rtcReleaseDevice(preview->device);
}

/// Lets shadow rays pass through the holes drawn in a burnt sheet, and partly through the sheet.
static void pass_sheets(const struct RTCFilterFunctionNArguments *arguments) {
    const Preview *preview = arguments->geometryUserPtr;
    const PreviewScene *scene = &preview->scene;
    Passage *passage = (Passage *)(void *)arguments->context;
    float footprint = preview->camera.pixel * preview->camera.reach;

    // fields of N each: the ray's twelve, of which the 11th is its id, and the hit's normal's three, u, v, triangle;
    // the accessors of the header are C++ only
    unsigned count = arguments->N;
    const float *u = (const float *)arguments->hit + 3 * count, *v = u + count;
    const unsigned *triangle = (const unsigned *)arguments->hit + 5 * count;
    const unsigned *lane = (const unsigned *)arguments->ray + 10 * count;

    for (unsigned i = 0; i < count; i++) {
        if (!arguments->valid[i]) continue;
        const uint32_t *t = scene->triangles[triangle[i]];
        const PaperVertex *vertices = scene->vertices;
        float burn = maxf(vertices[t[0]].burn, maxf(vertices[t[1]].burn, vertices[t[2]].burn));
        if (burn > PAPER_WHOLE) {
            PaperState state;
            paper_state(scene, triangle[i], u[i], v[i], &state);
            if (paper_is_hole(preview, &state, footprint)) {
                arguments->valid[i] = 0;
                continue;
            }
        }

        // what a sheet transmits straight: most of the light through it is scattered
        float straight = 0.5f * paper_transmittance(preview, vertices[t[0]].sheet);
        float *clear = &passage->clear[lane[i]];
        *clear *= straight * (1 - stepf(0.08f, PAPER_WHOLE, burn));
        if (*clear > 0.01f) arguments->valid[i] = 0;
    }
}

SingeResult tracer_build(Preview *preview, SingeError *error) {
    PreviewScene *scene = &preview->scene;
    tracer_release(preview);
    if (!scene->triangle_count) return SINGE_OK;

    (void)rtcGetDeviceError(preview->device);
    RTCScene built = rtcNewScene(preview->device);
    RTCGeometry geometry = rtcNewGeometry(preview->device, RTC_GEOMETRY_TYPE_TRIANGLE);

    if (built && geometry) {
        rtcSetSceneFlags(built, RTC_SCENE_FLAG_ROBUST);
        bool moves = preview->def.shutter > 0;
        rtcSetGeometryTimeStepCount(geometry, moves ? 2 : 1);
        for (unsigned step = 0; step < (moves ? 2u : 1u); step++)
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3,
                                       moves ? scene->moved[step] : scene->positions, 0, sizeof *scene->positions,
                                       scene->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, scene->triangles, 0,
                                   sizeof *scene->triangles, scene->triangle_count);
        rtcSetGeometryUserData(geometry, preview);
        rtcSetGeometryOccludedFilterFunction(geometry, pass_sheets);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(built, geometry);
        rtcCommitScene(built);
    }

    if (geometry) rtcReleaseGeometry(geometry);

    enum RTCError code = rtcGetDeviceError(preview->device);
    SingeResult result = SINGE_OK;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        result = preview_fail(error, SINGE_ERROR_MEMORY, -1, "Embree is out of memory");
    else if (code != RTC_ERROR_NONE)
        result = preview_fail(error, SINGE_ERROR_STATE, -1, "Embree refused the surface (error %d)", (int)code);
    else if (!built) result = preview_fail(error, SINGE_ERROR_MEMORY, -1, "Embree cannot create a scene");
    if (!result) scene->embree = built;
    else if (built) rtcReleaseScene(built);

    return result;
}

void tracer_release(Preview *preview) {
    if (preview->scene.embree) rtcReleaseScene(preview->scene.embree);
    preview->scene.embree = NULL;
}

/// 1 / x, large but finite at 0 so that no 0 times infinity follows.
static float inverse(float x) { return fabsf(x) > 1e-12f ? 1 / x : 1e12f; }

bool tracer_near(const PreviewScene *scene, Float3 o, Float3 d, float far, float margin) {
    float ix = inverse(d.x), iy = inverse(d.y), iz = inverse(d.z);
    float x0 = (scene->low.x - margin - o.x) * ix, x1 = (scene->high.x + margin - o.x) * ix;
    float y0 = (scene->low.y - margin - o.y) * iy, y1 = (scene->high.y + margin - o.y) * iy;
    float z0 = (scene->low.z - margin - o.z) * iz, z1 = (scene->high.z + margin - o.z) * iz;
    float enter = maxf(maxf(minf(x0, x1), minf(y0, y1)), maxf(minf(z0, z1), 0));
    float leave = minf(minf(maxf(x0, x1), maxf(y0, y1)), minf(maxf(z0, z1), far));
    return !(enter > leave);
}

void tracer_intersect(const Preview *preview, const int *valid, struct RTCRayHit16 *rays) {
    const PreviewScene *scene = &preview->scene;
    struct RTCRay16 *ray = &rays->ray;
    _Alignas(64) int wanted[LANES];
    int count = 0;

    for (int i = 0; i < LANES; i++) {
        rays->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        rays->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        wanted[i] = valid[i];
        if (wanted[i] && scene->embree)
            wanted[i] = -tracer_near(scene, float3(ray->org_x[i], ray->org_y[i], ray->org_z[i]),
                                     float3(ray->dir_x[i], ray->dir_y[i], ray->dir_z[i]), ray->tfar[i], 0);
        count += wanted[i] != 0;
    }

    if (!scene->embree || !count) return;
    trace_nearest16(scene->embree, wanted, rays);
}

void tracer_occlude(const Preview *preview, int *valid, struct RTCRay16 *ray, float clear[LANES]) {
    const PreviewScene *scene = &preview->scene;
    Passage passage;
    int count = 0;

    for (int i = 0; i < LANES; i++) {
        passage.clear[i] = clear[i] = 1;
        if (!valid[i]) continue;
        Float3 o = float3(ray->org_x[i], ray->org_y[i], ray->org_z[i]),
               d = float3(ray->dir_x[i], ray->dir_y[i], ray->dir_z[i]), normal;
        float moment = shutter_moment(preview, ray->time[i]);
        for (uint32_t k = 0; k < preview->shape_count && clear[i] > 0; k++)
            if (shape_intersect(&preview->shapes[k], moment, o, d, scene->epsilon, ray->tfar[i], &normal) > 0)
                clear[i] = 0;
        if (clear[i] <= 0 || !scene->embree || !tracer_near(scene, o, d, ray->tfar[i], 0)) valid[i] = 0;
        count += valid[i] != 0;
    }

    if (!count) return;

    trace_init(&passage.context);
    trace_occluded16(scene->embree, valid, &passage.context, ray);
    for (int i = 0; i < LANES; i++)
        if (valid[i]) clear[i] = ray->tfar[i] < 0 ? 0 : passage.clear[i];
}

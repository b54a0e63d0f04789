// One set of names for Embree 4 and 3: ray queries take a context in Embree 3, arguments in Embree 4. SINGE_EMBREE, 3
// or 4, is the version found by CMake; 0 is a build without the preview.
#ifndef PREVIEW_TRACE_H
#define PREVIEW_TRACE_H

#if SINGE_EMBREE == 4
#include <embree4/rtcore.h>

typedef struct RTCRayQueryContext TraceContext;

static inline void trace_init(TraceContext *context) { rtcInitRayQueryContext(context); }

static inline void trace_nearest(RTCScene scene, struct RTCRayHit *ray) { rtcIntersect1(scene, ray, NULL); }

/// Rays that run side by side. valid[i]: -1 or 0.
static inline void trace_nearest16(RTCScene scene, const int *valid, struct RTCRayHit16 *rays) {
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid, scene, rays, &arguments);
}

/// Filters find `context` in their arguments.
static inline void trace_occluded16(RTCScene scene, const int *valid, TraceContext *context, struct RTCRay16 *rays) {
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = context;
    rtcOccluded16(valid, scene, rays, &arguments);
}

#elif SINGE_EMBREE == 0
typedef void *RTCDevice;
typedef void *RTCScene;
struct RTCRayHit16;
struct RTCRay16;

#else
#include <embree3/rtcore.h>

typedef struct RTCIntersectContext TraceContext;

static inline void trace_init(TraceContext *context) { rtcInitIntersectContext(context); }

static inline void trace_nearest(RTCScene scene, struct RTCRayHit *ray) {
    TraceContext context;
    trace_init(&context);
    rtcIntersect1(scene, &context, ray);
}

/// Rays that run side by side. valid[i]: -1 or 0.
static inline void trace_nearest16(RTCScene scene, const int *valid, struct RTCRayHit16 *rays) {
    TraceContext context;
    trace_init(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &context, rays);
}

/// Filters find `context` in their arguments.
static inline void trace_occluded16(RTCScene scene, const int *valid, TraceContext *context, struct RTCRay16 *rays) {
    rtcOccluded16(valid, scene, context, rays);
}
#endif

#endif

// A build without the preview: it draws nothing, but bakes the gas (fire_shade.c).
#include "preview/internal.h"

bool preview_draws(void) { return false; }

static SingeResult draw_nothing(SingeError *error) {
    return preview_fail(error, SINGE_ERROR_STATE, -1, "this singe was built without the preview");
}

SingeResult preview_draw(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb, SingeError *error) {
    (void)preview, (void)surface, (void)time, (void)rgb;
    return draw_nothing(error);
}

SingeResult preview_draw_layers(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb,
                                const PreviewLayers *layers, SingeError *error) {
    (void)preview, (void)surface, (void)time, (void)rgb, (void)layers;
    return draw_nothing(error);
}

SingeResult preview_pack(Preview *preview, const SingeSurface *surface, double time, uint8_t **bytes, size_t *size,
                         SingeError *error) {
    (void)preview, (void)surface, (void)time, (void)size;
    *bytes = NULL;
    return draw_nothing(error);
}

SingeResult tracer_open(Preview *preview, SingeError *error) {
    (void)preview, (void)error;
    return SINGE_OK;
}

void tracer_close(Preview *preview) { (void)preview; }

SingeResult tracer_build(Preview *preview, SingeError *error) {
    (void)preview, (void)error;
    return SINGE_OK;
}

void tracer_release(Preview *preview) { (void)preview; }

SingeResult facets_get(Preview *preview, const PreviewSolid *solid, const Facets **facets, SingeError *error) {
    (void)preview, (void)solid, (void)error;
    *facets = NULL;
    return SINGE_OK;
}

float facets_intersect(const Facets *facets, Float3 origin, Float3 direction, float near, float far, Float3 *normal) {
    (void)facets, (void)origin, (void)direction, (void)near, (void)far, (void)normal;
    return -1;
}

void facets_drop(Preview *preview) { (void)preview; }

void facets_free(Preview *preview) { (void)preview; }

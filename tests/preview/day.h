// The light of the preview's tests: a low sun, a bright sky and a table, so that everything in a picture shows.
#pragma once

#include "preview/preview.h"

static inline PreviewDef by_day(void) {
    PreviewDef def = preview_default();
    def.samples = 8;
    def.camera = (PreviewCamera){.eye = {0, -0.42f, 0.34f}, .target = {0, -0.01f, 0}, .up = {0, 0, 1}, .fov = 0.6f};
    const float direction[3] = {-0.55f, 0.45f, 0.62f}, sun[3] = {2.2f, 2.05f, 1.85f}, sky[3] = {0.4f, 0.45f, 0.53f};
    const float ground[3] = {0.235f, 0.145f, 0.085f}, background[3] = {0.16f, 0.15f, 0.145f};
    def.sun_angle = 0.045f;
    for (int k = 0; k < 3; k++) {
        def.sun_direction[k] = direction[k];
        def.sun_colour[k] = sun[k];
        def.sky_colour[k] = sky[k];
        def.ground_colour[k] = ground[k];
        def.background[k] = background[k];
    }

    return def;
}

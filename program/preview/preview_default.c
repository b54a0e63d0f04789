// The defaults of pictures, apart, for scenes.
#include "preview/preview.h"

#include <math.h>

PreviewDef preview_default(void) {
#define DEGREE (3.14159265358979323846 / 180)
#define BRACED(...) \
    { __VA_ARGS__ }
#define PREVIEW_MAIN(TYPE, key, target, length, dimension, standard, range, text) .target = standard,
#define PREVIEW_CAMERA PREVIEW_MAIN
#define PREVIEW_LIGHT PREVIEW_MAIN
#define PREVIEW_LAMP PREVIEW_MAIN
#define PREVIEW_ENVIRONMENT PREVIEW_MAIN
#define PREVIEW_GROUND PREVIEW_MAIN
#define PREVIEW_WALL PREVIEW_MAIN
    return (PreviewDef){
        .width = 960,
        .height = 540,
        .thread_count = 1,
        .pace = 1,
        .wall_distance = -INFINITY,
#include "preview/preview.def"
    };
}

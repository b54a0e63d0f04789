#include "formats/output.h"

#define OUTPUT_ROW(name, ...) {#name, __VA_ARGS__},
const OutputFormat output_formats[OUTPUT_COUNT] = {OUTPUT_FORMATS(OUTPUT_ROW)};

SingeResult ply_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame, SingeError *error) {
    (void)scene;
    return ply_write_surface(path, frame->surface, frame->time, error);
}

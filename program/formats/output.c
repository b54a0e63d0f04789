#include "formats/output.h"

#define OUTPUT_ROW(name, ...) {#name, __VA_ARGS__},
const OutputFormat output_formats[OUTPUT_COUNT] = {OUTPUT_FORMATS(OUTPUT_ROW)};

const OutputSingle output_singles[OUTPUT_SINGLE_COUNT] = {{"usd", true, ".usdc", usd_write_single},
                                                          {"usdz", false, ".usdz", usdz_write},
                                                          {"glb", true, ".glb", glb_write_single},
                                                          {"vat", false, NULL, vat_write}};

SingeResult ply_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame, SingeError *error) {
    (void)scene;
    return ply_write_surface(path, frame->surface, frame->time, error);
}

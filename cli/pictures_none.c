#include "cli/pictures.h"

#include "cli/bench_preview.h"

#include <stdio.h>

bool pictures_available(void) { return false; }

SingeResult pictures_open(const Job *job, Pictures **pictures, SingeError *error) {
    (void)job;
    *pictures = NULL;
    *error = (SingeError){.code = SINGE_ERROR_STATE, .stage = "preview", .element = -1};
    snprintf(error->message, sizeof error->message, "this singe was built without the preview");
    return SINGE_ERROR_STATE;
}

SingeResult pictures_open_sharp(const Job *job, int scale, Pictures **pictures, SingeError *error) {
    (void)scale;
    return pictures_open(job, pictures, error);
}

SingeResult pictures_ember_width(Pictures *pictures, const SingeSurface *surface, double time, double *width,
                                 SingeError *error) {
    (void)pictures, (void)surface, (void)time, (void)width, (void)error;
    return SINGE_ERROR_STATE;
}

const uint8_t *pictures_draw(Pictures *pictures, const SingeSurface *surface, const SingeGas *gas, double time,
                             SingeError *error) {
    (void)pictures, (void)surface, (void)gas, (void)time, (void)error;
    return NULL;
}

SingeResult pictures_bake(Pictures *pictures, const SingeSurface *surface, const SingeGas *gas, double time, int detail,
                          float *smoke, float *flame, SingeError *error) {
    (void)pictures, (void)surface, (void)gas, (void)time, (void)detail, (void)smoke, (void)flame;
    *error = (SingeError){.code = SINGE_ERROR_STATE, .stage = "preview", .element = -1};
    return SINGE_ERROR_STATE;
}

SingeResult pictures_keep_layers(Pictures *pictures, SingeError *error) {
    (void)pictures, (void)error;
    return SINGE_ERROR_STATE;
}

SingeResult pictures_write_layers(const Pictures *pictures, const char *path, SingeError *error) {
    (void)pictures, (void)path, (void)error;
    return SINGE_ERROR_STATE;
}

SingeResult bench_preview(const BenchOptions *options, BenchTable *table, SingeError *error) {
    (void)options, (void)table;
    *error = (SingeError){.code = SINGE_ERROR_STATE, .stage = "preview", .element = -1};
    snprintf(error->message, sizeof error->message, "this singe was built without the preview");
    return SINGE_ERROR_STATE;
}

void pictures_size(const Pictures *pictures, int *width, int *height) {
    (void)pictures;
    *width = *height = 0;
}

void pictures_close(Pictures *pictures) { (void)pictures; }

// The preview of a scene as the commands use it. A program built without the preview bakes gas but draws nothing.
#ifndef CLI_PICTURES_H
#define CLI_PICTURES_H

#include "cli/job.h"

typedef struct Pictures Pictures;

/// False in a program built without the preview.
bool pictures_available(void);

/// The job must outlive *pictures. Fails in a program built without the preview.
SINGE_NODISCARD SingeResult pictures_open(const Job *job, Pictures **pictures, SingeError *error);

/// The same only for pictures_bake, in any program.
SINGE_NODISCARD SingeResult pictures_open_baker(const Job *job, Pictures **pictures, SingeError *error);

/// Draws a frame and returns its pixels, [height * width * 3], valid until the next call; NULL on failure. The gas may
/// be NULL.
const uint8_t *pictures_draw(Pictures *pictures, const SingeSurface *surface, const SingeGas *gas, double time,
                             SingeError *error);

/// The gas on finer cells, as preview_bake_gas.
SINGE_NODISCARD SingeResult pictures_bake(Pictures *pictures, const SingeSurface *surface, const SingeGas *gas,
                                          double time, int detail, float *smoke, float *flame, SingeError *error);

/// Makes pictures_draw keep the layers of the frame, too, for pictures_write_layers.
SINGE_NODISCARD SingeResult pictures_keep_layers(Pictures *pictures, SingeError *error);

/// Writes the layers of the last frame drawn as an EXR (docs/formats.md).
SINGE_NODISCARD SingeResult pictures_write_layers(const Pictures *pictures, const char *path, SingeError *error);

/// The same, sharp and `scale` times as large, with its layers: for pictures_ember_width.
SINGE_NODISCARD SingeResult pictures_open_sharp(const Job *job, int scale, Pictures **pictures, SingeError *error);
/// Draws a frame without gas and measures the width of the glowing line, m; NaN if nothing glows.
SINGE_NODISCARD SingeResult pictures_ember_width(Pictures *pictures, const SingeSurface *surface, double time,
                                                 double *width, SingeError *error);

void pictures_size(const Pictures *pictures, int *width, int *height);
void pictures_close(Pictures *pictures);

#endif

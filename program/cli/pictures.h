// The pictures of a scene as the commands use them, and the frames that they show.
#pragma once

#include "cli/folder.h"
#include "cli/job.h"
#include "formats/formats.h"
#include "preview/preview.h"
#include "singe/base.h"
#include "singe/singe.h"

typedef struct Pictures Pictures;

/// The job must outlive *pictures.
SINGE_NODISCARD SingeResult pictures_open(const Job *job, Pictures **pictures, SingeError *error);

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

/// The same, sharp and with its layers: for pictures_flame_shares and pictures_flame_feet.
SINGE_NODISCARD SingeResult pictures_open_sharp(const Job *job, Pictures **pictures, SingeError *error);

/// Sheets and solids alone, in the dark and larger: for pictures_ember_width.
SINGE_NODISCARD SingeResult pictures_open_embers(const Job *job, Pictures **pictures, SingeError *error);
/// Draws a frame without gas and measures the width of the glowing line, m; NaN if nothing glows.
SINGE_NODISCARD SingeResult pictures_ember_width(Pictures *pictures, const SingeSurface *surface, double time,
                                                 double *width, SingeError *error);

/// How pale and flat the flames of the last frame drawn are.
FlameShares pictures_flame_shares(const Pictures *pictures);

/// How far they stand from what burns.
SINGE_NODISCARD SingeResult pictures_flame_feet(const Pictures *pictures, const SingeSurface *surface, FlameFeet *feet,
                                                SingeError *error);

void pictures_size(const Pictures *pictures, int *width, int *height);
void pictures_close(Pictures *pictures);

typedef struct Frame {
    SingeSurface surface;
    Gas gas; ///< as in its file; empty if there is none
    double time;
    SingeStats stats; ///< of a simulation
} Frame;

void frame_free(Frame *frame);

/// The simulation's surface as it is now.
SINGE_NODISCARD SingeResult frame_take_surface(SingeSim *sim, Frame *frame, SingeError *error);
/// Its gas. If a simulation has gas, every frame has gas, even in still air.
SINGE_NODISCARD SingeResult frame_take_gas(SingeSim *sim, Frame *frame, SingeError *error);

/// Reads the surface of a frame, without its gas. Free it, after failure too.
SINGE_NODISCARD SingeResult frame_read_surface(const Folder *folder, int number, Frame *frame, SingeError *error);

/// Reads the files of a frame. Free it, after failure too.
SINGE_NODISCARD SingeResult frame_read(const Folder *folder, int number, Frame *frame, SingeError *error);

/// Draws the frame. The pixels are valid until the next call.
SINGE_NODISCARD SingeResult frame_draw(const Frame *frame, Pictures *pictures, const uint8_t **rgb, SingeError *error);

/// Writes the last picture as a PNG and, if `exr` is not NULL, its layers.
SINGE_NODISCARD SingeResult frame_write_picture(Pictures *pictures, const uint8_t *rgb, const char *png,
                                                const char *exr, SingeError *error);

typedef struct ContactSheet {
    int columns, rows;
    int frame_width, frame_height; ///< of the source frames
    int shrink;                    ///< frames are averaged over shrink × shrink pixels
    int width, height;
    uint8_t *rgb;
} ContactSheet;

/// At most about 1920 pixels wide.
SINGE_NODISCARD SingeResult contact_sheet_make(ContactSheet *sheet, int columns, int rows, int frame_width,
                                               int frame_height, SingeError *error);
void contact_sheet_put(ContactSheet *sheet, int tile, const uint8_t *rgb);
void contact_sheet_free(ContactSheet *sheet);

/// The frame of [first, last] that a tile shows: spread evenly, both ends included.
int contact_sheet_frame(int tile, int tiles, int first, int last);

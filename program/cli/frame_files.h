// A frame of a simulation, or one read from its files: run writes it, check tests it and render draws it.
#ifndef CLI_FRAME_FILES_H
#define CLI_FRAME_FILES_H

#include "cli/folder.h"
#include "cli/pictures.h"
#include "formats/formats.h"
#include "singe/singe.h"

typedef struct Frame {
    SingeSurface surface;
    Gas gas; ///< as in its file; empty if there is none
    double time;
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

#endif

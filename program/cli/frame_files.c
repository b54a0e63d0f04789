#include "cli/frame_files.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

void frame_free(Frame *frame) {
    singe_surface_free(&frame->surface);
    gas_free(&frame->gas);
    *frame = (Frame){0};
}

SingeResult frame_take_surface(SingeSim *sim, Frame *frame, SingeError *error) {
    SingeResult result = singe_sim_surface(sim, &frame->surface);
    if (result) *error = *singe_sim_error(sim);
    frame->time = singe_sim_stats(sim).time;
    return result;
}

SingeResult frame_take_gas(SingeSim *sim, Frame *frame, SingeError *error) {
    SingeGas gas = singe_sim_gas(sim);
    gas_free(&frame->gas);
    return gas.size[0] > 0 ? gas_copy(&gas, (SingeAllocator){0}, &frame->gas, error) : SINGE_OK;
}

/// Empty if the cache has no file of it.
static SingeResult read_gas(const Folder *folder, int number, Gas *gas, SingeError *error) {
    Bytes bytes = {0};
    SingeResult result = SINGE_OK;
    char *path = folder_vdb(folder, number);
    if (access(path, F_OK) == 0 || errno != ENOENT) {
        result = file_read(path, (SingeAllocator){0}, &bytes, error);
        if (!result) result = vdb_read_gas(path, bytes.data, bytes.size, (SingeAllocator){0}, gas, NULL, error);
        bytes_free(&bytes);
    }
    free(path);
    return result;
}

SingeResult frame_read_surface(const Folder *folder, int number, Frame *frame, SingeError *error) {
    Bytes bytes = {0};
    *frame = (Frame){0};
    char *path = folder_ply(folder, number);
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, error);
    if (!result)
        result =
            ply_read_surface(path, bytes.data, bytes.size, (SingeAllocator){0}, &frame->surface, &frame->time, error);
    bytes_free(&bytes);
    free(path);
    return result;
}

SingeResult frame_read(const Folder *folder, int number, Frame *frame, SingeError *error) {
    SingeResult result = frame_read_surface(folder, number, frame, error);
    return result ? result : read_gas(folder, number, &frame->gas, error);
}

SingeResult frame_draw(const Frame *frame, Pictures *pictures, const uint8_t **rgb, SingeError *error) {
    *rgb = pictures_draw(pictures, &frame->surface, &frame->gas.view, frame->time, error);
    if (*rgb) return SINGE_OK;
    return error->code ? error->code : SINGE_ERROR_STATE;
}

SingeResult frame_write_picture(Pictures *pictures, const uint8_t *rgb, const char *png, const char *exr,
                                SingeError *error) {
    int width, height;
    pictures_size(pictures, &width, &height);
    SingeResult result = png_write(png, width, height, rgb, error);
    return result || !exr ? result : pictures_write_layers(pictures, exr, error);
}

// Smoke and flame are the preview's, at the centres of the fine cells. The velocity is interpolated between the centres
// of the coarse cells. The temperature is that of a black body as bright as the flame: renderers whose blackbody
// emission goes with its fourth power show the same tongues, in a flame's colours.
#include "cli/gas_detail.h"

#include <stdlib.h>

#include "cli/frame_files.h"
#include "cli/pictures.h"
#include "cli/text.h"
#include "formats/gas_grid.h"

#define BRIGHTEST 2500.0f ///< K, where `flame` is 1: gives other renderers' pictures the colours of ours

/// The coarse cells on either side of a fine cell's centre along an axis, and the weight between them.
static uint32_t neighbours(uint32_t fine, int detail, uint32_t size, uint32_t pair[2], float *share) {
    const float at = ((float)fine + 0.5f) / (float)detail - 0.5f, low = at > 0 ? at : 0;
    pair[0] = (uint32_t)low < size - 1 ? (uint32_t)low : size - 1;
    pair[1] = pair[0] + 1 < size ? pair[0] + 1 : pair[0];
    *share = low - (float)pair[0];
    return pair[0];
}

static void interpolate(const SingeGas *coarse, int detail, Gas *fine) {
    const uint32_t *n = fine->view.size;
    uint32_t x[2], y[2], z[2];
    float s[3];
    size_t i = 0;
    for (uint32_t c = 0; c < n[2]; c++)
        for (uint32_t b = 0; b < n[1]; b++)
            for (uint32_t a = 0; a < n[0]; a++, i++) {
                neighbours(a, detail, coarse->size[0], x, &s[0]);
                neighbours(b, detail, coarse->size[1], y, &s[1]);
                neighbours(c, detail, coarse->size[2], z, &s[2]);
                float moved[3] = {0, 0, 0};
                for (int k = 0; k < 8; k++) {
                    const size_t from = gas_index(coarse, x[k & 1], y[k >> 1 & 1], z[k >> 2]);
                    const float weight =
                        (k & 1 ? s[0] : 1 - s[0]) * (k >> 1 & 1 ? s[1] : 1 - s[1]) * (k >> 2 ? s[2] : 1 - s[2]);
                    for (int d = 0; d < 3; d++) moved[d] += weight * coarse->velocity[from][d];
                }
                for (int d = 0; d < 3; d++) fine->velocity[i][d] = moved[d];
            }
}

static void glow(Gas *fine) {
    const size_t count = gas_cells(&fine->view);
    for (size_t i = 0; i < count; i++)
        fine->temperature[i] = fine->flame_share[i] > 0 ? BRIGHTEST * sqrtf(sqrtf(fine->flame_share[i])) : 0;
}

/// Removes smoke that is practically clear air: half a metre of it hides a quarter of a percent. This empties most warm
/// blocks.
static void clear_air(Gas *fine) {
    const size_t count = gas_cells(&fine->view);
    for (size_t i = 0; i < count; i++) {
        if (fine->extinction[i] >= 0.005f || fine->flame_share[i] >= 1e-4f) continue;
        fine->extinction[i] = fine->flame_share[i] = fine->temperature[i] = 0;
    }
}

SingeResult gas_detail_write_frame(const char *path, const Frame *frame, Pictures *pictures, int number, int detail,
                                   SingeError *error) {
    Gas fine = {0};
    const SingeGas *coarse = &frame->gas.view;
    SingeResult result = SINGE_OK;
    if (!coarse->size[0]) result = folder_fail(path, "write, for the frame has no gas", 0, error);
    fine.view = *coarse;
    fine.view.cell = coarse->cell / (float)detail;
    for (int c = 0; c < 3; c++) fine.view.size[c] *= (uint32_t)detail;
    if (!result && !gas_shape_is_good(&fine.view)) {
        *error = (SingeError){.code = SINGE_ERROR_LIMIT, .stage = "gas", .element = number};
        snprintf(error->message, sizeof error->message, "a gas of %u x %u x %u cells is too fine: at most %d cells",
                 fine.view.size[0], fine.view.size[1], fine.view.size[2], GAS_CELL_LIMIT);
        result = SINGE_ERROR_LIMIT;
    }
    if (result) fine = (Gas){0};
    else result = gas_make(&fine, path, 0, error);
    if (!result)
        result = pictures_bake(pictures, &frame->surface, coarse, frame->time, detail, fine.extinction,
                               fine.flame_share, error);
    if (!result) {
        interpolate(coarse, detail, &fine);
        glow(&fine);
        clear_air(&fine);
        gas_decode(&fine);
        result = vdb_write_fine(path, &fine, frame->time, error);
    }
    gas_free(&fine);
    return result;
}

SingeResult gas_detail_convert(const Folder *folder, Pictures *pictures, int number, int detail, SingeError *error) {
    Frame frame = {0};
    char *path = folder_gas_detail(folder, number);
    SingeResult result = frame_read(folder, number, &frame, error);
    if (!result) result = gas_detail_write_frame(path, &frame, pictures, number, detail, error);
    frame_free(&frame);
    free(path);
    return result;
}

SingeResult gas_detail_write(const Job *job, const Folder *folder, int last, OutputsProgress *progress, void *context,
                             SingeError *error) {
    Pictures *pictures = NULL;
    SingeResult result = pictures_open_baker(job, &pictures, error);
    for (int frame = 1; frame <= last && !result; frame++) {
        if (progress(context, frame)) {
            result = gas_detail_convert(folder, pictures, frame, job->scene->gas_detail, error);
            continue;
        }
        *error = (SingeError){.code = SINGE_ERROR_STATE, .stage = "gas", .element = -1, .message = "interrupted"};
        result = SINGE_ERROR_STATE;
    }
    pictures_close(pictures);
    return result;
}

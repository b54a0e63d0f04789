// The formats that a run or a conversion writes besides pictures and gas: frames, and the roots that refer to them; and
// the gas on finer cells, with the tongues of the flames.
#pragma once

#include "cli/folder.h"
#include "cli/job.h"
#include "cli/pictures.h"

typedef struct Outputs {
    const Job *job;
    const Folder *folder;
    OutputSet formats;
    OutputScene scene; ///< of frames
    OutputSheet *sheets;
    char **pictures; ///< [sheet_count] paths from the folder, or NULL
} Outputs;

/// The job and the folder must outlive it, and the folder must exist. `gas`: the frames have gas.
SINGE_NODISCARD SingeResult outputs_open(Outputs *outputs, const Job *job, const Folder *folder, OutputSet formats,
                                         bool gas, SingeError *error);
void outputs_close(Outputs *outputs);

/// Writes a frame in a format.
SINGE_NODISCARD SingeResult outputs_write(const Outputs *outputs, int format, const char *path, const Frame *frame,
                                          int number, SingeError *error);

/// The formats in which a frame is missing.
OutputSet outputs_missing(const Outputs *outputs, int number);

/// Writes a frame of the cache in those formats.
SINGE_NODISCARD SingeResult outputs_convert(const Outputs *outputs, int number, OutputSet formats, SingeError *error);

/// Writes the roots of all its formats, for frames from 1.
SINGE_NODISCARD SingeResult outputs_write_roots(const Outputs *outputs, int frames, SingeError *error);

/// Called before each frame is read; false ends it with an error.
typedef bool OutputsProgress(void *context, int frame);
/// Writes one of output_singles from the frames of the cache, from 1.
SINGE_NODISCARD SingeResult outputs_write_single(const Outputs *outputs, int single, int frames,
                                                 OutputsProgress *progress, void *context, SingeError *error);

/// The gas on cells `detail` times as fine, without values. SINGE_ERROR_LIMIT if a file cannot hold so many.
SINGE_NODISCARD SingeResult gas_detail_shape(const SingeGas *coarse, int detail, SingeGas *fine, SingeError *error);

/// Writes a frame that has gas, on cells `detail` times as fine.
SINGE_NODISCARD SingeResult gas_detail_write_frame(const char *path, const Frame *frame, Pictures *pictures, int detail,
                                                   SingeError *error);

/// The same from the cache.
SINGE_NODISCARD SingeResult gas_detail_convert(const Folder *folder, Pictures *pictures, int number, int detail,
                                               SingeError *error);

/// The same for frames 1 to `last`, in the existing folder. SINGE_ERROR_STATE if the progress callback returns false.
SINGE_NODISCARD SingeResult gas_detail_write(const Job *job, const Folder *folder, int last, OutputsProgress *progress,
                                             void *context, SingeError *error);

// The gas of a cache on finer cells, with the tongues of the flames: DIR/gas_detail/NAME.0001.vdb, ...
#ifndef CLI_GAS_DETAIL_H
#define CLI_GAS_DETAIL_H

#include "cli/folder.h"
#include "cli/frame_files.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/pictures.h"

/// Writes a frame that has gas, on cells `detail` times as fine.
SINGE_NODISCARD SingeResult gas_detail_write_frame(const char *path, const Frame *frame, Pictures *pictures, int number,
                                                   int detail, SingeError *error);

/// The same from the cache.
SINGE_NODISCARD SingeResult gas_detail_convert(const Folder *folder, Pictures *pictures, int number, int detail,
                                               SingeError *error);

/// The same for frames 1 to `last`, in the existing folder. SINGE_ERROR_STATE in a program built without the preview,
/// and if the progress callback returns false.
SINGE_NODISCARD SingeResult gas_detail_write(const Job *job, const Folder *folder, int last, OutputsProgress *progress,
                                             void *context, SingeError *error);

#endif

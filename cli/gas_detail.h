// The gas of a cache on finer cells, with the flames' tongues in it: DIR/gas_detail/NAME.0001.vdb, ...
#ifndef CLI_GAS_DETAIL_H
#define CLI_GAS_DETAIL_H

#include "cli/folder.h"
#include "cli/job.h"
#include "cli/outputs.h"

/// Path of the folder, from malloc.
char *gas_detail_folder(const Folder *folder);

/// Writes frames 1 to `last`, which have gas. SINGE_ERROR_STATE in a program built without the preview, and where
/// progress says no.
SINGE_NODISCARD SingeResult gas_detail_write(const Job *job, const Folder *folder, int last, OutputsProgress *progress,
                                             void *context, SingeError *error);

#endif

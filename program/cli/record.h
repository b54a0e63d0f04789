// DIR/run.json: the scene, the program, the time taken and the outcome of a run.
#ifndef CLI_RECORD_H
#define CLI_RECORD_H

#include "cli/folder.h"
#include "cli/job.h"
#include "cli/totals.h"

typedef struct Record {
    const char *scene_path;
    char started[32];   ///< ISO 8601, UTC
    const char *result; ///< "running", "complete", "interrupted" or "failed"
    SingeError error;   ///< when failed
    int frames_done;
    int resumed_from; ///< frame of the checkpoint from which the last start resumed, 0 for none
    bool preview, video;
    SingeCounts counts;
    float thickening;
    uint32_t triangles, fine_triangles; ///< of the last surface
    Totals totals;
} Record;

Record record_make(const char *scene_path);

/// Writes the file whole, or leaves the existing one. `path` is the folder's record, or a draft of it.
SINGE_NODISCARD SingeResult record_write(const Record *record, const char *path, const Job *job, SingeError *error);

#endif

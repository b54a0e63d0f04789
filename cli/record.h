// DIR/run.json: what was run, with which program, how long it took and how it ended.
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
    int resumed_from; ///< frame of the checkpoint that the last start went on from, 0 for none
    bool preview, video;
    SingeCounts counts;
    float thickening;
    uint32_t triangles, fine_triangles; ///< of the last frame drawn
    Totals totals;
} Record;

Record record_make(const char *scene_path);

/// Writes the file whole or leaves the one that was there. `path` is the folder's, or a draft of it.
SINGE_NODISCARD SingeResult record_write(const Record *record, const char *path, const Job *job, SingeError *error);

#endif

// Internals of singe run: a run in progress, and its parts. run.c is the command, run_begin.c begins or resumes a run,
// run_branch.c continues from another, run_frame.c steps to a frame and writes it, record.c writes DIR/run.json.
#pragma once

#include <pthread.h>

#include "cli/checkpoint.h"
#include "cli/folder.h"
#include "cli/job.h"
#include "cli/lock.h"
#include "cli/outputs.h"
#include "cli/pictures.h"
#include "cli/recording.h"
#include "cli/tables.h"

/// DIR/run.json: the scene, the program, the time taken and the outcome of a run.
typedef struct Record {
    const char *scene_path;
    char started[32];   ///< ISO 8601, UTC
    const char *result; ///< "running", "complete", "interrupted" or "failed"
    SingeError error;   ///< when failed
    int frames_done;
    int resumed_from; ///< frame of the checkpoint from which the last start resumed, 0 for none
    char *from;       ///< JSON: the run that this is a branch of, from malloc; NULL for none
    bool preview, video;
    SingeCounts counts;
    float thickening;
    uint32_t triangles, fine_triangles; ///< of the last surface
    Totals totals;
} Record;

Record record_make(const char *scene_path);

/// Writes the file whole, or leaves the existing one. `path` is the folder's record, or a draft of it.
SINGE_NODISCARD SingeResult record_write(const Record *record, const char *path, const Job *job, SingeError *error);

typedef struct RunOptions {
    const char *scene, *output;
    const char *from;   ///< "DIR:FRAME", the frame of which it is a branch; NULL: none
    const char *record; ///< file of the recording; NULL: none
    SetList sets;
    int threads, frames; ///< frames 0: the scene's
    bool resume, force, no_preview, exr, quiet;
} RunOptions;

/// A file of the current frame.
typedef struct FrameFile {
    char *path;
    char *draft; ///< the temporary file until it is published; NULL: written directly
} FrameFile;
enum { FRAME_FILES_MAX = 4 + OUTPUT_COUNT };

/// A frame that a thread of its own writes and draws while the simulation steps on to the next.
typedef struct FrameWriting {
    int frame; ///< 0: none
    bool threaded;
    pthread_t thread;
    // as they were at the frame
    SingeStats stats;
    Totals totals;
    FrameCost cost;
    CheckpointBytes checkpoint;
    // of the thread
    double output_seconds[TOTAL_OUTPUT_COUNT];
    SingeResult result;
    SingeError error;
} FrameWriting;

/// The run that this one continues from.
typedef struct Branch {
    int frame; ///< 0: this is no branch
    Job job;   ///< its scene at that frame
    Folder folder;
    int first;  ///< frame from which that scene holds
    bool alike; ///< its pictures are those of this run
} Branch;

/// A run in progress.
typedef struct Run {
    Console *console;
    Job job;
    Folder folder;
    Lock cache_lock, pictures_lock;
    SingeSim *sim;
    Pictures *pictures; ///< NULL without a preview
    Pictures *baker;    ///< of finer gas: `pictures`, or its own without a preview; NULL where none is asked for
    bool layers;        ///< also written as EXR
    Frame frame;
    Outputs outputs;
    FrameFile files[FRAME_FILES_MAX];
    int file_count;
    FrameWriting writing;
    Tables tables;
    Recording recording;
    Record record;
    Totals *totals;     ///< the record's
    SingeTimers timers; ///< as last read
    SceneHash hash;
    Branch branch;
    int keep_every;              ///< frames from one kept checkpoint to the next; 0: none are kept
    double started, wall_before; ///< s, clock at the start and time spent before a resumption
    double checkpoint_time, checkpoint_cost;
    double frame_ended, frame_seconds; ///< s, clock at the end of the last frame, and the time of a frame
    int first;                         ///< frame to begin with
    int step;                          ///< steps done towards the next frame
    int strained;                      ///< the frame with the largest strain_p99 above the limit; 0: none
    double strain;                     ///< strain_p99 in that frame
    uint64_t halts;                    ///< totals->contact_halts at the last frame
    bool halted;                       ///< contact's bound has been reported
    bool converted;                    ///< the frames so far have all their formats: roots may name them
    bool begun;                        ///< the folder belongs to this run: its first frame is whole, or it has resumed
} Run;

/// The outputs of the run besides the surface.
FolderParts run_parts(const Run *run);

/// Reads, builds and locks everything that the run needs, and with --resume loads its checkpoint. Of an earlier run
/// only half-written files have been removed.
ExitCode run_prepare(Run *run, const RunOptions *options);

/// Makes the simulation of a branch: that of the earlier run at the frame, with what has changed since. Writes nothing.
ExitCode branch_prepare(Run *run, const char *from);

/// Fills the folder, which has no frames, with those up to the branch, and writes its first checkpoint.
SINGE_NODISCARD SingeResult branch_fill(Run *run, SingeError *error);

void branch_close(Branch *branch);

/// The member "from" of a folder's run.json, from malloc; NULL if there is none.
char *branch_lineage(const Folder *folder);

/// Counts the steps since the last frame, as at a frame that is not written.
SINGE_NODISCARD SingeResult run_pass_frame(Run *run, int frame, SingeError *error);

/// Keeps the last checkpoint, which is of that frame, if the scene asks for it, and drops those that no longer fit.
SINGE_NODISCARD SingeResult run_keep_checkpoint(Run *run, int frame, SingeError *error);

/// Replaces an earlier run's files by the first frame of a new run, which has been written whole.
SINGE_NODISCARD SingeResult run_take_over(Run *run, SingeError *error);

/// Draws missing pictures of earlier frames. *whole is false if Ctrl-C interrupted it.
SINGE_NODISCARD SingeResult run_draw_missing(Run *run, bool *whole, SingeError *error);

/// Writes earlier frames in the formats in which they are missing, and their finer gas, from the cache, and then
/// the roots, which name them. run->converted is false if Ctrl-C interrupted it.
SINGE_NODISCARD SingeResult run_convert_missing(Run *run, SingeError *error);

/// Steps to the next frame, or by at least one step if the run is asked to stop; run->step says how far.
SINGE_NODISCARD SingeResult run_advance(Run *run, int frame, SingeError *error);

/// Takes the current frame of the simulation and begins to write its files; also a snapshot if a checkpoint is due, as
/// after the last frame. The first frame of a run is written at once.
SINGE_NODISCARD SingeResult run_begin_frame(Run *run, int frame, bool last, SingeError *error);

/// Waits until the files of the frame being written are complete, then writes its line and its checkpoint. Does nothing
/// if no frame is being written. `stats` are the frame's.
SINGE_NODISCARD SingeResult run_end_frame(Run *run, SingeStats *stats, SingeError *error);

/// Writes a checkpoint of the current state. No frame may be in writing.
SINGE_NODISCARD SingeResult run_write_checkpoint(Run *run, Progress progress, SingeError *error);

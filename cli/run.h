// singe run, inside: a run in progress, and its parts. run.c is the command, run_begin.c how a run begins and goes on,
// run_frame.c what a frame is and leaves.
#ifndef CLI_RUN_H
#define CLI_RUN_H

#include <pthread.h>

#include "cli/checkpoint.h"
#include "cli/folder.h"
#include "cli/frame_files.h"
#include "cli/gas_detail.h"
#include "cli/job.h"
#include "cli/lock.h"
#include "cli/outputs.h"
#include "cli/pictures.h"
#include "cli/record.h"
#include "cli/stats_file.h"
#include "cli/tables.h"

typedef struct RunOptions {
    const char *scene, *output;
    SetList sets;
    int threads;
    bool resume, no_preview, exr, quiet;
} RunOptions;

/// A file of the frame in hand.
typedef struct FrameFile {
    char *path;
    char *draft; ///< where it is written until it is published; NULL: at once
} FrameFile;
enum { FRAME_FILES_MAX = 4 + OUTPUT_COUNT };

/// A frame whose files are being written and whose picture is being drawn, in a thread of its own, while the simulation
/// steps on to the next.
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

/// A run in progress.
typedef struct Run {
    Console *console;
    Job job;
    Folder folder;
    Lock cache_lock, pictures_lock;
    SingeSim *sim;
    Pictures *pictures; ///< NULL without a preview
    Pictures *baker;    ///< of finer gas: `pictures`, or its own without a preview; NULL where none is asked for
    bool layers;        ///< written as EXR, too
    Frame frame;
    Outputs outputs;
    FrameFile files[FRAME_FILES_MAX];
    int file_count;
    FrameWriting writing;
    LineFile stats;
    Tables tables;
    Record record;
    Totals *totals;     ///< the record's
    SingeTimers timers; ///< as last read
    SceneHash hash;
    double started, wall_before; ///< s, clock at the start and time spent before a resumption
    double checkpoint_time, checkpoint_cost;
    double frame_ended, frame_seconds; ///< s, clock at the end of the last frame, and what one takes
    int first;                         ///< frame to begin with
    int step;                          ///< steps that are done of the frame in hand
    int strained;                      ///< the frame in which most is stretched by more than half; 0
    double strain;                     ///< of one edge in a hundred there (strain_p99)
    bool begun;                        ///< what is in the folder is this run's: its first frame stands, or it goes on
} Run;

/// What the run writes besides the surface.
FolderParts run_parts(const Run *run);

/// Reads, builds and locks all that the run needs, and with --resume goes back to its checkpoint. Nothing of an earlier
/// run has been touched but for half-written files.
ExitCode run_prepare(Run *run, const RunOptions *options);

/// Puts the first frame of a run from the start, which is written whole, over an earlier run's files.
SINGE_NODISCARD SingeResult run_take_over(Run *run, SingeError *error);

/// Draws pictures that frames of before lack. False in *whole when Ctrl-C came in between.
SINGE_NODISCARD SingeResult run_draw_missing(Run *run, bool *whole, SingeError *error);

/// Writes the frames of before in formats that they are not there in, and their finer gas, as the cache has them. False
/// in *whole as above.
SINGE_NODISCARD SingeResult run_convert_missing(Run *run, bool *whole, SingeError *error);

/// Steps on to the next frame, or, when the run is asked to stop, by at least one step: run->step tells.
SINGE_NODISCARD SingeResult run_advance(Run *run, int frame, SingeError *error);

/// Takes the frame that the simulation is at, and a snapshot when a checkpoint is due, as after the last frame, and
/// begins to write its files. The first frame of a run is written at once.
SINGE_NODISCARD SingeResult run_begin_frame(Run *run, int frame, bool last, SingeError *error);

/// Waits until the files of the frame in writing are there; then its line and its checkpoint follow. Nothing where none
/// is in writing. `stats` are the frame's.
SINGE_NODISCARD SingeResult run_end_frame(Run *run, SingeStats *stats, SingeError *error);

/// Writes a checkpoint of now. No frame is in writing.
SINGE_NODISCARD SingeResult run_write_checkpoint(Run *run, Progress progress, SingeError *error);

#endif

// A frame of a run. Its order is PLY, other formats, VDB, PNG, line of stats.csv, roots and checkpoint: whatever a
// checkpoint stands for is on the disk. The first one of a run from the start is written under temporary names, so that
// an earlier run stays until it is whole.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "analysis/initial.h"
#include "cli/interrupt.h"
#include "cli/run.h"

/// What takes less than this part of the run's time: a checkpoint is due when ten times its cost has passed.
static const double checkpoint_share = 0.1;
static const double checkpoint_every = 5; ///< s, however expensive it is

// ---- steps

static void count_events(Run *run) {
    size_t count;
    const SingeEvent *events = singe_sim_events(run->sim, &count);
    for (size_t i = 0; i < count; i++) {
        if (events[i].kind == SINGE_EVENT_IGNITED) run->totals->ignited++;
        else if (events[i].kind == SINGE_EVENT_HOLE_OPENED) run->totals->holes_opened++;
        else if (events[i].kind == SINGE_EVENT_PIECE_FREED) run->totals->pieces_freed++;
    }
}

/// Adds what the stages did since the last reading to the totals, and gives the frame's share.
static void read_timers(Run *run, FrameCost *cost) {
    SingeTimers now = singe_sim_timers(run->sim), *before = &run->timers;
    for (int i = 0; i < SINGE_STAGE_COUNT; i++) {
        double seconds = now.seconds[i] - before->seconds[i];
        cost->stage[i] = 1e3 * seconds;
        run->totals->stage_seconds[i] += seconds;
    }
    run->totals->steps += now.steps - before->steps;
    run->totals->heat_iterations += now.heat_iterations - before->heat_iterations;
    run->totals->strands_projected += now.strands_projected - before->strands_projected;
    run->totals->contacts += now.contacts - before->contacts;
    *before = now;
}

SingeResult run_advance(Run *run, SingeError *error) {
    while (run->step < run->job.scene->steps) {
        SingeResult result = singe_sim_step(run->sim);
        if (result) {
            *error = *singe_sim_error(run->sim);
            return result;
        }
        count_events(run);
        run->step++;
        if (interrupt_asked()) break;
    }
    return SINGE_OK;
}

/// Adds the time since *clock to one of the totals and moves the clock on.
static void charge(Run *run, int total, double *clock) {
    double now = console_clock();
    run->totals->output_seconds[total] += now - *clock;
    *clock = now;
}

// ---- files

/// Where to write a file of the frame; `path` is freed with the others.
static SingeResult file_begin(Run *run, char *path, const char **name, SingeError *error) {
    FrameFile *file = &run->files[run->file_count++];
    *file = (FrameFile){.path = path};
    *name = path;
    if (run->begun) return SINGE_OK;
    SingeResult result = file_draft(path, &file->draft, error);
    if (result) return result;
    interrupt_own(file->draft);
    *name = file->draft;
    return SINGE_OK;
}

/// Drafts that have not taken their places go.
static void files_end(Run *run) {
    for (int i = 0; i < run->file_count; i++) {
        interrupt_disown(run->files[i].draft);
        file_discard(run->files[i].draft);
        free(run->files[i].path);
    }
    run->file_count = 0;
}

/// The frame in all formats, the cache first.
static SingeResult write_surface(Run *run, int frame, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int i = 0; i < OUTPUT_COUNT && !result; i++) {
        const char *name;
        if (!output_has(run->outputs.formats, i)) continue;
        result = file_begin(run, folder_output(&run->folder, i, frame), &name, error);
        if (!result) result = outputs_write(&run->outputs, i, name, &run->frame, frame, error);
    }
    return result;
}

static SingeResult write_gas(Run *run, int frame, SingeError *error) {
    const char *name;
    SingeResult result = frame_take_gas(run->sim, &run->frame, error);
    if (result || !run_parts(run).gas) return result;
    result = file_begin(run, folder_vdb(&run->folder, frame), &name, error);
    return result ? result : vdb_write_gas(name, &run->frame.gas, run->frame.time, error);
}

static SingeResult write_picture(Run *run, int frame, SingeError *error) {
    const uint8_t *rgb;
    const char *png, *exr = NULL;
    if (!run->pictures) return SINGE_OK;
    SingeResult result = frame_draw(&run->frame, run->pictures, &rgb, error);
    if (!result) result = file_begin(run, folder_png(&run->folder, frame), &png, error);
    if (!result && run->layers) result = file_begin(run, folder_exr(&run->folder, frame), &exr, error);
    return result ? result : frame_write_picture(run->pictures, rgb, png, exr, error);
}

static SingeResult write_files(Run *run, int frame, FrameCost *cost, SingeError *error) {
    double begun = console_clock(), clock = begun;
    SingeResult result = frame_take_surface(run->sim, &run->frame, error);
    cost->surface = 1e3 * (console_clock() - begun);
    charge(run, TOTAL_SURFACE, &clock);
    if (!result) result = write_surface(run, frame, error);
    if (!result) result = write_gas(run, frame, error);
    charge(run, TOTAL_PLY, &clock);
    if (!result) result = write_picture(run, frame, error);
    charge(run, TOTAL_PREVIEW, &clock);
    cost->output = 1e3 * (clock - begun);
    cost->triangles = run->record.triangles = run->frame.surface.triangle_count;
    cost->fine_triangles = run->record.fine_triangles = run->frame.surface.fine_triangle_count;
    return result;
}

/// Tells of what crosses in the first frame: it has no side to be kept on.
static SingeResult tell_of_crossings(Run *run, SingeError *error) {
    float at[3];
    if (!initial_count(&run->frame.surface, &run->totals->crossed, at)) {
        *error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1, .message = "no memory to look for crossings"};
        return SINGE_ERROR_MEMORY;
    }
    if (run->totals->crossed)
        console_warn(run->console,
                     "%" PRIu64 " pairs of triangles cross initially, the first near (%.4g, %.4g, %.4g) m; `singe "
                 "verify` counts them separately", run->totals->crossed, (double)at[0], (double)at[1], (double)at[2]);
    return SINGE_OK;
}

SingeResult run_write_frame(Run *run, int frame, SingeStats *stats, SingeError *error) {
    FrameCost cost;
    read_timers(run, &cost);
    SingeResult result = write_files(run, frame, &cost, error);
    *stats = singe_sim_stats(run->sim);
    run->totals->hottest = fmax(run->totals->hottest, (double)stats->temperature_max);
    if (!result && frame == 1) result = tell_of_crossings(run, error);
    if (!result && !run->begun) result = run_take_over(run, error);
    files_end(run);
    if (!result) result = stats_write(&run->stats, frame, stats, run->totals, &cost, error);
    if (!result) run->record.frames_done = frame, run->step = 0;
    return result;
}

SingeResult run_write_checkpoint(Run *run, Progress progress, bool must, SingeError *error) {
    FrameCost cost; // of steps without a frame as yet
    double begun = console_clock(), clock = begun, since = begun - run->checkpoint_time;
    if (!must && since < run->checkpoint_cost * (1 / checkpoint_share - 1) && since < checkpoint_every) return SINGE_OK;
    read_timers(run, &cost);
    run->totals->wall_seconds = run->wall_before + begun - run->started;
    SingeResult result = stats_sync(&run->stats, error);
    if (!result) result = outputs_write_roots(&run->outputs, progress.frame, error);
    if (!result)
        result = checkpoint_write(&run->folder, run->sim, run->job.hooks.allocator, progress, run->hash, run->totals,
                                  error);
    charge(run, TOTAL_CHECKPOINT, &clock);
    run->checkpoint_time = clock;
    run->checkpoint_cost = clock - begun;
    return result;
}

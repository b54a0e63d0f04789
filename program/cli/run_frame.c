// A frame of a run. Its files are written in this order: PLY, other formats, VDB, PNG, lines of the tables, roots,
// checkpoint. Everything before a checkpoint is then on the disk. The first frame of a run from the start is written
// under temporary names, so that an earlier run remains until it is whole.
//
// The other frames are written and drawn by a thread of their own while the simulation steps on: from a copy of the
// surface and the gas, with the numbers and the snapshot taken at the frame. A frame is whole before the next one is
// taken, so at most one is being written. With one thread everything is done in turn.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/crossings.h"
#include "cli/interrupt.h"
#include "cli/run.h"

/// Max share of the run's time that checkpoints take: the next is due when a hundred times the cost of the last has passed.
static const double checkpoint_share = 0.01;
static const double checkpoint_every = 5; ///< s, however expensive it is

// ---- steps

/// Adds the stages' work since the last reading to the totals, and returns the frame's share.
static void read_timers(Run *run, FrameCost *cost) {
    SingeTimers now = singe_sim_timers(run->sim), *before = &run->timers;
    for (int i = 0; i < SINGE_STAGE_COUNT; i++) {
        double seconds = now.seconds[i] - before->seconds[i];
        cost->stage[i] = 1e3 * seconds;
        run->totals->stage_seconds[i] += seconds;
    }

    cost->contact = 1e3 * (now.contact_seconds - before->contact_seconds);
    run->totals->steps += now.steps - before->steps;
    run->totals->heat_iterations += now.heat_iterations - before->heat_iterations;
    run->totals->strands_projected += now.strands_projected - before->strands_projected;
    run->totals->contacts += now.contacts - before->contacts;
    run->totals->contact_halts += now.contact_halts - before->contact_halts;
    *before = now;
}

/// Counts the pairs of triangles of the first frame that cross.
static SingeResult count_crossings(Run *run, SingeError *error) {
    float at[3];
    if (!crossings_count(&run->frame.surface, &run->totals->crossed, at)) {
        *error = (SingeError){
            .code = SINGE_ERROR_MEMORY, .element = -1, .message = "out of memory while looking for crossings"};
        return SINGE_ERROR_MEMORY;
    }

    if (run->totals->crossed)
        console_warn(run->console,
                     "%" PRIu64 " pairs of triangles cross initially, the first near (%.4g, %.4g, %.4g) m; `singe "
                     "verify` counts them separately",
                     run->totals->crossed, (double)at[0], (double)at[1], (double)at[2]);
    return SINGE_OK;
}

SingeResult run_pass_frame(Run *run, int frame, SingeError *error) {
    FrameCost cost;
    run->step = 0;
    read_timers(run, &cost);
    run->totals->hottest = fmax(run->totals->hottest, (double)singe_sim_stats(run->sim).temperature_max);
    if (frame > 1) return SINGE_OK;
    SingeResult result = frame_take_surface(run->sim, &run->frame, error);
    return result ? result : count_crossings(run, error);
}

SingeResult run_advance(Run *run, int frame, SingeError *error) {
    if (run->step == 0) {
        SingeResult result = scene_follow(run->job.scene, &run->job.assets, run->sim, frame - 1, error);
        if (result) return result;
    }

    while (run->step < run->job.scene->steps) {
        SingeResult result = scene_begin_step(run->job.scene, run->sim, frame - 1, run->step, error);
        if (result) return result;

        result = singe_sim_step(run->sim);
        if (result) {
            *error = *singe_sim_error(run->sim);
            return result;
        }

        size_t count;
        const SingeEvent *events = singe_sim_events(run->sim, &count);
        for (size_t i = 0; i < count; i++) {
            run->totals->ignited += events[i].kind == SINGE_EVENT_IGNITED;
            run->totals->holes_opened += events[i].kind == SINGE_EVENT_HOLE_OPENED;
            run->totals->pieces_freed += events[i].kind == SINGE_EVENT_PIECE_FREED;
        }

        if ((result = tables_take_step(&run->tables, run->sim, error))) return result;
        run->step++;
        if (interrupt_asked()) break;
    }

    return SINGE_OK;
}

/// Advances the clock to the current time.
static double seconds_since(double *clock) {
    double now = console_clock(), seconds = now - *clock;
    *clock = now;
    return seconds;
}

// ---- files

/// The path to which a file of the frame is written; `path` is freed with the others.
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

/// Writes the frame's files, the cache first. Runs concurrently with the simulation, and uses neither it nor the totals.
static void *write_files(void *argument) {
    Run *run = argument;
    FrameWriting *writing = &run->writing;
    SingeError *error = &writing->error;
    const int frame = writing->frame;
    double begun = console_clock(), clock = begun, *seconds = writing->output_seconds;
    SingeResult result = SINGE_OK;
    const char *name = NULL, *exr = NULL;

    for (int i = 0; i < OUTPUT_COUNT && !result; i++) {
        if (!output_has(run->outputs.formats, i)) continue;
        result = file_begin(run, folder_output(&run->folder, i, frame), &name, error);
        if (!result) result = outputs_write(&run->outputs, i, name, &run->frame, frame, error);
    }

    const bool gas = run->frame.gas.view.size[0] > 0;
    if (!result && gas) result = file_begin(run, folder_vdb(&run->folder, frame), &name, error);
    if (!result && gas) result = vdb_write_gas(name, &run->frame.gas, run->frame.time, error);
    if (!result && gas && run->baker) {
        result = file_begin(run, folder_gas_detail(&run->folder, frame), &name, error);
        const int detail = run->job.scene->gas_detail;
        if (!result) result = gas_detail_write_frame(name, &run->frame, run->baker, detail, error);
    }

    seconds[TOTAL_PLY] += seconds_since(&clock);

    if (!result && run->pictures) {
        const uint8_t *rgb;
        result = frame_draw(&run->frame, run->pictures, &rgb, error);
        if (!result) result = file_begin(run, folder_png(&run->folder, frame), &name, error);
        if (!result && run->layers) result = file_begin(run, folder_exr(&run->folder, frame), &exr, error);
        if (!result) result = frame_write_picture(run->pictures, rgb, name, exr, error);
    }

    seconds[TOTAL_PREVIEW] += seconds_since(&clock);
    writing->cost.output += 1e3 * (clock - begun);
    writing->result = result;
    return NULL;
}

// ---- checkpoints

/// The time that this takes determines when the next one is due.
static SingeResult take_checkpoint(Run *run, CheckpointBytes *taken, SingeError *error) {
    double clock = console_clock();
    SingeResult result = checkpoint_take(run->sim, taken, error);
    run->checkpoint_cost = seconds_since(&clock);
    return result;
}

static SingeResult write_checkpoint(Run *run, CheckpointBytes *taken, Progress progress, Totals *totals,
                                    SingeError *error) {
    double clock = console_clock();
    totals->wall_seconds = run->wall_before + clock - run->started;
    memcpy(totals->output_seconds, run->totals->output_seconds, sizeof totals->output_seconds);

    SingeResult result = tables_sync(&run->tables, error);
    if (!result && run->converted) result = outputs_write_roots(&run->outputs, progress.frame, error);
    if (!result)
        result = checkpoint_write(&run->folder, run->sim, run->job.hooks.allocator, taken, progress, run->hash,
                                  &run->job.assets, totals, error);
    run->checkpoint_cost += seconds_since(&clock);
    run->checkpoint_time = clock;
    run->totals->output_seconds[TOTAL_CHECKPOINT] += run->checkpoint_cost;
    return result;
}

SingeResult run_write_checkpoint(Run *run, Progress progress, SingeError *error) {
    CheckpointBytes taken = {0};
    FrameCost cost; // of steps after the last frame
    read_timers(run, &cost);
    SingeResult result = take_checkpoint(run, &taken, error);
    if (!result) result = write_checkpoint(run, &taken, progress, run->totals, error);
    checkpoint_drop(run->sim, &taken);
    return result;
}

// ---- a frame

SingeResult run_begin_frame(Run *run, int frame, bool last, SingeError *error) {
    FrameWriting *writing = &run->writing;
    *writing = (FrameWriting){.frame = frame};
    FrameCost *cost = &writing->cost;
    run->step = 0;
    read_timers(run, cost);

    // copy what the files need
    double clock = console_clock();
    SingeResult result = frame_take_surface(run->sim, &run->frame, error);
    const double seconds = seconds_since(&clock);
    cost->surface = cost->output = 1e3 * seconds;

    run->totals->output_seconds[TOTAL_SURFACE] += seconds;
    cost->triangles = run->record.triangles = run->frame.surface.triangle_count;
    cost->fine_triangles = run->record.fine_triangles = run->frame.surface.fine_triangle_count;
    if (!result) result = frame_take_gas(run->sim, &run->frame, error);
    writing->stats = run->frame.stats;
    run->totals->hottest = fmax(run->totals->hottest, (double)writing->stats.temperature_max);
    if (!result) result = tables_take_frame(&run->tables, run->sim, frame, error);

    // contact cannot separate triangles that cross in the first frame
    if (!result && frame == 1) result = count_crossings(run, error);

    const bool kept = run->keep_every && frame % run->keep_every == 0;
    const double since = console_clock() - run->checkpoint_time;
    const bool due = since >= run->checkpoint_cost * (1 / checkpoint_share - 1) || since >= checkpoint_every;
    if (!result && (last || due || kept)) result = take_checkpoint(run, &writing->checkpoint, error);
    writing->totals = *run->totals;
    if (result) {
        writing->frame = 0;
        return result;
    }

    // also here if a thread cannot be created
    const bool beside = run->begun && run->job.hooks.thread_count != 1;
    writing->threaded = beside && pthread_create(&writing->thread, NULL, write_files, run) == 0;
    if (!writing->threaded) write_files(run);
    return SINGE_OK;
}

SingeResult run_end_frame(Run *run, SingeStats *stats, SingeError *error) {
    FrameWriting *writing = &run->writing;
    const int frame = writing->frame;
    if (!frame) return SINGE_OK;

    if (writing->threaded) pthread_join(writing->thread, NULL);
    for (int i = 0; i < TOTAL_OUTPUT_COUNT; i++) run->totals->output_seconds[i] += writing->output_seconds[i];
    SingeResult result = writing->result;
    if (result) *error = writing->error;
    if (!result && !run->begun) result = run_take_over(run, error);

    // remove drafts that have not been published
    for (int i = 0; i < run->file_count; i++) {
        if (result) file_name_target(error, run->files[i].draft, run->files[i].path);
        interrupt_disown(run->files[i].draft);
        file_discard(run->files[i].draft);
        free(run->files[i].path);
    }

    run->file_count = 0;

    writing->frame = 0;
    *stats = writing->stats;
    if (!result) result = tables_write_frame(&run->tables, frame, stats, &writing->totals, &writing->cost, error);
    if (!result) run->record.frames_done = frame;
    if (!result && writing->checkpoint.bytes)
        result = write_checkpoint(run, &writing->checkpoint, (Progress){frame, 0}, &writing->totals, error);
    if (!result && run->keep_every && frame % run->keep_every == 0) result = run_keep_checkpoint(run, frame, error);
    checkpoint_drop(run->sim, &writing->checkpoint);
    return result;
}

// singe run: frame 1 is the start, at time 0; each later frame is `steps` steps on from the one before it.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "cli/args.h"
#include "cli/interrupt.h"
#include "cli/run.h"
#include "cli/video.h"
#include "scene/warnings.h"

static const ArgOption run_options[] = {
    {"output", 'o', "DIR", "folder of the cache [out/NAME]", .read = args_text, offsetof(RunOptions, output)},
    {"frames", 0, "N", "number of frames; the first is the start", .read = args_int, offsetof(RunOptions, frames), 1,
     JOB_FRAMES_MAX},
    {ARGS_THREADS(RunOptions)},
    {ARGS_SET(RunOptions)},
    {"resume", 0, NULL, "continues from DIR/checkpoint.singe", .read = args_switch, offsetof(RunOptions, resume)},
    {"from", 0, "DIR:FRAME", "starts from a frame of an earlier run, with a changed scene", .read = args_text,
     offsetof(RunOptions, from)},
    {"force", 'f', NULL, "replaces an earlier run in DIR without asking", .read = args_switch,
     offsetof(RunOptions, force)},
    {"no-preview", 0, NULL, "draws no pictures and makes no video", .read = args_switch,
     offsetof(RunOptions, no_preview)},
    {"exr", 0, NULL, "also writes DIR/exr/NAME.0001.exr, ...: the layers of each frame", .read = args_switch,
     offsetof(RunOptions, exr)},
    {"record", 0, "FILE", "also writes a recording, which `singe replay` repeats and compares", .read = args_text,
     offsetof(RunOptions, record)},
    {ARGS_QUIET(RunOptions)},
};

static bool run_check(const ArgCommand *command, void *options) {
    RunOptions *o = options;
    if (o->exr && o->no_preview) return args_complain(command, "--exr: not with --no-preview");
    if (o->exr && !exr_available()) return args_complain(command, "--exr: this singe was built without EXR");
    if (o->frames) set_frames(&o->sets, o->frames);
    return true;
}

const ArgCommand run_command = {
    "run",
    "SCENE",
    "Simulates a scene file and writes a cache, pictures, a video and statistics to DIR.",
    ARGS_OPTIONS(run_options),
    "Ctrl-C ends the run after the current step; a second Ctrl-C ends it at once. Exit codes: 0 success,\n"
    "1 the run failed or was interrupted, or ffmpeg failed, 2 bad input.",
    "singe run letter.yaml -o out\n"
    "singe run letter.yaml --frames 24 --set pace=2 --set \"sheets.0.grid.cells=[40, 60]\"\n"
    "singe run letter.yaml -o out --resume",
    .operand_field = offsetof(RunOptions, scene),
    .check = run_check};

static SingeResult stop(Run *run, Progress progress, SingeError *error) {
    run->record.result = "interrupted";

    // before the first frame is whole there is nothing to resume from
    if (progress.frame <= 0) return SINGE_OK;

    SingeResult result = tables_write_steps(&run->tables, progress.frame + 1, error);
    return result ? result : run_write_checkpoint(run, progress, error);
}

/// A picture or a step took so long that it was given up. Its frame is not whole, and a checkpoint would be beyond it.
static SingeResult leave(Run *run) {
    run->record.result = "interrupted";
    return SINGE_OK;
}

/// From this 99th percentile of strain on, sheets no longer look like sheets.
static const double strain_max = 0.5;

/// Waits for the frame being written, if any, and reports it.
static SingeResult end_frame(Run *run, SingeError *error) {
    const int frame = run->writing.frame;
    const uint64_t halts = run->writing.totals.contact_halts;
    SingeStats stats;
    SingeResult result = run_end_frame(run, &stats, error);
    if (result || !frame) return result;

    if (stats.strain_p99 > fmax(strain_max, run->strain)) {
        run->strain = stats.strain_p99;
        run->strained = frame;
    }

    if (halts > run->halts && !run->halted) {
        run->halted = true;
        console_warn(run->console,
                     "in frame %d contact was too costly in %" PRIu64 " of %d steps, so all sheets were held still "
                     "(reported once; contact_halts in stats.csv); use more steps, or slower motion",
                     frame, halts - run->halts, run->job.scene->steps);
    }
    run->halts = halts;

    const double now = console_clock(), seconds = now - run->frame_ended;
    run->frame_ended = now;
    run->frame_seconds = run->frame_seconds > 0 ? 0.8 * run->frame_seconds + 0.2 * seconds : seconds;
    console_progress(run->console, &(ConsoleProgress){frame, run->job.scene->frames, stats.burnt_fraction,
                                                      (double)stats.temperature_max, run->frame_seconds});
    return SINGE_OK;
}

/// Steps from frame to frame. A frame is written while the simulation steps on to the next. Ctrl-C ends it between two
/// steps.
static SingeResult run_frames(Run *run, SingeError *error) {
    const int frames = run->job.scene->frames;
    run->frame_ended = console_clock();

    for (int frame = run->first; frame <= frames; frame++) {
        // step to the frame; the one before it is whole afterwards, also if a step has failed
        SingeError step_error;
        const SingeResult stepped = frame > 1 ? run_advance(run, frame, &step_error) : SINGE_OK;
        SingeResult result = end_frame(run, error);
        if (result && interrupt_left_work()) return leave(run);

        if (!result && stepped) {
            *error = step_error;
            result = stepped;
        }
        if (!result && frame > 1 && run->step < run->job.scene->steps)
            return stop(run, (Progress){frame - 1, run->step}, error);

        // begin to write it
        const bool last = frame == frames;
        if (!result) result = run_begin_frame(run, frame, last, error);
        const bool asked = interrupt_asked();
        if (!result && (asked || last)) result = end_frame(run, error);
        if (result && interrupt_left_work()) return leave(run);
        if (!result && asked && !last) return stop(run, (Progress){frame, 0}, error);
        if (result) return result;
    }

    run->record.result = "complete";
    return SINGE_OK;
}

// ---- before and after

/// Prints how far the run came, and warns of what makes its results doubtful.
static void print_summary(Run *run) {
    const Record *record = &run->record;
    const SingeStats stats = singe_sim_stats(run->sim);
    char took[32];

    console_duration(run->totals->wall_seconds, took);
    console_note(run->console, "%s: %d of %d frames in %s", record->result, record->frames_done, run->job.scene->frames,
                 took);

    char front[100] = ""; // a front that has had several paces has no one speed, nor has what a source has just lit
    const double pace = (double)run->job.scene->sim.pace, speed = 1e3 * stats.front_speed;
    if (pace == 1) snprintf(front, sizeof front, "front %.1f mm/s, ", speed);
    else snprintf(front, sizeof front, "front %.1f mm/s in the fire's time, %.1f on film, ", speed, speed * pace);
    if (run->job.scene->pace_count || stats.burnt_fraction < 0.01 || speed == 0) front[0] = 0;
    console_note(run->console, "%shottest %.0f C, %.0f %% burnt, %u pieces, %u particles left", front,
                 run->totals->hottest - 273.15, 100 * stats.burnt_fraction, stats.pieces, stats.particles);

    bool mapped = false;
    for (uint32_t i = 0; i < run->job.scene->source_count; i++)
        mapped = mapped || run->job.scene->sources[i].def.kind == SINGE_SOURCE_ARRIVAL;
    if (mapped)
        console_note(run->console, "the front kept to its map within %.1f ms, %u of %u particles missed it",
                     1e3 * stats.arrival_error, stats.arrival_missed, singe_sim_counts(run->sim).particles);

    const double ignition = scene_ignition(run->job.scene);
    if (strcmp(record->result, "complete") == 0 && run->job.scene->frames > 1 && isfinite(ignition) &&
        run->totals->ignited == 0 && stats.burnt_fraction == 0)
        console_warn(run->console, "nothing ignited: hottest %.0f C, ignition %.0f C", run->totals->hottest - 273.15,
                     ignition - 273.15);
    if (!stats.ledgers_close)
        console_warn(run->console,
                     "the ledgers do not close: heat is off by %.2g of its largest entry, mass by %.2g (the limit is "
                     "%g); the steps may be so short that temperatures hardly change in one",
                     stats.ledger_error, stats.mass_ledger_error, SINGE_LEDGER_BOUND);
    if (run->strained)
        console_warn(
            run->console,
            "in frame %d one edge in a hundred is strained by %.0f %% or more (strain_p99): the sheets move too fast, are "
            "pulled too hard, or are too soft; `singe verify` counts edges of twice their length",
            run->strained, 100 * run->strain);

    const double frames = record->frames_done > 0 ? record->frames_done : 1;
    console_note(run->console, "last frame: %u triangles, %.0f %% of them near the front; %.1f ms a surface",
                 record->triangles, 100.0 * record->fine_triangles / (record->triangles ? record->triangles : 1),
                 1e3 * run->totals->output_seconds[TOTAL_SURFACE] / frames);
}

/// Ends every run that has begun: writes the record and the video, and prints the paths.
static ExitCode finish(Run *run, SingeResult result, const SingeError *error) {
    Record *record = &run->record;
    SingeError write_error = {0};

    if (result) {
        record->result = "failed";
        record->error = *error;
        record->error.code = result;
        console_result(run->console, error);
    }

    tables_close(&run->tables);
    console_clear(run->console);

    VideoResult video = VIDEO_NO_PROGRAM;
    if (run->pictures && record->frames_done > 0)
        video = video_make(run->console, &run->folder, (double)run->job.scene->fps, 1, record->frames_done);
    record->video = video == VIDEO_MADE;
    run->totals->wall_seconds = run->wall_before + console_clock() - run->started;

    // an earlier run keeps its record as long as nothing of it has been replaced
    const bool ours = run->begun || access(run->folder.record, F_OK) != 0;
    SingeResult written = SINGE_OK;
    if (run->begun && run->converted && record->frames_done > 0)
        written = outputs_write_roots(&run->outputs, record->frames_done, &write_error);
    if (!written && ours) written = record_write(record, run->folder.record, &run->job, &write_error);

    if (written) {
        console_result(run->console, &write_error);
        return EXIT_FAILED;
    }

    if (!run->begun && !ours)
        console_note(run->console, "the output of an earlier run in %s is unchanged", run->folder.path);

    print_summary(run);
    if (!run->console->quiet) printf("%s\n", record->video ? run->folder.video : run->folder.path);
    if (strcmp(record->result, "interrupted") == 0 && record->frames_done > 0)
        console_note(run->console, "--resume continues from here");
    return strcmp(record->result, "complete") == 0 && video != VIDEO_FAILED ? EXIT_GOOD : EXIT_FAILED;
}

static ExitCode run_scene(Run *run, const RunOptions *options) {
    ExitCode code = run_prepare(run, options);
    if (code) return code;

    SingeError error = {0};
    run->record.preview = run->pictures != NULL;
    run->record.counts = singe_sim_counts(run->sim);
    run->record.thickening = singe_sim_stats(run->sim).thickening;
    job_note_meshes(&run->job, run->console);

    const SingeCounts *counts = &run->record.counts;
    console_note(run->console, "%u cells of %.3g mm, strands of %.1f springs on average", counts->cells,
                 1e3 * (double)counts->cell_size, counts->mean_strand_length);
    run->timers = singe_sim_timers(run->sim);
    interrupt_watch();

    // what is missing of the frames before a resumption, then the frames
    bool whole = false;
    SingeResult result = SINGE_OK;
    if (run->begun) result = record_write(&run->record, run->folder.record, &run->job, &error);
    if (!result) result = run_convert_missing(run, &error);
    if (!result && run->converted) result = run_draw_missing(run, &whole, &error);
    if (!run->pictures) lock_release(&run->pictures_lock);
    if (!result && whole) result = run_frames(run, &error);
    else if (!result) run->record.result = "interrupted";

    return finish(run, result, &error);
}

int command_run(int argc, char **argv) {
    RunOptions options = {.threads = job_threads()};
    ExitCode code;
    if (args_read(&run_command, argc, argv, &options, &code)) {
        interrupt_shield();
        Console console = console_make(options.quiet);
        Run run = {.console = &console,
                   .tables = TABLES_CLOSED,
                   .cache_lock = LOCK_NONE,
                   .pictures_lock = LOCK_NONE,
                   .started = console_clock()};
        run.checkpoint_time = run.started;

        const char *folder = options.scene; // of a run: the scene as it was burnt
        char *scene = job_recorded_path(folder);
        const bool recorded = scene;
        if (!recorded) scene = job_scene_path(&console, options.scene);
        options.scene = scene;

        run.record = record_make(scene ? scene : "");
        run.totals = &run.record.totals;
        code = EXIT_INPUT;
        if (recorded) code = job_reopen(&run.job, &console, folder, &options.sets, options.threads);
        else if (scene) code = job_read(&run.job, &console, scene, &options.sets, options.threads);

        const double pictures = !code && !options.no_preview ? scene_picture_memory(run.job.scene, options.exr) : 0;
        if (!code) code = (recorded ? job_fits : job_load)(&run.job, &console, pictures);
        if (!code && options.record) code = recording_open(&run.recording, options.record, &console);
        run.job.hooks.record = recording_hook(&run.recording);
        if (!code) code = run_scene(&run, &options);

        tables_close(&run.tables);
        frame_free(&run.frame);
        outputs_close(&run.outputs);
        if (run.baker != run.pictures) pictures_close(run.baker);
        pictures_close(run.pictures);
        branch_close(&run.branch);
        free(run.record.from);
        singe_sim_destroy(run.sim);
        code = recording_close(&run.recording, code, &console);
        lock_release(&run.pictures_lock);
        lock_release(&run.cache_lock);
        folder_free(&run.folder);
        job_close(&run.job);
        free(scene);
    }

    set_free(&options.sets);
    return code;
}

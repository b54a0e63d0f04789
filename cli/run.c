// singe run: frame 1 is the start, at time 0; each later frame is `steps` steps on from the one before it. Within
// a frame the order is PLY, VDB, PNG, line of stats.csv, checkpoint: whatever a checkpoint stands for is on the disk.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/checkpoint.h"
#include "cli/folder.h"
#include "cli/interrupt.h"
#include "cli/job.h"
#include "cli/pictures.h"
#include "cli/record.h"
#include "cli/stats.h"
#include "cli/text.h"
#include "cli/video.h"

enum { OPT_OUTPUT, OPT_FRAMES, OPT_THREADS, OPT_SET, OPT_RESUME, OPT_NO_PREVIEW, OPT_EXR, OPT_QUIET, OPT_COUNT };

static const ArgOption run_options[OPT_COUNT] = {
    [OPT_OUTPUT] = {"output", 'o', "DIR", "folder of the cache [out/NAME]"},
    [OPT_FRAMES] = {"frames", 0, "N", "frames to make, the start being the first"},
    [OPT_THREADS] = {"threads", 0, "N", "threads [all]; the result does not depend on them"},
    [OPT_SET] = {"set", 0, "PATH=VALUE", "lays a value over the scene; may be repeated"},
    [OPT_RESUME] = {"resume", 0, NULL, "goes on from DIR/checkpoint.singe"},
    [OPT_NO_PREVIEW] = {"no-preview", 0, NULL, "draws no pictures and makes no video"},
    [OPT_EXR] = {"exr", 0, NULL, "also DIR/exr/NAME.0001.exr, ...: the layers of each frame"},
    [OPT_QUIET] = {"quiet", 'q', NULL, "says nothing but errors"},
};

static const ArgCommand run_command = {
    "run", "SCENE", "Burns what the scene file describes and leaves a cache, pictures, a video and numbers in DIR.",
    run_options, OPT_COUNT,
    "Ctrl-C ends the run after its frame; a second Ctrl-C ends it at once. Exit codes: 0 good, 1 failed or\n"
    "interrupted, or its video did, 2 bad input."};

typedef struct RunOptions {
    const char *scene, *output;
    SetList sets;
    int threads;
    bool resume, no_preview, exr, quiet;
} RunOptions;

/// A run in progress.
typedef struct Run {
    Console *console;
    Job job;
    Folder folder;
    SingeSim *sim;
    Pictures *pictures; ///< NULL without a preview
    bool layers;        ///< written as EXR, too
    SingeSurface surface;
    Gas gas;                    ///< of the frame, as its file has it
    StatsFile stats;
    Record record;
    Totals *totals;             ///< the record's
    SingeTimers timers;         ///< as last read
    uint64_t scene_hash;
    double started, wall_before; ///< s, clock at the start and time spent before a resumption
    double checkpoint_time, checkpoint_cost, frame_seconds;
    int first;                  ///< frame to begin with
} Run;

/// What takes less than this part of the run's time: a checkpoint is due when ten times its cost has passed.
static const double checkpoint_share = 0.1;
static const double checkpoint_every = 5; ///< s, however dear it is

static ExitCode parse_options(int argc, char **argv, RunOptions *options, bool *done) {
    ArgReader reader = args_begin(&run_command, argc, argv);
    const char *value;
    int frames = 0;
    *options = (RunOptions){.threads = job_threads()};
    *done = false;
    for (int option; (option = args_next(&reader, &value)) != ARG_END;) {
        bool good = true;
        switch (option) {
        case OPT_OUTPUT: options->output = value; break;
        case OPT_FRAMES: good = args_int(&reader, option, value, 1, 1000000, &frames); break;
        case OPT_THREADS: good = args_int(&reader, option, value, 1, JOB_THREADS_MAX, &options->threads); break;
        case OPT_SET: set_add(&options->sets, value); break;
        case OPT_RESUME: options->resume = true; break;
        case OPT_NO_PREVIEW: options->no_preview = true; break;
        case OPT_EXR: options->exr = true; break;
        case OPT_QUIET: options->quiet = true; break;
        case ARG_OPERAND: options->scene = value; break;
        case ARG_HELP: *done = true; return EXIT_GOOD;
        default: good = false;
        }
        if (!good) return EXIT_INPUT;
    }
    if (options->exr && (options->no_preview || !pictures_available() || !exr_available())) {
        if (options->no_preview) args_complain(&reader, "--exr: not with --no-preview");
        else args_complain(&reader, "--exr: this singe was built without %s", exr_available() ? "the preview" : "EXR");
        return EXIT_INPUT;
    }
    if (frames) set_frames(&options->sets, frames);
    return EXIT_GOOD;
}

// ---- a frame

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
    run->totals->crossed += now.contact_crossed - before->contact_crossed;
    *before = now;
}

static SingeResult advance(Run *run, SingeError *error) {
    for (int step = 0; step < run->job.scene->steps; step++) {
        SingeResult result = singe_sim_step(run->sim);
        if (result) {
            *error = *singe_sim_error(run->sim);
            return result;
        }
        count_events(run);
    }
    return SINGE_OK;
}

/// Adds the time since *clock to one of the totals and moves the clock on.
static void charge(Run *run, int total, double *clock) {
    double now = console_clock();
    run->totals->output_seconds[total] += now - *clock;
    *clock = now;
}

static SingeResult write_picture(Run *run, int frame, double time, SingeError *error) {
    const uint8_t *rgb = pictures_draw(run->pictures, &run->surface, &run->gas.view, time, error);
    if (!rgb) return error->code ? error->code : SINGE_ERROR_STATE;
    int width, height;
    pictures_size(run->pictures, &width, &height);
    char *path = folder_png(&run->folder, frame);
    SingeResult result = png_write(path, width, height, rgb, error);
    free(path);
    if (result || !run->layers) return result;
    path = folder_exr(&run->folder, frame);
    result = pictures_write_layers(run->pictures, path, error);
    free(path);
    return result;
}

static bool has_gas(const Run *run) { return singe_sim_gas(run->sim).size[0] > 0; }

/// Where the simulation has gas every frame has a file of it, however still the air.
static SingeResult write_gas(Run *run, int frame, double time, SingeError *error) {
    SingeGas gas = singe_sim_gas(run->sim);
    gas_free(&run->gas);
    if (!has_gas(run)) return SINGE_OK;
    SingeResult result = gas_copy(&gas, (SingeAllocator){0}, &run->gas, error);
    if (result) return result;
    char *path = folder_vdb(&run->folder, frame);
    result = vdb_write_gas(path, &run->gas, time, error);
    free(path);
    return result;
}

static SingeResult write_frame(Run *run, int frame, SingeStats *stats, SingeError *error) {
    FrameCost cost;
    double begun = console_clock(), clock = begun;
    read_timers(run, &cost);
    SingeResult result = singe_sim_surface(run->sim, &run->surface);
    cost.surface = 1e3 * (console_clock() - begun);
    if (result) {
        *error = *singe_sim_error(run->sim);
        return result;
    }
    *stats = singe_sim_stats(run->sim);
    run->totals->hottest = fmax(run->totals->hottest, (double)stats->temperature_max);
    charge(run, TOTAL_SURFACE, &clock);
    char *path = folder_ply(&run->folder, frame);
    result = ply_write_surface(path, &run->surface, stats->time, error);
    free(path);
    if (!result) result = write_gas(run, frame, stats->time, error);
    if (result) return result;
    charge(run, TOTAL_PLY, &clock);
    if (run->pictures && (result = write_picture(run, frame, stats->time, error))) return result;
    charge(run, TOTAL_PREVIEW, &clock);
    cost.output = 1e3 * (clock - begun);
    cost.triangles = run->record.triangles = run->surface.triangle_count;
    cost.fine_triangles = run->record.fine_triangles = run->surface.fine_triangle_count;
    result = stats_write(&run->stats, frame, stats, run->totals, &cost, error);
    if (!result) run->record.frames_done = frame;
    return result;
}

static SingeResult write_checkpoint(Run *run, int frame, bool must, SingeError *error) {
    double begun = console_clock(), clock = begun, since = begun - run->checkpoint_time;
    if (!must && since < run->checkpoint_cost * (1 / checkpoint_share - 1) && since < checkpoint_every) return SINGE_OK;
    run->totals->wall_seconds = run->wall_before + begun - run->started;
    SingeResult result = stats_sync(&run->stats, error);
    if (!result)
        result = checkpoint_write(&run->folder, run->sim, run->job.hooks.allocator, frame, run->scene_hash, run->totals,
                                  error);
    charge(run, TOTAL_CHECKPOINT, &clock);
    run->checkpoint_time = clock;
    run->checkpoint_cost = clock - begun;
    return result;
}

static SingeResult run_frames(Run *run, SingeError *error) {
    int frames = run->job.scene->frames;
    for (int frame = run->first; frame <= frames; frame++) {
        double begun = console_clock();
        SingeStats stats;
        SingeResult result = frame > 1 ? advance(run, error) : SINGE_OK;
        if (!result) result = write_frame(run, frame, &stats, error);
        bool stop = interrupt_asked();
        if (!result) result = write_checkpoint(run, frame, stop || frame == frames, error);
        if (result) return result;
        double seconds = console_clock() - begun;
        run->frame_seconds = run->frame_seconds > 0 ? 0.8 * run->frame_seconds + 0.2 * seconds : seconds;
        console_progress(run->console, &(ConsoleProgress){frame, frames, stats.burnt_fraction,
                                                          (double)stats.temperature_max, run->frame_seconds});
        if (stop && frame < frames) {
            run->record.result = "interrupted";
            return SINGE_OK;
        }
    }
    run->record.result = "complete";
    return SINGE_OK;
}

// ---- before and after

static ExitCode fail(Run *run, const SingeError *error, ExitCode code) {
    console_result(run->console, error);
    return code;
}

/// Goes on from a checkpoint. run->sim stays NULL when there is none.
static ExitCode resume(Run *run) {
    Checkpoint checkpoint;
    SingeError error = {0};
    SingeResult result = checkpoint_read(&run->folder, &run->job.hooks, run->scene_hash, &checkpoint, &error);
    if (result) return fail(run, &error, result == SINGE_ERROR_FILE ? EXIT_FAILED : job_exit(result));
    if (checkpoint.frame == 0) {
        console_note(run->console, "no checkpoint in %s: starting from the beginning", run->folder.path);
        return EXIT_GOOD;
    }
    run->sim = checkpoint.sim;
    if (checkpoint.frame > run->job.scene->frames) {
        console_error(run->console, "the checkpoint is at frame %d, but only %d frames are asked for", checkpoint.frame,
                      run->job.scene->frames);
        return EXIT_INPUT;
    }
    result = stats_open(&run->stats, &run->folder, checkpoint.frame, &error);
    if (result) return fail(run, &error, result == SINGE_ERROR_FORMAT ? EXIT_INPUT : EXIT_FAILED);
    *run->totals = checkpoint.totals;
    run->wall_before = checkpoint.totals.wall_seconds;
    run->record.resumed_from = run->record.frames_done = checkpoint.frame;
    run->first = checkpoint.frame + 1;
    console_note(run->console, "going on from frame %d", checkpoint.frame);
    return EXIT_GOOD;
}

static FolderParts folder_parts(const Run *run) {
    return (FolderParts){.pictures = run->pictures != NULL, .gas = has_gas(run), .exr = run->layers};
}

/// Starts from the beginning, over whatever an earlier run of this name left.
static ExitCode start(Run *run) {
    SingeError error = {0};
    int removed = 0;
    SingeResult result = folder_clean(&run->folder, folder_parts(run), &removed, &error);
    if (removed)
        console_note(run->console, "removed %d files of an earlier run of '%s' in %s", removed, run->folder.name,
                     run->folder.path);
    if (!result) result = stats_open(&run->stats, &run->folder, 0, &error);
    run->first = 1;
    return result ? fail(run, &error, EXIT_FAILED) : EXIT_GOOD;
}

static ExitCode prepare(Run *run, const RunOptions *options) {
    SingeError error = {0};
    run->folder = folder_name(options->output, run->job.scene->name);
    SingeResult result = checkpoint_scene_hash(run->job.scene, &run->job.assets, &run->scene_hash, &error);
    if (result) return fail(run, &error, EXIT_FAILED);
    if (options->no_preview) console_note(run->console, "no preview");
    else if (!pictures_available()) console_note(run->console, "this singe was built without the preview");
    else if (pictures_open(&run->job, &run->pictures, &error)) return fail(run, &error, EXIT_FAILED);
    ExitCode code = EXIT_GOOD;
    if (options->resume && (code = resume(run))) return code;
    // built before anything of an earlier run is touched
    if (!run->sim && (code = job_build(&run->job, run->console, &run->sim))) return code;
    run->layers = options->exr;
    result = folder_create(&run->folder, folder_parts(run), &error);
    if (!result) result = folder_sweep(&run->folder, &error);
    if (result) return fail(run, &error, EXIT_FAILED);
    if (!run->first && (code = start(run))) return code;
    if (run->layers) result = pictures_keep_layers(run->pictures, &error);
    return result ? fail(run, &error, EXIT_FAILED) : EXIT_GOOD;
}

/// The end of every run that has begun: record, video, and where things are.
static ExitCode finish(Run *run, SingeResult result, const SingeError *error) {
    Record *record = &run->record;
    SingeError write_error = {0};
    if (result) {
        record->result = "failed";
        record->error = *error;
        record->error.code = result;
        console_result(run->console, error);
    }
    stats_close(&run->stats);
    console_clear(run->console);
    VideoResult video = VIDEO_NO_PROGRAM;
    if (run->pictures && record->frames_done > 0)
        video = video_make(run->console, &run->folder, (double)run->job.scene->fps, 1, record->frames_done);
    record->video = video == VIDEO_MADE;
    run->totals->wall_seconds = run->wall_before + console_clock() - run->started;
    if (record_write(record, &run->folder, &run->job, &write_error)) {
        console_result(run->console, &write_error);
        return EXIT_FAILED;
    }
    char took[32];
    console_duration(run->totals->wall_seconds, took);
    console_note(run->console, "%s: %d of %d frames in %s", record->result, record->frames_done, run->job.scene->frames,
                 took);
    SingeStats stats = singe_sim_stats(run->sim);
    console_note(run->console, "front %.1f mm/s, hottest %.0f C, %.0f %% burnt, %u pieces, %u particles left",
                 1e3 * stats.front_speed, run->totals->hottest - 273.15, 100 * stats.burnt_fraction, stats.pieces,
                 stats.particles);
    double frames = record->frames_done > 0 ? record->frames_done : 1;
    console_note(run->console, "drawn %u triangles at last, %.0f %% of them near the front; %.1f ms a surface",
                 record->triangles, 100.0 * record->fine_triangles / (record->triangles ? record->triangles : 1),
                 1e3 * run->totals->output_seconds[TOTAL_SURFACE] / frames);
    if (!run->console->quiet) printf("%s\n", record->video ? run->folder.video : run->folder.path);
    if (strcmp(record->result, "interrupted") == 0) console_note(run->console, "--resume goes on from here");
    return strcmp(record->result, "complete") == 0 && video != VIDEO_FAILED ? EXIT_GOOD : EXIT_FAILED;
}

static ExitCode run_scene(Run *run, const RunOptions *options) {
    ExitCode code = prepare(run, options);
    if (code) return code;
    SingeError error = {0};
    run->record.preview = run->pictures != NULL;
    run->record.census = singe_sim_census(run->sim);
    run->record.thickening = singe_sim_stats(run->sim).thickening;
    job_note_meshes(&run->job, run->console);
    const SingeCensus *census = &run->record.census;
    console_note(run->console, "%u cells of %.3g mm, strands of %.1f springs on average", census->cells,
                 1e3 * (double)census->cell_size, census->mean_strand_length);
    run->timers = singe_sim_timers(run->sim);
    interrupt_watch();
    SingeResult result = record_write(&run->record, &run->folder, &run->job, &error);
    if (!result) result = run_frames(run, &error);
    return finish(run, result, &error);
}

int command_run(int argc, char **argv) {
    RunOptions options;
    bool done;
    ExitCode code = parse_options(argc, argv, &options, &done);
    if (!code && !done) {
        interrupt_shield();
        Console console = console_make(options.quiet);
        Run run = {.console = &console, .stats = {.fd = -1}, .started = console_clock()};
        run.checkpoint_time = run.started;
        run.record = record_make(options.scene);
        run.totals = &run.record.totals;
        code = job_read(&run.job, &console, options.scene, &options.sets, options.threads);
        const bool drawn = !options.no_preview && pictures_available();
        if (!code) code = job_load(&run.job, &console, drawn ? scene_picture_memory(run.job.scene) : 0);
        if (!code) code = run_scene(&run, &options);
        stats_close(&run.stats);
        singe_surface_free(&run.surface);
        gas_free(&run.gas);
        pictures_close(run.pictures);
        singe_sim_destroy(run.sim);
        folder_free(&run.folder);
        job_close(&run.job);
    }
    set_free(&options.sets);
    return code;
}

// Begins a run: from the start, replacing an earlier run, or from a checkpoint.
//
// An earlier run remains until the first frame of the new one and its run.json are whole, under temporary names. Then
// the earlier checkpoint is removed, run.json is replaced, the earlier frames are removed, the new frame gets its name,
// and stats.csv starts again. Frames of two runs are thus never mixed.
#include <stdlib.h>
#include <unistd.h>

#include "cli/interrupt.h"
#include "cli/run.h"

static ExitCode run_begin_fail(Run *run, const SingeError *error, ExitCode code) {
    console_result(run->console, error);
    return code;
}

FolderParts run_parts(const Run *run) {
    bool gas = singe_sim_gas(run->sim).size[0] > 0;
    return (FolderParts){.pictures = run->pictures != NULL,
                         .gas = gas,
                         .gas_detail = gas && run->baker,
                         .exr = run->layers,
                         .events = run->job.scene->output.events,
                         .probes = run->job.scene->probe_count > 0,
                         .outputs = run->job.scene->output.formats};
}

// ---- the folder

static SingeResult take_lock(Run *run, Lock *lock, const char *path, const char *what, SingeError *error) {
    bool kept;
    SingeResult result = lock_take(lock, path, what, false, &kept, error);
    if (!kept)
        console_warn(run->console, "%s: the file system has no locks; nothing else may write there", run->folder.path);
    return result;
}

/// Creates the folder if necessary, and keeps other processes from writing to it.
static ExitCode hold_folder(Run *run) {
    SingeError error = {0};
    if (run->cache_lock.fd >= 0) return EXIT_GOOD;
    SingeResult result = folder_make(run->folder.path, &error);
    if (!result) result = take_lock(run, &run->cache_lock, run->folder.cache_lock, "frames", &error);
    if (!result) result = take_lock(run, &run->pictures_lock, run->folder.pictures_lock, "pictures", &error);
    return result ? run_begin_fail(run, &error, EXIT_FAILED) : EXIT_GOOD;
}

// ---- going on

/// Frames can only be computed again from the start; pictures can be drawn again.
static ExitCode expect_frames(Run *run, int last) {
    bool gas = run_parts(run).gas;
    for (int frame = 1; frame <= last; frame++) {
        char *ply = folder_ply(&run->folder, frame), *vdb = folder_vdb(&run->folder, frame);
        const char *missing = !folder_has(ply) ? ply : gas && !folder_has(vdb) ? vdb : NULL;
        if (missing)
            console_error(run->console,
                          "resume: %s is missing or empty, and the checkpoint is at frame %d; run without --resume to "
                          "start over",
                          missing, last);
        free(ply), free(vdb);
        if (missing) return EXIT_INPUT;
    }
    return EXIT_GOOD;
}

static SingeResult open_tables(Run *run, SingeError *error) {
    SingeResult result = lines_open(&run->stats, run->folder.stats, error);
    return result ? result : tables_open(&run->tables, &run->folder, run->job.scene, &run->job.assets, error);
}

/// Resumes from a checkpoint. run->sim remains NULL if there is none.
static ExitCode resume(Run *run) {
    Checkpoint checkpoint;
    ExitCode code;
    SingeError error = {0};
    SingeResult result =
        checkpoint_read(&run->folder, &run->job.hooks, run->hash, &run->job.assets, &checkpoint, &error);
    if (result) {
        code = run_begin_fail(run, &error, result == SINGE_ERROR_FILE ? EXIT_FAILED : job_exit(result));
        console_note(run->console, "without --resume the run starts over");
        return code;
    }
    if (checkpoint.refused.code)
        console_warn(run->console, "%s; the checkpoint before it is used", checkpoint.refused.message);
    const int frame = checkpoint.progress.frame;
    if (frame == 0) return EXIT_GOOD;
    run->sim = checkpoint.sim;
    if (frame > run->job.scene->frames) {
        console_error(run->console, "the checkpoint is at frame %d, but only %d frames are requested", frame,
                      run->job.scene->frames);
        return EXIT_INPUT;
    }
    if ((code = expect_frames(run, frame))) return code;
    result = open_tables(run, &error);
    if (!result) result = stats_cut(&run->stats, frame, &error);
    if (!result) result = tables_cut(&run->tables, frame, &checkpoint.totals, &error);
    if (!result && checkpoint.previous) result = checkpoint_promote(&run->folder, &error);
    if (result) return run_begin_fail(run, &error, result == SINGE_ERROR_FORMAT ? EXIT_INPUT : EXIT_FAILED);
    *run->totals = checkpoint.totals;
    run->wall_before = checkpoint.totals.wall_seconds;
    run->record.resumed_from = run->record.frames_done = frame;
    run->first = frame + 1;
    run->step = checkpoint.progress.step;
    run->begun = true;
    console_note(run->console, "continuing from frame %d", frame);
    if (checkpoint.other_looks && run->pictures)
        console_warn(run->console, "the preview has changed; `singe render` draws the earlier frames again");
    return EXIT_GOOD;
}

/// Whether a picture that the run should have written is missing.
static bool lacks_picture(const Run *run, int frame) {
    char *png = folder_png(&run->folder, frame), *exr = folder_exr(&run->folder, frame);
    bool lacks = !folder_has(png) || (run->layers && !folder_has(exr));
    free(png), free(exr);
    return lacks;
}

static SingeResult draw_again(Run *run, int number, SingeError *error) {
    Frame frame;
    const uint8_t *rgb;
    char *png = folder_png(&run->folder, number), *exr = folder_exr(&run->folder, number);
    SingeResult result = frame_read(&run->folder, number, &frame, error);
    if (!result) result = frame_draw(&frame, run->pictures, &rgb, error);
    if (!result) result = frame_write_picture(run->pictures, rgb, png, run->layers ? exr : NULL, error);
    frame_free(&frame);
    free(png), free(exr);
    return result;
}

SingeResult run_draw_missing(Run *run, bool *whole, SingeError *error) {
    SingeResult result = SINGE_OK;
    int last = run->record.resumed_from, count = 0;
    for (int frame = 1; frame <= last && run->pictures; frame++) count += lacks_picture(run, frame);
    if (count) console_note(run->console, "drawing %d pictures that are missing", count);
    *whole = true;
    for (int frame = 1; frame <= last && count && !result && *whole; frame++) {
        if (!lacks_picture(run, frame)) continue;
        result = draw_again(run, frame, error);
        *whole = --count == 0 || !interrupt_asked();
    }
    return result;
}

static bool lacks_fine_gas(const Run *run, int frame) {
    if (!run_parts(run).gas_detail) return false;
    char *path = folder_gas_detail(&run->folder, frame);
    const bool lacks = !folder_has(path);
    free(path);
    return lacks;
}

SingeResult run_convert_missing(Run *run, bool *whole, SingeError *error) {
    SingeResult result = SINGE_OK;
    const int last = run->record.resumed_from;
    *whole = true;
    for (int frame = 1; frame <= last && !result && *whole; frame++) {
        const OutputSet missing = outputs_missing(&run->outputs, frame);
        const bool coarse = lacks_fine_gas(run, frame);
        if (missing) result = outputs_convert(&run->outputs, frame, missing, error);
        if (coarse && !result)
            result = gas_detail_convert(&run->folder, run->baker, frame, run->job.scene->gas_detail, error);
        if (!missing && !coarse) continue;
        *whole = !interrupt_asked();
    }
    return result;
}

// ---- from the start

/// Replaces an earlier run's run.json by this run's; the earlier run can no longer be resumed.
static SingeResult replace_record(Run *run, int *removed, SingeError *error) {
    char *draft;
    SingeResult result = file_draft(run->folder.record, &draft, error);
    interrupt_own(draft);
    if (!result) result = record_write(&run->record, draft, &run->job, error);
    if (!result) result = folder_forget(&run->folder, removed, error);
    interrupt_disown(draft);
    if (result) {
        file_discard(draft);
        return result;
    }
    run->begun = true;
    return file_publish(draft, run->folder.record, error);
}

SingeResult run_take_over(Run *run, SingeError *error) {
    int removed = 0;
    SingeResult result = replace_record(run, &removed, error);
    if (!result) result = folder_clean(&run->folder, run_parts(run), &removed, error);
    if (removed)
        console_note(run->console, "removed %d files of an earlier run of '%s' in %s", removed, run->folder.name,
                     run->folder.path);
    for (int i = 0; i < run->file_count && !result; i++) {
        interrupt_disown(run->files[i].draft);
        result = file_publish(run->files[i].draft, run->files[i].path, error);
        run->files[i].draft = NULL;
    }
    if (!result) result = stats_begin(&run->stats, error);
    return result ? result : tables_begin(&run->tables, error);
}

// ---- both

static ExitCode open_pictures(Run *run, const RunOptions *options) {
    SingeError error = {0};
    if (options->no_preview) console_note(run->console, "no preview");
    else if (!pictures_available()) console_note(run->console, "this singe was built without the preview");
    else if (pictures_open(&run->job, &run->pictures, &error)) return run_begin_fail(run, &error, EXIT_FAILED);
    if (options->exr && pictures_keep_layers(run->pictures, &error)) return run_begin_fail(run, &error, EXIT_FAILED);
    run->layers = options->exr;
    if (run->job.scene->gas_detail <= 1 || !run->job.scene->sim.gas.enabled) return EXIT_GOOD;
    run->baker = run->pictures;
    if (!run->baker && pictures_open_baker(&run->job, &run->baker, &error))
        return run_begin_fail(run, &error, EXIT_FAILED);
    return EXIT_GOOD;
}

/// Checks that the folders and files of the run can be written, as far as possible before anything is removed.
static ExitCode open_outputs(Run *run) {
    SingeError error = {0};
    SingeResult result = folder_create(&run->folder, run_parts(run), &error);
    if (!result) result = folder_sweep(&run->folder, &error);
    if (!result && !run->begun) result = open_tables(run, &error);
    return result ? run_begin_fail(run, &error, EXIT_FAILED) : EXIT_GOOD;
}

ExitCode run_prepare(Run *run, const RunOptions *options) {
    SingeError error = {0};
    ExitCode code;
    run->folder = folder_name(options->output, run->job.scene->name);
    run->first = 1;
    if (checkpoint_scene_hash(run->job.scene, &run->job.assets, &run->hash, &error))
        return run_begin_fail(run, &error, EXIT_FAILED);
    if ((code = open_pictures(run, options))) return code;
    if (options->resume && access(run->folder.path, F_OK) == 0) {
        if ((code = hold_folder(run)) || (code = resume(run))) return code;
    }
    if (options->resume && !run->sim)
        console_note(run->console, "no checkpoint in %s: starting from the beginning", run->folder.path);
    if (!run->sim && (code = job_build(&run->job, run->console, &run->sim))) return code;
    if ((code = hold_folder(run))) return code;
    if (outputs_open(&run->outputs, &run->job, &run->folder, run->job.scene->output.formats, run_parts(run).gas,
                     &error))
        return run_begin_fail(run, &error, EXIT_FAILED);
    run->outputs.scene.gas_detail = run_parts(run).gas_detail;
    return open_outputs(run);
}

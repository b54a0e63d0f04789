// Begins a run: from the start, replacing an earlier run, or from a checkpoint.
//
// An earlier run remains until the first frame of the new one and its run.json are whole, under temporary names. Then
// the earlier checkpoint is removed, run.json is replaced, the earlier frames are removed, the new frame gets its name,
// and the tables start again. Thus frames of two runs are never mixed.
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cli/interrupt.h"
#include "cli/run.h"

FolderParts run_parts(const Run *run) {
    bool gas = singe_sim_gas(run->sim).size[0] > 0;
    return (FolderParts){.pictures = run->pictures != NULL,
                         .gas = gas,
                         .gas_detail = gas && run->baker,
                         .exr = run->layers,
                         .checkpoints = run->keep_every || run->branch.frame,
                         .events = run->job.scene->output.events,
                         .probes = run->job.scene->probe_count > 0,
                         .outputs = run->job.scene->output.formats};
}

// ---- the folder

/// Creates the folder if necessary, and keeps other processes from writing to it.
static ExitCode hold_folder(Run *run) {
    SingeError error = {0};
    if (run->cache_lock.fd >= 0) return EXIT_GOOD;

    SingeResult result = folder_make(run->folder.path, &error);
    if (!result) result = lock_take(&run->cache_lock, run->folder.cache_lock, "frames", false, run->console, &error);
    if (!result)
        result = lock_take(&run->pictures_lock, run->folder.pictures_lock, "pictures", false, run->console, &error);
    if (!result) return EXIT_GOOD;

    console_result(run->console, &error);
    return EXIT_FAILED;
}

// ---- resuming

/// Resumes from a checkpoint. run->sim remains NULL if there is none.
static ExitCode resume(Run *run) {
    Checkpoint checkpoint;
    SingeError error = {0};
    SingeResult result =
        checkpoint_read(&run->folder, &run->job.hooks, run->hash, &run->job.assets, &checkpoint, &error);
    if (result) {
        console_result(run->console, &error);
        console_note(run->console, "without --resume the run starts over");
        return result == SINGE_ERROR_FILE ? EXIT_FAILED : job_exit(result);
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

    // frames can only be computed again from the start; pictures can be drawn again
    const bool gas = run_parts(run).gas;
    for (int i = 1; i <= frame; i++) {
        char *ply = folder_ply(&run->folder, i), *vdb = folder_vdb(&run->folder, i);
        const char *missing = !folder_has(ply) ? ply : gas && !folder_has(vdb) ? vdb : NULL;
        if (missing)
            console_error(run->console,
                          "resume: %s is missing or empty, and the checkpoint is at frame %d; run without --resume to "
                          "start over",
                          missing, frame);
        free(ply);
        free(vdb);
        if (missing) return EXIT_INPUT;
    }

    result = tables_open(&run->tables, &run->folder, run->job.scene, &run->job.assets, &error);
    if (!result) result = tables_cut(&run->tables, frame, &checkpoint.totals, &error);
    if (!result && checkpoint.previous) result = checkpoint_promote(&run->folder, &error);

    if (result) {
        console_result(run->console, &error);
        return result == SINGE_ERROR_FORMAT ? EXIT_INPUT : EXIT_FAILED;
    }

    run->record.from = branch_lineage(&run->folder);
    *run->totals = checkpoint.totals;
    run->halts = checkpoint.totals.contact_halts;
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
    free(png);
    free(exr);
    return lacks;
}

SingeResult run_draw_missing(Run *run, bool *whole, SingeError *error) {
    SingeResult result = SINGE_OK;
    const int last = run->record.resumed_from;
    int count = 0;

    for (int frame = 1; frame <= last && run->pictures; frame++) count += lacks_picture(run, frame);
    if (count) console_note(run->console, "drawing %d missing pictures", count);

    *whole = true;
    for (int number = 1; number <= last && count && !result && *whole; number++) {
        if (!lacks_picture(run, number)) continue;

        Frame frame;
        const uint8_t *rgb;
        char *png = folder_png(&run->folder, number), *exr = folder_exr(&run->folder, number);

        result = frame_read(&run->folder, number, &frame, error);
        if (!result) result = frame_draw(&frame, run->pictures, &rgb, error);
        if (!result) result = frame_write_picture(run->pictures, rgb, png, run->layers ? exr : NULL, error);
        frame_free(&frame);
        free(png);
        free(exr);
        *whole = --count == 0 || !interrupt_asked();
    }

    return result;
}

SingeResult run_convert_missing(Run *run, SingeError *error) {
    SingeResult result = SINGE_OK;
    const int last = run->record.resumed_from;
    const bool fine = run_parts(run).gas_detail;

    bool stopped = false;
    for (int frame = 1; frame <= last && !result && !stopped; frame++) {
        const OutputSet missing = outputs_missing(&run->outputs, frame);
        if (missing) result = outputs_convert(&run->outputs, frame, missing, error);

        char *path = folder_gas_detail(&run->folder, frame);
        const bool coarse = fine && !folder_has(path);
        if (coarse && !result)
            result = gas_detail_convert(&run->folder, run->baker, frame, run->job.scene->gas_detail, error);
        free(path);
        if (missing || coarse) stopped = interrupt_asked();
    }

    run->converted = !result && !stopped;
    return run->converted && last ? outputs_write_roots(&run->outputs, last, error) : result;
}

// ---- from the start

SingeResult run_take_over(Run *run, SingeError *error) {
    // replace an earlier run's run.json by this run's; the earlier run can no longer be resumed
    int removed = 0;
    char *draft;
    SingeResult result = file_draft(run->folder.record, &draft, error);

    interrupt_own(draft);
    if (!result) result = record_write(&run->record, draft, &run->job, error);
    if (!result) result = folder_forget(&run->folder, &removed, error);
    interrupt_disown(draft);

    if (result) {
        file_name_target(error, draft, run->folder.record);
        file_discard(draft);
    } else {
        run->begun = true;
        result = file_publish(draft, run->folder.record, error);
    }

    if (!result) result = folder_clean(&run->folder, run_parts(run), &removed, error);
    if (removed)
        console_note(run->console, "removed %d files of an earlier run of '%s' in %s", removed, run->folder.name,
                     run->folder.path);

    for (int i = 0; i < run->file_count && !result; i++) {
        interrupt_disown(run->files[i].draft);
        result = file_publish(run->files[i].draft, run->files[i].path, error);
        run->files[i].draft = NULL;
    }

    if (!result) result = run->branch.frame ? branch_fill(run, error) : tables_begin(&run->tables, error);
    return result;
}

/// Asks on a terminal whether an earlier run may be replaced. Scripts are not asked.
static bool may_replace(const Run *run) {
    char *first = folder_ply(&run->folder, 1), answer[16] = "";
    const bool asks = folder_has(first) && isatty(STDIN_FILENO) && isatty(STDERR_FILENO);
    free(first);
    if (!asks) return true;

    fprintf(stderr, "%s has frames of an earlier run of '%s'. Replace them? [y/N] ", run->folder.path,
            run->folder.name);
    fflush(stderr);
    if (fgets(answer, sizeof answer, stdin) && (answer[0] == 'y' || answer[0] == 'Y')) return true;

    console_error(run->console, "nothing was replaced; -o names another folder, --force replaces without asking, and "
                                "--resume continues a run");
    return false;
}

// ---- both

ExitCode run_prepare(Run *run, const RunOptions *options) {
    SingeError error = {0};
    ExitCode code;

    run->folder = folder_name(options->output, run->job.scene->name);
    run->first = 1;
    const SceneCheckpoints *kept = &run->job.scene->checkpoints;
    run->keep_every = kept->every ? kept->every : kept->megabytes > 0 ? 10 : 0;

    SingeResult result = checkpoint_scene_hash(run->job.scene, &run->job.assets, &run->hash, &error);
    if (options->no_preview) console_note(run->console, "no preview");
    else if (!result) result = pictures_open(&run->job, &run->pictures, &error);
    if (!result && options->exr) result = pictures_keep_layers(run->pictures, &error);
    run->layers = options->exr;
    if (!result && run->job.scene->gas_detail > 1 && run->job.scene->sim.gas.enabled) {
        run->baker = run->pictures;
        if (!run->baker) result = pictures_open(&run->job, &run->baker, &error);
    }

    if (result) {
        console_result(run->console, &error);
        return EXIT_FAILED;
    }

    if (options->resume && access(run->folder.path, F_OK) == 0) {
        if ((code = hold_folder(run)) || (code = resume(run))) return code;
    }

    if (options->resume && !run->sim && !options->from) {
        char *lineage = branch_lineage(&run->folder);
        if (lineage)
            console_error(run->console,
                          "%s is a branch that stopped before its first checkpoint; give its --from again",
                          run->folder.path);
        free(lineage);
        if (lineage) return EXIT_INPUT;
        console_note(run->console, "no checkpoint in %s: starting from the beginning", run->folder.path);
    }

    if (!run->sim && !options->force && !may_replace(run)) return EXIT_FAILED;
    if (!run->sim && options->from && (code = branch_prepare(run, options->from))) return code;
    if (!run->sim && (code = job_build(&run->job, run->console, &run->sim))) return code;
    if ((code = hold_folder(run))) return code;

    // as far as possible all is known to be writable before anything is removed
    const FolderParts parts = run_parts(run);
    result = outputs_open(&run->outputs, &run->job, &run->folder, run->job.scene->output.formats, parts.gas, &error);
    run->outputs.scene.gas_detail = parts.gas_detail;
    if (!result) result = folder_create(&run->folder, parts, &error);
    if (!result) result = folder_sweep(&run->folder, &error);
    if (!result && run->branch.frame) result = run_take_over(run, &error);
    if (!result && !run->begun)
        result = tables_open(&run->tables, &run->folder, run->job.scene, &run->job.assets, &error);
    if (!result) return EXIT_GOOD;

    console_result(run->console, &error);
    return EXIT_FAILED;
}

// singe convert: a cache in another format, of the same bytes that a run with that format writes.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/interrupt.h"
#include "cli/lock.h"
#include "cli/outputs.h"
#include "formats/printable.h"

enum { OPT_TO, OPT_QUIET, OPT_COUNT };

static const ArgOption convert_options[OPT_COUNT] = {
    [OPT_TO] = {"to", 0, "FORMAT", "format to write (see docs/formats.md); may be repeated"},
    [OPT_QUIET] = {"quiet", 'q', NULL, "says nothing but errors"},
};

static const ArgCommand convert_command = {
    "convert", "DIR", "Writes the frames of a cache in other formats, beside it.", convert_options, OPT_COUNT,
    "Frames that are there are written again. Exit codes: 0 good, 1 failed or interrupted, 2 bad input."};

typedef struct ConvertOptions {
    const char *folder;
    OutputSet formats;
    bool quiet;
} ConvertOptions;

static bool add_format(const ArgReader *reader, const char *name, OutputSet *set) {
    for (int i = 0; i < OUTPUT_COUNT; i++) {
        if (i == OUTPUT_ply || strcmp(output_formats[i].name, name) != 0) continue;
        *set |= 1u << i;
        return true;
    }
    char known[80] = "";
    for (int i = 0; i < OUTPUT_COUNT; i++) {
        if (i == OUTPUT_ply) continue;
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", output_formats[i].name);
    }
    args_complain(reader, "--to: expected one of %s, got '%s'", known, shown(name).text);
    return false;
}

static ExitCode parse_options(int argc, char **argv, ConvertOptions *o, bool *done) {
    ArgReader reader = args_begin(&convert_command, argc, argv);
    const char *value;
    *o = (ConvertOptions){0};
    *done = false;
    for (int option; (option = args_next(&reader, &value)) != ARG_END;) {
        bool good = true;
        switch (option) {
        case OPT_TO: good = add_format(&reader, value, &o->formats); break;
        case OPT_QUIET: o->quiet = true; break;
        case ARG_OPERAND: o->folder = value; break;
        case ARG_HELP: *done = true; return EXIT_GOOD;
        default: good = false;
        }
        if (!good) return EXIT_INPUT;
    }
    if (o->formats) return EXIT_GOOD;
    args_complain(&reader, "needs --to FORMAT");
    return EXIT_INPUT;
}

static SingeResult convert_frames(const Outputs *outputs, Console *console, int last, bool *interrupted,
                                  SingeError *error) {
    const double begun = console_clock();
    SingeResult result = SINGE_OK;
    for (int frame = 1; frame <= last && !result && !*interrupted; frame++) {
        result = outputs_convert(outputs, frame, outputs->formats, error);
        console_picture(console, frame, last, (console_clock() - begun) / frame);
        *interrupted = interrupt_asked() && frame < last;
    }
    return result || *interrupted ? result : outputs_write_roots(outputs, last, error);
}

static void print_results(const Outputs *outputs) {
    for (int i = 0; i < OUTPUT_COUNT; i++) {
        if (!output_has(outputs->formats, i)) continue;
        char *path = output_formats[i].write_root ? folder_root(outputs->folder, i)
                                                  : folder_output(outputs->folder, i, 1);
        printf("%s\n", path);
        free(path);
    }
}

/// The cache is held against runs meanwhile.
static ExitCode convert(const ConvertOptions *o, Console *console, const Job *job, const Folder *folder, Lock *lock) {
    SingeError error = {0};
    Outputs outputs = {0};
    bool kept, interrupted = false;
    int first = 0, last = 0;
    ExitCode code = folder_span(folder, console, &first, &last);
    if (code) return code;
    if (first != 1) {
        console_error(console, "%s has frames from %d on only; the first is needed", folder->path, first);
        return EXIT_INPUT;
    }
    SingeResult result = lock_take(lock, folder->cache_lock, "frames", false, &kept, &error);
    if (!kept) console_warn(console, "%s: no locks there: nothing else may write it", folder->path);
    char *vdb = folder_vdb(folder, 1);
    if (!result) result = outputs_open(&outputs, job, folder, o->formats, folder_has(vdb), &error);
    free(vdb);
    if (!result) result = folder_create(folder, (FolderParts){.outputs = o->formats}, &error);
    interrupt_watch();
    if (!result) result = convert_frames(&outputs, console, last, &interrupted, &error);
    console_clear(console);
    if (result) console_result(console, &error);
    else if (!interrupted && !o->quiet) print_results(&outputs);
    outputs_close(&outputs);
    if (result) return result == SINGE_ERROR_FORMAT || result == SINGE_ERROR_MESH ? EXIT_INPUT : EXIT_FAILED;
    return interrupted ? EXIT_FAILED : EXIT_GOOD;
}

int command_convert(int argc, char **argv) {
    ConvertOptions options;
    bool done;
    ExitCode code = parse_options(argc, argv, &options, &done);
    if (code || done) return code;
    interrupt_shield();
    Console console = console_make(options.quiet);
    Job job = {0};
    Folder folder = {0};
    Lock lock = LOCK_NONE;
    SetList sets = {0};
    code = job_reopen(&job, &console, options.folder, &sets, 1);
    if (!code) {
        folder = folder_name(options.folder, job.scene->name);
        code = convert(&options, &console, &job, &folder, &lock);
    }
    lock_release(&lock);
    folder_free(&folder);
    job_close(&job);
    set_free(&sets);
    return code;
}

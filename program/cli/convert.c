// singe convert: writes a cache in another format, with the same bytes as a run that writes that format.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/interrupt.h"
#include "cli/lock.h"
#include "cli/outputs.h"
#include "common/printable.h"

typedef struct ConvertOptions {
    const char *folder;
    const char *names[16]; ///< of --to
    int name_count;
    OutputSet formats;
    unsigned singles; ///< of output_singles, a bit each
    SetList sets;
    int frames[2]; ///< the first and the last; 0: all
    bool single, plain, gas, quiet;
} ConvertOptions;

static int single_named(const char *name, bool by_option) {
    for (int i = 0; i < OUTPUT_SINGLE_COUNT; i++)
        if (output_singles[i].by_option == by_option && strcmp(output_singles[i].name, name) == 0) return i;
    return -1;
}

static bool add_format(const ArgCommand *command, const char *name, ConvertOptions *o) {
    int which = single_named(name, false);
    if (which < 0 && o->single) which = single_named(name, true);
    if (which >= 0) {
        o->singles |= 1u << which;
        return true;
    }

    if (!o->single && strcmp(name, "gas") == 0) return o->gas = true;

    for (int i = 0; i < OUTPUT_COUNT && !o->single; i++) {
        if (i == OUTPUT_ply || strcmp(output_formats[i].name, name) != 0) continue;
        o->formats |= 1u << i;
        return true;
    }

    // the formats of frames, or those that can be single files or always are
    char known[160] = "";
    for (int i = 0; i < OUTPUT_COUNT + OUTPUT_SINGLE_COUNT; i++) {
        const OutputSingle *other = i < OUTPUT_COUNT ? NULL : &output_singles[i - OUTPUT_COUNT];
        if (other ? other->by_option && !o->single : i == OUTPUT_ply || o->single) continue;
        const size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "",
                 other ? other->name : output_formats[i].name);
    }

    return args_complain(command, "--to%s: expected one of %s%s, got '%s'", o->single ? " with --single" : "", known,
                         o->single ? "" : ", gas", shown(name).text);
}

static bool read_to(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    ConvertOptions *o = field;
    (void)option;
    if (o->name_count == (int)(sizeof o->names / sizeof *o->names))
        return args_complain(command, "--to: too many formats");
    o->names[o->name_count++] = text;
    return true;
}

static const ArgOption convert_options[] = {
    {"to", 0, "FORMAT", "format to write (see docs/formats.md); may be repeated", .read = read_to},
    {"single", 0, NULL, "writes all frames into one file: `usd` or `glb`", .read = args_switch,
     offsetof(ConvertOptions, single)},
    {"plain", 0, NULL, "leaves a single GLB uncompressed, for readers without EXT_meshopt_compression",
     .read = args_switch, offsetof(ConvertOptions, plain)},
    {"set", 0, "PATH=VALUE", "sets a value of the scene (output.texture_size, gas.detail); may be repeated",
     .read = args_set, offsetof(ConvertOptions, sets)},
    {ARGS_FRAMES("writes", ", and no root file"), offsetof(ConvertOptions, frames)},
    {ARGS_QUIET(ConvertOptions)},
};

static bool convert_check(const ArgCommand *command, void *options) {
    ConvertOptions *o = options;
    for (int i = 0; i < o->name_count; i++)
        if (!add_format(command, o->names[i], o)) return false;
    if (o->frames[0] && (o->single || o->singles || o->gas))
        return args_complain(command, "--frames: not with --single, usdz, vat and gas, which need all frames");
    return o->name_count || args_complain(command, "needs --to FORMAT");
}

const ArgCommand convert_command = {
    "convert",
    "DIR",
    "Writes the frames of a cache in other formats, beside it.",
    ARGS_OPTIONS(convert_options),
    "Existing frames are overwritten. Exit codes: 0 success, 1 failed or interrupted, 2 bad input.",
    "singe convert out --to usd\n"
    "singe convert out --to glb --single\n"
    "singe convert out --to vtp --to textures --set output.texture_size=512\n"
    "singe convert out --to glb --frames 10-40",
    .operand_field = offsetof(ConvertOptions, folder),
    .check = convert_check};

const char *convert_format_word(int index) {
    if (index == 0) return "gas";
    for (int i = 0; i < OUTPUT_COUNT + OUTPUT_SINGLE_COUNT; i++) {
        const OutputSingle *single = i < OUTPUT_COUNT ? NULL : &output_singles[i - OUTPUT_COUNT];
        if (single ? single->by_option : i == OUTPUT_ply) continue; // the former are formats of frames too
        if (--index == 0) return single ? single->name : output_formats[i].name;
    }

    return NULL;
}

/// The progress over all that is written. What reads the frames several times counts once.
typedef struct ConvertProgress {
    Console *console;
    double begun;
    int last, parts; ///< frames, and how many times they are written
    int part, shown; ///< from 0; frames of all parts so far
} ConvertProgress;

static bool show_progress(void *context, int frame) {
    ConvertProgress *progress = context;
    const int done = progress->part * progress->last + frame;
    if (done > progress->shown) {
        progress->shown = done;
        console_picture(progress->console, done, progress->parts * progress->last,
                        (console_clock() - progress->begun) / done);
    }

    return !interrupt_asked();
}

/// Writes what was asked for. If Ctrl-C ends it, the result is an error.
static SingeResult convert_all(const Outputs *outputs, const ConvertOptions *o, Console *console, int first, int last,
                               SingeError *error) {
    ConvertProgress progress = {console, console_clock(), last - first + 1, o->gas + (o->formats != 0), 0, 0};
    SingeResult result = SINGE_OK;
    for (int i = 0; i < OUTPUT_SINGLE_COUNT; i++) progress.parts += (int)(o->singles >> i & 1);
    if (o->gas) result = gas_detail_write(outputs->job, outputs->folder, last, show_progress, &progress, error);

    progress.part = o->gas;
    for (int frame = first; frame <= last && !result && o->formats; frame++) {
        result = outputs_convert(outputs, frame, o->formats, error);
        if (!show_progress(&progress, frame - first + 1) && frame < last && !result) result = SINGE_ERROR_STATE;
    }
    if (!result && o->formats && !o->frames[0]) result = outputs_write_roots(outputs, last, error);

    progress.part += o->formats != 0;
    for (int i = 0; i < OUTPUT_SINGLE_COUNT && !result; i++) {
        if (!(o->singles >> i & 1)) continue;
        result = outputs_write_single(outputs, i, last, show_progress, &progress, error);
        progress.part++;
    }

    return result;
}

/// Prints a path and frees it.
static void print_path(char *path, const char *ending) {
    printf("%s%s\n", path, ending);
    free(path);
}

/// The cache is locked against runs meanwhile.
static ExitCode convert(const ConvertOptions *o, Console *console, const Job *job, const Folder *folder, Lock *lock) {
    SingeError error = {0};
    Outputs outputs = {0};
    int first = o->frames[0], last = o->frames[1];
    ExitCode code = folder_span(folder, console, &first, &last);
    if (code) return code;
    if (!o->frames[0] && first != 1) {
        console_error(console, "the frames in %s begin at %d, but the first frame is needed", folder->path, first);
        return EXIT_INPUT;
    }

    SingeResult result = lock_take(lock, folder->cache_lock, "frames", o->frames[0] > 0, console, &error);
    char *vdb = folder_vdb(folder, first), *fine = folder_gas_detail(folder, first);
    if (!result) result = outputs_open(&outputs, job, folder, o->formats, folder_has(vdb), &error);

    outputs.scene.plain = o->plain;
    outputs.scene.gas_detail = job->scene->gas_detail > 1 && (o->gas || folder_has(fine));
    free(vdb);
    free(fine);
    if (!result) result = folder_create(folder, (FolderParts){.outputs = o->formats, .gas_detail = o->gas}, &error);
    interrupt_watch();
    if (!result) result = convert_all(&outputs, o, console, first, last, &error);

    const bool interrupted = result && interrupt_asked();
    console_clear(console);
    if (result && !interrupted) console_result(console, &error);

    // the files to open
    if (!result && !o->quiet) {
        if (o->gas) print_path(folder_gas_detail(folder, 1), "");
        for (int i = 0; i < OUTPUT_SINGLE_COUNT; i++)
            if (o->singles >> i & 1) print_path(folder_single(folder, i), output_singles[i].ending ? "" : ".json");
        for (int i = 0; i < OUTPUT_COUNT; i++)
            if (output_has(o->formats, i))
                print_path(output_formats[i].write_root && !o->frames[0] ? folder_root(folder, i)
                                                                         : folder_output(folder, i, first),
                           "");
    }

    outputs_close(&outputs);
    if (!result) return EXIT_GOOD;
    return !interrupted && (result == SINGE_ERROR_FORMAT || result == SINGE_ERROR_MESH) ? EXIT_INPUT : EXIT_FAILED;
}

int command_convert(int argc, char **argv) {
    ConvertOptions options = {0};
    ExitCode code;
    if (!args_read(&convert_command, argc, argv, &options, &code)) {
        set_free(&options.sets);
        return code;
    }

    interrupt_shield();
    Console console = console_make(options.quiet);
    Job job = {0};
    Folder folder = {0};
    Lock lock = LOCK_NONE;

    code = job_reopen(&job, &console, options.folder, &options.sets, 1);
    if (!code) {
        folder = folder_name(options.folder, job.scene->name);
        code = convert(&options, &console, &job, &folder, &lock);
    }

    lock_release(&lock);
    folder_free(&folder);
    job_close(&job);
    set_free(&options.sets);
    return code;
}

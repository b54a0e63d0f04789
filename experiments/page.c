#include "experiments/page.h"

#include <stdlib.h>
#include <string.h>

#include "cli/folder.h"
#include "cli/text.h"
#include "formats/printable.h"
#include "scene/builtin.h"

extern const SceneBuiltin paper_files[]; // of the folder `paper`, embedded as they are

// ---- the command line

typedef struct Request {
    const char *folder, *name; ///< name NULL: all items
    bool quick;
    int threads;
} Request;

/// Whether there is an item of that name, or a message.
static bool take_item(const Page *page, const ArgReader *reader, int option, const char *word, Request *request) {
    request->name = word;
    for (int i = 0; i < page->count; i++)
        if (strcmp(word, page->items[i].name) == 0) return true;
    if (option != ARG_OPERAND) return args_complain(reader, "--only: there is no '%s'", shown(word).text), false;
    request->name = NULL;
    if (strcmp(word, "all") == 0) return true;
    const char *near = args_nearest(word, page->items, page->count, sizeof *page->items);
    if (near) args_complain(reader, "unknown WHAT '%s'; did you mean '%s'?", shown(word).text, near);
    else args_complain(reader, "unknown WHAT '%s': expected all, or one of the experiments", shown(word).text);
    return false;
}

/// False where the value is not good, which has been said.
static bool take(const Page *page, const ArgReader *reader, int option, const char *value, Request *request) {
    const char *name = option == ARG_OPERAND ? "only" : reader->command->options[option].name;
    if (strcmp(name, "only") == 0) return take_item(page, reader, option, value, request);
    if (strcmp(name, "quick") == 0) return request->quick = true;
    if (strcmp(name, "threads") == 0) return args_int(reader, option, value, 1, JOB_THREADS_MAX, &request->threads);
    request->folder = value;
    if (!value[0]) args_complain(reader, "--output needs a folder");
    return value[0] != 0;
}

// ---- the report

/// Lays the scenes beside the report, where `singe run` finds them.
static SingeResult write_scenes(const Lab *lab, SingeError *error) {
    SingeResult result = folder_make(lab->scenes, error);
    for (const SceneBuiltin *file = paper_files; file->name && !result; file++) {
        char *path = text_format("%s/%s", lab->scenes, file->name);
        result = file_write(path, file->bytes, file->size, error);
        free(path);
    }
    return result;
}

static SingeResult run_item(Lab *lab, const PageItem *item, SingeError *error) {
    double begun = console_clock();
    report_item(lab->report, item->name, item->heading, item->shows);
    SingeResult result = item->run(lab, error);
    if (result && error->code != result) *error = (SingeError){.code = result, .element = -1};
    char time[32];
    console_duration(console_clock() - begun, time);
    console_note(&lab->console, "%s: %s", item->name, time);
    return result;
}

/// Prints the error.
static ExitCode fail(const SingeError *error) {
    Console console = console_make(false);
    console_error(&console, "%s", error->message[0] ? error->message : singe_result_name(error->code));
    return EXIT_FAILED;
}

static ExitCode run(const Page *page, const Request *request) {
    SingeError error = {0};
    Lab lab = {.quick = request->quick, .threads = request->threads, .console = console_make(false)};
    lab.report = report_open(request->folder, page->title, page->lead, &error);
    if (!lab.report) return fail(&error);
    lab.scenes = text_format("%s/scenes", request->folder);
    SingeResult result = write_scenes(&lab, &error);
    ExitCode code = EXIT_GOOD;
    for (int i = 0; i < page->count && !result; i++)
        if (!request->name || strcmp(request->name, page->items[i].name) == 0)
            result = run_item(&lab, &page->items[i], &error);
    if (result) code = fail(&error);
    int failed = 0;
    if (report_close(lab.report, &failed, &error)) code = fail(&error);
    printf("\n%s/index.html: %s\n", request->folder, failed ? "measures fail" : "all measures hold");
    free(lab.scenes);
    return code ? code : failed ? EXIT_FAILED : EXIT_GOOD;
}

ExitCode page_run(const Page *page, const ArgCommand *command, int argc, char **argv) {
    ArgReader reader = args_begin(command, argc, argv);
    Request request = {.folder = page->folder, .threads = job_threads()};
    const char *value;
    for (int option; (option = args_next(&reader, &value)) != ARG_END;) {
        if (option == ARG_HELP) return EXIT_GOOD;
        if (option == ARG_ERROR || !take(page, &reader, option, value, &request)) return EXIT_INPUT;
    }
    return run(page, &request);
}

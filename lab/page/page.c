#include "page/page.h"

#include <pthread.h>
#include <stdlib.h>

#include "common/printable.h"
#include "scene/builtin.h"

extern const SceneBuiltin paper_files[]; // of the folder `paper`, embedded unchanged

// ---- the report

/// The items of a page, run by several threads.
typedef struct Queue {
    const Page *page;
    const PageRequest *request;
    const Lab *lab; ///< common to all
    ReportPage *report;
    pthread_mutex_t lock; ///< of all below
    int next, added;      ///< items: the next to run; the first that is not yet in the report
    Report **done;        ///< [items] run, but not yet in the report
    SingeResult result;   ///< the first failure; no further items are started
    SingeError error;
} Queue;

static bool is_wanted(const Queue *queue, int item) {
    return !queue->request->item || strcmp(queue->request->item, queue->page->items[item].name) == 0;
}

static bool is_alone(const Queue *queue, int item) {
    for (const char *const *name = queue->page->alone; *name; name++)
        if (strcmp(*name, queue->page->items[item].name) == 0) return true;
    return false;
}

static void run_item(Queue *queue, int index, int threads, bool echo) {
    const PageItem *item = &queue->page->items[index];
    const double begun = console_clock();
    SingeError error = {0};
    SingeResult result = SINGE_ERROR_MEMORY;
    Lab lab = *queue->lab;
    lab.threads = threads;
    lab.report = report_begin(queue->report, item->name, item->heading, item->shows, echo);
    if (lab.report) result = item->run(&lab, &error);

    char time[32];
    console_duration(console_clock() - begun, time);
    pthread_mutex_lock(&queue->lock);
    console_note(&lab.console, "%s: %s", item->name, time);

    if (result && !queue->result) {
        queue->result = result;
        queue->error = error;
        if (error.code != result) queue->error = (SingeError){.code = result, .element = -1};
    }

    // the items that have been run, up to the first that has not
    queue->done[index] = lab.report;
    for (; queue->added < queue->page->count; queue->added++) {
        Report *report = queue->done[queue->added];
        if (!report && is_wanted(queue, queue->added)) break;
        if (!report) continue;
        report_end(queue->report, report);
        queue->done[queue->added] = NULL;
    }

    pthread_mutex_unlock(&queue->lock);
}

/// Runs items that need not run alone, until there are none.
static void *run_together(void *context) {
    Queue *queue = context;
    for (;;) {
        int index = -1;
        pthread_mutex_lock(&queue->lock);
        for (; index < 0 && queue->next < queue->page->count && !queue->result; queue->next++)
            if (is_wanted(queue, queue->next) && !is_alone(queue, queue->next)) index = queue->next;
        pthread_mutex_unlock(&queue->lock);
        if (index < 0) return NULL;
        run_item(queue, index, 1, false);
    }
}

/// Prints the error.
static ExitCode fail(const SingeError *error) {
    Console console = console_make(false);
    console_error(&console, "%s", error->message[0] ? error->message : singe_result_name(error->code));
    return EXIT_FAILED;
}

/// Runs the items into the report, and closes it.
static ExitCode fill(Queue *queue) {
    ExitCode code = EXIT_GOOD;
    pthread_mutex_init(&queue->lock, NULL);

    // runs a page's items, each with one thread, and then those that run alone with all threads
    const int threads = queue->request->threads;
    pthread_t others[JOB_THREADS_MAX];
    int started = 0;
    if (!queue->request->item) {
        while (started < threads - 1 && !pthread_create(&others[started], NULL, run_together, queue)) started++;
        run_together(queue);
        for (int i = 0; i < started; i++) pthread_join(others[i], NULL);
    }

    for (int i = 0; i < queue->page->count && !queue->result; i++)
        if (is_wanted(queue, i) && (queue->request->item || is_alone(queue, i))) run_item(queue, i, threads, true);

    pthread_mutex_destroy(&queue->lock);
    if (queue->result) code = fail(&queue->error);
    for (int i = 0; i < queue->page->count; i++)
        if (queue->done[i]) report_end(queue->report, queue->done[i]);

    int failed = 0, missing = 0;
    SingeError error;
    if (report_page_close(queue->report, &failed, &missing, &error)) code = fail(&error);
    printf("\n%s/index.html: %s\n", queue->request->folder,
           code      ? "not complete"
           : failed  ? "measures fail"
           : missing ? "all measures hold but those that are known to miss"
                     : "all measures hold");
    return code ? code : failed ? EXIT_FAILED : EXIT_GOOD;
}

static ExitCode run(const Page *page, const PageRequest *request) {
    SingeError error = {0};
    Lab lab = {.quick = request->quick, .console = console_make(false)};
    Queue queue = {
        .page = page, .request = request, .lab = &lab, .done = calloc((size_t)page->count, sizeof *queue.done)};
    if (queue.done) queue.report = report_page_open(request->folder, page->title, page->lead, page->grade, &error);
    else error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1};

    ExitCode code = EXIT_FAILED;
    if (queue.report) {
        lab.scenes = text_format("%s/scenes", request->folder);

        // the scenes next to the report, where `singe run` finds them
        queue.result = folder_make(lab.scenes, &queue.error);
        for (const SceneBuiltin *file = paper_files; file->name && !queue.result; file++) {
            char *path = text_format("%s/%s", lab.scenes, file->name);
            queue.result = file_write(path, file->bytes, file->size, &queue.error);
            free(path);
        }

        code = fill(&queue);
        free(lab.scenes);
    } else {
        fail(&error);
    }

    free(queue.done);
    return code;
}

/// Whether there is an item of that name; otherwise prints a message.
static bool has_item(const Page *page, const ArgCommand *command, const char *name, bool only) {
    for (int i = 0; i < page->count; i++)
        if (strcmp(name, page->items[i].name) == 0) return true;
    if (only) return args_complain(command, "--only: there is no '%s'", shown(name).text);
    const char *near = args_nearest(name, page->items, page->count, sizeof *page->items);
    if (near) return args_complain(command, "unknown WHAT '%s'; did you mean '%s'?", shown(name).text, near);
    return args_complain(command, "unknown WHAT '%s': expected all, or one of the experiments", shown(name).text);
}

ExitCode page_run(const Page *page, const ArgCommand *command, int argc, char **argv) {
    PageRequest request = {.folder = page->folder, .threads = job_threads()};
    ExitCode code;
    if (!args_read(command, argc, argv, &request, &code)) return code;
    if (request.item && strcmp(request.item, "all") == 0) request.item = NULL;
    if (request.item && !has_item(page, command, request.item, false)) return EXIT_INPUT;
    if (request.only && !has_item(page, command, request.only, true)) return EXIT_INPUT;
    if (request.only) request.item = request.only;
    return run(page, &request);
}

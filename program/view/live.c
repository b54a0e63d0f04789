// A scene that burns while it is watched: `singe run` in a process of its own, into a folder of ours, and again each time
// the scene file is saved. The last run remains to be seen until the next one has its first frame.
#ifdef __linux__
#define _DEFAULT_SOURCE // nanoseconds of a file's time
#endif
#include "view/view.h"

#include <errno.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/spawn.h"
#include "cli/text.h"

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

/// Removes a folder of ours with all in it; follows no link.
static void remove_folder(const char *path) { nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS); }

static char *run_folder(const Live *live, int number) { return text_format("%s/%d", live->room, number); }

/// Remembers the file as it is now. False if it cannot be seen, as in the moment when an editor replaces it.
static bool look_at_file(Live *live, bool *changed) {
    struct stat info;
    if (stat(live->scene, &info) != 0) return false;
#ifdef __APPLE__
    const struct timespec time = info.st_mtimespec;
#else
    const struct timespec time = info.st_mtim;
#endif
    *changed =
        time.tv_sec != live->changed.tv_sec || time.tv_nsec != live->changed.tv_nsec || info.st_size != live->size;
    live->changed = time;
    live->size = info.st_size;
    return true;
}

static void start(View *view) {
    Live *live = &view->live;
    live->number++;
    free(live->folder);
    free(live->log);
    live->folder = run_folder(live, live->number);
    live->log = text_format("%s/%d.log", live->room, live->number);
    live->exit_code = -1;
    live->stopping = false;
    bool changed;
    look_at_file(live, &changed);

    char *threads = text_format("--threads=%d", live->threads);
    char *const first[] = {live->program, "run", "--no-preview", "--force", threads, "-o", live->folder};
    const size_t fixed = sizeof first / sizeof *first;
    char **command = calloc(fixed + 2 * (size_t)live->sets->count + 3, sizeof *command);
    int reason = ENOMEM;
    if (command) {
        size_t n = 0;
        for (; n < fixed; n++) command[n] = first[n];
        for (int i = 0; i < live->sets->count; i++) {
            command[n++] = "--set";
            command[n++] = (char *)live->sets->items[i];
        }
        command[n++] = "--";
        command[n++] = live->scene; // and NULL
        reason = spawn_program(command, live->log, &live->process);
    }
    if (reason) {
        live->process = 0;
        console_error(view->console, "cannot run %s: %s", live->program, strerror(reason));
    }
    free(command);
    free(threads);
}

SingeResult live_begin(View *view, SingeError *error) {
    Live *live = &view->live;
    const char *base = getenv("TMPDIR");
    live->room = text_format("%s/singe-view-XXXXXX", base && *base ? base : "/tmp");
    if (!mkdtemp(live->room)) {
        folder_fail(live->room, "make the folder", errno, error);
        free(live->room);
        live->room = NULL;
        return SINGE_ERROR_FILE;
    }
    start(view);
    return SINGE_OK;
}

void live_attend(View *view) {
    Live *live = &view->live;
    bool changed = false;
    const bool seen = look_at_file(live, &changed);
    if (seen && changed && !live->stopping) {
        live->stopping = true;
        if (live->process > 0) kill(live->process, SIGKILL); // its folder goes with it
    }

    int status;
    if (live->process > 0 && waitpid(live->process, &status, WNOHANG) == live->process) {
        live->process = 0;
        live->exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    if (live->stopping && live->process <= 0) {
        if (view->shown.number != live->number) remove_folder(live->folder); // nothing of it was shown
        start(view);
        return;
    }

    // the first frame is whole when the record is there
    if (view->shown.number == live->number) return;
    char *record = text_format("%s/run.json", live->folder);
    const bool ready = access(record, R_OK) == 0;
    free(record);
    if (!ready) return;
    const int before = view->shown.number;
    if (shown_open(view, live->folder)) return;
    view->shown.number = live->number;
    if (before) {
        char *old = run_folder(live, before);
        remove_folder(old);
        free(old);
    }
}

void live_end(View *view) {
    Live *live = &view->live;
    if (live->process > 0) {
        kill(live->process, SIGKILL);
        waitpid(live->process, NULL, 0);
    }
    if (live->room) remove_folder(live->room);
    free(live->room);
    free(live->folder);
    free(live->log);
    free(live->program);
    free(live->scene);
}

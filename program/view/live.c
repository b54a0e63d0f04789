// A scene that burns while it is watched: `singe run` in a process of its own, into a folder of ours, and again each time
// the scene file is saved. The last run remains to be seen until the next one has its first frame.
#ifdef __linux__
#define _DEFAULT_SOURCE // nanoseconds of a file's time
#endif
#include "view/view.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
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

/// Whoever holds this file's lock uses the folder. Its name is no run's.
static int open_lock(const char *folder, int flags) {
    char *path = text_format("%s/lock", folder);
    const int file = open(path, flags | O_RDWR | O_NOFOLLOW, 0600);
    free(path);
    if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    if (file >= 0) close(file);
    return -1;
}

/// Removes what views that were killed have left: our user's folders whose lock nobody holds.
static void remove_left(const char *base) {
    DIR *entries = opendir(base);
    if (!entries) return;

    for (struct dirent *entry; (entry = readdir(entries));) {
        struct stat info;
        if (strncmp(entry->d_name, "singe-view-", 11) != 0 || strlen(entry->d_name) != 17) continue;

        char *path = text_format("%s/%s", base, entry->d_name);
        const bool ours = lstat(path, &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == geteuid();
        const int lock = ours ? open_lock(path, 0) : -1;
        if (lock >= 0) {
            remove_folder(path);
            close(lock);
        }
        free(path);
    }

    closedir(entries);
}

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
    if (!base || !*base) base = "/tmp";
    remove_left(base);

    live->room = text_format("%s/singe-view-XXXXXX", base);
    if (!mkdtemp(live->room)) {
        folder_fail(live->room, "make the folder", errno, error);
        free(live->room);
        live->room = NULL;
        return SINGE_ERROR_FILE;
    }

    live->lock = open_lock(live->room, O_CREAT); // held to the end; runs inherit it, and hold it if they outlive us
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

    if (live->room) {
        remove_folder(live->room);
        if (live->lock >= 0) close(live->lock);
    }
    free(live->room);
    free(live->folder);
    free(live->log);
    free(live->program);
    free(live->scene);
}

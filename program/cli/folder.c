#include "cli/folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/text.h"

/// The files that are not of a frame.
static const struct {
    size_t field;
    const char *name;
} run_files[] = {
    {offsetof(Folder, stats), "stats.csv"},
    {offsetof(Folder, events), "events.csv"},
    {offsetof(Folder, probes), "probes.csv"},
    {offsetof(Folder, record), "run.json"},
    {offsetof(Folder, checkpoint), "checkpoint.singe"},
    {offsetof(Folder, previous_checkpoint), "checkpoint.previous.singe"},
    {offsetof(Folder, video), "preview.mp4"},
    {offsetof(Folder, sheet), "sheet.png"},
    {offsetof(Folder, gif), "preview.gif"},
    {offsetof(Folder, cache_lock), "cache.lock"},
    {offsetof(Folder, pictures_lock), "pictures.lock"},
};

enum { RUN_FILES = sizeof run_files / sizeof *run_files };

static char **run_file(Folder *folder, int file) { return (char **)(void *)((char *)folder + run_files[file].field); }

Folder folder_name(const char *path, const char *name) {
    Folder folder = {.name = text_format("%s", name)};
    folder.path = path ? text_format("%s", *path ? path : ".") : text_format("out/%s", name);
    for (size_t n = strlen(folder.path); n > 1 && folder.path[n - 1] == '/'; n--) folder.path[n - 1] = 0;
    for (int i = 0; i < RUN_FILES; i++) *run_file(&folder, i) = text_format("%s/%s", folder.path, run_files[i].name);
    return folder;
}

void folder_free(Folder *folder) {
    free(folder->path);
    free(folder->name);
    for (int i = 0; i < RUN_FILES; i++) free(*run_file(folder, i));
    *folder = (Folder){0};
}

SingeResult folder_fail(const char *path, const char *what, int reason, SingeError *error) {
    *error = (SingeError){.code = SINGE_ERROR_FILE, .stage = "output", .element = -1};

    // no link is followed, so "too many levels of symbolic links" would mislead
    const char *why = reason == ELOOP ? "it is a link" : reason ? strerror(reason) : "not a regular file";
    snprintf(error->message, sizeof error->message, "%.200s: cannot %s: %s", path, what, why);
    return SINGE_ERROR_FILE;
}

static SingeResult make_one(const char *path, SingeError *error) {
    if (mkdir(path, 0777) == 0) return SINGE_OK;
    int reason = errno;
    struct stat info;
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode)) return SINGE_OK;
        reason = ENOTDIR;
    }
    return folder_fail(path, "make the folder", reason, error);
}

SingeResult folder_make(const char *path, SingeError *error) {
    char *copy = text_format("%s", path);
    SingeResult result = SINGE_OK;

    for (char *p = copy + 1; *p && !result; p++) {
        if (*p != '/') continue;
        *p = 0;
        result = make_one(copy, error);
        *p = '/';
    }

    if (!result) result = make_one(copy, error);
    free(copy);
    return result;
}

/// A folder's name, and the ending of its files.
typedef struct Inner {
    const char *name, *ending;
} Inner;

static Inner inner(int which) {
    static const Inner others[] = {
        {"frames", ".png"}, {"gas", ".vdb"}, {"gas_detail", ".vdb"}, {"exr", ".exr"}, {"checkpoints", ".singe"}};
    if (which >= OUTPUT_COUNT) return others[which - OUTPUT_COUNT];
    return (Inner){output_formats[which].name, output_formats[which].ending};
}

static bool is_asked(FolderParts parts, int which) {
    const bool others[] = {parts.pictures, parts.gas, parts.gas_detail, parts.exr, parts.checkpoints};
    if (which >= OUTPUT_COUNT) return others[which - OUTPUT_COUNT];
    return which == OUTPUT_ply ? !parts.elsewhere : output_has(parts.outputs, which);
}

static char *frame_path(const Folder *folder, int which, int frame) {
    return text_format("%s/%s/%s.%04d%s", folder->path, inner(which).name, folder->name, frame, inner(which).ending);
}

SingeResult folder_create(const Folder *folder, FolderParts parts, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int i = 0; i < FOLDER_COUNT && !result; i++) {
        if (!is_asked(parts, i)) continue;
        struct stat info;
        char *path = text_format("%s/%s", folder->path, inner(i).name);
        if (lstat(path, &info) == 0 && S_ISLNK(info.st_mode)) result = folder_fail(path, "write", ELOOP, error);
        if (!result) result = make_one(path, error);
        if (!result && access(path, W_OK) != 0) result = folder_fail(path, "write", errno, error);
        free(path);
    }

    return result;
}

const char *folder_kind(int kind) { return kind < FOLDER_COUNT ? inner(kind).name : NULL; }

char *folder_ply(const Folder *folder, int frame) { return frame_path(folder, OUTPUT_ply, frame); }
char *folder_png(const Folder *folder, int frame) { return frame_path(folder, FOLDER_FRAMES, frame); }
char *folder_vdb(const Folder *folder, int frame) { return frame_path(folder, FOLDER_GAS, frame); }
char *folder_gas_detail(const Folder *folder, int frame) { return frame_path(folder, FOLDER_GAS_DETAIL, frame); }
char *folder_exr(const Folder *folder, int frame) { return frame_path(folder, FOLDER_EXR, frame); }
char *folder_kept(const Folder *folder, int frame) { return frame_path(folder, FOLDER_CHECKPOINTS, frame); }
char *folder_output(const Folder *folder, int format, int frame) { return frame_path(folder, format, frame); }

char *folder_root(const Folder *folder, int format) {
    return text_format("%s/%s%s", folder->path, folder->name, output_formats[format].root_ending);
}

char *folder_single(const Folder *folder, int single) {
    const OutputSingle *s = &output_singles[single];
    if (s->ending) return text_format("%s/%s%s", folder->path, folder->name, s->ending);
    return text_format("%s/%s/%s", folder->path, s->name, folder->name);
}

/// The frame of a file name NAME.0001ENDING, or 0 if it is no such name. *rest points behind the ending.
static int frame_of(const Folder *folder, const char *file, const char *ending, const char **rest) {
    size_t length = strlen(folder->name);
    if (strncmp(file, folder->name, length) != 0 || file[length] != '.') return 0;
    const char *digits = file + length + 1;
    size_t count = strspn(digits, "0123456789");
    if (count < 4 || count > 9 || (count > 4 && digits[0] == '0')) return 0;
    if (strncmp(digits + count, ending, strlen(ending)) != 0) return 0;

    *rest = digits + count + strlen(ending);
    return (int)strtol(digits, NULL, 10);
}

/// Whether this is the suffix that file_write and file_draft add until the file is whole: ".PID-NUMBER.tmp", once
/// for a draft and once more for a file written in its place.
static bool is_temporary(const char *rest) {
    for (int times = 0; times < 2; times++) {
        if (*rest++ != '.') return false;
        size_t pid = strspn(rest, "0123456789");
        if (pid == 0 || rest[pid] != '-') return false;
        rest += pid + 1;
        size_t attempt = strspn(rest, "0123456789");
        if (attempt == 0 || strncmp(rest + attempt, ".tmp", 4) != 0) return false;
        rest += attempt + 4;
        if (!*rest) return true;
    }

    return false;
}

static SingeResult remove_at(DIR *dir, const char *path, const char *name, int *removed, SingeError *error) {
    if (unlinkat(dirfd(dir), name, 0) == 0) (*removed)++;
    else if (errno != ENOENT) {
        int reason = errno;
        char *file = text_format("%s/%s", path, name);
        SingeResult result = folder_fail(file, "remove", reason, error);
        free(file);
        return result;
    }

    return SINGE_OK;
}

/// The next entry of a folder; NULL at its end, or with *result set if it cannot be read.
static struct dirent *next_entry(DIR *dir, const char *path, SingeResult *result, SingeError *error) {
    errno = 0;
    struct dirent *entry = readdir(dir);
    if (!entry && errno) *result = folder_fail(path, "list", errno, error);
    return entry;
}

/// Opens a folder of frames, and follows no link. *dir is NULL without an error if there is none.
static SingeResult open_inner(const char *path, DIR **dir, SingeError *error) {
    const int fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    *dir = fd < 0 ? NULL : fdopendir(fd);
    if (*dir) return SINGE_OK;
    const int reason = errno;
    if (fd >= 0) close(fd);
    if (reason == ENOENT || reason == ELOOP || reason == ENOTDIR) return SINGE_OK;
    return folder_fail(path, "list", reason, error);
}

/// Which frames go: of 1 to `last` those that are neither the first nor the last nor a multiple of `every`; all if it is
/// 0. Without any: half-written files of a killed run.
typedef struct Thinning {
    int every, last;
} Thinning;

static SingeResult clean_frames(const Folder *folder, int which, const Thinning *frames, int *removed,
                                SingeError *error) {
    char *path = text_format("%s/%s", folder->path, inner(which).name);
    DIR *dir;
    SingeResult result = open_inner(path, &dir, error);

    for (struct dirent *entry; dir && !result && (entry = next_entry(dir, path, &result, error));) {
        const char *rest;
        const int frame = frame_of(folder, entry->d_name, inner(which).ending, &rest);
        const bool thinned =
            frames && (!frames->every || (frame > 1 && frame < frames->last && frame % frames->every != 0));
        if (!frame || !(frames ? *rest == 0 && thinned : is_temporary(rest))) continue;
        result = remove_at(dir, path, entry->d_name, removed, error);
    }

    if (dir) closedir(dir);
    free(path);
    return result;
}

SingeResult folder_thin(const Folder *folder, int every, int last, int *removed, SingeError *error) {
    const Thinning thinning = {every, last};
    SingeResult result = SINGE_OK;
    for (int i = 0; i < FOLDER_COUNT && !result; i++)
        if (i != FOLDER_CHECKPOINTS) result = clean_frames(folder, i, &thinning, removed, error);
    return result;
}

SingeResult folder_sweep(const Folder *folder, SingeError *error) {
    int removed = 0;
    SingeResult result = SINGE_OK;
    for (int i = 0; i < FOLDER_COUNT && !result; i++) result = clean_frames(folder, i, NULL, &removed, error);
    if (result) return result;

    // half-written files other than frames
    DIR *dir = opendir(folder->path);
    if (!dir) return folder_fail(folder->path, "list", errno, error);
    for (struct dirent *entry; !result && (entry = next_entry(dir, folder->path, &result, error));) {
        const char *file = entry->d_name;
        bool ours = false;
        for (int i = 0; i < RUN_FILES; i++) {
            const size_t length = strlen(run_files[i].name);
            ours = ours || (strncmp(file, run_files[i].name, length) == 0 && is_temporary(file + length));
        }

        const size_t length = strlen(folder->name);
        for (int i = 0; i < OUTPUT_COUNT && strncmp(file, folder->name, length) == 0; i++) {
            const char *ending = output_formats[i].root_ending, *rest = file + length;
            if (ending && strncmp(rest, ending, strlen(ending)) == 0)
                ours = ours || is_temporary(rest + strlen(ending));
        }

        if (ours) result = remove_at(dir, folder->path, file, &removed, error);
    }

    closedir(dir);
    return result;
}

static SingeResult remove_file(const char *path, int *removed, SingeError *error) {
    if (unlink(path) == 0) (*removed)++;
    else if (errno != ENOENT) return folder_fail(path, "remove", errno, error);
    return SINGE_OK;
}

SingeResult folder_forget(const Folder *folder, int *removed, SingeError *error) {
    // the older one first, so that a failure leaves the newer one
    SingeResult result = remove_file(folder->previous_checkpoint, removed, error);
    return result ? result : remove_file(folder->checkpoint, removed, error);
}

SingeResult folder_clean(const Folder *folder, FolderParts parts, int *removed, SingeError *error) {
    SingeResult result = remove_file(folder->video, removed, error);
    if (!result) result = remove_file(folder->gif, removed, error);
    if (!result && !parts.events) result = remove_file(folder->events, removed, error);
    if (!result && !parts.probes) result = remove_file(folder->probes, removed, error);

    for (int i = 0; i < OUTPUT_COUNT && !result; i++) {
        if (!output_formats[i].root_ending) continue;
        char *root = folder_root(folder, i);
        result = remove_file(root, removed, error);
        free(root);
    }

    for (int i = 0; i < FOLDER_COUNT && !result; i++) {
        result = clean_frames(folder, i, &(Thinning){0}, removed, error);
        if (result || is_asked(parts, i)) continue;
        char *path = text_format("%s/%s", folder->path, inner(i).name);
        rmdir(path); // may fail: other files are in it
        free(path);
    }

    return result;
}

bool folder_has(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0;
}

SingeResult folder_link(const char *from, const char *to, SingeError *error) {
    struct stat info;
    if (lstat(from, &info) != 0) return folder_fail(from, "read", errno, error);
    if (!S_ISREG(info.st_mode)) return folder_fail(from, "read", S_ISLNK(info.st_mode) ? ELOOP : 0, error);
    if (unlink(to) != 0 && errno != ENOENT) return folder_fail(to, "replace", errno, error);
    if (link(from, to) == 0) return SINGE_OK;

    Bytes bytes = {0};
    SingeResult result = file_read(from, (SingeAllocator){0}, &bytes, error);
    if (!result) result = file_write(to, bytes.data, bytes.size, error);
    bytes_free(&bytes);
    return result;
}

SingeResult folder_each(const Folder *folder, int kind, FolderVisit *visit, void *context, SingeError *error) {
    char *path = text_format("%s/%s", folder->path, inner(kind).name);
    DIR *dir;
    SingeResult result = open_inner(path, &dir, error);
    for (struct dirent *entry; dir && !result && (entry = next_entry(dir, path, &result, error));) {
        const char *rest;
        struct stat info;
        const int frame = frame_of(folder, entry->d_name, inner(kind).ending, &rest);
        if (!frame || *rest || fstatat(dirfd(dir), entry->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0) continue;
        if (S_ISREG(info.st_mode)) visit(context, frame, (uint64_t)info.st_size, info.st_nlink > 1);
    }

    if (dir) closedir(dir);
    free(path);
    return result;
}

SingeResult folder_find(const Folder *folder, int *first, int *last, SingeError *error) {
    int lowest = INT_MAX, highest = 0;
    char *path = text_format("%s/ply", folder->path);
    DIR *dir = opendir(path);
    SingeResult result = dir || errno == ENOENT ? SINGE_OK : folder_fail(path, "list", errno, error);
    for (struct dirent *entry; dir && !result && (entry = next_entry(dir, path, &result, error));) {
        const char *rest;
        const int frame = frame_of(folder, entry->d_name, ".ply", &rest);
        if (!frame || *rest) continue;
        if (frame < lowest) lowest = frame;
        if (frame > highest) highest = frame;
    }

    if (dir) closedir(dir);
    free(path);
    *first = highest ? lowest : 0;
    *last = highest;
    return result;
}

ExitCode folder_span(const Folder *folder, Console *console, int *first, int *last) {
    int lowest, highest;
    SingeError error = {0};
    if (folder_find(folder, &lowest, &highest, &error)) {
        console_result(console, &error);
        return EXIT_FAILED;
    }

    if (highest == 0) {
        console_error(console, "no frames %s/ply/%s.*.ply", folder->path, folder->name);
        return EXIT_INPUT;
    }

    if (*first == 0) {
        *first = lowest;
        *last = highest;
    }

    if (*first >= lowest && *last <= highest) return EXIT_GOOD;

    console_error(console, "frames %d-%d are requested, but %s has %d-%d", *first, *last, folder->path, lowest,
                  highest);
    return EXIT_INPUT;
}

// Whole files: read into memory, and written under a temporary name that replaces the old file only when
// every byte is on the disk.
#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700
#endif

#include "formats/formats.h"
#include "common/store.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#ifndef PATH_MAX
#define PATH_MAX 4096
#endif
#ifndef O_CLOEXEC
#define O_CLOEXEC 0
#endif

enum { FILE_LIMIT = 0x7fffffff };

static SingeResult refuse_system(SingeError *error, const char *doing, const char *path, int reason) {
    char text[120];
    if (strerror_r(reason, text, sizeof text)) snprintf(text, sizeof text, "error %d", reason);
    return refuse(error, SINGE_ERROR_FILE, "file", -1, "%s: cannot %s: %s", short_name(path), doing, text);
}

// ---- reading

SingeResult file_read(const char *path, SingeAllocator allocator, Bytes *bytes, SingeError *error) {
    return file_read_max(path, FILE_LIMIT, allocator, bytes, error);
}

SingeResult file_read_max(const char *path, size_t max, SingeAllocator allocator, Bytes *bytes, SingeError *error) {
    memset(bytes, 0, sizeof *bytes);

    // without O_NONBLOCK a named pipe would wait here for its writer
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return refuse_system(error, "read", path, errno);

    struct stat about;
    SingeResult result = SINGE_OK;
    if (fstat(file, &about)) result = refuse_system(error, "read", path, errno);
    else if (S_ISDIR(about.st_mode)) result = refuse_system(error, "read", path, EISDIR);
    else if (!S_ISREG(about.st_mode))
        result = refuse(error, SINGE_ERROR_FILE, "file", -1, "%s: cannot read: not a regular file", short_name(path));
    else if (about.st_size > (off_t)max)
        result =
            refuse(error, SINGE_ERROR_LIMIT, "file", -1, "%s: larger than %zu MiB", short_name(path), (max + 1) >> 20);

    if (!result) {
        *bytes = (Bytes){.size = (size_t)about.st_size, .allocator = allocator};
        bytes->data = store_new(allocator, bytes->size + 1, 1);
        if (!bytes->data) result = refuse_memory(error, "file", path);
    }

    size_t done = 0;
    while (!result && done < bytes->size) {
        ssize_t count = read(file, bytes->data + done, bytes->size - done);
        if (count > 0) done += (size_t)count;
        else if (count == 0)
            result =
                refuse(error, SINGE_ERROR_FILE, "file", -1, "%s: became shorter while it was read", short_name(path));
        else if (errno != EINTR) result = refuse_system(error, "read", path, errno);
    }

    close(file);

    if (result) bytes_free(bytes);
    else bytes->data[done] = 0;
    return result;
}

size_t file_read_head(const char *path, uint8_t *bytes, size_t max) {
    struct stat about;
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return 0;

    size_t done = 0;
    ssize_t count = fstat(file, &about) || !S_ISREG(about.st_mode) ? 0 : 1;

    while (count > 0 && done < max) {
        count = read(file, bytes + done, max - done);
        if (count > 0) done += (size_t)count;
        else if (count < 0 && errno == EINTR) count = 1;
    }

    close(file);
    return done;
}

void bytes_free(Bytes *bytes) {
    store_free(bytes->allocator, bytes->data, bytes->size + 1, 1);
    memset(bytes, 0, sizeof *bytes);
}

// ---- writing

// Opens a new file next to `target`. Its name cannot be guessed: in a folder that others may write to, they could take
// all names of a sequence beforehand.
static int temporary_open(const char *target, char *temporary, size_t length, int *file) {
    for (uint32_t attempt = 0; attempt < 100; attempt++) {
        uint32_t number;
        if (getentropy(&number, sizeof number)) number = attempt;
        int needed = snprintf(temporary, length, "%s.%ld-%lu.tmp", target, (long)getpid(), (unsigned long)number);
        if (needed < 0 || (size_t)needed >= length) return ENAMETOOLONG;
        *file = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (*file >= 0) return 0;
        if (errno != EEXIST) return errno;
    }

    return EEXIST;
}

// A rename replaces a link, never its target; but it would replace a device by a regular file.
static SingeResult check_target(const char *path, SingeError *error) {
    struct stat about;
    if (!*path) return refuse_system(error, "write", "(no name)", ENOENT);
    if (strlen(path) >= PATH_MAX) return refuse_system(error, "write", path, ENAMETOOLONG);
    if (lstat(path, &about) || S_ISREG(about.st_mode) || S_ISLNK(about.st_mode)) return SINGE_OK;
    if (S_ISDIR(about.st_mode)) return refuse_system(error, "write", path, EISDIR);
    return refuse(error, SINGE_ERROR_FILE, "file", -1, "%s: cannot write: not a regular file", short_name(path));
}

static int put_in_place(const char *temporary, const char *target) {
    if (rename(temporary, target)) return errno;

    // the rename itself is durable only after the folder is flushed, too; a failure here loses no data
    char folder[PATH_MAX];
    strcpy(folder, target);
    char *slash = strrchr(folder, '/');
    if (!slash) strcpy(folder, ".");
    else slash[slash == folder] = 0;
    int file = open(folder, O_RDONLY | O_CLOEXEC);

    if (file >= 0) {
        (void)fsync(file);
        close(file);
    }

    return 0;
}

SingeResult file_write_backup(const char *path, const char *backup, const void *data, size_t size, SingeError *error) {
    char temporary[PATH_MAX + 64];
    int file = -1;
    SingeResult result = check_target(path, error);

    if (!result && backup) result = check_target(backup, error);
    if (result) return result;

    int reason = temporary_open(path, temporary, sizeof temporary, &file);
    if (!reason) {
        const uint8_t *at = data;
        while (size && !reason) {
            ssize_t count = write(file, at, size < FILE_LIMIT ? size : FILE_LIMIT);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) reason = count < 0 ? errno : EIO;
            if (count <= 0) break;
            at += count;
            size -= (size_t)count;
        }

        // EINVAL: the file system cannot flush
        if (!reason) reason = fsync(file) && errno != EINVAL && errno != ENOTSUP ? errno : 0;
        if (close(file) && !reason) reason = errno;
        if (!reason) reason = backup && rename(path, backup) && errno != ENOENT ? errno : 0;
        if (!reason) reason = put_in_place(temporary, path);
        if (reason) unlink(temporary);
    }

    return reason ? refuse_system(error, "write", path, reason) : SINGE_OK;
}

SingeResult file_write(const char *path, const void *data, size_t size, SingeError *error) {
    return file_write_backup(path, NULL, data, size, error);
}

SingeResult file_draft(const char *path, char **draft, SingeError *error) {
    int file = -1;
    *draft = NULL;
    TRY(check_target(path, error));

    char *name = malloc(PATH_MAX + 64);
    if (!name) return refuse_memory(error, "file", path);
    int reason = temporary_open(path, name, PATH_MAX + 64, &file);

    if (reason) {
        free(name);
        return refuse_system(error, "write", path, reason);
    }

    close(file);
    *draft = name;
    return SINGE_OK;
}

SingeResult file_publish(char *draft, const char *path, SingeError *error) {
    int file = open(draft, O_RDWR | O_NOFOLLOW | O_CLOEXEC); // Windows flushes no file that is only read
    int reason = file < 0 ? errno : fsync(file) && errno != EINVAL && errno != ENOTSUP ? errno : 0;
    if (file >= 0) close(file);
    if (!reason) reason = put_in_place(draft, path);

    if (reason) {
        file_discard(draft);
        return refuse_system(error, "write", path, reason);
    }
    free(draft);
    return SINGE_OK;
}

void file_name_target(SingeError *error, const char *draft, const char *path) {
    if (!draft) return;
    const char *suffix = draft + strlen(path); // messages may have only the end of a long name
    char *at = strstr(error->message, suffix);
    if (at) memmove(at, at + strlen(suffix), strlen(at + strlen(suffix)) + 1);
}

void file_discard(char *draft) {
    if (draft) unlink(draft);
    free(draft);
}

// ---- files that a file refers to

bool path_is_absolute(const char *path) {
#ifdef _WIN32
    if (path[0] && path[1] == ':') return true;
#endif
    return path[0] == '/';
}

bool path_is_inside(const char *name, const char *path) {
    const char *slash = strrchr(name, '/');
    size_t length = slash ? (size_t)(slash - name) + 1 : 0;
    if (strncmp(path, name, length) != 0 || path_is_absolute(path + length) || path[length] == 0) return false;

    // no part is ".."
    for (const char *part = path + length;;) {
        size_t size = strcspn(part, "/\\");
        if (size == 2 && part[0] == '.' && part[1] == '.') return false;
        if (!part[size]) break;
        part += size + 1;
    }

    // with links resolved it is in the folder or below
    char *folder = length ? strndup(name, length) : strdup(".");
    char *real_folder = folder ? realpath(folder, NULL) : NULL, *real = realpath(path, NULL);
    size_t kept = real_folder ? strlen(real_folder) : 0;
    if (kept == 1) kept = 0; // "/"

    bool inside = real_folder && real && strncmp(real, real_folder, kept) == 0 && real[kept] == '/';
    free(folder);
    free(real_folder);
    free(real);
    return inside;
}

#include "cli/line_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/folder.h"
#include "formats/formats.h"

SingeResult lines_append(LineFile *file, const char *text, size_t size, SingeError *error) {
    for (size_t done = 0; done < size;) {
        ssize_t n = write(file->fd, text + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            int reason = n < 0 ? errno : ENOSPC;
            if (ftruncate(file->fd, (off_t)file->size) != 0) return folder_fail(file->path, "cut", errno, error);
            return folder_fail(file->path, "write", reason, error);
        }
        done += (size_t)n;
    }
    file->size += (int64_t)size;
    return SINGE_OK;
}

/// Bytes of the header and of so many lines, or -1 if some are missing.
static int64_t kept_size(const Bytes *bytes, const char *header, uint64_t count, LineCheck *check, void *context) {
    size_t at = strlen(header);
    if (bytes->size < at || memcmp(bytes->data, header, at) != 0) return -1;
    for (uint64_t i = 0; i < count; i++) {
        const char *line = (const char *)bytes->data + at;
        const char *end = memchr(line, '\n', bytes->size - at);
        if (!end || (check && !check(i, line, (size_t)(end - line), context))) return -1;
        at += (size_t)(end - line) + 1;
    }
    return (int64_t)at;
}

SingeResult lines_cut(LineFile *file, const char *header, uint64_t count, LineCheck *check, void *context,
                      const char *what, SingeError *error) {
    Bytes bytes = {0};
    SingeResult result = file_read(file->path, (SingeAllocator){0}, &bytes, error);
    if (result) return result;
    file->size = kept_size(&bytes, header, count, check, context);
    bytes_free(&bytes);
    if (file->size < 0) {
        *error = (SingeError){.code = SINGE_ERROR_FORMAT, .stage = "resume", .element = -1};
        snprintf(error->message, sizeof error->message,
                 "%.200s does not hold %s of the checkpoint; run without --resume to start over", file->path, what);
        return SINGE_ERROR_FORMAT;
    }
    if (ftruncate(file->fd, (off_t)file->size) != 0) return folder_fail(file->path, "cut", errno, error);
    return SINGE_OK;
}

SingeResult lines_open(LineFile *file, const char *path, SingeError *error) {
    struct stat info;
    // without O_NONBLOCK a named pipe would wait here for its reader
    int flags = O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    *file = (LineFile){.path = path, .fd = open(path, flags, 0666)};
    if (file->fd < 0) return folder_fail(file->path, "write", errno == ENXIO ? 0 : errno, error);
    if (fstat(file->fd, &info) == 0 && S_ISREG(info.st_mode)) return SINGE_OK;
    lines_close(file);
    return folder_fail(file->path, "write", 0, error);
}

SingeResult lines_begin(LineFile *file, const char *header, SingeError *error) {
    if (ftruncate(file->fd, 0) != 0) return folder_fail(file->path, "write", errno, error);
    file->size = 0;
    return lines_append(file, header, strlen(header), error);
}

SingeResult lines_sync(LineFile *file, SingeError *error) {
    // EINVAL: the file system cannot flush
    if (fsync(file->fd) == 0 || errno == EINVAL || errno == ENOTSUP) return SINGE_OK;
    return folder_fail(file->path, "write", errno, error);
}

void lines_close(LineFile *file) {
    if (file->fd >= 0) close(file->fd);
    file->fd = -1;
}

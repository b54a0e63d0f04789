// The last holder of a lock removes its file. A process that has locked a file therefore checks that the file still has
// its name: if not, it was removed in between, and the new file of that name is tried.
#include "cli/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/folder.h"
#include "cli/text.h"

enum { HOLDER_SIZE = 320, ATTEMPTS = 100 };

static struct flock whole_file(bool shared) {
    return (struct flock){.l_type = shared ? F_RDLCK : F_WRLCK, .l_whence = SEEK_SET};
}

/// Another machine's processes are not known to this one's kernel; the file says "PID HOST".
static void name_holder(int fd, bool shared, char text[HOLDER_SIZE]) {
    char noted[HOLDER_SIZE - 20] = "", host[256] = "";
    struct flock found = whole_file(shared);
    ssize_t size = pread(fd, noted, sizeof noted - 1, 0);
    noted[size > 0 ? strcspn(noted, "\n") : 0] = 0;
    bool known = fcntl(fd, F_GETLK, &found) == 0 && found.l_type != F_UNLCK && found.l_pid > 0;
    const char *noted_host = strchr(noted, ' ');
    if (known && (!noted_host || atol(noted) != (long)found.l_pid)) {
        gethostname(host, sizeof host - 1);
        snprintf(text, HOLDER_SIZE, "process %ld on %s", (long)found.l_pid, host);
    } else if (noted_host) {
        snprintf(text, HOLDER_SIZE, "process %ld on %s", atol(noted), noted_host + 1);
    } else {
        snprintf(text, HOLDER_SIZE, "a process of another machine");
    }
}

static void note_holder(int fd) {
    char host[256] = "", text[HOLDER_SIZE];
    gethostname(host, sizeof host - 1);
    int length = snprintf(text, sizeof text, "%ld %s\n", (long)getpid(), host);
    // only needed for a message
    if (ftruncate(fd, 0) != 0 || pwrite(fd, text, (size_t)length, 0) < 0) return;
}

static bool still_named(int fd, const char *path) {
    struct stat locked, named;
    return fstat(fd, &locked) == 0 && lstat(path, &named) == 0 && locked.st_dev == named.st_dev &&
           locked.st_ino == named.st_ino;
}

static int open_file(const char *path, int *reason) {
    struct stat about;
    int fd = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    *reason = errno;
    if (fd < 0) return -1;
    if (fstat(fd, &about) == 0 && S_ISREG(about.st_mode)) return fd;
    *reason = EINVAL;
    close(fd);
    return -1;
}

static SingeResult refuse_held(int fd, const char *path, const char *what, bool shared, SingeError *error) {
    char holder[HOLDER_SIZE];
    const char *slash = strrchr(path, '/');
    name_holder(fd, shared, holder);
    *error = (SingeError){.code = SINGE_ERROR_STATE, .stage = "output", .element = -1};
    snprintf(error->message, sizeof error->message, "%.*s: its %s are being written by %.100s; wait for it to end",
             slash ? (int)(slash - path < 120 ? slash - path : 120) : 0, path, what, holder);
    return SINGE_ERROR_STATE;
}

SingeResult lock_take(Lock *lock, const char *path, const char *what, bool shared, bool *kept, SingeError *error) {
    *lock = LOCK_NONE;
    *kept = true;
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        int reason, fd = open_file(path, &reason);
        if (fd < 0) return folder_fail(path, "write", reason, error);
        struct flock wanted = whole_file(shared);
        if (fcntl(fd, F_SETLK, &wanted) != 0) {
            bool held = errno == EACCES || errno == EAGAIN;
            SingeResult result = held ? refuse_held(fd, path, what, shared, error) : SINGE_OK;
            if (!held) unlink(path);
            close(fd);
            *kept = held;
            return result;
        }
        if (still_named(fd, path)) {
            note_holder(fd);
            *lock = (Lock){.fd = fd, .shared = shared, .path = text_format("%s", path)};
            return SINGE_OK;
        }
        close(fd);
    }
    return folder_fail(path, "lock", EAGAIN, error);
}

void lock_release(Lock *lock) {
    if (lock->fd < 0) return;
    struct flock alone = whole_file(false); // others may share it
    if (!lock->shared || fcntl(lock->fd, F_SETLK, &alone) == 0) unlink(lock->path);
    close(lock->fd);
    free(lock->path);
    *lock = LOCK_NONE;
}

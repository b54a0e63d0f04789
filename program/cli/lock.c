// The last holder of a lock removes its file. A process that has locked a file therefore checks that the file still has
// its name: if not, it was removed in between, and the new file of that name is tried.
#include "cli/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/folder.h"
#include "cli/text.h"
#include "common/store.h"

enum { HOLDER_SIZE = 320, ATTEMPTS = 100 };

static struct flock whole_file(bool shared) {
    return (struct flock){.l_type = shared ? F_RDLCK : F_WRLCK, .l_whence = SEEK_SET};
}

/// The error of a lock that another process holds. Processes of other machines are not known to this one's kernel, but
/// the file says "PID HOST".
static SingeResult refuse_held(int fd, const char *path, const char *what, bool shared, SingeError *error) {
    char noted[HOLDER_SIZE - 20] = "", host[256] = "", holder[HOLDER_SIZE] = "a process on another machine";
    struct flock found = whole_file(shared);
    const ssize_t size = pread(fd, noted, sizeof noted - 1, 0);
    noted[size > 0 ? strcspn(noted, "\n") : 0] = 0;

    const bool known = fcntl(fd, F_GETLK, &found) == 0 && found.l_type != F_UNLCK && found.l_pid > 0;
    const char *noted_host = strchr(noted, ' ');
    if (known && (!noted_host || atol(noted) != (long)found.l_pid)) {
        gethostname(host, sizeof host - 1);
        snprintf(holder, sizeof holder, "process %ld on %s", (long)found.l_pid, host);
    } else if (noted_host) {
        snprintf(holder, sizeof holder, "process %ld on %s", atol(noted), noted_host + 1);
    }

    const char *slash = strrchr(path, '/');
    return refuse(error, SINGE_ERROR_STATE, "output", -1,
                  "%.*s: its %s are being written by %.100s; wait for it to end",
                  slash ? (int)(slash - path < 120 ? slash - path : 120) : 0, path, what, holder);
}

SingeResult lock_take(Lock *lock, const char *path, const char *what, bool shared, Console *console,
                      SingeError *error) {
    *lock = LOCK_NONE;
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        // a link, a pipe or a device in the file's place is refused
        struct stat locked, named;
        const int fd = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
        if (fd < 0) return folder_fail(path, "write", errno, error);
        if (fstat(fd, &locked) != 0 || !S_ISREG(locked.st_mode)) {
            close(fd);
            return folder_fail(path, "write", EINVAL, error);
        }

        struct flock wanted = whole_file(shared);
        if (fcntl(fd, F_SETLK, &wanted) != 0) {
            const bool held = errno == EACCES || errno == EAGAIN;
            SingeResult result = held ? refuse_held(fd, path, what, shared, error) : SINGE_OK;
            if (!held) {
                unlink(path);
                console_warn(console,
                             "%.*s: the file system does not support locks: make sure that nothing else writes there",
                             (int)(strrchr(path, '/') - path), path);
            }

            close(fd);
            return result;
        }

        // ours, if the file still has its name; who holds it is noted for messages only
        if (lstat(path, &named) == 0 && locked.st_dev == named.st_dev && locked.st_ino == named.st_ino) {
            char host[256] = "", text[HOLDER_SIZE];
            gethostname(host, sizeof host - 1);
            const int length = snprintf(text, sizeof text, "%ld %s\n", (long)getpid(), host);
            const bool noted = ftruncate(fd, 0) == 0 && pwrite(fd, text, (size_t)length, 0) == length;
            (void)noted;
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

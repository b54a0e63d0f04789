// A library to preload (LD_PRELOAD): it counts the calls of a program that may fail, from main on, and makes
// the n-th of a kind fail, alone or with all after it. Counters lie in a file that the driver reads, so they outlive
// a crash and are shared with forked children; programs that are started are left alone.
//
// SINGE_TORTURE_STATE   file of the counters, struct State
// SINGE_TORTURE_KIND    what fails: a name of `kinds`; "" for nothing
// SINGE_TORTURE_AT      n, from 1
// SINGE_TORTURE_ERROR   errno of it; "short" writes and reads half, and succeeds
// SINGE_TORTURE_ALL     1: all calls from the n-th on fail
// SINGE_TORTURE_TRAP    1: stops there, for a debugger
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

enum Kind {
    MEMORY,
    OPEN,
    READ,
    WRITE,
    SYNC,
    CLOSE,
    RENAME,
    REMOVE,
    FOLDER,
    LIST,
    CUT,
    STAT,
    PROCESS,
    THREAD,
    LOCK,
    MAP,
    KIND_COUNT
};

static const char *const kinds[KIND_COUNT] = {"memory",  "open",   "read",   "write", "sync", "close",
                                              "rename",  "remove", "folder", "list",  "cut",  "stat",
                                              "process", "thread", "lock",   "map"};

/// The results, for torture.py.
typedef struct State {
    _Atomic uint64_t failed;            ///< calls that were made to fail
    _Atomic uint64_t calls[KIND_COUNT]; ///< in the order of `kinds`
} State;

static State unshared, *state = &unshared;
static bool active; ///< main runs
static int failing = -1, failure;
static uint64_t failing_at;
static bool all_after, halves, traps;

/// Counts a call. Whether it is to fail; errno is set then.
static bool fails(enum Kind kind) {
    if (!active) return false;
    const uint64_t n = atomic_fetch_add(&state->calls[kind], 1) + 1;
    if ((int)kind != failing || n < failing_at || (n > failing_at && !all_after)) return false;
    atomic_fetch_add(&state->failed, 1);
    if (traps) raise(SIGTRAP);
    errno = failure;
    return true;
}

/// A call that is counted as `kind` and gives `bad` when it is to fail.
#define FAILING(type, name, parameters, arguments, kind, bad) \
    type name parameters {                                    \
        NEXT(name);                                           \
        return fails(kind) ? (bad) : next arguments;          \
    }

/// The next library's function of this name, as `next`.
#define NEXT(name)                 \
    static __typeof__(name) *next; \
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, #name)

// ---- memory

// clang-format off: parameters are not formatted as what they are

FAILING(void *, malloc, (size_t size), (size), MEMORY, NULL)

FAILING(void *, calloc, (size_t count, size_t size), (count, size), MEMORY, NULL)

FAILING(void *, aligned_alloc, (size_t alignment, size_t size), (alignment, size), MEMORY, NULL)

FAILING(void *, memalign, (size_t alignment, size_t size), (alignment, size), MEMORY, NULL)

FAILING(void *, realloc, (void *block, size_t size), (block, size), MEMORY, NULL)

FAILING(int, posix_memalign, (void **block, size_t alignment, size_t size), (block, alignment, size), MEMORY, ENOMEM)

FAILING(void *, mmap, (void *address, size_t size, int protection, int flags, int file, off_t offset),
        (address, size, protection, flags, file, offset), MAP, MAP_FAILED)

// ---- files

static mode_t mode_of(int flags, va_list list) { return flags & O_CREAT ? va_arg(list, mode_t) : 0; }

int open(const char *path, int flags, ...) {
    NEXT(open);
    va_list list;
    va_start(list, flags);
    const mode_t mode = mode_of(flags, list);
    va_end(list);
    return fails(OPEN) ? -1 : next(path, flags, mode);
}

int open64(const char *path, int flags, ...) {
    NEXT(open64);
    va_list list;
    va_start(list, flags);
    const mode_t mode = mode_of(flags, list);
    va_end(list);
    return fails(OPEN) ? -1 : next(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...) {
    NEXT(openat);
    va_list list;
    va_start(list, flags);
    const mode_t mode = mode_of(flags, list);
    va_end(list);
    return fails(OPEN) ? -1 : next(folder, path, flags, mode);
}

FAILING(FILE *, fopen, (const char *path, const char *mode), (path, mode), OPEN, NULL)

FAILING(int, rename, (const char *from, const char *to), (from, to), RENAME, -1)

FAILING(int, renameat, (int from_folder, const char *from, int to_folder, const char *to),
        (from_folder, from, to_folder, to), RENAME, -1)

FAILING(int, linkat, (int from_folder, const char *from, int to_folder, const char *to, int flags),
        (from_folder, from, to_folder, to, flags), RENAME, -1)

/// Pipes between processes cannot be full as disks can, so writes to them are not counted.
static bool is_pipe(int file) {
    const int reason = errno;
    const bool seeks = lseek(file, 0, SEEK_CUR) >= 0;
    errno = reason;
    return !seeks && file != STDOUT_FILENO;
}

ssize_t write(int file, const void *data, size_t size) {
    NEXT(write);
    if ((active && is_pipe(file)) || !fails(WRITE)) return next(file, data, size);
    return halves ? next(file, data, size / 2 ? size / 2 : size) : -1;
}

ssize_t read(int file, void *data, size_t size) {
    NEXT(read);
    if ((active && is_pipe(file)) || !fails(READ)) return next(file, data, size);
    return halves ? next(file, data, size / 2 ? size / 2 : size) : -1;
}

FAILING(int, fsync, (int file), (file), SYNC, -1)

// what fails to close is closed all the same, as on Linux
int close(int file) {
    NEXT(close);
    const bool bad = fails(CLOSE);
    const int reason = errno, result = next(file);
    if (!bad) return result;
    errno = reason;
    return -1;
}

int fclose(FILE *file) {
    NEXT(fclose);
    const bool bad = fails(CLOSE);
    const int reason = errno, result = next(file);
    if (!bad) return result;
    errno = reason;
    return EOF;
}

FAILING(int, unlink, (const char *path), (path), REMOVE, -1)

FAILING(int, rmdir, (const char *path), (path), REMOVE, -1)

FAILING(DIR *, opendir, (const char *path), (path), LIST, NULL)

FAILING(int, unlinkat, (int folder, const char *path, int flags), (folder, path, flags), REMOVE, -1)

FAILING(DIR *, fdopendir, (int file), (file), LIST, NULL)

FAILING(struct dirent *, readdir, (DIR * folder), (folder), LIST, NULL)

FAILING(int, mkdir, (const char *path, mode_t mode), (path, mode), FOLDER, -1)

FAILING(int, mkdirat, (int folder, const char *path, mode_t mode), (folder, path, mode), FOLDER, -1)

FAILING(int, ftruncate, (int file, off_t size), (file, size), CUT, -1)

FAILING(int, stat, (const char *path, struct stat *about), (path, about), STAT, -1)

FAILING(int, lstat, (const char *path, struct stat *about), (path, about), STAT, -1)

FAILING(int, fstat, (int file, struct stat *about), (file, about), STAT, -1)

FAILING(int, fstatat, (int folder, const char *path, struct stat *about, int flags), (folder, path, about, flags), STAT,
        -1)

FAILING(int, access, (const char *path, int mode), (path, mode), STAT, -1)

FAILING(char *, realpath, (const char *path, char *target), (path, target), STAT, NULL)

int fcntl(int file, int command, ...) {
    NEXT(fcntl);
    va_list list;
    va_start(list, command);
    void *argument = va_arg(list, void *);
    va_end(list);
    const bool locks = command == F_SETLK || command == F_SETLKW || command == F_OFD_SETLK;
    return locks && fails(LOCK) ? -1 : next(file, command, argument);
}

FAILING(int, flock, (int file, int operation), (file, operation), LOCK, -1)

// ---- processes and threads

FAILING(pid_t, fork, (void), (), PROCESS, -1)

FAILING(int, pipe, (int ends[2]), (ends), PROCESS, -1)

FAILING(int, socketpair, (int domain, int type, int protocol, int ends[2]), (domain, type, protocol, ends), PROCESS, -1)

FAILING(int, posix_spawnp,
        (pid_t * child, const char *program, const posix_spawn_file_actions_t *actions,
         const posix_spawnattr_t *attributes, char *const *arguments, char *const *environment),
        (child, program, actions, attributes, arguments, environment), PROCESS, failure)

FAILING(int, posix_spawn,
        (pid_t * child, const char *program, const posix_spawn_file_actions_t *actions,
         const posix_spawnattr_t *attributes, char *const *arguments, char *const *environment),
        (child, program, actions, attributes, arguments, environment), PROCESS, failure)

FAILING(int, pthread_create,
        (pthread_t * thread, const pthread_attr_t *attributes, void *(*work)(void *), void *context),
        (thread, attributes, work, context), THREAD, EAGAIN)

// ---- from main on

static int (*real_main)(int, char **, char **);

static ssize_t write_output(void *context, const char *data, size_t size) {
    (void)context;
    for (size_t done = 0; done < size;) {
        const ssize_t count = write(STDOUT_FILENO, data + done, size - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return 0; // what a cookie says of a failure
        done += (size_t)count;
    }

    return (ssize_t)size;
}

static int run_main(int argc, char **argv, char **environment) {
    // libc writes standard output by calls of its own, which cannot be seen from here
    static char buffer[4096];
    stdout = fopencookie(NULL, "w", (cookie_io_functions_t){.write = write_output});
    setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
    active = true;
    const int code = real_main(argc, argv, environment);
    active = false;
    return code;
}

static void read_environment(void) {
    const char *path = getenv("SINGE_TORTURE_STATE"), *kind = getenv("SINGE_TORTURE_KIND");
    const char *at = getenv("SINGE_TORTURE_AT"), *error = getenv("SINGE_TORTURE_ERROR");

    for (int i = 0; kind && i < KIND_COUNT; i++)
        if (strcmp(kind, kinds[i]) == 0) failing = i;
    failing_at = at ? strtoull(at, NULL, 10) : 0;
    halves = error && strcmp(error, "short") == 0;
    failure = error ? atoi(error) : 0;
    traps = getenv("SINGE_TORTURE_TRAP") != NULL;
    all_after = getenv("SINGE_TORTURE_ALL") != NULL;

    const int file = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file >= 0) {
        void *shared = mmap(NULL, sizeof *state, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        if (shared != MAP_FAILED) state = shared;
        close(file);
    }

    unsetenv("LD_PRELOAD");
}

int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end);

int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end) {
    int (*next)(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void), void *);
    *(void **)&next = dlsym(RTLD_NEXT, "__libc_start_main");
    real_main = main;
    read_environment();
    return next(run_main, argc, argv, init, fini, rtld_fini, stack_end);
}

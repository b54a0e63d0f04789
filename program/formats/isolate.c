// Uses fork of POSIX: other systems need another isolate_run.
//
// The child writes its answer and then an Ending to a pipe. It exits by _exit, so that nothing of the parent's is
// flushed, freed or reported twice. The parent reads until the pipe closes, and kills a child that is over its limits.
#if defined(__APPLE__)
#define _DARWIN_C_SOURCE
#elif defined(__linux__)
#define _DEFAULT_SOURCE
#endif

#include "formats/isolate.h"
#include "common/store.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#elif defined(__APPLE__)
#include <libproc.h>
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ISOLATE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define ISOLATE_SANITIZED 1
#endif
#endif
#ifndef ISOLATE_SANITIZED
#define ISOLATE_SANITIZED 0
#endif

#ifdef SINGE_COVERAGE
void __gcov_dump(void); // gcc's counters need it before _exit
#endif

enum { LOOK_MS = 20, EXIT_NO_MEMORY = 77, CRASH_STACK = 1 << 16 };

/// What follows the answer in the pipe.
typedef struct Ending {
    uint32_t magic;
    uint32_t no_memory; ///< the work failed after an allocation had failed
    SingeError error;   ///< code 0: the answer is whole
} Ending;

enum { ENDING_MAGIC = 0x53696e65 };

// ---- in the child

static void put_all(int pipe, const void *bytes, size_t size) {
    const char *at = bytes;
    while (size) {
        ssize_t count = write(pipe, at, size < 1u << 20 ? size : 1u << 20);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) _exit(1);
        at += count;
        size -= (size_t)count;
    }
}

void isolate_put(IsolateAnswer *answer, const void *bytes, size_t size) {
    int before = errno;
    put_all(answer->pipe, bytes, size);
    errno = before;
}

// Few libraries survive a failed allocation. errno still shows that one failed.
static void note_crash(int number) {
    if (errno == ENOMEM) _exit(EXIT_NO_MEMORY);
    signal(number, SIG_DFL);
    raise(number);
}

static void limit(int resource, rlim_t max) {
    struct rlimit now;
    if (getrlimit(resource, &now)) return;
    if (now.rlim_max != RLIM_INFINITY && now.rlim_max < max) max = now.rlim_max;
    now.rlim_cur = max;
    setrlimit(resource, &now);
}

#if defined(__linux__)
/// The numbers of a process's statm: pages in all and in memory. False where they cannot be read.
static bool read_pages(pid_t process, unsigned long long pages[2]) {
    char path[48], text[128];
    snprintf(path, sizeof path, "/proc/%ld/statm", (long)process);
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    ssize_t count = read(file, text, sizeof text - 1);
    close(file);
    text[count > 0 ? count : 0] = 0;
    return sscanf(text, "%llu %llu", &pages[0], &pages[1]) == 2;
}
#endif

static _Noreturn void child_main(int pipe, pid_t parent, const sigset_t *mask, IsolateWork *work, void *context,
                                 IsolateLimits limits) {
    if (pipe < 3) pipe = fcntl(pipe, F_DUPFD, 3); // the parent has closed these
    if (pipe < 0) _exit(1);
#if defined(__linux__)
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (getppid() != parent) _exit(1);

    int nowhere = open("/dev/null", O_RDWR);
    for (int i = 0; i < 3 && nowhere >= 0; i++) dup2(nowhere, i);
    if (nowhere > 2) close(nowhere);

    // the parent's handlers would set its flags here; a sanitizer's would print
    static char stack[CRASH_STACK];
    stack_t other = {.ss_sp = stack, .ss_size = sizeof stack};
    struct sigaction now, plain = {.sa_handler = SIG_DFL};

    for (int number = 1; number < NSIG; number++)
        if (sigaction(number, NULL, &now) == 0 && (number == SIGPIPE || now.sa_handler != SIG_IGN))
            sigaction(number, &plain, NULL);
    struct sigaction crash = {.sa_handler = note_crash, .sa_flags = SA_ONSTACK | SA_RESETHAND | SA_NODEFER};

    if (sigaltstack(&other, NULL) == 0) {
        sigaction(SIGSEGV, &crash, NULL);
        sigaction(SIGBUS, &crash, NULL);
        sigaction(SIGABRT, &crash, NULL);
    }

    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, (rlim_t)ceil(limits.seconds));
#if defined(__linux__)
    unsigned long long pages[2];

    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    if (!ISOLATE_SANITIZED && read_pages(getpid(), pages)) limit(RLIMIT_AS, (rlim_t)(pages[0] * page + limits.memory));
#endif

    sigprocmask(SIG_SETMASK, mask, NULL);
    IsolateAnswer answer = {pipe};
    Ending ending = {.magic = ENDING_MAGIC};
    errno = 0;

    SingeResult result = work(context, &answer, &ending.error);
    ending.no_memory = result != SINGE_OK && errno == ENOMEM;
    ending.error.code = result;
    put_all(pipe, &ending, sizeof ending);
#ifdef SINGE_COVERAGE
    __gcov_dump();
#endif
    _exit(0);
}

// ---- in the parent

/// A child process that the parent waits for.
typedef struct Child {
    const char *name;
    IsolateLimits limits;
    SingeError *error;
    pid_t process;
    int pipe;
    double waited;        ///< s so far
    double looked;        ///< s, clock at the last check
    size_t memory_before; ///< bytes at its start
} Child;

static double clock_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// Resident memory of the process, bytes; 0 if unknown.
static size_t memory_of(pid_t process) {
#if defined(__linux__)
    unsigned long long pages[2];
    return read_pages(process, pages) ? (size_t)pages[1] * (size_t)sysconf(_SC_PAGESIZE) : 0;
#elif defined(__APPLE__)
    struct rusage_info_v2 info;
    return proc_pid_rusage(process, RUSAGE_INFO_V2, (rusage_info_t *)&info) ? 0 : (size_t)info.ri_phys_footprint;
#else
    (void)process;
    return 0;
#endif
}

static SingeResult refuse_size(const Child *child) {
    return refuse(child->error, SINGE_ERROR_LIMIT, "file", (int64_t)child->limits.memory,
                  "%s: reading it takes more than %.0f MB of memory", short_name(child->name),
                  (double)child->limits.memory * 1e-6);
}

static SingeResult refuse_time(const Child *child) {
    return refuse(child->error, SINGE_ERROR_LIMIT, "file", -1, "%s: reading it takes more than %.3g s",
                  short_name(child->name), child->limits.seconds);
}

/// Checks the child's time and memory. Time during which this process was stopped does not count.
static SingeResult isolate_look(Child *child) {
    double now = clock_now(), passed = now - child->looked;
    if (passed < 1e-3 * LOOK_MS) return SINGE_OK;
    child->looked = now;
    child->waited += passed < 1 ? passed : 1;
    if (child->waited > 4 * child->limits.seconds) return refuse_time(child);

    size_t room = child->limits.memory;
    if (ISOLATE_SANITIZED) room = 2 * room + (300u << 20); // red zones, shadow, quarantine
    size_t memory = memory_of(child->process);
    return memory > child->memory_before && memory - child->memory_before > room ? refuse_size(child) : SINGE_OK;
}

/// Removes the ending from the answer and interprets it.
static SingeResult isolate_judge(const Child *child, Bytes *answer, int status) {
    const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (number == SIGXCPU) return refuse_time(child);
    if (number == SIGINT || number == SIGTERM || number == SIGHUP || number == SIGQUIT)
        return refuse(child->error, SINGE_ERROR_STATE, "file", -1, "%s: reading it was interrupted (signal %d)",
                      short_name(child->name), number);
    if (number)
        return refuse(child->error, SINGE_ERROR_FORMAT, "file", -1,
                      "%s: cannot be read: its reader crashed (signal %d)", short_name(child->name), number);
    if (WEXITSTATUS(status) == EXIT_NO_MEMORY) return refuse_size(child);

    Ending ending = {0};
    if (answer->size >= sizeof ending) memcpy(&ending, answer->data + answer->size - sizeof ending, sizeof ending);
    if (WEXITSTATUS(status) != 0 || ending.magic != ENDING_MAGIC)
        return refuse(child->error, SINGE_ERROR_FORMAT, "file", -1, "%s: cannot be read: its reader stopped (exit %d)",
                      short_name(child->name), WEXITSTATUS(status));

    answer->size -= sizeof ending;
    if (ending.error.code == SINGE_OK) return SINGE_OK;
    if (ending.no_memory) return refuse_size(child);
    ending.error.stage[sizeof ending.error.stage - 1] = 0;
    ending.error.message[sizeof ending.error.message - 1] = 0;

    SingeResult code = ending.error.code;
    if ((int)code < 0 || code > SINGE_ERROR_LIMIT) code = ending.error.code = SINGE_ERROR_FORMAT;
    if (child->error) *child->error = ending.error;
    return code;
}

static SingeResult wait_for(Child *child, Bytes *answer) {
    size_t capacity = 0;
    int status = 0;
    child->looked = clock_now();
    child->memory_before = memory_of(getpid());

    // all that the child writes
    SingeResult result = SINGE_OK;
    for (bool open = true; open && !result;) {
        struct pollfd ready = {.fd = child->pipe, .events = POLLIN};
        int count = poll(&ready, 1, LOOK_MS);
        if (count < 0 && errno != EINTR && errno != EAGAIN)
            result = refuse(child->error, SINGE_ERROR_FILE, "file", -1, "%s: cannot wait for its reader",
                            short_name(child->name));
        else result = isolate_look(child);
        if (result || count <= 0) continue;

        if (answer->size > child->limits.memory) result = refuse_size(child);
        else if (!store_grow(answer->allocator, &answer->data, &capacity, answer->size + (1u << 16) + 1, 1))
            result = refuse_memory(child->error, "file", child->name);
        if (result) break;

        ssize_t got = read(child->pipe, answer->data + answer->size, capacity - answer->size - 1);
        open = got != 0;
        if (got < 0 && errno != EINTR && errno != EAGAIN)
            result = refuse(child->error, SINGE_ERROR_FILE, "file", -1, "%s: its reader's answer cannot be read",
                            short_name(child->name));
        if (got > 0) answer->size += (size_t)got;
    }

    // the end of the child, whose pipe is closed; without a status (a parent that ignores SIGCHLD) it is 0
    while (!result && child->process) {
        const pid_t ended = waitpid(child->process, &status, WNOHANG);
        if (ended == 0 || (ended < 0 && errno == EINTR)) {
            result = isolate_look(child);
            if (!result) nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
        } else {
            child->process = 0;
            if (ended < 0) status = 0;
        }
    }

    if (!result) result = isolate_judge(child, answer, status);

    if (child->process) {
        kill(child->process, SIGKILL);
        while (waitpid(child->process, NULL, 0) < 0 && errno == EINTR) {
        }
    }

    // for bytes_free
    if (!result && !store_trim(answer->allocator, &answer->data, &capacity, answer->size + 1, 1))
        result = refuse_memory(child->error, "file", child->name);
    if (!result) answer->data[answer->size] = 0;
    else {
        store_free(answer->allocator, answer->data, capacity, 1);
        memset(answer, 0, sizeof *answer);
    }

    return result;
}

/// In a child, locks held by other threads would remain locked forever.
bool isolate_possible(void) {
#if defined(__linux__)
    struct stat tasks;
    return ISOLATE_SANITIZED || stat("/proc/self/task", &tasks) != 0 || tasks.st_nlink <= 3;
#else
    return true;
#endif
}

static SingeResult refuse_process(const char *name, SingeError *error, int reason) {
    char text[120];
    if (strerror_r(reason, text, sizeof text)) snprintf(text, sizeof text, "error %d", reason);
    return refuse(error, reason == ENOMEM ? SINGE_ERROR_MEMORY : SINGE_ERROR_FILE, "file", -1,
                  "%s: cannot start a process to read it: %s", short_name(name), text);
}

SingeResult isolate_run(const char *name, IsolateWork *work, void *context, IsolateLimits limits,
                        SingeAllocator allocator, Bytes *answer, SingeError *error) {
    *answer = (Bytes){.allocator = allocator};
    if (!isolate_possible())
        return refuse(error, SINGE_ERROR_STATE, "file", -1, "%s: cannot be read while other threads run",
                      short_name(name));

    int ends[2];
    if (pipe(ends)) return refuse_process(name, error, errno);
    for (int i = 0; i < 2; i++) fcntl(ends[i], F_SETFD, FD_CLOEXEC);
    sigset_t all, mask;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &mask); // until the child has its own handlers

    pid_t parent = getpid(), process = fork();
    int reason = errno;

    if (process == 0) {
        close(ends[0]);
        child_main(ends[1], parent, &mask, work, context, limits);
    }

    sigprocmask(SIG_SETMASK, &mask, NULL);
    close(ends[1]);
    Child child = {.name = name, .limits = limits, .error = error, .process = process, .pipe = ends[0]};
    SingeResult result = process < 0 ? refuse_process(name, error, reason) : wait_for(&child, answer);
    close(ends[0]);
    return result;
}

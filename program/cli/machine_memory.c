#if defined(__APPLE__)
#define _DARWIN_C_SOURCE
#elif defined(__linux__)
#define _DEFAULT_SOURCE
#endif

#include "cli/machine_memory.h"

#include <stddef.h>
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>
#if defined(__APPLE__)
#include <stdint.h>
#include <sys/sysctl.h>
#endif

static double physical(void) {
#if defined(_SC_PHYS_PAGES)
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (double)pages * (double)size : 0;
#elif defined(__APPLE__)
    uint64_t bytes = 0;
    size_t size = sizeof bytes;
    return sysctlbyname("hw.memsize", &bytes, &size, NULL, 0) == 0 ? (double)bytes : 0;
#else
    return 0;
#endif
}

/// A number in a file of Linux' control groups; 0 where there is none, or "max".
static double group_limit(const char *path) {
    FILE *file = fopen(path, "r");
    double bytes = 0;
    if (file && fscanf(file, "%lf", &bytes) != 1) bytes = 0;
    if (file) fclose(file);
    return bytes;
}

static double machine_lesser(double room, double limit) {
    return limit > 0 && (room <= 0 || limit < room) ? limit : room;
}

double machine_memory(void) {
    double room = physical();
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        room = machine_lesser(room, (double)limit.rlim_cur);
    if (getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        room = machine_lesser(room, (double)limit.rlim_cur);
    room = machine_lesser(room, group_limit("/sys/fs/cgroup/memory.max"));
    return machine_lesser(room, group_limit("/sys/fs/cgroup/memory/memory.limit_in_bytes"));
}

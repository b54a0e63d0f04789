#include "bench/machine.h"

#include <stdlib.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static double clock_read(clockid_t id) {
    struct timespec now;
    clock_gettime(id, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double machine_clock(void) { return clock_read(CLOCK_MONOTONIC); }
double machine_cpu_clock(void) { return clock_read(CLOCK_PROCESS_CPUTIME_ID); }

int machine_processors(void) {
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : (int)count;
}

const char *machine_name(void) {
    static char name[128];
    if (name[0]) return name;

    // "model name : NAME" of Linux
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    int found = 0;
    while (file && !found && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        line[strcspn(line, "\n")] = 0;
        found = snprintf(name, sizeof name, "%s", colon + 1 + strspn(colon + 1, " ")) > 0;
    }

    if (file) fclose(file);
    if (found) return name;

#if defined(__x86_64__)
    return "x86-64";
#elif defined(__aarch64__)
    return "aarch64";
#else
    return "unknown";
#endif
}

void *machine_resize(void *context, void *block, size_t old_size, size_t new_size) {
    MachineHeld *held = context;
    void *moved = NULL;
    if (new_size) {
        moved = realloc(block, new_size);
        if (!moved) return NULL;
    } else {
        free(block);
    }

    held->now += new_size - old_size;
    if (held->now > held->max) held->max = held->now;
    return moved;
}

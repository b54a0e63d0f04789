#include "bench/machine.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
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

// ---- cases on several threads

enum { THREADS_MAX = 64 };

typedef struct Workers {
    pthread_mutex_t lock;
    int count, next, reported;
    bool *ran;
    void (*run)(void *context, int i);
    void (*done)(void *context, int i);
    void *context;
} Workers;

static void *workers_work(void *argument) {
    Workers *w = argument;
    pthread_mutex_lock(&w->lock);
    while (w->next < w->count) {
        int i = w->next++;
        pthread_mutex_unlock(&w->lock);
        w->run(w->context, i);
        pthread_mutex_lock(&w->lock);
        w->ran[i] = true;
        while (w->reported < w->count && w->ran[w->reported]) w->done(w->context, w->reported++);
    }

    pthread_mutex_unlock(&w->lock);
    return NULL;
}

void workers_run(int count, int threads, void (*run)(void *context, int i), void (*done)(void *context, int i),
                 void *context) {
    Workers w = {.count = count, .run = run, .done = done, .context = context};
    pthread_t ids[THREADS_MAX];
    bool started[THREADS_MAX] = {false};

    w.ran = calloc((size_t)count, sizeof *w.ran);
    if (!w.ran) { // no threads: one after the other
        for (int i = 0; i < count; i++) run(context, i), done(context, i);
        return;
    }

    pthread_mutex_init(&w.lock, NULL);
    if (threads > THREADS_MAX) threads = THREADS_MAX;
    for (int t = 1; t < threads; t++) started[t] = pthread_create(&ids[t], NULL, workers_work, &w) == 0;
    workers_work(&w);
    for (int t = 1; t < threads; t++)
        if (started[t]) pthread_join(ids[t], NULL);
    pthread_mutex_destroy(&w.lock);
    free(w.ran);
}

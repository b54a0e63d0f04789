#include "bench/workers.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

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

// Each thread works on memory of its own, all start together, and the rates of all are added. The best of several
// trials counts: the machine undisturbed.
//
// The triad is McCalpin's: 12 bytes an element are counted, two reads and a write. The cache line that a write fetches
// first is not counted, as it is not counted for the solver either.
#include "bench/peaks.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>

#include "bench/fma.h"
#include "bench/machine.h"

enum { TRIALS = 5, THREADS_MAX = 64 };

static const double smallest = 24 * 1024; // bytes; the last of the sizes is 4^7 times that, 384 MB

typedef struct Worker {
    double seconds;  ///< a trial
    size_t elements; ///< of each of three arrays; 0: multiply-adds instead
    float *arrays;
    double rate; ///< operations or bytes a second, best trial
} Worker;

// chosen by glibc's loader at run time, which happens before sanitizers start
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
static void
triad(float *restrict a, const float *restrict b, const float *restrict c, size_t count) {
    for (size_t i = 0; i < count; i++) a[i] = b[i] + 0.5f * c[i];
}

static void *worker_run(void *context) {
    Worker *worker = context;
    long rounds = 1;
    for (size_t i = 0; i < 3 * worker->elements; i++) worker->arrays[i] = 1;
    for (int trial = 0; trial < TRIALS;) {
        const size_t n = worker->elements;
        double begun = machine_clock(), done = n ? 12.0 * (double)n * (double)rounds : fma_run(1000 * rounds);
        for (long round = 0; n && round < rounds; round++)
            triad(worker->arrays, worker->arrays + n, worker->arrays + 2 * n, n);
        double taken = machine_clock() - begun;
        if (taken < worker->seconds && rounds < 1L << 30) {
            rounds *= 2; // too short to be measured
            continue;
        }
        worker->rate = fmax(worker->rate, done / taken);
        trial++;
    }

    return NULL;
}

/// The rates of all threads together; 0 when out of memory.
static double run_threads(int threads, size_t elements, double seconds) {
    Worker workers[THREADS_MAX] = {0};
    pthread_t ids[THREADS_MAX];
    bool started[THREADS_MAX] = {false}, good = true;
    double rate = 0;
    for (int t = 0; t < threads; t++) {
        workers[t] = (Worker){.seconds = seconds, .elements = elements};
        if (elements) workers[t].arrays = aligned_alloc(64, 3 * elements * sizeof(float));
        if (elements && !workers[t].arrays) good = false;
    }

    for (int t = 1; good && t < threads; t++) started[t] = pthread_create(&ids[t], NULL, worker_run, &workers[t]) == 0;
    if (good) worker_run(&workers[0]);
    for (int t = 0; t < threads; t++) {
        if (started[t]) pthread_join(ids[t], NULL);
        rate += workers[t].rate;
        free(workers[t].arrays);
    }

    return good ? rate : 0;
}

bool peaks_measure(Peaks *peaks, int threads, double seconds) {
    const double trial = seconds / (2 * TRIALS * (PEAKS_SIZES + 1)); // the doubling takes as long as the trials
    *peaks = (Peaks){.gflops = 1e-9 * run_threads(threads, 0, trial)};
    for (int i = 0; i < PEAKS_SIZES; i++) {
        size_t elements = (size_t)(smallest * pow(4, i)) / 12 / 16 * 16;
        double rate = run_threads(threads, elements, trial);
        if (rate == 0) break;
        peaks->bytes[i] = 12.0 * (double)elements;
        peaks->gb_s[i] = 1e-9 * rate;
        peaks->count = i + 1;
    }

    return peaks->gflops > 0 && peaks->count > 0;
}

double peaks_stream(const Peaks *peaks, double bytes) {
    int i = 0;
    while (i < peaks->count - 1 && peaks->bytes[i + 1] <= bytes) i++;
    if (bytes <= peaks->bytes[0] || i == peaks->count - 1) return peaks->gb_s[i];
    double share = log(bytes / peaks->bytes[i]) / log(peaks->bytes[i + 1] / peaks->bytes[i]);
    return peaks->gb_s[i] + share * (peaks->gb_s[i + 1] - peaks->gb_s[i]);
}

void peaks_tell(const Peaks *peaks, BenchTable *table) {
    static const char *const names[PEAKS_SIZES] = {"stream_24k_gb_s",   "stream_96k_gb_s", "stream_384k_gb_s",
                                                   "stream_1536k_gb_s", "stream_6m_gb_s",  "stream_24m_gb_s",
                                                   "stream_96m_gb_s",   "stream_384m_gb_s"};
    table_fact(table, "fma_gflops", peaks->gflops);
    for (int i = 0; i < peaks->count; i++) table_fact(table, names[i], peaks->gb_s[i]);
}

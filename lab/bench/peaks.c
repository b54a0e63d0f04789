// Each thread works on memory of its own, all start together, and the rates of all are added. The best of several
// trials counts: the machine undisturbed.
//
// The triad is McCalpin's: 12 bytes an element are counted, two reads and a write. The cache line that a write fetches
// first is not counted, as it is not counted for the solver either.
#include "bench/peaks.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>

#include "bench/machine.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

// ---- multiply-adds
//
// Twelve independent chains x = x m + a: two units with a latency of four to five cycles need at least eight to ten.
// The numbers remain near 1 and the result is used, so that the compiler cannot remove the work.

enum { CHAINS = 12 };

static const float factor = 0.999f, addend = 0.001f;
static volatile float start = 1.01f, kept; // volatile: otherwise a compiler could compute the chain in advance

#if defined(__x86_64__) && defined(__GNUC__)
#define FMA_KERNEL(name, features, type, set1, fmadd, store, lanes)                                    \
    __attribute__((target(features))) static double name(long rounds) {                                \
        type x[CHAINS], m = set1(factor), a = set1(addend), sum = set1(0.0f);                          \
        float out[lanes];                                                                              \
        for (int c = 0; c < CHAINS; c++) x[c] = set1(start + 0.01f * (float)c);                        \
        for (long round = 0; round < rounds; round += 4) { /* four between two looks at the counter */ \
            for (int c = 0; c < CHAINS; c++) x[c] = fmadd(x[c], m, a);                                 \
            for (int c = 0; c < CHAINS; c++) x[c] = fmadd(x[c], m, a);                                 \
            for (int c = 0; c < CHAINS; c++) x[c] = fmadd(x[c], m, a);                                 \
            for (int c = 0; c < CHAINS; c++) x[c] = fmadd(x[c], m, a);                                 \
        }                                                                                              \
        for (int c = 0; c < CHAINS; c++) sum = fmadd(sum, m, x[c]);                                    \
        store(out, sum);                                                                               \
        kept = out[0];                                                                                 \
        return 2.0 * CHAINS * (lanes) * (double)rounds;                                                \
    }

FMA_KERNEL(fma_512, "avx512f", __m512, _mm512_set1_ps, _mm512_fmadd_ps, _mm512_storeu_ps, 16)
FMA_KERNEL(fma_256, "avx2,fma", __m256, _mm256_set1_ps, _mm256_fmadd_ps, _mm256_storeu_ps, 8)
#endif

/// Runs `rounds` rounds, a multiple of 4, with the processor's widest vectors; returns the number of floating-point
/// operations.
static double fma_run(long rounds) {
#if defined(__x86_64__) && defined(__GNUC__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f")) return fma_512(rounds);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return fma_256(rounds);
#endif

    // lanes that any compiler maps to the target's vectors
    enum { LANES = 4 };
    float x[CHAINS][LANES], sum = 0;
    for (int c = 0; c < CHAINS; c++)
        for (int lane = 0; lane < LANES; lane++) x[c][lane] = start + 0.01f * (float)(c + lane);
    for (long round = 0; round < rounds; round++)
        for (int c = 0; c < CHAINS; c++)
            for (int lane = 0; lane < LANES; lane++) x[c][lane] = x[c][lane] * factor + addend;
    for (int c = 0; c < CHAINS; c++)
        for (int lane = 0; lane < LANES; lane++) sum += x[c][lane];
    kept = sum;
    return 2.0 * CHAINS * LANES * (double)rounds;
}

// ---- rates

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

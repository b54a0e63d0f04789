// Twelve independent chains x = x m + a: two units with a latency of four to five cycles need at least eight to ten.
// The numbers remain near 1 and the result is used, so that the compiler cannot remove the work.
#include "bench/fma.h"

enum { CHAINS = 12 };

static const float factor = 0.999f, addend = 0.001f;
static volatile float start = 1.01f, kept; // volatile: otherwise a compiler could compute the chain in advance

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

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

double fma_run(long rounds) {
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

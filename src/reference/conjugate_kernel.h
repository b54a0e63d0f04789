// The sweeps of conjugate gradients. One file per instruction set defines CONJUGATE_KERNEL, the name of its table, and
// includes this. Every operation rounds according to IEEE 754 and lanes are added in a fixed order, so all of them give
// the same bytes.
#include <string.h>

#include "reference/conjugate.h"

#ifdef __AVX__
enum { PACK = 4 };
#else
enum { PACK = 2 };
#endif
enum { PACKS = NETWORK_LANES / PACK };

/// As many lanes as a register holds. Of natural alignment: gcc 14 for AArch64 crashes on an argument of less.
typedef double Pack __attribute__((vector_size(PACK * sizeof(double))));

static inline Pack pack_load(const double *from) {
    Pack a;
    memcpy(&a, from, sizeof a);
    return a;
}
static inline void pack_store(double *to, Pack a) { memcpy(to, &a, sizeof a); }

static inline Pack pack_gather(const double *from, const uint32_t *at) {
    Pack pack = {0};
    for (int l = 0; l < PACK; l++) pack[l] = from[at[l]];
    return pack;
}

static double pack_sum(const Pack *packs) {
    double a[NETWORK_LANES];
    for (int i = 0; i < PACKS; i++) pack_store(a + PACK * i, packs[i]);
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

/// q = A p and p . q, eight rows at a time.
static double conjugate_multiply(void *task, int begin, int end) {
    const Conjugate *job = task;
    const size_t *first = job->group->slice_first;
    const uint32_t *run = job->group->run, *column = job->group->column;
    const double *value = job->value, *p = job->p;
    Pack dot[PACKS] = {0};
    for (int slice = begin / NETWORK_LANES; slice < end / NETWORK_LANES; slice++) {
        const double *own = p + slice * NETWORK_LANES;
        Pack sum[PACKS];
        for (int i = 0; i < PACKS; i++) sum[i] = pack_load(own + PACK * i);

        for (size_t k = first[slice], last = first[slice + 1]; k < last; k++) {
            const double *entry = value + NETWORK_LANES * k;
            const uint32_t *at = column + NETWORK_LANES * k;
            if (run[k] != NETWORK_NO_RUN)
                for (int i = 0; i < PACKS; i++)
                    sum[i] += pack_load(entry + PACK * i) * pack_load(p + run[k] + PACK * i);
            else
                for (int i = 0; i < PACKS; i++) sum[i] += pack_load(entry + PACK * i) * pack_gather(p, at + PACK * i);
        }

        for (int i = 0; i < PACKS; i++) {
            pack_store(job->q + slice * NETWORK_LANES + PACK * i, sum[i]);
            dot[i] += pack_load(own + PACK * i) * sum[i];
        }
    }

    return pack_sum(dot);
}

/// r -= alpha q and r . r.
static double conjugate_reduce(void *task, int begin, int end) {
    const Conjugate *job = task;
    Pack dot[PACKS] = {0};
    for (int row = begin; row < end; row += NETWORK_LANES)
        for (int i = 0; i < PACKS; i++) {
            double *r = job->r + row + PACK * i;
            Pack rest = pack_load(r) - job->alpha * pack_load(job->q + row + PACK * i);
            pack_store(r, rest);
            dot[i] += rest * rest;
        }

    return pack_sum(dot);
}

/// x += alpha p, p = r + beta p.
static void conjugate_advance(void *task, int begin, int end) {
    const Conjugate *job = task;
    double *restrict x = job->x, *restrict p = job->p;
    const double *restrict r = job->r;
    for (int row = begin; row < end; row++) {
        x[row] += job->alpha * p[row];
        p[row] = r[row] + job->beta * p[row];
    }
}

const ConjugateKernel CONJUGATE_KERNEL = {conjugate_multiply, conjugate_reduce, conjugate_advance};

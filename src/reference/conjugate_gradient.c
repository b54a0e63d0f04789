// Conjugate gradients (Hestenes and Stiefel 1952) on a matrix of unit diagonal, from zero:
//
//   p = r = b;  until |r| is small:  q = A p,  alpha = r.r / p.q,  r -= alpha q,  beta = r.r / (r.r before),
//                                    x += alpha p,  p = r + beta p
//
// in three sweeps an iteration: the product with its dot, r with its dot, and x with p. The scaling to a unit diagonal
// is Jacobi's preconditioner, folded into the matrix. Sums run in NETWORK_LANES lanes over blocks of POOL_BLOCK rows:
// the same for any number of threads and any width of the processor's registers.
#include "reference/conjugate.h"

#include "common/cpu.h"

#include <math.h>

static void conjugate_begin(void *task, int begin, int end) {
    const Conjugate *job = task;
    for (int row = begin; row < end; row++) {
        job->x[row] = 0;
        job->p[row] = job->r[row];
    }
}

const ConjugateKernel *conjugate_choose(SingeInstructions instructions) {
#ifdef SINGE_X86_LEVELS
    bool asked = instructions == SINGE_INSTRUCTIONS_BEST || instructions == SINGE_INSTRUCTIONS_X86_V3 ||
                 instructions == SINGE_INSTRUCTIONS_X86_V4;
    if (asked && cpu_has(SINGE_INSTRUCTIONS_X86_V3)) return &conjugate_v3;
#endif
    (void)instructions;
    return &conjugate_plain;
}

ProjectionReport conjugate_gradient(Network *network, uint32_t group, Pool *pool, double square, double enough) {
    const ConjugateKernel *kernel = network->kernel;
    Conjugate job = {&network->groups[group],
                     network->value,
                     network->solution,
                     network->residual,
                     network->direction,
                     network->product,
                     0,
                     0};
    int rows = (int)job.group->padded;
    ProjectionReport report = {0};

    // iterate until the residual is small enough
    double rest = square;
    pool_for(pool, rows, POOL_BLOCK, conjugate_begin, &job);

    while (rest > enough && report.iterations < network->rules.iterations && !pool_cancelled(pool)) {
        double curvature = pool_sum(pool, rows, kernel->multiply, &job, network->partial);
        report.iterations++;
        if (!(curvature > 0) || !isfinite(curvature)) {
            report.broken = true;
            break;
        }

        job.alpha = rest / curvature;
        double before = rest;
        rest = pool_sum(pool, rows, kernel->reduce, &job, network->partial);
        job.beta = rest / before;
        pool_for(pool, rows, POOL_BLOCK, kernel->advance, &job);
    }

    // residual and cost
    report.broken = report.broken || !isfinite(rest);
    report.residual = square > 0 ? sqrt(rest / square) : 0;
    double entries = (double)ellpack_entries(job.group), iterations = report.iterations;
    report.flops = iterations * (2 * entries + 10.0 * rows);
    report.bytes = iterations * (12 * entries + 80.0 * rows);
    return report;
}

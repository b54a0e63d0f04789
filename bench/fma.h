// Chains of multiply-adds that keep a core's floating-point units as busy as can be.
#ifndef BENCH_FMA_H
#define BENCH_FMA_H

/// Runs `rounds` rounds, a multiple of 4, with the widest vectors that this processor has; the floating-point
/// operations done.
double fma_run(long rounds);

#endif

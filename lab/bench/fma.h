// Chains of multiply-adds that keep a core's floating-point units fully busy.
#ifndef BENCH_FMA_H
#define BENCH_FMA_H

/// Runs `rounds` rounds, a multiple of 4, with the processor's widest vectors; returns the number of floating-point
/// operations.
double fma_run(long rounds);

#endif

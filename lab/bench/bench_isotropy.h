#ifndef BENCH_ISOTROPY_H
#define BENCH_ISOTROPY_H

#include "bench/bench.h"

/// How much the folds of a burning sheet follow the mesh: the same burn on a grid and on the grid turned by 45 degrees.
BenchFn bench_isotropy;

#endif

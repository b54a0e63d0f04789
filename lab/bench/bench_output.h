#ifndef BENCH_OUTPUT_H
#define BENCH_OUTPUT_H

#include "bench/bench.h"

/// Frames of 25,000 vertices in every format: milliseconds of the program and of the system, bytes.
BenchFn bench_output;

#endif

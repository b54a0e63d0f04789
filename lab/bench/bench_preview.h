#ifndef BENCH_PREVIEW_H
#define BENCH_PREVIEW_H

#include "bench/bench.h"

/// Pictures of 1280 x 720 with 16 samples of a burning sheet: seconds of processor time for each.
BenchFn bench_preview;

#endif

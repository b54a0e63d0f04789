// Peak rates of the machine: fused multiply-adds from registers, and streaming through arrays.
#pragma once

#include "bench/table.h"

/// Total sizes of the triad's three arrays, each four times the previous one: from a first-level cache to beyond the
/// last level.
enum { PEAKS_SIZES = 8 };

typedef struct Peaks {
    double gflops;             ///< single precision; a fused multiply-add is two operations
    double bytes[PEAKS_SIZES]; ///< working set a thread, ascending
    double gb_s[PEAKS_SIZES];  ///< of the triad a = b + s c at that working set, a read or a write counted once
    int count;
} Peaks;

/// Measures with `threads` threads at once, within about `seconds`. False when out of memory.
bool peaks_measure(Peaks *peaks, int threads, double seconds);

/// GB/s at a working set of so many bytes a thread.
double peaks_stream(const Peaks *peaks, double bytes);

/// Adds them to a table's facts.
void peaks_tell(const Peaks *peaks, BenchTable *table);

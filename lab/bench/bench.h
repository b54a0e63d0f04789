// The measurements behind `singe bench`. Each fills the given table, whose `text` is set, and returns the error that
// stopped it, if any. A simulation that diverges is a result, not a failure.
#pragma once

#include "bench/options.h"
#include "bench/table.h"

typedef SingeResult BenchFn(const BenchOptions *options, BenchTable *table, SingeError *error);

// What each measures: the table in bench_command.c.
BenchFn bench_swing, bench_hang_and_shrink, bench_tear, bench_dynamics, bench_step, bench_surface, bench_heap,
    bench_collapse, bench_stack, bench_wind, bench_memory, bench_front, bench_spread, bench_output, bench_preview,
    bench_compare, bench_stability, bench_look, bench_fold, bench_isotropy, bench_plate, bench_spectrum;

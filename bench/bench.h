// The measurements behind `singe bench`. Each fills the table that it is given, whose `text` is set, and returns
// what stopped it. A simulation that diverges is a result, not a failure.
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include "bench/options.h"
#include "bench/table.h"

typedef SingeResult BenchFn(const BenchOptions *options, BenchTable *table, SingeError *error);

/// A sheet falls from the horizontal and swings, held at corner points: cost, strain and motion.
BenchFn bench_swing;
/// The swinging sheet made of triangles, as mesh_make makes quads of them: cells, strands, strain and motion.
BenchFn bench_mesh;
/// A sheet that hangs and shrinks to 0.8 of its size: cost, strain, speed.
BenchFn bench_hang_and_shrink;

/// A strip with a weak line that is pulled apart: the load at which it breaks, over cell size and time step.
BenchFn bench_tear;

/// The stage dynamics and its projection by size, against the machine's peaks.
BenchFn bench_dynamics;
/// Whole burning steps with a sphere and the ground, held against a limit if one is given (SINGE_ERROR_LIMIT).
BenchFn bench_step;
/// One stage of burning steps.
BenchFn bench_heat;
BenchFn bench_ablate;
/// The drawn surface of a burning sheet by detail: triangles and cost.
BenchFn bench_surface;
/// A cloth that falls over a sphere in folds: cost of contact, strain.
BenchFn bench_heap;
BenchFn bench_collapse;
/// Bytes a spring.
BenchFn bench_memory;

/// The burning front of options->materials on strips, beside what sources say.
BenchFn bench_front;
/// How fast fire runs level, down and up in the gas that rises from it.
BenchFn bench_spread;

/// The paper's solver and ours on the same trajectories.
BenchFn bench_compare;
/// The same run with each set of instructions.
BenchFn bench_width;
/// Over thickness, resolution and time step: does it hold?
BenchFn bench_stability;
/// How much the look depends on time step, substeps and resolution.
BenchFn bench_look;
/// What a strip that was folded and let go keeps of the fold.
BenchFn bench_fold;
/// The spectrum of the wrinkles of a burning edge, and how much its peak depends on time step and resolution.
BenchFn bench_spectrum;

#endif

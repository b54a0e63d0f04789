// The measurements behind `singe bench`. Each fills the given table, whose `text` is set, and returns the error that
// stopped it, if any. A simulation that diverges is a result, not a failure.
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include "bench/options.h"
#include "bench/table.h"

typedef SingeResult BenchFn(const BenchOptions *options, BenchTable *table, SingeError *error);

/// A sheet falls from the horizontal and swings, held at corner points: cost, strain and motion.
BenchFn bench_swing;
/// The swinging sheet made from triangles, which mesh_make joins to quads: cells, strands, strain and motion.
BenchFn bench_mesh;
/// A hanging sheet that shrinks to 0.8 of its size: cost, strain, speed.
BenchFn bench_hang_and_shrink;

/// A strip with a weak line is pulled apart: the load at which it breaks, over cell size and time step.
BenchFn bench_tear;

/// The stage dynamics and its projection by size, against the machine's peaks.
BenchFn bench_dynamics;
/// Whole burning steps with a sphere and the ground; SINGE_ERROR_LIMIT if they exceed a given limit.
BenchFn bench_step;
/// The drawn surface of a burning sheet by detail: triangles and cost.
BenchFn bench_surface;
/// A cloth falls over a sphere in folds: cost of contact, strain.
BenchFn bench_heap;
BenchFn bench_collapse;
/// Sheets fall on top of each other over a sphere: cost of the crowd, strain, crossings, memory.
BenchFn bench_stack;
/// A sheet held at two corners in gusts of several speeds: processor time, over that of the first.
BenchFn bench_wind;
/// Bytes per spring.
BenchFn bench_memory;

/// Frames of 25,000 vertices in every format: milliseconds of the program and of the system, bytes.
BenchFn bench_output;
/// Pictures of a burning sheet at 1280 x 720 with 16 samples: seconds of processor time for each.
BenchFn bench_preview;
/// Pictures at 960 x 540: seconds, and their error against 256 samples, and its change from frame to frame.
BenchFn bench_picture;

/// The burning front of options->materials on strips, compared with sources.
BenchFn bench_front;
/// The speed of fire that spreads level, down and up in its own rising gas.
BenchFn bench_spread;

/// The paper's solver and ours on the same trajectories.
BenchFn bench_compare;
/// The same run with each instruction set.
BenchFn bench_width;
/// Stability over thickness, resolution and time step.
BenchFn bench_stability;
/// The dependence of the appearance on time step, substeps and resolution.
BenchFn bench_look;
/// The angle that remains after a strip was folded and released.
BenchFn bench_fold;
/// How much the folds of a burning sheet follow the mesh: the same burn on a grid and on the grid turned by 45 degrees.
BenchFn bench_isotropy;
/// Bending of strips and discs by the direction of their mesh, against plate theory.
BenchFn bench_plate;
/// The spectrum of the wrinkles of a burning edge, and the dependence of its peak on time step and resolution.
BenchFn bench_spectrum;

/// Draws tables of costs; takes the arguments after "bench plot" and returns an exit code.
int bench_plot(int argc, char **argv);

#endif

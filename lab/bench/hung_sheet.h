// The sheet that most measurements use: 1 m x 1 m, 0.1 kg/m2, n x n cells, no drag, no damping, held at corners.
#pragma once

#include "bench/bench.h"

typedef struct BenchSetup {
    BenchState state;
    int cells;       ///< a side
    int pins;        ///< corners held, 1 or 2
    float thickness; ///< m
    float time_step; ///< s
    float shrink;    ///< final ratio of lengths in BENCH_SHRINK
    bool rigid;      ///< inextensible springs as in eq 16: no compliance
    int threads;
    SingeInstructions instructions;
    SingeSolverDef solver;
    const SingeSheetDef *shape; ///< its vertices and cells are used, in the xy plane; NULL: the grid
} BenchSetup;

/// Frames a second at which trajectories are sampled.
enum { BENCH_FPS = 24 };

/// A setup with the options' solver, threads and time step: `steps` per frame.
BenchSetup sheet_setup(const BenchOptions *options, BenchState state, int steps);

/// Adds only the sheet, flat in the xy plane or upright in the xz plane, `cells` per side.
SingeResult sheet_add(SingeSim *sim, SingeSheetDef *def, int cells, float size, bool upright, SingeSheetId *id);

/// The same for a rectangle of cells[0] by cells[1] cells.
SingeResult sheet_add_strip(SingeSim *sim, SingeSheetDef *def, const int cells[2], const float sides[2], bool upright,
                            SingeSheetId *id);

/// Only weight acts on a sheet of this material, and no heat flows.
void sheet_inert(SingeMaterialDef *material);

/// Takes over why a simulation could not be built, and destroys it: *sim is NULL. Returns the result.
SingeResult bench_give_up(SingeSim **sim, SingeResult result, SingeError *error);

/// Creates a simulation and commits it. On failure *sim is NULL.
SingeResult sheet_build(const BenchSetup *setup, SingeSim **sim, SingeError *error);

// A burning sheet: it hangs upright from two corners while a hot ball crosses it. Its lower edge lies on the ground,
// and a sphere touches it from behind.

/// Creates and commits it; `pace` is the fire's. On failure *sim is NULL.
SingeResult burning_build(const BenchOptions *options, const SingeAllocator *allocator, double springs, float pace,
                          SingeSim **sim, SingeError *error);

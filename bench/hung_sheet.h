// The sheet that most measurements use: 1 m x 1 m, 0.1 kg/m2, n x n cells, no drag, no damping, held at corners.
#ifndef BENCH_HUNG_SHEET_H
#define BENCH_HUNG_SHEET_H

#include "bench/options.h"

typedef struct BenchSetup {
    BenchState state;
    int cells;       ///< a side
    int pins;        ///< corners held, 1 or 2
    float thickness; ///< m
    float time_step; ///< s
    float shrink;    ///< what the lengths end at in BENCH_SHRINK
    float damping;   ///< 1/s
    float approach;  ///< m that the second patch moves towards the first within half a second (BENCH_HANG)
    bool rigid;      ///< springs do not give, as in eq 16: no compliance
    int threads;
    SingeInstructions instructions;
    SingeSolverDef solver;
    const SingeSheetDef *shape; ///< whose vertices and cells are taken, in the xy plane; NULL: the grid
} BenchSetup;

/// Frames a second at which trajectories are sampled.
enum { BENCH_FPS = 24 };

/// A setup with the solver, threads and time step that the options ask for: `steps` a frame.
BenchSetup sheet_setup(const BenchOptions *options, BenchState state, int steps);

/// Adds the sheet alone, flat in the xy plane or upright in the xz plane, `cells` a side.
SingeResult sheet_add(SingeSim *sim, SingeSheetDef *def, int cells, float size, bool upright, SingeSheetId *id);

/// The same for a rectangle of cells[0] by cells[1] cells.
SingeResult sheet_add_strip(SingeSim *sim, SingeSheetDef *def, const int cells[2], const float sides[2], bool upright,
                            SingeSheetId *id);

/// Nothing but the sheet's own weight acts on what is of this material, and no heat flows.
void sheet_inert(SingeMaterialDef *material);

/// Makes a simulation and commits it. On failure *sim is NULL.
SingeResult sheet_build(const BenchSetup *setup, SingeSim **sim, SingeError *error);

#endif

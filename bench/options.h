// What a measurement is asked for. Zero, or an empty list, means the measurement's own default.
#ifndef BENCH_OPTIONS_H
#define BENCH_OPTIONS_H

#include <stdbool.h>

#include "singe/singe.h"

enum { BENCH_LIST_MAX = 16 };

typedef struct BenchList {
    int count;
    double values[BENCH_LIST_MAX];
} BenchList;

/// What a sheet does while it is measured.
typedef enum BenchState {
    BENCH_SWING,  ///< held at corner points, lets go horizontally
    BENCH_SHRINK, ///< hangs from two corner patches, all target lengths shrink to 0.8 of themselves within a second
    BENCH_HANG,   ///< hangs from two corner patches that come nearer to each other
} BenchState;

/// What sheets are cut to.
typedef enum BenchOutline { BENCH_ALL_OUTLINES, BENCH_SQUARE, BENCH_DISC } BenchOutline;

/// A material, and what sources say of its fire, from .. to; 0 and 0 where they say nothing.
typedef struct BenchMaterial {
    const char *name;
    SingeMaterialDef def;
    bool calibrated;      ///< it was made to agree with them
    float speed[2];       ///< m/s of a front that runs level
    float temperature[2]; ///< K, hottest
    float residue[2];     ///< share of the mass
} BenchMaterial;

typedef struct BenchOptions {
    BenchList cells;     ///< a side of the square sheet
    BenchList thickness; ///< m
    BenchList springs;
    BenchList curvature; ///< 1/m, limits of it; 0: none
    BenchList seeds;     ///< of noise
    BenchOutline outline;
    bool creases; ///< sharp bends stay
    bool contact; ///< with themselves
    BenchState state;
    SingeSolverMethod solver;
    SingeInstructions instructions;
    int pins;  ///< 1 or 2 corners
    int steps; ///< per frame, or steps to time
    int substeps, projections;
    int threads;
    double time;      ///< s
    double smoothing; ///< 1/s; below 0: the measurement's default
    double detail;    ///< m, of the drawn surface; 0: cells as they are
    double limit_ms;  ///< 0: none
    bool quick;
    int material_count;
    const BenchMaterial *materials;
} BenchOptions;

static inline BenchOptions bench_options(void) { return (BenchOptions){.threads = 1, .smoothing = -1}; }

/// The list asked for, or these defaults.
BenchList bench_list(const BenchList *asked, int count, const double *defaults);

/// Cells a side of a square sheet with about so many springs, ten a cell.
int options_cells(double springs);

const char *options_solver_name(SingeSolverMethod method);
const char *options_instructions_name(SingeInstructions instructions);

#endif

// The options of a measurement. Zero, or an empty list, means the measurement's own default.
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "scene/words.h"
#include "singe/singe.h"

enum { BENCH_LIST_MAX = 16 };

typedef struct BenchList {
    int count;
    double values[BENCH_LIST_MAX];
} BenchList;

/// The motion of a measured sheet.
typedef enum BenchState {
    BENCH_SWING,  ///< held at corner points, released from the horizontal
    BENCH_SHRINK, ///< hangs from two corner patches; all target lengths shrink to 0.8 within a second
    BENCH_HANG,   ///< hangs from two corner patches that move closer
} BenchState;

/// The outline of sheets.
typedef enum BenchOutline { BENCH_ALL_OUTLINES, BENCH_SQUARE, BENCH_DISC } BenchOutline;

/// A material, and the ranges of its fire's values in sources; 0 and 0 if unknown.
typedef struct BenchMaterial {
    const char *name;
    SingeMaterialDef def;
    bool calibrated;      ///< it is calibrated to them
    float speed[2];       ///< m/s of a level front
    float temperature[2]; ///< K, hottest
    float residue[2];     ///< share of the mass
} BenchMaterial;

typedef struct BenchOptions {
    BenchList cells;     ///< per side of the square sheet
    BenchList sheets;    ///< on top of each other
    BenchList thickness; ///< m
    BenchList springs;
    BenchList curvature; ///< 1/m, limits of it; 0: none
    BenchList seeds;     ///< of noise
    BenchOutline outline;
    bool creases; ///< sharp bends are plastic
    bool contact; ///< with themselves
    double red;   ///< m/N, compliance of red springs; 0: the material's
    BenchState state;
    SingeSolverMethod solver;
    SingeInstructions instructions;
    int pins;  ///< 1 or 2 corners
    int steps; ///< per frame, or steps to time
    int substeps, projections;
    int threads;
    double time;      ///< s
    double smoothing; ///< 1/s; below 0: the measurement's default
    double detail;    ///< m, of the drawn surface; 0: plain cells
    double limit_ms;  ///< 0: none
    bool quick;
    FILE *drawing; ///< where the measurement is drawn, SVG, or NULL
    int material_count;
    const BenchMaterial *materials;
} BenchOptions;

static inline BenchOptions bench_options(void) { return (BenchOptions){.threads = 1, .smoothing = -1}; }

/// The given list, or these defaults.
BenchList bench_list(const BenchList *asked, int count, const double *defaults);

/// Cells per side of a square sheet with about so many springs, ten per cell.
int options_cells(double springs);

/// As asked for, or 3: fewer than the default, so that a step's cost compares with that of earlier versions.
int options_substeps(const BenchOptions *options);

// What `singe bench` measures, and with which options. Zero, or an empty list, means the measurement's own default.
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "bench/table.h"
#include "cli/args.h"
#include "cli/cli.h"
#include "common/store.h"
#include "scene/scene.h"
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
    bool creases;   ///< sharp bends are plastic
    bool contact;   ///< with themselves
    bool isotropic; ///< with braces
    double red;     ///< m/N, compliance of red springs; 0: the material's
    BenchState state;
    SingeSolverMethod solver;
    SingeInstructions instructions;
    int pins;  ///< 1 or 2 corners
    int steps; ///< per frame, or steps to time
    int substeps, projections;
    int threads;
    double time;      ///< s
    double start;     ///< of the solver; below 0: the measurement's default
    double smoothing; ///< 1/s; below 0: the measurement's default
    double detail;    ///< m, of the drawn surface; 0: plain cells
    double limit_ms;  ///< 0: none
    bool quick;
    FILE *drawing; ///< where the measurement is drawn, SVG, or NULL
    int material_count;
    const BenchMaterial *materials;
} BenchOptions;

static inline BenchOptions bench_options(void) { return (BenchOptions){.threads = 1, .smoothing = -1, .start = -1}; }

/// The given list, or these defaults.
BenchList bench_list(const BenchList *asked, int count, const double *defaults);

/// Cells per side of a square sheet with about so many springs, ten per cell.
int options_cells(double springs);

/// As asked for, or 3: fewer than the default, so that a step's cost compares with that of earlier versions.
int options_substeps(const BenchOptions *options);

/// Steps of a frame of 1/24 s: as asked for, or 20.
int options_steps(const BenchOptions *options);

// ---- command lines

/// The options of all measurements.
enum { BENCH_OPTION_COUNT = 27 };
extern const ArgOption bench_all_options[BENCH_OPTION_COUNT];

typedef struct BenchRequest {
    BenchOptions options;
    bool json;
    const char *csv;       ///< path, or NULL
    const char *svg;       ///< path, or NULL
    const char *materials; ///< "office-paper,./mine.yaml", or NULL for all that are built in
} BenchRequest;

/// Whether a measurement takes an option: `accepted` has its name between spaces, " cells time ".
bool bench_takes(const char *accepted, const char *option);

/// Reads the command line of the measurement `name` ("swing"), as args_read does.
bool bench_args_read(const char *name, const char *summary, const char *accepted, int argc, char **argv,
                     BenchRequest *request, ExitCode *code);

// ---- materials

enum { BENCH_MATERIALS_MAX = 16 };

typedef struct BenchMaterials {
    int count;
    BenchMaterial items[BENCH_MATERIALS_MAX];
    Scene *scenes[BENCH_MATERIALS_MAX]; ///< the scenes that own them
} BenchMaterials;

/// Reads "office-paper,./mine.yaml", or all built-in ones (NULL). Messages have been printed unless the result is
/// EXIT_GOOD. Close it in any case.
ExitCode bench_materials_open(const char *list, BenchMaterials *materials);
void bench_materials_close(BenchMaterials *materials);

// ---- measurements

// Each fills the given table, whose `text` is set, and returns the error that
// stopped it, if any. A simulation that diverges is a result, not a failure.

typedef SingeResult BenchFn(const BenchOptions *options, BenchTable *table, SingeError *error);

// What each measures: the table in bench_command.c.
BenchFn bench_swing, bench_hang_and_shrink, bench_tear, bench_dynamics, bench_step, bench_surface, bench_heap,
    bench_collapse, bench_stack, bench_drop, bench_wind, bench_memory, bench_front, bench_spread, bench_output,
    bench_preview, bench_compare, bench_stability, bench_fold, bench_isotropy, bench_plate, bench_spectrum;

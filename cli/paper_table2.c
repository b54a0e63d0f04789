// Table 2: time of a step against the number of springs, h = 2 ms, at most 7 projections, threshold 1e-7. Its last row
// says 10,000 springs; its columns fit 100,000.
#include <stdio.h>
#include <stdlib.h>

#include "cli/paper.h"
#include "cli/paper_states.h"

typedef struct Table2Row {
    int cells;             ///< a side: 10 springs each
    double early, full;    ///< ms, the paper's columns b and c
} Table2Row;

static const Table2Row table2[] = {
    {10, 6.50, 142.46}, {20, 27.93, 362.69}, {40, 159.17, 1268.00}, {50, 211.67, 1877.92}, {100, 1045.02, 7412.92}};

enum { ROW_COUNT = sizeof table2 / sizeof *table2, QUICK_COUNT = 3 };

/// Steps before the clock runs, so that the sheet moves, and steps with it.
enum { WARM_STEPS = 25, TIMED_STEPS = 25 };

typedef struct Cost {
    double ms;           ///< median of the projection of a step
    double iterations;   ///< of the conjugate gradients, a step
    double strain;       ///< mean over the mesh's edges, at the end
} Cost;

static int compare(const void *a, const void *b) {
    double x, y;
    x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static SingeResult cost_measure(int cells, const SingeSolverDef *solver, int threads, Cost *cost, SingeError *error) {
    SingeSim *sim;
    SingeResult result = paper_sim(PAPER_SWING, cells, solver, threads, &sim, error);
    if (result) return result;
    double times[TIMED_STEPS];
    SingeTimers first = singe_sim_timers(sim), before = first;
    for (int step = 0; step < WARM_STEPS + TIMED_STEPS && !result; step++) {
        result = singe_sim_step(sim);
        SingeTimers now = singe_sim_timers(sim);
        if (step >= WARM_STEPS) times[step - WARM_STEPS] = 1e3 * (now.projection_seconds - before.projection_seconds);
        if (step + 1 == WARM_STEPS) first = now;
        before = now;
    }
    if (result) *error = *singe_sim_error(sim);
    qsort(times, TIMED_STEPS, sizeof *times, compare);
    *cost = (Cost){times[TIMED_STEPS / 2],
                   (double)(before.projection_iterations - first.projection_iterations) / TIMED_STEPS,
                   singe_sim_stats(sim).strain_mean};
    singe_sim_destroy(sim);
    return result;
}

static SingeSolverDef table2_solver(SingeSolverMethod method, bool early_exit) {
    SingeSolverDef def = singe_default_solver();
    singe_init_solver_method(&def, sizeof def, method);
    def.early_exit = early_exit;
    def.substeps = 1, def.projections = 7;
    def.smoothing = def.height_min = 0;
    return def;
}

static SingeResult table2_row(const Table2Row *row, int threads, SingeError *error) {
    Cost early, full, strand;
    SingeSolverDef early_solver = table2_solver(SINGE_SOLVER_PAPER, true);
    SingeSolverDef full_solver = table2_solver(SINGE_SOLVER_PAPER, false);
    SingeSolverDef strand_solver = table2_solver(SINGE_SOLVER_STRAND, false);
    SingeResult result = cost_measure(row->cells, &early_solver, threads, &early, error);
    if (!result) result = cost_measure(row->cells, &full_solver, threads, &full, error);
    if (!result) result = cost_measure(row->cells, &strand_solver, threads, &strand, error);
    if (result) return result;
    double springs = 10.0 * row->cells * row->cells;
    printf("%7.0f  %8.2f %8.2f %9.4f  %8.2f %8.2f %9.5f %6.0f  %8.3f %7.0f  %8.1e %8.1e\n", springs, row->early,
           row->full, row->full / springs, early.ms, full.ms, full.ms / springs, full.iterations, strand.ms,
           full.ms / strand.ms, full.strain, strand.strain);
    fflush(stdout);
    return SINGE_OK;
}

ExitCode paper_table2(const PaperOptions *options) {
    printf("ms a step: 7 projections of all colours, h = 2 ms, a swinging sheet, %d thread%s\n"
           "(b) with early exit, (c) fully iterated, (c)/(a) ms a spring; CG: iterations a step\n\n"
           "   (a)               paper                       here, solver: paper           strand              mean "
           "strain\n"
           "springs       (b)      (c)   (c)/(a)       (b)      (c)   (c)/(a)     CG        ms (c)/it     paper   "
           "strand\n",
           options->threads, options->threads == 1 ? "" : "s");
    for (int i = 0; i < (options->quick ? QUICK_COUNT : ROW_COUNT); i++) {
        SingeError error = {0};
        if (table2_row(&table2[i], options->threads, &error)) return paper_fail(&error);
    }
    return EXIT_GOOD;
}

// The paper's solver and ours on the same trajectories: errors, cost, and the ratio at equal or lower error; and the
// cost of seven projections of all colours without early exit.
//
// Both start from the same state and run the same frames, as many as the paper's solver completes in its share of the
// time. The error is the strain over all frames: of the mesh's edges and of all springs. p99 and mean are compared: the
// max is that of a single spring, and jumps. Ours runs with several numbers of substeps, to find its cheapest run with
// no more error.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/timing.h"
#include "bench/trajectory.h"

enum { STEPS = 20 }; // a frame

/// The results of a trajectory.
typedef struct Outcome {
    double frames, step_ms, fall; ///< NAN where nothing was followed
    BenchValue blue, all;
} Outcome;

typedef struct Comparison {
    const BenchOptions *options;
    BenchTable *table;
    SingeError *error;
    double budget; ///< s of wall clock for a trajectory of the paper's solver
    int frames;
} Comparison;

static const char *state_name(BenchState state) { return state == BENCH_SWING ? "swing" : "shrink"; }

static SingeResult compare_follow(const Comparison *c, const BenchSetup *setup, int frames, double budget,
                                  Outcome *outcome) {
    Trajectory *t = trajectory_run(setup, frames, STEPS, budget, c->error);
    if (!t) return c->error->code;

    *outcome = (Outcome){.frames = t->frames, .step_ms = t->dynamics_ms / STEPS, .fall = t->fall_end};
    outcome->blue = strain_percent(&t->strain[SINGE_BLUE]);
    for (int colour = 1; colour < SINGE_COLOUR_COUNT; colour++) strain_merge(&t->strain[0], &t->strain[colour]);
    outcome->all = strain_percent(&t->strain[0]);
    if (t->diverged) outcome->blue = outcome->all = (BenchValue){.number = {NAN, NAN, NAN}};
    trajectory_free(t);
    return SINGE_OK;
}

static bool no_more(const BenchValue *ours, const BenchValue *theirs) {
    bool less = true; // the paper's NaN is a divergence: anything is better
    for (int i = 1; i < 3; i++) less = less && (ours->number[i] <= theirs->number[i] || isnan(theirs->number[i]));
    return less && !isnan(ours->number[0]);
}

static SingeResult compare_add(const Comparison *c, const char *kind, const BenchSetup *setup, double springs,
                               const Outcome *outcome, const Outcome *paper) {
    const SingeSolverDef *solver = &setup->solver;

    // whether p99 and mean are at most the paper's
    bool edges = no_more(&outcome->blue, &paper->blue), all = no_more(&outcome->all, &paper->all);
    const char *less = outcome == paper || isnan(outcome->frames) ? "-"
                       : edges && all                             ? "edges and all"
                       : edges                                    ? "edges"
                       : all                                      ? "all"
                                                                  : "no";

    table_text(c->table, "kind", 10, kind);
    table_text(c->table, "state", 6, state_name(setup->state));
    table_number(c->table, "springs", "%.0f", 8, springs);
    table_text(c->table, "solver", 11, enum_words.SingeSolverMethod[solver->method]);
    table_number(c->table, "substeps", "%.0f", 8, solver->substeps);
    table_number(c->table, "projections", "%.0f", 11, solver->projections);
    table_number(c->table, "frames", "%.0f", 6, outcome->frames);
    table_number(c->table, "step_ms", "%.4g", 9, outcome->step_ms);

    table_parts(c->table, "blue_pct", "%.3g", 20, "max/p99/mean", outcome->blue);
    table_parts(c->table, "all_pct", "%.3g", 20, "max/p99/mean", outcome->all);
    table_number(c->table, "fall_m", "%.3f", 7, outcome->fall);
    table_number(c->table, "ratio", "%.1f", 8, paper->step_ms / outcome->step_ms);
    table_text(c->table, "no_more_error", 13, less);
    return table_end_row(c->table);
}

static BenchSetup method_setup(const Comparison *c, BenchState state, double springs, SingeSolverMethod method) {
    BenchOptions options = *c->options;
    options.solver = method;
    BenchSetup setup = sheet_setup(&options, state, STEPS);
    setup.rigid = true;
    setup.cells = options_cells(springs);
    return setup;
}

/// The paper's trajectory, and ours at several substeps.
static SingeResult trajectories(const Comparison *c, BenchState state, double springs) {
    static const int substeps[] = {1, 2, 3, 6, 12, 24};
    BenchSetup setup = method_setup(c, state, springs, SINGE_SOLVER_PAPER);
    Outcome paper, ours;
    SingeResult result = compare_follow(c, &setup, c->frames, c->budget, &paper);

    if (!result) result = compare_add(c, "trajectory", &setup, springs, &paper, &paper);
    double best_edges = 0, best_all = 0;

    setup = method_setup(c, state, springs, SINGE_SOLVER_STRAND);
    for (size_t i = 0; i < sizeof substeps / sizeof *substeps && !result; i++) {
        setup.solver.substeps = substeps[i];
        result = compare_follow(c, &setup, (int)paper.frames, INFINITY, &ours);
        if (!result) result = compare_add(c, "trajectory", &setup, springs, &ours, &paper);
        if (!result && no_more(&ours.blue, &paper.blue)) best_edges = fmax(best_edges, paper.step_ms / ours.step_ms);
        if (!result && no_more(&ours.all, &paper.all)) best_all = fmax(best_all, paper.step_ms / ours.step_ms);
    }

    if (!result && c->table->text)
        fprintf(c->table->text,
                "%s, %.0f springs: %.1f times as fast at equal error of edges, %.1f times at equal error of all springs"
                " springs (0: never)\n",
                state_name(state), springs, best_edges, best_all);
    return result;
}

/// Seven projections of all colours in one substep: milliseconds of the projection, median over a few steps.
static SingeResult full(const Comparison *c, double springs, SingeSolverMethod method, double *paper_ms) {
    BenchSetup setup = method_setup(c, BENCH_SWING, springs, method);
    SingeSim *sim;
    Timing timing = {0};

    setup.solver.substeps = 1;
    setup.solver.projections = 7;
    setup.solver.early_exit = false;
    TRY(sheet_build(&setup, &sim, c->error));

    // the same few steps for both solvers: a step of the paper's takes seconds at 100,000 springs
    int warm_up = springs > 5e4 ? 5 : 40, steps = springs > 5e4 ? 5 : 11;
    SingeResult result = timing_measure(&timing, sim, NULL, warm_up, steps);
    if (result) *c->error = *singe_sim_error(sim);

    double ms = result ? 0 : timing_median(&timing, TIMED_PROJECTION);
    if (method == SINGE_SOLVER_PAPER) *paper_ms = ms;
    timing_free(&timing);
    singe_sim_destroy(sim);
    if (result) return result;

    // nothing but the time is compared
    const BenchValue none = {.number = {NAN, NAN, NAN}};
    const Outcome outcome = {.frames = NAN, .step_ms = ms, .fall = NAN, .blue = none, .all = none};
    const Outcome paper = {.step_ms = *paper_ms};
    return compare_add(c, "full", &setup, springs, &outcome, &paper);
}

SingeResult bench_compare(const BenchOptions *options, BenchTable *table, SingeError *error) {
    static const double sizes[] = {4e3, 16e3, 1e5}, small_sizes[] = {1e3, 4e3};
    const bool quick = options->quick;
    BenchList springs = bench_list(&options->springs, quick ? 2 : 3, quick ? small_sizes : sizes);
    Comparison c = {.options = options, .table = table, .error = error, .budget = quick ? 8 : 100};
    double seconds = options->time > 0 ? options->time : quick ? 0.25 : 1;
    SingeResult result = SINGE_OK;

    c.frames = (int)fmax(1, round(seconds * BENCH_FPS));
    for (int i = 0; i < springs.count && !result; i++) {
        double size = pow(options_cells(springs.values[i]), 2) * 10, paper_ms = 0;
        result = trajectories(&c, BENCH_SWING, size);
        if (!result) result = trajectories(&c, BENCH_SHRINK, size);
        if (!result) result = full(&c, size, SINGE_SOLVER_PAPER, &paper_ms);
        if (!result) result = full(&c, size, SINGE_SOLVER_STRAND, &paper_ms);
    }

    return result;
}

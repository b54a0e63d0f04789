// Stability of the solver: swing and strong shrinkage over thickness, resolution and time step.
//
// Swing is that of `singe bench swing`. Strong shrink: a sheet hangs from one corner patch and shrinks to half its
// size within a second. Neither has drag or damping. A case is
//
//   NaN       a step failed, or a position, a speed or a strain is not a finite number
//   exploded  kinetic plus potential energy exceeds its initial value by more than 0.5 J/kg (swing; 10 J/kg for shrink,
//             whose springs do work: as much as lifting all of the sheet by its side), or a speed is above 100 m/s
//   stretched a point is more than 1.5 times as far from a pin as the sheet allows
//   crumpled  at the end the root mean square distance from the sheet's centre is below 0.35 of that of a flat sheet
//             of its size (one that hangs from a corner has 0.7), or more than a quarter of the inner edges fold
//             sharper than a right angle
//   ok        else
//
// Also: the max number of inverted cells, whose centre is not in front of their corners, at the end of any step.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/machine.h"
#include "bench/hung_sheet.h"

static const double gravity = 9.81, speed_limit = 100, reach_limit = 1.5, gyration_limit = 0.35, folded_limit = 0.25;

typedef struct Case {
    BenchSetup setup;
    double t_over_s, seconds;
    bool finite;
    double speed, energy_gain, reach, gyration, folded; ///< the greatest, and the last two at the end
    double inverted;                                    ///< cells, the max after any step
    BenchValue strain;
    SingeResult failed; ///< could not be built
    SingeError error;
} Case;

typedef struct Cases {
    Case *list;
    int count;
    BenchTable *table;
    bool full_table; ///< out of memory for it
} Cases;

static double larger(double max, double value) { return value <= max ? max : value; } // NaN stays

static void stability_run(void *context, int i) {
    Case *c = &((Cases *)context)->list[i];
    SingeSim *sim = NULL;
    Strain *strain = malloc(sizeof *strain);

    c->failed = strain ? sheet_build(&c->setup, &sim, &c->error) : SINGE_ERROR_MEMORY;
    if (!c->failed) {
        strain_clear(strain);

        const float corners[2][3] = {{0, 0, 1}, {0, 0, 0}};
        const double h = (double)c->setup.time_step;
        const int steps = (int)ceil(c->seconds / h), every = h < 0.015 ? (int)(0.015 / h) : 1;
        SingeView view = singe_sim_view(sim);
        double energy = geometry_energy(&view, gravity);

        c->finite = true;
        for (int step = 1; step <= steps && c->finite; step++) {
            if (singe_sim_step(sim)) c->finite = false;
            else c->inverted = larger(c->inverted, geometry_inverted(&view));
            if (!c->finite || (step % every != 0 && step != steps)) continue;

            view = singe_sim_view(sim);
            strain_add(strain, &view, SINGE_BLUE);
            c->speed = larger(c->speed, geometry_speed(&view));
            c->energy_gain = larger(c->energy_gain, geometry_energy(&view, gravity) - energy);
            c->reach = larger(c->reach, geometry_reach(&view, corners[c->setup.state == BENCH_SWING]));
            c->finite = c->finite && strain->finite && isfinite(c->speed) && isfinite(c->reach);
        }

        view = singe_sim_view(sim);
        double shrunk = c->setup.state == BENCH_SHRINK ? (double)c->setup.shrink : 1;
        c->gyration = geometry_gyration(&view) / (sqrt(1.0 / 6) * shrunk);
        c->folded = geometry_folded(&view, c->setup.cells);
        c->strain = strain_percent(strain);
    }

    singe_sim_destroy(sim);
    free(strain);
}

static void done(void *context, int i) {
    Cases *cases = context;
    const Case *c = &cases->list[i];
    if (c->failed) return;

    const double energy_limit = c->setup.state == BENCH_SWING ? 0.5 : 10;
    const char *verdict = "ok";
    if (!c->finite) verdict = "NaN";
    else if (c->energy_gain > energy_limit || c->speed > speed_limit) verdict = "exploded";
    else if (c->reach > reach_limit) verdict = "stretched";
    else if (c->gyration < gyration_limit || c->folded > folded_limit) verdict = "crumpled";

    table_text(cases->table, "state", 6, c->setup.state == BENCH_SWING ? "swing" : "shrink");
    table_number(cases->table, "cells", "%.0f", 5, c->setup.cells);
    table_number(cases->table, "t_over_s", "%.3g", 8, c->t_over_s);
    table_number(cases->table, "h_ms", "%.3g", 5, 1e3 * (double)c->setup.time_step);
    table_text(cases->table, "result", 9, verdict);

    table_number(cases->table, "max_strain_pct", "%.3g", 14, c->strain.number[0]);
    table_number(cases->table, "p99_pct", "%.3g", 8, c->strain.number[1]);
    table_number(cases->table, "speed", "%.3g", 7, c->speed);
    table_number(cases->table, "energy_gain", "%.3g", 11, c->energy_gain);
    table_number(cases->table, "reach", "%.3f", 7, c->reach);
    table_number(cases->table, "gyration", "%.2f", 8, c->gyration);
    table_number(cases->table, "folded", "%.2f", 6, c->folded);
    table_number(cases->table, "inverted", "%.0f", 8, c->inverted);
    if (table_end_row(cases->table)) cases->full_table = true;
}

enum { CELLS_MAX = BENCH_LIST_MAX, RATIOS_MAX = 6, STEPS_MAX = 5 };

SingeResult bench_stability(const BenchOptions *options, BenchTable *table, SingeError *error) {
    Cases cases = {.table = table, .list = calloc(2 * CELLS_MAX * RATIOS_MAX * STEPS_MAX, sizeof *cases.list)};
    SingeResult result = SINGE_OK;
    if (!cases.list) return SINGE_ERROR_MEMORY;

    if (table->text)
        fputs("NaN: a step failed or a number is not finite. exploded: energy_gain > 0.5 J/kg (shrink 10) or\n"
              "speed > 100 m/s. stretched: reach > 1.5. crumpled: gyration < 0.35 of a flat sheet's, or folded > 0.25\n"
              "of the edges.\n",
              table->text);

    static const double all_cells[] = {20, 50, 100, 200}, all_ratios[] = {0.05, 0.2, 0.5, 0.7, 1, 2.5};
    static const double all_steps[] = {1, 2, 4, 8, 16}, few_ratios[] = {0.05, 0.7, 2.5}, few_steps[] = {4, 16};
    const bool quick = options->quick;
    BenchList cells = bench_list(&options->cells, quick ? 1 : 4, all_cells);
    const double *ratios = quick ? few_ratios : all_ratios, *steps = quick ? few_steps : all_steps;
    for (int state = 0; state < 2; state++)
        for (int n = 0; n < cells.count; n++)
            for (int r = 0; r < (quick ? 3 : RATIOS_MAX); r++)
                for (int s = 0; s < (quick ? 2 : STEPS_MAX); s++) {
                    Case *c = &cases.list[cases.count++];
                    c->setup = sheet_setup(options, state ? BENCH_SHRINK : BENCH_SWING, 20);
                    c->setup.cells = (int)cells.values[n];
                    c->setup.pins = state ? 1 : 2;
                    c->setup.shrink = 0.5f;
                    c->setup.threads = 1;
                    c->setup.thickness = (float)(ratios[r] / cells.values[n]);
                    c->setup.time_step = (float)(1e-3 * steps[s]);
                    c->t_over_s = ratios[r];
                    c->seconds = options->time > 0 ? options->time : quick ? 0.5 : state ? 1.5 : 1;
                }

    workers_run(cases.count, options->threads > 1 ? options->threads : machine_processors(), stability_run, done,
                &cases);
    for (int i = 0; i < cases.count && !result; i++)
        if (cases.list[i].failed) result = cases.list[i].failed, *error = cases.list[i].error;
    if (!result && cases.full_table) result = SINGE_ERROR_MEMORY;
    free(cases.list);
    return result;
}

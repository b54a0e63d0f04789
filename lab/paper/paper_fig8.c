// Fig 8: the error |C| of each colour and their sum, over the projection steps of successive fast projection, in two
// states: a sheet that swings (at 0.4 s) and one that shrinks (at 0.1 s). Also the number of states of either run in
// which the sum rises in a projection step, which the paper excludes.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "paper/paper.h"
#include "paper/paper_states.h"
#include "cli/text.h"
#include "formats/formats.h"

enum { CELLS = 20, STEPS = 20, COUNTED = 7, EVERY = 2, LINES = SINGE_COLOUR_COUNT + 1 };

typedef struct Fig8 {
    double error[LINES][STEPS + 1]; ///< of red, green, blue, yellow and their sum, before and after each step
} Fig8;

typedef struct Fig8Run {
    PaperState state;
    int shown, last; ///< simulation steps: shown in the figure, and the last that is counted
} Fig8Run;

static const Fig8Run runs[] = {{PAPER_SWING, 200, 250}, {PAPER_SHRINK, 50, 200}};

/// Projects `steps` times and records the errors; `floor` on the diagonal, of which the paper has none.
static SingeResult fig8_project(const SingeSim *sim, PaperState state, double floor, int steps, Fig8 *fig,
                                SingeError *error) {
    SingeNetwork *network;
    double errors[SINGE_COLOUR_COUNT];
    SingeResult result = paper_network(sim, state, false, floor, 0, &network, error);

    if (result) return result;
    for (int step = 0; step <= steps && !result; step++) {
        for (uint32_t set = 0; step > 0 && set < SINGE_COLOUR_COUNT && !result; set++)
            result = singe_network_project(network, set, NULL);
        fig->error[SINGE_COLOUR_COUNT][step] = paper_errors(network, SINGE_COLOUR_COUNT, errors);
        for (int c = 0; c < SINGE_COLOUR_COUNT; c++) fig->error[c][step] = errors[c];
    }

    if (result) *error = (SingeError){.code = result, .element = -1};
    singe_network_destroy(network);
    return result;
}

/// Of all states of a run.
typedef struct Fig8Count {
    int states;
    int rises[2]; ///< states in which the sum rises in one of the first 7 steps: with the solver's floor, and without
    int lower;    ///< states in which it is lower after them
    double worst; ///< sum after 7 steps over that before, max
} Fig8Count;

static SingeResult fig8_write(Lab *lab, const char *state, const Fig8 *fig, SingeError *error) {
    static const char *const names[] = {"red", "green", "blue", "yellow", "sum"};
    static const char *const inks[] = {"#d62728", "#2ca02c", "#1f77b4", "#d0a000", "#777777"};
    char path[4096], title[80], *csv;
    FILE *file = text_open(&csv);
    fprintf(file, "step,red,green,blue,yellow,sum\n");
    for (int step = 0; step <= STEPS; step++) {
        fprintf(file, "%d", step);
        for (int l = 0; l < LINES; l++) fprintf(file, ",%.9g", fig->error[l][step]);
        fputc('\n', file);
    }

    text_close(file, &csv);
    snprintf(path, sizeof path, "%s/fig8-%s.csv", report_folder(lab->report), state);
    SingeResult result = file_write(path, csv, strlen(csv), error);
    free(csv);
    if (result) return result;

    snprintf(title, sizeof title, "Error of each colour: %s, %d springs", state, 10 * CELLS * CELLS);
    Plot plot = {.title = title, .x_label = "projection step", .y_label = "|C|, m", .log_y = true};
    for (int l = 0; l < LINES; l++)
        plot_add(&plot, (PlotLine){.name = names[l], .colour = inks[l], .y = fig->error[l], .count = STEPS + 1});
    report_plot(lab->report, &plot);
    snprintf(path, sizeof path, "%s/fig8-%s.svg", report_folder(lab->report), state);
    return plot_write(&plot, path, error);
}

SingeResult paper_fig8(Lab *lab, SingeError *error) {
    enum { RUNS = sizeof runs / sizeof *runs };
    Fig8Count count[RUNS] = {{0}}, all = {0};
    double fell[RUNS] = {0};
    const double floor = singe_default_network().regularisation;
    SingeResult result = SINGE_OK;
    for (int i = 0; i < RUNS && !result; i++) {
        const Fig8Run *run = &runs[i];
        Fig8Count *own = &count[i];
        SingeSolverDef solver = singe_default_solver();
        singe_init_solver_method(&solver, sizeof solver, SINGE_SOLVER_PAPER);

        SingeSim *sim;
        Fig8 shown = {0}, counted;
        result = paper_sim(run->state, CELLS, &solver, 1, &sim, error);
        if (result) break;

        for (int step = 0; step <= run->last && !result; step++) {
            if (step == run->shown) result = fig8_project(sim, run->state, floor, STEPS, &shown, error);
            for (int bare = 0; bare < 2 && !result && step % EVERY == 0; bare++) {
                result = fig8_project(sim, run->state, bare ? 0 : floor, COUNTED, &counted, error);
                if (result) break;

                const double *sum = counted.error[SINGE_COLOUR_COUNT];
                bool rises = false;
                for (int k = 0; k < COUNTED; k++) rises = rises || sum[k + 1] > sum[k];
                own->rises[bare] += rises;
                if (bare) continue;

                own->states++;
                own->lower += sum[COUNTED] < sum[0];
                if (sum[0] > 0 && sum[COUNTED] / sum[0] > own->worst) own->worst = sum[COUNTED] / sum[0];
            }
            if (!result && (result = singe_sim_step(sim))) *error = *singe_sim_error(sim);
        }

        singe_sim_destroy(sim);
        if (result) break;

        const char *name = paper_state_names[run->state];
        const double *sum = shown.error[SINGE_COLOUR_COUNT];

        result = fig8_write(lab, name, &shown, error);
        report_text(
            lab->report,
            "%s at %g s: the sum falls from %.3g to %.3g m in %d projection steps, to %.3g in %d. Of %d states up to "
            "%g s it rises in one of the first %d steps in %d, and in %d without our floor of 1e-4 on the diagonal; it is "
            "lower after them in %d, and in the worst %.2f times what it was.",
            name, run->shown * (double)PAPER_TIME_STEP, sum[0], sum[COUNTED], COUNTED, sum[STEPS], STEPS, own->states,
            run->last * (double)PAPER_TIME_STEP, COUNTED, own->rises[0], own->rises[1], own->lower, own->worst);

        fell[i] = sum[COUNTED] / sum[0];
        all.states += count[i].states;
        for (int bare = 0; bare < 2; bare++) all.rises[bare] += count[i].rises[bare];
        all.lower += count[i].lower;
    }
    if (result) return result;

    const double rises = (double)all.rises[1] / all.states, lower = (double)all.lower / all.states;
    report_bar(lab->report, "rises",
               "share of all states in which the sum rises in one of 7 steps, with nothing on the diagonal, "
               "as the paper has it: \"always decreases\" is refuted",
               rises, 0.25, 1, (double)all.rises[0] / all.states, "with our floor of 1e-4");
    report_bar(lab->report, "shrunk", "sum after 7 steps over that before, the sheet that shrinks evenly", fell[1], 0,
               0.05, fell[0], "the sheet that swings");
    report_bar(lab->report, "lower", "share of all states in which the sum is lower after 7 steps", lower, 0.95, 1,
               1 - rises, "in which it falls in each of them, without the floor");

    return SINGE_OK;
}

// Fig 8: the error |C| of each colour and their sum, over the projection steps of successive fast projection, in two
// states: a sheet that swings (at 0.4 s) and one that shrinks (at 0.1 s). And in how many states of either run the
// sum rises in a projection step, which the paper says it never does.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/lab/paper.h"
#include "cli/lab/paper_states.h"
#include "cli/text.h"
#include "formats/formats.h"

enum { CELLS = 20, STEPS = 20, COUNTED = 7, LINES = SINGE_COLOUR_COUNT + 1 };

typedef struct Fig8 {
    double error[LINES][STEPS + 1]; ///< of red, green, blue, yellow and their sum, before and after each step
} Fig8;

typedef struct Fig8Run {
    PaperState state;
    int shown, last; ///< simulation steps: whose state the figure shows, and that are counted
} Fig8Run;

static const Fig8Run runs[] = {{PAPER_SWING, 200, 250}, {PAPER_SHRINK, 50, 200}};

/// Projects `steps` times and notes the errors.
static SingeResult fig8_project(const SingeSim *sim, PaperState state, int steps, Fig8 *fig, SingeError *error) {
    SingeNetwork *network;
    double errors[SINGE_COLOUR_COUNT];
    SingeResult result = paper_network(sim, state, false, singe_default_network().regularisation, &network, error);
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

static bool fig8_rises(const Fig8 *fig, int steps) {
    const double *sum = fig->error[SINGE_COLOUR_COUNT];
    for (int step = 0; step < steps; step++)
        if (sum[step + 1] > sum[step]) return true;
    return false;
}

static SingeResult fig8_write(Lab *lab, const char *state, const Fig8 *fig, SingeError *error) {
    static const char *const names[] = {"red", "green", "blue", "yellow", "sum"};
    static const char *const inks[] = {"#d62728", "#2ca02c", "#1f77b4", "#d0a000", "#777777"};
    char path[4096], title[80], *csv = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&csv, &size);
    if (!file) return *error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1}, error->code;
    fprintf(file, "step,red,green,blue,yellow,sum\n");
    for (int step = 0; step <= STEPS; step++) {
        fprintf(file, "%d", step);
        for (int l = 0; l < LINES; l++) fprintf(file, ",%.9g", fig->error[l][step]);
        fputc('\n', file);
    }
    SingeResult result = SINGE_ERROR_MEMORY;
    snprintf(path, sizeof path, "%s/fig8-%s.csv", report_folder(lab->report), state);
    if (text_stream_end(file, &csv)) result = file_write(path, csv, size, error);
    else *error = (SingeError){.code = result, .element = -1};
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

static SingeResult fig8_run(Lab *lab, const Fig8Run *run, SingeError *error) {
    SingeSolverDef solver = singe_default_solver();
    singe_init_solver_method(&solver, sizeof solver, SINGE_SOLVER_PAPER);
    SingeSim *sim;
    Fig8 shown = {0}, counted;
    int rises = 0;
    const int last = lab->quick ? run->shown : run->last, every = lab->quick ? 10 : 1; // states that are counted
    SingeResult result = paper_sim(run->state, CELLS, &solver, 1, &sim, error);
    if (result) return result;
    for (int step = 0; step <= last && !result; step++) {
        if (step == run->shown) result = fig8_project(sim, run->state, STEPS, &shown, error);
        if (!result && step % every == 0) {
            result = fig8_project(sim, run->state, COUNTED, &counted, error);
            if (!result && fig8_rises(&counted, COUNTED)) rises++;
        }
        if (!result && (result = singe_sim_step(sim))) *error = *singe_sim_error(sim);
    }
    singe_sim_destroy(sim);
    if (result) return result;
    const char *name = paper_state_names[run->state];
    const double *sum = shown.error[SINGE_COLOUR_COUNT];
    char measure[40], text[200];
    result = fig8_write(lab, name, &shown, error);
    report_text(lab->report, "%s at %g s: the sum falls from %.3g to %.3g m in %d projection steps, to %.3g in %d. "
                             "Of the "
                "states up to %g s it rises in one of the first %d steps in %d of %d%s.", name,
                run->shown * (double)PAPER_TIME_STEP, sum[0], sum[COUNTED], COUNTED, sum[STEPS], STEPS,
                last * (double)PAPER_TIME_STEP, COUNTED, rises, last / every + 1,
                rises ? ": \"always decreases\" is too much" : "");
    snprintf(measure, sizeof measure, "%s_rises", name);
    snprintf(text, sizeof text, "%s: projection steps of %d in which the sum rises, in the state drawn", name, STEPS);
    int rising = 0;
    for (int step = 0; step < STEPS; step++) rising += sum[step + 1] > sum[step];
    report_measure(lab->report, measure, text, rising, 0, 0);
    snprintf(measure, sizeof measure, "%s_left", name);
    snprintf(text, sizeof text, "%s: share of the sum that is left after %d steps", name, STEPS);
    report_measure(lab->report, measure, text, sum[STEPS] / sum[0], 0, 0.7);
    return result;
}

SingeResult paper_fig8(Lab *lab, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (size_t i = 0; i < sizeof runs / sizeof *runs && !result; i++) result = fig8_run(lab, &runs[i], error);
    return result;
}

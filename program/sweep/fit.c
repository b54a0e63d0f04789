// singe fit: the command, and the optimiser (NLopt).
//
// Each evaluation is a row of a sweep. The optimiser is deterministic, so an interrupted fit asks for the same rows
// again: rows that are complete and have their line in fit.csv are not run again.
#include "sweep/fit.h"

#include <math.h>
#include <nlopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/interrupt.h"
#include "cli/text.h"
#include "formats/formats.h"
#include "sweep/csv.h"

enum { OPT_OUTPUT, OPT_THREADS, OPT_QUIET, OPT_COUNT };

static const ArgOption fit_options[OPT_COUNT] = {
    [OPT_OUTPUT] = {"output", 'o', "DIR", "folder of the fit [out/NAME]"},
    [OPT_THREADS] = {"threads", 0, "N", "threads [all]; the result does not depend on them"},
    [OPT_QUIET] = {"quiet", 'q', NULL, "prints errors and the result only"},
};

static const ArgCommand fit_command = {
    "fit",
    "PLAN",
    "Finds the parameters with which a scene best matches measurements.",
    fit_options,
    OPT_COUNT,
    "docs/sweep.md describes plans. The same command continues a fit that was stopped.\n"
    "Exit codes: 0 good, 1 a row failed or the fit was interrupted, 2 bad input."};

/// Changes of the coordinates in [0, 1] below this end the search.
static const double parameter_tolerance = 1e-3;

typedef struct Fit {
    Sweep *sweep;
    SweepOptions *options;
    const FitTarget *target;
    nlopt_opt optimiser;
    char *noted;            ///< fit.csv: header and lines so far
    uint32_t row, best_row; ///< the next row, and the best one so far
    double best;
    double *errors; ///< [evaluations] of the rows so far
    ExitCode code;
} Fit;

// ---- fit.csv

static char *table_path(const Fit *fit) { return text_format("%s/fit.csv", fit->sweep->folder); }

static char *table_line(const Fit *fit, uint32_t row) {
    const Plan *plan = &fit->sweep->plan;
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file) {
        fprintf(file, "%u", row + 1);
        for (uint32_t p = 0; p < plan->parameter_count; p++)
            fputc(',', file), text_csv_cell(file, plan_value(plan, row, p));
        fputc(',', file);
    }
    if (text_stream_end(file, &text)) return text;
    free(text);
    return NULL;
}

/// The error in fit.csv of a row. False: none. `other`: its line has other parameters.
static bool noted_error(const Fit *fit, const char *line, uint32_t row, double *error, bool *other) {
    const char *at = fit->noted;
    for (uint32_t i = 0; i <= row && at; i++) { // after the header and the earlier rows
        at = strchr(at, '\n');
        if (at) at++;
    }
    *other = at && *at && strncmp(at, line, strlen(line)) != 0;
    if (!at || !*at || *other) return false;
    *error = atof(at + strlen(line));
    return true;
}

static bool note_error(Fit *fit, const char *line, double value) {
    char *path = table_path(fit), *longer = text_format("%s%s%.17g\n", fit->noted, line, value);
    SingeError error = {0};
    const bool good = !file_write(path, longer, strlen(longer), &error);
    if (!good) console_result(fit->sweep->console, &error);
    free(fit->noted), free(path);
    fit->noted = longer;
    return good;
}

static bool read_table(Fit *fit) {
    char *path = table_path(fit), *text = NULL;
    size_t size = 0;
    Bytes bytes = {0};
    SingeError error = {0};
    FILE *file = open_memstream(&text, &size);
    if (file) {
        fputs("row", file);
        for (uint32_t p = 0; p < fit->sweep->plan.parameter_count; p++)
            fputc(',', file), text_csv_cell(file, fit->sweep->plan.parameters[p].key);
        fputs(",error\n", file);
    }
    bool good = text_stream_end(file, &text);
    fit->noted = text;
    if (good && !file_read(path, (SingeAllocator){0}, &bytes, &error)) {
        free(fit->noted);
        fit->noted = text_format("%s", (const char *)bytes.data);
    }
    bytes_free(&bytes);
    free(path);
    return good;
}

// ---- an evaluation

/// Runs a row and measures it.
static ExitCode evaluate(Fit *fit, uint32_t row, double *value) {
    ExitCode code = sweep_check_row(fit->sweep, row);
    fit->options->row = (int)row + 1;
    fit->options->retry = true;
    const bool quiet = fit->sweep->console->quiet;
    fit->sweep->console->quiet = true;
    if (!code) code = sweep_run_rows(fit->sweep);
    fit->sweep->console->quiet = quiet;
    if (!code && !fit_error(fit->target, fit->sweep, row, value)) code = EXIT_FAILED;
    return code;
}

static void show_evaluation(const Fit *fit, uint32_t row, double value) {
    const Plan *plan = &fit->sweep->plan;
    char *text = text_format("%u:", row + 1);
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        char *longer = text_format("%s %s=%s", text, plan_label(plan, p), plan_value(plan, row, p));
        free(text);
        text = longer;
    }
    console_note(fit->sweep->console, "%s: error %.6g (best %.6g)", text, value, fit->best);
    free(text);
}

/// The error of a row whose values are set: from fit.csv, or after running it.
static ExitCode row_error(Fit *fit, uint32_t row, double *value) {
    bool other = false;
    char *line = table_line(fit, row);
    if (!line) return EXIT_FAILED;
    ExitCode code = EXIT_GOOD;
    if (!noted_error(fit, line, row, value, &other)) {
        if (other) {
            console_error(fit->sweep->console,
                          "fit.csv in %s is of another fit: line %u differs; use another folder (-o)",
                          fit->sweep->folder, row + 2);
            code = EXIT_INPUT;
        } else {
            code = evaluate(fit, row, value);
            if (!code && !note_error(fit, line, *value)) code = EXIT_FAILED;
        }
    }
    free(line);
    return code;
}

/// An earlier row with the values of `row`, or `row`: the optimiser returns to points, and numbers are rounded.
static uint32_t same_row(const Plan *plan, uint32_t row) {
    for (uint32_t r = 0; r < row; r++) {
        uint32_t p = 0;
        while (p < plan->parameter_count && strcmp(plan_value(plan, r, p), plan_value(plan, row, p)) == 0) p++;
        if (p == plan->parameter_count) return r;
    }
    return row;
}

static double stop(Fit *fit, ExitCode code) {
    fit->code = code;
    nlopt_force_stop(fit->optimiser);
    return HUGE_VAL;
}

/// NLopt's objective function.
static double objective(unsigned count, const double *coordinates, double *gradient, void *context) {
    Fit *fit = context;
    Plan *plan = &fit->sweep->plan;
    const uint32_t row = fit->row;
    (void)count, (void)gradient;
    if (fit->code || row == plan->evaluations) return stop(fit, fit->code);
    if (!plan_set_row(plan, row, coordinates)) return stop(fit, EXIT_FAILED);
    const uint32_t before = same_row(plan, row);
    if (before != row) return fit->errors[before];

    const ExitCode code = row_error(fit, row, &fit->errors[row]);
    if (code || interrupt_asked()) return stop(fit, code ? code : EXIT_FAILED);
    const double value = fit->errors[row];
    if (value < fit->best) {
        fit->best = value;
        fit->best_row = row;
    }
    show_evaluation(fit, row, value);
    fit->row++;
    return value;
}

// ---- the fit

static bool set_up(Fit *fit, unsigned count) {
    const bool global = fit->sweep->plan.search == PLAN_SEARCH_GLOBAL;
    nlopt_opt optimiser = fit->optimiser = nlopt_create(global ? NLOPT_GN_DIRECT_L : NLOPT_LN_SBPLX, count);
    return optimiser && nlopt_set_lower_bounds1(optimiser, 0) > 0 && nlopt_set_upper_bounds1(optimiser, 1) > 0 &&
           nlopt_set_min_objective(optimiser, objective, fit) > 0 &&
           nlopt_set_maxeval(optimiser, 10 * (int)fit->sweep->plan.evaluations) > 0 && // including repeated points
           nlopt_set_xtol_abs1(optimiser, parameter_tolerance) > 0 && nlopt_set_initial_step1(optimiser, 0.25) > 0;
}

static void print_result(const Fit *fit) {
    const Plan *plan = &fit->sweep->plan;
    char *scene = text_shell_quote(plan->scene);
    printf("row %u of %u, error %.6g:\nsinge run %s", fit->best_row + 1, fit->row, fit->best, scene);
    free(scene);
    for (uint32_t i = 0; i < plan->set_count + plan->parameter_count; i++) {
        char *set = i < plan->set_count ? text_format("%s", plan->sets[i])
                                        : text_format("%s=%s", plan->parameters[i - plan->set_count].key,
                                                      plan_value(plan, fit->best_row, i - plan->set_count));
        char *quoted = text_shell_quote(set);
        printf(" --set %s", quoted);
        free(set), free(quoted);
    }
    putchar('\n');
}

static ExitCode search(Fit *fit) {
    const unsigned count = fit->sweep->plan.parameter_count;
    double coordinates[PLAN_PARAMETERS_MAX], least;
    for (unsigned p = 0; p < count; p++) coordinates[p] = 0.5;
    fit->errors = calloc(fit->sweep->plan.evaluations, sizeof *fit->errors);
    if (!fit->errors || !read_table(fit) || !set_up(fit, count)) {
        console_error(fit->sweep->console, "out of memory");
        return EXIT_FAILED;
    }
    const nlopt_result result = nlopt_optimize(fit->optimiser, coordinates, &least);
    // rounding ends a search near a minimum: the best point is valid
    const bool spent = result == NLOPT_FORCED_STOP && fit->row == fit->sweep->plan.evaluations;
    if (!fit->code && result < 0 && !spent && result != NLOPT_ROUNDOFF_LIMITED) {
        console_error(fit->sweep->console, "the search failed: %s", nlopt_result_to_string(result));
        fit->code = EXIT_FAILED;
    }
    if (!fit->code) print_result(fit);
    else if (interrupt_asked()) console_note(fit->sweep->console, "the same command continues");
    return fit->code;
}

static ExitCode fit_plan(Sweep *sweep, SweepOptions *options) {
    ExitCode code = plan_read(options->plan, true, sweep->console, &sweep->plan);
    FitTarget target = {0};
    if (code) return code;
    code = fit_target_read(&target, &sweep->plan.target, sweep->console);
    if (!code) code = sweep_prepare(sweep);
    if (!code) {
        Fit fit = {.sweep = sweep, .options = options, .target = &target, .best = HUGE_VAL};
        interrupt_watch();
        code = search(&fit);
        nlopt_destroy(fit.optimiser);
        free(fit.noted), free(fit.errors);
    }
    fit_target_free(&target);
    return code;
}

static ExitCode fit_parse(int argc, char **argv, SweepOptions *o, bool *done) {
    ArgReader reader = args_begin(&fit_command, argc, argv);
    const char *value;
    *o = (SweepOptions){.threads = job_threads(), .jobs = 1, .no_preview = true};
    *done = false;
    for (int option; (option = args_next(&reader, &value)) != ARG_END;) switch (option) {
        case OPT_OUTPUT: o->output = value; break;
        case OPT_THREADS:
            if (!args_int(&reader, option, value, 1, JOB_THREADS_MAX, &o->threads)) return EXIT_INPUT;
            break;
        case OPT_QUIET: o->quiet = true; break;
        case ARG_OPERAND: o->plan = value; break;
        case ARG_HELP: *done = true; return EXIT_GOOD;
        default: return EXIT_INPUT;
        }
    return EXIT_GOOD;
}

int command_fit(int argc, char **argv) {
    SweepOptions options;
    bool done;
    ExitCode code = fit_parse(argc, argv, &options, &done);
    if (code || done) return code;
    interrupt_shield();
    Console console = console_make(options.quiet);
    Sweep sweep = sweep_make(&console, &options);
    code = fit_plan(&sweep, &options);
    sweep_close(&sweep);
    return code;
}

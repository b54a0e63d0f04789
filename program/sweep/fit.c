// singe fit: a sweep whose rows an optimiser (NLopt) chooses, to match measurements.
//
// Each evaluation is a row of a sweep. The optimiser is deterministic, so an interrupted fit asks for the same rows
// again: rows that are complete and have their line in fit.csv are not run again.
//
// The error of a complete row is the sum of
//   ((v - v0)/v0)^2                             of the front's speed in the last frame,
//   mean ((T(t) - T0(t))/(max T0 - min T0))^2   of the curve, over its points,
//   the share of pixels that differ             of the masks, over the sheet and all frames with a mask.
#include <math.h>
#include <nlopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/args.h"
#include "cli/csv.h"
#include "cli/folder.h"
#include "cli/interrupt.h"
#include "cli/pictures.h"
#include "cli/text.h"
#include "formats/formats.h"
#include "formats/uv_raster.h"
#include "sweep/sweep.h"

static const ArgOption fit_options[] = {
    {"output", 'o', "DIR", "folder of the fit [out/NAME]", .read = args_text, offsetof(SweepOptions, output)},
    {ARGS_THREADS(SweepOptions)},
    {"quiet", 'q', NULL, "prints only warnings, errors and the result", .read = args_switch,
     offsetof(SweepOptions, quiet)},
};

const ArgCommand fit_command = {
    "fit",
    "PLAN",
    "Finds the parameters with which a scene best matches measurements.",
    ARGS_OPTIONS(fit_options),
    "docs/sweep.md describes plans. Repeat the command to continue a fit that was stopped.\n"
    "Exit codes: 0 success, 1 a row failed or the fit was interrupted, 2 bad input.",
    "singe fit fit.yaml -o out",
    .operand_field = offsetof(SweepOptions, plan)};

/// Changes of the coordinates in [0, 1] below this end the search.
static const double parameter_tolerance = 1e-3;

/// A measured curve.
typedef struct FitCurve {
    uint32_t count;
    double *times, *temperatures; ///< s, K; times ascend
} FitCurve;

/// The measurements, read.
typedef struct FitTarget {
    const PlanTarget *plan;
    FitCurve curve;
} FitTarget;

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

// ---- the error of a row

/// Reads the files of a target. Errors have been printed unless the result is EXIT_GOOD.
static ExitCode read_target(FitTarget *target, const PlanTarget *plan, Console *console) {
    *target = (FitTarget){.plan = plan};
    if (!plan->curve.path) return EXIT_GOOD;

    FitCurve *curve = &target->curve;
    Csv csv;
    ExitCode code = csv_read(&csv, plan->curve.path, console);
    if (code) return code;

    const int time = csv_column(&csv, "time"), temperature = csv_column(&csv, "temperature");
    uint32_t count = 0;
    curve->times = csv_numbers(&csv, time, (CsvLines){0}, &curve->count);
    curve->temperatures = csv_numbers(&csv, temperature, (CsvLines){0}, &count);

    double low = INFINITY, high = -INFINITY;
    bool ascending = true;
    for (uint32_t i = 0; i < count; i++) {
        low = fmin(low, curve->temperatures[i]);
        high = fmax(high, curve->temperatures[i]);
        ascending = ascending && (i == 0 || i >= curve->count || curve->times[i] > curve->times[i - 1]);
    }

    csv_free(&csv);

    const char *why = NULL;
    if (time < 0 || temperature < 0) why = "needs columns 'time' and 'temperature'";
    else if (count != curve->count || count < 2) why = "needs at least two lines, each with a time and a temperature";
    else if (!ascending) why = "times must ascend";
    else if (!(high > low)) why = "all temperatures are the same";
    if (why) console_error(console, "%s: %s", plan->curve.path, why);
    return why ? EXIT_INPUT : EXIT_GOOD;
}

enum { MASK_SIZE = 256 };

typedef struct MaskDrawing {
    uint8_t *pixels;
    float burn[3]; ///< of the triangle's corners; all 0: the sheet as a whole
} MaskDrawing;

/// A pixel that is less than half burnt counts as paper.
static void draw_fresh(void *context, size_t pixel, const float weight[3]) {
    MaskDrawing *drawing = context;
    const float *burn = drawing->burn;
    if (weight[0] * burn[0] + weight[1] * burn[1] + weight[2] * burn[2] < 0.5f) drawing->pixels[pixel] = 1;
}

/// 1 where a frame's first sheet is paper; everywhere on it if `whole`.
static bool draw_mask(const Folder *folder, int number, bool whole, uint8_t *pixels, Console *console) {
    Frame frame = {0};
    SingeError error = {0};
    MaskDrawing drawing = {.pixels = pixels};
    const bool good = !frame_read_surface(folder, number, &frame, &error);

    memset(pixels, 0, (size_t)MASK_SIZE * MASK_SIZE);

    for (uint32_t t = 0; good && t < frame.surface.triangle_count; t++) {
        const uint32_t *v = frame.surface.triangles[t];
        float uv[3][2];
        if (frame.surface.sheet[v[0]] != 0) continue;
        for (int i = 0; i < 3; i++) {
            memcpy(uv[i], frame.surface.uv[v[i]], sizeof uv[i]);
            drawing.burn[i] = whole ? 0 : frame.surface.burn[v[i]];
        }
        uv_triangle(MASK_SIZE, (const float(*)[2])uv, draw_fresh, &drawing);
    }

    if (!good) console_result(console, &error);
    frame_free(&frame);
    return good;
}

static bool masks_error(const FitTarget *target, const Sweep *sweep, uint32_t row, double *error) {
    const char *pattern = target->plan->masks.path, *slash = strrchr(pattern, '/');
    const char *run = strchr(slash ? slash : pattern, '#');
    const int width = (int)strspn(run, "#");

    const size_t pixels = (size_t)MASK_SIZE * MASK_SIZE;
    char *path = sweep_row_folder(sweep, row, true);
    Folder folder = folder_name(path, sweep->name);
    uint8_t *sheet = malloc(pixels), *fresh = malloc(pixels);
    bool good = sheet && fresh && draw_mask(&folder, 1, true, sheet, sweep->console);
    uint32_t count = 0;
    double sum = 0;
    for (uint32_t frame = 1; good && frame <= sweep->frames[row]; frame++) {
        char *mask = text_format("%.*s%0*d%s", (int)(run - pattern), pattern, width, (int)frame, run + width);
        if (access(mask, F_OK) == 0) {
            Bytes bytes = {0};
            Image image = {0};
            SingeError read_error = {0};
            good = !file_read(mask, (SingeAllocator){0}, &bytes, &read_error) &&
                   !image_read(mask, bytes.data, bytes.size, (SingeAllocator){0}, &image, &read_error);
            if (!good) console_result(sweep->console, &read_error);
            good = good && draw_mask(&folder, (int)frame, false, fresh, sweep->console);
            count += good;

            // the share of the sheet's pixels that are burnt in only one of the two
            uint32_t different = 0, all = 0;
            for (size_t pixel = 0; good && pixel < pixels; pixel++) {
                if (!sheet[pixel]) continue;
                const size_t column = pixel % MASK_SIZE * (size_t)image.width / MASK_SIZE;
                const size_t line = pixel / MASK_SIZE * (size_t)image.height / MASK_SIZE;
                const uint8_t *rgb = image.rgb + 3 * (line * (size_t)image.width + column);
                const bool burnt = rgb[0] + rgb[1] + rgb[2] >= 3 * 128;
                all++;
                different += burnt == (fresh[pixel] != 0);
            }

            if (good) sum += all ? (double)different / all : 1;
            image_free(&image);
            bytes_free(&bytes);
        }

        free(mask);
    }

    if (good && !count) {
        console_error(sweep->console, "%s: no frame has a mask of this name", pattern);
        good = false;
    }

    if (good) *error += sum / count;
    free(sheet);
    free(fresh);
    free(path);
    folder_free(&folder);
    return good;
}

/// The error of a complete row. False if it lacks the compared data; an error has been printed.
static bool fit_error(const FitTarget *target, const Sweep *sweep, uint32_t row, double *error) {
    bool good = true;
    *error = 0;
    if (target->plan->front_speed > 0) {
        char *folder = sweep_row_folder(sweep, row, true), *path = text_format("%s/stats.csv", folder);
        Csv csv = {0};
        uint32_t count = 0;
        good = !csv_read(&csv, path, sweep->console);
        double *speeds = csv_numbers(&csv, csv_column(&csv, "front_speed"), (CsvLines){0}, &count);

        if (good && count == 0) console_error(sweep->console, "%s has no front_speed", path);
        good = good && count > 0;
        if (good) *error += pow(speeds[count - 1] / target->plan->front_speed - 1, 2);
        csv_free(&csv);
        free(speeds);
        free(path);
        free(folder);
    }

    if (good && target->plan->curve.path) {
        char *folder = sweep_row_folder(sweep, row, true), *path = text_format("%s/probes.csv", folder);
        const FitCurve *measured = &target->curve;
        Csv csv = {0};
        uint32_t count = 0, times_count = 0;
        good = !csv_read(&csv, path, sweep->console);

        const CsvLines lines = {"probe", target->plan->probe, "temperature"}; // none once the paper is gone
        double *values = csv_numbers(&csv, csv_column(&csv, "temperature"), lines, &count);
        double *times = csv_numbers(&csv, csv_column(&csv, "time"), lines, &times_count);

        if (good && (count == 0 || times_count != count)) {
            console_error(sweep->console, "%s has no temperatures of probe '%s'", path, target->plan->probe);
            good = false;
        }

        double sum = 0, low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; good && i < measured->count; i++) {
            // linear between the points of the simulated curve; once the paper is gone the last temperature remains
            const double time = measured->times[i];
            uint32_t k = 0;
            while (k < count && times[k] < time) k++;

            double simulated = values[k < count ? k : count - 1];
            if (k > 0 && k < count) {
                const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
                simulated = values[k - 1] + share * (values[k] - values[k - 1]);
            }

            sum += pow(simulated - measured->temperatures[i], 2);
            low = fmin(low, measured->temperatures[i]);
            high = fmax(high, measured->temperatures[i]);
        }

        if (good) *error += sum / measured->count / pow(high - low, 2);
        csv_free(&csv);
        free(values);
        free(times);
        free(path);
        free(folder);
    }

    return good && target->plan->masks.path ? masks_error(target, sweep, row, error) : good;
}

// ---- fit.csv

static char *table_path(const Fit *fit) { return text_format("%s/fit.csv", fit->sweep->folder); }

// ---- an evaluation

/// The error of a row whose values are set: from fit.csv, or after running it.
static ExitCode row_error(Fit *fit, uint32_t row, double *value) {
    // its line in fit.csv, up to its error
    const Plan *plan = &fit->sweep->plan;
    char *line;
    FILE *file = text_open(&line);
    fprintf(file, "%u", row + 1);
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        fputc(',', file);
        text_csv_cell(file, plan_value(plan, row, p));
    }
    fputc(',', file);
    text_close(file, &line);

    // the line noted earlier for this row, behind the header and the earlier rows
    const char *at = fit->noted;
    for (uint32_t i = 0; i <= row && at; i++) {
        at = strchr(at, '\n');
        if (at) at++;
    }

    ExitCode code = EXIT_GOOD;
    if (at && *at && strncmp(at, line, strlen(line)) == 0) {
        *value = atof(at + strlen(line));
    } else if (at && *at) {
        console_error(fit->sweep->console,
                      "fit.csv in %s belongs to another fit: line %u differs; use another folder (-o)",
                      fit->sweep->folder, row + 2);
        code = EXIT_INPUT;
    } else {
        // run the row and measure it
        Console *console = fit->sweep->console;
        const bool quiet = console->quiet;
        code = sweep_check_row(fit->sweep, row);

        fit->options->row = (int)row + 1;
        fit->options->retry = true;
        console->quiet = true;
        if (!code) code = sweep_run_rows(fit->sweep);
        console->quiet = quiet;
        if (!code && !fit_error(fit->target, fit->sweep, row, value)) code = EXIT_FAILED;

        // note it
        if (!code) {
            char *path = table_path(fit), *longer = text_format("%s%s%.17g\n", fit->noted, line, *value);
            SingeError error = {0};
            if (file_write(path, longer, strlen(longer), &error)) {
                console_result(console, &error);
                code = EXIT_FAILED;
            }
            free(fit->noted);
            free(path);
            fit->noted = longer;
        }
    }

    free(line);
    return code;
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

    // an earlier row may have the same values: the optimiser returns to points, and numbers are rounded
    for (uint32_t before = 0; before < row; before++) {
        uint32_t p = 0;
        while (p < plan->parameter_count && strcmp(plan_value(plan, before, p), plan_value(plan, row, p)) == 0) p++;
        if (p == plan->parameter_count) return fit->errors[before];
    }

    const ExitCode code = row_error(fit, row, &fit->errors[row]);
    if (code || interrupt_asked()) return stop(fit, code ? code : EXIT_FAILED);

    const double value = fit->errors[row];
    if (value < fit->best) {
        fit->best = value;
        fit->best_row = row;
    }

    fit->row++;

    char *text = text_format("%u:", row + 1);
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        char *longer = text_format("%s %s=%s", text, plan_label(plan, p), plan_value(plan, row, p));
        free(text);
        text = longer;
    }

    console_note(fit->sweep->console, "%s: error %.6g (best %.6g)", text, value, fit->best);
    free(text);
    return value;
}

// ---- the fit

static void print_result(const Fit *fit) {
    const Plan *plan = &fit->sweep->plan;
    char *scene = text_shell_quote(plan->scene.path);

    printf("row %u of %u, error %.6g:\nsinge run %s", fit->best_row + 1, fit->row, fit->best, scene);
    free(scene);

    for (uint32_t i = 0; i < plan->set_count + plan->parameter_count; i++) {
        char *set = i < plan->set_count ? text_format("%s", plan->sets[i])
                                        : text_format("%s=%s", plan->parameters[i - plan->set_count].key,
                                                      plan_value(plan, fit->best_row, i - plan->set_count));
        char *quoted = text_shell_quote(set);
        printf(" --set %s", quoted);
        free(set);
        free(quoted);
    }

    putchar('\n');
}

static ExitCode search(Fit *fit) {
    const Plan *plan = &fit->sweep->plan;
    const unsigned count = plan->parameter_count;
    Console *console = fit->sweep->console;

    // fit.csv: its header, or what an earlier fit has left
    FILE *file = text_open(&fit->noted);
    fputs("row", file);
    for (unsigned p = 0; p < count; p++) {
        fputc(',', file);
        text_csv_cell(file, plan->parameters[p].key);
    }

    fputs(",error\n", file);
    text_close(file, &fit->noted);
    char *path = table_path(fit);
    Bytes bytes = {0};
    SingeError error = {0};
    if (!file_read(path, (SingeAllocator){0}, &bytes, &error)) {
        free(fit->noted);
        fit->noted = text_format("%s", (const char *)bytes.data);
    }

    bytes_free(&bytes);
    free(path);

    nlopt_opt optimiser = fit->optimiser =
        nlopt_create(plan->search == PLAN_SEARCH_GLOBAL ? NLOPT_GN_DIRECT_L : NLOPT_LN_SBPLX, count);

    fit->errors = calloc(plan->evaluations, sizeof *fit->errors);
    bool good = fit->errors && optimiser && nlopt_set_lower_bounds1(optimiser, 0) > 0 &&
                nlopt_set_upper_bounds1(optimiser, 1) > 0 && nlopt_set_min_objective(optimiser, objective, fit) > 0 &&
                nlopt_set_maxeval(optimiser, 10 * (int)plan->evaluations) > 0 && // including repeated points
                nlopt_set_xtol_abs1(optimiser, parameter_tolerance) > 0 && nlopt_set_initial_step1(optimiser, 0.25) > 0;
    if (!good) {
        console_error(console, "out of memory");
        return EXIT_FAILED;
    }

    double coordinates[PLAN_PARAMETERS_MAX], least;
    for (unsigned p = 0; p < count; p++) coordinates[p] = 0.5;
    const nlopt_result result = nlopt_optimize(optimiser, coordinates, &least);

    // rounding ends a search near a minimum: the best point is valid
    const bool spent = result == NLOPT_FORCED_STOP && fit->row == plan->evaluations;
    if (!fit->code && result < 0 && !spent && result != NLOPT_ROUNDOFF_LIMITED) {
        console_error(console, "the search failed: %s", nlopt_result_to_string(result));
        fit->code = EXIT_FAILED;
    }

    if (!fit->code) print_result(fit);
    else if (interrupt_asked()) console_note(console, "the same command continues the fit");
    return fit->code;
}

int command_fit(int argc, char **argv) {
    SweepOptions options = {.threads = job_threads(), .jobs = 1, .no_preview = true};
    ExitCode code;
    if (!args_read(&fit_command, argc, argv, &options, &code)) return code;

    interrupt_shield();
    Console console = console_make(options.quiet);
    Sweep sweep = sweep_make(&console, &options);
    FitTarget target = {0};

    code = plan_read(options.plan, true, &console, &sweep.plan);
    if (!code) code = read_target(&target, &sweep.plan.target, &console);
    if (!code) code = sweep_prepare(&sweep);

    if (!code) {
        Fit fit = {.sweep = &sweep, .options = &options, .target = &target, .best = HUGE_VAL};
        interrupt_watch();
        code = search(&fit);
        nlopt_destroy(fit.optimiser);
        free(fit.noted);
        free(fit.errors);
    }

    free(target.curve.times);
    free(target.curve.temperatures);
    sweep_close(&sweep);
    return code;
}

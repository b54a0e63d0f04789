// singe bench plot: cost against springs, the paper's Table 2 and ours, as SVG.
#include <stdio.h>
#include <stdlib.h>

#include "bench/curves.h"
#include "cli/args.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "cli/console.h"

enum { OPT_OUT, OPT_COUNT };

static const ArgOption plot_options[OPT_COUNT] = {
    [OPT_OUT] = {"out", 'o', "FILE.svg", "where the picture goes"},
};

static const ArgCommand plot_command = {
    .name = "bench plot",
    .operand = "FILE.csv...",
    .summary = "Draws the milliseconds per step over the number of springs, with the paper's Table 2, from tables\n"
               "written with --csv (columns springs and step_ms).",
    .options = plot_options,
    .option_count = OPT_COUNT,
};

/// Reads all named curves, and `*out`.
static ExitCode read_all(ArgReader *reader, Curves *curves, const char **out, bool *help) {
    Console console = console_make(false);
    const char *value;
    int option;

    while ((option = args_next(reader, &value)) != ARG_END) {
        SingeError error = {.element = -1};
        if (option == ARG_HELP) *help = true;
        if (option == ARG_HELP) return EXIT_GOOD;
        if (option == ARG_ERROR) return EXIT_INPUT;
        if (option == OPT_OUT) *out = value;
        if (option != ARG_OPERAND || curves_read(curves, value, &error) == SINGE_OK) continue;
        console_result(&console, &error);
        return EXIT_INPUT;
    }

    if (*out) return EXIT_GOOD;
    args_complain(reader, "needs -o FILE.svg");
    return EXIT_INPUT;
}

int bench_plot(int argc, char **argv) {
    ArgReader reader = args_begin(&plot_command, argc, argv);
    Curves *curves = calloc(1, sizeof *curves);
    const char *out = NULL;
    bool help = false;

    if (!curves) {
        fputs("singe bench plot: error: out of memory\n", stderr);
        return EXIT_FAILED;
    }
    curves_add_paper(curves);
    ExitCode code = read_all(&reader, curves, &out, &help);
    if (code == EXIT_GOOD && !help) {
        Console console = console_make(false);
        SingeError error = {.element = -1};
        code = curves_draw(curves, out, &error) == SINGE_OK ? EXIT_GOOD : EXIT_FAILED;
        if (code == EXIT_GOOD) printf("%s\n", out);
        else console_result(&console, &error);
    }

    free(curves);
    return code;
}

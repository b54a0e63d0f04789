// singe paper: the paper's tables and figures about its solver, computed here and set beside its own numbers.
#include "cli/paper.h"

#include <stdio.h>
#include <string.h>

#include "cli/args.h"

static const struct {
    const char *name;
    ExitCode (*run)(const PaperOptions *options);
} parts[] = {
    {"table1", paper_table1}, {"table2", paper_table2}, {"fig8", paper_fig8}, {"all-at-once", paper_all_at_once}};

enum { PART_COUNT = sizeof parts / sizeof *parts };

enum { OPT_OUTPUT, OPT_QUICK, OPT_THREADS, OPT_COUNT };

static const ArgOption paper_options[OPT_COUNT] = {
    [OPT_OUTPUT] = {"output", 'o', "DIR", "where fig8's files go [.]"},
    [OPT_QUICK] = {"quick", 0, NULL, "table2 without its slow rows"},
    [OPT_THREADS] = {"threads", 0, "N", "threads of table2 [1]"},
};

static const ArgCommand paper_command = {
    "paper", "WHAT", "Computes what the paper says about its solver.", paper_options, OPT_COUNT,
    "WHAT is one of\n"
    "  table1       two springs that exclude each other, projected in turn: the ten positions\n"
    "  table2       time of a step, with early exit and fully iterated, beside the paper's and strand's\n"
    "  fig8         error of each colour and their sum over projection steps, as CSV and SVG\n"
    "  all-at-once  all colours in one system: its rank, singular values and error, beside the successive method's\n"
    "\n"
    "Exit codes: 0 good, 1 failed, 2 bad usage."};

ExitCode paper_fail(const SingeError *error) {
    fprintf(stderr, "singe: error: %s\n", error->message[0] ? error->message : singe_result_name(error->code));
    return EXIT_FAILED;
}

/// The part that a word names, or -1 with a message.
static int part_find(const ArgReader *reader, const char *word) {
    for (int i = 0; i < PART_COUNT; i++)
        if (strcmp(word, parts[i].name) == 0) return i;
    const char *near = args_nearest(word, parts, PART_COUNT, sizeof parts[0]);
    if (near) args_complain(reader, "unknown WHAT '%s'; did you mean '%s'?", word, near);
    else args_complain(reader, "unknown WHAT '%s': expected table1, table2, fig8 or all-at-once", word);
    return -1;
}

int command_paper(int argc, char **argv) {
    ArgReader reader = args_begin(&paper_command, argc, argv);
    PaperOptions options = {.folder = ".", .threads = 1};
    const char *value;
    int part = -1;
    for (int option; (option = args_next(&reader, &value)) != ARG_END;) {
        switch (option) {
        case ARG_OPERAND:
            if ((part = part_find(&reader, value)) < 0) return EXIT_INPUT;
            break;
        case OPT_OUTPUT:
            if (!value[0]) return args_complain(&reader, "--output needs a folder"), EXIT_INPUT;
            options.folder = value;
            break;
        case OPT_QUICK: options.quick = true; break;
        case OPT_THREADS:
            if (!args_int(&reader, option, value, 1, 64, &options.threads)) return EXIT_INPUT;
            break;
        case ARG_HELP: return EXIT_GOOD;
        default: return EXIT_INPUT;
        }
    }
    return parts[part].run(&options);
}

#include "bench/bench_args.h"
#include "common/printable.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const ArgOption bench_all_options[BENCH_OPT_COUNT] = {
    [BENCH_OPT_CELLS] = {"cells", 0, "N,N,...", "cells per side of the sheet, 2 to 2000"},
    [BENCH_OPT_SHEETS] = {"sheets", 0, "N,N,...", "sheets on top of each other, 1 to 1000"},
    [BENCH_OPT_THICKNESS] = {"thickness", 0, "MM,MM,...", "distance between the two layers, 0.01 to 100 mm"},
    [BENCH_OPT_PINS] = {"pins", 0, "1|2", "number of corners that are held [2]"},
    [BENCH_OPT_TIME] = {"time", 0, "S", "seconds of motion, 0.01 to 60"},
    [BENCH_OPT_SUBSTEPS] = {"substeps", 0, "N", "substeps per step, 1 to 1000 [3, or the measurement's own]"},
    [BENCH_OPT_STEPS] = {"steps", 0, "N", "steps per frame of 1/24 s, 1 to 1000 [20; swing: 1 of 60 or 240 substeps]"},
    [BENCH_OPT_SMOOTHING] = {"smoothing", 0, "RATE", "internal friction, 0 to 1e6 per second"},
    [BENCH_OPT_THREADS] = {"threads", 0, "N", "threads [1]"},
    [BENCH_OPT_SOLVER] = {"solver", 0, "METHOD", "strand, paper, paper-literal, all-at-once or mass-spring [strand]"},
    [BENCH_OPT_INSTRUCTIONS] = {"instructions", 0, "SET", "best, plain, v2, v3, v4, neon or simd128 [best]"},
    [BENCH_OPT_PROJECTIONS] = {"projections", 0, "N", "projections per substep, 1 to 1000 [the solver's]"},
    [BENCH_OPT_SPRINGS] = {"springs", 0, "N,N,...", "sizes, 40 to 40000000 springs"},
    [BENCH_OPT_STATE] = {"state", 0, "swing|shrink", "motion of the sheet [swing]"},
    [BENCH_OPT_LIMIT] = {"limit-ms", 0, "MS", "fails if a step takes longer, at the pace of the reference machine"},
    [BENCH_OPT_QUICK] = {"quick", 0, NULL, "a short run"},
    [BENCH_OPT_TIMED] = {"steps", 0, "N", "steps to time, 1 to 100000 [by size]"},
    [BENCH_OPT_MATERIAL] = {"material", 0, "NAME,NAME,...", "materials or material files [all built-in ones]"},
    [BENCH_OPT_CURVATURE] = {"curvature", 0, "1/M,1/M,...", "curvature_max, 0 (none) to 1e6 [the material's]"},
    [BENCH_OPT_SEEDS] = {"seeds", 0, "N,N,...", "seeds of the noise, 1 to 1000000 [1,2,3,4]"},
    [BENCH_OPT_OUTLINE] = {"outline", 0, "square|disc", "only this outline [both]"},
    [BENCH_OPT_CREASES] = {"creases", 0, NULL, "sharp bends leave creases, by the material's crease_radius"},
    [BENCH_OPT_RED] = {"red", 0, "M/N", "compliance of red springs, 1e-6 to 1e6 m/N [the material's]"},
    [BENCH_OPT_JSON] = {"json", 0, NULL, "prints JSON"},
    [BENCH_OPT_CSV] = {"csv", 0, "FILE", "also writes the table to FILE"},
    [BENCH_OPT_SVG] = {"svg", 0, "FILE", "also draws what was measured, as SVG"},
};

/// A command with only the accepted options, and the index of each among all options.
typedef struct Parser {
    ArgOption options[BENCH_OPT_COUNT];
    int which[BENCH_OPT_COUNT];
    ArgCommand command;
    ArgReader reader;
    int option; ///< being read
} Parser;

static bool bench_args_refuse(const Parser *parser, const char *expected, const char *text) {
    args_complain(&parser->reader, "--%s: expected %s, got '%s'", parser->options[parser->option].name, expected,
                  shown(text).text);
    return false;
}

static bool read_number(const char *text, char **end, double low, double high, double *number) {
    errno = 0;
    *number = strtod(text, end);
    return errno == 0 && *end != text && *number >= low && *number <= high; // NaN is refused
}

static bool read_one(const Parser *parser, const char *text, double low, double high, const char *expected,
                     double *number) {
    char *end;
    return (read_number(text, &end, low, high, number) && *end == 0) || bench_args_refuse(parser, expected, text);
}

/// Reads "1,2,3", each times `unit`.
static bool read_list(const Parser *parser, const char *text, double low, double high, bool whole, double unit,
                      const char *expected, BenchList *list) {
    list->count = 0;
    for (const char *at = text;; at++) {
        char *end;
        double number;
        if (!read_number(at, &end, low, high, &number) || (whole && number != floor(number)))
            return bench_args_refuse(parser, expected, text);
        if (list->count == BENCH_LIST_MAX) return bench_args_refuse(parser, "at most 16 numbers", text);
        list->values[list->count++] = number * unit;
        if (*end == 0) return true;
        if (*end != ',') return bench_args_refuse(parser, expected, text);
        at = end;
    }
}

/// One of the words, which end with NULL. The message lists them.
static bool read_word(const Parser *parser, const char *text, const char *const *words, int *value) {
    char expected[160] = "";
    for (*value = 0; words[*value]; ++*value) {
        if (strcmp(words[*value], text) == 0) return true;
        const char *before = *value == 0 ? "" : words[*value + 1] ? ", " : " or ";
        const size_t length = strlen(expected);
        snprintf(expected + length, sizeof expected - length, "%s%s", before, words[*value]);
    }

    return bench_args_refuse(parser, expected, text);
}

static bool read_option(Parser *parser, const char *text, BenchRequest *request) {
    BenchOptions *o = &request->options;
    const ArgReader *reader = &parser->reader;
    const int option = parser->option;

    switch ((BenchOption)parser->which[option]) {
    case BENCH_OPT_CELLS:
        return read_list(parser, text, 2, 2000, true, 1, "whole numbers from 2 to 2000 as in 32,100", &o->cells);
    case BENCH_OPT_SHEETS:
        return read_list(parser, text, 1, 1000, true, 1, "whole numbers from 1 to 1000 as in 10,50", &o->sheets);
    case BENCH_OPT_THICKNESS:
        return read_list(parser, text, 0.01, 100, false, 1e-3, "millimetres from 0.01 to 100 as in 1,2.5",
                         &o->thickness);
    case BENCH_OPT_PINS: return args_int(reader, option, text, 1, 2, &o->pins);
    case BENCH_OPT_TIME: return read_one(parser, text, 0.01, 60, "seconds from 0.01 to 60", &o->time);
    case BENCH_OPT_SUBSTEPS: return args_int(reader, option, text, 1, 1000, &o->substeps);
    case BENCH_OPT_STEPS: return args_int(reader, option, text, 1, 1000, &o->steps);
    case BENCH_OPT_SMOOTHING: return read_one(parser, text, 0, 1e6, "a number from 0 to 1e6", &o->smoothing);
    case BENCH_OPT_THREADS: return args_int(reader, option, text, 1, 64, &o->threads);
    case BENCH_OPT_SOLVER: {
        int value;
        if (!read_word(parser, text, enum_words.SingeSolverMethod, &value)) return false;
        o->solver = (SingeSolverMethod)value;
        return true;
    }
    case BENCH_OPT_INSTRUCTIONS: {
        int value;
        if (!read_word(parser, text, enum_words.SingeInstructions, &value)) return false;
        o->instructions = (SingeInstructions)value;
        return true;
    }
    case BENCH_OPT_PROJECTIONS: return args_int(reader, option, text, 1, 1000, &o->projections);
    case BENCH_OPT_SPRINGS:
        return read_list(parser, text, 40, 4e7, true, 1, "whole numbers from 40 to 40000000 as in 1000,16000",
                         &o->springs);
    case BENCH_OPT_STATE: {
        static const char *const words[] = {"swing", "shrink", NULL};
        int value;
        if (!read_word(parser, text, words, &value)) return false;
        o->state = (BenchState)value;
        return true;
    }
    case BENCH_OPT_LIMIT: return read_one(parser, text, 1e-3, 1e6, "milliseconds from 0.001 to 1e6", &o->limit_ms);
    case BENCH_OPT_QUICK: o->quick = true; return true;
    case BENCH_OPT_TIMED: return args_int(reader, option, text, 1, 100000, &o->steps);
    case BENCH_OPT_MATERIAL: request->materials = text; return true;
    case BENCH_OPT_CURVATURE:
        return read_list(parser, text, 0, 1e6, false, 1, "numbers from 0 to 1e6 as in 0,390", &o->curvature);
    case BENCH_OPT_SEEDS:
        return read_list(parser, text, 1, 1e6, true, 1, "whole numbers from 1 to 1000000 as in 1,2", &o->seeds);
    case BENCH_OPT_OUTLINE: {
        static const char *const words[] = {"square", "disc", NULL};
        int value;
        if (!read_word(parser, text, words, &value)) return false;
        o->outline = value ? BENCH_DISC : BENCH_SQUARE;
        return true;
    }
    case BENCH_OPT_CREASES: o->creases = true; return true;
    case BENCH_OPT_RED: return read_one(parser, text, 1e-6, 1e6, "m/N from 1e-6 to 1e6", &o->red);
    case BENCH_OPT_JSON: request->json = true; return true;
    case BENCH_OPT_CSV: request->csv = text; return true;
    case BENCH_OPT_SVG: request->svg = text; return true;
    case BENCH_OPT_COUNT: break;
    }
    return false;
}

int bench_args_read(const char *name, const char *summary, unsigned accepted, int argc, char **argv,
                    BenchRequest *request) {
    Parser parser = {.command = {.name = name, .summary = summary, .options = parser.options}};
    const char *value;
    *request = (BenchRequest){.options = bench_options()};
    for (int i = 0; i < BENCH_OPT_COUNT; i++) {
        if (!(accepted >> i & 1)) continue;
        parser.options[parser.command.option_count] = bench_all_options[i];
        parser.which[parser.command.option_count++] = i;
    }

    parser.reader = args_begin(&parser.command, argc, argv);
    while ((parser.option = args_next(&parser.reader, &value)) >= 0)
        if (!read_option(&parser, value, request)) return ARG_ERROR;
    return parser.option;
}

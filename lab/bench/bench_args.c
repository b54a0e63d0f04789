#include "bench/bench.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/job.h"
#include "cli/text.h"
#include "common/printable.h"

#define FIELD(name) offsetof(BenchRequest, options.name)

/// Reads "1,2,3": whole numbers, or what the value's name in the help says.
static bool read_list(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    const bool whole = option->value[0] == 'N';
    const double unit = option->value[0] == 'M' ? 1e-3 : 1; // millimetres
    BenchList *list = field;
    list->count = 0;
    for (const char *at = text;; at++) {
        char *end;
        errno = 0;
        const double number = strtod(at, &end);
        const bool inside = number >= option->low && number <= option->high; // NaN is not
        if (errno || end == at || !inside || (whole && number != floor(number)) || (*end && *end != ','))
            return args_complain(command, "--%s: expected %snumbers from %.10g to %.10g as %s, got '%s'", option->name,
                                 whole ? "whole " : "", option->low, option->high, option->value, shown(text).text);
        if (list->count == BENCH_LIST_MAX)
            return args_complain(command, "--%s: expected at most 16 numbers, got '%s'", option->name,
                                 shown(text).text);

        list->values[list->count++] = number * unit;
        if (*end == 0) return true;
        at = end;
    }
}

/// The number of one of the option's words. The message lists them.
static bool read_word(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    static const char *const states[] = {"swing", "shrink", NULL}, *const outlines[] = {"square", "disc", NULL};
    const char *const *words = option->field == FIELD(solver)         ? enum_words.SingeSolverMethod
                               : option->field == FIELD(instructions) ? enum_words.SingeInstructions
                               : option->field == FIELD(state)        ? states
                                                                      : outlines;
    char expected[160] = "";
    for (int i = 0; words[i]; i++) {
        if (strcmp(words[i], text) == 0) {
            *(int *)field = i + (words == outlines); // no outline is 0
            return true;
        }
        const char *before = i == 0 ? "" : words[i + 1] ? ", " : " or ";
        const size_t length = strlen(expected);
        snprintf(expected + length, sizeof expected - length, "%s%s", before, words[i]);
    }

    return args_complain(command, "--%s: expected %s, got '%s'", option->name, expected, shown(text).text);
}

const ArgOption bench_all_options[BENCH_OPTION_COUNT] = {
    {"cells", 0, "N,N,...", "cells per side of the sheet, 2 to 2000", .read = read_list, FIELD(cells), 2, 2000},
    {"sheets", 0, "N,N,...", "sheets on top of each other, 1 to 1000", .read = read_list, FIELD(sheets), 1, 1000},
    {"thickness", 0, "MM,MM,...", "distance between the two layers, 0.01 to 100 mm", .read = read_list,
     FIELD(thickness), 0.01, 100},
    {"pins", 0, "1|2", "number of corners that are held [2]", .read = args_int, FIELD(pins), 1, 2},
    {"time", 0, "S", "seconds of motion, 0.01 to 60", .read = args_number, FIELD(time), 0.01, 60},
    {"substeps", 0, "N", "substeps per step, 1 to 1000 [3, or the measurement's own]", .read = args_int,
     FIELD(substeps), 1, 1000},
    {"steps", 0, "N",
     "steps of a frame of 1/24 s [20; swing: 1 of 38 or 84 substeps], or to time [by size], 1 to 100000",
     .read = args_int, FIELD(steps), 1, 100000},
    {"start", 0, "SHARE", "the solver's `start`, 0 to 0.65 [0; swing: 0.63]", .read = args_number, FIELD(start), 0,
     0.65},
    {"smoothing", 0, "RATE", "internal friction, 0 to 1e6 per second", .read = args_number, FIELD(smoothing), 0, 1e6},
    {"threads", 0, "N", "threads [1]", .read = args_int, FIELD(threads), 1, JOB_THREADS_MAX},
    {"solver", 0, "METHOD", "strand, paper, paper-literal, all-at-once or mass-spring [strand]", .read = read_word,
     FIELD(solver)},
    {"instructions", 0, "SET", "best, plain, v2, v3, v4, neon or simd128 [best]", .read = read_word,
     FIELD(instructions)},
    {"projections", 0, "N", "projections per substep, 1 to 1000 [the solver's]", .read = args_int, FIELD(projections),
     1, 1000},
    {"springs", 0, "N,N,...", "sizes, 40 to 40000000 springs", .read = read_list, FIELD(springs), 40, 4e7},
    {"state", 0, "swing|shrink", "motion of the sheet [swing]", .read = read_word, FIELD(state)},
    {"limit-ms", 0, "MS", "fails if a step takes longer, at the pace of the reference machine", .read = args_number,
     FIELD(limit_ms), 1e-3, 1e6},
    {"quick", 0, NULL, "a short run", .read = args_switch, FIELD(quick)},
    {"material", 0, "NAME,NAME,...", "materials or material files [all built-in ones]", .read = args_text,
     offsetof(BenchRequest, materials)},
    {"curvature", 0, "1/M,1/M,...", "curvature_max, 0 (none) to 1e6 [the material's]", .read = read_list,
     FIELD(curvature), 0, 1e6},
    {"seeds", 0, "N,N,...", "seeds of the noise, 1 to 1000000 [1,2,3,4]", .read = read_list, FIELD(seeds), 1, 1e6},
    {"outline", 0, "square|disc", "only this outline [both]", .read = read_word, FIELD(outline)},
    {"creases", 0, NULL, "sharp bends leave creases, by the material's crease_radius", .read = args_switch,
     FIELD(creases)},
    {"isotropic", 0, NULL, "bending is isotropic, with braces", .read = args_switch, FIELD(isotropic)},
    {"red", 0, "M/N", "compliance of red springs, 1e-6 to 1e6 m/N [the material's]", .read = args_number, FIELD(red),
     1e-6, 1e6},
    {"json", 0, NULL, "prints JSON", .read = args_switch, offsetof(BenchRequest, json)},
    {"csv", 0, "FILE", "also writes the table to FILE", .read = args_text, offsetof(BenchRequest, csv)},
    {"svg", 0, "FILE", "also draws what was measured, as SVG", .read = args_text, offsetof(BenchRequest, svg)},
};

bool bench_takes(const char *accepted, const char *option) {
    char word[32];
    snprintf(word, sizeof word, " %s ", option);
    return strstr(accepted, word);
}

bool bench_args_read(const char *name, const char *summary, const char *accepted, int argc, char **argv,
                     BenchRequest *request, ExitCode *code) {
    char full[32];
    snprintf(full, sizeof full, "bench %s", name);
    ArgOption options[BENCH_OPTION_COUNT];
    ArgCommand command = {.name = full, .summary = summary, .options = options};
    for (int i = 0; i < BENCH_OPTION_COUNT; i++)
        if (bench_takes(accepted, bench_all_options[i].name)) options[command.option_count++] = bench_all_options[i];
    *request = (BenchRequest){.options = bench_options()};
    return args_read(&command, argc, argv, request, code);
}

// ----

int options_cells(double springs) {
    double cells = round(sqrt(springs / 10));
    return cells < 2 ? 2 : (int)cells;
}

int options_steps(const BenchOptions *options) { return options->steps ? options->steps : 20; }
int options_substeps(const BenchOptions *options) { return options->substeps ? options->substeps : 3; }

BenchList bench_list(const BenchList *asked, int count, const double *defaults) {
    if (asked->count) return *asked;
    BenchList list = {.count = count};
    for (int i = 0; i < count; i++) list.values[i] = defaults[i];
    return list;
}

// ---- materials

/// A material is read as the material of a sheet in a scene, so that its errors are reported in the same way.
static ExitCode read_one(const char *name, size_t length, BenchMaterials *materials) {
    static const char text[] = "sheets: [{grid: {size: [1, 1], cells: [1, 1]}}]";
    char *set = text_format("sheets.0.material.base=%.*s", (int)length, name);
    const char *sets[] = {set};
    SceneMessages messages = {0};
    Scene **scene = &materials->scenes[materials->count];
    SingeResult result = scene_parse("material", text, sizeof text - 1, ".", sets, 1, scene, &messages);

    scene_messages_print(&messages, stderr);
    scene_messages_free(&messages);
    free(set);
    if (result) return job_exit(result);

    const SceneMaterial *material = &(*scene)->sheets[0].material;
    BenchMaterial *bench = &materials->items[materials->count++];
    *bench = (BenchMaterial){.name = material->name ? material->name : "-",
                             .def = material->def,
                             .calibrated = material->measured.given && material->measured.calibrated};
    memcpy(bench->speed, material->measured.speed, sizeof bench->speed);
    memcpy(bench->temperature, material->measured.temperature, sizeof bench->temperature);
    memcpy(bench->residue, material->measured.residue, sizeof bench->residue);
    return EXIT_GOOD;
}

ExitCode bench_materials_open(const char *list, BenchMaterials *materials) {
    ExitCode code = EXIT_GOOD;
    const char *name;
    *materials = (BenchMaterials){0};
    for (int i = 0; !list && !code && (name = scene_material_name(i)) && i < BENCH_MATERIALS_MAX; i++)
        code = read_one(name, strlen(name), materials);

    while (list && !code) {
        size_t length = strcspn(list, ",");
        if (materials->count == BENCH_MATERIALS_MAX) {
            fprintf(stderr, "singe bench: error: at most %d materials\n", BENCH_MATERIALS_MAX);
            return EXIT_INPUT;
        }
        code = read_one(list, length, materials);
        list = list[length] ? list + length + 1 : NULL;
    }

    return code;
}

void bench_materials_close(BenchMaterials *materials) {
    for (int i = 0; i < BENCH_MATERIALS_MAX; i++) scene_free(materials->scenes[i]);
    *materials = (BenchMaterials){0};
}

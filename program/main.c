#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cli/args.h"
#include "cli/cli.h"
#include "cli/console.h"
#include "common/printable.h"
#include "scene/scene.h"

/// The commands, group by group: of the help, the manual, completion and every message that lists them.
static const Command commands[] = {
    {"new", command_new, &new_command, "burn", "writes a commented scene to start from"},
    {"run", command_run, &run_command, "burn", "burns a scene: cache, pictures, video, numbers"},
    {"check", command_check, &check_command, "burn", "checks a scene, and prints its size and cost"},
    {"info", command_info, &info_command, "burn",
     "prints what a run's folder holds: frames, sizes, checkpoints, lineage"},
    {"clean", command_clean, &clean_command, "burn", "removes frames of a run, and keeps every N-th one"},
    {"view", command_view, &view_command, "look", "shows a cache, or a scene while it burns, in a browser"},
    {"render", command_render, &render_command, "look", "draws a cache's pictures and video again"},
    {"convert", command_convert, &convert_command, "look", "writes a cache in another format, such as USD"},
    {"measure", command_measure, &measure_command, "look", "measures the shape of a cache: creases, wrinkles, jitter"},
    {"verify", command_verify, &verify_command, "look",
     "finds faults in a cache: crossings, inverted cells, bad edges and values"},
    {"sweep", command_sweep, &sweep_command, "many",
     "burns a scene many times with different parameters, here or on a farm"},
    {"fit", command_fit, &fit_command, "many", "fits a scene's parameters to measurements"},
    {"replay", command_replay, &replay_command, "research",
     "repeats a recording of a run, and names the first step that differs"},
    {"bench", command_bench, &bench_command, "research",
     "measures speed, strain and stability of the solver on this machine"},
    {"paper", command_paper, &paper_command, "research", "runs the paper's experiments and writes a page about them"},
    {"validate", command_validate, &validate_command, "research",
     "compares the physics with outside sources, on a page"},
    {"materials", command_materials, &materials_command, "help", "lists the built-in materials, or prints one"},
    {"scene-schema", command_scene_schema, &scene_schema_command, "help",
     "prints the JSON Schema of scenes, for completion and checks in editors"},
    {"manual", command_manual, &manual_command, "help", "prints a command's manual page"},
    {"completion", command_completion, &completion_command, "help", "prints what bash, zsh or fish complete"},
    {"scene-doc", command_scene_doc, &scene_doc_command, NULL, NULL},
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static const char *command_word(int index) {
    return index < COMMAND_COUNT && commands[index].group ? commands[index].name : NULL;
}

/// What the names of operands and of options' values stand for.
static const CommandValue values[] = {
    {"DIR", VALUE_FOLDER, NULL},
    {"FILE", VALUE_FILE, NULL},
    {"SCENE", VALUE_YAML, NULL},
    {"PLAN", VALUE_YAML, NULL},
    {"FORMAT", VALUE_WORD, convert_format_word},
    {"MEASUREMENT", VALUE_WORD, bench_measurement_word},
    {"WHAT", VALUE_WORD, paper_item_word},
    {"TEMPLATE", VALUE_WORD, new_template_word},
    {"MATERIAL", VALUE_WORD, scene_material_name},
    {"COMMAND", VALUE_WORD, command_word},
    {"SHELL", VALUE_WORD, completion_shell_word},
};

const CommandTable command_table = {commands, values, COMMAND_COUNT, sizeof values / sizeof *values};

int main(int argc, char **argv) {
#ifdef __GLIBC__
    // keep the memory of a frame's files for the next frame: by default glibc returns it to the system, and each of its
    // pages faults again, which costs 2 to 3 ms for 25,000 vertices (singe bench output)
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
    if (console_open()) return EXIT_FAILED;
    const char *word = argc < 2 ? "help" : argv[1];
    const bool help = strcmp(word, "help") == 0;
    if (help && argc > 2) word = argv[2]; // singe help run: singe run --help

    for (int i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(word, commands[i].name) != 0) continue;
        char *const ask[] = {"--help", NULL};
        return console_finish(help ? commands[i].run(1, (char **)ask) : commands[i].run(argc - 2, argv + 2));
    }
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0) {
        printf("singe %s burns cloth and paper.\n\nusage: singe COMMAND [options]\n", singe_version());

        const char *group = "";
        for (int i = 0; i < COMMAND_COUNT && commands[i].group; i++) {
            if (strcmp(group, commands[i].group) != 0) printf("\n%s:\n", commands[i].group);
            group = commands[i].group;
            printf("  %-13s %s\n", commands[i].name, commands[i].summary);
        }

        printf("\n  singe COMMAND --help   the command's options\n"
               "  singe help COMMAND     the same\n"
               "  singe --version        the version\n\n"
               "Exit codes: 0 success, 1 the run failed or was interrupted, 2 bad input.\n");

        return console_finish(EXIT_GOOD);
    }

    if (strcmp(word, "--version") == 0) {
        printf("singe %s\n", singe_version());
        return console_finish(EXIT_GOOD);
    }

    static const char *const options[] = {"--help", "--version"};
    const bool option = word[0] == '-';
    const char *near = option ? args_nearest(word, options, 2, sizeof options[0])
                              : args_nearest(word, commands, COMMAND_COUNT, sizeof commands[0]);
    const char *ending = strrchr(word, '.');
    const bool scene = ending && (strcmp(ending, ".yaml") == 0 || strcmp(ending, ".yml") == 0);
    fprintf(stderr, "singe: error: unknown %s '%s'", option ? "option" : "command", shown(word).text);
    if (near || scene) fprintf(stderr, "; did you mean '%s%s'?", near ? near : "run ", near ? "" : shown(word).text);
    fputs("\nsee: singe --help\n", stderr);
    return EXIT_INPUT;
}

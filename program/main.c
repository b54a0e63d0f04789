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
#include "singe/singe.h"

/// The commands, group by group: of the help and of every message that lists them.
static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *group; ///< heading in the help; NULL: not in the help
    const char *summary;
} commands[] = {
    {"run", command_run, "burn", "burns a scene: cache, pictures, video, numbers"},
    {"check", command_check, "burn", "checks a scene, and prints its size and cost"},
    {"info", command_info, "burn", "prints what a run's folder holds: frames, sizes, checkpoints, lineage"},
    {"clean", command_clean, "burn", "removes frames of a run, and keeps every N-th one"},
    {"view", command_view, "look", "shows a cache, or a scene while it burns, in a browser"},
    {"render", command_render, "look", "draws a cache's pictures and video again"},
    {"convert", command_convert, "look", "writes a cache in another format, such as USD"},
    {"measure", command_measure, "look", "measures the shape of a cache: creases, wrinkles, jitter"},
    {"verify", command_verify, "look", "finds faults in a cache: crossings, inverted cells, bad edges and values"},
    {"sweep", command_sweep, "many", "burns a scene many times with other parameters, here or on a farm"},
    {"fit", command_fit, "many", "fits a scene's parameters to measurements"},
    {"replay", command_replay, "research", "repeats a recording of a run, and names the first step that differs"},
    {"bench", command_bench, "research", "measures speed, strain and stability of the solver on this machine"},
    {"paper", command_paper, "research", "runs the paper's experiments and writes a page about them"},
    {"validate", command_validate, "research", "compares the physics with outside sources, on a page"},
    {"scene-doc", command_scene_doc, NULL, NULL},
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static void main_help(void) {
    printf("singe %s burns cloth and paper.\n\nusage: singe COMMAND [options]\n", singe_version());

    const char *group = "";
    for (int i = 0; i < COMMAND_COUNT && commands[i].group; i++) {
        if (strcmp(group, commands[i].group) != 0) printf("\n%s:\n", commands[i].group);
        group = commands[i].group;
        printf("  %-10s %s\n", commands[i].name, commands[i].summary);
    }

    printf("\n  singe COMMAND --help   the command's options\n"
           "  singe help COMMAND     the same\n"
           "  singe --version        the version\n\n"
           "Exit codes: 0 success, 1 the run failed or was interrupted, 2 bad input.\n");
}

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
        main_help();
        return console_finish(EXIT_GOOD);
    }

    if (strcmp(word, "--version") == 0) {
        printf("singe %s\n", singe_version());
        return console_finish(EXIT_GOOD);
    }

    const char *near = args_nearest(word, commands, COMMAND_COUNT, sizeof commands[0]);
    fprintf(stderr, "singe: error: unknown %s '%s'", word[0] == '-' ? "option" : "command", shown(word).text);
    if (near) fprintf(stderr, "; did you mean '%s'?", near);
    fputs("\nsee: singe --help\n", stderr);
    return EXIT_INPUT;
}

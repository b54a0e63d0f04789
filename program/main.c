#include <stdio.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cli/args.h"
#include "cli/cli.h"
#include "cli/streams.h"
#include "common/printable.h"
#include "singe/singe.h"

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary; ///< NULL: not in the help
} commands[] = {
    {"run", command_run, "burns a scene: cache, pictures, video, numbers"},
    {"check", command_check, "checks a scene, and prints its size and cost"},
    {"render", command_render, "draws a cache's pictures and video again"},
    {"convert", command_convert, "writes a cache in another format, such as USD"},
    {"measure", command_measure, "measures the shape of a cache: creases, wrinkles, jitter"},
    {"verify", command_verify, "looks for faults in a cache: crossings, inverted cells, bad edges and values"},
    {"sweep", command_sweep, "burns a scene many times with other parameters, here or on a farm"},
    {"fit", command_fit, "fits a scene's parameters to measurements"},
    {"bench", command_bench, "measures speed, strain and stability of the solver on this machine"},
    {"paper", command_paper, "runs the paper's experiments and writes a page about them"},
    {"validate", command_validate, "compares the physics with outside sources, on a page"},
    {"scene-doc", command_scene_doc, NULL},
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static void main_help(void) {
    printf("singe %s burns cloth and paper.\n\nusage: singe COMMAND [options]\n\ncommands:\n", singe_version());
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (commands[i].summary) printf("  %-10s %s\n", commands[i].name, commands[i].summary);
    printf("\n  singe COMMAND --help   the command's options\n  singe --version        the version\n\n"
           "Exit codes: 0 good, 1 the run failed or was interrupted, 2 bad input.\n");
}

/// Keeps the memory of a frame's files for the next frame. By default glibc returns it to the system, and each of its
/// pages faults again: 2 to 3 ms for 25,000 vertices (singe bench output).
static void keep_memory(void) {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

int main(int argc, char **argv) {
    keep_memory();
    if (streams_open()) return EXIT_FAILED;
    if (argc < 2) {
        fputs(
            "singe: error: needs a command: run, check, render, convert, measure, verify, sweep, fit, bench, paper or validate\n"
            "see: singe --help\n",
            stderr);
        return EXIT_INPUT;
    }
    const char *word = argv[1];
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(word, commands[i].name) == 0) return streams_finish(commands[i].run(argc - 2, argv + 2));
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0) {
        main_help();
        return streams_finish(EXIT_GOOD);
    }
    if (strcmp(word, "--version") == 0) {
        printf("singe %s\n", singe_version());
        return streams_finish(EXIT_GOOD);
    }
    const char *near = args_nearest(word, commands, COMMAND_COUNT, sizeof commands[0]);
    fprintf(stderr, "singe: error: unknown %s '%s'", word[0] == '-' ? "option" : "command", shown(word).text);
    if (near) fprintf(stderr, "; did you mean '%s'?", near);
    fputs("\nsee: singe --help\n", stderr);
    return EXIT_INPUT;
}

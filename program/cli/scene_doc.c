// singe scene-doc: the reference of scene files, made from the schema that reads them.
#include <stdio.h>

#include "cli/args.h"
#include "cli/cli.h"
#include "scene/scene.h"

static const ArgCommand scene_doc_command = {"scene-doc", NULL, "Prints the reference of scene files (docs/scene.md).",
                                             NULL,        0,    NULL};

int command_scene_doc(int argc, char **argv) {
    ArgReader reader = args_begin(&scene_doc_command, argc, argv);
    const char *value;
    int option = args_next(&reader, &value);
    if (option == ARG_HELP) return EXIT_GOOD;
    if (option != ARG_END) return EXIT_INPUT;

    setvbuf(stdout, NULL, _IOFBF, 1 << 18); // written in one piece, so that main gets the reason of a failure
    scene_document(stdout);
    return EXIT_GOOD; // main checks whether it was written
}

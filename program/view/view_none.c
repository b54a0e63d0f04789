// singe view in a program that was built without it.
#include <stdio.h>

#include "cli/args.h"
#include "cli/cli.h"

const ArgCommand view_command = {.name = "view",
                                 .operand = "SCENE|DIR",
                                 .summary = "This singe was built without libmicrohttpd.",
                                 .examples = "singe view letter.yaml"};

int command_view(int argc, char **argv) {
    (void)argc, (void)argv;
    fputs("singe view: error: this singe was built without libmicrohttpd\n", stderr);
    return EXIT_FAILED;
}

// singe view in a program that was built without it.
#include <stdio.h>

#include "cli/cli.h"

int command_view(int argc, char **argv) {
    (void)argc, (void)argv;
    fputs("singe view: error: this singe was built without libmicrohttpd or without the preview\n", stderr);
    return EXIT_FAILED;
}

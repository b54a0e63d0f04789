// singe fit in a build without NLopt.
#include <stdio.h>

#include "cli/cli.h"

int command_fit(int argc, char **argv) {
    (void)argc, (void)argv;
    fputs("singe: error: fit: this singe was built without NLopt\n", stderr);
    return EXIT_FAILED;
}

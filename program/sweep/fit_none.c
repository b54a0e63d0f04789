// singe fit in a build without NLopt.
#include <stdio.h>

#include "cli/args.h"
#include "cli/cli.h"

const ArgCommand fit_command = {.name = "fit",
                                .operand = "PLAN",
                                .summary = "This singe was built without NLopt.",
                                .examples = "singe fit fit.yaml"};

int command_fit(int argc, char **argv) {
    (void)argc, (void)argv;
    fputs("singe: error: fit: this singe was built without NLopt\n", stderr);
    return EXIT_FAILED;
}

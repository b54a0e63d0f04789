// Apart, as programs with a main function of their own use the rest.
#include "support/test.h"

int main(int argc, char **argv) { return test_run(argc, argv); }

#include "common/assertion.h"

#ifdef SINGE_ASSERTIONS
#include <stdio.h>
#include <stdlib.h>

void assertion_failed(const char *condition, const char *file, int line) {
    fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, condition);
    abort();
}
#endif

// Helpers for the tests of formats: a temporary folder, and checks of messages.
#ifndef TESTS_FORMATS_FORMAT_TEST_H
#define TESTS_FORMATS_FORMAT_TEST_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/formats.h"
#include "support/support.h"

static inline char *test_folder(void) {
    static char folder[] = "/tmp/singe-formats-XXXXXX";
    assert_non_null(mkdtemp(folder));
    return folder;
}

static inline void assert_message(const SingeError *error, const char *part) {
    if (!strstr(error->message, part)) fail_msg("\"%s\" is not in \"%s\"", part, error->message);
}

#endif

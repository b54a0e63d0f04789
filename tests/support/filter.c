// Runs only the cases of a test program whose names fit the pattern in SINGE_TEST_FILTER, with * and ?.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>

__attribute__((constructor)) static void filter_tests(void) {
    const char *pattern = getenv("SINGE_TEST_FILTER");
    if (pattern) cmocka_set_test_filter(pattern);
}

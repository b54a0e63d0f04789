// Runs the cases of a test program in the order in which they stand in it: those whose names fit the pattern in
// SINGE_TEST_FILTER, with * and ?, or all without it.
#include "support/test.h"

#include <time.h>

enum { MOST_CASES = 64 };

static struct CMUnitTest cases[MOST_CASES];
static size_t case_count;
static void (*run_before)(int argc, char **argv);
static int (*run_after)(void);

void test_add(const char *name, CMUnitTestFunction run) {
    if (case_count == MOST_CASES) {
        fprintf(stderr, "a test program has at most %d cases\n", MOST_CASES);
        abort();
    }
    cases[case_count++] = (struct CMUnitTest){.name = name, .test_func = run};
}

void test_around(void (*before)(int argc, char **argv), int (*after)(void)) {
    run_before = before;
    run_after = after;
}

double test_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void test_float_equal(float value, float expected, float tolerance, const char *file, int line) {
    if (value != expected && !(isfinite(value) && isfinite(expected))) {
        print_error("%g != %g\n", (double)value, (double)expected);
        _fail(file, line);
    }
    _assert_float_equal(value, expected, tolerance, file, line);
}

int main(int argc, char **argv) {
    const char *pattern = getenv("SINGE_TEST_FILTER");
    if (pattern) cmocka_set_test_filter(pattern);

    if (run_before) run_before(argc, argv);
    int failed = _cmocka_run_group_tests("cases", cases, case_count, NULL, NULL);
    if (run_after) failed += run_after();
    return failed;
}

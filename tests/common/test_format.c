// The library's own printf gives what the C library's does, but always with a decimal point.
#include "support/support.h"

#include "common/format.h"

#include <locale.h>

static void print(char *out, size_t size, const char *format, ...) SINGE_PRINTF(3, 4);

static void print(char *out, size_t size, const char *format, ...) {
    va_list list;
    va_start(list, format);
    text_print(out, size, format, list);
    va_end(list);
}

/// Prints a number by snprintf and by ours, between two names, and fails if the texts differ.
#define same(format, ...)                                               \
    do {                                                                \
        char ours[700], theirs[700];                                    \
        print(ours, sizeof ours, "a " format " b", __VA_ARGS__);        \
        snprintf(theirs, sizeof theirs, "a " format " b", __VA_ARGS__); \
        assert_string_equal(ours, theirs);                              \
    } while (0)

TEST(prints_as_the_c_library) {
    same("%d %u %x", -7, 4000000000u, 48879u);
    same("%ld %lld %llu %zu", -5L, -9000000000LL, 18446744073709551615ULL, (size_t)77);
    same("%5d|%-5d|%05d|%+d", 42, 42, 42, 42);
    same("%s|%8s|%-8s|%.2s", "sheet", "sheet", "sheet", "sheet");
    same("%g %g %g %g", 0.1, -0.0, 1e-5, 1e22);
    same("%.3g %.4g %10.2f|%-10.2f|%.2e", 1234.5678, 0.00012345, 2.0 / 3, 2.0 / 3, 12345.678);
    same("%g %g %g", (double)INFINITY, -(double)INFINITY, (double)NAN);
    same("%f", -1.7976931348623157e308);
    same("100 %% of %d", 3);
}

TEST(long_text_is_cut) {
    for (size_t size = 1; size < 40; size++) {
        char ours[40], theirs[40];
        memset(ours, 'x', sizeof ours);
        print(ours, size, "sheet %u: %.3g mm, %s and %d", 12u, 3.14159, "rim", -1);
        snprintf(theirs, size, "sheet %u: %.3g mm, %s and %d", 12u, 3.14159, "rim", -1);
        assert_string_equal(ours, theirs);
        for (size_t i = size; i < sizeof ours; i++) assert_int_equal(ours[i], 'x');
    }
}

TEST(unknown_formats_end_the_text) {
    static const char *const formats[] = {"one %", "one %q two", "one %l", "one %0000000000000000000000000000000d"};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        char text[40];
        const char *volatile format = formats[i]; // not for the compiler to check
        va_list none;
        memset(&none, 0, sizeof none);
        text_print(text, sizeof text, format, none);
        assert_string_equal(text, "one ");
    }
}

TEST(a_comma_locale_changes_nothing) {
    if (!test_comma_locale()) skip();
    char ours[80], theirs[80];
    print(ours, sizeof ours, "%.3g mm, %g, %.2f", 0.125, 1e-5, 2.5);
    snprintf(theirs, sizeof theirs, "%.3g mm, %g, %.2f", 0.125, 1e-5, 2.5);
    setlocale(LC_ALL, "C");
    assert_string_equal(ours, "0.125 mm, 1e-05, 2.50");
    assert_string_equal(theirs, "0,125 mm, 1e-05, 2,50"); // or this test shows nothing
}

// The printf of singe.wasm gives what the C library's does, in every conversion that the library's messages have.
#include "support/support.h"

#define snprintf web_snprintf
#define vsnprintf web_vsnprintf
int snprintf(char *text, size_t size, const char *format, ...);
int vsnprintf(char *text, size_t size, const char *format, va_list arguments);
#include "../../bindings/web/print.c"
#undef snprintf
#undef vsnprintf

#define same(...)                                                               \
    do {                                                                        \
        char ours[100], theirs[100];                                            \
        int length = web_snprintf(ours, sizeof ours, __VA_ARGS__);              \
        assert_int_equal(length, snprintf(theirs, sizeof theirs, __VA_ARGS__)); \
        assert_string_equal(ours, theirs);                                      \
    } while (0)

static void same_float(double value) {
    same("%g %.3g %.4g %.9g", value, value, value, value);
    same("%g %.1g", -value, -value);
}

TEST(text_and_integers) {
    same("a %s b %c %% %.2s|%.0s|%.9s", "sheet", 'x', "sheet", "sheet", "sheet");
    same("%d %d %u %x", 0, -2147483647 - 1, 4294967295u, 48879u);
    same("%ld %lld %llu %zu", -5L, -9000000000LL, 18446744073709551615ULL, (size_t)77);
    same("\\x%02x \\u%04x \\U%08x %02x", 7u, 0xabu, 0x1d173u, 0x1234u);
}

TEST(floats) {
    const double values[] = {0,
                             1,
                             10,
                             100,
                             999999,
                             999999.4,
                             9999999,
                             1e6,
                             1e15,
                             1e22,
                             1e300,
                             1.7976931348623157e308,
                             0.1,
                             0.15,
                             0.0001,
                             0.00001,
                             0.00012345678,
                             123.456,
                             99999.951,
                             9.99999951,
                             1.0 / 3,
                             1e-38,
                             1e-300,
                             5e-324,
                             (double)INFINITY};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) same("%g %.3g %.4g", values[i], values[i], -values[i]);

    same("%g", (double)NAN);
    for (int i = 1; i < 20000; i++) same_float((double)(float)(1.2345e-7 * i * i)); // not half-way between two
}

TEST(a_small_buffer_ends_with_zero) {
    char text[4] = "xxx";
    assert_int_equal(web_snprintf(text, sizeof text, "%s", "sheet"), 5);
    assert_string_equal(text, "she");
    assert_int_equal(web_snprintf(NULL, 0, "%d", 12345), 5);
}

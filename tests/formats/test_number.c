#include "format_test.h"

#include <locale.h>

#include "formats/number.h"

static NumberStatus read_float(const char *text, float *value, size_t *used) {
    const uint8_t *at = (const uint8_t *)text;
    NumberStatus status = number_float(&at, at + strlen(text), value);
    *used = (size_t)(at - (const uint8_t *)text);
    return status;
}

static void expect_float(const char *text, float expected) {
    float value = -77;
    size_t used;
    assert_int_equal(read_float(text, &value, &used), NUMBER_OK);
    assert_int_equal(used, strlen(text));
    if (memcmp(&value, &expected, sizeof value)) fail_msg("%s gives %a, not %a", text, (double)value, (double)expected);
}

TEST(reads_plain_numbers) {
    expect_float("0", 0.0f);
    expect_float("-0", -0.0f);
    expect_float("1.", 1.0f);
    expect_float(".5", 0.5f);
    expect_float("+2.50", 2.5f);
    expect_float("0.1", 0.1f);
    expect_float("-123.456", -123.456f);
    expect_float("1e3", 1000.0f);
    expect_float("1E-3", 0.001f);
    expect_float("12.5e+1", 125.0f);
    expect_float("000000000000000000000000000001", 1.0f);
    expect_float("0.000000000000000000000000000001", 1e-30f);
    expect_float("100000000000000000000000000000000000000", 1e38f);
    expect_float("0e999999999999", 0.0f);
}

// Ties and limits, where a double in between would round twice.
TEST(rounds_exactly) {
    expect_float("16777217", 16777216.0f);
    expect_float("16777217.0000000000000000000000000000001", 16777218.0f);
    expect_float("16777219", 16777220.0f);
    expect_float("1.00000005960464477539062500000000000000000000", 1.0f);
    expect_float("1.00000005960464477539062500000000000000000001", 0x1.000002p0f);
    expect_float("3.4028234663852886e38", 0x1.fffffep127f);
    expect_float("3.4028235677973362e38", 0x1.fffffep127f);
    expect_float("1.1754943508222875e-38", 0x1p-126f);
    expect_float("1.401298464324817e-45", 0x1p-149f);
    expect_float("0.7006492321624085e-45", 0.0f);
    expect_float("0.7006492321624086e-45", 0x1p-149f);
    expect_float("2.1019476964872256e-45", 0x1p-149f);
    expect_float("2.1019476964872257e-45", 0x1p-148f);
    expect_float("1e-400", 0.0f);
    expect_float("1e-999999999999", 0.0f);
}

TEST(agrees_with_libc) {
    uint64_t seed = 88172645463325252u;
    char text[64];
    for (int i = 0; i < 200000; i++) {
        seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
        uint32_t bits = (uint32_t)seed;
        float expected, value;
        memcpy(&expected, &bits, sizeof expected);
        if (!isfinite(expected)) continue;

        snprintf(text, sizeof text, i % 2 ? "%.9g" : "%.17g", (double)expected);
        size_t used;
        assert_int_equal(read_float(text, &value, &used), NUMBER_OK);
        assert_memory_equal(&value, &expected, sizeof value);

        // a number of many digits, not a float's own
        snprintf(text, sizeof text, "%u.%020llue%d", bits % 1000, (unsigned long long)seed, (int)(seed % 60) - 40);
        expected = strtof(text, NULL);
        NumberStatus status = read_float(text, &value, &used);
        if (isinf(expected)) assert_int_equal(status, NUMBER_RANGE);
        else assert_memory_equal(&value, &expected, sizeof value);
    }
}

TEST(text_that_is_not_a_number_is_refused) {
    static const char *const junk[] = {"",  "-",   "+",   ".",   "-.", "e5", "1e", "1e+",
                                       "x", "--1", "+-1", "abc", " 1", ",5", "#"};
    float value;
    size_t used;
    for (size_t i = 0; i < sizeof junk / sizeof *junk; i++) {
        if (read_float(junk[i], &value, &used) != NUMBER_JUNK) fail_msg("\"%s\" was read", junk[i]);
        assert_int_equal(used, 0);
    }

    static const char *const endless[] = {"nan", "NaN", "-nan(ind)", "inf", "-Inf", "Infinity"};
    for (size_t i = 0; i < sizeof endless / sizeof *endless; i++)
        assert_int_equal(read_float(endless[i], &value, &used), NUMBER_NOT_FINITE);
    static const char *const huge[] = {"3.4028236e38", "3.402823567797337e38", "-1e39", "1e400", "1e999999999999"};
    for (size_t i = 0; i < sizeof huge / sizeof *huge; i++)
        assert_int_equal(read_float(huge[i], &value, &used), NUMBER_RANGE);

    // the number ends where it stops being one
    assert_int_equal(read_float("0x10", &value, &used), NUMBER_OK);
    assert_int_equal(used, 1);
    assert_int_equal(read_float("1,5", &value, &used), NUMBER_OK);
    assert_int_equal(used, 1);
    assert_int_equal(read_float("1.2.3", &value, &used), NUMBER_OK);
    assert_int_equal(used, 3);
}

TEST(reads_integers) {
    static const struct {
        const char *text;
        NumberStatus status;
        int64_t value;
    } cases[] = {
        {"0", NUMBER_OK, 0},  {"-12", NUMBER_OK, -12}, {"+7", NUMBER_OK, 7},  {"4294967296", NUMBER_OK, 4294967296},
        {"", NUMBER_JUNK, 0}, {"-", NUMBER_JUNK, 0},   {"x", NUMBER_JUNK, 0}, {"99999999999999999999", NUMBER_RANGE, 0},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const uint8_t *at = (const uint8_t *)cases[i].text;
        int64_t value = 0;
        assert_int_equal(number_integer(&at, at + strlen(cases[i].text), &value), cases[i].status);
        assert_int_equal(value, cases[i].value);
    }
}

TEST(doubles_survive_printing) {
    static const double values[] = {
        0, -0.0, 1 / 24.0, 0.1, 1e22, 1e23, 123456789.123456789, 5e-324, 1.7976931348623157e308, -2.5e-10};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        char text[40];
        double back;
        int length = number_print(values[i], text);
        const uint8_t *at = (const uint8_t *)text, *end = at + length;
        assert_int_equal(number_double(&at, end, &back), NUMBER_OK);
        assert_ptr_equal(at, end);
        assert_memory_equal(&back, &values[i], sizeof back);
    }
}

// Comma locales may not be installed; then only the C locale is seen here.
TEST(ignores_the_locale) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE", "ps_AF.utf8"};
    bool found = false;
    for (size_t i = 0; !found && i < sizeof names / sizeof *names; i++) found = setlocale(LC_ALL, names[i]) != NULL;
    expect_float("1.5", 1.5f);

    char text[40];
    number_print(0.25, text);
    assert_string_equal(text, "0.25");
    setlocale(LC_ALL, "C");
    if (!found) print_message("no locale with a decimal comma is installed\n");
}

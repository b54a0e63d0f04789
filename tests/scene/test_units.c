// Quantities: every unit, strictness, and numbers that come back as they went out.
#include "parsing.h"

#include <locale.h>

#include "scene/units.h"

static double read_good(const char *text, Dimension dimension) {
    double value = -12345;
    assert_int_equal(quantity_read(text, dimension, &value), NUMBER_GOOD);
    return value;
}

static void near(double value, double expected) { assert_true(fabs(value - expected) <= 1e-12 * (1 + fabs(expected))); }

TEST(units_are_converted) {
    near(read_good("293", DIM_TEMPERATURE), 293);
    near(read_good("240 C", DIM_TEMPERATURE), 513.15);
    near(read_good("240C", DIM_TEMPERATURE), 513.15);
    near(read_good("-40 \u00b0C", DIM_TEMPERATURE), 233.15);
    near(read_good("-40 F", DIM_TEMPERATURE), 233.15);
    near(read_good("212 F", DIM_TEMPERATURE), 373.15);
    near(read_good("1.5 mm", DIM_LENGTH), 1.5e-3);
    near(read_good("1 in", DIM_LENGTH), 0.0254);
    near(read_good("3 \u00b5m", DIM_LENGTH), 3e-6);
    near(read_good("80 g/m2", DIM_GRAMMAGE), 0.08);
    near(read_good("80 g/m\u00b2", DIM_GRAMMAGE), 0.08);
    near(read_good("4 mm2", DIM_AREA), 4e-6);
    near(read_good("250ms", DIM_TIME), 0.25);
    near(read_good("2 min", DIM_TIME), 120);
    near(read_good("180", DIM_ANGLE), 3.14159265358979323846);
    near(read_good("90 deg", DIM_ANGLE), 1.57079632679489661923);
    near(read_good("1 rad", DIM_ANGLE), 1);
    near(read_good("5 %", DIM_FRACTION), 0.05);
    near(read_good("30 kW/m2", DIM_FLUX), 30e3);
    near(read_good("14 W/(m2 K)", DIM_CONDUCTANCE), 14);
    near(read_good("14 W/(m\u00b2\u00b7K)", DIM_CONDUCTANCE), 14);
    near(read_good("14 W/m2/K", DIM_CONDUCTANCE), 14);
    near(read_good("1.4 kJ/(kg K)", DIM_SPECIFIC_HEAT), 1400);
    near(read_good("10 mm2/s", DIM_DIFFUSIVITY), 1e-5);
    near(read_good("14   W/(m^2 K)", DIM_CONDUCTANCE), 14);
    near(read_good("14 W/(m2*K)", DIM_CONDUCTANCE), 14);
    near(read_good("1400 J/(kgK)", DIM_SPECIFIC_HEAT), 1400);
    near(read_good("3 \u03bcm", DIM_LENGTH), 3e-6);
    near(read_good("30\u00b0", DIM_ANGLE), 0.52359877559829887308);
    near(read_good("1e-3", DIM_NONE), 1e-3);
    near(read_good("+.5", DIM_NONE), 0.5);
}

TEST(odd_quantities_are_refused) {
    static const char *const not_numbers[] = {"",      " ",   "x",   "nan", "inf",  "-inf",    "0x10 ",
                                              "--1",   ".",   "+",   "e5",  "1,5",  "C 12",    "- 1",
                                              "1.2.3", "1 2", "+-3", "++3", "- 3",  "\u22123", "infinity m",
                                              "nan m", "NaN", ".e3", "_1",  "1..2", "\u00a03"};
    static const char *const bad_units[] = {
        "1 kg",   "1 mmm", "1 m m2",    "1 e",       "1 s",        "1 M",   "3 m m", "3mm mm",     "3 c m",
        "1e3 e3", "1_000", "1 m\n",     "1\tm",      "1 \u00b0",   "1 *",   "1 ^",   "1 \u00b7",   "1 m^",
        "1 *m",   "1 m*",  "1 \u00b0m", "1 m\u00b2", "1 \u00b5 m", "1 m/1", "1m1",   "1 m\xc2\x85"};
    double value;
    for (size_t i = 0; i < sizeof not_numbers / sizeof *not_numbers; i++)
        assert_int_not_equal(quantity_read(not_numbers[i], DIM_LENGTH, &value), NUMBER_GOOD);
    for (size_t i = 0; i < sizeof bad_units / sizeof *bad_units; i++)
        assert_int_equal(quantity_read(bad_units[i], DIM_LENGTH, &value), NUMBER_BAD_UNIT);

    static const struct {
        const char *text;
        Dimension dimension;
    } of_others[] = {
        {"1 m", DIM_NONE},
        {"1 %", DIM_NONE},
        {"1 \u00b0", DIM_NONE},
        {"3 m/ s", DIM_SPEED},
        {"3 m /s", DIM_SPEED},
        {"3 m s", DIM_SPEED},
        {"3 m//s", DIM_SPEED},
        {"3 ms", DIM_SPEED},
        {"5 % %", DIM_FRACTION},
        {"5 %%", DIM_FRACTION},
        {"20 \u00b0 C", DIM_TEMPERATURE},
        {"20 \u00b0K", DIM_TEMPERATURE},
        {"20 C C", DIM_TEMPERATURE},
        {"1 W/( m2 K)", DIM_CONDUCTANCE},
        {"1 W/(m2 K", DIM_CONDUCTANCE},
        {"1 W/m2 K", DIM_CONDUCTANCE},
        {"1 W/(m 2 K)", DIM_CONDUCTANCE},
        {"1 m2", DIM_LENGTH},
        {"1 m i n", DIM_TIME},
        {"1 r a d", DIM_ANGLE},
        {"1 1/ s", DIM_RATE},
    };

    for (size_t i = 0; i < sizeof of_others / sizeof *of_others; i++)
        assert_int_equal(quantity_read(of_others[i].text, of_others[i].dimension, &value), NUMBER_BAD_UNIT);
}

static void back(float value, Dimension dimension, const char *expected) {
    char text[40];
    quantity_print(value, dimension, text, sizeof text);
    if (expected) assert_string_equal(text, expected);
    double again;
    assert_int_equal(quantity_read(text, dimension, &again), NUMBER_GOOD);
    float narrow = (float)again;
    assert_memory_equal(&narrow, &value, sizeof value);
}

TEST(numbers_print_with_their_unit) {
    back(0, DIM_NONE, "0");
    back(1200, DIM_TEMPERATURE, "1200");
    back(-9.81f, DIM_ACCELERATION, "-9.81");
    back(0.0005f, DIM_LENGTH, "0.0005");
    back(1e-5f, DIM_NONE, "1e-05");
    back(16777216, DIM_NONE, "16777216");
    back(3.4e38f, DIM_NONE, NULL);
    back(1e-45f, DIM_NONE, NULL);

    uint32_t bits = 1;
    for (int i = 0; i < 20000; i++) {
        float value;
        bits = bits * 1664525u + 1013904223u;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) {
            back(value, DIM_NONE, NULL);
            if (fabsf(value) < 1e6f && fabsf(value) > 1e-30f) back(value, DIM_ANGLE, NULL);
        }
    }
}

// A decimal comma must change nothing. Skipped where no such locale is installed.
TEST(a_decimal_comma_changes_nothing) {
    static const char *const locales[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    bool found = false;
    for (int i = 0; i < 4 && !found; i++) found = setlocale(LC_ALL, locales[i]) != NULL;
    back(0.25f, DIM_NONE, "0.25");
    near(read_good("1.5 mm", DIM_LENGTH), 1.5e-3);
    setlocale(LC_ALL, "C");
    if (!found) skip();
}

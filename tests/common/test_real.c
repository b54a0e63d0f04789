// Our elementary functions against libm's in double precision, and where they must not fail.
#include "support/support.h"

#include "common/real.h"

static float power(float x) { return portable_powf(x, 1.7f); }
static double double_power(double x) { return pow(x, (double)1.7f); }
static float root(float x) { return portable_powf(x, 0.3f); }
static double double_root(double x) { return pow(x, (double)0.3f); }
static float angle(float x) { return portable_atan2f(x, -0.7f); }
static double double_angle(double x) { return atan2(x, (double)-0.7f); }
static float off(float x) { return nextafterf(portable_expf(x), INFINITY); }

/// The error of a float, in units of its last digit.
static double units(float value, double wanted) {
    float size = fabsf(value);
    return fabs((double)value - wanted) / (double)(nextafterf(size, INFINITY) - size);
}

static double worst(float (*ours)(float), double (*wanted)(double), float low, float high) {
    double max = 0;
    for (uint32_t i = 0; i < 200000; i++) {
        float x = low + (high - low) * ((float)((i * 2654435761u) >> 8) / 16777216.0f);
        max = fmax(max, units(ours(x), wanted((double)x)));
    }
    return max;
}

TEST(floats_are_rounded_as_if_exact) {
    const struct {
        float (*ours)(float);
        double (*wanted)(double);
        float low, high;
    } rows[] = {{portable_expf, exp, -80, 80},         {portable_expm1f, expm1, -20, 20},
                {portable_expm1f, expm1, -0.5f, 0.5f}, {portable_log1pf, log1p, -0.999f, 50},
                {portable_log1pf, log1p, -0.4f, 0.4f}, {portable_sinf, sin, -400, 400},
                {portable_cosf, cos, -7, 7},           {portable_acosf, acos, -1, 1},
                {power, double_power, 1e-4f, 50},      {root, double_root, 1e-4f, 50},
                {angle, double_angle, -5, 5}};

    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++)
        assert_true(worst(rows[k].ours, rows[k].wanted, rows[k].low, rows[k].high) < 0.50001);
    assert_true(worst(off, exp, -80, 80) > 0.50001); // a digit off is seen
}

TEST(doubles_are_close) {
    for (int i = 1; i < 100000; i++) {
        double x = 0.013 * i - 700, y = 1e-3 * i * i;
        assert_true(fabs(portable_exp(x) / exp(x) - 1) < 1e-15);
        assert_true(fabs(portable_exp2(x / 100) / exp2(x / 100) - 1) < 2e-15);
        assert_true(fabs(portable_sin(x) - sin(x)) < 1e-15 && fabs(portable_cos(x) - cos(x)) < 1e-15);
        assert_true(fabs(portable_cbrt(y) / cbrt(y) - 1) < 1e-15);
    }
}

TEST(functions_end_as_the_c_library_says) {
    assert_true(portable_expf(-200) == 0 && isinf(portable_expf(100)) && isnan(portable_expf(NAN)));
    assert_true(portable_exp(-740) > 0 && portable_exp(-800) == 0 && isinf(portable_exp(710)));
    assert_true(portable_expm1f(0) == 0 && portable_expm1f(-INFINITY) == -1 && isinf(portable_expm1f(INFINITY)));
    assert_true(portable_log1pf(0) == 0 && isinf(portable_log1pf(-1)) && isnan(portable_log1pf(-2)));
    assert_true(portable_powf(0, 0) == 1 && portable_powf(0, 2) == 0 && portable_powf(0.5f, INFINITY) == 0);
    assert_true(portable_powf(1, INFINITY) == 1 && portable_powf(3, 1) == 3 && isnan(portable_powf(-1, 0.5f)));
    assert_true(portable_sinf(0) == 0 && portable_cosf(0) == 1 && isnan(portable_sinf(INFINITY)));
    assert_true(portable_acosf(1) == 0 && portable_acosf(-1) == (float)acos(-1) && isnan(portable_acosf(1.5f)));
    assert_true(portable_atan2f(0, 0) == 0 && portable_atan2f(0, -1) == (float)acos(-1));
    assert_true(portable_cbrt(0) == 0 && fabs(portable_cbrt(1e-310) / cbrt(1e-310) - 1) < 1e-12);
}

TEST(the_larger_and_the_smaller_are_the_c_library_s) {
    const double values[] = {-INFINITY, -1, -0.0, 0, 1e-40, 2, INFINITY, (double)NAN};
    const size_t count = sizeof values / sizeof values[0];
    for (size_t i = 0; i < count * count; i++) {
        const double a = values[i / count], b = values[i % count];
        const float fa = (float)a, fb = (float)b, larger = float_max(fa, fb), smaller = float_min(fa, fb);
        if (isnan(a) && isnan(b)) {
            assert_true(isnan(larger) && isnan(smaller) && isnan(double_max(a, b)) && isnan(double_min(a, b)));
            continue;
        }

        assert_true(larger == fmaxf(fa, fb) && smaller == fminf(fa, fb)); // not of a NaN
        assert_true(double_max(a, b) == fmax(a, b) && double_min(a, b) == fmin(a, b));
        if (a == 0 && b == 0) assert_true(signbit(larger) == signbit(fb) && signbit(smaller) == signbit(fb));
    }
}

// Taylor's series in double precision after a reduction of the argument, cut off below 1e-16 of the result. So a float
// is correctly rounded, unless the exact value is closer to a tie than about 1e-8 of its last digit.
#include "common/real.h"

#include <stdint.h>
#include <string.h>

static const double LN2_HIGH = 0x1.62e42fefap-1, LN2_LOW = 0x1.cf79abc9e3b3ap-40; // the first has 35 bits
static const double LOG2_E = 1.44269504088896340736, PI = 3.14159265358979323846;

/// 2^k for -1022 <= k <= 1023.
static double real_power(int k) {
    uint64_t bits = (uint64_t)(k + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/// e^r - 1 for |r| <= ln 2 / 2, by Taylor's series.
static double real_exp_series(double r) {
    static const double over_factorial[] = {1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800,
                                            1.0 / 362880,     1.0 / 40320,     1.0 / 5040,     1.0 / 720,
                                            1.0 / 120,        1.0 / 24,        1.0 / 6,        0.5};
    double sum = 0;
    for (int i = 0; i < 12; i++) sum = sum * r + over_factorial[i];
    return r + r * r * sum;
}

double portable_exp(double x) {
    if (isnan(x)) return x;
    if (x > 709.7) return x > 709.782 ? INFINITY : portable_exp(x - 1) * 2.71828182845904523536;
    if (x < -745) return 0;
    double k = floor(x * LOG2_E + 0.5), r = (x - k * LN2_HIGH) - k * LN2_LOW;
    int half = (int)k / 2;
    return (1 + real_exp_series(r)) * real_power(half) * real_power((int)k - half);
}

double portable_exp2(double x) { return portable_exp(x * 0.69314718055994530942); }

float portable_expf(float x) { return (float)portable_exp((double)x); }

float portable_expm1f(float x) {
    return fabsf(x) < 0.34f ? (float)real_exp_series((double)x) : (float)(portable_exp((double)x) - 1);
}

/// 2 artanh(s) for |s| <= 0.1716.
static double real_log_series(double s) {
    static const double over_odd[] = {1.0 / 21, 1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13,
                                      1.0 / 11, 1.0 / 9,  1.0 / 7,  1.0 / 5,  1.0 / 3};
    double square = s * s, sum = 0;
    for (int i = 0; i < 10; i++) sum = sum * square + over_odd[i];
    return 2 * s + 2 * s * square * sum;
}

/// ln x of a positive normal number.
static double real_log(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int k = (int)(bits >> 52) - 1023;
    bits = (bits & 0xfffffffffffffu) | (uint64_t)1023 << 52;
    memcpy(&x, &bits, sizeof x); // 1 <= x < 2
    if (x > 1.41421356237309504880) x *= 0.5, k++;
    return k * LN2_HIGH + (real_log_series((x - 1) / (x + 1)) + k * LN2_LOW);
}

float portable_log1pf(float x) {
    double y = (double)x;
    if (!(x > -1) || isinf(x)) return x == -1 ? -INFINITY : x > 0 ? x : NAN;
    return fabsf(x) < 0.3f ? (float)real_log_series(y / (2 + y)) : (float)real_log(1 + y);
}

float portable_powf(float x, float y) {
    if (y == 0 || x == 1) return 1;
    if (isnan(x) || isnan(y)) return NAN;
    if (x == 0) return y > 0 ? 0 : INFINITY;
    if (isinf(x)) return y > 0 ? x : 0;
    if (!(x > 0)) return NAN;
    return (float)portable_exp((double)y * real_log((double)x));
}

/// sin(x + turn pi/2).
static double real_wave(double x, int turn) {
    static const double high = 0x1.921fb544p0, mid = 0x1.0b4611a6p-34, low = 0x1.3198a2e037073p-69; // of pi/2
    static const double sine[] = {1.0 / 355687428096000, -1.0 / 1307674368000, 1.0 / 6227020800, -1.0 / 39916800,
                                  1.0 / 362880,          -1.0 / 5040,          1.0 / 120,        -1.0 / 6};
    static const double cosine[] = {1.0 / 20922789888000, -1.0 / 87178291200, 1.0 / 479001600, -1.0 / 3628800,
                                    1.0 / 40320,          -1.0 / 720,         1.0 / 24,        -0.5};
    if (!isfinite(x)) return NAN;

    // x less the nearest multiple k of pi/2, which is in parts of 33, 33 and 53 bits
    double k = floor(x * (2 / PI) + 0.5);
    double r = ((x - k * high) - k * mid) - k * low;
    int quarter = ((int)(k - 4 * floor(0.25 * k)) + turn) & 3;

    const double *over_factorial = quarter & 1 ? cosine : sine;
    double square = r * r, sum = 0;
    for (int i = 0; i < 8; i++) sum = sum * square + over_factorial[i];
    double value = quarter & 1 ? 1 + square * sum : r + r * square * sum;
    return quarter & 2 ? -value : value;
}

float portable_sinf(float x) { return (float)real_wave((double)x, 0); }
float portable_cosf(float x) { return (float)real_wave((double)x, 1); }
double portable_sin(double x) { return real_wave(x, 0); }
double portable_cos(double x) { return real_wave(x, 1); }

/// atan t for 0 <= t <= 1: a quarter of the angle has a tangent of 0.199 at most.
static double real_atan(double t) {
    static const double over_odd[] = {1.0 / 21,  -1.0 / 19, 1.0 / 17, -1.0 / 15, 1.0 / 13,
                                      -1.0 / 11, 1.0 / 9,   -1.0 / 7, 1.0 / 5,   -1.0 / 3};
    double sum = 0;
    for (int i = 0; i < 2; i++) t = t / (1 + sqrt(1 + t * t));
    for (int i = 0; i < 10; i++) sum = sum * (t * t) + over_odd[i];
    return 4 * (t + t * (t * t) * sum);
}

static double real_atan2(double y, double x) {
    double a = fabs(y), b = fabs(x), angle;
    if (isnan(a) || isnan(b)) return NAN;
    if (isinf(a) && isinf(b)) angle = PI / 4;
    else if (a == 0 && b == 0) angle = 0;
    else angle = a <= b ? real_atan(a / b) : PI / 2 - real_atan(b / a);
    if (signbit(x)) angle = PI - angle;
    return copysign(angle, y);
}

float portable_atan2f(float y, float x) { return (float)real_atan2((double)y, (double)x); }

float portable_acosf(float x) {
    double y = (double)x;
    return x >= -1 && x <= 1 ? (float)real_atan2(sqrt((1 - y) * (1 + y)), y) : NAN;
}

double portable_cbrt(double x) {
    if (!(x >= 0x1p-1022) || isinf(x)) return x > 0 && !isinf(x) ? portable_cbrt(x * 0x1p60) * 0x1p-20 : x;
    double y = portable_exp(real_log(x) / 3);
    return y - (y - x / (y * y)) / 3;
}

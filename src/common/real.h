// Elementary functions of the core. libm's by default; with SINGE_PORTABLE_MATH our own (real.c), which use nothing but
// IEEE 754's additions, products, quotients and square roots: the same bytes with every C library, compiler and
// processor. The two differ in the last digit of some results, so a build uses one kind throughout.
#pragma once

#include <math.h>
#include <stdbool.h>

/// Accurate to a float's last digit: the error is at most half a unit of it, or hardly more.
float portable_expf(float x);
float portable_expm1f(float x);
float portable_log1pf(float x);
/// x > 0, or x = 0 and y >= 0.
float portable_powf(float x, float y);
/// |x| at most 1e6.
float portable_sinf(float x);
float portable_cosf(float x);
float portable_acosf(float x);
float portable_atan2f(float y, float x);
/// Accurate to 1e-15 of the result.
double portable_exp(double x);
/// Accurate to 1e-15 of the result for |x| of a few units.
double portable_exp2(double x);
/// Accurate to 1e-15; |x| at most 1e6.
double portable_sin(double x);
double portable_cos(double x);
/// x >= 0.
double portable_cbrt(double x);

#ifdef SINGE_PORTABLE_MATH
#define REAL(name) portable_##name
#else
#define REAL(name) name
#endif

static inline float real_expf(float x) { return REAL(expf)(x); }
static inline float real_expm1f(float x) { return REAL(expm1f)(x); }
static inline float real_log1pf(float x) { return REAL(log1pf)(x); }
static inline float real_powf(float x, float y) { return REAL(powf)(x, y); }
static inline float real_sinf(float x) { return REAL(sinf)(x); }
static inline float real_cosf(float x) { return REAL(cosf)(x); }
static inline float real_acosf(float x) { return REAL(acosf)(x); }
static inline float real_atan2f(float y, float x) { return REAL(atan2f)(y, x); }
static inline double real_exp(double x) { return REAL(exp)(x); }
static inline double real_exp2(double x) { return REAL(exp2)(x); }
static inline double real_sin(double x) { return REAL(sin)(x); }
static inline double real_cos(double x) { return REAL(cos)(x); }
static inline double real_cbrt(double x) { return REAL(cbrt)(x); }

#undef REAL

/// fmaxf, fminf, fmax and fmin without a call: the other number where one is NaN. Of zeros with both signs, b.
static inline float float_max(float a, float b) { return a > b || b != b ? a : b; }
static inline float float_min(float a, float b) { return a < b || b != b ? a : b; }
static inline double double_max(double a, double b) { return a > b || b != b ? a : b; }
static inline double double_min(double a, double b) { return a < b || b != b ? a : b; }

/// False for NaN.
static inline bool float_within(float value, float low, float high) { return value >= low && value <= high; }

// Bounds, mixtures and steps of numbers.
#pragma once

// one instruction each, where fminf and fmaxf are calls; b if either is NaN
static inline float minf(float a, float b) { return a < b ? a : b; }
static inline float maxf(float a, float b) { return a > b ? a : b; }
static inline float clampf(float x, float low, float high) { return x < low ? low : x > high ? high : x; }
static inline float mixf(float a, float b, float s) { return a + (b - a) * s; }

/// 0 below a, 1 above b, the cubic 3x^2 - 2x^3 between.
static inline float stepf(float a, float b, float x) {
    float s = clampf((x - a) / (b - a), 0, 1);
    return s * s * (3 - 2 * s);
}

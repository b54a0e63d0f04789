// Three doubles: for geometry that must not round as floats do, over arrays of three.
#ifndef COMMON_DOUBLE3_H
#define COMMON_DOUBLE3_H

#include <math.h>
#include <stdbool.h>

static inline double dot3(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline void sub3(const double *a, const double *b, double *out) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}
static inline void cross3(const double *a, const double *b, double *out) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}
/// Scales to length 1; false if the length is 0 or not a number.
static inline bool unit3(double *a) {
    const double length = sqrt(dot3(a, a));
    if (!(length > 0)) return false;
    for (int k = 0; k < 3; k++) a[k] /= length;
    return true;
}

#endif

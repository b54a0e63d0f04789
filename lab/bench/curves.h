// Curves of cost against springs, read from the CSV files that `singe bench` writes.
#ifndef BENCH_CURVES_H
#define BENCH_CURVES_H

#include "singe/singe.h"

enum { CURVE_POINTS_MAX = 64, CURVES_MAX = 12 };

typedef struct Curve {
    char name[80];
    int count;
    double springs[CURVE_POINTS_MAX], ms[CURVE_POINTS_MAX];
} Curve;

typedef struct Curves {
    int count;
    Curve list[CURVES_MAX];
} Curves;

/// Adds the paper's Table 2, with and without early exit.
void curves_add_paper(Curves *curves);

/// Adds a curve for every solver and number of threads in a file with columns `springs` and `step_ms`.
SingeResult curves_read(Curves *curves, const char *path, SingeError *error);

/// Draws them log-log as SVG.
SingeResult curves_draw(const Curves *curves, const char *path, SingeError *error);

#endif

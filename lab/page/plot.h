// Lines over an axis, as SVG.
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "singe/base.h"

typedef struct PlotLine {
    const char *name, *colour; ///< of SVG
    const double *x, *y;       ///< [count]; x NULL: 0, 1, 2, ...; values that an axis cannot show are skipped
    int count;
    bool dots, dashed; ///< only marks; a dashed line
} PlotLine;

enum { PLOT_LINES_MAX = 12 };

typedef struct Plot {
    const char *title, *x_label, *y_label;
    bool log_x, log_y;
    int line_count;
    PlotLine lines[PLOT_LINES_MAX];
} Plot;

void plot_add(Plot *plot, PlotLine line);
void plot_draw(const Plot *plot, FILE *file);
SINGE_NODISCARD SingeResult plot_write(const Plot *plot, const char *path, SingeError *error);

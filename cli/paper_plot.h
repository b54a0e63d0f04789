// Lines over projection steps on a logarithmic axis, as SVG.
#ifndef CLI_PAPER_PLOT_H
#define CLI_PAPER_PLOT_H

#include "singe/base.h"

typedef struct PlotLine {
    const char *name, *colour; ///< of SVG
    const double *values;      ///< [count]; what is not above 0 is left out
} PlotLine;

SINGE_NODISCARD SingeResult plot_write(const char *path, const char *title, const PlotLine *lines, int line_count,
                                       int count, SingeError *error);

#endif

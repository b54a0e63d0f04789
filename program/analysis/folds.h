// How smooth a drawn sheet is along its folds.
#ifndef ANALYSIS_FOLDS_H
#define ANALYSIS_FOLDS_H

#include <stdbool.h>

#include "singe/sim.h"

/// Sums over a frame, or over many.
typedef struct Folds {
    double power, count; ///< rad2, and samples: the normal's angle along folds in wavelengths below three cells
} Folds;

/// Adds a frame. False when out of memory.
bool folds_add(const SingeSurface *surface, Folds *folds);

/// Degrees, root mean square; NaN if there is no fold.
double folds_angle(const Folds *folds);

#endif

// singe fit: a sweep whose rows an optimiser chooses, to match measurements.
#ifndef SWEEP_FIT_H
#define SWEEP_FIT_H

#include "sweep/sweep.h"

/// A measured curve.
typedef struct FitCurve {
    uint32_t count;
    double *times, *temperatures; ///< s, K; times ascend
} FitCurve;

/// The measurements, read (fit_target.c).
typedef struct FitTarget {
    const PlanTarget *plan;
    FitCurve curve;
} FitTarget;

/// Reads the files of a target. Errors have been printed unless the result is EXIT_GOOD.
ExitCode fit_target_read(FitTarget *target, const PlanTarget *plan, Console *console);
void fit_target_free(FitTarget *target);

/// The error of a complete row: the sum of
///   ((v - v0)/v0)^2                          of the front's speed in the last frame,
///   mean ((T(t) - T0(t))/(max T0 - min T0))^2   of the curve, over its points,
///   the share of pixels that differ          of the masks, over the sheet and all frames with a mask.
/// False if the row lacks the compared data; an error has been printed.
bool fit_error(const FitTarget *target, const Sweep *sweep, uint32_t row, double *error);

#endif

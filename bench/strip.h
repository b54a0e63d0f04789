// A strip of sheet, held all over and lit at one end: how fast its front runs, how hot it gets and what it leaves.
#ifndef BENCH_STRIP_H
#define BENCH_STRIP_H

#include "singe/singe.h"

typedef struct StripSetup {
    SingeMaterialDef material; ///< what varies over the sheet counts by its middle
    float cell;                ///< m
    float time_step;           ///< s
    int threads;
    int steps_most;            ///< when they are over the fire has gone out
} StripSetup;

typedef struct StripResult {
    double speed;      ///< m/s of the front along the strip; 0 where the fire went out
    double hottest;    ///< K, of what the front has passed
    double residue;    ///< share of its mass that did not go as gas
    double thickening; ///< F
} StripResult;

/// A strip of cells of a millimetre, in default steps.
StripSetup strip_setup(const SingeMaterialDef *material);
SingeResult strip_burn(const StripSetup *setup, StripResult *result, SingeError *error);

#endif

// A strip of sheet, held everywhere and lit at one end: the speed of its front, its max temperature and its residue.
#pragma once

#include "singe/singe.h"

typedef struct StripSetup {
    SingeMaterialDef material; ///< varying parameters take their mean
    float cell;                ///< m
    float time_step;           ///< s
    float length, width;       ///< m
    float gravity[3];          ///< m/s2; the strip lies in the xy plane, and its front runs along x
    float pace;
    bool gas;
    float gas_cell; ///< m, 0: the default
    int threads;
    int patience;      ///< steps without progress after which the fire counts as out
    uint64_t work_max; ///< steps, and iterations of their conduction, in all
    /// Moves a vertex from its position on the grid; NULL: none.
    void (*shape)(float x[3], uint32_t column, uint32_t row, float cell);
} StripSetup;

typedef enum StripEnd {
    STRIP_UNKNOWN, ///< a step failed
    STRIP_THROUGH, ///< the front has passed along it
    STRIP_OUT,     ///< the fire has gone out
    STRIP_CUT,     ///< work_max was reached
} StripEnd;

typedef struct StripResult {
    StripEnd end;
    uint64_t work;     ///< as in work_max
    double speed;      ///< m/s of the front along the strip; 0 if it has not passed along it
    double hottest;    ///< K, of the part that the front has passed
    double residue;    ///< share of its mass that did not become gas
    double thickening; ///< F
} StripResult;

/// A level strip of cells of a millimetre, three across, in default steps and without gas.
StripSetup strip_setup(const SingeMaterialDef *material);
SingeResult strip_burn(const StripSetup *setup, StripResult *result, SingeError *error);

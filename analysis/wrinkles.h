// What can be measured of a drawn sheet's shape: which way its creases run, how rough it is.
#ifndef ANALYSIS_WRINKLES_H
#define ANALYSIS_WRINKLES_H

#include <stdbool.h>

#include "singe/sim.h"

/// Directions of creases in bins of 7.5 degrees over half a turn, from that of growing u.
enum { WRINKLE_BINS = 24 };

/// Sums over a frame, or over many.
typedef struct Wrinkles {
    double crease[WRINKLE_BINS];        ///< area times bend, m2/m
    double axis, diagonal;              ///< the same within 11.25 degrees of the sheet's axes and of their diagonals
    double burnt_power, burnt_area;     ///< rad2 m2 and m2: the normal's angle in wavelengths of 3 to 15 mm
    double unburnt_power, unburnt_area; ///< the same where nothing has burnt far and wide
} Wrinkles;

/// Adds a frame's. False when out of memory.
bool wrinkles_add(const SingeSurface *surface, Wrinkles *wrinkles);

/// Axis over diagonal; NaN where there is no crease.
double wrinkles_bias(const Wrinkles *wrinkles);

/// rad2, of what is burnt and 10 mm around it, and of what has not burnt and is 25 mm from it; NaN where there is none.
double wrinkles_burnt(const Wrinkles *wrinkles);
double wrinkles_unburnt(const Wrinkles *wrinkles);

#endif

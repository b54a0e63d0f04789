// Measures of a drawn sheet's shape: the directions of its creases, its roughness, and how smooth it is along folds.
#pragma once

#include <stdbool.h>

#include "singe/sim.h"

/// Directions of creases in bins of 7.5 degrees over half a turn, from that of growing u.
enum { WRINKLE_BINS = 24 };

/// Sums over a frame, or over many.
typedef struct Wrinkles {
    double crease[WRINKLE_BINS];        ///< area times bend, m2/m
    double axis, diagonal;              ///< the same within 11.25 degrees of the sheet's axes and of their diagonals
    double gentle[2], sharp[2];         ///< of these, bends below 50 and above 130 1/m: axis, diagonal
    double burnt_power, burnt_area;     ///< rad2 m2 and m2: the normal's angle in wavelengths of 3 to 15 mm
    double unburnt_power, unburnt_area; ///< the same far from everything burnt
} Wrinkles;

/// Adds a frame. False when out of memory.
bool wrinkles_add(const SingeSurface *surface, Wrinkles *wrinkles);

/// Axis over diagonal; NaN if there is no crease.
double wrinkles_bias(const Wrinkles *wrinkles);
double wrinkles_bias_gentle(const Wrinkles *wrinkles);
double wrinkles_bias_sharp(const Wrinkles *wrinkles);

/// rad2, of burnt parts and 10 mm around them, and of parts that never ignited at least 25 mm from burnt ones; NaN if
/// there are none.
double wrinkles_burnt(const Wrinkles *wrinkles);
double wrinkles_unburnt(const Wrinkles *wrinkles);

/// Sums over a frame, or over many.
typedef struct Folds {
    double power, count; ///< rad2, and samples: the normal's angle along folds in wavelengths below three cells
} Folds;

/// Adds a frame. False when out of memory.
bool folds_add(const SingeSurface *surface, Folds *folds);

/// Degrees, root mean square; NaN if there is no fold.
double folds_angle(const Folds *folds);

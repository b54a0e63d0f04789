// What a burning sheet looks like in numbers, at the moments that are asked for.
#ifndef EXPERIMENTS_APPEARANCE_H
#define EXPERIMENTS_APPEARANCE_H

#include "experiments/lab.h"
#include "analysis/rim.h"
#include "analysis/wrinkles.h"

/// Sums over the moments looked at; zeroed before the first.
typedef struct Look {
    Rim rim;
    Wrinkles wrinkles;
    double strain_mean, strain_p99; ///< the largest
    double inverted;                ///< share of the cells left, the largest
    double bend;                    ///< degrees from cell to cell, rms, the largest
    double hottest;                 ///< K
    double left;                    ///< share of the cells, at the last
    double step_ms;                 ///< of all stages, the mean since the start
    double dynamics, heat;          ///< shares of it
    int pieces;                     ///< of a twentieth of the sheet and more, at the last
    double border;                  ///< border at rest over the root of the area, at the last
} Look;

/// Adds this moment's. Where nothing is taken away, `cut` above 0 leaves out of the rim's sheet what has no more than
/// this mass: then its rim lies where the edge of the same sheet would be if it were.
SINGE_NODISCARD SingeResult look_take(Play *play, double cut, Look *look, SingeError *error);

/// Degrees: angle between the rim and 10 mm inland, this share of the rim has less.
double look_curl(const Look *look, double share);
/// Degrees: slope of the 4 mm next to the rim, from the plane that the sheet began in.
double look_slope(const Look *look, double share);
/// Area over that at rest, of the same.
double look_area(const Look *look);
/// Degrees rms, of the normal in wavelengths of 3 to 15 mm, where it has burnt.
double look_wrinkles(const Look *look);

#endif

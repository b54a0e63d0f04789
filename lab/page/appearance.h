// The appearance of a burning sheet in numbers, at given times.
#pragma once

#include "page/lab.h"
#include "analysis/rim.h"
#include "analysis/wrinkles.h"

/// Results over several times; zeroed before the first.
typedef struct Look {
    Rim rim;
    Wrinkles wrinkles;
    double strain_mean, strain_p99; ///< the max
    double inverted;                ///< share of the remaining cells, the max
    double bend;                    ///< degrees from cell to cell, rms, the max
    double hottest;                 ///< K
    double left;                    ///< remaining share of the cells, at the last time
    double step_ms;                 ///< all stages, mean since the start
    double dynamics, heat;          ///< shares of it
    int pieces;                     ///< of at least a twentieth of the sheet, at the last time
    double border;                  ///< border at rest over the root of the area, at the last time
} Look;

/// Adds the current state. For a sheet that is not ablated, `cut` above 0 drops triangles with at most this mass before
/// the rim is measured: the rim is then where the edge would be with ablation.
SINGE_NODISCARD SingeResult look_take(Play *play, double cut, Look *look, SingeError *error);

/// Degrees: the angle between the rim and 10 mm inland, at this percentile of the rim.
double look_curl(const Look *look, double share);
/// Degrees: slope of the 4 mm next to the rim, from the plane that the sheet began in.
double look_slope(const Look *look, double share);
/// Area over rest area of the same band.
double look_area(const Look *look);
/// Degrees rms, of the normal in wavelengths of 3 to 15 mm, where it has burnt.
double look_wrinkles(const Look *look);

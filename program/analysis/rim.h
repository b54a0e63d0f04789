// The shape of a burnt edge: how far a sheet shrinks, slopes and curls, by the distance from the edge.
#pragma once

#include <stdbool.h>

#include "singe/sim.h"

/// Angles are counted in bins of half a degree from 0 to 180.
enum { RIM_BANDS = 7, RIM_ANGLES = 360 };

/// m, distances from the burnt edge, on the sheet at rest, at which the bands begin and the last one ends.
extern const double rim_band_limits[RIM_BANDS + 1];

/// Sums over one band. All but `area` are weighted by the area at rest.
typedef struct RimBand {
    double rest_area, area;   ///< m2, at rest and now
    double mass;              ///< m2, mass fraction times area
    double height;            ///< m3, above the plane of the piece at rest
    double slope[RIM_ANGLES]; ///< m2, by the angle between the normal and that plane's
} RimBand;

/// Sums over a frame, or over many.
typedef struct Rim {
    RimBand band[RIM_BANDS];
    double curl[RIM_ANGLES]; ///< m2, by the angle between the normals at the rim and 10 mm inland
    double curl_max;         ///< degrees
} Rim;

/// Adds the largest piece of a frame, if it has a burnt edge. False when out of memory.
bool rim_add(const SingeSurface *surface, Rim *rim);

/// Adds the sums of one to the other.
void rim_sum(const Rim *rim, Rim *sum);

/// Degrees below which this share of the counted area lies; NaN if nothing was counted.
double rim_percentile(const double histogram[RIM_ANGLES], double share);

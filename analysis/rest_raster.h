// A surface's fields over the sheet as it was before it burnt: pixels that know nothing of the mesh's edges.
#ifndef ANALYSIS_REST_RASTER_H
#define ANALYSIS_REST_RASTER_H

#include <stdbool.h>

#include "singe/sim.h"

typedef struct RestRaster {
    int width, height;
    double spacing;   ///< m, of pixels
    double turn;      ///< rad, of the raster's axes against the direction of growing u on the sheet
    float *cover;     ///< 1 where the sheet is drawn, 0 elsewhere
    float *normal[3]; ///< unit, that of the drawn sheet
    float *burn;      ///< 0 fresh to 1 ash
    float *unlit;     ///< 1 where it has never ignited
} RestRaster;

/// Draws a sheet of the surface at a spacing of pixels in m. The sheet is laid into the plane that fits its rest
/// positions best: a sheet that was curved to begin with is seen from one side. False when out of memory, after which
/// nothing is to be freed. A sheet that has no area gives a raster of no pixels.
bool rest_raster_draw(const SingeSurface *surface, int32_t sheet, double spacing, RestRaster *raster);
void rest_raster_free(RestRaster *raster);

/// Smooths `field` where it is covered by a Gaussian of this deviation in m, leaving out what is not covered, into
/// `smooth`. `scratch` is room for twice a field; `weight` gets the share of the Gaussian that was covered.
void rest_raster_smooth(const RestRaster *raster, const float *field, double deviation, float *scratch, float *weight,
                        float *smooth);

/// Distance in m of every pixel to the nearest one with burn above `least`; at most a tenth off.
void rest_raster_distance(const RestRaster *raster, float min, float *distance);

#endif

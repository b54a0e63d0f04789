// A surface's fields over the sheet at rest, before it burnt, on pixels that are independent of the mesh's edges.
#pragma once

#include <stdbool.h>

#include "singe/sim.h"

typedef struct RestRaster {
    int width, height;
    double spacing;   ///< m, of pixels
    double turn;      ///< rad, of the raster's axes from the direction of growing u on the sheet
    float *cover;     ///< 1 if the sheet is drawn there, else 0
    float *normal[3]; ///< unit, that of the drawn sheet
    float *burn;      ///< 0 fresh to 1 ash
    float *unlit;     ///< 1 if it has never ignited there, else 0
} RestRaster;

/// Draws a sheet of the surface on pixels of this spacing, m. The sheet is projected onto the plane that fits its rest
/// positions best: a sheet that is curved at rest is seen from one side. False when out of memory; then there is
/// nothing to free. A sheet without area gives a raster without pixels.
bool rest_raster_draw(const SingeSurface *surface, int32_t sheet, double spacing, RestRaster *raster);
void rest_raster_free(RestRaster *raster);

/// Smooths the covered part of `field` by a Gaussian of this deviation, m, into `smooth`. `scratch` has room for two
/// fields; `weight` gets the share of the Gaussian that was covered.
void rest_raster_smooth(const RestRaster *raster, const float *field, double deviation, float *scratch, float *weight,
                        float *smooth);

/// Distance in m of every pixel to the nearest one with burn above `min`; its error is at most a tenth.
void rest_raster_distance(const RestRaster *raster, float min, float *distance);

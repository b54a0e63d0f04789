// The burnt edge of a piece as points along it, on the sheet at rest.
#ifndef ANALYSIS_RIM_POINTS_H
#define ANALYSIS_RIM_POINTS_H

#include <stdbool.h>
#include <stddef.h>

#include "singe/sim.h"

/// Points in a grid. An empty one has count 0.
typedef struct RimPoints {
    size_t count;
    double (*position)[3]; ///< m, at rest
    double (*near)[3];     ///< sums of the normals near the rim, made by the caller for the nearest point
    double (*normal)[3];   ///< unit, of the rim; 0 if it is not known
    double low[3], cell;   ///< m, of the grid
    int size[3];
    uint32_t *first; ///< [cells + 1] of `order`
    uint32_t *order; ///< points by their cell
} RimPoints;

/// Makes points every quarter of a millimetre along the piece's open edges that have burnt, if there are any. False
/// when out of memory. Free them, after failure too.
bool rim_points_make(const SingeSurface *surface, int32_t piece, RimPoints *points);
void rim_points_free(RimPoints *points);

/// m from a rest position to the nearest point, or INFINITY if it is not below `reach`. *nearest gets that point.
/// Before the call it is a hint: any number, best that of a nearby point.
double rim_points_distance(const RimPoints *points, const double position[3], double reach, uint32_t *nearest);

/// The rim's normal at each point, from `near` of all points within `reach` in m.
void rim_points_normals(RimPoints *points, double reach);

#endif

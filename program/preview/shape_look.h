// The appearance of a shape: a point in its frame, and a function for each surface.
#pragma once

#include "preview/internal.h"

/// A point in its shape's frame.
typedef struct Place {
    const PreviewShape *shape;
    Float3 p, normal; ///< m
    float size;       ///< m, half of the shape's length or so
} Place;

/// Tilts the normal by a slope in the shape's frame.
void shape_lean(const Place *place, Float3 slope, Point *point);

// shade_wood.c
void shape_wood(const Preview *preview, const Place *place, Point *point);

// shade_cloth.c
void shape_cloth(const Place *place, Point *point);
void shape_cord(const Place *place, Point *point);

// shade_metal.c
void shape_metal(const Place *place, Point *point);

/// What glows.
void shape_glow(const Preview *preview, const Place *place, Point *point);

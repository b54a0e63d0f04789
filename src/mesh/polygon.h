// Polygons cut into triangles that cover exactly their area (polygon.c).
#pragma once

#include "mesh/work.h"

enum { POLYGON_GROWTH = 2 }; ///< max corners of a ring per corner of its face

/// Scratch for the polygons of some faces, and the triangles of one polygon.
typedef struct PolygonCut {
    Work *work;
    const Faces *faces;
    uint32_t capacity;       ///< POLYGON_GROWTH times the corners of the largest face
    uint32_t *ring;          ///< [capacity] half-edges
    double (*at)[2];         ///< [capacity] their positions, projected along the normal
    double *worth;           ///< [capacity] of the triangle at a corner
    uint32_t *order;         ///< sides sorted by their ends; made when first needed
    uint32_t count;          ///< triangles
    uint32_t (*triangle)[3]; ///< [capacity] half-edges
} PolygonCut;

/// False when out of memory.
bool polygon_begin(PolygonCut *cut, Work *work, const Faces *faces);

/// Twice the area of a ring of n half-edges times its normal.
void polygon_normal(const PolygonCut *cut, const uint32_t *ring, uint32_t n, double normal[3]);

/// Whether all sides are visible from the mean of the corners and wind around it once, and the same holds for the quads
/// that the polygon would be split into. Cells are drawn from there.
bool polygon_is_star(PolygonCut *cut, const uint32_t *ring, uint32_t n);

/// Appends to cut->triangle n - 2 triangles that cover a ring of 3 half-edges or more. False if it crosses itself.
bool polygon_cut(PolygonCut *cut, const uint32_t *ring, uint32_t n);

/// Whether two of cut->triangle overlap, projected along a normal.
bool polygon_overlaps(PolygonCut *cut, const double normal[3]);

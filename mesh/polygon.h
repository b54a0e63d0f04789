// Polygons cut into triangles that cover exactly their area (polygon.c).
#ifndef MESH_POLYGON_H
#define MESH_POLYGON_H

#include "mesh/work.h"

enum { POLYGON_GROWTH = 2 }; ///< corners that a ring may have for one of its face

/// Scratch for the polygons of some faces, and the triangles that come of one.
typedef struct PolygonCut {
    Work *work;
    const Faces *faces;
    uint32_t capacity;       ///< POLYGON_GROWTH times the corners of the largest face
    uint32_t *ring;          ///< [capacity] half-edges
    double (*at)[2];         ///< [capacity] their positions, seen along the normal
    double *worth;           ///< [capacity] of the triangle at a corner
    uint32_t *order;         ///< sides by their ends, once one is asked for
    uint32_t count;          ///< triangles
    uint32_t (*triangle)[3]; ///< [capacity] half-edges
} PolygonCut;

/// False without memory.
bool polygon_begin(PolygonCut *cut, Work *work, const Faces *faces);

/// Twice the area of a ring of n half-edges times its normal.
void polygon_normal(const PolygonCut *cut, const uint32_t *ring, uint32_t n, double normal[3]);

/// Whether all sides can be seen from the mean of the corners, once around, and so in the quads that it would be split
/// into: cells are drawn from there.
bool polygon_is_star(PolygonCut *cut, const uint32_t *ring, uint32_t n);

/// Appends to cut->triangle n - 2 triangles that cover a ring of 3 half-edges or more. False where it crosses itself.
bool polygon_cut(PolygonCut *cut, const uint32_t *ring, uint32_t n);

/// Whether two of cut->triangle lie on each other, seen along a normal.
bool polygon_overlaps(PolygonCut *cut, const double normal[3]);

#endif

// The triangles of a mesh while they are joined to quads (pair.c).
#ifndef MESH_PAIR_H
#define MESH_PAIR_H

#include "mesh/pair_heap.h"

typedef struct Pairs {
    Work *work;
    uint32_t *mate;   ///< [triangles]
    uint32_t *whole;  ///< [triangles] the first corner, in `before`, of the quad that it is half of; else MESH_NONE
    double *cost;     ///< [half-edges] of the pair across a side, at the lower of its two half-edges
    uint8_t *good;    ///< [half-edges] whether that pair makes a good quad
    uint32_t *degree; ///< [vertices] triangles
    uint8_t *rim;     ///< [vertices] whether on an open edge
    Faces before;     ///< the faces that the triangles come from
    uint32_t *before_face, *before_twin; ///< [corners of `before`]
    uint32_t *from;                      ///< [half-edges] the corner in `before` at which it begins
    PairHeap heap;
} Pairs;

/// Degrees between 0 and 180 at vertex b of the corner a b c.
double pair_angle(const Work *work, uint32_t a, uint32_t b, uint32_t c);
/// Cuts all faces into triangles: fills `before`, `from`, `mate` and `whole`, and the faces of `work`. False if a
/// face cannot be cut. work->no_memory is set when out of memory.
bool pair_cut_faces(Pairs *pairs);
/// Finds the twins of the triangles' sides: those of the faces in `before`, and for a diagonal its other side.
void pair_find_twins(Pairs *pairs);

#endif

// Splits a face's ring of corners into loops that can be cut into triangles (loops.c).
#pragma once

#include "mesh/polygon.h"

/// Kind of a face.
typedef enum FaceKind {
    FACE_WHOLE,   ///< one loop, entirely visible from its centroid
    FACE_CUT,     ///< loops, cut into cut.triangle
    FACE_IDLE,    ///< without area
    FACE_CROSSED, ///< crosses itself
} FaceKind;

typedef struct Loops {
    PolygonCut cut;
    uint32_t *ring, *stack; ///< [cut.capacity] half-edges of the face, and those not yet in a loop
    uint32_t count;
    uint32_t *corner;    ///< half-edges of the loops, contiguous
    uint32_t *end;       ///< [count + 1]
    uint32_t *triangles; ///< [count + 1] the first triangle of each loop
    bool repeats;        ///< the face names a vertex twice
    bool spikes;         ///< the face doubles back along itself
} Loops;

/// False when out of memory.
bool loops_begin(Loops *loops, Work *work, const Faces *faces);

/// Finds the loops of a face, and cuts them if it is not whole.
FaceKind loops_find(Loops *loops, uint32_t face);

/// Whether a loop is entirely visible from the mean of its corners.
bool loops_is_star(Loops *loops, uint32_t loop);

/// Whether all corners lie on a line. A ring that crosses itself may have an area of 0 without being flat.
bool loops_is_flat(const Loops *loops, const uint32_t *ring, uint32_t n);

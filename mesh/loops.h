// A face's ring of corners taken apart into loops that can be cut (loops.c).
#ifndef MESH_LOOPS_H
#define MESH_LOOPS_H

#include "mesh/polygon.h"

/// What a face is.
typedef enum FaceKind {
    FACE_WHOLE,   ///< one loop, all of which can be seen from its centre
    FACE_CUT,     ///< loops that are cut into cut.triangle
    FACE_IDLE,    ///< without area
    FACE_CROSSED, ///< crosses itself
} FaceKind;

typedef struct Loops {
    PolygonCut cut;
    uint32_t *ring, *stack; ///< [cut.capacity] half-edges of the face, and those not yet in a loop
    uint32_t count;
    uint32_t *corner;    ///< half-edges of the loops, one after the other
    uint32_t *end;       ///< [count + 1]
    uint32_t *triangles; ///< [count + 1] the first triangle of each loop
    bool repeats;        ///< the face names a vertex twice
    bool spikes;         ///< or goes out and comes back the same way
} Loops;

/// False without memory.
bool loops_begin(Loops *loops, Work *work, const Faces *faces);

/// Finds the loops of a face, and cuts them where it is not whole.
FaceKind loops_find(Loops *loops, uint32_t face);

/// Whether all of a loop can be seen from the mean of its corners.
bool loops_is_star(Loops *loops, uint32_t loop);

/// Whether corners lie on a line. A ring that crosses itself may have an area of 0, and is not flat.
bool loops_is_flat(const Loops *loops, const uint32_t *ring, uint32_t n);

#endif

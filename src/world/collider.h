// Rigid primitives: their signed distance, for contact in the dynamics and for contact heat.
#ifndef WORLD_COLLIDER_H
#define WORLD_COLLIDER_H

#include "world/path.h"

typedef struct Collider {
    uint32_t generation; ///< 0: the slot is free
    SingeColliderDef def; ///< its `path` pointer is not used
    Path path;
} Collider;

typedef struct ColliderList {
    uint32_t count, capacity;
    Collider *items;
} ColliderList;

SingeResult collider_check(const SingeColliderDef *def, SingeError *error);

/// Signed distance of a point in the collider's own frame, negative inside, and the outward unit
/// normal there (own frame).
float collider_distance(const SingeColliderDef *def, Vec local, Vec *normal);

#endif

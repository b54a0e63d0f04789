// Rigid solids: their signed distance, for contact in the dynamics, for contact heat and for the gas.
#pragma once

#include "world/deform.h"
#include "world/height_solid.h"
#include "world/mesh_solid.h"
#include "world/path.h"

typedef struct Collider {
    uint32_t generation;  ///< 0: the slot is free
    SingeColliderDef def; ///< its pointers are not used
    Path path;
    MeshSolid mesh;      ///< of a mesh
    HeightSolid heights; ///< of a heightfield
    Deform deform;       ///< of a deforming mesh
} Collider;

typedef struct ColliderList {
    uint32_t count, capacity;
    Collider *items;
} ColliderList;

/// Checks a Def and copies what it points to, into a zeroed Collider whose generation stays 0. On failure it is empty.
SingeResult collider_create(Memory *memory, const SingeColliderDef *def, Collider *collider, SingeError *error);
void collider_free(Memory *memory, Collider *collider);

/// Signed distance of a point in the collider's own frame, negative inside, and the outward unit normal there (own
/// frame). Exact inside and where it is less than `limit`; farther out it is some number from `limit` to the distance,
/// and the normal is arbitrary. With a limit of 0 only the sign is valid, also inside.
float collider_distance(const Collider *collider, Float3 local, float limit, Float3 *normal);

/// Poses a deforming mesh at a time; others need no posing.
void collider_at(const Collider *collider, double time);

/// The bounding box of the collider during a substep, in its own frame; infinite where the collider is.
void collider_bounds(const Collider *collider, Float3 *low, Float3 *high);

// A closed mesh whose vertices a caller moves: its solids at the two ends of a substep.
//
// Between them every point of the surface moves in a straight line. So a particle's path starts where the nearest point
// of the surface would have carried the particle:
//
//   x' = x + sum_k w_k (v_k' - v_k),   w the weights of its foot in the triangle before, v and v' that triangle's
//   vertices
#pragma once

#include "world/mesh_solid.h"
#include "world/motion.h"

/// Scratch of the steps: the mesh at two times. It depends only on the motion and the times.
typedef struct DeformPose {
    MeshSolid solid[2]; ///< the second owns only its vertices, leaves and nodes
    double time[2];     ///< s; NAN if it must be rebuilt
    int now;            ///< which of them is the later one
    float farthest;     ///< m, max displacement of a vertex between the two
} DeformPose;

typedef struct Deform {
    Motion motion;
    float (*rest)[3]; ///< [vertices] of the given mesh
    DeformPose *pose;
} Deform;

/// Checks and copies a mesh as mesh_solid_create does; it is at rest until it is moved. On failure it is empty.
SingeResult deform_create(Memory *memory, uint32_t vertex_count, const float *vertices, uint32_t triangle_count,
                          const uint32_t *triangles, Deform *deform, SingeError *error);
void deform_free(Memory *memory, Deform *deform);

/// Poses the later solid at a time, or both at the ends of a substep.
void deform_at(const Deform *deform, double time);
void deform_between(const Deform *deform, double before, double after);

/// Marks both solids as out of date, after a change of the motion.
void deform_forget(const Deform *deform);

static inline const MeshSolid *deform_solid(const Deform *deform) { return &deform->pose->solid[deform->pose->now]; }

/// Displacement in the substep of the surface point nearest to p, which is given at the substep's beginning.
Float3 deform_drift(const Deform *deform, Float3 p);

/// The bounding box of the mesh during the substep.
void deform_bounds(const Deform *deform, Float3 *low, Float3 *high);

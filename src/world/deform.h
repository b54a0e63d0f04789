// A closed mesh whose vertices a caller moves: the solids that it is at the two ends of a substep.
//
// Between them every point of the surface moves in a straight line. So a particle is followed from where it would have
// been carried by the point of the surface that was nearest to it:
//
//   x' = x + sum_k w_k (v_k' - v_k),   w the weights of its foot in the triangle before, v and v' that triangle's
//   vertices
#ifndef WORLD_DEFORM_H
#define WORLD_DEFORM_H

#include "world/mesh_solid.h"
#include "world/motion.h"

/// Scratch of the steps: the mesh at two times. It follows from the motion and the times alone.
typedef struct DeformPose {
    MeshSolid solid[2]; ///< share all but vertices, leaves and nodes, which the first owns
    double time[2];     ///< s; NAN where it has to be made anew
    int now;            ///< which of them is the later one
    float farthest;     ///< m, that a vertex moves between the two
} DeformPose;

typedef struct Deform {
    Motion motion;
    float (*rest)[3]; ///< [vertices] as the mesh was given
    DeformPose *pose;
} Deform;

/// Checks and copies a mesh as mesh_solid_create does; it stands still until it is moved. On failure it is empty.
SingeResult deform_create(Memory *memory, uint32_t vertex_count, const float *vertices, uint32_t triangle_count,
                          const uint32_t *triangles, Deform *deform, SingeError *error);
void deform_free(Memory *memory, Deform *deform);

/// Poses the later solid at a time, or both at the ends of a substep.
void deform_at(const Deform *deform, double time);
void deform_between(const Deform *deform, double before, double after);

/// What the vertices' motion was changed to is not yet posed.
void deform_forget(const Deform *deform);

static inline const MeshSolid *deform_solid(const Deform *deform) { return &deform->pose->solid[deform->pose->now]; }

/// How far the surface nearest to a point moves in the substep; p as it was at its beginning.
Float3 deform_drift(const Deform *deform, Float3 p);

/// The box that holds the mesh throughout the substep.
void deform_bounds(const Deform *deform, Float3 *low, Float3 *high);

#endif

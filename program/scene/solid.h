// Colliders from files.
#pragma once

#include "scene/scene.h"

/// The triangles of a mesh file, times `scale`.
SINGE_NODISCARD SingeResult solid_read_mesh(const char *name, const uint8_t *bytes, size_t size, double scale,
                                            SceneSolid *solid, SingeError *error);

/// What is known of a face's corner while it is cut.
typedef struct SolidEar {
    double square;    ///< m2, of the new edge when it is clipped; infinite if it is no ear
    uint32_t blocker; ///< the first corner left that lies in its triangle; UINT32_MAX: none, or it turns the other way
} SolidEar;

/// Cuts a face into count - 2 triangles; `left` has its corners and is consumed, as is `ears`, of the same length.
void solid_cut_face(const float *vertices, uint32_t *left, SolidEar *ears, uint32_t count, uint32_t *triangles);

/// Heights from a picture, between the heights of black and of white, over a rectangle of that size, and the drawn
/// surface.
SINGE_NODISCARD SingeResult solid_make_heights(const SingeTexture *picture, const float size[2], const float heights[2],
                                               SceneSolid *solid, SingeError *error);

/// Metres per unit of a file with these SceneUnits, times `scale` (load.c).
double metres_per_unit(int unit, float scale);

void solid_free(SceneSolid *solid);

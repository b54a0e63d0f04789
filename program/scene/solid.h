// Colliders from files.
#ifndef SCENE_SOLID_H
#define SCENE_SOLID_H

#include "scene/scene.h"

/// The triangles of a mesh file, times `scale`.
SINGE_NODISCARD SingeResult solid_read_mesh(const char *name, const uint8_t *bytes, size_t size, double scale,
                                            SceneSolid *solid, SingeError *error);

/// Cuts a face into count - 2 triangles; `left` has its corners and is consumed.
void solid_cut_face(const float *vertices, uint32_t *left, uint32_t count, uint32_t *triangles);

/// Heights from a picture, between the heights of black and of white, over a rectangle of that size, and the drawn
/// surface.
SINGE_NODISCARD SingeResult solid_make_heights(const SingeTexture *picture, const float size[2], const float heights[2],
                                               SceneSolid *solid, SingeError *error);

/// Metres per unit of a file with these SceneUnits, times `scale` (load.c).
double metres_per_unit(int unit, float scale);

void solid_free(SceneSolid *solid);

#endif

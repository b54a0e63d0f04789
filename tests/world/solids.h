// Closed triangle meshes for the tests of colliders.
#pragma once

#include "singe/types.h"

typedef struct Triangles {
    uint32_t vertex_count, triangle_count;
    float *vertices;
    uint32_t *triangles;
} Triangles;

/// A sphere of about 2 around^2/2 triangles; every vertex off its position by up to `rough` of the radius.
Triangles triangles_sphere(uint32_t around, float radius, float rough);
/// A torus about z.
Triangles triangles_torus(uint32_t around, uint32_t tube, float radius, float tube_radius);
/// A box, each face of n by n squares.
Triangles triangles_box(uint32_t n, float x, float y, float z);
/// Turned about an odd axis and moved.
void triangles_turn(Triangles *mesh, float angle, float x, float y, float z);
void triangles_free(Triangles *mesh);
#define OwnTriangles OWNED(triangles_free) Triangles
/// A Def of it, to be given a path.
SingeColliderDef triangles_def(const Triangles *mesh);

/// Signed distance by looking at all triangles: the sign by the solid angle under which they are seen.
double triangles_distance(const Triangles *mesh, const float p[3]);

// Signed distance from a closed mesh. Its magnitude is the distance to the nearest triangle; its sign is that of
//
//   (p - foot) . n,   n the pseudonormal of the feature that the foot lies on: the face's normal, the sum of an edge's
//   two, or the sum of a vertex's weighted by their angles
//
// (Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal, 2005), which is right for
// every mesh that does not intersect itself. A grid of distances at its cells' centres avoids searches in the tree of
// triangles (mesh_tree.c) for points far away: the distance changes by at most the displacement, so that at p
//
//   |d(p)| >= |d(c)| - |p - c|,   and the sign is that at c where this is above 0,
//
// and it bounds the search radius in the tree. So the grid's coarseness costs time, never accuracy.
#include "common/real.h"
#include "world/mesh_solid.h"
#include "world/triangle.h"

/// Cells of the grid per triangle; min and max number of cells.
static const double GRID_SHARE = 32, GRID_MIN = 4096, GRID_MAX = 1 << 20;

/// Factor on the square of a distance, for rounding.
static const float SOLID_SLACK = 1.001f;

static Float3 solid_corner(const MeshSolid *solid, uint32_t t, uint32_t corner) {
    return float3_load(solid->vertices[solid->triangles[t][corner]]);
}

static Float3 solid_face_normal(const MeshSolid *solid, uint32_t t) {
    Float3 a = solid_corner(solid, t, 0);
    return float3_unit(
        float3_cross(float3_sub(solid_corner(solid, t, 1), a), float3_sub(solid_corner(solid, t, 2), a)));
}

/// A triangle's angle at a corner.
static float solid_angle(const MeshSolid *solid, uint32_t t, uint32_t corner) {
    Float3 at = solid_corner(solid, t, corner), a = float3_sub(solid_corner(solid, t, (corner + 1) % 3), at);
    Float3 b = float3_sub(solid_corner(solid, t, (corner + 2) % 3), at);
    return real_atan2f(float3_length(float3_cross(a, b)), float3_dot(a, b));
}

static SingeResult solid_no_memory(SingeError *error) {
    return error_set(error, SINGE_ERROR_MEMORY, "collider", -1, "out of memory for the mesh");
}

static Float3 solid_cell_centre(const MeshSolid *solid, int i, int j, int k) {
    return float3(solid->origin.x + ((float)i + 0.5f) * solid->cell, solid->origin.y + ((float)j + 0.5f) * solid->cell,
                  solid->origin.z + ((float)k + 0.5f) * solid->cell);
}

/// A vertex's normal, weighted by angles: stored, or from the triangles around it.
static Float3 solid_vertex_normal(const MeshSolid *solid, uint32_t t, uint32_t corner) {
    const uint32_t vertex = solid->triangles[t][corner], first = t;
    if (solid->vertex_normals) return float3_load(solid->vertex_normals[vertex]);

    Float3 sum = {0, 0, 0};
    uint32_t turns = 0;
    do {
        uint32_t i = 0;
        while (i < 2 && solid->triangles[t][i] != vertex) i++;
        sum = float3_mad(sum, solid_face_normal(solid, t), solid_angle(solid, t, i));
        t = solid->neighbours[t][i];
    } while (t != first && ++turns < solid->triangle_count);

    return sum;
}

/// The signed distance from triangle t, the nearest one.
static float solid_signed(const MeshSolid *solid, Float3 p, uint32_t t, Float3 *normal) {
    Float3 a = solid_corner(solid, t, 0), b = solid_corner(solid, t, 1), c = solid_corner(solid, t, 2);
    TriangleClosest foot = triangle_closest(p, a, b, c);

    // the pseudonormal of the feature
    const int edge = foot.feature - TRIANGLE_EDGE, corner = foot.feature - TRIANGLE_CORNER;
    if (edge < 0) *normal = float3_unit(solid_vertex_normal(solid, t, (uint32_t)corner));
    else *normal = solid_face_normal(solid, t);
    if (edge >= 0 && foot.feature < TRIANGLE_FACE)
        *normal = float3_unit(float3_add(*normal, solid_face_normal(solid, solid->neighbours[t][edge])));

    const double n[3] = {(double)normal->x, (double)normal->y, (double)normal->z};
    double along = dot3(foot.away, n), distance = sqrt(foot.square);
    float sign = along < 0 ? -1 : 1;

    // at an edge or a vertex the normal points from the foot to p or back, unless that is lost in rounding
    if (foot.feature < TRIANGLE_FACE && distance > 1e-7 * (1 + (double)float3_length(p))) {
        double scale = (double)sign / distance;
        *normal = float3((float)(foot.away[0] * scale), (float)(foot.away[1] * scale), (float)(foot.away[2] * scale));
    }

    return sign * (float)distance;
}

/// Computes the grid's distances, one after another along x: each bounds the search radius of the next.
static bool solid_grid(Memory *memory, MeshSolid *solid) {
    Float3 size = float3_sub(solid->high, solid->low);
    double wanted = double_min(double_max(GRID_SHARE * solid->triangle_count, GRID_MIN), GRID_MAX);

    // a flat mesh counts as thicker: otherwise all cells would lie in its plane
    double min = (double)float_max(size.x, float_max(size.y, size.z)) / 256;
    double side[3] = {double_max((double)size.x, min), double_max((double)size.y, min),
                      double_max((double)size.z, min)};
    solid->cell = (float)real_cbrt(side[0] * side[1] * side[2] / wanted);

    size_t count = 1;
    for (int d = 0; d < 3; d++) { // and a margin of one cell
        solid->cells[d] = (int32_t)ceil(side[d] / (double)solid->cell) + 2;
        count *= (size_t)solid->cells[d];
    }

    Float3 half = float3((float)solid->cells[0], (float)solid->cells[1], (float)solid->cells[2]);
    solid->origin = float3_mad(float3_scale(float3_add(solid->low, solid->high), 0.5f), half, -0.5f * solid->cell);
    if (!NEW(memory, solid->coarse, count)) return false;

    float *coarse = solid->coarse;
    for (int k = 0; k < solid->cells[2]; k++)
        for (int j = 0; j < solid->cells[1]; j++) {
            float square = INFINITY;
            for (int i = 0; i < solid->cells[0]; i++, coarse++) {
                Float3 p = solid_cell_centre(solid, i, j, k), normal;
                *coarse = solid_signed(solid, p, mesh_tree_nearest(solid, p, &square), &normal);
                float next = fabsf(*coarse) + 1.01f * solid->cell;
                square = next * next;
            }
        }

    return true;
}

SingeResult mesh_solid_create(Memory *memory, uint32_t vertex_count, const float *vertices, uint32_t triangle_count,
                              const uint32_t *triangles, MeshSolid *solid, SingeError *error) {
    SingeResult result =
        mesh_solid_create_moving(memory, vertex_count, vertices, triangle_count, triangles, solid, error);
    if (result) return result;
    if (!NEW(memory, solid->vertex_normals, solid->vertex_count)) {
        mesh_solid_free(memory, solid);
        return solid_no_memory(error);
    }

    // vertices' normals, weighted by angles
    for (uint32_t t = 0; t < solid->triangle_count; t++) {
        Float3 normal = solid_face_normal(solid, t);
        for (uint32_t i = 0; i < 3; i++) {
            float *sum = solid->vertex_normals[solid->triangles[t][i]];
            float3_store(sum, float3_mad(float3_load(sum), normal, solid_angle(solid, t, i)));
        }
    }

    if (solid_grid(memory, solid)) return SINGE_OK;

    mesh_solid_free(memory, solid);
    return solid_no_memory(error);
}

SingeResult mesh_solid_create_moving(Memory *memory, uint32_t vertex_count, const float *vertices,
                                     uint32_t triangle_count, const uint32_t *triangles, MeshSolid *solid,
                                     SingeError *error) {
    *solid = (MeshSolid){.cell = 1};
    SingeResult result = mesh_solid_take(memory, vertex_count, vertices, triangle_count, triangles, solid, error);
    if (!result && !mesh_tree_create(memory, solid)) result = solid_no_memory(error);

    if (result) {
        mesh_solid_free(memory, solid);
        return result;
    }

    // bounds
    solid->low = solid->high = solid_corner(solid, 0, 0);
    for (uint32_t t = 0; t < solid->triangle_count; t++)
        for (uint32_t i = 0; i < 3; i++) {
            Float3 v = solid_corner(solid, t, i), low = solid->low, high = solid->high;
            solid->low = float3(float_min(low.x, v.x), float_min(low.y, v.y), float_min(low.z, v.z));
            solid->high = float3(float_max(high.x, v.x), float_max(high.y, v.y), float_max(high.z, v.z));
        }

    return SINGE_OK;
}

void mesh_solid_free(Memory *memory, MeshSolid *solid) {
    FREE(memory, solid->vertices, solid->vertex_count);
    FREE(memory, solid->triangles, solid->room);
    FREE(memory, solid->neighbours, solid->room);
    FREE(memory, solid->vertex_normals, solid->vertex_count);
    FREE(memory, solid->order, solid->triangle_count);
    FREE(memory, solid->leaves, solid->leaf_count);
    FREE(memory, solid->nodes, solid->node_count);
    FREE(memory, solid->coarse, (size_t)solid->cells[0] * (size_t)solid->cells[1] * (size_t)solid->cells[2]);
    *solid = (MeshSolid){0};
}

float mesh_solid_distance(const MeshSolid *solid, Float3 p, float limit, Float3 *normal) {
    const float q[3] = {(p.x - solid->origin.x) / solid->cell, (p.y - solid->origin.y) / solid->cell,
                        (p.z - solid->origin.z) / solid->cell};
    int at[3];
    bool within = true;
    *normal = float3(0, 0, 1);
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) return INFINITY; // every box of the tree would be near

    // the grid's cell
    for (int d = 0; d < 3; d++) {
        within = within && q[d] >= 0 && q[d] < (float)solid->cells[d];
        at[d] = within ? (int)q[d] : 0;
    }

    // bounds by the grid, or by the box outside of it
    float min = 0, max = INFINITY;
    if (within) {
        int row = at[2] * solid->cells[1] + at[1];
        float coarse = solid->coarse[(size_t)row * (size_t)solid->cells[0] + (size_t)at[0]];
        float distance = 1.0001f * float3_length(float3_sub(p, solid_cell_centre(solid, at[0], at[1], at[2])));
        min = fabsf(coarse) - distance;
        max = fabsf(coarse) + distance;
        if (min > 0 && min >= limit && (coarse > 0 || limit == 0)) return coarse > 0 ? min : -min;
    } else {
        Float3 low = float3_sub(solid->low, p), high = float3_sub(p, solid->high);
        Float3 out = float3(float_max(float_max(low.x, high.x), 0), float_max(float_max(low.y, high.y), 0),
                            float_max(float_max(low.z, high.z), 0));
        min = float3_length(out);
        if (min > 0 && min >= limit) return min;
    }

    // the nearest triangle
    float square = SOLID_SLACK * max * max;
    uint32_t t = mesh_tree_nearest(solid, p, &square);
    return t == UINT32_MAX ? INFINITY : solid_signed(solid, p, t, normal);
}

// Rays against closed meshes, one BVH per solid, in the solid's own frame, into which rays are transformed.
// A moving mesh is thus built once, and blurs like other shapes.
//
// Normals are smooth over edges blunter than FACETS_CREASE: a corner's normal is the sum, weighted by area, of those of
// the surrounding faces within that angle.

#include "preview/internal.h"

#include <string.h>

static const float FACETS_CREASE = 0.82f; ///< cosine of 35 degrees
static const Float3 UP = {0, 0, 1};       ///< the normal of a face without area

static Float3 facets_corner(const PreviewSolid *solid, uint32_t triangle, int corner) {
    return float3_load(solid->vertices + 3 * (size_t)solid->triangles[3 * (size_t)triangle + (size_t)corner]);
}

/// The normal times twice the area.
static Float3 facets_cross(const PreviewSolid *solid, uint32_t t) {
    Float3 a = facets_corner(solid, t, 0);
    return float3_cross(float3_sub(facets_corner(solid, t, 1), a), float3_sub(facets_corner(solid, t, 2), a));
}

/// Normals of the corners, and bounds.
static SingeResult facets_normals(Preview *preview, Facets *facets, SingeError *error) {
    const PreviewSolid *solid = facets->solid;
    const uint32_t *triangles = solid->triangles;
    SingeAllocator allocator = preview->allocator;
    size_t corners = 3 * (size_t)solid->triangle_count, vertices = (size_t)solid->vertex_count + 2;
    uint32_t *first = allocator_resize(allocator, NULL, 0, vertices * sizeof *first);
    uint32_t *fan = allocator_resize(allocator, NULL, 0, corners * sizeof *fan);

    facets->normals = allocator_resize(allocator, NULL, 0, corners * sizeof *facets->normals);
    facets->bent = allocator_resize(allocator, NULL, 0, solid->triangle_count * sizeof *facets->bent);
    bool ok = first && fan && facets->normals && facets->bent;

    if (ok) {
        // triangles by their vertices: those of vertex v are fan[first[v]] up to fan[first[v + 1]]
        memset(first, 0, vertices * sizeof *first);
        for (size_t k = 0; k < corners; k++) first[triangles[k] + 2]++;
        for (size_t v = 2; v <= solid->vertex_count; v++) first[v + 1] += first[v];
        for (size_t k = 0; k < corners; k++) fan[first[triangles[k] + 1]++] = (uint32_t)(k / 3);
    }

    Float3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; ok && k < corners; k++) {
        Float3 own = float3_unit_or(facets_cross(solid, (uint32_t)(k / 3)), UP), sum = {0, 0, 0};
        for (uint32_t i = first[triangles[k]]; i < first[triangles[k] + 1]; i++) {
            Float3 other = facets_cross(solid, fan[i]);
            if (float3_dot(other, own) >= FACETS_CREASE * float3_length(other)) sum = float3_add(sum, other);
        }

        facets->normals[k] = float3_dot(sum, own) > 0 ? float3_unit_or(sum, own) : own;

        Float3 v = float3_load(solid->vertices + 3 * (size_t)triangles[k]);
        low = float3(minf(low.x, v.x), minf(low.y, v.y), minf(low.z, v.z));
        high = float3(maxf(high.x, v.x), maxf(high.y, v.y), maxf(high.z, v.z));
    }

    // how much the normals turn along the edges
    double turn = 0, area = 0;
    for (uint32_t t = 0; ok && t < solid->triangle_count; t++) {
        const Float3 *n = facets->normals + 3 * (size_t)t;
        const float twice = float3_length(facets_cross(solid, t));
        facets->bent[t] = 0;
        for (int k = 0; k < 3; k++) {
            const int next = (k + 1) % 3;
            const float edge = float3_length(float3_sub(facets_corner(solid, t, next), facets_corner(solid, t, k)));
            facets->bent[t] = maxf(facets->bent[t], float3_length(float3_sub(n[next], n[k])) / maxf(edge, 1e-6f));
        }
        turn += (double)facets->bent[t] * (double)twice;
        area += (double)twice;
    }
    facets->round = turn > 0 ? (float)(area / turn) : INFINITY;
    facets->bounds[0] = low;
    facets->bounds[1] = high;
    facets->centre = float3_scale(float3_add(low, high), 0.5f);
    facets->extent = 0.5f * float3_length(float3_sub(high, low));
    allocator_resize(allocator, first, first ? vertices * sizeof *first : 0, 0);
    allocator_resize(allocator, fan, fan ? corners * sizeof *fan : 0, 0);
    return ok ? SINGE_OK : preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a mesh");
}

SingeResult facets_get(Preview *preview, const PreviewSolid *solid, const Facets **found, SingeError *error) {
    Facets *facets = preview->facets;
    while (facets && facets->solid != solid) facets = facets->next;
    *found = facets;
    if (facets) return SINGE_OK;

    bool good = solid->vertices && solid->triangles && solid->triangle_count > 0;
    for (size_t k = 0; good && k < 3 * (size_t)solid->vertex_count; k++) good = fabsf(solid->vertices[k]) <= 1e4f;
    for (size_t k = 0; good && k < 3 * (size_t)solid->triangle_count; k++)
        good = solid->triangles[k] < solid->vertex_count;
    if (!good) return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "solid: a vertex or an index is out of range");

    facets = allocator_resize(preview->allocator, NULL, 0, sizeof *facets);
    if (!facets) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a mesh");
    *facets = (Facets){
        .solid = solid, .triangle_count = solid->triangle_count, .passing = solid->passing, .next = preview->facets};
    preview->facets = facets;
    SingeResult result = facets_normals(preview, facets, error);
    const BvhMesh mesh = {.positions = {solid->vertices, solid->vertices},
                          .stride = 3,
                          .triangles = (const uint32_t(*)[3])solid->triangles,
                          .triangle_count = solid->triangle_count};
    if (!result && !bvh_build(&facets->bvh, preview->allocator, &mesh))
        result = preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a mesh");
    if (result) facets->solid = NULL; // stays in the list until it is freed, but is not found
    else *found = facets;

    return result;
}

static void facets_free_one(Preview *preview, Facets *facets) {
    bvh_free(&facets->bvh, preview->allocator);
    size_t size = facets->normals ? 3 * (size_t)facets->triangle_count * sizeof *facets->normals : 0;
    allocator_resize(preview->allocator, facets->normals, size, 0);
    size = facets->bent ? facets->triangle_count * sizeof *facets->bent : 0;
    allocator_resize(preview->allocator, facets->bent, size, 0);
    allocator_resize(preview->allocator, facets, sizeof *facets, 0);
}

void facets_drop(Preview *preview) {
    Facets **link = &preview->facets;
    while (*link) {
        Facets *facets = *link;
        bool in_use = !facets->passing;
        for (uint32_t i = 0; i < preview->shape_count; i++) in_use = in_use || preview->shapes[i].facets == facets;
        if (in_use) {
            link = &facets->next;
        } else {
            *link = facets->next;
            facets_free_one(preview, facets);
        }
    }
}

void facets_free(Preview *preview) {
    while (preview->facets) {
        Facets *facets = preview->facets;
        preview->facets = facets->next;
        facets_free_one(preview, facets);
    }
}

float facets_intersect(const Facets *facets, Float3 o, Float3 d, float near, float far, Facing *facing) {
    // whether the ray, of unit direction, comes near enough
    const Float3 to = float3_sub(facets->centre, o);
    const float along = float3_dot(to, d), extent = 1.0001f * facets->extent;
    const Float3 aside = float3_mad(to, d, -along);
    if (!(float3_dot(aside, aside) <= extent * extent) || along < near - extent || along > far + extent) return -1;
    if (!bounds_near(facets->bounds, o, d, far, 1e-4f * facets->extent)) return -1;

    Rays rays;
    Hits hits;
    for (int i = 1; i < LANES; i++) rest_ray(&rays, i);
    aim_ray(&rays, 0, o, d, maxf(near, 0), far, 0);
    bvh_nearest(&facets->bvh, &rays, &hits);
    if (hits.triangle[0] == BVH_NONE) return -1;

    const Float3 *corner = facets->normals + 3 * (size_t)hits.triangle[0];
    float u = hits.u[0], v = hits.v[0];
    Float3 smooth = float3_mad(float3_mad(float3_scale(corner[0], 1 - u - v), corner[1], u), corner[2], v);
    Float3 flat = float3_unit_or(facets_cross(facets->solid, hits.triangle[0]), UP);

    // a smooth normal that faces away from the eye although the face does not would be flipped
    facing->normal = float3_dot(smooth, d) * float3_dot(flat, d) > 0 ? float3_unit_or(smooth, flat) : flat;
    facing->bent = facets->bent[hits.triangle[0]];
    return rays.far[0];
}

// Seams of the uv. A vertex where cells have different uv is drawn once for each, at the same position and with the
// same normal, so that textures are discontinuous there and the surface is not. A drawn vertex lies on one of a cell's
// four triangles at rest; with its barycentric weights w there, of the side's two corners and the virtual centre,
//
//   uv = w_a uv_a + w_b uv_b + w_c (uv_1 + uv_2 + uv_3 + uv_4)/4,   uv_i as this cell has them
//
// Only cells whose uv differ from those of their vertices (Shell.uv) are visited. If the input had several vertices on
// a seam, each copy keeps its own source vertex.
#include "common/assertion.h"
#include "surface/surface_parts.h"
#include "common/float3.h"
#include "common/real.h"

#include <string.h>

/// Tolerance of uv, over the cell's extent in uv; weights this close to 1 are a corner.
#define SEAM_SAME 1e-3f

typedef struct Seams {
    const Shell *shell;
    SingeSurface *surface;
    uint8_t *claimed; ///< [capacity] a triangle uses the vertex with its present uv
    uint32_t *next;   ///< [capacity] another copy of it, SHELL_NONE
    uint32_t capacity;
} Seams;

static bool is_seamed(const Shell *shell, uint32_t cell) {
    for (int i = 0; i < 4; i++)
        if (memcmp(shell->corner_uv[cell][i], shell->uv[shell->cells[cell][i]], 2 * sizeof(float)) != 0 ||
            shell->corner_source[cell][i] != shell->source_vertex[shell->cells[cell][i]])
            return true;
    return false;
}

static Float3 corner_rest(const Shell *shell, uint32_t cell, int i) {
    return float3_load(shell->rest_position[shell->cells[cell][i]]);
}

/// Barycentric weights of a point in the cell's triangle of that side.
static void weights_at(const Shell *shell, uint32_t cell, int side, Float3 point, float weight[3]) {
    Float3 c = {0, 0, 0};
    for (int i = 0; i < 4; i++) c = float3_add(c, corner_rest(shell, cell, i));
    c = float3_scale(c, 0.25f);

    Float3 a = float3_sub(corner_rest(shell, cell, side), c);
    Float3 b = float3_sub(corner_rest(shell, cell, (side + 1) & 3), c), p = float3_sub(point, c);
    float aa = float3_dot(a, a), ab = float3_dot(a, b), bb = float3_dot(b, b), pa = float3_dot(p, a),
          pb = float3_dot(p, b);
    float det = aa * bb - ab * ab;
    weight[0] = det > 0 ? (pa * bb - pb * ab) / det : 0;
    weight[1] = det > 0 ? (pb * aa - pa * ab) / det : 0;
    weight[2] = 1 - weight[0] - weight[1];
}

/// The copy of a vertex that has this uv and source vertex; created if there is none.
static uint32_t copy_with(Seams *seams, uint32_t vertex, const float uv[2], float same, int32_t source) {
    SingeSurface *surface = seams->surface;
    uint32_t last = vertex;

    if (!seams->claimed[vertex]) {
        seams->claimed[vertex] = 1;
        memcpy(surface->uv[vertex], uv, 2 * sizeof *uv);
        surface->source_vertex[vertex] = source;
        return vertex;
    }

    // a vertex that has this uv already
    for (uint32_t v = vertex; v != SHELL_NONE; last = v, v = seams->next[v])
        if (fabsf(surface->uv[v][0] - uv[0]) <= same && fabsf(surface->uv[v][1] - uv[1]) <= same &&
            surface->source_vertex[v] == source)
            return v;

    // a new copy
    uint32_t copy = surface->vertex_count++;
    surface_copy_vertex(surface, vertex, copy);
    memcpy(surface->uv[copy], uv, 2 * sizeof *uv);
    surface->source_vertex[copy] = source;
    seams->claimed[copy] = 1;
    seams->next[copy] = SHELL_NONE;
    seams->next[last] = copy;
    return copy;
}

static void part_cell(Seams *seams, uint32_t cell, uint32_t begin, uint32_t end) {
    const float(*uvs)[2] = (const float(*)[2])seams->shell->corner_uv[cell];
    float size = 0;
    for (int i = 1; i < 4; i++)
        size = float_max(size, float_max(fabsf(uvs[i][0] - uvs[0][0]), fabsf(uvs[i][1] - uvs[0][1])));
    const float same = SEAM_SAME * size;

    for (uint32_t t = begin; t < end; t++) {
        uint32_t *triangle = seams->surface->triangles[t], parted[3];

        // the side in whose triangle it lies: where the smallest weight of its centroid is largest
        Float3 centroid = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            centroid = float3_add(centroid, float3_load(seams->surface->rest_position[triangle[k]]));
        centroid = float3_scale(centroid, 1 / 3.0f);

        int side = 0;
        float max = -INFINITY;
        for (int s = 0; s < 4; s++) {
            float weight[3];
            weights_at(seams->shell, cell, s, centroid, weight);
            float min = float_min(weight[0], float_min(weight[1], weight[2]));
            if (min > max) {
                max = min;
                side = s;
            }
        }

        for (int k = 0; k < 3; k++) {
            float uv[2];
            int32_t source = seams->surface->source_vertex[triangle[k]];

            // uv there, and the source vertex of a corner that has one
            const float(*corner)[2] = (const float(*)[2])seams->shell->corner_uv[cell];
            const int next = (side + 1) & 3;
            float weight[3];
            weights_at(seams->shell, cell, side, float3_load(seams->surface->rest_position[triangle[k]]), weight);
            if (source >= 0) source = seams->shell->corner_source[cell][weight[0] > weight[1] ? side : next];

            for (int d = 0; d < 2; d++) {
                float centre = 0.25f * (corner[0][d] + corner[1][d] + corner[2][d] + corner[3][d]);
                float mixed = weight[0] * corner[side][d] + weight[1] * corner[next][d] + weight[2] * centre;
                uv[d] = weight[0] > 1 - SEAM_SAME   ? corner[side][d]
                        : weight[1] > 1 - SEAM_SAME ? corner[next][d]
                                                    : mixed;
            }

            parted[k] = copy_with(seams, triangle[k], uv, same, source);
        }

        memcpy(triangle, parted, sizeof parted);
    }
}

/// Claims the vertices of cells without a seam; returns the max number of copies.
static uint64_t claim(Seams *seams, const uint32_t *cell_first) {
    const Shell *shell = seams->shell;
    uint64_t copies = 0;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (is_seamed(shell, c)) {
            copies += 3 * (uint64_t)(cell_first[c + 1] - cell_first[c]);
            continue;
        }

        for (uint32_t t = cell_first[c]; t < cell_first[c + 1] && seams->claimed; t++)
            for (int k = 0; k < 3; k++) seams->claimed[seams->surface->triangles[t][k]] = 1;
    }

    return copies;
}

SingeResult surface_seams(const Shell *shell, const uint32_t *cell_first, SingeSurface *surface, SingeError *error) {
    Memory memory = memory_make(surface->allocator);
    Seams seams = {.shell = shell, .surface = surface};
    uint64_t max = surface->vertex_count + claim(&seams, cell_first);
    SingeResult result = surface_grow_vertices(surface, max, error);

    if (result) return result;

    seams.capacity = (uint32_t)max;
    if (NEW(&memory, seams.claimed, seams.capacity) && NEW(&memory, seams.next, seams.capacity)) {
        memset(seams.next, 0xff, seams.capacity * sizeof *seams.next);
        claim(&seams, cell_first);
        for (uint32_t c = 0; c < shell->cell_count; c++)
            if (is_seamed(shell, c)) part_cell(&seams, c, cell_first[c], cell_first[c + 1]);
        SINGE_ASSERT(surface->vertex_count <= seams.capacity);
    } else {
        surface_clear(surface);
        result = error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's seams");
    }

    FREE(&memory, seams.claimed, seams.capacity);
    FREE(&memory, seams.next, seams.capacity);
    return result;
}

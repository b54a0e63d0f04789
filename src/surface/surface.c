// Marching triangles (section 6, Fig 6). Every remaining cell is drawn as four triangles around its virtual centre; the
// level set m' cuts them:
//
//   corners inside   3          2                1              0
//   drawn            all of it  a quadrilateral  a triangle     nothing
//
// m' >= 0 is inside. Each triangle is clipped into a polygon of keys (AblatePlan), one key per vertex that neighbouring
// triangles share, so that they meet without cracks. The keys in use are then numbered in order: corners in the input's
// order, virtual centres, cuts. A cut at its inside end becomes that end; polygons with fewer than three corners are
// dropped. Cuts keep a distance from ends, and quadrilaterals are divided along the diagonal that gives the rounder
// triangles, so that no triangle is as thin as the rounding of its vertices.
#include "ablate/ablate_plan.h"
#include "common/float3.h"

#include <string.h>

typedef struct Polygon {
    int count;
    uint32_t keys[4];
} Polygon;

static void polygon_push(Polygon *polygon, uint32_t key) {
    if (polygon->count && polygon->keys[polygon->count - 1] == key) return;
    polygon->keys[polygon->count++] = key;
}

/// Triangle `side` of a cell, clipped: it walks along the cell's side, to the virtual centre and back.
static Polygon surface_clip(const AblatePlan *plan, const Shell *shell, uint32_t cell, int side) {
    const CellSprings *springs = &shell->cell_springs[cell];
    int next = (side + 1) & 3;
    uint32_t corner[3] = {shell->cells[cell][side], shell->cells[cell][next], shell_centre(shell, cell)};
    uint32_t edge[3] = {plan->keys.blue + springs->blue[side], plan->keys.red + springs->red[next],
                        plan->keys.red + springs->red[side]};
    const float level[3] = {plan->level[corner[0]], plan->level[corner[1]], plan->level[corner[2]]};
    const int first = surface_fan(level, SURFACE_NEAREST);
    Polygon polygon = {0};

    // corners inside and cuts, without repetitions
    for (int i = 0; i < 3; i++) {
        int a = (first + i) % 3, b = (a + 1) % 3;
        float level_a = level[a], level_b = level[b];
        if (level_a >= 0) {
            polygon_push(&polygon, corner[a]);
            if (level_b < 0)
                polygon_push(&polygon, surface_cut(level_a, level_b, SURFACE_NEAREST) > 0 ? edge[a] : corner[a]);
        } else if (level_b >= 0) {
            polygon_push(&polygon, surface_cut(level_b, level_a, SURFACE_NEAREST) > 0 ? edge[a] : corner[b]);
        }
    }
    if (polygon.count > 1 && polygon.keys[polygon.count - 1] == polygon.keys[0]) polygon.count--;
    return polygon;
}

/// Draws the cells with keys as vertices, and marks these keys in plan->output.
static void draw_cells(AblatePlan *plan, const Shell *shell, const State *state, uint32_t *cell_first,
                       SingeSurface *surface) {
    memset(plan->output, 0, plan->keys.count * sizeof *plan->output);
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (cell_first) cell_first[c + 1] = surface->triangle_count;
        if (!(state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;
        for (int side = 0; side < 4; side++) {
            Polygon polygon = surface_clip(plan, shell, c, side);
            for (int k = 2; k < polygon.count; k++) {
                uint32_t *triangle = surface->triangles[surface->triangle_count++];
                triangle[0] = polygon.keys[0], triangle[1] = polygon.keys[k - 1], triangle[2] = polygon.keys[k];
                for (int i = 0; i < 3; i++) plan->output[triangle[i]] = 1;
            }
        }
        if (cell_first) cell_first[c + 1] = surface->triangle_count;
    }
}

/// Max number of triangles: four per remaining cell, or eight where the level set may cross it.
static uint64_t max_triangles(const AblatePlan *plan, const Shell *shell, const State *state) {
    uint64_t max = 0;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (!(state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;
        const uint32_t *corners = shell->cells[c];
        bool whole = plan->level[shell_centre(shell, c)] >= 0;
        for (int i = 0; i < 4; i++) whole = whole && plan->level[corners[i]] >= 0;
        max += whole ? 4 : 8;
    }
    return max;
}

/// How many keys are marked.
static uint32_t count_vertices(AblatePlan *plan) {
    uint32_t count = 0;
    for (uint32_t key = 0; key < plan->keys.count; key++) count += plan->output[key];
    return count;
}

static void fill_vertices(AblatePlan *plan, const Shell *shell, const State *state, SingeSurface *surface) {
    for (uint32_t key = 0; key < plan->keys.count; key++) {
        if (!plan->output[key]) continue;
        plan->output[key] = surface->vertex_count++;
        surface_vertex(plan, shell, state, key, plan->output[key], surface);
    }
    for (uint32_t t = 0; t < surface->triangle_count; t++)
        for (int i = 0; i < 3; i++) surface->triangles[t][i] = plan->output[surface->triangles[t][i]];
}

/// The normalised sum of 2 A n over the triangles around each vertex; +z where they cancel.
void surface_normals(SingeSurface *surface) {
    memset(surface->normal, 0, surface->vertex_count * sizeof *surface->normal);
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *triangle = surface->triangles[t];
        Float3 corner = float3_load(surface->position[triangle[0]]);
        Float3 doubled = float3_cross(float3_sub(float3_load(surface->position[triangle[1]]), corner),
                                      float3_sub(float3_load(surface->position[triangle[2]]), corner));
        for (int i = 0; i < 3; i++) {
            float *normal = surface->normal[triangle[i]];
            float3_store(normal, float3_add(float3_load(normal), doubled));
        }
    }
    for (uint32_t v = 0; v < surface->vertex_count; v++) {
        Float3 normal = float3_unit(float3_load(surface->normal[v]));
        bool unit = float3_dot(normal, normal) > 0.5f;
        float3_store(surface->normal[v], unit ? normal : float3(0, 0, 1));
    }
}

static SingeResult surface_draw(AblatePlan *plan, const Shell *shell, const State *state, uint32_t *cell_first,
                                SingeSurface *surface, SingeError *error) {
    TRY(surface_reserve_triangles(surface, max_triangles(plan, shell, state), error));
    draw_cells(plan, shell, state, cell_first, surface);
    TRY(surface_reserve_vertices(surface, count_vertices(plan), error));
    fill_vertices(plan, shell, state, surface);
    if (surface->vertex_count) surface_normals(surface);
    return cell_first ? surface_seams(shell, cell_first, surface, error) : SINGE_OK;
}

SingeResult ablate_surface(AblatePlan *plan, const Shell *shell, const State *state, SingeSurface *surface,
                           SingeError *error) {
    ablate_levels(plan, shell, &state->burn);
    surface->vertex_count = surface->triangle_count = surface->fine_triangle_count = 0;
    if (!shell->corner_uv) return surface_draw(plan, shell, state, NULL, surface, error);
    Memory memory = memory_make(surface->allocator);
    uint32_t *cell_first;
    size_t cells = (size_t)shell->cell_count + 1;
    if (!NEW(&memory, cell_first, cells)) {
        surface_clear(surface);
        return error_set(error, SINGE_ERROR_MEMORY, "ablate", -1, "out of memory for the surface's seams");
    }
    SingeResult result = surface_draw(plan, shell, state, cell_first, surface, error);
    FREE(&memory, cell_first, cells);
    return result;
}

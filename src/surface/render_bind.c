// Finds the position of a sheet at rest that is nearest to each vertex of a render mesh, and what the vertex keeps from
// there. Cells lie in a grid by their centroids; its cubes have sides of the reach and the largest cell's radius. By uv it
// is the same in the plane of uv, where the reach is the largest cell's radius. In the same way it finds what is near a sheet where it is now, and leaves little room for a
// mesh.
#include "common/cube_grid.h"
#include "common/real.h"
#include "surface/render_parts.h"

typedef struct Binding {
    const Fine *fine;
    RenderMesh *mesh;
    bool by_uv;           ///< below, uv are in place of m
    bool now;             ///< cells are where they are drawn, not at rest
    float reach;          ///< m
    float (*centroid)[4]; ///< [cells] and the radius, m
    CubeGrid grid;        ///< of the cells, by their centroids
    uint32_t begin;
    float *distance; ///< [vertices of the mesh from `begin` on, or of the sheets] m, INFINITY where no cell is near
    uint32_t *near;  ///< [vertices of the sheets] the nearest cell, or SHELL_NONE
} Binding;

static Float3 corner_of(const Binding *binding, uint32_t cell, int i) {
    const Shell *shell = binding->fine->shell;
    if (binding->now) return float3_load(binding->fine->corner[shell->cells[cell][i]]);
    if (!binding->by_uv) return float3_load(shell->rest_position[shell->cells[cell][i]]);
    const float *uv = shell_corner_uv(shell, cell, i);
    return float3(uv[0], uv[1], 0);
}

/// Weights of the point of a triangle that is nearest to p (Ericson, Real-Time Collision Detection, 2005, 5.1.5);
/// returns the square of the distance.
static float nearest(Float3 p, const Float3 corner[3], float weight[3]) {
    const Float3 ab = float3_sub(corner[1], corner[0]), ac = float3_sub(corner[2], corner[0]);
    const Float3 ap = float3_sub(p, corner[0]), bp = float3_sub(p, corner[1]), cp = float3_sub(p, corner[2]);
    const float d1 = float3_dot(ab, ap), d2 = float3_dot(ac, ap), d3 = float3_dot(ab, bp), d4 = float3_dot(ac, bp);
    const float d5 = float3_dot(ab, cp), d6 = float3_dot(ac, cp);
    const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    float v, w;
    if (d1 <= 0 && d2 <= 0) {
        v = 0;
        w = 0;
    } else if (d3 >= 0 && d4 <= d3) {
        v = 1;
        w = 0;
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        v = d1 / (d1 - d3);
        w = 0;
    } else if (d6 >= 0 && d5 <= d6) {
        v = 0;
        w = 1;
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        v = 0;
        w = d2 / (d2 - d6);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1 - w;
    } else {
        const float sum = va + vb + vc;
        v = sum > 0 ? vb / sum : 0;
        w = sum > 0 ? vc / sum : 0;
    }

    weight[0] = 1 - v - w;
    weight[1] = v;
    weight[2] = w;
    const Float3 from = float3_sub(p, float3_mad(float3_mad(corner[0], ab, v), ac, w));
    return float3_dot(from, from);
}

/// The nearest position of the sheet, among the cells within a cube of p's; its distance.
static float find_foot(const Binding *binding, Float3 p, FineLocation *foot) {
    uint32_t first[27];
    cube_grid_around(&binding->grid, p, first);

    float min = INFINITY;
    for (int k = 0; k < 27; k++) {
        for (uint32_t cell = first[k]; cell != CUBE_GRID_END; cell = binding->grid.next[cell]) {
            const Float3 centroid = float3_load(binding->centroid[cell]);
            if (float3_length(float3_sub(p, centroid)) - binding->centroid[cell][3] > sqrtf(min)) continue;

            for (uint8_t side = 0; side < 4; side++) {
                const Float3 corner[3] = {corner_of(binding, cell, side), corner_of(binding, cell, (side + 1) & 3),
                                          centroid};
                FineLocation there = {.cell = cell, .side = side};
                const float square = nearest(p, corner, there.weight);
                if (!(square < min)) continue;
                min = square;
                *foot = there;
            }
        }
    }

    return sqrtf(min);
}

static void find_range(void *context, int begin, int end) {
    const Binding *binding = context;
    for (int k = begin; k < end; k++) {
        RenderVertex *vertex = &binding->mesh->vertices[binding->begin + (uint32_t)k];
        const Float3 at = binding->by_uv ? float3(vertex->uv[0], vertex->uv[1], 0) : float3_load(vertex->offset);
        binding->distance[k] = find_foot(binding, at, &vertex->foot);
    }
}

static void bind_range(void *context, int begin, int end) {
    const Binding *binding = context;
    const Fine *fine = binding->fine;
    for (int v = begin; v < end; v++) {
        RenderVertex *vertex = &binding->mesh->vertices[v];
        float position[3], normal[3];
        const FinePatch patch = fine_patch(fine, vertex->foot.cell);
        fine_position_at(fine, &patch, &vertex->foot, position, normal);
        if (binding->by_uv) { // on the surface
            memcpy(vertex->rest, position, sizeof position);
            memcpy(vertex->normal, normal, sizeof normal);
        }

        const FineFrame frame = fine_frame(fine, vertex->foot.cell, float3_load(normal));
        const Float3 from = float3_sub(float3_load(vertex->rest), float3_load(position));
        const Float3 turned = float3_load(vertex->normal);
        for (int k = 0; k < 3; k++) {
            vertex->offset[k] = float3_dot(from, frame.axis[k]);
            vertex->normal[k] = float3_dot(turned, frame.axis[k]);
        }

        const float height = vertex->offset[2];
        vertex->slack = float_max(1, 2 * fabsf(height) / render_bend_room(fine, &vertex->foot, height));
    }
}

void render_bind(const Fine *fine, bool by_uv, RenderMesh *mesh) {
    Binding binding = {.fine = fine, .mesh = mesh, .by_uv = by_uv};
    pool_for(fine->pool, (int)mesh->vertex_count, 64, bind_range, &binding);
}

/// Puts the cells into the grid.
static void fill_grid(Binding *binding) {
    const Shell *shell = binding->fine->shell;
    const uint8_t *flags = binding->now ? binding->fine->state->ablate.cell_flags : NULL;
    float radius = 0;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (flags && !(flags[c] & SINGE_ALIVE)) continue;

        Float3 centroid = {0, 0, 0};
        for (int i = 0; i < 4; i++) centroid = float3_add(centroid, corner_of(binding, c, i));
        centroid = float3_scale(centroid, 0.25f);
        float3_store(binding->centroid[c], centroid);

        for (int i = 0; i < 4; i++) {
            const Float3 from = float3_sub(corner_of(binding, c, i), centroid);
            binding->centroid[c][3] = float_max(binding->centroid[c][3], float3_length(from));
        }
        radius = float_max(radius, binding->centroid[c][3]);
    }

    if (binding->by_uv) binding->reach = radius;
    cube_grid_clear(&binding->grid, float_max(binding->reach + radius, 1e-5f));
    for (uint32_t c = 0; c < shell->cell_count; c++)
        if (!flags || flags[c] & SINGE_ALIVE) cube_grid_add(&binding->grid, c, binding->centroid[c]);
}

SingeResult render_find_feet(const Fine *fine, bool by_uv, float reach, uint32_t first, RenderMesh *mesh,
                             SingeError *error) {
    Memory *memory = fine->memory;
    const uint32_t cells = fine->shell->cell_count, count = mesh->vertex_count - first;
    Binding binding = {.fine = fine, .mesh = mesh, .by_uv = by_uv, .reach = reach, .begin = first};
    SingeResult result = SINGE_OK;
    if (NEW(memory, binding.centroid, cells) && cube_grid_create(memory, cells, &binding.grid) &&
        NEW(memory, binding.distance, count)) {
        fill_grid(&binding);
        pool_for(fine->pool, (int)count, 64, find_range, &binding);

        uint32_t far = 0, worst = 0;
        for (uint32_t k = 0; k < count; k++) {
            far += !(binding.distance[k] <= binding.reach);
            if (binding.distance[k] > binding.distance[worst]) worst = k;
        }

        if (far && by_uv && first)
            result = error_set(error, SINGE_ERROR_MESH, "render mesh", -1,
                               "the middle of an edge has a uv that the sheet lacks");
        else if (far && by_uv)
            result =
                error_set(error, SINGE_ERROR_MESH, "render mesh", worst,
                          "%u of %u vertices have a uv that the sheet lacks, such as vertex %u", far, count, worst);
        else if (far && first)
            result = error_set(error, SINGE_ERROR_MESH, "render mesh", -1,
                               "the middle of an edge is farther from the sheet than its reach, %g m", (double)reach);
        else if (far && binding.distance[worst] < INFINITY)
            result =
                error_set(error, SINGE_ERROR_MESH, "render mesh", worst,
                          "%u of %u vertices are farther from the sheet than its reach, %g m; vertex %u is %g m away",
                          far, count, (double)reach, worst, (double)binding.distance[worst]);
        else if (far)
            result = error_set(error, SINGE_ERROR_MESH, "render mesh", worst,
                               "%u of %u vertices are farther from the sheet than its reach, %g m, such as vertex %u",
                               far, count, (double)reach, worst);
    } else {
        result = error_set(error, SINGE_ERROR_MEMORY, "render mesh", -1, "out of memory for the render mesh");
    }

    FREE(memory, binding.centroid, cells);
    cube_grid_free(memory, &binding.grid);
    FREE(memory, binding.distance, count);
    return result;
}

// ---- room

/// Positions of a sheet that were this many times as far from each other at rest are of a fold, as half a turn is (pi/2);
/// nearer ones are bent (render_bends).
#define FOLDED 1.5f

/// The distance of a vertex from another sheet, or from a part of its own that has been folded over it.
static void room_range(void *context, int begin, int end) {
    const Binding *binding = context;
    const Shell *shell = binding->fine->shell;
    const uint16_t *sheet = shell->matter.sheet;
    for (int v = begin; v < end; v++) {
        const Float3 p = float3_load(binding->fine->corner[v]), rest = float3_load(shell->rest_position[v]);
        uint32_t first[27];
        cube_grid_around(&binding->grid, p, first);

        float min = binding->reach * binding->reach;
        for (int k = 0; k < 27; k++) {
            for (uint32_t cell = first[k]; cell != CUBE_GRID_END; cell = binding->grid.next[cell]) {
                const uint32_t centre = shell_centre(shell, cell);
                const Float3 centroid = float3_load(binding->centroid[cell]);
                if (float3_length(float3_sub(p, centroid)) - binding->centroid[cell][3] > sqrtf(min)) continue;

                for (int side = 0; side < 4; side++) {
                    const Float3 corner[3] = {corner_of(binding, cell, side), corner_of(binding, cell, (side + 1) & 3),
                                              centroid};
                    FineLocation there = {.cell = cell, .side = (uint8_t)side};
                    const float square = nearest(p, corner, there.weight);
                    if (!(square < min)) continue;

                    const Float3 from = float3_sub(rest, fine_blend(shell->cells[cell], &there, shell->rest_position));
                    const float before = float3_dot(from, from), radius = binding->centroid[cell][3];
                    const bool bent = before < FOLDED * FOLDED * square || before < radius * radius; // or beside it
                    if (sheet[centre] == sheet[v] && bent) continue;
                    min = square;
                    binding->near[v] = cell;
                }
            }
        }
        binding->distance[v] = sqrtf(min);
    }
}

SingeResult render_rooms(Fine *fine, float reach, SingeError *error) {
    Memory *memory = fine->memory;
    const Shell *shell = fine->shell;
    const uint32_t cells = shell->cell_count, count = shell->vertex_count;
    Binding binding = {.fine = fine, .now = true, .reach = reach};
    const bool ok = NEW(memory, binding.centroid, cells) && cube_grid_create(memory, cells, &binding.grid) &&
                    NEW(memory, binding.distance, count) && NEW(memory, binding.near, count);
    if (ok) {
        fill_grid(&binding);
        for (uint32_t v = 0; v < count; v++) binding.near[v] = SHELL_NONE;
        pool_for(fine->pool, (int)count, 64, room_range, &binding);

        // for both of the two that are near
        for (uint32_t v = 0; v < count; v++) fine->mesh_room[v] = fine->room ? fine->room[v] : INFINITY;
        for (uint32_t v = 0; v < count; v++) {
            if (binding.near[v] == SHELL_NONE) continue;
            const uint32_t *at = shell->cells[binding.near[v]];
            fine->mesh_room[v] = float_min(fine->mesh_room[v], binding.distance[v]);
            for (int i = 0; i < 4; i++) fine->mesh_room[at[i]] = float_min(fine->mesh_room[at[i]], binding.distance[v]);
        }
    }

    FREE(memory, binding.centroid, cells);
    cube_grid_free(memory, &binding.grid);
    FREE(memory, binding.distance, count);
    FREE(memory, binding.near, count);
    return ok ? SINGE_OK : error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the render mesh");
}

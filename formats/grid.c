#include "mesh.h"
#include "support.h"

#include <math.h>
#include <string.h>

static void grid_fill(Mesh *mesh, double size_x, double size_y, uint32_t cells_x, uint32_t cells_y) {
    float *position = mesh->positions, *uv = mesh->uv;
    uint32_t *cell = mesh->cells, row = cells_x + 1;
    for (uint32_t j = 0; j <= cells_y; j++)
        for (uint32_t i = 0; i <= cells_x; i++, position += 3, uv += 2) {
            double u = (double)i / cells_x, v = (double)j / cells_y;
            position[0] = (float)(size_x * (u - 0.5));
            position[1] = (float)(size_y * (v - 0.5));
            position[2] = 0;
            uv[0] = (float)u, uv[1] = (float)v;
        }
    for (uint32_t j = 0; j < cells_y; j++)
        for (uint32_t i = 0; i < cells_x; i++, cell += 4) {
            uint32_t first = j * row + i;
            cell[0] = first, cell[1] = first + 1, cell[2] = first + row + 1, cell[3] = first + row;
        }
}

SingeResult mesh_grid(float size_x, float size_y, uint32_t cells_x, uint32_t cells_y, SingeAllocator allocator,
                      Mesh *mesh, SingeError *error) {
    memset(mesh, 0, sizeof *mesh);
    if (!(size_x > 0 && size_y > 0) || !isfinite(size_x) || !isfinite(size_y))
        return refuse(error, SINGE_ERROR_ARGUMENT, "grid", -1, "grid: both sizes must be positive and finite");
    if (cells_x < 1 || cells_y < 1)
        return refuse(error, SINGE_ERROR_ARGUMENT, "grid", -1, "grid: needs at least one cell each way");
    uint64_t vertices = ((uint64_t)cells_x + 1) * ((uint64_t)cells_y + 1);
    if (cells_x > MESH_COUNT_LIMIT || cells_y > MESH_COUNT_LIMIT || vertices > MESH_COUNT_LIMIT)
        return refuse(error, SINGE_ERROR_LIMIT, "grid", -1, "grid: %u by %u cells are too many", cells_x, cells_y);
    mesh->allocator = allocator;
    mesh->vertex_count = (uint32_t)vertices;
    mesh->cell_count = cells_x * cells_y;
    mesh->positions = store_new(allocator, mesh->vertex_count, 3 * sizeof *mesh->positions);
    mesh->uv = store_new(allocator, mesh->vertex_count, 2 * sizeof *mesh->uv);
    mesh->cells = store_new(allocator, mesh->cell_count, 4 * sizeof *mesh->cells);
    if (!mesh->positions || !mesh->uv || !mesh->cells) {
        mesh_free(mesh);
        return refuse_memory(error, "grid", "grid");
    }
    grid_fill(mesh, size_x, size_y, cells_x, cells_y);
    return SINGE_OK;
}

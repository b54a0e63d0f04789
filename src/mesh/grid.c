// Rectangles of quads, and their imperfections.
//
// Noise is a sum of plane waves whose directions are spread evenly over the half circle, so that it favours neither
// the grid's lines nor any other:
//
//     n(p) = sqrt(2/N) sum over k of cos(p . d_k f_k + phase_k),   f_k = 2 pi / wavelength, stretched by 0.7 to 1.4
//
// with mean 0 and mean square 1.

#include "mesh/polygons.h"
#include "common/real.h"
#include "common/store.h"
#include "mesh/to_quads.h"

#include <math.h>
#include <string.h>

enum { WAVES = 12 };

/// A hash of two numbers in [0, 1).
static double grid_random(uint32_t seed, uint32_t index) {
    uint32_t h = seed * 0x9E3779B9u + index * 0x85EBCA6Bu + 0x165667B1u;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return (double)(h ^ (h >> 15)) / 4294967296.0;
}

static double grid_noise(double x, double y, double wavelength, uint32_t seed) {
    const double pi = 3.14159265358979323846;
    double sum = 0;
    for (uint32_t k = 0; k < WAVES; k++) {
        double angle = pi * ((double)k + grid_random(seed, 3 * k)) / WAVES;
        double f = 2 * pi / wavelength * real_exp2(grid_random(seed, 3 * k + 1) - 0.5);
        sum += real_cos(f * (real_cos(angle) * x + real_sin(angle) * y) + 2 * pi * grid_random(seed, 3 * k + 2));
    }
    return sum * sqrt(2.0 / WAVES);
}

void mesh_grid_wear(Mesh *mesh, uint32_t cells_x, uint32_t cells_y, const GridWear *wear) {
    if (!(wear->jitter > 0) && !(wear->displacement > 0)) return;

    const double jitter_wavelength = 3.7; // cells: neighbours move nearly alike, so cells stay convex
    uint32_t row = cells_x + 1, last = mesh->vertex_count - 1;
    double size_x = (double)mesh->positions[3 * last] * 2, size_y = (double)mesh->positions[3 * last + 1] * 2;
    double wavelength = 0.45 * double_min(size_x, size_y);

    // along the longer sides of slim cells at most twice their width: more would shear them into needles many cells long
    double slim = size_x * cells_y / (size_y * cells_x);
    double jitter_x = (double)wear->jitter * double_min(1, 2 / slim),
           jitter_y = (double)wear->jitter * double_min(1, 2 * slim);

    for (uint32_t v = 0; v <= last; v++) {
        uint32_t i = v % row, j = v / row;

        // border vertices move only along the border
        bool free_x = i > 0 && i<cells_x, free_y = j> 0 && j < cells_y;
        double dx =
            free_x ? double_max(-1, double_min(1, 0.5 * grid_noise(i, j, jitter_wavelength, 2 * wear->seed))) : 0;
        double dy =
            free_y ? double_max(-1, double_min(1, 0.5 * grid_noise(i, j, jitter_wavelength, 2 * wear->seed + 1))) : 0;
        double x = (i + jitter_x * dx) / cells_x, y = (j + jitter_y * dy) / cells_y;
        float *position = mesh->positions + 3 * (size_t)v, *uv = mesh->uv + 2 * (size_t)v;
        uv[0] = (float)x;
        uv[1] = (float)y;

        position[0] = (float)((x - 0.5) * size_x);
        position[1] = (float)((y - 0.5) * size_y);

        double height = grid_noise((double)position[0], (double)position[1], wavelength, ~wear->seed);
        position[2] = (float)((double)wear->displacement * height);
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

    float *position = mesh->positions, *uv = mesh->uv;
    for (uint32_t j = 0; j <= cells_y; j++)
        for (uint32_t i = 0; i <= cells_x; i++, position += 3, uv += 2) {
            double u = (double)i / cells_x, v = (double)j / cells_y;
            position[0] = (float)((double)size_x * (u - 0.5));
            position[1] = (float)((double)size_y * (v - 0.5));
            position[2] = 0;
            uv[0] = (float)u;
            uv[1] = (float)v;
        }

    uint32_t *cell = mesh->cells, row = cells_x + 1;
    for (uint32_t j = 0; j < cells_y; j++)
        for (uint32_t i = 0; i < cells_x; i++, cell += 4) {
            uint32_t first = j * row + i;
            cell[0] = first;
            cell[1] = first + 1;
            cell[2] = first + row + 1;
            cell[3] = first + row;
        }

    return SINGE_OK;
}

#include "analysis/turned_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/store.h"

/// Min depth of a cell's centroid within the outline, in cells: with less, the cell would be a sliver.
static const double inside_min = 0.25;

/// m, depth of a point within the outline; negative outside.
static double turned_grid_inside(const TurnedGrid *cut, const double p[2]) {
    if (cut->disc) return cut->size / 2 - hypot(p[0], p[1]);
    const double across = cut->across > 0 ? cut->across : cut->size;
    return fmin(cut->size / 2 - fabs(p[0]), across / 2 - fabs(p[1]));
}

SingeResult turned_grid(const TurnedGrid *cut, Mesh *mesh, SingeError *error) {
    // a square rotated by 45 degrees is sqrt 2 times as wide; equal extra cells on both sides keep the lines in place
    const uint32_t wide = (uint32_t)cut->cells + 2 * (uint32_t)ceil(0.21 * cut->cells + 1);
    const float size = (float)(cut->size * wide / cut->cells);
    TRY(mesh_grid(size, size, wide, wide, (SingeAllocator){0}, mesh, error));
    mesh_grid_wear(mesh, wide, wide, &cut->wear);

    const double c = cos(cut->angle), s = sin(cut->angle), half = cut->size / 2;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *position = mesh->positions + 3 * (size_t)v;
        const double x = (double)position[0], y = (double)position[1];
        position[0] = (float)(c * x - s * y);
        position[1] = (float)(s * x + c * y);
    }

    // keeps the cells within the outline, and their vertices
    uint32_t *number = calloc(mesh->vertex_count, sizeof *number), cells = 0, vertices = 0;
    if (!number) {
        mesh_free(mesh);
        return refuse(error, SINGE_ERROR_MEMORY, "", -1, "out of memory");
    }

    for (uint32_t q = 0; q < mesh->cell_count; q++) {
        const uint32_t *corner = mesh->cells + 4 * (size_t)q;
        double centroid[2] = {0, 0};
        for (int i = 0; i < 4; i++)
            for (size_t k = 0; k < 2; k++) centroid[k] += 0.25 * (double)mesh->positions[3 * (size_t)corner[i] + k];
        if (!(turned_grid_inside(cut, centroid) > inside_min * cut->size / cut->cells)) continue;
        for (int i = 0; i < 4; i++) number[corner[i]] = 1;
        memmove(mesh->cells + 4 * (size_t)cells++, corner, 4 * sizeof *corner);
    }

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (!number[v]) continue;
        memmove(mesh->positions + 3 * (size_t)vertices, mesh->positions + 3 * (size_t)v, 3 * sizeof(float));
        number[v] = vertices++;
    }

    for (size_t i = 0; i < 4 * (size_t)cells; i++) mesh->cells[i] = number[mesh->cells[i]];
    mesh->cell_count = cells;
    mesh->vertex_count = vertices;
    free(number);

    // vertices beyond the outline move onto it
    for (uint32_t v = 0; v < vertices; v++) {
        float *position = mesh->positions + 3 * (size_t)v, *uv = mesh->uv + 2 * (size_t)v;
        double p[2] = {(double)position[0], (double)position[1]};
        const double from_centre = hypot(p[0], p[1]);
        const bool beyond = turned_grid_inside(cut, p) < 0;
        const double sides[2] = {half, cut->across > 0 ? cut->across / 2 : half};
        for (int k = 0; k < 2; k++) {
            if (beyond) p[k] = cut->disc ? p[k] * half / from_centre : fmax(-sides[k], fmin(sides[k], p[k]));
            position[k] = (float)p[k];
            uv[k] = (float)(p[k] / cut->size + 0.5);
        }
    }

    return SINGE_OK;
}

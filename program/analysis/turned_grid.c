#include "analysis/turned_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Min depth of a cell's centroid within the outline, in cells: with less, the cell would be a sliver.
static const double inside_min = 0.25;

/// m, depth of a point within the outline; negative outside.
static double turned_grid_inside(const TurnedGrid *cut, const double p[2]) {
    double from_centre = cut->disc ? hypot(p[0], p[1]) : fmax(fabs(p[0]), fabs(p[1]));
    return cut->size / 2 - from_centre;
}

static void move_onto_outline(const TurnedGrid *cut, double p[2]) {
    const double half = cut->size / 2, from_centre = hypot(p[0], p[1]);
    if (turned_grid_inside(cut, p) >= 0) return;
    for (int k = 0; k < 2; k++) p[k] = cut->disc ? p[k] * half / from_centre : fmax(-half, fmin(half, p[k]));
}

static void turn_vertices(const TurnedGrid *cut, Mesh *mesh) {
    const double c = cos(cut->angle), s = sin(cut->angle);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *position = mesh->positions + 3 * (size_t)v;
        const double x = (double)position[0], y = (double)position[1];
        position[0] = (float)(c * x - s * y), position[1] = (float)(s * x + c * y);
    }
}

static bool is_kept(const TurnedGrid *cut, const Mesh *mesh, const uint32_t *corner) {
    double centroid[2] = {0, 0};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++) centroid[k] += 0.25 * (double)mesh->positions[3 * (size_t)corner[i] + (size_t)k];
    return turned_grid_inside(cut, centroid) > inside_min * cut->size / cut->cells;
}

/// Keeps the cells within, and their vertices; `number` has an entry for each vertex, all 0.
static void keep_inside(const TurnedGrid *cut, Mesh *mesh, uint32_t *number) {
    uint32_t cells = 0, vertices = 0;
    for (uint32_t c = 0; c < mesh->cell_count; c++) {
        const uint32_t *corner = mesh->cells + 4 * (size_t)c;
        if (!is_kept(cut, mesh, corner)) continue;
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
}

static void lay_to_outline(const TurnedGrid *cut, Mesh *mesh) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *position = mesh->positions + 3 * (size_t)v, *uv = mesh->uv + 2 * (size_t)v;
        double p[2] = {(double)position[0], (double)position[1]};
        move_onto_outline(cut, p);
        for (int k = 0; k < 2; k++) position[k] = (float)p[k], uv[k] = (float)(p[k] / cut->size + 0.5);
    }
}

SingeResult turned_grid(const TurnedGrid *cut, Mesh *mesh, SingeError *error) {
    // a square rotated by 45 degrees is sqrt 2 times as wide; equal extra cells on both sides keep the lines in place
    const uint32_t wide = (uint32_t)cut->cells + 2 * (uint32_t)ceil(0.21 * cut->cells + 1);
    const float size = (float)(cut->size * wide / cut->cells);
    SingeResult result = mesh_grid(size, size, wide, wide, (SingeAllocator){0}, mesh, error);
    if (result) return result;
    mesh_grid_wear(mesh, wide, wide, &cut->wear);
    turn_vertices(cut, mesh);
    uint32_t *number = calloc(mesh->vertex_count, sizeof *number);
    if (!number) {
        mesh_free(mesh);
        *error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1};
        return SINGE_ERROR_MEMORY;
    }
    keep_inside(cut, mesh, number);
    free(number);
    lay_to_outline(cut, mesh);
    return SINGE_OK;
}

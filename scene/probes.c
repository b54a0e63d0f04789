// The nearest place of a sheet to a probe's, in space or in uv. A cell is four triangles around the mean of its
// corners, as it is drawn where it is flat.
#include "scene/probes.h"

#include <math.h>
#include <string.h>

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The share of the way from a to b at which p is nearest.
static double along(const double p[3], const double a[3], const double b[3]) {
    double side[3], to[3];
    for (int k = 0; k < 3; k++) side[k] = b[k] - a[k], to[k] = p[k] - a[k];
    const double length = dot(side, side);
    return length > 0 ? fmin(fmax(dot(to, side) / length, 0), 1) : 0;
}

static double distance2(const double p[3], const double corner[3][3], const double weight[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d = weight[0] * corner[0][k] + weight[1] * corner[1][k] + weight[2] * corner[2][k] - p[k];
        sum += d * d;
    }
    return sum;
}

/// Weights of p's foot in the plane of a triangle. False where it lies outside, or the triangle has no area.
static bool foot_inside(const double p[3], const double corner[3][3], double weight[3]) {
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++)
        u[k] = corner[1][k] - corner[0][k], v[k] = corner[2][k] - corner[0][k], w[k] = p[k] - corner[0][k];
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
    const double area = uu * vv - uv * uv;
    if (!(area > 1e-12 * uu * vv)) return false;
    weight[1] = (vv * wu - uv * wv) / area, weight[2] = (uu * wv - uv * wu) / area;
    weight[0] = 1 - weight[1] - weight[2];
    return weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0;
}

/// Square of the distance from p to a triangle, and the weights of its corners at the nearest point.
static double nearest_in_triangle(const double p[3], const double corner[3][3], double weight[3]) {
    if (foot_inside(p, corner, weight)) return distance2(p, corner, weight);
    double best = INFINITY;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const double t = along(p, corner[i], corner[j]);
        double side[3] = {0};
        side[i] = 1 - t, side[j] = t;
        const double gap = distance2(p, corner, side);
        if (gap < best) best = gap, memcpy(weight, side, sizeof side);
    }
    return best;
}

/// Square of the distance from p to a cell, and the weights of the cell's corners.
static double nearest_in_cell(const double p[3], const double corners[4][3], double weight[4]) {
    double centre[3], best = INFINITY;
    for (int k = 0; k < 3; k++) centre[k] = (corners[0][k] + corners[1][k] + corners[2][k] + corners[3][k]) / 4;
    for (int i = 0; i < 4; i++) {
        const int j = (i + 1) & 3;
        double triangle[3][3], share[3] = {0};
        memcpy(triangle[0], centre, sizeof centre);
        memcpy(triangle[1], corners[i], sizeof centre), memcpy(triangle[2], corners[j], sizeof centre);
        const double gap = nearest_in_triangle(p, (const double(*)[3])triangle, share);
        if (!(gap < best)) continue;
        best = gap;
        for (int k = 0; k < 4; k++) weight[k] = share[0] / 4;
        weight[i] += share[1], weight[j] += share[2];
    }
    return best;
}

/// A cell's corners in space, or in uv.
static void cell_corners(const Mesh *mesh, uint32_t cell, bool in_uv, double corners[4][3]) {
    for (int i = 0; i < 4; i++) {
        const size_t vertex = mesh->cells[4 * (size_t)cell + (size_t)i];
        const float *uv = mesh->corner_uv ? mesh->corner_uv + 8 * (size_t)cell + 2 * (size_t)i
                          : in_uv         ? mesh->uv + 2 * vertex
                                          : NULL;
        const float *from = in_uv ? uv : mesh->positions + 3 * vertex;
        for (int k = 0; k < 3; k++) corners[i][k] = in_uv && k == 2 ? 0 : (double)from[k];
    }
}

static SceneProbePlace find_place(const Mesh *mesh, const SceneProbe *probe) {
    const bool in_uv = probe->kind == SCENE_PROBE_UV;
    const float *at = in_uv ? probe->uv : probe->point;
    const double p[3] = {(double)at[0], (double)at[1], in_uv ? 0 : (double)at[2]};
    SceneProbePlace place = {.distance = INFINITY};
    double best = INFINITY;
    for (uint32_t c = 0; c < mesh->cell_count && best > 0; c++) {
        double corners[4][3], weight[4];
        cell_corners(mesh, c, in_uv, corners);
        const double gap = nearest_in_cell(p, (const double(*)[3])corners, weight);
        if (!(gap < best)) continue;
        best = gap, place.cell = c;
        memcpy(place.weight, weight, sizeof weight);
    }
    place.distance = sqrt(best);
    return place;
}

void probes_find(const Scene *scene, SceneAssets *assets, SceneMessages *messages) {
    for (uint32_t i = 0; i < scene->probe_count; i++) {
        const SceneProbe *probe = &scene->probes[i];
        const Mesh *mesh = &assets->meshes[probe->sheet_index];
        if (probe->kind == SCENE_PROBE_UV && !mesh->uv && !mesh->corner_uv) {
            message_add(messages, scene->text, probe->location, "the probe's place is in uv, but the mesh has none");
            continue;
        }
        assets->probes[i] = find_place(mesh, probe);
        for (uint32_t s = 0; s < probe->sheet_index; s++) assets->probes[i].cell += assets->meshes[s].cell_count;
    }
}

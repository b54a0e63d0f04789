// Finds the point of a sheet nearest to a probe, in space or in uv. A cell is four triangles around the mean of its
// corners, as drawn if it is flat.
#include "scene/assets.h"

#include "scene/space.h"

#include <math.h>
#include <string.h>

/// Squared distance from p to a cell, and the weights of the cell's corners.
static double nearest_in_cell(const double p[3], const double corners[4][3], double weight[4]) {
    double centre[3], best = INFINITY;
    for (int k = 0; k < 3; k++) centre[k] = (corners[0][k] + corners[1][k] + corners[2][k] + corners[3][k]) / 4;

    for (int i = 0; i < 4; i++) {
        const int j = (i + 1) & 3;
        double triangle[3][3], share[3] = {0};
        memcpy(triangle[0], centre, sizeof centre);
        memcpy(triangle[1], corners[i], sizeof centre);
        memcpy(triangle[2], corners[j], sizeof centre);

        const double gap = closest_on_triangle(p, (const double(*)[3])triangle, share);
        if (!(gap < best)) continue;
        best = gap;
        for (int k = 0; k < 4; k++) weight[k] = share[0] / 4;
        weight[i] += share[1];
        weight[j] += share[2];
    }

    return best;
}

void probes_find(const Scene *scene, SceneAssets *assets, SceneMessages *messages) {
    for (uint32_t i = 0; i < scene->probe_count; i++) {
        const SceneProbe *probe = &scene->probes[i];
        const Mesh *mesh = &assets->meshes[probe->sheet_index];
        const bool in_uv = probe->kind == SCENE_PROBE_UV;
        if (in_uv && !mesh->uv && !mesh->corner_uv) {
            message_add(messages, scene->text, probe->location, "the probe is given in uv, but the mesh has none");
            continue;
        }

        const float *at = in_uv ? probe->uv : probe->point;
        const double p[3] = {(double)at[0], (double)at[1], in_uv ? 0 : (double)at[2]};
        SceneProbePoint found = {.distance = INFINITY};
        double best = INFINITY;
        for (uint32_t c = 0; c < mesh->cell_count && best > 0; c++) {
            double corners[4][3], weight[4]; // in space, or in uv
            for (size_t k = 0; k < 4; k++) {
                const size_t corner = 4 * (size_t)c + k, vertex = mesh->cells[corner];
                const float *uv = mesh->corner_uv ? mesh->corner_uv + 2 * corner : in_uv ? mesh->uv + 2 * vertex : NULL;
                const float *from = in_uv ? uv : mesh->positions + 3 * vertex;
                for (int x = 0; x < 3; x++) corners[k][x] = in_uv && x == 2 ? 0 : (double)from[x];
            }

            const double gap = nearest_in_cell(p, (const double(*)[3])corners, weight);
            if (!(gap < best)) continue;
            best = gap;
            found.cell = c;
            memcpy(found.weight, weight, sizeof weight);
        }

        found.distance = sqrt(best);
        for (uint32_t s = 0; s < probe->sheet_index; s++) found.cell += assets->meshes[s].cell_count;
        assets->probes[i] = found;
    }
}

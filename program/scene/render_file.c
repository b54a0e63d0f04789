// Meshes that are drawn in place of sheets: a file's polygons become triangles, each corner's uv one of a vertex.
#include "common/store.h"
#include "scene/assets.h"

#include <stdlib.h>
#include <string.h>

void render_file_free(RenderFile *file) {
    free(file->positions);
    free(file->uv);
    free(file->triangles);
    *file = (RenderFile){0};
}

/// The vertex with a corner's position and uv; vertices of one position are in a list by `next`.
static uint32_t vertex_of(const Polygons *polygons, uint32_t corner, RenderFile *file, uint32_t *first,
                          uint32_t *next) {
    const uint32_t at = polygons->corners[corner];
    const float *uv = polygons->uv ? polygons->uv + 2 * (size_t)corner : NULL;
    for (uint32_t v = first[at]; v != UINT32_MAX; v = next[v])
        if (!uv || memcmp(file->uv + 2 * (size_t)v, uv, 2 * sizeof *uv) == 0) return v;

    const uint32_t made = file->def.vertex_count++;
    memcpy(file->positions + 3 * (size_t)made, polygons->positions + 3 * (size_t)at, 3 * sizeof *file->positions);
    if (uv) memcpy(file->uv + 2 * (size_t)made, uv, 2 * sizeof *uv);
    next[made] = first[at];
    first[at] = made;
    return made;
}

SingeResult render_file_make(const char *name, const Polygons *polygons, RenderFile *file, SingeError *error) {
    const size_t corners = polygons->corner_count, faces = polygons->face_count;
    uint32_t *first = malloc((polygons->vertex_count + (size_t)1) * sizeof *first);
    uint32_t *next = malloc((corners + 1) * sizeof *next), *left = malloc((corners + 1) * sizeof *left);
    SolidEar *ears = malloc((corners + 1) * sizeof *ears);

    *file = (RenderFile){.def = singe_default_render_mesh()};
    file->positions = malloc(3 * (corners + 1) * sizeof *file->positions);
    file->triangles = malloc(3 * (corners + 1) * sizeof *file->triangles);
    if (polygons->uv) file->uv = malloc(2 * (corners + 1) * sizeof *file->uv);

    const bool good =
        first && next && left && ears && file->positions && file->triangles && (!polygons->uv || file->uv);

    if (good) {
        memset(first, 0xff, polygons->vertex_count * sizeof *first);
        for (size_t f = 0; f < faces; f++) {
            const uint32_t begin = polygons->first[f], count = polygons->first[f + 1] - begin;
            for (uint32_t k = 0; k < count; k++) left[k] = vertex_of(polygons, begin + k, file, first, next);
            solid_cut_face(file->positions, left, ears, count, file->triangles + 3 * (size_t)file->def.triangle_count);
            file->def.triangle_count += count - 2;
        }

        file->def.positions = file->positions;
        file->def.uv = file->uv;
        file->def.triangles = file->triangles;
    } else {
        render_file_free(file);
    }

    free(first);
    free(next);
    free(left);
    free(ears);
    return good ? SINGE_OK : refuse_memory(error, "scene", name);
}

SingeResult scene_bind_meshes(const SceneAssets *assets, SingeSim *sim, uint32_t *sheet, SingeError *error) {
    for (uint32_t i = 0; i < assets->sheet_count; i++) {
        *sheet = i;
        if (!assets->renders[i].positions) continue;
        SingeResult result = singe_sim_add_render_mesh(sim, (SingeSheetId){i, 1}, &assets->renders[i].def);
        if (result) {
            *error = *singe_sim_error(sim);
            return result;
        }
    }

    return SINGE_OK;
}

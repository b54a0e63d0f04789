// Properties of every mesh that a reader accepts.
#pragma once

#include <math.h>

#include "formats/formats.h"
#include "mesh/to_quads.h"
#include "input.h"

static inline void demand_mesh(const Polygons *mesh) {
    demand(mesh->vertex_count > 0 && mesh->face_count > 0 && mesh->positions && mesh->corners && mesh->first);
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; i++) demand(isfinite(mesh->positions[i]));
    for (size_t i = 0; mesh->uv && i < 2 * (size_t)mesh->corner_count; i++) demand(isfinite(mesh->uv[i]));
    demand(mesh->first[0] == 0 && mesh->first[mesh->face_count] == mesh->corner_count);
    for (uint32_t f = 0; f < mesh->face_count; f++) demand(mesh->first[f + 1] >= mesh->first[f] + 3);
    for (uint32_t i = 0; i < mesh->corner_count; i++) demand(mesh->corners[i] < mesh->vertex_count);

    for (uint32_t a = 0; a < mesh->attribute_count; a++) {
        demand(mesh->attributes[a].name[0] != 0);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) demand(isfinite(mesh->attributes[a].values[v]));
    }
}

/// mesh_make turns it into a mesh of quads.
static inline void demand_quads(const Polygons *polygons) {
    Mesh mesh;
    SingeError error;
    MeshReport report;
    MeshOptions options = mesh_default_options();
    if (mesh_make("fuzz", polygons, &options, (SingeAllocator){0}, &mesh, &report, &error)) {
        demand(error.message[0] && !mesh.positions);
        return;
    }

    demand(mesh.vertex_count > 0 && mesh.cell_count > 0);
    for (size_t i = 0; i < mesh.cell_count; i++) {
        const uint32_t *c = mesh.cells + 4 * i;
        for (int k = 0; k < 4; k++)
            demand(c[k] < mesh.vertex_count && c[k] != c[(k + 1) % 4] && c[k] != c[(k + 2) % 4]);
    }
    mesh_free(&mesh);
}

// Frees the arrays of polygons and meshes.
#include "common/store.h"
#include "mesh/to_quads.h"

#include <string.h>

void polygons_free(Polygons *polygons) {
    size_t vertices = polygons->vertex_count, faces = polygons->face_count, corners = polygons->corner_count;
    attributes_free(polygons->allocator, polygons->attributes, polygons->attribute_count, vertices);
    store_free(polygons->allocator, polygons->positions, vertices, 3 * sizeof *polygons->positions);
    store_free(polygons->allocator, polygons->first, faces + 1, sizeof *polygons->first);
    store_free(polygons->allocator, polygons->corners, corners, sizeof *polygons->corners);
    store_free(polygons->allocator, polygons->uv, corners, 2 * sizeof *polygons->uv);
    store_free(polygons->allocator, polygons->lines, faces, sizeof *polygons->lines);
    memset(polygons, 0, sizeof *polygons);
}

void mesh_free(Mesh *mesh) {
    size_t vertices = mesh->vertex_count, cells = mesh->cell_count;
    attributes_free(mesh->allocator, mesh->attributes, mesh->attribute_count, vertices);
    store_free(mesh->allocator, mesh->positions, vertices, 3 * sizeof *mesh->positions);
    store_free(mesh->allocator, mesh->uv, vertices, 2 * sizeof *mesh->uv);
    store_free(mesh->allocator, mesh->corner_uv, cells, 8 * sizeof *mesh->corner_uv);
    store_free(mesh->allocator, mesh->cells, cells, 4 * sizeof *mesh->cells);
    store_free(mesh->allocator, mesh->cell_lines, cells, sizeof *mesh->cell_lines);
    store_free(mesh->allocator, mesh->cell_faces, cells, sizeof *mesh->cell_faces);
    store_free(mesh->allocator, mesh->source, vertices, sizeof *mesh->source);
    store_free(mesh->allocator, mesh->corner_source, cells, 4 * sizeof *mesh->corner_source);
    store_free(mesh->allocator, mesh->became, mesh->source_count, sizeof *mesh->became);
    memset(mesh, 0, sizeof *mesh);
}

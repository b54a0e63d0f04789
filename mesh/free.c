// Frees the arrays of meshes.
#include "formats/mesh_reader.h"
#include "formats/store.h"
#include "mesh/to_quads.h"

#include <string.h>

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

// The mesh formats, by the ending of the name. A new format is a file of its own and a line here.
#include "mesh.h"
#include "support.h"

#include <string.h>

typedef SingeResult MeshReader(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                               Mesh *mesh, SingeError *error);

static const struct {
    const char *ending;
    MeshReader *read;
} mesh_formats[] = {
    {".obj", obj_read},
    {".ply", ply_read},
};

static bool ends_with(const char *name, const char *ending) {
    size_t length = strlen(name), tail = strlen(ending);
    if (length < tail) return false;
    for (size_t i = 0; i < tail; i++) {
        char c = name[length - tail + i];
        if ((c >= 'A' && c <= 'Z' ? c + 32 : c) != ending[i]) return false;
    }
    return true;
}

SingeResult mesh_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Mesh *mesh,
                      SingeError *error) {
    memset(mesh, 0, sizeof *mesh);
    enum { FORMATS = sizeof mesh_formats / sizeof *mesh_formats };
    for (size_t i = 0; i < FORMATS; i++)
        if (ends_with(name, mesh_formats[i].ending))
            return mesh_formats[i].read(name, bytes, size, allocator, mesh, error);
    char known[64] = "";
    for (size_t i = 0; i < FORMATS; i++) {
        if (i) strcat(known, ", ");
        strcat(known, mesh_formats[i].ending);
    }
    return refuse(error, SINGE_ERROR_FORMAT, "mesh", -1, "%s: unknown mesh format; the name must end in one of %s",
                  short_name(name), known);
}

void mesh_free(Mesh *mesh) {
    size_t vertices = mesh->vertex_count;
    for (uint32_t i = 0; i < mesh->attribute_count; i++) {
        const SingeAttribute *attribute = &mesh->attributes[i];
        if (attribute->name) store_free(mesh->allocator, (void *)attribute->name, strlen(attribute->name) + 1, 1);
        store_free(mesh->allocator, (void *)attribute->values, vertices, sizeof *attribute->values);
    }
    store_free(mesh->allocator, mesh->attributes, mesh->attribute_count, sizeof *mesh->attributes);
    store_free(mesh->allocator, mesh->positions, vertices, 3 * sizeof *mesh->positions);
    store_free(mesh->allocator, mesh->uv, vertices, 2 * sizeof *mesh->uv);
    store_free(mesh->allocator, mesh->cells, mesh->cell_count, 4 * sizeof *mesh->cells);
    store_free(mesh->allocator, mesh->cell_lines, mesh->cell_count, sizeof *mesh->cell_lines);
    memset(mesh, 0, sizeof *mesh);
}

// The mesh formats, by the ending of the name. A new format is a file of its own and a line here.
#include "formats/mesh_reader.h"
#include "formats/store.h"

#include <string.h>

typedef SingeResult MeshReader(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                               Polygons *polygons, SingeError *error);

static const struct {
    const char *ending;
    MeshReader *read;
} mesh_formats[] = {
    {".obj", obj_read},
    {".ply", ply_read},
    {".stl", stl_read},
    {".off", off_read},
    {".gltf", gltf_read},
    {".glb", gltf_read},
    {".fbx", assimp_read},
    {".dae", assimp_read},
    {".3ds", assimp_read},
    {".x3d", assimp_read},
};

bool mesh_name_ends(const char *name, const char *ending) {
    size_t length = strlen(name), tail = strlen(ending);
    if (length < tail) return false;
    for (size_t i = 0; i < tail; i++) {
        char c = name[length - tail + i];
        if ((c >= 'A' && c <= 'Z' ? c + 32 : c) != ending[i]) return false;
    }
    return true;
}

SingeResult polygons_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                          Polygons *polygons, SingeError *error) {
    memset(polygons, 0, sizeof *polygons);
    enum { FORMATS = sizeof mesh_formats / sizeof *mesh_formats };
    for (size_t i = 0; i < FORMATS; i++)
        if (mesh_name_ends(name, mesh_formats[i].ending))
            return mesh_formats[i].read(name, bytes, size, allocator, polygons, error);
    char known[96] = "";
    for (size_t i = 0; i < FORMATS; i++) {
        if (i) strcat(known, ", ");
        strcat(known, mesh_formats[i].ending);
    }
    return refuse(error, SINGE_ERROR_FORMAT, "mesh", -1, "%s: unknown mesh format; the name must end in one of %s",
                  short_name(name), known);
}

void attributes_free(SingeAllocator allocator, SingeAttribute *attributes, uint32_t attribute_count, size_t count) {
    for (uint32_t i = 0; i < attribute_count; i++) {
        const SingeAttribute *attribute = &attributes[i];
        if (attribute->name) store_free(allocator, (void *)attribute->name, strlen(attribute->name) + 1, 1);
        store_free(allocator, (void *)attribute->values, count, sizeof *attribute->values);
    }
    store_free(allocator, attributes, attribute_count, sizeof *attributes);
}

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

// The mesh formats, by the ending of the name. A new format needs a file of its own and a line here.
#include "formats/mesh_reader.h"
#include "common/store.h"

#include <string.h>

typedef SingeResult MeshReader(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                               Polygons *polygons, SingeError *error);

static const struct {
    const char *ending;
    MeshReader *read;
} mesh_formats[] = {
    {".obj", obj_read},  {".ply", ply_read},    {".stl", stl_read},    {".off", off_read},    {".gltf", gltf_read},
    {".glb", gltf_read}, {".fbx", assimp_read}, {".dae", assimp_read}, {".3ds", assimp_read}, {".x3d", assimp_read},
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

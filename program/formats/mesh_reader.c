// The mesh formats, by the ending of the name. A new format needs a file of its own and a line here.
#include "formats/mesh_reader.h"

#include "common/store.h"

#include <string.h>
#include <math.h>

typedef SingeResult MeshReader(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                               Polygons *polygons, SingeError *error);

static const struct {
    const char *ending;
    MeshReader *read;
} mesh_formats[] = {
    {".obj", obj_read},    {".ply", ply_read},    {".stl", stl_read},    {".gltf", gltf_read},  {".glb", gltf_read},
    {".fbx", assimp_read}, {".dae", assimp_read}, {".3ds", assimp_read}, {".x3d", assimp_read}, {".off", assimp_read},
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

bool mesh_name_is_stage(const char *name) {
    return mesh_name_ends(name, ".usd") || mesh_name_ends(name, ".usda") || mesh_name_ends(name, ".usdc") ||
           mesh_name_ends(name, ".usdz");
}

SingeResult polygons_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                          Polygons *polygons, SingeError *error) {
    memset(polygons, 0, sizeof *polygons);
    enum { FORMATS = sizeof mesh_formats / sizeof *mesh_formats };
    for (size_t i = 0; i < FORMATS; i++)
        if (mesh_name_ends(name, mesh_formats[i].ending))
            return mesh_formats[i].read(name, bytes, size, allocator, polygons, error);

    if (mesh_name_is_stage(name))
        return refuse(error, SINGE_ERROR_FORMAT, "mesh", -1, "%s: " MESH_STAGE_HELP, short_name(name));

    char known[96] = "";
    for (size_t i = 0; i < FORMATS; i++) {
        if (i) strcat(known, ", ");
        strcat(known, mesh_formats[i].ending);
    }

    return refuse(error, SINGE_ERROR_FORMAT, "mesh", -1, "%s: unknown mesh format; the name must end in one of %s",
                  short_name(name), known);
}

// ---- answers of a child process

static SingeResult refuse_answer(const char *name, SingeError *error) {
    return refuse(error, SINGE_ERROR_FORMAT, "mesh", -1, "%s: its reader returned damaged data", short_name(name));
}

static SingeResult take_arrays(const char *name, const uint8_t *at, Polygons *made, SingeError *error) {
    memcpy(made->positions, at, 12 * (size_t)made->vertex_count), at += 12 * (size_t)made->vertex_count;
    memcpy(made->first + 1, at, 4 * (size_t)made->face_count), at += 4 * (size_t)made->face_count;
    memcpy(made->corners, at, 4 * (size_t)made->corner_count), at += 4 * (size_t)made->corner_count;
    if (made->uv) memcpy(made->uv, at, 8 * (size_t)made->corner_count);

    // the faces' first corners, from their sizes, which are stored after the first entry
    uint64_t corner = 0;
    made->first[0] = 0;

    for (size_t f = 0; f < made->face_count; f++) {
        if (made->first[f + 1] < 3 || made->first[f + 1] > made->corner_count - corner)
            return refuse_answer(name, error);
        corner += made->first[f + 1];
        made->first[f + 1] = (uint32_t)corner;
    }

    if (corner != made->corner_count) return refuse_answer(name, error);

    for (size_t i = 0; i < made->corner_count; i++)
        if (made->corners[i] >= made->vertex_count) return refuse_answer(name, error);
    for (size_t i = 0; made->uv && i < 2 * (size_t)made->corner_count; i++)
        if (!isfinite(made->uv[i])) made->uv[i] = 0;

    for (size_t i = 0; i < 3 * (size_t)made->vertex_count; i++)
        if (!isfinite(made->positions[i]))
            return refuse(error, SINGE_ERROR_MESH, "mesh", (int64_t)(i / 3),
                          "%s: vertex %llu (from 0) has a position that is not finite", short_name(name),
                          (unsigned long long)(i / 3));
    return SINGE_OK;
}

SingeResult mesh_answer_take(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                             Polygons *polygons, SingeError *error) {
    MeshCounts counts;
    *polygons = (Polygons){.allocator = allocator};
    if (size < sizeof counts) return refuse_answer(name, error);
    memcpy(&counts, bytes, sizeof counts);

    if (counts.vertices > MESH_COUNT_LIMIT || counts.faces > MESH_COUNT_LIMIT || counts.corners > MESH_COUNT_LIMIT ||
        counts.uv > 1 ||
        size != sizeof counts + 12 * counts.vertices + 4 * counts.faces + (4 + 8 * counts.uv) * counts.corners)
        return refuse_answer(name, error);

    if (counts.faces == 0) return refuse(error, SINGE_ERROR_MESH, "mesh", -1, "%s: has no faces", short_name(name));
    Polygons made = {.vertex_count = (uint32_t)counts.vertices,
                     .face_count = (uint32_t)counts.faces,
                     .corner_count = (uint32_t)counts.corners,
                     .allocator = allocator};
    made.positions = store_new(allocator, made.vertex_count, 3 * sizeof *made.positions);
    made.first = store_new(allocator, (size_t)made.face_count + 1, sizeof *made.first);
    made.corners = store_new(allocator, made.corner_count, sizeof *made.corners);
    if (counts.uv) made.uv = store_new(allocator, made.corner_count, 2 * sizeof *made.uv);

    bool room = made.positions && made.first && made.corners && (!counts.uv || made.uv);
    SingeResult result =
        room ? take_arrays(name, bytes + sizeof counts, &made, error) : refuse_memory(error, "mesh", name);
    if (result) polygons_free(&made);
    else *polygons = made;
    return result;
}

// The program's readers of meshes and its writer of USD for JavaScript: a module of its own, singe-files.wasm, which a
// page loads when a file comes or goes. Each call has a new instance of it, so nothing is freed.
#include "formats/usd.h"
#include "singe/mesh.h"

#include <assert.h>
#include <stdint.h>
#include <stdlib.h>

static_assert(sizeof(void *) == 4, "JavaScript passes pointers as words");

const char *files_read_mesh(const char *name, const uint8_t *bytes, size_t size, uintptr_t words[7]);
const char *files_make_quads(uintptr_t words[7]);
const char *files_write_usdc(const char *name, const float colour[3], uintptr_t *words);

/// What the module keeps of its one call.
static SingeError error;

/// Reads a mesh of the format that the name's ending tells. `words` becomes vertices, faces, corners, and where lie:
/// positions [3 vertices], first corners [faces + 1], corners, uv [2 corners] or 0. Returns the message of what is
/// wrong, or NULL.
const char *files_read_mesh(const char *name, const uint8_t *bytes, size_t size, uintptr_t words[7]) {
    Polygons mesh;
    if (polygons_read(name, bytes, size, (SingeAllocator){0}, &mesh, &error)) return error.message;
    const uintptr_t found[7] = {mesh.vertex_count,         mesh.face_count,       mesh.corner_count,
                                (uintptr_t)mesh.positions, (uintptr_t)mesh.first, (uintptr_t)mesh.corners,
                                (uintptr_t)mesh.uv};
    memcpy(words, found, sizeof found);
    return NULL;
}

/// Makes quads of faces. `words` has vertices, faces, and where lie: positions, corners, corners of each face or 0, uv of
/// vertices or 0, uv of corners or 0. It becomes vertices, cells, and where lie: positions, cells, uv of vertices or 0, uv
/// of corners or 0. Returns as above.
const char *files_make_quads(uintptr_t words[7]) {
    SingeMeshDef def = singe_default_mesh();
    def.vertex_count = words[0];
    def.face_count = words[1];
    def.positions = (const float *)words[2];
    def.corners = (const uint32_t *)words[3];
    def.face_sizes = (const uint32_t *)words[4];
    def.uv = (const float *)words[5];
    def.corner_uv = (const float *)words[6];
    SingeMesh *mesh;
    if (singe_mesh_create(&def, &mesh, &error)) return error.message;
    const SingeMeshView view = singe_mesh_view(mesh);
    const uintptr_t found[6] = {view.vertex_count,     view.cell_count,    (uintptr_t)view.positions,
                                (uintptr_t)view.cells, (uintptr_t)view.uv, (uintptr_t)view.corner_uv};
    memcpy(words, found, sizeof found);
    return NULL;
}

/// Writes a surface of one sheet of this colour as USDC. `words` has its counts and pointers in the order of
/// SingeSurface, and becomes where the bytes lie and how many. Returns as above.
const char *files_write_usdc(const char *name, const float colour[3], uintptr_t *words) {
    SingeSurface surface = {0};
    memcpy(&surface, words, offsetof(SingeSurface, vertex_capacity));
    const OutputSheet sheet = {.name = "sheet", .colour = {colour[0], colour[1], colour[2]}};
    const OutputScene scene = {.name = name, .fps = 24, .frames = 1, .sheet_count = 1, .sheets = &sheet};
    const OutputFrame frame = {.surface = &surface, .number = 1};
    Sink sink = {0};
    if (usd_frame_bytes(name, &scene, &frame, &sink, &error)) return error.message;
    words[0] = (uintptr_t)sink.bytes;
    words[1] = sink.size;
    return NULL;
}

// ---- what a page cannot do

void bytes_free(Bytes *bytes) { (void)bytes; }

bool path_is_inside(const char *name, const char *path) {
    (void)name, (void)path;
    return true; // it is refused below
}

SingeResult file_read_max(const char *path, size_t max, SingeAllocator allocator, Bytes *bytes, SingeError *why) {
    (void)max, (void)allocator;
    *bytes = (Bytes){0};
    return refuse(why, SINGE_ERROR_FILE, "file", -1, "%s: the page cannot open a second file", short_name(path));
}

SingeResult assimp_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                        Polygons *polygons, SingeError *why) {
    (void)bytes, (void)size, (void)allocator, (void)polygons;
    return refuse(why, SINGE_ERROR_FORMAT, "mesh", -1, "%s: the page reads OBJ, PLY, STL and GLB", short_name(name));
}

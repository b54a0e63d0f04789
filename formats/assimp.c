// Meshes by assimp's C interface: glTF, GLB, STL, FBX, COLLADA and more. Nothing is triangulated, smoothed or joined
// there: mesh_make does that by position. All meshes of all nodes are taken with their transforms, in the order of a
// walk over the nodes. What a file refers to beside itself (a glTF's buffers) is read from its folder.
#include "mesh.h"
#include "support.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool assimp_available(void) { return true; }

// ---- files in memory

typedef struct Source {
    const char *name;
    const uint8_t *bytes;
    size_t size;
} Source;

typedef struct Opened {
    const uint8_t *bytes;
    size_t size, at;
    Bytes own; ///< of a file beside the first
} Opened;

static size_t opened_read(struct aiFile *file, char *to, size_t size, size_t count) {
    Opened *opened = (void *)file->UserData;
    if (!size) return 0;
    size_t most = (opened->size - opened->at) / size;
    if (count > most) count = most;
    if (count) memcpy(to, opened->bytes + opened->at, size * count);
    opened->at += size * count;
    return count;
}

static size_t opened_write(struct aiFile *file, const char *from, size_t size, size_t count) {
    (void)file, (void)from, (void)size, (void)count;
    return 0;
}

static size_t opened_tell(struct aiFile *file) { return ((Opened *)(void *)file->UserData)->at; }
static size_t opened_size(struct aiFile *file) { return ((Opened *)(void *)file->UserData)->size; }
static void opened_flush(struct aiFile *file) { (void)file; }

static enum aiReturn opened_seek(struct aiFile *file, size_t offset, enum aiOrigin origin) {
    Opened *opened = (void *)file->UserData;
    size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? opened->at : opened->size;
    size_t to = from + offset; // wraps where it goes back
    if (to > opened->size) return aiReturn_FAILURE;
    opened->at = to;
    return aiReturn_SUCCESS;
}

static struct aiFile *source_open(struct aiFileIO *io, const char *name, const char *mode) {
    const Source *source = (void *)io->UserData;
    if (!mode || strchr(mode, 'w')) return NULL;
    struct aiFile *file = calloc(1, sizeof *file);
    Opened *opened = calloc(1, sizeof *opened);
    bool good = file && opened;
    if (good && strcmp(name, source->name) == 0) opened->bytes = source->bytes, opened->size = source->size;
    else if (good && !file_read(name, (SingeAllocator){0}, &opened->own, NULL))
        opened->bytes = opened->own.data, opened->size = opened->own.size;
    else good = false;
    if (!good) {
        free(file);
        free(opened);
        return NULL;
    }
    *file = (struct aiFile){opened_read, opened_write, opened_tell, opened_size, opened_seek, opened_flush,
                            (void *)opened};
    return file;
}

static void source_close(struct aiFileIO *io, struct aiFile *file) {
    (void)io;
    Opened *opened = (void *)file->UserData;
    bytes_free(&opened->own);
    free(opened);
    free(file);
}

// ---- from its scene to polygons

typedef struct Counts {
    uint64_t vertices, faces, corners, skipped;
    bool uv;
} Counts;

static void count_node(const struct aiScene *scene, const struct aiNode *node, Counts *counts) {
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *mesh = scene->mMeshes[node->mMeshes[i]];
        counts->vertices += mesh->mNumVertices;
        for (unsigned f = 0; f < mesh->mNumFaces; f++) {
            unsigned corners = mesh->mFaces[f].mNumIndices;
            if (corners < 3) counts->skipped++; // points and lines carry nothing that burns
            else counts->faces++, counts->corners += corners;
        }
        counts->uv = counts->uv || mesh->mTextureCoords[0];
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) count_node(scene, node->mChildren[i], counts);
}

static struct aiVector3D moved(const struct aiMatrix4x4 *m, struct aiVector3D p) {
    return (struct aiVector3D){m->a1 * p.x + m->a2 * p.y + m->a3 * p.z + m->a4,
                               m->b1 * p.x + m->b2 * p.y + m->b3 * p.z + m->b4,
                               m->c1 * p.x + m->c2 * p.y + m->c3 * p.z + m->c4};
}

/// False where an index is out of range.
static bool take_mesh(const struct aiMesh *mesh, const struct aiMatrix4x4 *at, Polygons *out) {
    const uint32_t base = out->vertex_count;
    const float turn = (at->a1 * (at->b2 * at->c3 - at->b3 * at->c2) - at->a2 * (at->b1 * at->c3 - at->b3 * at->c1) +
                        at->a3 * (at->b1 * at->c2 - at->b2 * at->c1));
    for (unsigned v = 0; v < mesh->mNumVertices; v++) {
        struct aiVector3D p = moved(at, mesh->mVertices[v]);
        float *position = out->positions + 3 * (size_t)out->vertex_count++;
        position[0] = p.x, position[1] = p.y, position[2] = p.z;
    }
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        if (face->mNumIndices < 3) continue;
        for (unsigned i = 0; i < face->mNumIndices; i++) {
            unsigned v = face->mIndices[turn < 0 ? face->mNumIndices - 1 - i : i]; // a mirror turns faces over
            if (v >= mesh->mNumVertices) return false;
            if (out->uv) {
                float *uv = out->uv + 2 * (size_t)out->corner_count;
                const struct aiVector3D *given = mesh->mTextureCoords[0];
                uv[0] = given ? given[v].x : 0, uv[1] = given ? given[v].y : 0;
                if (!isfinite(uv[0]) || !isfinite(uv[1])) uv[0] = uv[1] = 0;
            }
            out->corners[out->corner_count++] = base + v;
        }
        out->first[++out->face_count] = out->corner_count;
    }
    return true;
}

static bool take_node(const struct aiScene *scene, const struct aiNode *node, struct aiMatrix4x4 parent,
                      Polygons *out) {
    aiMultiplyMatrix4(&parent, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (!take_mesh(scene->mMeshes[node->mMeshes[i]], &parent, out)) return false;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (!take_node(scene, node->mChildren[i], parent, out)) return false;
    return true;
}

/// Makes the arrays, which are then filled, their counts rising to what they have room for.
static SingeResult take_scene(const char *name, const struct aiScene *scene, Polygons *out, SingeError *error) {
    Counts counts = {0};
    count_node(scene, scene->mRootNode, &counts);
    if (counts.faces == 0)
        return refuse(error, SINGE_ERROR_MESH, "mesh", -1, "%s: has no faces", short_name(name));
    if (counts.vertices > MESH_COUNT_LIMIT || counts.corners > MESH_COUNT_LIMIT)
        return refuse(error, SINGE_ERROR_LIMIT, "mesh", -1, "%s: is too large", short_name(name));
    SingeAllocator a = out->allocator;
    Polygons made = {.allocator = a};
    made.positions = store_new(a, counts.vertices, 3 * sizeof *made.positions);
    made.first = store_new(a, counts.faces + 1, sizeof *made.first);
    made.corners = store_new(a, counts.corners, sizeof *made.corners);
    if (counts.uv) made.uv = store_new(a, counts.corners, 2 * sizeof *made.uv);
    *out = made;
    bool room = made.positions && made.first && made.corners && (!counts.uv || made.uv), good = true;
    if (room) {
        struct aiMatrix4x4 unit;
        aiIdentityMatrix4(&unit);
        out->first[0] = 0;
        good = take_node(scene, scene->mRootNode, unit, out);
    }
    // as they were made, so that polygons_free knows
    out->vertex_count = (uint32_t)counts.vertices, out->face_count = (uint32_t)counts.faces;
    out->corner_count = (uint32_t)counts.corners;
    if (!room) return refuse_memory(error, "mesh", name);
    if (!good)
        return refuse(error, SINGE_ERROR_MESH, "mesh", -1, "%s: a face uses a vertex that is not there",
                      short_name(name));
    for (size_t i = 0; i < 3 * (size_t)counts.vertices; i++)
        if (!isfinite(out->positions[i]))
            return refuse(error, SINGE_ERROR_MESH, "mesh", (int64_t)(i / 3),
                          "%s: vertex %llu (from 0) has a position that is not finite", short_name(name),
                          (unsigned long long)(i / 3));
    return SINGE_OK;
}

SingeResult assimp_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                        Polygons *polygons, SingeError *error) {
    memset(polygons, 0, sizeof *polygons);
    polygons->allocator = allocator;
    if (size == 0) return refuse(error, SINGE_ERROR_FORMAT, "mesh", 0, "%s: is empty", short_name(name));
    Source source = {name, bytes, size};
    struct aiFileIO io = {source_open, source_close, (void *)&source};
    const struct aiScene *scene = aiImportFileEx(name, 0, &io);
    if (!scene || !scene->mRootNode) {
        const char *why = aiGetErrorString();
        return refuse(error, SINGE_ERROR_FORMAT, "mesh", -1, "%s: %.160s", short_name(name),
                      why && why[0] ? why : "cannot be read");
    }
    SingeResult result = take_scene(name, scene, polygons, error);
    aiReleaseImport(scene);
    if (result) polygons_free(polygons);
    return result;
}

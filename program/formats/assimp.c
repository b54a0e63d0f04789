// Meshes by assimp's C interface: FBX, COLLADA, 3DS, X3D, OFF and glTF 1. assimp is large and was not written for hostile
// files, so it runs in a child process, which answers with polygons (mesh_reader.h). Nothing is triangulated, smoothed
// or joined there: mesh_make does that by position. All meshes of all nodes are read with their transforms, in
// depth-first order of the nodes.
#include "common/store.h"
#include "formats/formats.h"

#ifndef SINGE_ASSIMP

SingeResult assimp_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                        Polygons *polygons, SingeError *error) {
    (void)bytes, (void)size;
    *polygons = (Polygons){.allocator = allocator};
    return refuse(error, SINGE_ERROR_STATE, "mesh", -1,
                  "%s: this singe was built without assimp; it reads OBJ, PLY, STL and glTF 2", short_name(name));
}

#else

#include "formats/isolate.h"
#include "formats/mesh_reader.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/scene.h>

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_LIMIT = 1000 }; ///< of nested nodes

// ---- the files that assimp may open: the one to read, which is in memory, and regular files in its folder or below

typedef struct Source {
    const char *name; ///< of the file to read; paths in it are relative to its folder
    const uint8_t *bytes;
    size_t size;
    size_t beside_size;  ///< of the other files that were opened
    const char *refused; ///< the end of a sentence about the first refused file, or NULL
} Source;

typedef struct Opened {
    const uint8_t *bytes;
    size_t size, at;
    Bytes own; ///< of a file other than the first
} Opened;

// ---- one file

static size_t opened_read(struct aiFile *file, char *to, size_t size, size_t count) {
    Opened *opened = (void *)file->UserData;
    if (!size) return 0;
    size_t max = (opened->size - opened->at) / size;
    if (count > max) count = max;
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
    size_t to = from + offset; // wraps for negative offsets
    if (to > opened->size) return aiReturn_FAILURE;
    opened->at = to;
    return aiReturn_SUCCESS;
}

// ---- which files

static void note_refused(Source *source, const char *why) {
    if (!source->refused) source->refused = why;
}

// ---- assimp's callbacks

static struct aiFile *source_open(struct aiFileIO *io, const char *name, const char *mode) {
    Source *source = (void *)io->UserData;
    if (!mode || strchr(mode, 'w') || strchr(mode, 'a') || strchr(mode, '+')) return NULL;

    struct aiFile *file = calloc(1, sizeof *file);
    Opened *opened = calloc(1, sizeof *opened);
    bool good = file && opened;

    if (good && strcmp(name, source->name) == 0) {
        opened->bytes = source->bytes;
        opened->size = source->size;
    } else if (good && !path_is_inside(source->name, name)) {
        note_refused(source, "; it may refer only to files in its folder or below");
        good = false;
    } else if (good && file_read(name, (SingeAllocator){0}, &opened->own, NULL)) {
        note_refused(source, "; it refers to a file that cannot be read");
        good = false;
    } else if (good) {
        opened->bytes = opened->own.data;
        opened->size = opened->own.size;
        source->beside_size += opened->size;
    }

    if (!good) {
        free(file);
        free(opened);
        return NULL;
    }

    *file =
        (struct aiFile){opened_read, opened_write, opened_tell, opened_size, opened_seek, opened_flush, (void *)opened};
    return file;
}

static void source_close(struct aiFileIO *io, struct aiFile *file) {
    (void)io;
    Opened *opened = (void *)file->UserData;
    bytes_free(&opened->own);
    free(opened);
    free(file);
}

// ---- a walk over the meshes of all nodes

typedef struct Walk Walk;
typedef SingeResult Visit(Walk *walk, const struct aiMesh *mesh, const struct aiMatrix4x4 *at);

struct Walk {
    const struct aiScene *scene;
    const char *name;
    SingeError *error;
    Visit *visit;
    MeshCounts counts; ///< so far
    uint64_t max;      ///< bytes of the answer
    int depth;
    IsolateAnswer *answer;
    size_t held; ///< bytes of `buffer` in use
    uint8_t buffer[1 << 12];
};

static SingeResult walk_node(Walk *walk, const struct aiNode *node, struct aiMatrix4x4 parent) {
    const struct aiScene *scene = walk->scene;
    if (++walk->depth > DEPTH_LIMIT)
        return refuse(walk->error, SINGE_ERROR_LIMIT, "mesh", -1, "%s: nodes are nested more than %d deep",
                      short_name(walk->name), DEPTH_LIMIT);
    aiMultiplyMatrix4(&parent, &node->mTransformation);

    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        if (node->mMeshes[i] >= scene->mNumMeshes)
            return refuse(walk->error, SINGE_ERROR_MESH, "mesh", -1, "%s: a node uses mesh %u of %u",
                          short_name(walk->name), node->mMeshes[i], scene->mNumMeshes);
        TRY(walk->visit(walk, scene->mMeshes[node->mMeshes[i]], &parent));
    }

    for (unsigned i = 0; i < node->mNumChildren; i++) TRY(walk_node(walk, node->mChildren[i], parent));
    walk->depth--;
    return SINGE_OK;
}

static SingeResult walk_scene(Walk *walk, Visit *visit) {
    struct aiMatrix4x4 unit;
    aiIdentityMatrix4(&unit);
    walk->visit = visit;
    walk->depth = 0;
    return walk_node(walk, walk->scene->mRootNode, unit);
}

// ---- parts of the answer, each by a walk of its own

static void put(Walk *walk, const void *bytes, size_t size) {
    if (walk->held + size > sizeof walk->buffer) {
        isolate_put(walk->answer, walk->buffer, walk->held);
        walk->held = 0;
    }
    memcpy(walk->buffer + walk->held, bytes, size);
    walk->held += size;
}

static SingeResult count_mesh(Walk *walk, const struct aiMesh *mesh, const struct aiMatrix4x4 *at) {
    (void)at;
    MeshCounts *counts = &walk->counts;
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        unsigned corners = mesh->mFaces[f].mNumIndices;

        const struct aiFace *face = &mesh->mFaces[f];
        for (unsigned i = 0; i < face->mNumIndices; i++)
            if (face->mIndices[i] >= mesh->mNumVertices) {
                unsigned number = 0; // of the mesh in its file
                while (number < walk->scene->mNumMeshes && walk->scene->mMeshes[number] != mesh) number++;
                return refuse(
                    walk->error, SINGE_ERROR_MESH, "mesh", f,
                    "%s: mesh %u, face %u (from 0): vertex index %u is out of range: the mesh has %u vertices",
                    short_name(walk->name), number, f, face->mIndices[i], mesh->mNumVertices);
            }

        if (corners < 3) continue; // points and lines have no area
        counts->faces++, counts->corners += corners;
    }

    counts->vertices += mesh->mNumVertices;
    counts->uv = counts->uv || mesh->mTextureCoords[0];

    if (12 * counts->vertices + 12 * counts->corners > walk->max)
        return refuse(walk->error, SINGE_ERROR_LIMIT, "mesh", -1,
                      "%s: too large: its nodes repeat meshes, which come to more than %llu MB", short_name(walk->name),
                      (unsigned long long)walk->max / 1000000);

    return SINGE_OK;
}

static SingeResult put_positions(Walk *walk, const struct aiMesh *mesh, const struct aiMatrix4x4 *m) {
    for (unsigned v = 0; v < mesh->mNumVertices; v++) {
        struct aiVector3D p = mesh->mVertices[v];
        float moved[3] = {m->a1 * p.x + m->a2 * p.y + m->a3 * p.z + m->a4,
                          m->b1 * p.x + m->b2 * p.y + m->b3 * p.z + m->b4,
                          m->c1 * p.x + m->c2 * p.y + m->c3 * p.z + m->c4};
        put(walk, moved, sizeof moved);
    }

    return SINGE_OK;
}

static SingeResult put_sizes(Walk *walk, const struct aiMesh *mesh, const struct aiMatrix4x4 *at) {
    (void)at;
    for (unsigned f = 0; f < mesh->mNumFaces; f++)
        if (mesh->mFaces[f].mNumIndices >= 3) put(walk, &mesh->mFaces[f].mNumIndices, 4);
    return SINGE_OK;
}

/// The i-th corner of a face: mirroring flips faces.
static unsigned corner(const struct aiFace *face, const struct aiMatrix4x4 *at, unsigned i) {
    float turn = (at->a1 * (at->b2 * at->c3 - at->b3 * at->c2) - at->a2 * (at->b1 * at->c3 - at->b3 * at->c1) +
                  at->a3 * (at->b1 * at->c2 - at->b2 * at->c1));
    return face->mIndices[turn < 0 ? face->mNumIndices - 1 - i : i];
}

static SingeResult put_corners(Walk *walk, const struct aiMesh *mesh, const struct aiMatrix4x4 *at) {
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        for (unsigned i = 0; face->mNumIndices >= 3 && i < face->mNumIndices; i++) {
            uint32_t vertex = (uint32_t)walk->counts.vertices + corner(face, at, i);
            put(walk, &vertex, sizeof vertex);
        }
    }

    walk->counts.vertices += mesh->mNumVertices;
    return SINGE_OK;
}

static SingeResult put_uv(Walk *walk, const struct aiMesh *mesh, const struct aiMatrix4x4 *at) {
    const struct aiVector3D *given = mesh->mTextureCoords[0];
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        for (unsigned i = 0; face->mNumIndices >= 3 && i < face->mNumIndices; i++) {
            unsigned v = corner(face, at, i);
            float uv[2] = {given ? given[v].x : 0, given ? given[v].y : 0};
            put(walk, uv, sizeof uv);
        }
    }

    return SINGE_OK;
}

// ---- in the child

/// assimp omits or changes some indices that are out of range, and reports that only in its log.
static void note_complaint(const char *message, char *bad_index) {
    if (!strstr(message, "ndex")) return;
    if (strstr(message, "range") || strstr(message, "overflow") || strstr(message, "nvalid")) *bad_index = 1;
}

static SingeResult read_in_child(void *context, IsolateAnswer *answer, SingeError *error) {
    char bad_index = 0;
    Source *source = context;
    struct aiFileIO files = (struct aiFileIO){source_open, source_close, (void *)source};
    struct aiLogStream log = {note_complaint, &bad_index};
    aiAttachLogStream(&log);
    const struct aiScene *scene = aiImportFileEx(source->name, 0, &files);

    if (!scene || !scene->mRootNode) {
        const char *why = aiGetErrorString();
        char words[160];
        if (why && strstr(why, "bad_alloc")) errno = ENOMEM; // tells isolate_run

        // without its quotes: whoever sees the message may not be allowed to read the file
        size_t n = 0;
        bool quoted = false;
        for (const char *c = why && why[0] ? why : "cannot be read"; *c && n + 4 < sizeof words; c++) {
            if (*c == '"' && !quoted) {
                memcpy(words + n, "...", 3);
                n += 3;
            }

            if (*c == '"') quoted = !quoted;
            else if (!quoted && (unsigned char)*c >= ' ') words[n++] = *c;
        }

        words[n] = 0;
        return refuse(error, SINGE_ERROR_FORMAT, "mesh", -1, "%s: %s%s", short_name(source->name), words,
                      source->refused ? source->refused : "");
    }

    if (bad_index)
        return refuse(error, SINGE_ERROR_MESH, "mesh", -1, "%s: an index is out of range", short_name(source->name));

    Walk walk = {.scene = scene,
                 .name = source->name,
                 .error = error,
                 .answer = answer,
                 .max = MESH_ANSWER_BASE + MESH_ANSWER_TIMES * ((uint64_t)source->size + source->beside_size)};

    TRY(walk_scene(&walk, count_mesh));
    MeshCounts counts = walk.counts;
    if (counts.vertices > MESH_COUNT_LIMIT || counts.corners > MESH_COUNT_LIMIT)
        return refuse(walk.error, SINGE_ERROR_LIMIT, "mesh", -1, "%s: is too large", short_name(walk.name));

    put(&walk, &counts, sizeof counts);
    TRY(walk_scene(&walk, put_positions));
    TRY(walk_scene(&walk, put_sizes));
    walk.counts.vertices = 0; // start again
    TRY(walk_scene(&walk, put_corners));
    if (counts.uv) TRY(walk_scene(&walk, put_uv));
    isolate_put(walk.answer, walk.buffer, walk.held);
    return SINGE_OK;
}

// ---- in the parent

SingeResult assimp_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                        Polygons *polygons, SingeError *error) {
    *polygons = (Polygons){.allocator = allocator};
    if (size == 0) return refuse(error, SINGE_ERROR_FORMAT, "mesh", 0, "%s: is empty", short_name(name));

    // assimp detects the format from the contents, whatever the name, so it may read other formats, too
    bool matches = false;
    static const struct {
        const char *ending, *begins;
    } kinds[] = {{".gltf", "{"},  {".glb", "glTF"}, {".fbx", "Kaydara FBX"}, {".fbx", ";"},
                 {".fbx", "FBX"}, {".dae", "<"},    {".x3d", "<"},           {".3ds", "MM"},
                 {".off", "OFF"}, {".off", "C"},    {".off", "N"},           {".off", "S"}};

    const uint8_t *at = bytes, *end = bytes + size;
    if (end - at >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0) at += 3;
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) at++;

    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        size_t length = strlen(kinds[i].begins);
        if (mesh_name_ends(name, kinds[i].ending) && (size_t)(end - at) >= length &&
            memcmp(at, kinds[i].begins, length) == 0)
            matches = true;
    }

    if (!matches)
        return refuse(error, SINGE_ERROR_FORMAT, "mesh", 0, "%s: the contents do not match the extension",
                      short_name(name));

    Source source = {.name = name, .bytes = bytes, .size = size};
    IsolateLimits limits = {(512u << 20) + 32 * size, 10 + 5e-7 * (double)size};
    Bytes answer;
    TRY(isolate_run(name, read_in_child, &source, limits, allocator, &answer, error));
    SingeResult result = mesh_answer_take(name, answer.data, answer.size, allocator, polygons, error);

    bytes_free(&answer);
    return result;
}

#endif

#include "cli/checkpoint.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/text.h"

/// At the end of the file, so that the snapshot need not be copied. The byte order is the machine's, as is the
/// snapshot's.
typedef struct Trailer {
    char magic[8];
    uint64_t snapshot_size, scene_hash, frame;
    Totals totals;
    uint64_t checksum; ///< of everything before it
} Trailer;

static const char checkpoint_magic[8] = {'S', 'I', 'N', 'G', 'E', 'C', 'P', '3'};

/// FNV-1a over words of 8 bytes with a final mix; the rest byte by byte.
static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size) {
    const uint64_t prime = 1099511628211u;
    const uint8_t *p = data;
    for (; size >= 8; p += 8, size -= 8) {
        uint64_t word;
        memcpy(&word, p, 8);
        hash = (hash ^ word) * prime;
        hash ^= hash >> 29;
    }
    for (; size; p++, size--) hash = (hash ^ *p) * prime;
    return hash ^ hash >> 32;
}

static const uint64_t hash_start = 14695981039346656037u;

static uint64_t hash_mesh(uint64_t hash, const Mesh *mesh) {
    hash = hash_bytes(hash, mesh->positions, sizeof(float) * 3 * mesh->vertex_count);
    if (mesh->corner_uv) hash = hash_bytes(hash, mesh->corner_uv, sizeof(float) * 8 * mesh->cell_count);
    if (mesh->uv) hash = hash_bytes(hash, mesh->uv, sizeof(float) * 2 * mesh->vertex_count);
    hash = hash_bytes(hash, mesh->cells, sizeof(uint32_t) * 4 * mesh->cell_count);
    for (uint32_t i = 0; i < mesh->attribute_count; i++) {
        hash = hash_bytes(hash, mesh->attributes[i].name, strlen(mesh->attributes[i].name));
        hash = hash_bytes(hash, mesh->attributes[i].values, sizeof(float) * mesh->vertex_count);
    }
    return hash;
}

static uint64_t hash_picture(uint64_t hash, const SingePicture *picture) {
    if (!picture->values) return hash;
    hash = hash_bytes(hash, &picture->width, sizeof picture->width);
    return hash_bytes(hash, picture->values, sizeof(float) * (size_t)picture->width * (size_t)picture->height);
}

SingeResult checkpoint_scene_hash(const Scene *scene, const SceneAssets *assets, uint64_t *hash, SingeError *error) {
    Scene bare = *scene; // a longer run or other looks may go on from the same checkpoint
    bare.frames = 1;
    bare.preview = (ScenePreview){0};
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file) scene_dump(&bare, SCENE_JSON, 0, file);
    const bool good = text_stream_end(file, &text);
    if (good) {
        *hash = hash_bytes(hash_start, text, size);
        for (uint32_t i = 0; i < assets->sheet_count; i++) {
            *hash = hash_mesh(*hash, &assets->meshes[i]);
            for (int k = 0; k < SCENE_PARAM_SLOTS; k++) *hash = hash_picture(*hash, &assets->params[i][k]);
        }
        for (uint32_t i = 0; i < assets->source_count; i++) *hash = hash_picture(*hash, &assets->source_pictures[i]);
    }
    free(text);
    if (good) return SINGE_OK;
    *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "checkpoint", .element = -1};
    return SINGE_ERROR_MEMORY;
}

SingeResult checkpoint_write(const Folder *folder, SingeSim *sim, SingeAllocator allocator, int frame,
                             uint64_t scene_hash, const Totals *totals, SingeError *error) {
    uint8_t *bytes;
    size_t size;
    SingeResult result = singe_sim_save(sim, &bytes, &size);
    if (result) {
        *error = *singe_sim_error(sim);
        return result;
    }
    uint8_t *grown = allocator.resize(allocator.context, bytes, size, size + sizeof(Trailer));
    if (!grown) {
        singe_sim_free_bytes(sim, bytes, size);
        *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "checkpoint", .element = -1};
        return SINGE_ERROR_MEMORY;
    }
    Trailer trailer = {.snapshot_size = size, .scene_hash = scene_hash, .frame = (uint64_t)frame, .totals = *totals};
    memcpy(trailer.magic, checkpoint_magic, sizeof trailer.magic);
    trailer.checksum = hash_bytes(hash_bytes(hash_start, grown, size), &trailer, offsetof(Trailer, checksum));
    memcpy(grown + size, &trailer, sizeof trailer);
    result = file_write(folder->checkpoint, grown, size + sizeof trailer, error);
    // given back as it came: the library counts what it lent
    uint8_t *shrunk = allocator.resize(allocator.context, grown, size + sizeof trailer, size);
    singe_sim_free_bytes(sim, shrunk ? shrunk : grown, size);
    return result;
}

static SingeResult refuse(const Folder *folder, SingeResult code, const char *why, SingeError *error) {
    *error = (SingeError){.code = code, .stage = "resume", .element = -1};
    snprintf(error->message, sizeof error->message, "%.150s: %.180s; run without --resume to start over",
             folder->checkpoint, why);
    return code;
}

static SingeResult read_trailer(const Folder *folder, const Bytes *bytes, uint64_t scene_hash, Trailer *trailer,
                                SingeError *error) {
    if (bytes->size < sizeof *trailer) return refuse(folder, SINGE_ERROR_FORMAT, "the checkpoint is cut short", error);
    size_t size = bytes->size - sizeof *trailer;
    memcpy(trailer, bytes->data + size, sizeof *trailer);
    if (memcmp(trailer->magic, checkpoint_magic, sizeof trailer->magic) != 0 || trailer->snapshot_size != size)
        return refuse(folder, SINGE_ERROR_FORMAT, "not a checkpoint of this version, or cut short", error);
    uint64_t checksum = hash_bytes(hash_bytes(hash_start, bytes->data, size), trailer, offsetof(Trailer, checksum));
    if (checksum != trailer->checksum || trailer->frame < 1 || trailer->frame > INT_MAX)
        return refuse(folder, SINGE_ERROR_FORMAT, "the checkpoint is damaged (its checksum differs)", error);
    if (trailer->scene_hash != scene_hash)
        return refuse(folder, SINGE_ERROR_STATE,
                      "the checkpoint is of another scene (the scene, its --set or a file it names has changed)",
                      error);
    return SINGE_OK;
}

SingeResult checkpoint_read(const Folder *folder, const SingeSimDef *hooks, uint64_t scene_hash, Checkpoint *checkpoint,
                            SingeError *error) {
    *checkpoint = (Checkpoint){0};
    if (access(folder->checkpoint, F_OK) != 0 && errno == ENOENT) return SINGE_OK;
    Bytes bytes = {0};
    SingeResult result = file_read(folder->checkpoint, (SingeAllocator){0}, &bytes, error);
    if (result) return result;
    Trailer trailer;
    result = read_trailer(folder, &bytes, scene_hash, &trailer, error);
    if (!result) {
        SingeError inner = {0};
        result = singe_sim_load(hooks, bytes.data, (size_t)trailer.snapshot_size, &checkpoint->sim, &inner);
        if (result) refuse(folder, result, inner.message[0] ? inner.message : singe_result_name(result), error);
        else checkpoint->frame = (int)trailer.frame, checkpoint->totals = trailer.totals;
    }
    bytes_free(&bytes);
    return result;
}

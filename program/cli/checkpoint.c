#include "cli/checkpoint.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/text.h"
#include "common/store.h"

/// At the end of the file, so that the snapshot need not be copied. The byte order is the machine's, as in the
/// snapshot.
typedef struct Trailer {
    char magic[8];
    uint64_t snapshot_size, frame, step;
    SceneHash hash;
    Totals totals;
    uint64_t checksum; ///< of everything before it
} Trailer;

static const char checkpoint_magic[8] = {'S', 'I', 'N', 'G', 'E', 'C', 'P', '5'};

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

/// The prefix of an array states its length and that it is present.
static uint64_t hash_array(uint64_t hash, const void *data, size_t count, size_t size) {
    uint64_t length = data ? count : 0;
    hash = hash_bytes(hash, &length, sizeof length);
    return length ? hash_bytes(hash, data, count * size) : hash;
}

static uint64_t hash_picture(uint64_t hash, const SingeTexture *picture) {
    hash = hash_bytes(hash, &picture->width, sizeof picture->width);
    return hash_array(hash, picture->values, (size_t)picture->width * (size_t)picture->height, sizeof(float));
}

static uint64_t hash_sequence(uint64_t hash, const SceneSequence *sequence, uint32_t frames) {
    if (sequence->frame_count) hash = hash_array(hash, sequence->triangles, 3 * (size_t)sequence->triangle_count, 4);
    for (uint32_t f = 0; f < sequence->frame_count && f < frames; f++)
        hash = hash_array(hash, sequence->frames[f].vertices, 3 * (size_t)sequence->vertex_count, sizeof(float));
    return hash;
}

static uint64_t hash_image(uint64_t hash, const Image *image) {
    hash = hash_bytes(hash, &image->width, sizeof image->width);
    return hash_array(hash, image->rgb, 3 * (size_t)image->width * (size_t)image->height, sizeof *image->rgb);
}

/// The contents of the files that the scene names.
static uint64_t hash_files(uint64_t hash, const SceneAssets *assets) {
    for (uint32_t i = 0; i < assets->sheet_count; i++) {
        const Mesh *mesh = &assets->meshes[i];
        const Image *back = &assets->images[assets->sheet_count + i];

        hash = hash_array(hash, mesh->positions, 3 * (size_t)mesh->vertex_count, sizeof(float));
        hash = hash_array(hash, mesh->corner_uv, 8 * (size_t)mesh->cell_count, sizeof(float));
        hash = hash_array(hash, mesh->uv, 2 * (size_t)mesh->vertex_count, sizeof(float));
        hash = hash_array(hash, mesh->cells, 4 * (size_t)mesh->cell_count, sizeof(uint32_t));
        hash = hash_array(hash, mesh->became, mesh->source_count, sizeof(uint32_t)); // which vertices pins name
        for (uint32_t k = 0; k < mesh->attribute_count; k++) {
            hash = hash_array(hash, mesh->attributes[k].name, strlen(mesh->attributes[k].name), 1);
            hash = hash_array(hash, mesh->attributes[k].values, mesh->vertex_count, sizeof(float));
        }

        const SingeRenderMeshDef *render = &assets->renders[i].def;
        if (render->positions) {
            hash = hash_array(hash, render->positions, 3 * (size_t)render->vertex_count, sizeof(float));
            hash = hash_array(hash, render->uv, 2 * (size_t)render->vertex_count, sizeof(float));
            hash = hash_array(hash, render->triangles, 3 * (size_t)render->triangle_count, sizeof(uint32_t));
        }

        hash = hash_image(hash, &assets->images[i]);
        if (back->rgb) hash = hash_image(hash, back); // scenes without one keep their hash
        for (int k = 0; k < SCENE_PARAM_SLOTS; k++) hash = hash_picture(hash, &assets->fields[i][k].texture);
    }

    for (uint32_t i = 0; i < assets->source_count; i++) hash = hash_picture(hash, &assets->source_textures[i]);

    for (uint32_t i = 0; i < assets->collider_count; i++) {
        const PreviewSolid *surface = &assets->solids[i].surface;
        hash = hash_array(hash, surface->vertices, 3 * (size_t)surface->vertex_count, sizeof(float));
        hash = hash_array(hash, surface->triangles, 3 * (size_t)surface->triangle_count, sizeof(uint32_t));
        hash = hash_array(hash, assets->solids[i].heights, (size_t)assets->solids[i].columns * assets->solids[i].rows,
                          sizeof(float));
    }

    return hash;
}

static bool hash_scene(const Scene *scene, uint64_t *hash) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file) scene_dump(scene, SCENE_JSON, 0, file);
    const bool good = text_stream_end(file, &text);
    if (good) *hash = hash_bytes(hash_start, text, size);
    free(text);
    return good;
}

SingeResult checkpoint_scene_hash(const Scene *scene, const SceneAssets *assets, SceneHash *hash, SingeError *error) {
    Scene bare = *scene; // a run with more frames or another preview may resume from the same checkpoint
    bare.frames = 1;
    bare.output = (SceneOutput){0};
    bare.gas_detail = 0;
    bare.checkpoints = (SceneCheckpoints){0};
    bool good = hash_scene(&bare, &hash->looks);

    bare.preview = (ScenePreview){0};
    if (good && hash_scene(&bare, &hash->result)) {
        hash->looks = hash_image(hash->looks, &assets->sky);
        hash->result = hash_files(hash->result, assets);
        return SINGE_OK;
    }

    return refuse(error, SINGE_ERROR_MEMORY, "checkpoint", -1, "out of memory");
}

/// The result's hash with the frames of moving meshes up to there; a longer run has more of them. Unchanged if there
/// are none.
static uint64_t hash_so_far(uint64_t hash, const SceneAssets *assets, Progress progress) {
    const uint32_t frames = (uint32_t)progress.frame + (progress.step > 0);
    for (uint32_t i = 0; i < assets->collider_count; i++)
        hash = hash_sequence(hash, &assets->collider_motions[i], frames);
    for (uint32_t i = 0; i < assets->pin_count; i++) hash = hash_sequence(hash, &assets->pin_motions[i], frames);
    return hash;
}

SingeResult checkpoint_take(SingeSim *sim, CheckpointBytes *taken, SingeError *error) {
    SingeResult result = singe_sim_save(sim, &taken->bytes, &taken->size);
    if (result) {
        *taken = (CheckpointBytes){0};
        *error = *singe_sim_error(sim);
    }
    return result;
}

void checkpoint_drop(SingeSim *sim, CheckpointBytes *taken) {
    if (taken->bytes) singe_sim_free_bytes(sim, taken->bytes, taken->size);
    *taken = (CheckpointBytes){0};
}

SingeResult checkpoint_write(const Folder *folder, SingeSim *sim, SingeAllocator allocator, CheckpointBytes *taken,
                             Progress progress, SceneHash hash, const SceneAssets *assets, const Totals *totals,
                             SingeError *error) {
    hash.result = hash_so_far(hash.result, assets, progress);
    size_t size = taken->size;
    uint8_t *grown = allocator.resize(allocator.context, taken->bytes, size, size + sizeof(Trailer));
    if (!grown) {
        checkpoint_drop(sim, taken);
        return refuse(error, SINGE_ERROR_MEMORY, "checkpoint", -1, "out of memory");
    }

    Trailer trailer = {.snapshot_size = size,
                       .hash = hash,
                       .frame = (uint64_t)progress.frame,
                       .step = (uint64_t)progress.step,
                       .totals = *totals};
    memcpy(trailer.magic, checkpoint_magic, sizeof trailer.magic);
    trailer.checksum = hash_bytes(hash_bytes(hash_start, grown, size), &trailer, offsetof(Trailer, checksum));
    memcpy(grown + size, &trailer, sizeof trailer);

    SingeResult result =
        file_write_backup(folder->checkpoint, folder->previous_checkpoint, grown, size + sizeof trailer, error);

    // freed with its own size: the library counts its allocations
    uint8_t *shrunk = allocator.resize(allocator.context, grown, size + sizeof trailer, size);
    taken->bytes = shrunk ? shrunk : grown;
    checkpoint_drop(sim, taken);
    return result;
}

static SingeResult checkpoint_refuse(const char *path, SingeResult code, const char *why, SingeError *error) {
    return refuse(error, code, "resume", -1, "%.150s: %.180s", path, why);
}

static SingeResult read_trailer(const char *path, const Bytes *bytes, SceneHash hash, const SceneAssets *assets,
                                Trailer *trailer, SingeError *error) {
    if (bytes->size < sizeof *trailer)
        return checkpoint_refuse(path, SINGE_ERROR_FORMAT, "the checkpoint is truncated", error);

    size_t size = bytes->size - sizeof *trailer;
    memcpy(trailer, bytes->data + size, sizeof *trailer);
    if (memcmp(trailer->magic, checkpoint_magic, sizeof trailer->magic) != 0 || trailer->snapshot_size != size)
        return checkpoint_refuse(path, SINGE_ERROR_FORMAT, "not a checkpoint of this version, or truncated", error);

    uint64_t checksum = hash_bytes(hash_bytes(hash_start, bytes->data, size), trailer, offsetof(Trailer, checksum));
    if (checksum != trailer->checksum || trailer->frame < 1 || trailer->frame > INT_MAX || trailer->step > INT_MAX)
        return checkpoint_refuse(path, SINGE_ERROR_FORMAT, "the checkpoint is damaged (its checksum differs)", error);

    const Progress progress = {(int)trailer->frame, (int)trailer->step};
    if (trailer->hash.result != hash_so_far(hash.result, assets, progress))
        return checkpoint_refuse(
            path, SINGE_ERROR_STATE,
            "the checkpoint belongs to another scene (the scene, its --set or a file it names has changed)", error);

    return SINGE_OK;
}

bool checkpoint_peek(const char *path, Progress *progress) {
    Trailer trailer;
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    struct stat info;
    bool good = file >= 0 && fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > (off_t)sizeof trailer;
    good = good && pread(file, &trailer, sizeof trailer, info.st_size - (off_t)sizeof trailer) == sizeof trailer &&
           memcmp(trailer.magic, checkpoint_magic, sizeof trailer.magic) == 0 && trailer.frame >= 1 &&
           trailer.frame <= INT_MAX && trailer.step <= INT_MAX;
    if (file >= 0) close(file);
    if (good) *progress = (Progress){(int)trailer.frame, (int)trailer.step};

    return good;
}

SingeResult checkpoint_read_file(const char *path, const SingeSimDef *hooks, SceneHash hash, const SceneAssets *assets,
                                 Checkpoint *checkpoint, SingeError *error) {
    Bytes bytes = {0};
    TRY(file_read(path, (SingeAllocator){0}, &bytes, error));

    Trailer trailer;
    SingeResult result = read_trailer(path, &bytes, hash, assets, &trailer, error);
    if (!result) {
        SingeError inner = {0};
        uint32_t sheet;
        result = singe_sim_load(hooks, bytes.data, (size_t)trailer.snapshot_size, &checkpoint->sim, &inner);
        if (!result) result = scene_bind_meshes(assets, checkpoint->sim, &sheet, &inner);

        if (result) {
            singe_sim_destroy(checkpoint->sim);
            checkpoint->sim = NULL;
        }

        if (result)
            checkpoint_refuse(path, result, inner.message[0] ? inner.message : singe_result_name(result), error);
        else checkpoint->progress = (Progress){(int)trailer.frame, (int)trailer.step};
        checkpoint->totals = trailer.totals;
        checkpoint->other_looks = trailer.hash.looks != hash.looks;
    }

    bytes_free(&bytes);
    return result;
}

static bool is_there(const char *path) { return access(path, F_OK) == 0 || errno != ENOENT; }

SingeResult checkpoint_read(const Folder *folder, const SingeSimDef *hooks, SceneHash hash, const SceneAssets *assets,
                            Checkpoint *checkpoint, SingeError *error) {
    const bool last = is_there(folder->checkpoint), before = is_there(folder->previous_checkpoint);
    *checkpoint = (Checkpoint){0};
    if (!last && !before) return SINGE_OK;
    if (last) {
        SingeResult result = checkpoint_read_file(folder->checkpoint, hooks, hash, assets, checkpoint, error);
        // the previous one would be of another scene, too, or need the same memory
        if (!result || !before || result == SINGE_ERROR_STATE || result == SINGE_ERROR_MEMORY) return result;
    }

    const SingeError refused = last ? *error : (SingeError){0};
    *checkpoint = (Checkpoint){.previous = true, .refused = refused};
    SingeResult result = checkpoint_read_file(folder->previous_checkpoint, hooks, hash, assets, checkpoint, error);
    if (result && last) *error = refused;
    return result && last ? refused.code : result;
}

SingeResult checkpoint_promote(const Folder *folder, SingeError *error) {
    if (rename(folder->previous_checkpoint, folder->checkpoint) == 0) return SINGE_OK;
    return folder_fail(folder->checkpoint, "replace", errno, error);
}

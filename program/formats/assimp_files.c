#include "formats/assimp_files.h"

#include "formats/path_inside.h"
#include "common/store.h"

#include <stdlib.h>
#include <string.h>

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

static bool open_beside(Source *source, const char *path, Opened *opened) {
    if (!path_is_inside(source->name, path)) {
        note_refused(source, "; it refers to something that is not a file in its folder or below");
        return false;
    }
    if (file_read(path, (SingeAllocator){0}, &opened->own, NULL)) {
        note_refused(source, "; it refers to a file that cannot be read");
        return false;
    }
    opened->bytes = opened->own.data;
    opened->size = opened->own.size;
    source->beside_size += opened->size;
    return true;
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
    } else good = good && open_beside(source, name, opened);
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

struct aiFileIO assimp_files(Source *source) {
    return (struct aiFileIO){source_open, source_close, (void *)source};
}

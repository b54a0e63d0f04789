// STL: triangles, each with its own three vertices, in text or binary. Their normals, names and the two bytes after
// each binary triangle are ignored.
#include "common/store.h"
#include "formats/lines.h"
#include "formats/mesh_reader.h"
#include "formats/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

enum { HEAD = 84, TRIANGLE = 50 }; // bytes of a binary file: 80 of anything, the count; a normal, three points, 2 more

/// A position in the text, with the context of error messages.
typedef struct Stl {
    const char *name;
    const uint8_t *begin; ///< of the file
    Text text;
    SingeError *error;
} Stl;

/// Fails at the cursor's line.
SINGE_PRINTF(2, 3)
static SingeResult stl_refuse(const Stl *stl, const char *format, ...) {
    char what[320];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return refuse(stl->error, SINGE_ERROR_FORMAT, "stl", stl->text.line, "%s:%lld: %s", short_name(stl->name),
                  (long long)stl->text.line, what);
}

/// Allocates the arrays for so many triangles and fills all but the positions.
static SingeResult stl_arrays(Polygons *mesh, const char *name, size_t count, SingeError *error) {
    SingeAllocator a = mesh->allocator;
    mesh->vertex_count = mesh->corner_count = (uint32_t)(3 * count);
    mesh->face_count = (uint32_t)count;
    mesh->first = store_new(a, count + 1, sizeof *mesh->first);
    mesh->corners = store_new(a, 3 * count, sizeof *mesh->corners);
    if (!mesh->first || !mesh->corners) return refuse_memory(error, "stl", name);

    for (uint32_t f = 0; f <= count; f++) mesh->first[f] = 3 * f;
    for (uint32_t i = 0; i < 3 * count; i++) mesh->corners[i] = i;
    return SINGE_OK;
}

static SingeResult stl_read_bytes(const char *name, const uint8_t *bytes, size_t size, Polygons *mesh,
                                  SingeError *error) {
    if (size < HEAD)
        return refuse(error, SINGE_ERROR_FORMAT, "stl", 0, "%s: not an STL file: %llu bytes are too few",
                      short_name(name), (unsigned long long)size);

    uint64_t count = load_u32_little(bytes + 80), needed = HEAD + TRIANGLE * count;
    if (size != needed)
        return refuse(error, SINGE_ERROR_FORMAT, "stl", 80,
                      "%s: byte 80: the file's length does not match its number of triangles", short_name(name));
    if (count == 0) return refuse(error, SINGE_ERROR_FORMAT, "stl", 80, "%s: has no faces", short_name(name));

    mesh->positions = store_new(mesh->allocator, 9 * (size_t)count, sizeof *mesh->positions);
    mesh->vertex_count = (uint32_t)(3 * count);
    if (!mesh->positions) return refuse_memory(error, "stl", name);

    for (size_t f = 0; f < count; f++)
        for (size_t i = 0; i < 9; i++) {
            size_t at = HEAD + TRIANGLE * f + 12 + 4 * i;
            uint32_t bits = load_u32_little(bytes + at);
            float *value = &mesh->positions[9 * f + i];
            memcpy(value, &bits, sizeof *value);
            if (!isfinite(*value))
                return refuse(error, SINGE_ERROR_FORMAT, "stl", (int64_t)at, "%s: byte %llu: a position is not finite",
                              short_name(name), (unsigned long long)at);
        }

    return stl_arrays(mesh, name, (size_t)count, error);
}

// ---- text

/// Moves past blanks and line ends. False at the end of the file.
static bool stl_to_word(Stl *stl) {
    Text *text = &stl->text;
    for (text_skip_blanks(text); text->at < text->end; text_skip_blanks(text)) {
        if (!text_is_end(*text->at)) return true;
        text_next_line(text);
    }
    return false;
}

/// If the next word is this one, in any case, moves past it and returns true.
static bool stl_word(Stl *stl, const char *word) {
    if (!stl_to_word(stl)) return false;
    const uint8_t *at = stl->text.at, *end = text_word_end(&stl->text);
    for (; at < end && *word; at++, word++)
        if ((*at >= 'A' && *at <= 'Z' ? *at + 32 : *at) != *word) return false;
    if (at != end || *word) return false;
    stl->text.at = end;
    return true;
}

static SingeResult stl_expect(Stl *stl, const char *first, const char *second) {
    if (stl_word(stl, first) && (!second || stl_word(stl, second))) return SINGE_OK;
    return stl_refuse(stl, "\"%s%s%s\" is missing", first, second ? " " : "", second ? second : "");
}

static SingeResult stl_solids(Stl *stl, Polygons *mesh, size_t *vertices, size_t *capacity) {
    while (stl_to_word(stl)) {
        TRY(stl_expect(stl, "solid", NULL));
        text_next_line(&stl->text);
        while (stl_word(stl, "facet")) {
            if (!store_grow(mesh->allocator, &mesh->positions, capacity, *vertices + 3, 3 * sizeof *mesh->positions))
                return refuse_memory(stl->error, "stl", stl->name);

            TRY(stl_expect(stl, "normal", NULL));
            text_next_line(&stl->text); // the normal is often not a number
            TRY(stl_expect(stl, "outer", "loop"));

            for (size_t v = 0; v < 3; v++) {
                TRY(stl_expect(stl, "vertex", NULL));
                for (size_t i = 0; i < 3; i++) {
                    text_skip_blanks(&stl->text);
                    const uint8_t *at = stl->text.at, *end = text_word_end(&stl->text);
                    NumberStatus status = number_float(&at, end, &(mesh->positions + 3 * *vertices)[3 * v + i]);

                    // messages give the position of a word that is no number, not the word: whoever sees them may
                    // not be allowed to read the file
                    if (stl->text.at == end) return stl_refuse(stl, "the line has too few values");
                    if (status || at != end)
                        return stl_refuse(stl, "the value in column %lld is %s",
                                          (long long)text_column(&stl->text, stl->begin),
                                          status == NUMBER_NOT_FINITE ? "not a finite number"
                                          : status == NUMBER_RANGE    ? "out of range"
                                                                      : "not a number");
                    stl->text.at = at;
                }
            }

            TRY(stl_expect(stl, "endloop", NULL));
            TRY(stl_expect(stl, "endfacet", NULL));

            *vertices += 3;
        }

        TRY(stl_expect(stl, "endsolid", NULL));
        text_next_line(&stl->text);
    }

    return *vertices ? SINGE_OK : stl_refuse(stl, "the file has no faces");
}

SingeResult stl_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Polygons *mesh,
                     SingeError *error) {
    memset(mesh, 0, sizeof *mesh);
    mesh->allocator = allocator;
    Stl stl = {name, bytes, {bytes, bytes + size, 1}, error}, ahead = stl;
    if (size == 0) return stl_refuse(&stl, "the file is empty");
    if (size > MESH_COUNT_LIMIT)
        return refuse(error, SINGE_ERROR_LIMIT, "stl", -1, "%s: the file is too large", short_name(name));

    // binary files may begin with "solid", too: their size decides
    bool binary = size >= HEAD && size == HEAD + TRIANGLE * (uint64_t)load_u32_little(bytes + 80);
    SingeResult result;

    if (binary || !stl_word(&ahead, "solid")) {
        result = stl_read_bytes(name, bytes, size, mesh, error);
    } else {
        size_t vertices = 0, capacity = 0;
        result = stl_solids(&stl, mesh, &vertices, &capacity);
        if (!result && !store_trim(allocator, &mesh->positions, &capacity, vertices, 3 * sizeof *mesh->positions))
            result = refuse_memory(error, "stl", name);
        mesh->vertex_count = (uint32_t)capacity; // for polygons_free
        if (!result) result = stl_arrays(mesh, name, vertices / 3, error);
    }

    if (result) polygons_free(mesh);
    return result;
}

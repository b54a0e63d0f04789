// The PLY files of a cache: a header in text, then vertices of 4-byte values, then triangles.
#include "cache.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { COLUMNS_MAX = 64, COUNT_MAX = 100000000 };

/// Properties that are drawn, and where they lie in a row.
static const char *const wanted[] = {"x",    "y", "z", "nx", "ny", "nz", "s", "t", "temperature", "temperature_peak",
                                     "burnt"};
enum { WANTED = sizeof wanted / sizeof *wanted };

static bool fail(char *why, size_t size, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(why, size, format, list);
    va_end(list);
    return false;
}

/// Room for `count` elements of a size, as much as before or more.
static bool grow(void **block, size_t *room, size_t count, size_t size) {
    if (count <= *room) return true;
    void *made = realloc(*block, count * size);
    if (!made) return false;
    *block = made;
    *room = count;
    return true;
}

/// The file's path: the last run of # becomes the number, of as many digits or more.
static bool cache_path(const char *pattern, int64_t number, char *path, size_t size) {
    const char *file = strrchr(pattern, '/'), *run = strchr(file ? file : pattern, '#');
    if (!run) return false;
    const int digits = (int)strspn(run, "#");
    return snprintf(path, size, "%.*s%0*lld%s", (int)(run - pattern), pattern, digits, (long long)number,
                    run + digits) < (int)size;
}

static bool cache_load(const char *path, CacheFrame *frame, size_t *size, char *why, size_t why_size) {
    struct stat found; // a pipe would halt the game
    const bool plain = stat(path, &found) == 0 && S_ISREG(found.st_mode);
    FILE *file = plain ? fopen(path, "rb") : NULL;
    if (!file) return fail(why, why_size, "%s: cannot read", path);
    bool good = !fseek(file, 0, SEEK_END);
    const long length = good ? ftell(file) : -1;
    good = length > 0 && !fseek(file, 0, SEEK_SET) &&
           grow((void **)&frame->bytes, &frame->byte_room, (size_t)length + 1, 1) &&
           fread(frame->bytes, 1, (size_t)length, file) == (size_t)length;
    fclose(file);
    if (!good) return fail(why, why_size, "%s: cannot read", path);
    frame->bytes[length] = 0;
    *size = (size_t)length;
    return true;
}

typedef struct Header {
    const uint8_t *body;
    long long vertices, faces;
    int columns, at[WANTED]; ///< of a row; -1: not there
} Header;

/// Reads the header, line by line.
static bool cache_header(const uint8_t *bytes, size_t size, Header *header) {
    static const char begin[] = "ply\nformat binary_little_endian 1.0\n", end[] = "end_header\n";
    *header = (Header){.vertices = -1, .faces = -1};
    for (int i = 0; i < WANTED; i++) header->at[i] = -1;
    if (size < sizeof begin || memcmp(bytes, begin, sizeof begin - 1) != 0) return false;
    const char *line = (const char *)bytes + sizeof begin - 1, *stop = (const char *)bytes + size;
    while (line < stop && strncmp(line, end, sizeof end - 1) != 0) {
        const char *next = memchr(line, '\n', (size_t)(stop - line));
        char kind[16] = "", name[32] = "";
        if (!next) return false;
        sscanf(line, "element vertex %lld", &header->vertices);
        sscanf(line, "element face %lld", &header->faces);
        if (header->faces < 0 && sscanf(line, "property %15s %31s", kind, name) == 2) {
            if (header->columns == COLUMNS_MAX || (strcmp(kind, "float") != 0 && strcmp(kind, "int") != 0))
                return false;
            for (int i = 0; i < WANTED; i++)
                if (!strcmp(name, wanted[i])) header->at[i] = header->columns;
            header->columns++;
        }
        line = next + 1;
    }
    header->body = (const uint8_t *)line + sizeof end - 1;
    return line < stop && header->vertices >= 0 && header->faces >= 0 && header->vertices <= COUNT_MAX &&
           header->faces <= COUNT_MAX && header->at[0] >= 0 && header->at[1] >= 0 && header->at[2] >= 0;
}

bool cache_read(const char *pattern, int64_t number, CacheFrame *frame, char *why, size_t why_size) {
    char path[1200];
    size_t size = 0;
    Header header;
    frame->vertex_count = frame->triangle_count = 0;
    if (!cache_path(pattern, number, path, sizeof path))
        return fail(why, why_size, "%s: expected a path with a run of # for the number", pattern);
    if (!cache_load(path, frame, &size, why, why_size)) return false;
    if (!cache_header(frame->bytes, size, &header)) return fail(why, why_size, "%s: not a frame of a cache", path);

    const size_t row = 4 * (size_t)header.columns, before = (size_t)(header.body - frame->bytes);
    const size_t rows = (size_t)header.vertices * row, faces = (size_t)header.faces * 13;
    if (size - before != rows + faces) return fail(why, why_size, "%s: %zu bytes too few or too many", path, size);
    if (!grow((void **)&frame->vertices, &frame->vertex_room, (size_t)header.vertices, sizeof *frame->vertices) ||
        !grow((void **)&frame->triangles, &frame->triangle_room, (size_t)header.faces, sizeof *frame->triangles))
        return fail(why, why_size, "%s: out of memory", path);
    for (size_t i = 0; i < (size_t)header.vertices; i++) {
        float value[WANTED] = {0};
        for (int c = 0; c < WANTED; c++) {
            if (header.at[c] >= 0) memcpy(&value[c], header.body + i * row + 4 * (size_t)header.at[c], 4);
            if (!isfinite(value[c]))
                return fail(why, why_size, "%s: vertex %zu has a %s that is not finite", path, i, wanted[c]);
        }
        // z up becomes y up
        frame->vertices[i] = (SheetVertex){{value[0], value[2], -value[1]},
                                           {value[3], value[5], -value[4]},
                                           {value[6], value[7]},
                                           value[8],
                                           value[9],
                                           value[10]};
    }
    for (size_t t = 0; t < (size_t)header.faces; t++) {
        const uint8_t *face = header.body + rows + 13 * t;
        memcpy(frame->triangles[t], face + 1, 12);
        for (int k = 0; k < 3; k++)
            if (face[0] != 3 || frame->triangles[t][k] >= (uint64_t)header.vertices)
                return fail(why, why_size, "%s: face %zu is no triangle of the vertices", path, t);
    }
    frame->vertex_count = header.vertices;
    frame->triangle_count = header.faces;
    return true;
}

void cache_free(CacheFrame *frame) {
    free(frame->vertices);
    free(frame->triangles);
    free(frame->bytes);
    *frame = (CacheFrame){0};
}

void cache_vertex(const void *frame, int64_t i, SheetVertex *vertex) {
    *vertex = ((const CacheFrame *)frame)->vertices[i];
}

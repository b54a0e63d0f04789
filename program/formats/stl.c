// STL: triangles, each with its own three vertices, in text or binary. Their normals, names and the two bytes after
// each binary triangle are ignored.
#include "formats/mesh_reader.h"
#include "formats/scan.h"
#include "common/store.h"

#include <math.h>

enum { HEAD = 84, TRIANGLE = 50 }; // bytes of a binary file: 80 of anything, the count; a normal, three points, 2 more

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

// ---- bytes

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

/// If the word at the cursor is this one, in any case, moves past it and returns true.
static bool stl_word(Scan *scan, const char *word) {
    if (!scan_to_word(scan, 0)) return false;
    const uint8_t *at = scan->text.at, *end = text_word_end(&scan->text);
    for (; at < end && *word; at++, word++)
        if ((*at >= 'A' && *at <= 'Z' ? *at + 32 : *at) != *word) return false;
    if (at != end || *word) return false;
    scan->text.at = end;
    return true;
}

static SingeResult stl_expect(Scan *scan, const char *first, const char *second) {
    if (stl_word(scan, first) && (!second || stl_word(scan, second))) return SINGE_OK;
    return scan_refuse(scan, SINGE_ERROR_FORMAT, "\"%s%s%s\" is missing", first, second ? " " : "",
                       second ? second : "");
}

// facet normal x y z / outer loop / vertex x y z, three times / endloop / endfacet, after the word "facet"
static SingeResult stl_facet(Scan *scan, float position[9]) {
    TRY(stl_expect(scan, "normal", NULL));
    text_next_line(&scan->text); // the normal is often not a number
    TRY(stl_expect(scan, "outer", "loop"));
    for (size_t v = 0; v < 3; v++) {
        TRY(stl_expect(scan, "vertex", NULL));
        for (size_t i = 0; i < 3; i++) TRY(scan_float(scan, &position[3 * v + i]));
    }
    TRY(stl_expect(scan, "endloop", NULL));
    return stl_expect(scan, "endfacet", NULL);
}

static SingeResult stl_solids(Scan *scan, Polygons *mesh, size_t *vertices, size_t *capacity) {
    while (scan_to_word(scan, 0)) {
        TRY(stl_expect(scan, "solid", NULL));
        text_next_line(&scan->text);
        while (stl_word(scan, "facet")) {
            if (!store_grow(scan->allocator, &mesh->positions, capacity, *vertices + 3, 3 * sizeof *mesh->positions))
                return refuse_memory(scan->error, "stl", scan->name);
            TRY(stl_facet(scan, mesh->positions + 3 * *vertices));
            *vertices += 3;
        }
        TRY(stl_expect(scan, "endsolid", NULL));
        text_next_line(&scan->text);
    }
    return *vertices ? SINGE_OK : scan_refuse(scan, SINGE_ERROR_FORMAT, "the file has no faces");
}

static SingeResult stl_read_text(Scan *scan, Polygons *mesh) {
    size_t vertices = 0, capacity = 0;
    SingeResult result = stl_solids(scan, mesh, &vertices, &capacity);
    if (!result && !store_trim(scan->allocator, &mesh->positions, &capacity, vertices, 3 * sizeof *mesh->positions))
        result = refuse_memory(scan->error, "stl", scan->name);
    mesh->vertex_count = (uint32_t)capacity; // for polygons_free
    return result ? result : stl_arrays(mesh, scan->name, vertices / 3, scan->error);
}

SingeResult stl_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Polygons *mesh,
                     SingeError *error) {
    memset(mesh, 0, sizeof *mesh);
    mesh->allocator = allocator;
    Scan scan = {name, "stl", bytes, {bytes, bytes + size, 1}, allocator, error}, ahead = scan;
    if (size == 0) return scan_refuse(&scan, SINGE_ERROR_FORMAT, "the file is empty");
    if (size > MESH_COUNT_LIMIT) return scan_refuse(&scan, SINGE_ERROR_LIMIT, "the file is too large");
    // binary files may begin with "solid", too: their size decides
    bool binary = size >= HEAD && size == HEAD + TRIANGLE * (uint64_t)load_u32_little(bytes + 80);
    SingeResult result = !binary && stl_word(&ahead, "solid") ? stl_read_text(&scan, mesh)
                                                              : stl_read_bytes(name, bytes, size, mesh, error);
    if (result) polygons_free(mesh);
    return result;
}

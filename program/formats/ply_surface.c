// The cache: a surface as a binary little-endian PLY file, one table for the writer and the reader.
#include "formats/number.h"
#include "formats/output.h"
#include "formats/ply.h"
#include "common/store.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

enum { FACE_SIZE = 1 + 3 * 4, HEADER_LIMIT = 2048 };

static size_t column_count(const SingeSurface *surface) {
    return SURFACE_VECTORS + (size_t)surface_field_count(surface->wet);
}

/// Allocates the arrays. False when out of memory; those before it are there.
static bool surface_arrays(SingeSurface *surface) {
    surface->vertex_capacity = surface->vertex_count ? surface->vertex_count : 1;
    surface->triangle_capacity = surface->triangle_count ? surface->triangle_count : 1;
    for (size_t i = 0; i < column_count(surface); i++) {
        if (surface_columns[i].index) continue;
        void *array = store_new(surface->allocator, surface->vertex_capacity, 4 * (size_t)surface_columns[i].width);
        memcpy((uint8_t *)surface + surface_columns[i].array, &array, sizeof array);
        if (!array) return false;
    }

    surface->triangles = store_new(surface->allocator, surface->triangle_capacity, sizeof *surface->triangles);
    return surface->triangles;
}

bool surface_new(SingeSurface *surface, uint32_t vertices, uint32_t triangles) {
    *surface = (SingeSurface){.vertex_count = vertices, .triangle_count = triangles};
    if (!surface_arrays(surface)) {
        singe_surface_free(surface);
        return false;
    }

    for (size_t i = 0; i < column_count(surface); i++)
        if (!surface_columns[i].index)
            memset(surface_field(surface, &surface_columns[i]), 0,
                   4 * (size_t)surface_columns[i].width * surface->vertex_capacity);
    memset(surface->triangles, 0, surface->triangle_capacity * sizeof *surface->triangles);
    return true;
}

// Bytes after the header.
static uint64_t surface_data_size(const SingeSurface *surface) {
    return 4 * (uint64_t)column_count(surface) * surface->vertex_count + (uint64_t)FACE_SIZE * surface->triangle_count;
}

uint64_t ply_surface_size(const SingeSurface *surface) { return HEADER_LIMIT / 2 + surface_data_size(surface); }

// ---- writing

SingeResult ply_write_surface(const char *path, const SingeSurface *surface, double time, SingeError *error) {
    if (!isfinite(time))
        return refuse(error, SINGE_ERROR_ARGUMENT, "cache", -1, "%s: the time is not finite", short_name(path));
    if (surface->vertex_count > MESH_COUNT_LIMIT || surface->triangle_count > MESH_COUNT_LIMIT)
        return refuse(error, SINGE_ERROR_LIMIT, "cache", -1, "%s: too many vertices or triangles", short_name(path));

    uint64_t max = HEADER_LIMIT + surface_data_size(surface);
    if (max > SIZE_MAX / 2) return refuse_memory(error, "cache", path);

    uint8_t *bytes = store_new(surface->allocator, (size_t)max, 1);
    if (!bytes) return refuse_memory(error, "cache", path);

    char number[40], *text = (char *)bytes;
    number_print(time, number);
    size_t n = (size_t)snprintf(text, HEADER_LIMIT,
                                "ply\nformat binary_little_endian 1.0\ncomment singe %s time %s\nelement vertex %u\n",
                                SINGE_VERSION, number, surface->vertex_count);

    const size_t count = column_count(surface);
    for (size_t i = 0; i < count; i++)
        n += (size_t)snprintf(text + n, HEADER_LIMIT - n, "property %s %s\n",
                              surface_columns[i].integer ? "int" : "float", surface_columns[i].name);
    n += (size_t)snprintf(text + n, HEADER_LIMIT - n,
                          "element face %u\nproperty list uchar int vertex_indices\nend_header\n",
                          surface->triangle_count);

    uint8_t *out = bytes + n;
    const uint8_t *source[SURFACE_COLUMNS];
    for (size_t i = 0; i < count; i++)
        source[i] = surface->vertex_count
                        ? (uint8_t *)surface_field(surface, &surface_columns[i]) + 4 * surface_columns[i].index
                        : NULL;

    for (uint32_t v = 0; v < surface->vertex_count; v++)
        for (size_t i = 0; i < count; i++, out += 4) {
            uint32_t bits;
            memcpy(&bits, source[i], sizeof bits);
            source[i] += 4 * surface_columns[i].width;
            store_u32_little(out, bits);
        }

    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        *out++ = 3;
        for (int k = 0; k < 3; k++, out += 4) store_u32_little(out, surface->triangles[f][k]);
    }

    SingeResult result = file_write(path, bytes, (size_t)(out - bytes), error);
    store_free(surface->allocator, bytes, (size_t)max, 1);
    return result;
}

// ---- reading

static SingeResult surface_check_header(const Ply *ply, SingeSurface *surface, double *time) {
    const PlyHeader *header = &ply->header;

    // "singe VERSION time SECONDS"
    const uint8_t *note = header->note, *end = header->note_end;
    while (note && end - note > 6 && memcmp(note, " time ", 6) != 0) note++;
    bool timed = note && end - note > 6;
    if (timed) note += 6;
    if (!timed || number_double(&note, end, time) != NUMBER_OK || note != end)
        return ply_refuse(ply, SINGE_ERROR_FORMAT,
                          "not a cache of Singe: the header has no \"comment singe ... time ...\"");

    // the columns, and triangles
    const PlyElement *vertices = ply_element(ply, "vertex"), *faces = ply_element(ply, "face");
    bool fits = header->format == PLY_LITTLE && header->element_count == 2 && vertices == &header->elements[0] &&
                faces && faces->property_count == 1;
    surface->wet = fits && vertices->property_count == SURFACE_COLUMNS;
    const size_t count = column_count(surface);
    fits = fits && vertices->property_count == count;

    for (size_t i = 0; fits && i < count; i++) {
        const PlyProperty *property = &header->properties[vertices->first_property + i];
        fits = !property->is_list && property->type == (surface_columns[i].integer ? PLY_INT32 : PLY_FLOAT32) &&
               text_word_is(property->name, property->name_end, surface_columns[i].name);
    }

    const PlyProperty *list = fits ? &header->properties[faces->first_property] : NULL;
    if (!list || !list->is_list || list->count_type != PLY_UINT8 || list->type != PLY_INT32 ||
        !text_word_is(list->name, list->name_end, "vertex_indices"))
        return ply_refuse(ply, SINGE_ERROR_FORMAT,
                          "not a cache of this version of Singe: unexpected elements or properties");

    surface->vertex_count = vertices->count;
    surface->triangle_count = faces->count;
    uint64_t expected = surface_data_size(surface);
    uint64_t actual = (uint64_t)(ply->text.end - ply->text.at);
    if (actual != expected)
        return ply_refuse(ply, SINGE_ERROR_FORMAT, "the file has %llu bytes of data where its counts need %llu",
                          (unsigned long long)actual, (unsigned long long)expected);

    return SINGE_OK;
}

static SingeResult surface_unpack(Ply *ply, SingeSurface *surface) {
    uint8_t *target[SURFACE_COLUMNS];
    const size_t count = column_count(surface);
    for (size_t i = 0; i < count; i++)
        target[i] = (uint8_t *)surface_field(surface, &surface_columns[i]) + 4 * surface_columns[i].index;

    for (uint32_t v = 0; v < surface->vertex_count; v++)
        for (size_t i = 0; i < count; i++, ply->text.at += 4) {
            uint32_t bits = load_u32_little(ply->text.at);
            if (!surface_columns[i].integer && (bits & 0x7f800000) == 0x7f800000)
                return ply_refuse(ply, SINGE_ERROR_FORMAT, "%s of vertex %u is not a finite number",
                                  surface_columns[i].name, v);
            memcpy(target[i], &bits, sizeof bits);
            target[i] += 4 * surface_columns[i].width;
        }

    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        if (*ply->text.at != 3)
            return ply_refuse(ply, SINGE_ERROR_MESH, "face %u has %d corners where a cache has 3", f, *ply->text.at);

        ply->text.at++;
        for (int k = 0; k < 3; k++, ply->text.at += 4) {
            uint32_t index = load_u32_little(ply->text.at);
            if (index >= surface->vertex_count)
                return ply_refuse(ply, SINGE_ERROR_MESH, "vertex index %u of face %u is out of range", index, f);
            surface->triangles[f][k] = index;
        }
    }

    return SINGE_OK;
}

SingeResult ply_read_surface(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                             SingeSurface *surface, double *time, SingeError *error) {
    memset(surface, 0, sizeof *surface);
    if (size == 0) return refuse(error, SINGE_ERROR_FORMAT, "ply", 1, "%s: is empty", short_name(name));

    Ply ply = {.name = name, .begin = bytes, .text = {bytes, bytes + size, 1}, .allocator = allocator, .error = error};
    double seconds = 0;
    SingeResult result = ply_read_header(&ply);
    if (!result) result = surface_check_header(&ply, surface, &seconds);

    surface->allocator = allocator;
    if (!result && !surface_arrays(surface)) result = refuse_memory(error, "ply", name);
    if (!result) result = surface_unpack(&ply, surface);
    ply_header_free(&ply);
    if (result) singe_surface_free(surface);
    if (!result && time) *time = seconds;
    return result;
}

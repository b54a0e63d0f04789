#include "analysis/cache.h"

#include <math.h>
#include <stdlib.h>

#include "formats/number.h"
#include "formats/ply.h"
#include "common/store.h"

enum { FACE_SIZE = 1 + 3 * 4 };

float cache_value(const CacheFrame *frame, int column, uint32_t vertex) {
    float value = 0;
    if (!frame->there[column]) return value;
    const uint32_t bits = load_u32_little(frame->rows + vertex * frame->row + frame->offset[column]);
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// Checks the header and finds the offsets of the promised properties in a vertex.
static SingeResult read_header(const Ply *ply, CacheFrame *frame) {
    const PlyElement *vertices = ply_element(ply, "vertex"), *faces = ply_element(ply, "face");
    if (ply->header.format != PLY_LITTLE || ply->header.element_count != 2 || !vertices || !faces || vertices > faces)
        return ply_refuse(ply, SINGE_ERROR_FORMAT, "not a cache: a binary_little_endian PLY of vertices and faces");

    const PlyProperty *list = &ply->header.properties[faces->first_property];
    if (faces->property_count != 1 || !list->is_list || list->count_type != PLY_UINT8 || list->type != PLY_INT32 ||
        !text_word_is(list->name, list->name_end, "vertex_indices"))
        return ply_refuse(ply, SINGE_ERROR_FORMAT, "not a cache: its faces are no \"list uchar int vertex_indices\"");
    frame->vertex_count = vertices->count;
    frame->triangle_count = faces->count;

    for (size_t i = 0; i < vertices->property_count; i++) {
        const PlyProperty *property = &ply->header.properties[vertices->first_property + i];
        if (property->is_list) return ply_refuse(ply, SINGE_ERROR_FORMAT, "a vertex of a cache has no lists");

        for (int c = 0; c < CACHE_COLUMNS; c++) {
            const PlyType type = surface_columns[c].integer ? PLY_INT32 : PLY_FLOAT32;
            if (property->type != type || !text_word_is(property->name, property->name_end, surface_columns[c].name))
                continue;
            frame->there[c] = true;
            frame->offset[c] = frame->row;
        }

        frame->row += ply_type_size(property->type);
    }

    for (int c = CACHE_X; c < CACHE_X + 3; c++)
        if (!frame->there[c])
            return ply_refuse(ply, SINGE_ERROR_FORMAT, "vertices have no property \"float %s\"",
                              surface_columns[c].name);

    frame->time = (double)NAN;
    const uint8_t *end = ply->header.note_end;
    for (const uint8_t *p = ply->header.note; p && end - p > 6; p++) {
        const uint8_t *number = p + 6;
        double time;
        if (memcmp(p, " time ", 6) != 0) continue;
        if (number_double(&number, end, &time) == NUMBER_OK && number == end) frame->time = time;
        break;
    }

    const uint64_t needed = (uint64_t)frame->row * vertices->count + (uint64_t)FACE_SIZE * faces->count;
    const uint64_t actual = (uint64_t)(ply->text.end - ply->text.at);
    if (actual == needed) return SINGE_OK;

    return ply_refuse(ply, SINGE_ERROR_FORMAT, "the file has %llu bytes of data where its counts need %llu",
                      (unsigned long long)actual, (unsigned long long)needed);
}

SingeResult cache_read(const char *path, CacheFrame *frame, SingeError *error) {
    *frame = (CacheFrame){0};
    TRY(file_read(path, (SingeAllocator){0}, &frame->bytes, error));
    const Bytes *bytes = &frame->bytes;
    Ply ply = {.name = path, .begin = bytes->data, .text = {bytes->data, bytes->data + bytes->size, 1}, .error = error};
    SingeResult result = ply_read_header(&ply);
    if (!result) result = read_header(&ply, frame);
    ply_header_free(&ply);
    if (result) return result;

    frame->position = malloc(((size_t)frame->vertex_count + 1) * sizeof *frame->position);
    frame->rest = malloc(((size_t)frame->vertex_count + 1) * sizeof *frame->rest);
    frame->triangles = malloc(((size_t)frame->triangle_count + 1) * sizeof *frame->triangles);
    if (!frame->position || !frame->rest || !frame->triangles) return refuse_memory(error, "ply", path);

    frame->rows = ply.text.at;
    for (uint32_t v = 0; v < frame->vertex_count; v++)
        for (int k = 0; k < 3; k++) {
            frame->position[v][k] = cache_value(frame, CACHE_X + k, v);
            frame->rest[v][k] = cache_value(frame, CACHE_REST + k, v);
        }

    ply.text.at += frame->row * frame->vertex_count;
    for (uint32_t f = 0; f < frame->triangle_count; f++) {
        if (*ply.text.at != 3)
            return ply_refuse(&ply, SINGE_ERROR_MESH, "face %u has %d corners where a cache has 3", f, *ply.text.at);
        ply.text.at++;
        for (int k = 0; k < 3; k++, ply.text.at += 4) frame->triangles[f][k] = load_u32_little(ply.text.at);
    }

    return SINGE_OK;
}

void cache_free(CacheFrame *frame) {
    bytes_free(&frame->bytes);
    free(frame->position);
    free(frame->rest);
    free(frame->triangles);
    *frame = (CacheFrame){0};
}

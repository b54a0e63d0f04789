// PLY meshes: ascii and binary of both byte orders. Elements other than "vertex" and "face", lists of a vertex and
// other properties of a face are ignored.
#include "formats/ply.h"

#include "common/store.h"
#include "formats/number.h"

#include <math.h>

// The target of a vertex property: every `stride`th float from `values`, times `scale`; NULL: ignored.
typedef struct PlyTarget {
    float *values;
    size_t stride;
    float scale;
} PlyTarget;

// ---- values

static SingeResult ply_ended(const Ply *ply) { return ply_refuse(ply, SINGE_ERROR_FORMAT, "the file ends too soon"); }

static SingeResult ply_value(Ply *ply, PlyType type, double *value) {
    if (ply->header.format == PLY_ASCII) {
        static const double min[] = {-128, 0, -32768, 0, -2147483648.0, 0};
        static const double max[] = {127, 255, 32767, 65535, 2147483647.0, 4294967295.0};
        Text *text = &ply->text;
        text_skip_blanks(text);
        const uint8_t *word = text->at, *end = text_word_end(text);
        if (word == end) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the line has too few values");

        float single = 0;
        NumberStatus status = number_float(&text->at, end, &single);
        *value = single;

        // an integer is read as one: a float would round it
        if (type < PLY_FLOAT32 && status == NUMBER_OK) {
            int64_t integer = 0;
            text->at = word;
            status = number_integer(&text->at, end, &integer);
            *value = (double)integer;
            if (status == NUMBER_OK && (*value < min[type] || *value > max[type])) status = NUMBER_RANGE;
        }

        if (status == NUMBER_OK && text->at == end) return SINGE_OK;
        text->at = word;
        return ply_refuse(ply, SINGE_ERROR_FORMAT, "the value in column %lld is %s",
                          (long long)text_column(text, ply->begin),
                          status == NUMBER_NOT_FINITE ? "not a finite number"
                          : status == NUMBER_RANGE    ? "out of range"
                          : type < PLY_FLOAT32        ? "not an integer"
                                                      : "not a number");
    }

    size_t size = ply_type_size(type);
    if ((size_t)(ply->text.end - ply->text.at) < size) return ply_ended(ply);

    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits |= (uint64_t)ply->text.at[i] << 8 * (ply->header.format == PLY_BIG ? size - 1 - i : i);

    float single;
    uint32_t low = (uint32_t)bits;
    switch (type) {
    case PLY_INT8: *value = (double)(bits & 0x7f) - (double)(bits & 0x80); break;
    case PLY_INT16: *value = (double)(bits & 0x7fff) - (double)(bits & 0x8000); break;
    case PLY_INT32: *value = (double)(bits & 0x7fffffff) - (double)(bits & 0x80000000); break;
    case PLY_FLOAT32:
        memcpy(&single, &low, sizeof single);
        *value = single;
        break;
    case PLY_FLOAT64: memcpy(value, &bits, sizeof *value); break;
    default: *value = (double)bits; break;
    }

    if (!isfinite(*value)) return ply_refuse(ply, SINGE_ERROR_FORMAT, "a value is not a finite number");
    ply->text.at += size;
    return SINGE_OK;
}

static SingeResult ply_list_length(Ply *ply, const PlyProperty *property, uint64_t *count) {
    double value;
    TRY(ply_value(ply, property->count_type, &value));
    if (value < 0) return ply_refuse(ply, SINGE_ERROR_FORMAT, "a list has a negative length");
    *count = (uint64_t)value;
    return SINGE_OK;
}

static SingeResult ply_skip_property(Ply *ply, const PlyProperty *property) {
    uint64_t count = 1;
    if (property->is_list) TRY(ply_list_length(ply, property, &count));

    Text *text = &ply->text;
    if (ply->header.format != PLY_ASCII) {
        if ((uint64_t)(text->end - text->at) / ply_type_size(property->type) < count) return ply_ended(ply);
        text->at += count * ply_type_size(property->type);
        return SINGE_OK;
    }

    for (; count; count--) {
        text_skip_blanks(text);
        if (text_at_line_end(text)) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the line has too few values");
        text->at = text_word_end(text);
    }

    return SINGE_OK;
}

// In text, an element has a line of its own.
static SingeResult ply_begin_row(Ply *ply) {
    if (ply->header.format != PLY_ASCII) return SINGE_OK;
    for (text_skip_blanks(&ply->text); text_at_line_end(&ply->text); text_skip_blanks(&ply->text)) {
        if (ply->text.at == ply->text.end) return ply_ended(ply);
        text_next_line(&ply->text);
    }
    return SINGE_OK;
}

static SingeResult ply_end_row(Ply *ply) {
    if (ply->header.format != PLY_ASCII) return SINGE_OK;
    text_skip_blanks(&ply->text);
    if (!text_at_line_end(&ply->text)) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the line has too many values");
    return SINGE_OK;
}

// ---- vertices

static const PlyProperty *ply_scalar(const Ply *ply, const PlyElement *element, const char *name, size_t *index) {
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *property = &ply->header.properties[element->first_property + i];
        if (property->is_list || !text_word_is(property->name, property->name_end, name)) continue;
        *index = i;
        return property;
    }

    return NULL;
}

// Any scalar other than position, uv and normal is an attribute.
static bool ply_is_attribute(const PlyProperty *property, const PlyTarget *target) {
    static const char *const normals[] = {"nx", "ny", "nz"};
    for (int i = 0; i < 3; i++)
        if (text_word_is(property->name, property->name_end, normals[i])) return false;
    return !property->is_list && !target->values;
}

static SingeResult ply_plan_vertices(Ply *ply, const PlyElement *element, Polygons *mesh, float **uv,
                                     PlyTarget *targets) {
    static const char *const axes[] = {"x", "y", "z"};
    static const char *const uvs[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
    size_t index, other;
    for (int i = 0; i < 3; i++) // before allocating: without properties a count needs no bytes in the file
        if (!ply_scalar(ply, element, axes[i], &index))
            return ply_refuse(ply, SINGE_ERROR_FORMAT, "vertices have no property \"%s\"", axes[i]);
    mesh->positions = store_new(ply->allocator, mesh->vertex_count, 3 * sizeof *mesh->positions);
    if (!mesh->positions) return refuse_memory(ply->error, "ply", ply->name);

    for (int i = 0; i < 3; i++) {
        ply_scalar(ply, element, axes[i], &index);
        targets[index] = (PlyTarget){mesh->positions + i, 3, 1};
    }

    for (int i = 0; i < 3 && !*uv; i++) {
        if (!ply_scalar(ply, element, uvs[i][0], &index) || !ply_scalar(ply, element, uvs[i][1], &other)) continue;
        *uv = store_new(ply->allocator, mesh->vertex_count, 2 * sizeof **uv);
        if (!*uv) return refuse_memory(ply->error, "ply", ply->name);
        targets[index] = (PlyTarget){*uv, 2, 1};
        targets[other] = (PlyTarget){*uv + 1, 2, 1};
    }

    const PlyProperty *properties = ply->header.properties + element->first_property;
    uint32_t count = 0;
    for (size_t i = 0; i < element->property_count; i++) count += ply_is_attribute(&properties[i], &targets[i]);
    if (count == 0) return SINGE_OK;

    mesh->attributes = store_new(ply->allocator, count, sizeof *mesh->attributes);
    if (!mesh->attributes) return refuse_memory(ply->error, "ply", ply->name);
    memset(mesh->attributes, 0, count * sizeof *mesh->attributes);
    mesh->attribute_count = count;

    SingeAttribute *next = mesh->attributes;
    for (size_t i = 0; i < element->property_count; i++)
        if (ply_is_attribute(&properties[i], &targets[i])) {
            static const char *const colours[] = {"red", "green", "blue", "alpha"};
            size_t length = (size_t)(properties[i].name_end - properties[i].name);
            char *name = store_new(ply->allocator, length + 1, 1);
            if (!name) return refuse_memory(ply->error, "ply", ply->name);
            memcpy(name, properties[i].name, length);
            name[length] = 0;
            next->name = name;
            float *values = store_new(ply->allocator, mesh->vertex_count, sizeof *values);
            if (!values) return refuse_memory(ply->error, "ply", ply->name);
            (next++)->values = values;
            targets[i] = (PlyTarget){values, 1, 1};

            // 8-bit colours map to 0 to 1, as everywhere else
            for (int k = 0; k < 4; k++)
                if (properties[i].type == PLY_UINT8 && strcmp(name, colours[k]) == 0) targets[i].scale = 1 / 255.0f;
        }

    return SINGE_OK;
}

static SingeResult ply_read_vertex(Ply *ply, const PlyElement *element, const PlyTarget *targets, size_t vertex) {
    TRY(ply_begin_row(ply));
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *property = &ply->header.properties[element->first_property + i];
        double value;

        if (!targets[i].values) {
            TRY(ply_skip_property(ply, property));
            continue;
        }

        TRY(ply_value(ply, property->type, &value));
        if (fabs(value) > 3.4028234663852886e38)
            return ply_refuse(ply, SINGE_ERROR_FORMAT, "a value is too large for a float");
        targets[i].values[targets[i].stride * vertex] = (float)value * targets[i].scale;
    }

    return ply_end_row(ply);
}

// ---- faces

/// The faces being read.
typedef struct PlyFaces {
    Polygons *mesh;
    const PlyProperty *corners, *uvs; ///< lists; uvs may be NULL
    size_t corner_capacity, uv_capacity;
} PlyFaces;

static bool ply_is_list(const PlyProperty *property, const char *name, const char *other) {
    return property->is_list && (text_word_is(property->name, property->name_end, name) ||
                                 text_word_is(property->name, property->name_end, other));
}

static SingeResult ply_read_face(Ply *ply, const PlyElement *element, PlyFaces *faces, uint32_t f) {
    const PlyProperty *properties = ply->header.properties + element->first_property;
    Polygons *mesh = faces->mesh;
    size_t uvs = 2 * (size_t)mesh->corner_count;
    mesh->first[f] = mesh->corner_count;
    TRY(ply_begin_row(ply));

    for (size_t i = 0; i < element->property_count; i++) {
        if (&properties[i] == faces->corners) {
            uint64_t count = 0;
            TRY(ply_list_length(ply, faces->corners, &count));
            if (count < 3)
                return ply_refuse(ply, SINGE_ERROR_MESH, "face has %llu corner%s; it needs three",
                                  (unsigned long long)count, count == 1 ? "" : "s");

            for (; count; count--) {
                double value;
                TRY(ply_value(ply, faces->corners->type, &value));
                if (value < 0 || value >= mesh->vertex_count)
                    return ply_refuse(ply, SINGE_ERROR_MESH,
                                      "vertex index %lld is out of range: the file has %u vertices", (long long)value,
                                      mesh->vertex_count);
                if (mesh->corner_count >= MESH_COUNT_LIMIT)
                    return ply_refuse(ply, SINGE_ERROR_LIMIT, "too many corners");
                if (!store_grow(ply->allocator, &mesh->corners, &faces->corner_capacity, (size_t)mesh->corner_count + 1,
                                sizeof *mesh->corners))
                    return refuse_memory(ply->error, "ply", ply->name);
                mesh->corners[mesh->corner_count++] = (uint32_t)value;
            }
        } else if (&properties[i] == faces->uvs) {
            // a list of u and v of each corner. It may precede the corners.
            uint64_t count = 0;
            TRY(ply_list_length(ply, faces->uvs, &count));
            for (; count; count--) {
                double value;
                TRY(ply_value(ply, faces->uvs->type, &value));
                if (fabs(value) > 3.4028234663852886e38)
                    return ply_refuse(ply, SINGE_ERROR_FORMAT, "a value is too large for a float");
                if (!store_grow(ply->allocator, &mesh->uv, &faces->uv_capacity, uvs + 1, sizeof *mesh->uv))
                    return refuse_memory(ply->error, "ply", ply->name);
                mesh->uv[uvs++] = (float)value;
            }
        } else TRY(ply_skip_property(ply, &properties[i]));
    }

    TRY(ply_end_row(ply));
    if (faces->uvs && uvs != 2 * (size_t)mesh->corner_count)
        return ply_refuse(ply, SINGE_ERROR_MESH, "a face needs u and v for each of its corners in \"texcoord\"");
    return SINGE_OK;
}

static SingeResult ply_read_faces(Ply *ply, const PlyElement *element, Polygons *mesh) {
    const PlyProperty *properties = ply->header.properties + element->first_property;
    PlyFaces faces = {.mesh = mesh};

    for (size_t i = 0; i < element->property_count; i++) {
        if (!faces.corners && ply_is_list(&properties[i], "vertex_indices", "vertex_index"))
            faces.corners = &properties[i];
        if (!faces.uvs && ply_is_list(&properties[i], "texcoord", "texcoord")) faces.uvs = &properties[i];
    }

    if (!faces.corners) return ply_refuse(ply, SINGE_ERROR_FORMAT, "faces have no list \"vertex_indices\"");
    if (faces.corners->type >= PLY_FLOAT32)
        return ply_refuse(ply, SINGE_ERROR_FORMAT, "vertex indices must have an integer type");
    mesh->first = store_new(ply->allocator, (size_t)mesh->face_count + 1, sizeof *mesh->first);
    if (!mesh->first) return refuse_memory(ply->error, "ply", ply->name);

    SingeResult result = SINGE_OK;
    for (uint32_t f = 0; f < element->count && !result; f++) result = ply_read_face(ply, element, &faces, f);

    bool trimmed = result || (store_trim(ply->allocator, &mesh->corners, &faces.corner_capacity, mesh->corner_count,
                                         sizeof *mesh->corners) &&
                              (!faces.uvs || store_trim(ply->allocator, &mesh->uv, &faces.uv_capacity,
                                                        2 * (size_t)mesh->corner_count, sizeof *mesh->uv)));
    if (!trimmed) result = refuse_memory(ply->error, "ply", ply->name);

    if (result) {
        // drops a partially read face
        store_free(ply->allocator, faces.mesh->corners, faces.corner_capacity, sizeof *faces.mesh->corners);
        store_free(ply->allocator, faces.mesh->uv, faces.uv_capacity, sizeof *faces.mesh->uv);
        faces.mesh->corners = NULL;
        faces.mesh->uv = NULL;
        faces.mesh->corner_count = 0;
    } else mesh->first[mesh->face_count] = mesh->corner_count;

    return result;
}

static SingeResult ply_read_body(Ply *ply, Polygons *mesh, float **uv) {
    const PlyElement *vertices = ply_element(ply, "vertex"), *faces = ply_element(ply, "face");
    if (!vertices || vertices->count == 0) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the file has no vertices");
    if (!faces || faces->count == 0) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the file has no faces");
    mesh->vertex_count = vertices->count;
    mesh->face_count = faces->count;

    for (size_t i = 0; i < ply->header.element_count; i++) {
        const PlyElement *element = &ply->header.elements[i];
        if (element == vertices) {
            PlyTarget *targets = store_new(ply->allocator, element->property_count, sizeof *targets);
            if (!targets) return refuse_memory(ply->error, "ply", ply->name);
            for (size_t k = 0; k < element->property_count; k++) targets[k] = (PlyTarget){0};
            SingeResult result = ply_plan_vertices(ply, element, mesh, uv, targets);
            for (uint32_t v = 0; !result && v < mesh->vertex_count; v++)
                result = ply_read_vertex(ply, element, targets, v);
            store_free(ply->allocator, targets, element->property_count, sizeof *targets);
            if (result) return result;
        } else if (element == faces) TRY(ply_read_faces(ply, element, mesh));

        for (uint32_t row = 0; element != vertices && element != faces && row < element->count; row++) {
            if (element->property_count == 0) break;
            TRY(ply_begin_row(ply));
            for (size_t k = 0; k < element->property_count; k++)
                TRY(ply_skip_property(ply, &ply->header.properties[element->first_property + k]));
            TRY(ply_end_row(ply));
        }
    }

    // uv of the vertices, if the corners have none of their own
    if (!*uv || mesh->uv) return SINGE_OK;
    mesh->uv = store_new(ply->allocator, mesh->corner_count, 2 * sizeof *mesh->uv);
    if (!mesh->uv) return refuse_memory(ply->error, "ply", ply->name);

    for (uint32_t i = 0; i < mesh->corner_count; i++)
        for (size_t k = 0; k < 2; k++) mesh->uv[2 * (size_t)i + k] = (*uv)[2 * (size_t)mesh->corners[i] + k];
    return SINGE_OK;
}

SingeResult ply_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Polygons *mesh,
                     SingeError *error) {
    memset(mesh, 0, sizeof *mesh);
    mesh->allocator = allocator;
    if (size == 0) return refuse(error, SINGE_ERROR_FORMAT, "ply", 1, "%s: is empty", short_name(name));

    Ply ply = {.name = name, .begin = bytes, .text = {bytes, bytes + size, 1}, .allocator = allocator, .error = error};
    SingeResult result = ply_read_header(&ply);
    float *uv = NULL; // of the vertices
    if (!result) result = ply_read_body(&ply, mesh, &uv);
    store_free(allocator, uv, mesh->vertex_count, 2 * sizeof *uv);
    ply_header_free(&ply);
    if (result) polygons_free(mesh);
    return result;
}

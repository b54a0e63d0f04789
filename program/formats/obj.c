// Wavefront OBJ: v, vt and f; everything about appearance and groups is ignored.
#include "formats/mesh_reader.h"
#include "formats/number.h"
#include "common/store.h"
#include "formats/lines.h"

#include <string.h>

typedef struct ObjCorner {
    int32_t vertex, uv; // from 0; uv is -1 where none is given
} ObjCorner;

typedef struct ObjFace {
    uint32_t first, line; // its first corner
} ObjFace;

typedef struct Obj {
    Text text;
    const uint8_t *begin; ///< of the file
    const char *name;
    SingeAllocator allocator;
    SingeError *error;
    float (*positions)[3];
    float (*uvs)[2];
    ObjFace *faces;
    ObjCorner *corners;
    size_t position_count, position_capacity, uv_count, uv_capacity, face_count, face_capacity;
    size_t corner_count, corner_capacity;
} Obj;

static SingeResult obj_refuse_at(const Obj *obj, SingeResult code, int64_t line, const char *what) {
    return refuse(obj->error, code, "obj", line, "%s:%lld: %s", short_name(obj->name), (long long)line, what);
}

static SingeResult obj_refuse(const Obj *obj, SingeResult code, const char *what) {
    return obj_refuse_at(obj, code, obj->text.line, what);
}

/// The word at the cursor is reported only by its position: whoever sees the message may not be allowed to read the
/// file.
static SingeResult obj_refuse_word(const Obj *obj, const char *what) {
    return refuse(obj->error, SINGE_ERROR_FORMAT, "obj", obj->text.line, "%s:%lld:%lld: this %s", short_name(obj->name),
                  (long long)obj->text.line, (long long)text_column(&obj->text, obj->begin), what);
}

// A backslash at the end of a line joins the next one to it.
static size_t obj_continuation(const uint8_t *p, const uint8_t *end) {
    size_t length = p < end && *p == '\\' ? text_end_length(p + 1, end) : 0;
    return length ? length + 1 : 0;
}

static void obj_skip_blanks(Obj *obj) {
    size_t length;
    text_skip_blanks(&obj->text);
    while ((length = obj_continuation(obj->text.at, obj->text.end))) {
        obj->text.at += length;
        obj->text.line++;
        text_skip_blanks(&obj->text);
    }
}

static bool obj_at_end(const Obj *obj) { return text_at_line_end(&obj->text) || *obj->text.at == '#'; }

static bool obj_word_ended(const Obj *obj) {
    return obj_at_end(obj) || text_is_blank(*obj->text.at) || obj_continuation(obj->text.at, obj->text.end);
}

// Reads the numbers of a line, at least `least`, and keeps the first `kept`; `count` gets how many there were.
static SingeResult obj_numbers(Obj *obj, int min, int max, int kept, float *values, const char *expected) {
    int count = 0;
    for (obj_skip_blanks(obj); !obj_at_end(obj); obj_skip_blanks(obj), count++) {
        float value;
        if (count == max) return obj_refuse(obj, SINGE_ERROR_FORMAT, expected);

        const uint8_t *word = obj->text.at;
        NumberStatus status = number_float(&obj->text.at, obj->text.end, &value);
        if (status != NUMBER_OK || !obj_word_ended(obj)) {
            obj->text.at = word;
            return obj_refuse_word(obj, status == NUMBER_NOT_FINITE ? "is not a finite number"
                                        : status == NUMBER_RANGE    ? "is too large for a float"
                                                                    : "is not a number");
        }

        if (count < kept) values[count] = value;
    }

    return count < min ? obj_refuse(obj, SINGE_ERROR_FORMAT, expected) : SINGE_OK;
}

// An index counts from 1, or backwards from the last one so far. A positive one may be of a later vertex.
static SingeResult obj_index(Obj *obj, size_t so_far, const char *what, int32_t *index) {
    int64_t value;
    const uint8_t *word = obj->text.at;
    NumberStatus status = number_integer(&obj->text.at, obj->text.end, &value);
    bool ended = status == NUMBER_OK && (obj_word_ended(obj) || *obj->text.at == '/');

    obj->text.at = word;
    if (status == NUMBER_JUNK || (status == NUMBER_OK && !ended)) return obj_refuse_word(obj, "is not an index");
    if (status == NUMBER_OK && value == 0) return obj_refuse_word(obj, "has index 0; OBJ counts from 1");

    if (status == NUMBER_RANGE || value > MESH_COUNT_LIMIT || value < -(int64_t)so_far)
        return refuse(obj->error, SINGE_ERROR_MESH, "obj", obj->text.line,
                      "%s:%lld:%lld: this %s index is out of range (%llu so far)", short_name(obj->name),
                      (long long)obj->text.line, (long long)text_column(&obj->text, obj->begin), what,
                      (unsigned long long)so_far);

    *index = (int32_t)(value > 0 ? value - 1 : value + (int64_t)so_far);
    (void)number_integer(&obj->text.at, obj->text.end, &value);
    return SINGE_OK;
}

static SingeResult obj_face(Obj *obj) {
    if (obj->face_count >= MESH_COUNT_LIMIT) return obj_refuse(obj, SINGE_ERROR_LIMIT, "too many faces");
    if (!store_grow(obj->allocator, &obj->faces, &obj->face_capacity, obj->face_count + 1, sizeof *obj->faces))
        return refuse_memory(obj->error, "obj", obj->name);

    size_t first = obj->corner_count;
    Text *text = &obj->text;
    int64_t line = text->line;

    for (obj_skip_blanks(obj); !obj_at_end(obj); obj_skip_blanks(obj), obj->corner_count++) {
        if (obj->corner_count >= MESH_COUNT_LIMIT) return obj_refuse(obj, SINGE_ERROR_LIMIT, "too many corners");
        if (!store_grow(obj->allocator, &obj->corners, &obj->corner_capacity, obj->corner_count + 1,
                        sizeof *obj->corners))
            return refuse_memory(obj->error, "obj", obj->name);
        ObjCorner *corner = &obj->corners[obj->corner_count];

        // v, v/vt, v//vn or v/vt/vn; normals are checked for their form only
        corner->uv = -1;
        TRY(obj_index(obj, obj->position_count, "vertex", &corner->vertex));
        if (obj_word_ended(obj)) continue;
        text->at++;

        if (text->at < text->end && *text->at != '/') {
            TRY(obj_index(obj, obj->uv_count, "texture coordinate", &corner->uv));
            if (obj_word_ended(obj)) continue;
        }

        if (text->at == text->end || *text->at != '/') return obj_refuse_word(obj, "is not an index");
        text->at++;
        int64_t normal;
        const uint8_t *word = text->at;

        if (number_integer(&text->at, text->end, &normal) || normal == 0 || !obj_word_ended(obj)) {
            text->at = word;
            return obj_refuse_word(obj, "is not an index");
        }
    }

    size_t corners = obj->corner_count - first;
    if (corners < 3)
        return refuse(obj->error, SINGE_ERROR_MESH, "obj", line, "%s:%lld: face has %d corner%s; it needs three",
                      short_name(obj->name), (long long)line, (int)corners, corners == 1 ? "" : "s");
    obj->faces[obj->face_count++] = (ObjFace){(uint32_t)first, (uint32_t)line};
    return SINGE_OK;
}

static SingeResult obj_line(Obj *obj) {
    static const char *const ignored[] = {"vn",     "vp",     "g",        "o",        "s",          "mg",
                                          "usemtl", "mtllib", "usemap",   "maplib",   "shadow_obj", "trace_obj",
                                          "bevel",  "lod",    "c_interp", "d_interp", "l",          "p"};
    const uint8_t *word = obj->text.at, *end = text_word_end(&obj->text);
    const uint8_t *cut = memchr(word, '\\', (size_t)(end - word));
    if (cut && obj_continuation(cut, obj->text.end)) end = cut;

    bool vertex = text_word_is(word, end, "v"), uv = text_word_is(word, end, "vt");

    // lines about appearance, groups, points and lines
    if (!vertex && !uv && !text_word_is(word, end, "f")) {
        size_t i = 0;
        while (i < sizeof ignored / sizeof *ignored && !text_word_is(word, end, ignored[i])) i++;
        if (i == sizeof ignored / sizeof *ignored) return obj_refuse_word(obj, "is not a directive that Singe knows");

        for (; !text_at_line_end(&obj->text); obj->text.at++) {
            size_t length = obj_continuation(obj->text.at, obj->text.end);
            if (!length) continue;
            obj->text.at += length - 1;
            obj->text.line++;
        }

        return SINGE_OK;
    }

    obj->text.at = end;
    if (vertex) { // v x y z [w | r g b [w]]
        if (obj->position_count >= MESH_COUNT_LIMIT) return obj_refuse(obj, SINGE_ERROR_LIMIT, "too many vertices");
        if (!store_grow(obj->allocator, &obj->positions, &obj->position_capacity, obj->position_count + 1,
                        sizeof *obj->positions))
            return refuse_memory(obj->error, "obj", obj->name);
        TRY(obj_numbers(obj, 3, 7, 3, obj->positions[obj->position_count], "a vertex is v x y z"));
        obj->position_count++;
        return SINGE_OK;
    }

    if (uv) { // vt u [v [w]]
        if (obj->uv_count >= MESH_COUNT_LIMIT)
            return obj_refuse(obj, SINGE_ERROR_LIMIT, "too many texture coordinates");
        if (!store_grow(obj->allocator, &obj->uvs, &obj->uv_capacity, obj->uv_count + 1, sizeof *obj->uvs))
            return refuse_memory(obj->error, "obj", obj->name);
        float *made = obj->uvs[obj->uv_count];
        made[0] = made[1] = 0;
        TRY(obj_numbers(obj, 1, 3, 2, made, "a texture coordinate is vt u v"));
        obj->uv_count++;
        return SINGE_OK;
    }

    return obj_face(obj);
}

// ---- from the file's lists to the mesh

static SingeResult obj_finish(Obj *obj, Polygons *polygons) {
    SingeAllocator allocator = obj->allocator;
    bool uv = false;
    for (size_t i = 0; i < obj->corner_count && !uv; i++) uv = obj->corners[i].uv >= 0;

    polygons->allocator = allocator;
    polygons->face_count = (uint32_t)obj->face_count;
    polygons->corner_count = (uint32_t)obj->corner_count;
    polygons->first = store_new(allocator, obj->face_count + 1, sizeof *polygons->first);
    polygons->corners = store_new(allocator, obj->corner_count, sizeof *polygons->corners);
    polygons->lines = store_new(allocator, obj->face_count, sizeof *polygons->lines);
    if (uv) polygons->uv = store_new(allocator, obj->corner_count, 2 * sizeof *polygons->uv);
    if (!polygons->first || !polygons->corners || !polygons->lines || (uv && !polygons->uv))
        return refuse_memory(obj->error, "obj", obj->name);

    for (size_t f = 0; f < obj->face_count; f++) {
        size_t end = f + 1 < obj->face_count ? obj->faces[f + 1].first : obj->corner_count;
        polygons->first[f] = obj->faces[f].first;
        polygons->lines[f] = obj->faces[f].line;
        for (size_t i = obj->faces[f].first; i < end; i++) {
            ObjCorner corner = obj->corners[i];
            if ((size_t)corner.vertex >= obj->position_count || (corner.uv >= 0 && (size_t)corner.uv >= obj->uv_count))
                return refuse(obj->error, SINGE_ERROR_MESH, "obj", obj->faces[f].line,
                              "%s:%u: corner %d is out of range: there are %llu vertices, %llu texture coordinates",
                              short_name(obj->name), obj->faces[f].line, (int)(i - obj->faces[f].first) + 1,
                              (unsigned long long)obj->position_count, (unsigned long long)obj->uv_count);

            polygons->corners[i] = (uint32_t)corner.vertex;
            if (!polygons->uv) continue;
            if (corner.uv < 0)
                return obj_refuse_at(obj, SINGE_ERROR_MESH, obj->faces[f].line,
                                     "a corner has no texture coordinate, but others have one");
            memcpy(polygons->uv + 2 * i, obj->uvs[corner.uv], 2 * sizeof *polygons->uv);
        }
    }

    polygons->first[obj->face_count] = (uint32_t)obj->corner_count;

    if (!store_trim(allocator, &obj->positions, &obj->position_capacity, obj->position_count, sizeof *obj->positions))
        return refuse_memory(obj->error, "obj", obj->name);
    polygons->positions = (float *)obj->positions;
    polygons->vertex_count = (uint32_t)obj->position_count;
    obj->positions = NULL;
    return SINGE_OK;
}

SingeResult obj_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Polygons *polygons,
                     SingeError *error) {
    memset(polygons, 0, sizeof *polygons);
    if (size == 0) return refuse(error, SINGE_ERROR_FORMAT, "obj", 1, "%s: is empty", short_name(name));

    Obj obj = {.text = {bytes, bytes + size, 1}, .begin = bytes, .name = name, .allocator = allocator, .error = error};
    SingeResult result = SINGE_OK;
    Text *text = &obj.text;
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) text->at += 3;

    while (text->at < text->end && !result) {
        if (text->line >= UINT32_MAX) {
            result = obj_refuse(&obj, SINGE_ERROR_LIMIT, "too many lines");
            break;
        }

        obj_skip_blanks(&obj);
        if (!obj_at_end(&obj)) result = obj_line(&obj);
        if (!result) text_next_line(text);
    }

    if (!result && obj.face_count == 0)
        result = refuse(error, SINGE_ERROR_FORMAT, "obj", text->line, "%s: has no faces", short_name(name));
    if (!result) result = obj_finish(&obj, polygons);
    store_free(allocator, obj.positions, obj.position_capacity, sizeof *obj.positions);
    store_free(allocator, obj.uvs, obj.uv_capacity, sizeof *obj.uvs);
    store_free(allocator, obj.faces, obj.face_capacity, sizeof *obj.faces);
    store_free(allocator, obj.corners, obj.corner_capacity, sizeof *obj.corners);
    if (result) polygons_free(polygons);
    return result;
}

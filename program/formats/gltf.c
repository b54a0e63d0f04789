// glTF 2.0 and GLB: locates the data in the file. Every offset and count is checked here, once: of buffers, of views of
// buffers, and of accessors, which are arrays in a view.
#include "formats/gltf.h"

#include "formats/mesh_reader.h"
#include "common/store.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { BUFFERS_LIMIT = 1 << 30, PATH_LIMIT = 4096 };

SingeResult gltf_refuse(const Gltf *gltf, SingeResult code, const char *format, ...) {
    char what[320];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return refuse(gltf->error, code, "gltf", -1, "%s: %s", short_name(gltf->name), what);
}

static SingeResult gltf_bad(const Gltf *gltf, const char *list, uint32_t number, const char *what) {
    return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "%s[%u]: %s", list, number, what);
}

SingeResult gltf_index(const Gltf *gltf, int64_t object, const char *key, uint32_t count, int64_t *index) {
    int64_t value = json_member(&gltf->json, object, key);
    uint64_t number;

    *index = JSON_NONE;
    if (value == JSON_NONE) return SINGE_OK;
    if (!json_count(&gltf->json, value, &number) || number >= count)
        return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "byte %u of its JSON: \"%s\" is not a number below %u",
                           gltf->json.values[value].begin, key, count);

    *index = (int64_t)number;
    return SINGE_OK;
}

/// A member that is a count, or `otherwise` if it is missing. False if it is no count, or above `max`.
static bool take_count(const Gltf *gltf, int64_t object, const char *key, uint64_t otherwise, uint64_t max,
                       uint64_t *count) {
    int64_t value = json_member(&gltf->json, object, key);
    *count = otherwise;
    return (value == JSON_NONE || json_count(&gltf->json, value, count)) && *count <= max;
}

static SingeResult list_items(Gltf *gltf, const char *key, uint32_t **items, uint32_t *count) {
    int64_t list = json_member(&gltf->json, 0, key), at = list + 1;
    *count = json_items(&gltf->json, list);
    *items = store_new(gltf->allocator, *count, sizeof **items);
    if (!*items) return refuse_memory(gltf->error, "gltf", gltf->name);
    for (uint32_t i = 0; i < *count; i++, at = gltf->json.values[at].after) (*items)[i] = (uint32_t)at;
    return SINGE_OK;
}

// ---- buffers

static int hex_digit(uint8_t c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

static SingeResult load_file(Gltf *gltf, uint32_t number, const uint8_t *at, const uint8_t *end, Bytes *bytes) {
    // the path of the URI, relative to the folder of the file
    char path[PATH_LIMIT];
    const char *slash = strrchr(gltf->name, '/');
    size_t length = slash ? (size_t)(slash - gltf->name) + 1 : 0;
    bool good = length < PATH_LIMIT;
    if (good) memcpy(path, gltf->name, length);

    for (; good && at < end; at++) {
        int c = *at;
        if (c == '%' && end - at > 2 && hex_digit(at[1]) >= 0 && hex_digit(at[2]) >= 0) {
            c = hex_digit(at[1]) << 4 | hex_digit(at[2]);
            at += 2;
        } else if (c == '\\' && (++at == end || !strchr("/\\\"", c = *at))) c = 0; // names in \u are not read
        good = c != 0 && length + 1 < PATH_LIMIT;
        if (good) path[length++] = (char)c;
    }

    if (good) path[length] = 0;
    if (!good || !path_is_inside(gltf->name, path))
        return gltf_bad(gltf, "buffers", number, "it may refer only to files in its folder or below");

    SingeError error = {0};
    SingeResult result = file_read_max(path, BUFFERS_LIMIT - gltf->loaded_size, gltf->allocator, bytes, &error);
    if (result == SINGE_ERROR_MEMORY) return refuse_memory(gltf->error, "gltf", gltf->name);
    if (result == SINGE_ERROR_LIMIT) return gltf_bad(gltf, "buffers", number, "buffers exceed 1 GiB");

    return result ? gltf_bad(gltf, "buffers", number, "the file that it refers to cannot be read") : SINGE_OK;
}

/// The bytes of a buffer, read at first use.
static SingeResult load_buffer(Gltf *gltf, uint32_t number, const uint8_t **bytes, uint64_t *size) {
    int64_t buffer = gltf->buffers[number], uri = json_member(&gltf->json, buffer, "uri");
    Bytes *loaded = &gltf->loaded[number];

    if (uri == JSON_NONE && number == 0 && gltf->chunk) {
        *bytes = gltf->chunk;
        *size = gltf->chunk_size;
    } else if (uri == JSON_NONE || gltf->json.values[uri].kind != JSON_STRING) {
        return gltf_bad(gltf, "buffers", number, "it has no data");
    } else if (!loaded->data) {
        const JsonValue *text = &gltf->json.values[uri];
        const uint8_t *at = gltf->json.text + text->begin, *end = gltf->json.text + text->end;
        const uint8_t *comma = memchr(at, ',', (size_t)(end - at));
        bool inside = end - at > 5 && memcmp(at, "data:", 5) == 0;
        if (inside && (!comma || comma - at < 7 || memcmp(comma - 7, ";base64", 7) != 0))
            return gltf_bad(gltf, "buffers", number, "its data is not base64");

        if (inside) {
            at = comma + 1;
            static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
            while (end > at && end[-1] == '=') end--;
            *loaded = (Bytes){.size = (size_t)(end - at) * 3 / 4, .allocator = gltf->allocator};
            loaded->data = store_new(gltf->allocator, loaded->size + 1, 1);
            if (!loaded->data) return refuse_memory(gltf->error, "gltf", gltf->name);

            uint32_t bits = 0;
            size_t done = 0;

            for (int held = 0; at < end; at++) {
                const char *place = *at ? strchr(digits, *at) : NULL;
                int digit = place ? (int)(place - digits) : *at == '-' ? 62 : *at == '_' ? 63 : -1;
                if (digit < 0 && *at == '\\' && at + 1 < end && at[1] == '/') continue; // an escaped / of JSON
                if (digit < 0) return gltf_bad(gltf, "buffers", number, "its data is not base64");

                bits = bits << 6 | (uint32_t)digit;
                held += 6;
                if (held >= 8) {
                    held -= 8;
                    loaded->data[done++] = (uint8_t)(bits >> held);
                }
            }

            loaded->size = done;
        } else TRY(load_file(gltf, number, at, end, loaded));

        gltf->loaded_size += loaded->size;
        if (!inside) gltf->beside_size += loaded->size;
    }

    if (loaded->data) {
        *bytes = loaded->data;
        *size = loaded->size;
    }

    uint64_t claimed;
    if (!take_count(gltf, buffer, "byteLength", *size, *size, &claimed))
        return gltf_bad(gltf, "buffers", number, "its data is shorter than its byteLength");
    *size = claimed;
    return SINGE_OK;
}

// ---- views and accessors

/// An offset in a view; `size` bytes follow it.
typedef struct Slice {
    const uint8_t *bytes;
    uint64_t size, stride; ///< 0: contiguous
} Slice;

uint32_t gltf_type_size(uint32_t type) {
    static const uint32_t sizes[] = {1, 1, 2, 2, 0, 4, 4};
    return type >= 5120 && type <= 5126 ? sizes[type - 5120] : 0;
}

/// Finds `count` elements of `size` bytes; *stride is their distance.
static SingeResult find_elements(Gltf *gltf, int64_t object, uint32_t number, uint64_t count, uint32_t size,
                                 const uint8_t **bytes, uint32_t *stride) {
    int64_t view;
    uint64_t offset;
    TRY(gltf_index(gltf, object, "bufferView", gltf->view_count, &view));
    if (view == JSON_NONE) return gltf_bad(gltf, "accessors", number, "it has no data, or its data is compressed");
    if (!take_count(gltf, object, "byteOffset", 0, INT64_MAX, &offset))
        return gltf_bad(gltf, "accessors", number, "its byteOffset must be a whole number from 0");

    Slice slice = {0};

    int64_t held = gltf->views[view], extensions = json_member(&gltf->json, held, "extensions"), buffer;
    if (json_member(&gltf->json, extensions, "EXT_meshopt_compression") != JSON_NONE)
        return gltf_bad(gltf, "bufferViews", (uint32_t)view, "compressed data is not supported");
    TRY(gltf_index(gltf, held, "buffer", gltf->buffer_count, &buffer));
    if (buffer == JSON_NONE) return gltf_bad(gltf, "bufferViews", (uint32_t)view, "it has no buffer");

    const uint8_t *from = NULL;
    uint64_t buffer_size = 0, begin, length;
    TRY(load_buffer(gltf, (uint32_t)buffer, &from, &buffer_size));
    bool good = take_count(gltf, held, "byteOffset", 0, buffer_size, &begin);
    good = good && take_count(gltf, held, "byteLength", 0, buffer_size - begin, &length) && offset <= length;
    if (!good || !take_count(gltf, held, "byteStride", 0, 252, &slice.stride))
        return gltf_bad(gltf, "bufferViews", (uint32_t)view, "it goes past the end of its buffer");

    slice.bytes = from + begin + offset;
    slice.size = length - offset;

    uint64_t step = slice.stride ? slice.stride : size;
    if (step < size) return gltf_bad(gltf, "accessors", number, "its elements overlap");
    if (count == 0 || slice.size < size || (slice.size - size) / step < count - 1)
        return gltf_bad(gltf, "accessors", number, "it has no elements, or goes past the end of its view");

    *bytes = slice.bytes;
    *stride = (uint32_t)step;
    return SINGE_OK;
}

/// Finds an accessor that is needed, once.
static SingeResult find_accessor(Gltf *gltf, int64_t number) {
    static const char *const widths[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    if (number < 0 || gltf->read[number].width) return SINGE_OK;

    int64_t object = gltf->accessors[number], sparse = json_member(&gltf->json, object, "sparse");
    uint64_t type, count;
    GltfAccessor accessor = {0};

    for (uint32_t i = 0; i < 4; i++)
        if (json_is(&gltf->json, json_member(&gltf->json, object, "type"), widths[i])) accessor.width = i + 1;

    int64_t normalized = json_member(&gltf->json, object, "normalized");
    accessor.normalized = normalized != JSON_NONE && gltf->json.text[gltf->json.values[normalized].begin] == 't';
    if (!take_count(gltf, object, "componentType", 0, 5126, &type) || !gltf_type_size((uint32_t)type) ||
        !accessor.width || !take_count(gltf, object, "count", 0, MESH_COUNT_LIMIT, &count))
        return gltf_bad(gltf, "accessors", (uint32_t)number, "it has no type or count");

    accessor.type = (uint32_t)type;
    accessor.count = (uint32_t)count;

    uint32_t size = accessor.width * gltf_type_size(accessor.type);
    TRY(find_elements(gltf, object, (uint32_t)number, count, size, &accessor.bytes, &accessor.stride));

    if (sparse != JSON_NONE) {
        int64_t indices = json_member(&gltf->json, sparse, "indices"),
                values = json_member(&gltf->json, sparse, "values");
        uint64_t sparse_count, index_type;
        uint32_t step;

        if (!take_count(gltf, sparse, "count", 0, accessor.count, &sparse_count) || sparse_count == 0 ||
            !take_count(gltf, indices, "componentType", 0, 5125, &index_type) ||
            (index_type != 5121 && index_type != 5123 && index_type != 5125))
            return gltf_bad(gltf, "accessors", (uint32_t)number, "its sparse elements have no count or type");

        accessor.sparse_type = (uint32_t)index_type;
        TRY(find_elements(gltf, indices, (uint32_t)number, sparse_count, gltf_type_size((uint32_t)index_type),
                          &accessor.sparse_index, &step));
        if (step != gltf_type_size((uint32_t)index_type))
            return gltf_bad(gltf, "accessors", (uint32_t)number, "sparse indices must be contiguous");

        TRY(find_elements(gltf, values, (uint32_t)number, sparse_count, size, &accessor.sparse_bytes, &step));
        if (step != size) return gltf_bad(gltf, "accessors", (uint32_t)number, "sparse elements must be contiguous");
        accessor.sparse_count = (uint32_t)sparse_count;
    }

    gltf->read[number] = accessor;
    return SINGE_OK;
}

// ---- meshes

static SingeResult read_meshes(Gltf *gltf) {
    TRY(list_items(gltf, "buffers", &gltf->buffers, &gltf->buffer_count));
    TRY(list_items(gltf, "bufferViews", &gltf->views, &gltf->view_count));
    TRY(list_items(gltf, "accessors", &gltf->accessors, &gltf->accessor_count));
    TRY(list_items(gltf, "meshes", &gltf->meshes, &gltf->mesh_count));
    TRY(list_items(gltf, "nodes", &gltf->nodes, &gltf->node_count));
    gltf->loaded = store_new(gltf->allocator, gltf->buffer_count, sizeof *gltf->loaded);
    gltf->read = store_new(gltf->allocator, gltf->accessor_count, sizeof *gltf->read);
    gltf->ranges = store_new(gltf->allocator, gltf->mesh_count, sizeof *gltf->ranges);
    if (gltf->loaded) memset(gltf->loaded, 0, gltf->buffer_count * sizeof *gltf->loaded);
    if (!gltf->loaded || !gltf->read || !gltf->ranges) return refuse_memory(gltf->error, "gltf", gltf->name);
    memset(gltf->read, 0, gltf->accessor_count * sizeof *gltf->read);

    for (uint32_t m = 0; m < gltf->mesh_count; m++) {
        int64_t list = json_member(&gltf->json, gltf->meshes[m], "primitives"), at = list + 1;
        uint32_t count = json_items(&gltf->json, list);

        gltf->ranges[m] = (GltfMesh){(uint32_t)gltf->primitive_count, 0};
        for (uint32_t i = 0; i < count; i++, at = gltf->json.values[at].after) {
            GltfPrimitive primitive = {.number = i, .mesh = m};

            int64_t attributes = json_member(&gltf->json, at, "attributes");
            int64_t extensions = json_member(&gltf->json, at, "extensions");
            uint64_t mode;

            if (json_member(&gltf->json, extensions, "KHR_draco_mesh_compression") != JSON_NONE)
                return gltf_bad(gltf, "meshes", primitive.mesh, "compressed data is not supported");
            if (!take_count(gltf, at, "mode", 4, 6, &mode))
                return gltf_bad(gltf, "meshes", primitive.mesh, "a primitive's mode is not known");

            primitive.mode = (uint32_t)mode;
            TRY(gltf_index(gltf, attributes, "POSITION", gltf->accessor_count, &primitive.position));
            TRY(gltf_index(gltf, attributes, "TEXCOORD_0", gltf->accessor_count, &primitive.uv));
            TRY(gltf_index(gltf, at, "indices", gltf->accessor_count, &primitive.indices));

            if (primitive.position < 0) continue;
            TRY(find_accessor(gltf, primitive.position));
            TRY(find_accessor(gltf, primitive.indices));
            TRY(find_accessor(gltf, primitive.uv));

            const GltfAccessor *position = &gltf->read[primitive.position],
                               *uv = primitive.uv < 0 ? NULL : &gltf->read[primitive.uv];
            const GltfAccessor *indices = primitive.indices < 0 ? NULL : &gltf->read[primitive.indices];

            if (position->width != 3) return gltf_bad(gltf, "meshes", primitive.mesh, "positions are not VEC3");
            if (uv && (uv->width != 2 || uv->count < position->count))
                return gltf_bad(gltf, "meshes", primitive.mesh,
                                "texture coordinates are not VEC2, or fewer than the positions");
            if (indices && (indices->width != 1 || indices->sparse_count ||
                            (indices->type != 5121 && indices->type != 5123 && indices->type != 5125)))
                return gltf_bad(gltf, "meshes", primitive.mesh, "indices must be unsigned integers");

            if (!store_grow(gltf->allocator, &gltf->primitives, &gltf->primitive_capacity, gltf->primitive_count + 1,
                            sizeof primitive))
                return refuse_memory(gltf->error, "gltf", gltf->name);
            gltf->primitives[gltf->primitive_count++] = primitive;
            gltf->ranges[m].count++;
        }
    }

    return SINGE_OK;
}

// ---- the file

/// Finds the two chunks of a GLB. `json` becomes the range of the text.
static SingeResult find_chunks(Gltf *gltf, const uint8_t *bytes, size_t size, const uint8_t **json, size_t *json_size) {
    if (size < 20 || load_u32_little(bytes + 8) > size || load_u32_little(bytes + 8) < 20)
        return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "byte 8: the file is shorter than its header states");

    const uint8_t *end = bytes + load_u32_little(bytes + 8), *at = bytes + 12;
    size_t length = load_u32_little(at);
    if (load_u32_little(at + 4) != 0x4e4f534a || length > (size_t)(end - at) - 8)
        return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "byte 12: the first chunk is not JSON, or longer than the file");
    *json = at + 8;
    *json_size = length;

    for (at += 8 + length; end - at >= 8; at += 8 + length) {
        length = load_u32_little(at);
        if (length > (size_t)(end - at) - 8)
            return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "byte %lld: a chunk is longer than the file",
                               (long long)(at - bytes));
        if (load_u32_little(at + 4) == 0x004e4942 && !gltf->chunk) {
            gltf->chunk = at + 8;
            gltf->chunk_size = length;
        }
    }

    return SINGE_OK;
}

SingeResult gltf_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Polygons *polygons,
                      SingeError *error) {
    *polygons = (Polygons){.allocator = allocator};
    Gltf gltf = {.name = name, .allocator = allocator, .error = error};
    if (size == 0) return gltf_refuse(&gltf, SINGE_ERROR_FORMAT, "is empty");
    if (size > MESH_COUNT_LIMIT) return gltf_refuse(&gltf, SINGE_ERROR_LIMIT, "is too large");

    const uint8_t *json = bytes;
    size_t json_size = size;
    SingeResult result = SINGE_OK;

    if (size >= 8 && memcmp(bytes, "glTF", 4) == 0) {
        if (load_u32_little(bytes + 4) == 1) return assimp_read(name, bytes, size, allocator, polygons, error);
        result = find_chunks(&gltf, bytes, size, &json, &json_size);
    }

    if (!result) result = json_read(name, json, json_size, allocator, &gltf.json, error);
    if (!result && gltf.json.values[0].kind != JSON_OBJECT)
        result = gltf_refuse(&gltf, SINGE_ERROR_FORMAT, "not glTF: its JSON is not an object");

    // glTF 1, which has objects in place of arrays, or compressed by Draco: assimp can read both
    bool other = false;
    if (!result) {
        const Json *text = &gltf.json;
        int64_t accessors = json_member(text, 0, "accessors"), used = json_member(text, 0, "extensionsRequired");
        int64_t at = used + 1;
        other = accessors != JSON_NONE && text->values[accessors].kind == JSON_OBJECT;
        for (uint32_t i = 0; i < json_items(text, used) && !other; i++, at = text->values[at].after)
            other = json_is(text, at, "KHR_draco_mesh_compression");
    }

    if (!result && !other) result = read_meshes(&gltf);

    uint64_t max = MESH_ANSWER_BASE + MESH_ANSWER_TIMES * ((uint64_t)size + gltf.beside_size);
    if (!result && !other) result = gltf_make(&gltf, max, polygons);

    SingeAllocator a = gltf.allocator;
    for (uint32_t i = 0; gltf.loaded && i < gltf.buffer_count; i++)
        if (gltf.loaded[i].data) bytes_free(&gltf.loaded[i]);

    store_free(a, gltf.loaded, gltf.buffer_count, sizeof *gltf.loaded);
    store_free(a, gltf.read, gltf.accessor_count, sizeof *gltf.read);
    store_free(a, gltf.ranges, gltf.mesh_count, sizeof *gltf.ranges);
    store_free(a, gltf.primitives, gltf.primitive_capacity, sizeof *gltf.primitives);
    store_free(a, gltf.buffers, gltf.buffer_count, sizeof *gltf.buffers);
    store_free(a, gltf.views, gltf.view_count, sizeof *gltf.views);
    store_free(a, gltf.accessors, gltf.accessor_count, sizeof *gltf.accessors);
    store_free(a, gltf.meshes, gltf.mesh_count, sizeof *gltf.meshes);
    store_free(a, gltf.nodes, gltf.node_count, sizeof *gltf.nodes);
    json_free(&gltf.json);

    return other ? assimp_read(name, bytes, size, allocator, polygons, error) : result;
}

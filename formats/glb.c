// A frame as binary glTF 2.0: a mesh for each sheet of which something is left, in metres, y up ((x, y, z) of the cache
// is (x, z, -y) here). Fields are attributes of their own names in capitals behind an underscore; whole numbers are
// floats there, for glTF has no others (exact to 16,777,216). COLOR_0 is how far it is burnt, which multiplies the
// picture.
#include "formats/burn_colour.h"
#include "formats/fields.h"
#include "formats/output.h"
#include "formats/sheet_parts.h"
#include "formats/sink.h"

#include <math.h>
#include <string.h>

enum { GLB_FLOAT = 5126, GLB_UINT = 5125, GLB_VERTICES = 34962, GLB_CORNERS = 34963 };

typedef struct GlbWriter {
    Sink text, data, views, accessors, meshes;
    const OutputScene *scene;
    const SingeSurface *surface;
    SheetParts parts;
    uint32_t accessor_count, mesh_count;
} GlbWriter;

// ---- JSON

/// A string in quotes, all but letters, digits and the usual marks escaped byte by byte where that is possible: names
/// are UTF-8.
static void put_json(Sink *sink, const char *text) {
    sink_bytes(sink, "\"", 1);
    for (const char *c = text; *c; c++) {
        if (*c == '"' || *c == '\\') sink_text(sink, "\\%c", *c);
        else if ((unsigned char)*c < 0x20) sink_text(sink, "\\u%04x", (unsigned)(unsigned char)*c);
        else sink_bytes(sink, c, 1);
    }
    sink_bytes(sink, "\"", 1);
}

/// A path as a URI, one folder further down.
static void put_uri(Sink *sink, const char *path) {
    sink_text(sink, *path == '/' ? "\"" : "\"../");
    for (const unsigned char *c = (const unsigned char *)path; *c; c++) {
        const bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') ||
                           strchr("-_.~/", *c);
        if (plain) sink_bytes(sink, c, 1);
        else sink_text(sink, "%%%02X", (unsigned)*c);
    }
    sink_bytes(sink, "\"", 1);
}

// ---- buffers

/// The view and the accessor of what has come into the data since `begin`. `box`: least and greatest, or NULL.
static void put_accessor(GlbWriter *w, size_t begin, uint32_t count, int width, bool corners, const float *box) {
    static const char *const types[] = {[1] = "SCALAR", [2] = "VEC2", [3] = "VEC3"};
    const char *comma = w->accessor_count ? "," : "";
    sink_text(&w->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":%d}", comma, begin,
              w->data.size - begin, corners ? GLB_CORNERS : GLB_VERTICES);
    sink_text(&w->accessors, "%s{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"", comma,
              w->accessor_count, corners ? GLB_UINT : GLB_FLOAT, count, types[width]);
    for (int side = 0; box && side < 2; side++) {
        sink_text(&w->accessors, side ? "],\"max\":[" : ",\"min\":[");
        for (int c = 0; c < 3; c++) {
            sink_text(&w->accessors, c ? "," : "");
            sink_float(&w->accessors, box[3 * side + c]);
        }
    }
    sink_text(&w->accessors, box ? "]}" : "}");
    w->accessor_count++;
}

static void put_name(GlbWriter *w, const char *name) {
    sink_text(&w->meshes, "\"%s\":%u,", name, w->accessor_count);
}

/// A vector of the cache in axes of which y is up.
static void turn(const float from[3], float to[3]) { to[0] = from[0], to[1] = from[2], to[2] = -from[1]; }

/// glTF wants normals of length one; what has none points up.
static void make_unit(float v[3]) {
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (fabsf(length - 1) < 1e-4f) return;
    for (int c = 0; c < 3; c++) v[c] = length > 0 ? v[c] / length : (float)(c == 1);
}

static void put_vectors(GlbWriter *w, const SheetPart *part, const char *name, float (*values)[3], bool unit, bool box) {
    const size_t begin = w->data.size;
    float bounds[6] = {0};
    for (uint32_t i = 0; i < part->count; i++) {
        float v[3];
        turn(values[part->vertices[i]], v);
        if (unit) make_unit(v);
        for (int c = 0; c < 3; c++) {
            bounds[c] = i && bounds[c] < v[c] ? bounds[c] : v[c];
            bounds[3 + c] = i && bounds[3 + c] > v[c] ? bounds[3 + c] : v[c];
        }
        sink_words(&w->data, v, 3);
    }
    put_name(w, name);
    put_accessor(w, begin, part->count, 3, false, box ? bounds : NULL);
}

/// v of glTF counts from the picture's top.
static void put_uv(GlbWriter *w, const SheetPart *part) {
    const size_t begin = w->data.size;
    for (uint32_t i = 0; i < part->count; i++) {
        const float *uv = w->surface->uv[part->vertices[i]], turned[2] = {uv[0], 1 - uv[1]};
        sink_words(&w->data, turned, 2);
    }
    put_name(w, "TEXCOORD_0");
    put_accessor(w, begin, part->count, 2, false, NULL);
}

static void put_colours(GlbWriter *w, const SheetPart *part) {
    const size_t begin = w->data.size;
    OutputSheet bare = w->scene->sheets[part->sheet];
    bare.image = NULL;
    for (uint32_t i = 0; i < part->count; i++) {
        float colour[3];
        burn_colour(&bare, w->surface, part->vertices[i], colour);
        for (int c = 0; c < 3; c++) colour[c] = colour[c] < 0 ? 0 : colour[c] > 1 ? 1 : colour[c];
        sink_words(&w->data, colour, 3);
    }
    put_name(w, "COLOR_0");
    put_accessor(w, begin, part->count, 3, false, NULL);
}

static void put_field(GlbWriter *w, const SheetPart *part, const SurfaceField *field) {
    const size_t begin = w->data.size;
    const void *values = surface_field(w->surface, field);
    char name[40] = "_";
    for (uint32_t i = 0; i < part->count; i++) {
        const uint32_t v = part->vertices[i];
        const float value = field->integer ? (float)((const int32_t *)values)[v] : ((const float *)values)[v];
        sink_words(&w->data, &value, 1);
    }
    for (size_t i = 0; field->name[i]; i++)
        name[i + 1] = field->name[i] == '_' ? '_' : (char)(field->name[i] - 'a' + 'A');
    put_name(w, name);
    put_accessor(w, begin, part->count, 1, false, NULL);
}

static void put_corners(GlbWriter *w, const SheetPart *part) {
    const size_t begin = w->data.size;
    for (uint32_t i = 0; i < part->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            sink_u32(&w->data, w->parts.local[w->surface->triangles[part->triangles[i]][k]]);
    put_accessor(w, begin, 3 * part->triangle_count, 1, true, NULL);
}

// ---- meshes

static void put_mesh(GlbWriter *w, uint32_t sheet) {
    const SheetPart part = sheet_part(&w->parts, sheet);
    const SingeSurface *s = w->surface;
    if (!part.count || !part.triangle_count) return; // glTF has no meshes of nothing
    sink_text(&w->meshes, "%s{\"name\":", w->mesh_count++ ? "," : "");
    put_json(&w->meshes, w->scene->sheets[sheet].name);
    sink_text(&w->meshes, ",\"primitives\":[{\"material\":%u,\"attributes\":{", sheet);
    put_vectors(w, &part, "POSITION", s->position, false, true);
    put_vectors(w, &part, "NORMAL", s->normal, true, false);
    put_uv(w, &part);
    put_colours(w, &part);
    put_vectors(w, &part, "_VELOCITY", s->velocity, false, false);
    put_vectors(w, &part, "_REST", s->rest_position, false, false);
    for (int i = 0; i < SURFACE_FIELDS; i++) put_field(w, &part, &surface_fields[i]);
    w->meshes.size--; // the last comma
    sink_text(&w->meshes, "},\"indices\":%u}]}", w->accessor_count);
    put_corners(w, &part);
}

static void put_materials(GlbWriter *w) {
    uint32_t textures = 0;
    for (uint32_t i = 0; i < w->scene->sheet_count; i++) {
        const bool pictured = w->scene->sheets[i].picture != NULL;
        sink_text(&w->text, "%s{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.9",
                  i ? "," : "");
        if (pictured) sink_text(&w->text, ",\"baseColorTexture\":{\"index\":%u}", textures++);
        sink_text(&w->text, "}}");
    }
}

static void put_pictures(GlbWriter *w) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < w->scene->sheet_count; i++) {
        if (!w->scene->sheets[i].picture) continue;
        sink_text(&w->text, count++ ? ",{\"uri\":" : ",\"images\":[{\"uri\":");
        put_uri(&w->text, w->scene->sheets[i].picture);
        sink_text(&w->text, "}");
    }
    if (!count) return;
    sink_text(&w->text, "],\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071}],\"textures\":[");
    for (uint32_t i = 0; i < count; i++) sink_text(&w->text, "%s{\"source\":%u,\"sampler\":0}", i ? "," : "", i);
    sink_text(&w->text, "]");
}

static void put_scene(GlbWriter *w, double time) {
    sink_text(&w->text, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Singe " SINGE_VERSION "\",\"extras\":{\"time\":");
    sink_number(&w->text, time);
    sink_text(&w->text, "}},\"scene\":0,\"scenes\":[{");
    if (w->mesh_count) {
        sink_text(&w->text, "\"nodes\":[");
        for (uint32_t i = 0; i < w->mesh_count; i++) sink_text(&w->text, i ? ",%u" : "%u", i);
        sink_text(&w->text, "]}],\"nodes\":[");
        for (uint32_t i = 0; i < w->mesh_count; i++) sink_text(&w->text, "%s{\"mesh\":%u}", i ? "," : "", i);
        sink_text(&w->text, "],\"meshes\":[");
        sink_bytes(&w->text, w->meshes.bytes, w->meshes.size);
        sink_text(&w->text, "],\"materials\":[");
        put_materials(w);
        sink_text(&w->text, "]");
        put_pictures(w);
        sink_text(&w->text, ",\"accessors\":[");
        sink_bytes(&w->text, w->accessors.bytes, w->accessors.size);
        sink_text(&w->text, "],\"bufferViews\":[");
        sink_bytes(&w->text, w->views.bytes, w->views.size);
        sink_text(&w->text, "],\"buffers\":[{\"byteLength\":%zu}]}", w->data.size);
    } else {
        sink_text(&w->text, "}]}");
    }
    while (w->text.size % 4 && !w->text.failed) sink_bytes(&w->text, " ", 1);
}

/// The header and the two chunks; the data are whole numbers of 4 bytes anyway.
static SingeResult write_file(GlbWriter *w, const char *path, SingeError *error) {
    if (w->data.size > UINT32_MAX / 2)
        return refuse(error, SINGE_ERROR_LIMIT, "glb", -1, "%s: more than a GLB can hold", short_name(path));
    Sink sink = {.allocator = w->surface->allocator};
    const uint32_t head = 12 + 8 + (uint32_t)w->text.size, body = w->mesh_count ? 8 + (uint32_t)w->data.size : 0;
    sink_reserve(&sink, head + body);
    sink_bytes(&sink, "glTF", 4);
    sink_u32(&sink, 2);
    sink_u32(&sink, head + body);
    sink_u32(&sink, (uint32_t)w->text.size);
    sink_bytes(&sink, "JSON", 4);
    sink_bytes(&sink, w->text.bytes, w->text.size);
    if (body) {
        sink_u32(&sink, (uint32_t)w->data.size);
        sink_bytes(&sink, "BIN", 4);
        sink_bytes(&sink, w->data.bytes, w->data.size);
    }
    sink.failed = sink.failed || w->text.failed || w->data.failed || w->views.failed || w->accessors.failed ||
                  w->meshes.failed;
    return sink_write(&sink, path, error);
}

SingeResult glb_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame, SingeError *error) {
    const SingeAllocator a = frame->surface->allocator;
    GlbWriter writer = {.text.allocator = a, .data.allocator = a, .views.allocator = a, .accessors.allocator = a,
                        .meshes.allocator = a, .scene = scene, .surface = frame->surface};
    sink_reserve(&writer.data, 140 * (size_t)frame->surface->vertex_count);
    SingeResult result = sheet_parts_make(&writer.parts, frame->surface, scene->sheet_count, path, error);
    for (uint32_t i = 0; i < scene->sheet_count && !result; i++) put_mesh(&writer, i);
    if (!result) {
        put_scene(&writer, frame->time);
        result = write_file(&writer, path, error);
    }
    sheet_parts_free(&writer.parts);
    sink_free(&writer.text), sink_free(&writer.data), sink_free(&writer.views);
    sink_free(&writer.accessors), sink_free(&writer.meshes);
    return result;
}

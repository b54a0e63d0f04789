#include "formats/glb_file.h"

#include <math.h>
#include <string.h>

enum { GLB_FLOAT = 5126, GLB_UINT = 5125, GLB_VERTICES = 34962, GLB_CORNERS = 34963 };

void glb_begin(GlbFile *f, const OutputScene *scene, SingeAllocator a) {
    *f = (GlbFile){.text.allocator = a,
                   .data.allocator = a,
                   .views.allocator = a,
                   .accessors.allocator = a,
                   .meshes.allocator = a,
                   .nodes.allocator = a,
                   .animations.allocator = a,
                   .scene = scene};
}

void glb_free(GlbFile *f) {
    sink_free(&f->text), sink_free(&f->data), sink_free(&f->views), sink_free(&f->accessors), sink_free(&f->meshes);
    sink_free(&f->nodes), sink_free(&f->animations);
}

// ---- JSON

/// Escapes everything but letters, digits and common marks, byte by byte if possible: names are UTF-8.
void glb_put_string(Sink *sink, const char *text) {
    sink_bytes(sink, "\"", 1);
    for (const char *c = text; *c; c++) {
        if (*c == '"' || *c == '\\') sink_text(sink, "\\%c", *c);
        else if ((unsigned char)*c < 0x20) sink_text(sink, "\\u%04x", (unsigned)(unsigned char)*c);
        else sink_bytes(sink, c, 1);
    }
    sink_bytes(sink, "\"", 1);
}

/// A path as a URI, prefixed by `up` if it is relative.
static void put_uri(Sink *sink, const char *up, const char *path) {
    sink_text(sink, "\"%s", *path == '/' ? "" : up);
    for (const unsigned char *c = (const unsigned char *)path; *c; c++) {
        const bool plain =
            (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') || strchr("-_.~/", *c);
        if (plain) sink_bytes(sink, c, 1);
        else sink_text(sink, "%%%02X", (unsigned)*c);
    }
    sink_bytes(sink, "\"", 1);
}

// ---- buffers

uint32_t glb_put_accessor(GlbFile *f, size_t begin, uint32_t count, int width, GlbUse use, const float *box) {
    static const char *const types[] = {[1] = "SCALAR", [2] = "VEC2", [3] = "VEC3", [4] = "VEC4"};
    const char *comma = f->view_count ? "," : "";
    sink_text(&f->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", comma, begin, f->data.size - begin);
    if (use == GLB_OF_ANIMATION) sink_text(&f->views, "}");
    else sink_text(&f->views, ",\"target\":%d}", use == GLB_OF_CORNERS ? GLB_CORNERS : GLB_VERTICES);
    sink_text(&f->accessors, "%s{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"", comma,
              f->view_count, use == GLB_OF_CORNERS ? GLB_UINT : GLB_FLOAT, count, types[width]);
    for (int side = 0; box && side < 2; side++) {
        sink_text(&f->accessors, side ? "],\"max\":[" : ",\"min\":[");
        for (int c = 0; c < width; c++) {
            sink_text(&f->accessors, c ? "," : "");
            sink_float(&f->accessors, box[width * side + c]);
        }
    }
    sink_text(&f->accessors, box ? "]}" : "}");
    return f->view_count++;
}

void glb_make_unit(float v[3]) {
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (fabsf(length - 1) < 1e-4f) return;
    for (int c = 0; c < 3; c++) v[c] = length > 0 ? v[c] / length : (float)(c == 1);
}

// ---- the whole

static void put_materials(GlbFile *f) {
    uint32_t textures = 0;
    for (uint32_t i = 0; i < f->scene->sheet_count; i++) {
        const bool pictured = f->scene->sheets[i].picture != NULL;
        sink_text(&f->text,
                  "%s{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.9",
                  i ? "," : "");
        if (pictured) sink_text(&f->text, ",\"baseColorTexture\":{\"index\":%u}", textures++);
        sink_text(&f->text, "}}");
    }
}

static void put_pictures(GlbFile *f, const char *up) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < f->scene->sheet_count; i++) {
        if (!f->scene->sheets[i].picture) continue;
        sink_text(&f->text, count++ ? ",{\"uri\":" : ",\"images\":[{\"uri\":");
        put_uri(&f->text, up, f->scene->sheets[i].picture);
        sink_text(&f->text, "}");
    }
    if (!count) return;
    sink_text(&f->text, "],\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071}],\"textures\":[");
    for (uint32_t i = 0; i < count; i++) sink_text(&f->text, "%s{\"source\":%u,\"sampler\":0}", i ? "," : "", i);
    sink_text(&f->text, "]");
}

static void put_part(GlbFile *f, const char *before, const Sink *part) {
    sink_text(&f->text, "%s", before);
    sink_bytes(&f->text, part->bytes, part->size);
}

static void put_scene(GlbFile *f, const char *up, const char *extras) {
    sink_text(&f->text, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Singe " SINGE_VERSION "\",\"extras\":");
    sink_bytes(&f->text, extras, strlen(extras));
    sink_text(&f->text, "},\"scene\":0,\"scenes\":[{");
    if (f->mesh_count) {
        sink_text(&f->text, "\"nodes\":[");
        for (uint32_t i = 0; i < f->node_count; i++) sink_text(&f->text, i ? ",%u" : "%u", i);
        put_part(f, "]}],\"nodes\":[", &f->nodes);
        put_part(f, "],\"meshes\":[", &f->meshes);
        sink_text(&f->text, "],\"materials\":[");
        put_materials(f);
        sink_text(&f->text, "]");
        put_pictures(f, up);
        if (f->animations.size) put_part(f, ",\"animations\":", &f->animations);
        put_part(f, ",\"accessors\":[", &f->accessors);
        put_part(f, "],\"bufferViews\":[", &f->views);
        sink_text(&f->text, "],\"buffers\":[{\"byteLength\":%zu}]}", f->data.size);
    } else {
        sink_text(&f->text, "}]}");
    }
    while (f->text.size % 4 && !f->text.failed) sink_bytes(&f->text, " ", 1);
}

/// The header and the two chunks; the data are multiples of 4 bytes anyway.
SingeResult glb_finish(GlbFile *f, const char *up, const char *extras, const char *path, SingeError *error) {
    put_scene(f, up, extras);
    if (f->data.size + f->text.size > UINT32_MAX / 2)
        return refuse(error, SINGE_ERROR_LIMIT, "glb", -1, "%s: too large for a GLB", short_name(path));
    Sink sink = {.allocator = f->text.allocator};
    const uint32_t head = 12 + 8 + (uint32_t)f->text.size, body = f->mesh_count ? 8 + (uint32_t)f->data.size : 0;
    sink_reserve(&sink, head + body);
    sink_bytes(&sink, "glTF", 4);
    sink_u32(&sink, 2);
    sink_u32(&sink, head + body);
    sink_u32(&sink, (uint32_t)f->text.size);
    sink_bytes(&sink, "JSON", 4);
    sink_bytes(&sink, f->text.bytes, f->text.size);
    if (body) {
        sink_u32(&sink, (uint32_t)f->data.size);
        sink_bytes(&sink, "BIN", 4);
        sink_bytes(&sink, f->data.bytes, f->data.size);
    }
    sink.failed = sink.failed || f->text.failed || f->data.failed || f->views.failed || f->accessors.failed ||
                  f->meshes.failed || f->nodes.failed || f->animations.failed;
    return sink_write(&sink, path, error);
}

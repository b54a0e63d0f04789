// Frames as binary glTF 2.0: a mesh for each sheet that is not gone, in metres, y up ((x, y, z) of the cache is (x, z,
// -y) here). Fields are attributes: an underscore and their names in capitals. Integers are floats, as glTF requires
// (exact up to 16,777,216). COLOR_0 is the burn colour, which multiplies the picture.
#include "formats/glb.h"

#include "formats/burn_colour.h"
#include "formats/number.h"

#include <math.h>
#include <stdio.h>

// ---- the file

enum { GLB_FLOAT = 5126, GLB_UINT = 5125, GLB_VERTICES = 34962, GLB_CORNERS = 34963 };

void glb_begin(GlbFile *f, const OutputScene *scene, SingeAllocator a) {
    *f = (GlbFile){.text.allocator = a,
                   .data.allocator = a,
                   .views.allocator = a,
                   .accessors.allocator = a,
                   .meshes.allocator = a,
                   .nodes.allocator = a,
                   .animations.allocator = a,
                   .scratch.allocator = a,
                   .corners.allocator = a,
                   .scene = scene};
}

void glb_free(GlbFile *f) {
    sink_free(&f->text), sink_free(&f->data), sink_free(&f->views), sink_free(&f->accessors), sink_free(&f->meshes);
    sink_free(&f->nodes), sink_free(&f->animations), sink_free(&f->scratch), sink_free(&f->corners);
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

// ---- buffers

uint32_t glb_end_accessor(GlbFile *f, int width, const float *box) {
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

uint32_t glb_put_accessor(GlbFile *f, size_t begin, uint32_t count, int width, GlbUse use, const float *box) {
    static const char *const types[] = {[1] = "SCALAR", [2] = "VEC2", [3] = "VEC3", [4] = "VEC4"};
    const char *comma = f->view_count ? "," : "";
    sink_text(&f->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", comma, begin, f->data.size - begin);
    if (use == GLB_OF_ANIMATION) sink_text(&f->views, "}");
    else sink_text(&f->views, ",\"target\":%d}", use == GLB_OF_CORNERS ? GLB_CORNERS : GLB_VERTICES);
    sink_text(&f->accessors, "%s{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"", comma,
              f->view_count, use == GLB_OF_CORNERS ? GLB_UINT : GLB_FLOAT, count, types[width]);

    return glb_end_accessor(f, width, box);
}

void glb_make_unit(float v[3]) {
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (fabsf(length - 1) < 1e-4f) return;
    for (int c = 0; c < 3; c++) v[c] = length > 0 ? v[c] / length : (float)(c == 1);
}

// ---- the whole

static void put_part(GlbFile *f, const char *before, const Sink *part) {
    sink_text(&f->text, "%s", before);
    sink_bytes(&f->text, part->bytes, part->size);
}

/// The first sheet that has this sheet's picture, and how many other pictures come before that.
static uint32_t picture_of(const OutputScene *scene, uint32_t sheet, uint32_t *before) {
    *before = 0;
    for (uint32_t i = 0; i < sheet; i++) {
        uint32_t ignored;
        if (!scene->sheets[i].picture) continue;
        if (strcmp(scene->sheets[i].picture, scene->sheets[sheet].picture) == 0) return i;
        *before += picture_of(scene, i, &ignored) == i;
    }

    return sheet;
}

/// Begins the list of the sheets' pictures. Returns how many there are.
static uint32_t put_images(GlbFile *f, const char *up) {
    uint32_t pictures = 0;
    for (uint32_t i = 0; i < f->scene->sheet_count; i++) {
        if (!f->scene->sheets[i].picture) continue;

        sink_text(&f->text, pictures++ ? ",{" : ",\"images\":[{");
        if (f->pictures_inside) {
            uint32_t before;
            picture_of(f->scene, i, &before);
            const char *ending = strrchr(f->scene->sheets[i].picture, '.');
            const bool png = ending && (strcmp(ending, ".png") == 0 || strcmp(ending, ".PNG") == 0);
            sink_text(&f->text, "\"bufferView\":%u,\"mimeType\":\"image/%s\"}", f->first_picture + before,
                      png ? "png" : "jpeg");
            continue;
        }

        // a path as a URI, prefixed by `up` if it is relative
        sink_text(&f->text, "\"uri\":\"%s", path_is_absolute(f->scene->sheets[i].picture) ? "" : up);
        for (const unsigned char *c = (const unsigned char *)f->scene->sheets[i].picture; *c; c++) {
            const bool plain =
                (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') || strchr("-_.~/", *c);
            if (plain) sink_bytes(&f->text, c, 1);
            else sink_text(&f->text, "%%%02X", (unsigned)*c);
        }

        sink_text(&f->text, "\"}");
    }

    return pictures;
}

static void put_scene(GlbFile *f, const char *up, const char *extras) {
    sink_text(&f->text, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Singe " SINGE_VERSION "\",\"extras\":");
    sink_bytes(&f->text, extras, strlen(extras));
    sink_text(&f->text, "},");
    if (f->packed && f->mesh_count) {
        static const char list[] = "[\"EXT_meshopt_compression\",\"KHR_mesh_quantization\"]";
        sink_text(&f->text, "\"extensionsUsed\":%s,\"extensionsRequired\":%s,", list, list);
    }
    sink_text(&f->text, "\"scene\":0,\"scenes\":[{");

    if (f->mesh_count) {
        sink_text(&f->text, "\"nodes\":[");
        for (uint32_t i = 0; i < f->node_count; i++) sink_text(&f->text, i ? ",%u" : "%u", i);
        put_part(f, "]}],\"nodes\":[", &f->nodes);
        put_part(f, "],\"meshes\":[", &f->meshes);
        sink_text(&f->text, "],\"materials\":[");

        uint32_t textures = 0; // a material for each sheet: paper, with the sheet's picture if it has one
        for (uint32_t i = 0; i < f->scene->sheet_count; i++) {
            const bool pictured = f->scene->sheets[i].picture != NULL;
            sink_text(&f->text,
                      "%s{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.9",
                      i ? "," : "");
            if (pictured) sink_text(&f->text, ",\"baseColorTexture\":{\"index\":%u}", textures++);
            sink_text(&f->text, "}}");
        }
        sink_text(&f->text, "]");

        const uint32_t pictures = put_images(f, up);
        if (pictures) {
            sink_text(&f->text, "],\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071}],\"textures\":[");
            for (uint32_t i = 0; i < pictures; i++)
                sink_text(&f->text, "%s{\"source\":%u,\"sampler\":0}", i ? "," : "", i);
            sink_text(&f->text, "]");
        }

        if (f->animations.size) put_part(f, ",\"animations\":", &f->animations);
        put_part(f, ",\"accessors\":[", &f->accessors);
        put_part(f, "],\"bufferViews\":[", &f->views);
        sink_text(&f->text, "],\"buffers\":[{\"byteLength\":%zu}", f->data.size);
        if (f->packed)
            sink_text(&f->text,
                      ",{\"byteLength\":%zu,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}",
                      f->unpacked);
        sink_text(&f->text, "]}");
    } else {
        sink_text(&f->text, "}]}");
    }

    while (f->text.size % 4 && !f->text.failed) sink_bytes(&f->text, " ", 1);
}

/// The header and the two chunks; the data are multiples of 4 bytes anyway.
SingeResult glb_finish(GlbFile *f, const char *up, const char *extras, const char *path, SingeError *error) {
    if (f->pictures_inside && f->mesh_count) {
        // the files of the pictures follow the data, each once
        f->first_picture = f->view_count;
        for (uint32_t i = 0; i < f->scene->sheet_count; i++) {
            Bytes bytes;
            uint32_t before;
            if (!f->scene->sheets[i].picture || picture_of(f->scene, i, &before) != i) continue;

            TRY(output_picture_read(path, f->scene->sheets[i].picture, &bytes, error));
            sink_text(&f->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", f->view_count++ ? "," : "",
                      f->data.size, bytes.size);
            sink_bytes(&f->data, bytes.data, bytes.size);
            sink_align(&f->data, 4);
            bytes_free(&bytes);
        }
    }
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
                  f->meshes.failed || f->nodes.failed || f->animations.failed || f->scratch.failed || f->corners.failed;
    return sink_write(&sink, path, error);
}

// ---- the meshes

typedef struct GlbMeshes {
    GlbFile *file;
    const SingeSurface *surface;
    SheetParts parts;
    bool lean; ///< only drawn and common attributes
} GlbMeshes;

/// How a packed file rounds an attribute: on a grid, to half of its step. A grid packs better than 16 bits of the same step,
/// as what is left is in the last bits.
static GlbRounding rounding_of(const GlbFile *f, const char *name) {
    static const struct {
        const char *name;
        int bits;
    } grids[] = {{"TEXCOORD_0", -13}, {"COLOR_0", -9}, {"_TEMPERATURE", 0}, {"_VELOCITY", -8}};

    if (strcmp(name, "POSITION") == 0) return (GlbRounding){GLB_GRID, f->grid, 0};
    if (strcmp(name, "NORMAL") == 0) return (GlbRounding){GLB_DIRECTION, 0, 0};
    for (size_t i = 0; i < sizeof grids / sizeof *grids; i++)
        if (strcmp(name, grids[i].name) == 0) return (GlbRounding){GLB_GRID, grids[i].bits, 0};
    return (GlbRounding){GLB_GRID, -10, 0};
}

static void put_named(GlbMeshes *w, const char *name, size_t begin, uint32_t count, int width, const float *box) {
    GlbFile *f = w->file;
    sink_text(&f->meshes, "\"%s\":%u,", name,
              f->packed ? glb_put_packed(f, begin, count, width, rounding_of(f, name), box != NULL)
                        : glb_put_accessor(f, begin, count, width, GLB_OF_VERTICES, box));
}

static void put_vectors(GlbMeshes *w, const SheetPart *part, const char *name, float (*values)[3], bool unit,
                        bool box) {
    const size_t begin = w->file->data.size;
    float bounds[6] = {0};

    for (uint32_t i = 0; i < part->count; i++) {
        float v[3];
        glb_turn(values[part->vertices[i]], v);
        if (unit) glb_make_unit(v);
        box_grow(bounds, v, i == 0);
        sink_words(&w->file->data, v, 3);
    }

    put_named(w, name, begin, part->count, 3, box ? bounds : NULL);
}

// ---- meshes

/// Lists the corners of a sheet's triangles. In a packed file neighbours shall be neighbours on the sheet, which packs
/// better: triangles follow each other in strips, and vertices are numbered by their first use. Those that no triangle
/// has go.
static void list_corners(GlbMeshes *w, SheetPart *part) {
    SheetParts *p = &w->parts;
    w->file->corners.size = 0;
    for (uint32_t i = 0; i < part->triangle_count; i++)
        for (int k = 0; k < 3; k++) sink_u32(&w->file->corners, p->surface->triangles[part->triangles[i]][k]);
    if (!w->file->packed || w->file->corners.failed) return;

    uint32_t *corners = (uint32_t *)(void *)w->file->corners.bytes;
    glb_sort_triangles(w->file, corners, 3 * (size_t)part->triangle_count, p->surface->vertex_count);

    uint32_t *vertices = p->vertices + p->vertex_first[part->sheet], count = 0;
    for (uint32_t i = 0; i < part->count; i++) p->local[vertices[i]] = UINT32_MAX;
    for (uint32_t i = 0; i < 3 * part->triangle_count; i++) {
        if (p->local[corners[i]] != UINT32_MAX) continue;
        p->local[corners[i]] = count;
        vertices[count++] = corners[i];
    }

    part->count = count;
}

/// A scalar field as an attribute: `_TEMPERATURE`.
static void put_field(GlbMeshes *w, const SheetPart *part, const SurfaceField *field) {
    const size_t begin = w->file->data.size;
    const void *values = surface_field(w->surface, field);
    char key[40] = "_";

    for (uint32_t i = 0; i < part->count; i++) {
        const uint32_t vertex = part->vertices[i];
        const float value = field->integer ? (float)((const int32_t *)values)[vertex] : ((const float *)values)[vertex];
        sink_words(&w->file->data, &value, 1);
    }

    for (size_t i = 0; field->name[i]; i++)
        key[i + 1] = field->name[i] == '_' ? '_' : (char)(field->name[i] - 'a' + 'A');
    put_named(w, key, begin, part->count, 1, NULL);
}

/// The mesh of a sheet. False if nothing of it is left: glTF has no empty meshes.
static bool put_mesh(GlbMeshes *w, uint32_t sheet) {
    SheetPart part = sheet_part(&w->parts, sheet);
    const SingeSurface *s = w->surface;
    GlbFile *f = w->file;

    if (!part.count || !part.triangle_count) return false;
    list_corners(w, &part);
    if (f->corners.failed) return false; // glb_finish says so

    sink_text(&f->meshes, "%s{\"name\":", f->mesh_count++ ? "," : "");
    glb_put_string(&f->meshes, f->scene->sheets[sheet].name);
    sink_text(&f->meshes, ",\"primitives\":[{\"material\":%u,\"attributes\":{", sheet);
    put_vectors(w, &part, "POSITION", s->position, false, true);
    put_vectors(w, &part, "NORMAL", s->normal, true, false);

    // v of glTF runs from the picture's top
    const size_t uv_begin = w->file->data.size;

    for (uint32_t i = 0; i < part.count; i++) {
        const float *uv = w->surface->uv[part.vertices[i]], turned[2] = {uv[0], 1 - uv[1]};
        sink_words(&w->file->data, turned, 2);
    }

    put_named(w, "TEXCOORD_0", uv_begin, part.count, 2, NULL);

    const size_t colour_begin = w->file->data.size;
    OutputSheet bare = w->file->scene->sheets[part.sheet];
    bare.image = NULL;

    for (uint32_t i = 0; i < part.count; i++) {
        float colour[3];
        burn_colour(&bare, w->surface, part.vertices[i], colour);
        for (int c = 0; c < 3; c++) colour[c] = colour[c] < 0 ? 0 : colour[c] > 1 ? 1 : colour[c];
        sink_words(&w->file->data, colour, 3);
    }

    put_named(w, "COLOR_0", colour_begin, part.count, 3, NULL);

    put_vectors(w, &part, "_VELOCITY", s->velocity, false, false);
    if (!w->lean) put_vectors(w, &part, "_REST", s->rest_position, false, false);

    for (int k = 0; k < surface_field_count(s->wet); k++) {
        const char *name = surface_fields[k].name;
        if (!w->lean || strcmp(name, "temperature") == 0 || strcmp(name, "burnt") == 0)
            put_field(w, &part, &surface_fields[k]);
    }

    f->meshes.size--; // the last comma
    const size_t corner_begin = w->file->data.size;
    const uint32_t *listed = (const uint32_t *)(const void *)w->file->corners.bytes;
    for (uint32_t i = 0; i < 3 * part.triangle_count; i++) sink_u32(&w->file->data, w->parts.local[listed[i]]);

    const GlbRounding corners = {GLB_TRIANGLES, 0, part.count};
    sink_text(&f->meshes, "},\"indices\":%u}]}",
              f->packed ? glb_put_packed(f, corner_begin, 3 * part.triangle_count, 1, corners, false)
                        : glb_put_accessor(f, corner_begin, 3 * part.triangle_count, 1, GLB_OF_CORNERS, NULL));

    return true;
}

SingeResult glb_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame, SingeError *error) {
    GlbFile file;
    GlbMeshes meshes = {.file = &file, .surface = frame->surface};
    glb_begin(&file, scene, frame->surface->allocator);
    sink_reserve(&file.data, 140 * (size_t)frame->surface->vertex_count);

    SingeResult result = sheet_parts_make(&meshes.parts, frame->surface, scene->sheet_count, path, error);
    for (uint32_t i = 0; i < scene->sheet_count && !result; i++)
        if (put_mesh(&meshes, i)) {
            sink_text(&file.nodes, "%s{\"mesh\":%u}", file.node_count ? "," : "", file.node_count);
            file.node_count++;
        }

    if (!result) {
        char extras[80];
        const int length = snprintf(extras, sizeof extras, "{\"time\":");
        const int more = number_print(frame->time, extras + length);
        snprintf(extras + length + more, sizeof extras - (size_t)(length + more), "}");
        result = glb_finish(&file, "../", extras, path, error);
    }

    sheet_parts_free(&meshes.parts);
    glb_free(&file);
    return result;
}

// ---- animated

/// Keys of the scale of a frame's node: 1 while the frame lasts, 0 otherwise; frames begin at (number - 1)/fps.
static void put_appearance(GlbFile *file, int number, int frames) {
    float times[3], scales[3][3];
    uint32_t count = 0;
    for (int k = -1; k < 2; k++) {
        const int at = number + k;
        if (at > frames || (k < 0 && number == 1)) continue;
        times[count] = k < 0 ? 0 : (float)((double)(at - 1) / (double)file->scene->fps);
        for (int c = 0; c < 3; c++) scales[count][c] = k == 0;
        count++;
    }

    size_t begin = file->data.size;
    sink_words(&file->data, times, count);

    const float box[2] = {times[0], times[count - 1]};
    const uint32_t input = glb_put_accessor(file, begin, count, 1, GLB_OF_ANIMATION, box);
    begin = file->data.size;
    sink_words(&file->data, scales, 3 * (size_t)count);
    const uint32_t output = glb_put_accessor(file, begin, count, 3, GLB_OF_ANIMATION, NULL);
    sink_text(&file->animations, "%s{\"input\":%u,\"output\":%u,\"interpolation\":\"STEP\"}",
              file->node_count ? "," : "", input, output);
}

SingeResult glb_write_single(const char *path, const OutputScene *scene, const OutputCache *cache, SingeError *error) {
    GlbFile file;
    SingeResult result = SINGE_OK;
    glb_begin(&file, scene, (SingeAllocator){0});
    file.packed = glb_pack_available() && !scene->plain;
    file.pictures_inside = true;
    sink_text(&file.animations, "[{\"name\":\"burn\",\"samplers\":[");

    for (int i = 1; i <= cache->frames && !result; i++) {
        OutputFrame frame;
        result = cache->read(cache->context, i, &frame, error);
        if (result) break;

        // the grid of positions: a 32,768th of the mesh's longest side, or finer
        if (i == 1) {
            const SingeSurface *s = frame.surface;
            float box[6] = {0}, side = 0;
            for (uint32_t v = 0; v < s->vertex_count; v++) box_grow(box, s->position[v], v == 0);
            for (int c = 0; c < 3; c++) side = fmaxf(side, box[3 + c] - box[c]);
            file.grid = side > 0 && isfinite(side) ? ilogbf(side) - 15 : -17;
        }

        GlbMeshes meshes = {.file = &file, .surface = frame.surface, .lean = true};
        result = sheet_parts_make(&meshes.parts, frame.surface, scene->sheet_count, path, error);
        for (uint32_t sheet = 0; sheet < scene->sheet_count && !result; sheet++) {
            if (!put_mesh(&meshes, sheet)) continue;

            put_appearance(&file, frame.number, cache->frames);
            sink_text(&file.nodes, "%s{\"mesh\":%u,\"name\":", file.node_count ? "," : "", file.node_count);
            glb_put_string(&file.nodes, scene->sheets[sheet].name);
            sink_text(&file.nodes, frame.number > 1 ? ",\"scale\":[0,0,0]}" : "}");
            file.node_count++;
        }

        sheet_parts_free(&meshes.parts);
        if (!result && file.data.size > UINT32_MAX / 2)
            result = refuse(error, SINGE_ERROR_LIMIT, "glb", frame.number, "%s: frame %d is too large for a GLB",
                            short_name(path), frame.number);
    }

    sink_text(&file.animations, "],\"channels\":[");
    for (uint32_t i = 0; i < file.node_count; i++)
        sink_text(&file.animations, "%s{\"sampler\":%u,\"target\":{\"node\":%u,\"path\":\"scale\"}}", i ? "," : "", i,
                  i);
    sink_text(&file.animations, "]}]");
    if (!result) result = glb_finish(&file, "", "{}", path, error);
    glb_free(&file);
    return result;
}

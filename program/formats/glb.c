// Frames as binary glTF 2.0: a mesh for each sheet that is not gone, in metres, y up ((x, y, z) of the cache is (x, z,
// -y) here). Fields are attributes: an underscore and their names in capitals. Integers are floats, as glTF requires
// (exact up to 16,777,216). COLOR_0 is the burn colour, which multiplies the picture.
#include "formats/burn_colour.h"
#include "formats/fields.h"
#include "formats/glb_file.h"
#include "formats/number.h"
#include "formats/sheet_parts.h"

#include <stdio.h>
#include <string.h>

typedef struct GlbMeshes {
    GlbFile *file;
    const SingeSurface *surface;
    SheetParts parts;
    bool lean; ///< only drawn and common attributes
} GlbMeshes;

static void put_named(GlbMeshes *w, const char *name, size_t begin, uint32_t count, int width, const float *box) {
    sink_text(&w->file->meshes, "\"%s\":%u,", name,
              glb_put_accessor(w->file, begin, count, width, GLB_OF_VERTICES, box));
}

static void put_vectors(GlbMeshes *w, const SheetPart *part, const char *name, float (*values)[3], bool unit,
                        bool box) {
    const size_t begin = w->file->data.size;
    float bounds[6] = {0};
    for (uint32_t i = 0; i < part->count; i++) {
        float v[3];
        glb_turn(values[part->vertices[i]], v);
        if (unit) glb_make_unit(v);
        for (int c = 0; c < 3; c++) {
            bounds[c] = i && bounds[c] < v[c] ? bounds[c] : v[c];
            bounds[3 + c] = i && bounds[3 + c] > v[c] ? bounds[3 + c] : v[c];
        }
        sink_words(&w->file->data, v, 3);
    }
    put_named(w, name, begin, part->count, 3, box ? bounds : NULL);
}

/// v of glTF runs from the picture's top.
static void put_uv(GlbMeshes *w, const SheetPart *part) {
    const size_t begin = w->file->data.size;
    for (uint32_t i = 0; i < part->count; i++) {
        const float *uv = w->surface->uv[part->vertices[i]], turned[2] = {uv[0], 1 - uv[1]};
        sink_words(&w->file->data, turned, 2);
    }
    put_named(w, "TEXCOORD_0", begin, part->count, 2, NULL);
}

static void put_colours(GlbMeshes *w, const SheetPart *part) {
    const size_t begin = w->file->data.size;
    OutputSheet bare = w->file->scene->sheets[part->sheet];
    bare.image = NULL;
    for (uint32_t i = 0; i < part->count; i++) {
        float colour[3];
        burn_colour(&bare, w->surface, part->vertices[i], colour);
        for (int c = 0; c < 3; c++) colour[c] = colour[c] < 0 ? 0 : colour[c] > 1 ? 1 : colour[c];
        sink_words(&w->file->data, colour, 3);
    }
    put_named(w, "COLOR_0", begin, part->count, 3, NULL);
}

static void put_field(GlbMeshes *w, const SheetPart *part, const SurfaceField *field) {
    const size_t begin = w->file->data.size;
    const void *values = surface_field(w->surface, field);
    char name[40] = "_";
    for (uint32_t i = 0; i < part->count; i++) {
        const uint32_t v = part->vertices[i];
        const float value = field->integer ? (float)((const int32_t *)values)[v] : ((const float *)values)[v];
        sink_words(&w->file->data, &value, 1);
    }
    for (size_t i = 0; field->name[i]; i++)
        name[i + 1] = field->name[i] == '_' ? '_' : (char)(field->name[i] - 'a' + 'A');
    put_named(w, name, begin, part->count, 1, NULL);
}

static void put_corners(GlbMeshes *w, const SheetPart *part) {
    const size_t begin = w->file->data.size;
    for (uint32_t i = 0; i < part->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            sink_u32(&w->file->data, w->parts.local[w->surface->triangles[part->triangles[i]][k]]);
    glb_put_accessor(w->file, begin, 3 * part->triangle_count, 1, GLB_OF_CORNERS, NULL);
}

// ---- meshes

static bool is_lean(const char *name) { return strcmp(name, "temperature") == 0 || strcmp(name, "burnt") == 0; }

/// The mesh of a sheet. False if nothing of it is left: glTF has no empty meshes.
static bool put_mesh(GlbMeshes *w, uint32_t sheet) {
    const SheetPart part = sheet_part(&w->parts, sheet);
    const SingeSurface *s = w->surface;
    GlbFile *f = w->file;
    if (!part.count || !part.triangle_count) return false;
    sink_text(&f->meshes, "%s{\"name\":", f->mesh_count++ ? "," : "");
    glb_put_string(&f->meshes, f->scene->sheets[sheet].name);
    sink_text(&f->meshes, ",\"primitives\":[{\"material\":%u,\"attributes\":{", sheet);
    put_vectors(w, &part, "POSITION", s->position, false, true);
    put_vectors(w, &part, "NORMAL", s->normal, true, false);
    put_uv(w, &part);
    put_colours(w, &part);
    put_vectors(w, &part, "_VELOCITY", s->velocity, false, false);
    if (!w->lean) put_vectors(w, &part, "_REST", s->rest_position, false, false);
    for (int i = 0; i < SURFACE_FIELDS; i++)
        if (!w->lean || is_lean(surface_fields[i].name)) put_field(w, &part, &surface_fields[i]);
    f->meshes.size--; // the last comma
    sink_text(&f->meshes, "},\"indices\":%u}]}", f->view_count);
    put_corners(w, &part);
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

/// Keys of a node's scale: 1 while its frame lasts, 0 otherwise; frames begin at (number - 1)/fps.
static void put_keys(GlbFile *f, int number, int frames) {
    float times[3], scales[3][3];
    uint32_t count = 0;
    for (int k = -1; k < 2; k++) {
        const int at = number + k;
        if (at > frames || (k < 0 && number == 1)) continue;
        times[count] = k < 0 ? 0 : (float)((double)(at - 1) / (double)f->scene->fps);
        for (int c = 0; c < 3; c++) scales[count][c] = k == 0;
        count++;
    }
    size_t begin = f->data.size;
    sink_words(&f->data, times, count);
    const float box[2] = {times[0], times[count - 1]};
    const uint32_t input = glb_put_accessor(f, begin, count, 1, GLB_OF_ANIMATION, box);
    begin = f->data.size;
    sink_words(&f->data, scales, 3 * (size_t)count);
    const uint32_t output = glb_put_accessor(f, begin, count, 3, GLB_OF_ANIMATION, NULL);
    sink_text(&f->animations, "%s{\"input\":%u,\"output\":%u,\"interpolation\":\"STEP\"}", f->node_count ? "," : "",
              input, output);
}

static SingeResult put_frame(GlbFile *f, const OutputFrame *frame, int frames, const char *path, SingeError *error) {
    GlbMeshes meshes = {.file = f, .surface = frame->surface, .lean = true};
    SingeResult result = sheet_parts_make(&meshes.parts, frame->surface, f->scene->sheet_count, path, error);
    for (uint32_t i = 0; i < f->scene->sheet_count && !result; i++) {
        if (!put_mesh(&meshes, i)) continue;
        put_keys(f, frame->number, frames);
        sink_text(&f->nodes, "%s{\"mesh\":%u,\"name\":", f->node_count ? "," : "", f->node_count);
        glb_put_string(&f->nodes, f->scene->sheets[i].name);
        sink_text(&f->nodes, frame->number > 1 ? ",\"scale\":[0,0,0]}" : "}");
        f->node_count++;
    }
    sheet_parts_free(&meshes.parts);
    if (!result && f->data.size > UINT32_MAX / 2)
        result = refuse(error, SINGE_ERROR_LIMIT, "glb", frame->number, "%s: frame %d is too large for a GLB",
                        short_name(path), frame->number);
    return result;
}

SingeResult glb_write_single(const char *path, const OutputScene *scene, const OutputCache *cache, SingeError *error) {
    GlbFile file;
    SingeResult result = SINGE_OK;
    glb_begin(&file, scene, (SingeAllocator){0});
    sink_text(&file.animations, "[{\"name\":\"burn\",\"samplers\":[");
    for (int i = 1; i <= cache->frames && !result; i++) {
        OutputFrame frame;
        result = cache->read(cache->context, i, &frame, error);
        if (!result) result = put_frame(&file, &frame, cache->frames, path, error);
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

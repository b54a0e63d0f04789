// A frame as a stage of its own in a crate file: a mesh for each sheet, every attribute at the frame's time, so that
// the root's value clips can use it, and complete enough to be opened alone.
//
// Vertices of a sheet keep their order. Colours are indexed: they are rounded to 5, 6 and 5 bits of their square roots.
#include "formats/burn_colour.h"
#include "formats/usd.h"
#include "formats/usd_crate.h"

#include <math.h>
#include <string.h>

enum { ATTRIBUTES_MAX = USD_OWN + SURFACE_FIELDS, COLOURS = 1 << 16, PRIM_FIELDS = 4 };

/// The values of a sheet at a time: own attributes, fields, and the faces of its subsets, burnt and fresh.
enum { SLOT_FIELDS = USD_OWN, SLOT_SUBSETS = SLOT_FIELDS + SURFACE_FIELDS, SLOTS = SLOT_SUBSETS + 2 };

typedef struct UsdWriter {
    Crate crate;
    const OutputScene *scene;
    const SingeSurface *surface;
    CrateValue time;    ///< of all samples
    CrateValue *kept;   ///< [frames][sheets][SLOTS] values of many frames; NULL for one, which has them in the surface
    CrateValue *column; ///< [frames]
    size_t frames;
    SheetParts parts;
    float *gathered;  ///< [3 * vertex_count]
    int32_t *numbers; ///< [3 * triangle_count and vertex_count at least]
    int32_t *palette; ///< [COLOURS] index of a colour, -1: none
    size_t number_count;
} UsdWriter;

static bool writer_make(UsdWriter *w) {
    const SingeSurface *s = w->surface;
    const SingeAllocator a = s->allocator;
    w->number_count = 3 * (size_t)s->triangle_count > s->vertex_count ? 3 * (size_t)s->triangle_count : s->vertex_count;
    w->gathered = store_new(a, s->vertex_count, 12);
    w->numbers = store_new(a, w->number_count, 4);
    w->palette = store_new(a, COLOURS, 4);
    return w->gathered && w->numbers && w->palette;
}

static void writer_free(UsdWriter *w) {
    const SingeSurface *s = w->surface;
    const SingeAllocator a = s->allocator;
    sheet_parts_free(&w->parts);
    store_free(a, w->gathered, s->vertex_count, 12);
    store_free(a, w->numbers, w->number_count, 4), store_free(a, w->palette, COLOURS, 4);
    crate_free(&w->crate);
}

// ---- values

/// A sheet's values of 4 bytes, `width` per vertex: not copied if they are contiguous, as for a single sheet.
static const void *gather(UsdWriter *w, const SheetPart *part, const void *values, int width) {
    const uint32_t *v = part->vertices;
    if (!part->count) return values;
    const uint32_t *from = values;
    if (v[part->count - 1] - v[0] == part->count - 1) return from + (size_t)width * v[0];
    uint32_t *to = (uint32_t *)(void *)w->gathered;
    for (uint32_t i = 0; i < part->count; i++)
        memcpy(to + (size_t)width * i, from + (size_t)width * v[i], 4 * (size_t)width);
    return to;
}

static CrateValue put_vectors(UsdWriter *w, const SheetPart *part, const void *values, int width) {
    return crate_floats(&w->crate, width, gather(w, part, values, width), part->count);
}

/// The palette of colours, and the index of each vertex.
static void put_colours(UsdWriter *w, const SheetPart *part, CrateValue *palette, CrateValue *indices) {
    uint32_t found = 0;
    memset(w->palette, 0xff, COLOURS * sizeof *w->palette);

    for (uint32_t i = 0; i < part->count; i++) {
        static const float steps[3] = {31, 63, 31};
        float colour[3];
        uint32_t q[3];
        burn_colour(&w->scene->sheets[part->sheet], w->surface, part->vertices[i], colour);

        for (int c = 0; c < 3; c++) {
            const float within = colour[c] < 0 ? 0 : colour[c] > 1 ? 1 : colour[c];
            q[c] = (uint32_t)(sqrtf(within) * steps[c] + 0.5f);
        }

        int32_t *entry = &w->palette[q[0] << 11 | q[1] << 5 | q[2]];
        if (*entry < 0) {
            *entry = (int32_t)found;
            for (int c = 0; c < 3; c++)
                w->gathered[3 * found + (uint32_t)c] = (float)q[c] / steps[c] * ((float)q[c] / steps[c]);
            found++;
        }

        w->numbers[i] = *entry;
    }

    *palette = crate_floats(&w->crate, 3, w->gathered, found);
    *indices = crate_ints(&w->crate, w->numbers, part->count);
}

// ---- prims

/// The samples of a slot of a sheet: `value` for one frame, otherwise the kept values.
static CrateValue put_samples(UsdWriter *w, uint32_t sheet, int slot, CrateValue value) {
    if (!w->kept) return crate_series(&w->crate, w->time, &value, 1);
    for (size_t i = 0; i < w->frames; i++)
        w->column[i] = w->kept[(i * w->scene->sheet_count + sheet) * SLOTS + (size_t)slot];
    return crate_series(&w->crate, w->time, w->column, w->frames);
}

static void put_sampled(UsdWriter *w, uint32_t prim, const char *name, const char *type, bool vertex,
                        CrateValue samples) {
    CrateField fields[3] = {{"typeName", crate_token(&w->crate, type)}, {"timeSamples", samples}};
    if (vertex) fields[2] = (CrateField){"interpolation", crate_token(&w->crate, "vertex")};
    crate_spec(&w->crate, crate_path(&w->crate, name, true, prim), CRATE_ATTRIBUTE, fields, vertex ? 3 : 2);
}

static void put_uniform(UsdWriter *w, uint32_t prim, const char *name, const char *type, CrateValue value) {
    CrateField fields[] = {{"typeName", crate_token(&w->crate, type)},
                           {"variability", crate_inline(CRATE_VARIABILITY, 1)},
                           {"default", value}};
    crate_spec(&w->crate, crate_path(&w->crate, name, true, prim), CRATE_ATTRIBUTE, fields, 3);
}

/// The faces whose corners all look unburnt, or the other faces.
static CrateValue put_subset_faces(UsdWriter *w, const SheetPart *part, bool fresh) {
    const SingeSurface *s = w->surface;
    size_t count = 0;
    for (uint32_t i = 0; i < part->triangle_count; i++) {
        bool untouched = true;
        for (int k = 0; k < 3; k++) {
            const uint32_t v = s->triangles[part->triangles[i]][k];
            untouched = untouched && s->burn[v] < BURN_COLOUR_MIN && s->temperature_peak[v] <= BURN_COLOUR_PEAK;
        }
        if (untouched == fresh) w->numbers[count++] = (int32_t)i;
    }

    return crate_ints(&w->crate, w->numbers, count);
}

static void put_subset(UsdWriter *w, const SheetPart *part, uint32_t mesh, const char *name, bool fresh) {
    static const char *const names[] = {"elementType", "familyName", "indices"};
    const uint32_t prim = crate_path(&w->crate, name, false, mesh);
    CrateField fields[] = {{"specifier", crate_inline(CRATE_SPECIFIER, 0)},
                           {"typeName", crate_token(&w->crate, "GeomSubset")},
                           {"properties", crate_token_list(&w->crate, names, 3)}};
    crate_spec(&w->crate, prim, CRATE_PRIM, fields, 3);
    put_uniform(w, prim, names[0], "token", crate_token(&w->crate, "face"));
    put_uniform(w, prim, names[1], "token", crate_token(&w->crate, "materialBind"));

    const CrateValue faces = w->kept ? 0 : put_subset_faces(w, part, fresh);
    put_sampled(w, prim, names[2], "int[]", false, put_samples(w, part->sheet, SLOT_SUBSETS + fresh, faces));
}

static void put_own(UsdWriter *w, const SheetPart *part, CrateValue values[USD_OWN]) {
    const SingeSurface *s = w->surface;
    values[USD_POINTS] = put_vectors(w, part, s->position, 3);
    values[USD_VELOCITIES] = put_vectors(w, part, s->velocity, 3);
    values[USD_NORMALS] = put_vectors(w, part, s->normal, 3);
    values[USD_ST] = put_vectors(w, part, s->uv, 2);
    values[USD_REST] = put_vectors(w, part, s->rest_position, 3);

    float box[6] = {0};
    for (uint32_t i = 0; i < part->count; i++) box_grow(box, s->position[part->vertices[i]], i == 0);
    values[USD_EXTENT] = crate_floats(&w->crate, 3, box, 2);

    put_colours(w, part, &values[USD_COLOUR], &values[USD_COLOUR_INDICES]);

    // the palette of glow: dark and the steps that occur
    float colours[EMBER_STEPS * EMBER_PARTS][3];
    int32_t entries[EMBER_STEPS * EMBER_PARTS], found = 0;
    memset(entries, 0xff, sizeof entries);

    for (uint32_t i = 0; i < part->count; i++) {
        const uint16_t step = ember_vertex(s, part->vertices[i]);
        if (entries[step] < 0) {
            ember_colour(step, colours[found]);
            entries[step] = found++;
        }

        w->numbers[i] = entries[step];
    }

    values[USD_EMBER] = crate_floats(&w->crate, 3, colours[0], (size_t)found);
    values[USD_EMBER_INDICES] = crate_ints(&w->crate, w->numbers, part->count);

    for (uint32_t i = 0; i < part->triangle_count; i++) w->numbers[i] = 3;
    values[USD_COUNTS] = crate_ints(&w->crate, w->numbers, part->triangle_count);
    for (uint32_t i = 0; i < part->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            w->numbers[3 * i + (uint32_t)k] = (int32_t)w->parts.local[w->surface->triangles[part->triangles[i]][k]];
    values[USD_INDICES] = crate_ints(&w->crate, w->numbers, 3 * (size_t)part->triangle_count);
}

static CrateValue put_field(UsdWriter *w, const SheetPart *part, const SurfaceField *field) {
    const void *values = surface_field(w->surface, field);
    if (values) values = gather(w, part, values, 1);
    else values = memset(w->gathered, 0, part->count * sizeof *w->gathered); // dry, as its picture of moisture is black
    return field->integer ? crate_ints(&w->crate, values, part->count)
                          : crate_floats(&w->crate, 1, values, part->count);
}

static void put_mesh(UsdWriter *w, uint32_t sheets, uint32_t sheet) {
    static const char *const uniforms[][2] = {
        {"subdivisionScheme", "none"}, {"orientation", "rightHanded"}, {"doubleSided", NULL}};
    const SheetPart part = w->kept ? (SheetPart){.sheet = sheet} : sheet_part(&w->parts, sheet);
    const bool pictured = w->scene->sheets[sheet].picture != NULL;
    const char *names[ATTRIBUTES_MAX + 4];

    // programs that bind no subsets, such as Blender from the second frame on, use the first for all faces
    const char *children[] = {"burnt", "fresh"};
    char primvars[SURFACE_FIELDS][40], name[USD_NAME];
    const int own = surface_field_count(w->scene->wet);
    size_t count = 0;

    for (int i = 0; i < 3; i++) names[count++] = uniforms[i][0];
    for (int i = 0; i < USD_OWN; i++) names[count++] = usd_attributes[i].name;

    for (int i = 0; i < own; i++) {
        strcat(strcpy(primvars[i], "primvars:"), surface_fields[i].name);
        names[count++] = primvars[i];
    }

    if (pictured) names[count++] = "subsetFamily:materialBind:familyType";
    usd_sheet_name(w->scene, sheet, name);

    const uint32_t mesh = crate_path(&w->crate, name, false, sheets);
    CrateField fields[PRIM_FIELDS] = {{"specifier", crate_inline(CRATE_SPECIFIER, 0)},
                                      {"typeName", crate_token(&w->crate, "Mesh")},
                                      {"properties", crate_token_list(&w->crate, names, count)}};
    if (pictured) fields[3] = (CrateField){"primChildren", crate_token_list(&w->crate, children, 2)};
    crate_spec(&w->crate, mesh, CRATE_PRIM, fields, pictured ? 4 : 3);

    for (int i = 0; i < 2; i++) put_uniform(w, mesh, uniforms[i][0], "token", crate_token(&w->crate, uniforms[i][1]));
    put_uniform(w, mesh, uniforms[2][0], "bool", crate_inline(CRATE_BOOL, 1));
    CrateValue values[USD_OWN] = {0};
    if (!w->kept) put_own(w, &part, values);

    for (int i = 0; i < USD_OWN; i++)
        put_sampled(w, mesh, usd_attributes[i].name, usd_attributes[i].type, usd_attributes[i].vertex,
                    put_samples(w, sheet, i, values[i]));

    for (int i = 0; i < own; i++) {
        const CrateValue value = w->kept ? 0 : put_field(w, &part, &surface_fields[i]);
        put_sampled(w, mesh, primvars[i], surface_fields[i].integer ? "int[]" : "float[]", true,
                    put_samples(w, sheet, SLOT_FIELDS + i, value));
    }

    if (!pictured) return;
    put_uniform(w, mesh, "subsetFamily:materialBind:familyType", "token", crate_token(&w->crate, "nonOverlapping"));
    put_subset(w, &part, mesh, children[0], false);
    put_subset(w, &part, mesh, children[1], true);
}

static uint32_t put_group(UsdWriter *w, const char *name, uint32_t parent, const char *const *children, size_t count) {
    const uint32_t prim = crate_path(&w->crate, name, false, parent);
    CrateField fields[] = {{"specifier", crate_inline(CRATE_SPECIFIER, 0)},
                           {"typeName", crate_token(&w->crate, "Xform")},
                           {"primChildren", crate_token_list(&w->crate, children, count)}};
    crate_spec(&w->crate, prim, CRATE_PRIM, fields, 3);
    return prim;
}

static void put_stage(UsdWriter *w, int first, int last) {
    Crate *crate = &w->crate;
    const uint32_t count = w->scene->sheet_count;
    char name[USD_NAME];
    const char *only[1] = {name};

    usd_name(w->scene->name, name);

    const uint32_t root = crate_path(crate, "", false, CRATE_NO_PARENT);
    CrateField fields[] = {{"defaultPrim", crate_token(crate, name)},
                           {"metersPerUnit", crate_double(1)},
                           {"upAxis", crate_token(crate, "Z")},
                           {"startTimeCode", crate_double((float)first)},
                           {"endTimeCode", crate_double((float)last)},
                           {"timeCodesPerSecond", crate_double(w->scene->fps)},
                           {"framesPerSecond", crate_double(w->scene->fps)},
                           {"primChildren", crate_token_list(crate, only, 1)}};
    crate_spec(crate, root, CRATE_ROOT, fields, sizeof fields / sizeof *fields);
    static const char *const sheets[] = {"sheets"};

    const uint32_t top = put_group(w, name, root, sheets, 1);
    char(*names)[USD_NAME] = store_new(w->crate.sink.allocator, count, USD_NAME);
    const char **list = store_new(w->crate.sink.allocator, count, sizeof *list);

    if (names && list) {
        for (uint32_t i = 0; i < count; i++) {
            usd_sheet_name(w->scene, i, names[i]);
            list[i] = names[i];
        }

        const uint32_t group = put_group(w, sheets[0], top, list, count);
        w->time = crate_times(crate, first, (size_t)(last - first) + 1);
        for (uint32_t i = 0; i < count; i++) put_mesh(w, group, i);
    } else {
        crate->sink.failed = true;
    }

    store_free(w->crate.sink.allocator, names, count, USD_NAME);
    store_free(w->crate.sink.allocator, list, count, sizeof *list);
}

/// Writes a frame into the crate of a writer; free the writer, also after failure.
static SingeResult put_one(UsdWriter *w, const OutputScene *scene, const OutputFrame *frame, const char *path,
                           SingeError *error) {
    *w = (UsdWriter){.scene = scene, .surface = frame->surface};
    crate_begin(&w->crate, frame->surface->allocator);
    sink_reserve(&w->crate.sink, 4096 + 96 * (size_t)frame->surface->vertex_count); // mostly enough
    SingeResult result = sheet_parts_make(&w->parts, frame->surface, scene->sheet_count, path, error);
    if (!result && !writer_make(w)) result = refuse_memory(error, "usd", path);
    if (!result) put_stage(w, frame->number, frame->number);
    return result;
}

SingeResult usd_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame, SingeError *error) {
    UsdWriter writer;
    SingeResult result = put_one(&writer, scene, frame, path, error);
    if (!result) result = crate_write(&writer.crate, path, error);
    writer_free(&writer);
    return result;
}

SingeResult usd_frame_bytes(const char *path, const OutputScene *scene, const OutputFrame *frame, Sink *bytes,
                            SingeError *error) {
    UsdWriter writer;
    SingeResult result = put_one(&writer, scene, frame, path, error);
    if (!result && !crate_take(&writer.crate, bytes)) result = refuse_memory(error, "usd", path);
    writer_free(&writer);
    return result;
}

// ---- all frames in one

SingeResult usd_write_single(const char *path, const OutputScene *scene, const OutputCache *cache, SingeError *error) {
    const size_t frames = (size_t)cache->frames, each = (size_t)scene->sheet_count * SLOTS;
    const SingeAllocator a = {0};
    UsdWriter writer = {.scene = scene, .frames = frames};
    SingeResult result = SINGE_OK;

    crate_begin(&writer.crate, a);

    CrateValue *kept = store_new(a, frames * each, sizeof *kept);
    writer.column = store_new(a, frames, sizeof *writer.column);
    if (!kept || !writer.column) result = refuse_memory(error, "usd", path);

    for (int i = 1; i <= cache->frames && !result; i++) {
        OutputFrame frame;
        result = cache->read(cache->context, i, &frame, error);
        if (result) break;

        // the values of the frame
        CrateValue *own = kept + (size_t)(i - 1) * each;
        UsdWriter one = {.crate = writer.crate, .scene = scene, .surface = frame.surface};
        result = sheet_parts_make(&one.parts, frame.surface, scene->sheet_count, path, error);
        if (!result && !writer_make(&one)) result = refuse_memory(error, "usd", path);

        for (uint32_t sheet = 0; sheet < scene->sheet_count && !result; sheet++, own += SLOTS) {
            const SheetPart part = sheet_part(&one.parts, sheet);
            put_own(&one, &part, own);
            for (int k = 0; k < surface_field_count(scene->wet); k++)
                own[SLOT_FIELDS + k] = put_field(&one, &part, &surface_fields[k]);
            for (int k = 0; k < 2; k++) own[SLOT_SUBSETS + k] = put_subset_faces(&one, &part, k);
        }

        writer.crate = one.crate; // keep everything written so far
        one.crate = (Crate){.sink = {.allocator = frame.surface->allocator}};
        writer_free(&one);
    }

    writer.kept = kept;
    if (!result) {
        put_stage(&writer, 1, cache->frames);
        result = crate_write(&writer.crate, path, error);
    }

    crate_free(&writer.crate);
    store_free(a, kept, frames * each, sizeof *kept);
    store_free(a, writer.column, frames, sizeof *writer.column);
    return result;
}

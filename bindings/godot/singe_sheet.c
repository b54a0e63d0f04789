// The node SingeSheet: a rectangle of paper or cloth that burns live in the scene, or a run's cache that plays. It uses the
// public headers of Singe alone. A frame allocates nothing: the surface has room for the sheet's drawn mesh, and is
// written in place; what has burnt away are triangles without area. Only a surface that outgrows it is made anew.
//
// A node's axes are y up; the sheet lies in its x-y plane and is simulated in its axes, with gravity turned into them.
#include "burning_sheet.h"
#include "cache.h"
#include "godot.h"

#include <singe/singe.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    FORMAT_VERTEX = 1,
    FORMAT_NORMAL = 2,
    FORMAT_COLOUR = 8,
    FORMAT_UV = 16,
    FORMAT_INDEX = 1 << 12,
    FORMAT_DYNAMIC = 1 << 26,
    SURFACE_FORMAT = FORMAT_VERTEX | FORMAT_NORMAL | FORMAT_COLOUR | FORMAT_UV | FORMAT_INDEX | FORMAT_DYNAMIC,
    PATH_SIZE = 1024
};
static const int64_t surface_format = SURFACE_FORMAT | (int64_t)1 << 35; // version 2, of Godot 4.2 and later

/// Methods of the engine, fetched when the first node is made.
static struct {
    GDExtensionMethodBindPtr mesh_create, add_surface, clear, update_vertices, update_attributes, update_indices,
        set_box, free_rid, offset, normal_stride, attribute_stride, index_stride, set_base, transform;
} calls;

typedef struct SingeSheet {
    void *object; ///< the engine's
    uint64_t mesh;
    BurningSheet live;
    char cache[PATH_SIZE];
    int64_t frame;
    // what is drawn
    GodotBytes vertices, attributes, indices;
    int64_t vertex_room, index_room, normal_offset, normal_stride, colour_offset, uv_offset, attribute_stride,
        index_stride;
    int64_t triangles_drawn;
    float box[6]; ///< position and size
    CacheFrame played;
} SingeSheet;

// ---- drawing

/// A unit vector as two halves of a word, as the engine has it.
static uint32_t octahedron(const float n[3]) {
    const float sum = fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]), scale = sum > 0 ? 1 / sum : 0;
    float x = n[0] * scale, y = n[1] * scale;
    if (n[2] < 0) {
        const float folded = (1 - fabsf(y)) * (x >= 0 ? 1 : -1);
        y = (1 - fabsf(x)) * (y >= 0 ? 1 : -1);
        x = folded;
    }
    return (uint32_t)((x * 0.5f + 0.5f) * 65535) | (uint32_t)((y * 0.5f + 0.5f) * 65535) << 16;
}

/// Makes room for a mesh, half as much again as it has now.
static void sheet_make_room(SingeSheet *self, int64_t vertices, int64_t triangles) {
    if (vertices <= self->vertex_room && 3 * triangles <= self->index_room) return;
    self->vertex_room = vertices + vertices / 2 + 3;
    self->index_room = 3 * (triangles + triangles / 2 + 1);
    int64_t *room = &self->vertex_room, position = 1, colour = 3, uv = 4; // of RenderingServer.ArrayType
    const void *format[] = {&surface_format, room}, *normal_at[] = {&surface_format, room, &position},
               *colour_at[] = {&surface_format, room, &colour}, *uv_at[] = {&surface_format, room, &uv};
    godot_call(calls.offset, NULL, normal_at, &self->normal_offset);
    godot_call(calls.offset, NULL, colour_at, &self->colour_offset);
    godot_call(calls.offset, NULL, uv_at, &self->uv_offset);
    godot_call(calls.normal_stride, NULL, format, &self->normal_stride);
    godot_call(calls.attribute_stride, NULL, format, &self->attribute_stride);
    godot_call(calls.index_stride, NULL, format, &self->index_stride);
    godot_bytes_make(&self->vertices, self->vertex_room * (12 + self->normal_stride));
    godot_bytes_make(&self->attributes, self->vertex_room * self->attribute_stride);
    godot_bytes_make(&self->indices, self->index_room * self->index_stride);
    const void *mesh[] = {&self->mesh};
    godot_call(calls.clear, NULL, mesh, NULL);
    godot_add_surface(calls.add_surface, self->mesh,
                      &(GodotSurface){.format = surface_format,
                                      .vertex_count = self->vertex_room,
                                      .index_count = self->index_room,
                                      .vertices = &self->vertices,
                                      .attributes = &self->attributes,
                                      .indices = &self->indices,
                                      .box = {-1, -1, -1, 2, 2, 2}});
}

static void sheet_send(SingeSheet *self) {
    int64_t surface = 0, offset = 0;
    const void *vertices[] = {&self->mesh, &surface, &offset, self->vertices.packed};
    const void *attributes[] = {&self->mesh, &surface, &offset, self->attributes.packed};
    const void *indices[] = {&self->mesh, &surface, &offset, self->indices.packed};
    godot_call(calls.update_vertices, NULL, vertices, NULL);
    godot_call(calls.update_attributes, NULL, attributes, NULL);
    godot_call(calls.update_indices, NULL, indices, NULL);
}

/// Shows a mesh: `vertex` fills in number i of `vertices`.
static void sheet_show(SingeSheet *self, int64_t vertices, int64_t triangles, const uint32_t (*corners)[3],
                       void (*vertex)(const void *mesh, int64_t i, SheetVertex *v), const void *mesh) {
    sheet_make_room(self, vertices, triangles);
    uint8_t *points = godot_bytes_data(&self->vertices), *attributes = godot_bytes_data(&self->attributes);
    uint8_t *normals =
        self->normal_offset < 12 * self->vertex_room ? points + 12 * self->vertex_room : points + self->normal_offset;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t i = 0; i < vertices; i++) {
        SheetVertex v;
        vertex(mesh, i, &v);
        for (int c = 0; c < 3; c++) {
            low[c] = fminf(low[c], v.position[c]);
            high[c] = fmaxf(high[c], v.position[c]);
        }
        const uint32_t normal = octahedron(v.normal);
        uint8_t colour[4];
        burning_colour(v.temperature, v.peak, v.burn, colour);
        memcpy(points + 12 * i, v.position, 12);
        memcpy(normals + self->normal_stride * i, &normal, 4);
        memcpy(attributes + self->attribute_stride * i + self->colour_offset, colour, 4);
        memcpy(attributes + self->attribute_stride * i + self->uv_offset, v.uv, 8);
    }
    uint8_t *indices = godot_bytes_data(&self->indices);
    memset(indices, 0, (size_t)self->indices.size);
    for (int64_t t = 0; t < triangles; t++)
        for (int k = 0; k < 3; k++) { // the engine's fronts turn clockwise
            const uint32_t corner = corners[t][2 - k];
            const uint16_t half = (uint16_t)corner;
            memcpy(indices + self->index_stride * (3 * t + k), self->index_stride == 2 ? (const void *)&half : &corner,
                   (size_t)self->index_stride);
        }
    self->triangles_drawn = triangles;
    sheet_send(self);
    for (int c = 0; c < 3 && vertices; c++) self->box[c] = low[c], self->box[3 + c] = high[c] - low[c];
    const void *arguments[] = {&self->mesh, self->box};
    godot_call(calls.set_box, NULL, arguments, NULL);
}

static void surface_vertex(const void *mesh, int64_t i, SheetVertex *v) {
    const SingeSurface *surface = mesh;
    memcpy(v->position, surface->position[i], 12);
    memcpy(v->normal, surface->normal[i], 12);
    memcpy(v->uv, surface->uv[i], 8);
    v->temperature = surface->temperature[i], v->peak = surface->temperature_peak[i], v->burn = surface->burn[i];
}

static void sheet_draw(SingeSheet *self) {
    const SingeSurface *surface = &self->live.surface;
    sheet_show(self, surface->vertex_count, surface->triangle_count, (const uint32_t(*)[3])surface->triangles,
               surface_vertex, surface);
}

// ---- living

static void *sheet_create(void *object) {
    if (!calls.mesh_create) {
        calls.mesh_create = godot_method("RenderingServer", "mesh_create", 529393457);
        calls.add_surface = godot_method("RenderingServer", "mesh_add_surface", 1217542888);
        calls.clear = godot_method("RenderingServer", "mesh_clear", 2722037293);
        calls.update_vertices = godot_method("RenderingServer", "mesh_surface_update_vertex_region", 2900195149);
        calls.update_attributes = godot_method("RenderingServer", "mesh_surface_update_attribute_region", 2900195149);
        calls.update_indices = godot_method("RenderingServer", "mesh_surface_update_index_region", 2900195149);
        calls.set_box = godot_method("RenderingServer", "mesh_set_custom_aabb", 3696536120);
        calls.free_rid = godot_method("RenderingServer", "free_rid", 2722037293);
        calls.offset = godot_method("RenderingServer", "mesh_surface_get_format_offset", 2981368685);
        calls.normal_stride =
            godot_method("RenderingServer", "mesh_surface_get_format_normal_tangent_stride", 3188363337);
        calls.attribute_stride =
            godot_method("RenderingServer", "mesh_surface_get_format_attribute_stride", 3188363337);
        calls.index_stride = godot_method("RenderingServer", "mesh_surface_get_format_index_stride", 3188363337);
        calls.set_base = godot_method("VisualInstance3D", "set_base", 2722037293);
        calls.transform = godot_method("Node3D", "get_global_transform", 3229777777);
    }
    SingeSheet *self = calloc(1, sizeof *self);
    if (!self) abort(); // as the engine does
    *self = (SingeSheet){.object = object, .live = burning_default(), .frame = 1};
    godot_call(calls.mesh_create, NULL, NULL, &self->mesh);
    const void *arguments[] = {&self->mesh};
    godot_call(calls.set_base, object, arguments, NULL);
    return self;
}

static void sheet_destroy(void *data) {
    SingeSheet *self = data;
    burning_stop(&self->live);
    cache_free(&self->played);
    const void *arguments[] = {&self->mesh};
    godot_call(calls.free_rid, NULL, arguments, NULL);
    godot_bytes_free(&self->vertices);
    godot_bytes_free(&self->attributes);
    godot_bytes_free(&self->indices);
    free(self);
}

static void sheet_process(void *data, double seconds) {
    SingeSheet *self = data;
    if (!self->live.sim) return;
    if (burning_advance(&self->live, seconds)) {
        sheet_draw(self);
        return;
    }
    godot_error("the sheet stands still", self->live.error.message);
    burning_stop(&self->live);
}

static void sheet_bounds(const void *data, float box[6]) { memcpy(box, ((const SingeSheet *)data)->box, 24); }

/// Gravity, in the node's own axes.
static void sheet_gravity(const SingeSheet *self, float gravity[3]) {
    GodotValue transform = {0};
    godot_call(calls.transform, self->object, NULL, &transform);
    float length = 0;
    for (int c = 0; c < 3; c++) { // the second row of its columns: how far each axis points up
        gravity[c] = transform.vector[3 + c];
        length += gravity[c] * gravity[c];
    }
    for (int c = 0; c < 3; c++) gravity[c] *= length > 0 ? -9.81f / sqrtf(length) : 0;
}

static void sheet_start(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    (void)arguments;
    sheet_gravity(self, self->live.gravity);
    result->yes = burning_start(&self->live);
    if (result->yes) sheet_draw(self);
    else godot_error("cannot start", self->live.error.message);
}

/// The result of a call on the sheet; what went wrong is printed.
static void sheet_answer(const SingeSheet *self, GodotValue *result, bool good) {
    result->yes = good;
    if (!good) godot_error("not possible", self->live.error.message);
}

static void sheet_pin(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    sheet_answer(self, result, burning_pin(&self->live, arguments[0]->vector, (float)arguments[1]->real));
}

static void sheet_ignite(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    sheet_answer(
        self, result,
        burning_ignite(&self->live, arguments[0]->vector, (float)arguments[1]->real, (float)arguments[2]->real));
}

static void sheet_blow(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    sheet_answer(self, result, burning_blow(&self->live, arguments[0]->vector, (float)arguments[1]->real));
}

static void sheet_add_sphere(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    sheet_answer(self, result, burning_add_sphere(&self->live, arguments[0]->vector, (float)arguments[1]->real));
}

static void sheet_add_plane(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    sheet_answer(self, result, burning_add_plane(&self->live, arguments[0]->vector, arguments[1]->vector));
}

static void sheet_end(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments, (void)result;
    burning_stop(&((SingeSheet *)data)->live);
}

static void sheet_burnt(void *data, const GodotValue *const *arguments, GodotValue *result) {
    const SingeSheet *self = data;
    (void)arguments;
    result->real = self->live.sim ? singe_sim_stats(self->live.sim).burnt_fraction : 0;
}

static void sheet_springs(void *data, const GodotValue *const *arguments, GodotValue *result) {
    const SingeSheet *self = data;
    (void)arguments;
    result->whole = self->live.sim ? singe_sim_stats(self->live.sim).springs : 0;
}

static void sheet_milliseconds(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments;
    result->real = ((const SingeSheet *)data)->live.milliseconds;
}

static void sheet_processor(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments;
    result->real = ((const SingeSheet *)data)->live.processor_time;
}

static void sheet_allocations(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments;
    result->whole = (int64_t)((const SingeSheet *)data)->live.allocations;
}

static void sheet_triangles(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments;
    result->whole = ((const SingeSheet *)data)->triangles_drawn;
}

// ---- a cache

/// Shows the frame of the cache that `frame` names.
static void sheet_play(SingeSheet *self) {
    if (!self->cache[0] || self->live.sim) return;
    char why[PATH_SIZE + 128];
    GodotValue path = godot_string(self->cache);
    char file[PATH_SIZE];
    godot_path(&path, file, sizeof file);
    godot_string_free(&path);
    if (!cache_read(file, self->frame, &self->played, why, sizeof why)) {
        godot_error("no frame of a cache", why);
        return;
    }
    sheet_show(self, self->played.vertex_count, self->played.triangle_count, self->played.triangles, cache_vertex,
               &self->played);
}

// ---- properties

static void sheet_cells(SingeSheet *self, const int32_t cells[2]) {
    for (int i = 0; i < 2; i++)
        self->live.cells[i] = cells[i] > 0 ? (uint32_t)cells[i] : 0; // 0 is refused at the start
}

#define PROPERTY(name, set, get)                                                                       \
    static void sheet_set_##name(void *data, const GodotValue *const *arguments, GodotValue *result) { \
        SingeSheet *self = data;                                                                       \
        (void)result;                                                                                  \
        set;                                                                                           \
    }                                                                                                  \
    static void sheet_get_##name(void *data, const GodotValue *const *arguments, GodotValue *result) { \
        const SingeSheet *self = data;                                                                 \
        (void)arguments;                                                                               \
        get;                                                                                           \
    }
PROPERTY(size, memcpy(self->live.size, arguments[0]->vector, 8), memcpy(result->vector, self->live.size, 8))
PROPERTY(cells, sheet_cells(self, arguments[0]->cells), memcpy(result->cells, self->live.cells, 8))
PROPERTY(material, godot_text(arguments[0], self->live.material, sizeof self->live.material),
         *result = godot_string(self->live.material))
PROPERTY(pace, self->live.pace = (float)arguments[0]->real, result->real = (double)self->live.pace)
PROPERTY(detail, self->live.detail = (float)arguments[0]->real, result->real = (double)self->live.detail)
PROPERTY(threads, self->live.threads = (int)arguments[0]->whole, result->whole = self->live.threads)
PROPERTY(frame, self->frame = arguments[0]->whole; sheet_play(self), result->whole = self->frame)
PROPERTY(cache, godot_text(arguments[0], self->cache, PATH_SIZE); sheet_play(self), *result = godot_string(self->cache))

#define NONE GDEXTENSION_VARIANT_TYPE_NIL
#define YES GDEXTENSION_VARIANT_TYPE_BOOL
#define WHOLE GDEXTENSION_VARIANT_TYPE_INT
#define REAL GDEXTENSION_VARIANT_TYPE_FLOAT
#define TEXT GDEXTENSION_VARIANT_TYPE_STRING
#define VECTOR2 GDEXTENSION_VARIANT_TYPE_VECTOR2
#define CELLS GDEXTENSION_VARIANT_TYPE_VECTOR2I
#define VECTOR3 GDEXTENSION_VARIANT_TYPE_VECTOR3
#define ACCESS(name, type)                                          \
    {"set_" #name, sheet_set_##name, NONE, 1, {"value"}, {type}}, { \
        "get_" #name, sheet_get_##name, type, 0, {0}, { 0 }         \
    }

static const GodotMethod sheet_methods[] = {
    ACCESS(size, VECTOR2),
    ACCESS(cells, CELLS),
    ACCESS(material, TEXT),
    ACCESS(pace, REAL),
    ACCESS(detail, REAL),
    ACCESS(threads, WHOLE),
    ACCESS(cache, TEXT),
    ACCESS(frame, WHOLE),
    {"start", sheet_start, YES, 0, {0}, {0}},
    {"stop", sheet_end, NONE, 0, {0}, {0}},
    {"pin", sheet_pin, YES, 2, {"point", "radius"}, {VECTOR3, REAL}},
    {"ignite", sheet_ignite, YES, 3, {"point", "radius", "seconds"}, {VECTOR3, REAL, REAL}},
    {"blow", sheet_blow, YES, 2, {"velocity", "gust"}, {VECTOR3, REAL}},
    {"add_sphere", sheet_add_sphere, YES, 2, {"centre", "radius"}, {VECTOR3, REAL}},
    {"add_plane", sheet_add_plane, YES, 2, {"point", "normal"}, {VECTOR3, VECTOR3}},
    {"get_burnt", sheet_burnt, REAL, 0, {0}, {0}},
    {"get_springs", sheet_springs, WHOLE, 0, {0}, {0}},
    {"get_triangles", sheet_triangles, WHOLE, 0, {0}, {0}},
    {"get_milliseconds", sheet_milliseconds, REAL, 0, {0}, {0}},
    {"get_processor_milliseconds", sheet_processor, REAL, 0, {0}, {0}},
    {"get_allocations", sheet_allocations, WHOLE, 0, {0}, {0}},
};

static const GodotProperty sheet_properties[] = {
    {"size", VECTOR2}, {"cells", CELLS},   {"material", TEXT}, {"pace", REAL},
    {"detail", REAL},  {"threads", WHOLE}, {"cache", TEXT},    {"frame", WHOLE},
};

static const GodotClass sheet_class = {
    .name = "SingeSheet",
    .parent = "GeometryInstance3D",
    .create = sheet_create,
    .destroy = sheet_destroy,
    .process = sheet_process,
    .bounds = sheet_bounds,
    .methods = sheet_methods,
    .method_count = sizeof sheet_methods / sizeof *sheet_methods,
    .properties = sheet_properties,
    .property_count = sizeof sheet_properties / sizeof *sheet_properties,
};

static void begin(void *data, GDExtensionInitializationLevel level) {
    (void)data;
    if (level == GDEXTENSION_INITIALIZATION_SCENE) godot_register(&sheet_class);
}

static void end(void *data, GDExtensionInitializationLevel level) {
    (void)data;
    if (level == GDEXTENSION_INITIALIZATION_SCENE) godot_unregister(&sheet_class);
}

/// What the engine looks for, by the name in singe.gdextension.
SINGE_API GDExtensionBool singe_godot_begin(GDExtensionInterfaceGetProcAddress get, GDExtensionClassLibraryPtr library,
                                            GDExtensionInitialization *made);

GDExtensionBool singe_godot_begin(GDExtensionInterfaceGetProcAddress get, GDExtensionClassLibraryPtr library,
                                  GDExtensionInitialization *made) {
    *made = (GDExtensionInitialization){GDEXTENSION_INITIALIZATION_SCENE, NULL, begin, end};
    return godot_begin(get, library);
}

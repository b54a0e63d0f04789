// The node SingeSheet: a rectangle of paper or cloth that burns live in the scene, or a run's cache that plays. It uses the
// public headers of Singe alone. A frame allocates nothing: the surface has room for the sheet's drawn mesh, and is
// written in place; what has burnt away are triangles without area. Only a surface that outgrows it is made anew.
//
// A node's axes are y up; the sheet lies in its x-y plane and is simulated in its axes, with gravity turned into them.
#include "cache.h"
#include "godot.h"

#include <singe/mesh.h>
#include <singe/singe.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    FORMAT_VERTEX = 1,
    FORMAT_NORMAL = 2,
    FORMAT_COLOUR = 8,
    FORMAT_UV = 16,
    FORMAT_INDEX = 1 << 12,
    FORMAT_DYNAMIC = 1 << 26,
    SURFACE_FORMAT = FORMAT_VERTEX | FORMAT_NORMAL | FORMAT_COLOUR | FORMAT_UV | FORMAT_INDEX | FORMAT_DYNAMIC,
    PATH_SIZE = 1024,
    KEPT = 8
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
    // properties
    float size[2];
    int32_t cells[2];
    char material[64], cache[PATH_SIZE];
    double pace, detail;
    int64_t frame, threads;
    // live
    SingeSim *sim;
    SingeSheetId id;
    SingeSurface surface;
    uint64_t allocations, allocations_at_start;
    struct { ///< blocks that drawing has freed, for the next frame
        void *block;
        size_t size;
    } kept[KEPT];
    double milliseconds, processor_milliseconds; ///< of the last frame
    // what is drawn
    GodotBytes vertices, attributes, indices;
    int64_t vertex_room, index_room, normal_offset, normal_stride, colour_offset, uv_offset, attribute_stride,
        index_stride;
    int64_t triangles_drawn;
    float box[6]; ///< position and size
    CacheFrame played;
} SingeSheet;

// ---- memory, which is counted

static void *sheet_resize(void *context, void *block, size_t old_size, size_t new_size) {
    SingeSheet *self = context;
    (void)old_size;
    if (!new_size) {
        free(block);
        return NULL;
    }
    self->allocations++;
    return realloc(block, new_size);
}

/// For drawing, which frees in each frame what it has asked for.
static void *sheet_resize_kept(void *context, void *block, size_t old_size, size_t new_size) {
    SingeSheet *self = context;
    for (int i = 0; i < KEPT && !block; i++)
        if (self->kept[i].block && self->kept[i].size >= new_size) {
            block = self->kept[i].block;
            self->kept[i].block = NULL;
            return block;
        }
    for (int i = 0; i < KEPT && block && !new_size; i++)
        if (!self->kept[i].block) {
            self->kept[i].block = block, self->kept[i].size = old_size;
            return NULL;
        }
    return sheet_resize(context, block, old_size, new_size);
}

static double now(void) {
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

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

static uint8_t byte_of(float value) { return (uint8_t)(fminf(fmaxf(value, 0), 1) * 255); }

/// Red, green and blue are how far it has browned, charred and turned to ash, for the material's `albedo`; alpha is how
/// brightly it glows.
static void colour_of(const SheetVertex *v, uint8_t colour[4]) {
    const float brown = fminf(fmaxf((v->peak - 430) / 200, 0), 1);
    const float black = fminf(3 * v->burn, 1), grey = v->burn > 0.5f ? 2 * v->burn - 1 : 0;
    static const float fresh[3] = {1, 1, 1}, scorched[3] = {0.45f, 0.26f, 0.1f}, charred[3] = {0.02f, 0.018f, 0.016f},
                       ash[3] = {0.35f, 0.34f, 0.33f};
    for (int c = 0; c < 3; c++) {
        float value = fresh[c] + brown * (scorched[c] - fresh[c]);
        value += black * (charred[c] - value);
        value += grey * (ash[c] - value);
        colour[c] = byte_of(value);
    }
    colour[3] = byte_of((v->temperature - 900) / 500);
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
        colour_of(&v, colour);
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
    if (singe_sim_surface(self->sim, &self->surface)) {
        godot_error("cannot draw", singe_sim_error(self->sim)->message);
        return;
    }
    sheet_show(self, self->surface.vertex_count, self->surface.triangle_count,
               (const uint32_t(*)[3])self->surface.triangles, surface_vertex, &self->surface);
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
    *self = (SingeSheet){.object = object,
                         .size = {0.2f, 0.2f},
                         .cells = {32, 32},
                         .material = "office-paper",
                         .pace = 8,
                         .frame = 1,
                         .threads = 1};
    self->surface.allocator = (SingeAllocator){sheet_resize_kept, self};
    godot_call(calls.mesh_create, NULL, NULL, &self->mesh);
    const void *arguments[] = {&self->mesh};
    godot_call(calls.set_base, object, arguments, NULL);
    return self;
}

static void sheet_stop(SingeSheet *self) {
    singe_sim_destroy(self->sim);
    self->sim = NULL;
    singe_surface_free(&self->surface);
    for (int i = 0; i < KEPT; i++) {
        free(self->kept[i].block);
        self->kept[i].block = NULL;
    }
    self->surface.allocator = (SingeAllocator){sheet_resize_kept, self};
}

static void sheet_destroy(void *data) {
    SingeSheet *self = data;
    sheet_stop(self);
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
    if (!self->sim) return;
    const double before = now();
    const clock_t used = clock();
    // a slow frame slows the fire down and makes no more steps than a frame has time for
    if (singe_sim_advance(self->sim, seconds, 4, NULL)) {
        godot_error("the sheet stands still", singe_sim_error(self->sim)->message);
        sheet_stop(self);
        return;
    }
    sheet_draw(self);
    self->milliseconds = now() - before;
    self->processor_milliseconds = 1e3 * (double)(clock() - used) / CLOCKS_PER_SEC;
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

/// Builds the sheet; false, with the reason in *error, if it cannot be.
static bool sheet_build(SingeSheet *self, SingeError *error) {
    SingeGridDef grid = singe_default_grid();
    SingeSimDef def = singe_default_sim();
    SingeSheetDef sheet = singe_default_sheet();
    for (int i = 0; i < 2; i++) {
        grid.size[i] = self->size[i];
        grid.cells[i] = (uint32_t)(self->cells[i] > 0 ? self->cells[i] : 0);
    }
    def.allocator = (SingeAllocator){sheet_resize, self};
    def.pace = (float)self->pace, def.surface_detail = (float)self->detail, def.thread_count = (int)self->threads;
    def.time_step = 1.0f / 120;
    sheet_gravity(self, def.gravity);
    if (singe_material_preset(self->material, &sheet.material, error)) return false;
    SingeMesh *mesh = NULL;
    if (singe_mesh_create_grid(&grid, &mesh, error)) return false;
    singe_mesh_fill_sheet(mesh, &sheet);
    bool good = !singe_sim_create(&def, &self->sim, error);
    if (good && (singe_sim_add_sheet(self->sim, &sheet, &self->id) || singe_sim_commit(self->sim) ||
                 singe_sim_advance(self->sim, 0, 0, NULL))) {
        *error = *singe_sim_error(self->sim);
        good = false;
    }
    singe_mesh_destroy(mesh);
    return good;
}

static void sheet_start(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    SingeError error = {0};
    (void)arguments;
    sheet_stop(self);
    result->yes = sheet_build(self, &error);
    if (!result->yes) {
        godot_error("cannot start", error.message);
        sheet_stop(self);
        return;
    }
    sheet_draw(self);
    self->allocations_at_start = self->allocations;
}

/// Says why a call on the simulation failed, or that there is none.
static void sheet_answer(SingeSheet *self, GodotValue *result, SingeResult done) {
    result->yes = self->sim && !done;
    if (!self->sim) godot_error("not possible", "the sheet has not started");
    if (self->sim && done) godot_error("not possible", singe_sim_error(self->sim)->message);
}

static void sheet_pin(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    SingePinDef pin = singe_default_pin();
    pin.sheet = self->id, pin.point_count = 1, pin.points = arguments[0]->vector,
    pin.radius = (float)arguments[1]->real;
    sheet_answer(self, result, self->sim ? singe_sim_add_pin(self->sim, &pin, NULL) : SINGE_OK);
}

static void sheet_ignite(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    SingeSourceDef match = singe_default_source();
    memcpy(match.position, arguments[0]->vector, sizeof match.position);
    match.radius = match.falloff = (float)arguments[1]->real, match.temperature = 1123;
    if (self->sim) match.start = (float)singe_sim_view(self->sim).time;
    match.end = match.start + (float)arguments[2]->real;
    sheet_answer(self, result, self->sim ? singe_sim_add_source(self->sim, &match, NULL) : SINGE_OK);
}

static void sheet_blow(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    SingeWindDef wind = singe_default_sim().wind;
    memcpy(wind.velocity, arguments[0]->vector, sizeof wind.velocity);
    wind.gust = (float)arguments[1]->real;
    sheet_answer(self, result, self->sim ? singe_sim_set_wind(self->sim, &wind) : SINGE_OK);
}

static void sheet_add_sphere(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    SingeColliderDef ball = singe_default_collider();
    ball.kind = SINGE_COLLIDER_SPHERE, ball.radius = (float)arguments[1]->real;
    memcpy(ball.position, arguments[0]->vector, sizeof ball.position);
    sheet_answer(self, result, self->sim ? singe_sim_add_collider(self->sim, &ball, NULL) : SINGE_OK);
}

static void sheet_add_plane(void *data, const GodotValue *const *arguments, GodotValue *result) {
    SingeSheet *self = data;
    SingeColliderDef plane = singe_default_collider();
    const float *n = arguments[1]->vector, length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    memcpy(plane.position, arguments[0]->vector, sizeof plane.position);
    // the shortest turn from z to the normal
    const float w = length + n[2], scale = sqrtf(n[0] * n[0] + n[1] * n[1] + w * w);
    const float turn[4] = {-n[1] / scale, n[0] / scale, 0, w / scale}, over[4] = {1, 0, 0, 0};
    memcpy(plane.rotation, scale > 1e-6f ? turn : over, sizeof turn);
    sheet_answer(self, result, self->sim ? singe_sim_add_collider(self->sim, &plane, NULL) : SINGE_OK);
}

static void sheet_end(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments, (void)result;
    sheet_stop(data);
}

static void sheet_burnt(void *data, const GodotValue *const *arguments, GodotValue *result) {
    const SingeSheet *self = data;
    (void)arguments;
    result->real = self->sim ? singe_sim_stats(self->sim).burnt_fraction : 0;
}

static void sheet_springs(void *data, const GodotValue *const *arguments, GodotValue *result) {
    const SingeSheet *self = data;
    (void)arguments;
    result->whole = self->sim ? singe_sim_stats(self->sim).springs : 0;
}

static void sheet_milliseconds(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments;
    result->real = ((const SingeSheet *)data)->milliseconds;
}

static void sheet_processor(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments;
    result->real = ((const SingeSheet *)data)->processor_milliseconds;
}

static void sheet_allocations(void *data, const GodotValue *const *arguments, GodotValue *result) {
    const SingeSheet *self = data;
    (void)arguments;
    result->whole = (int64_t)(self->allocations - self->allocations_at_start);
}

static void sheet_triangles(void *data, const GodotValue *const *arguments, GodotValue *result) {
    (void)arguments;
    result->whole = ((const SingeSheet *)data)->triangles_drawn;
}

// ---- a cache

/// Shows the frame of the cache that `frame` names.
static void sheet_play(SingeSheet *self) {
    if (!self->cache[0] || self->sim) return;
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
PROPERTY(size, memcpy(self->size, arguments[0]->vector, 8), memcpy(result->vector, self->size, 8))
PROPERTY(cells, memcpy(self->cells, arguments[0]->cells, 8), memcpy(result->cells, self->cells, 8))
PROPERTY(material, godot_text(arguments[0], self->material, sizeof self->material),
         *result = godot_string(self->material))
PROPERTY(pace, self->pace = arguments[0]->real, result->real = self->pace)
PROPERTY(detail, self->detail = arguments[0]->real, result->real = self->detail)
PROPERTY(threads, self->threads = arguments[0]->whole, result->whole = self->threads)
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

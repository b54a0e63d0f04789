// The memory of a surface.
#include "surface/surface_parts.h"

#include <string.h>

typedef struct SurfaceArray {
    size_t offset, element_size;
} SurfaceArray;

#define ARRAY(field) \
    { offsetof(SingeSurface, field), sizeof *((SingeSurface *)0)->field }

static const SurfaceArray vertex_arrays[] = {
    ARRAY(position),
    ARRAY(normal),
    ARRAY(uv),
    ARRAY(velocity),
    ARRAY(rest_position),
    ARRAY(temperature),
    ARRAY(temperature_peak),
    ARRAY(mass),
    ARRAY(burn_rate),
    ARRAY(char_fraction),
    ARRAY(ash_fraction),
    ARRAY(burn),
    ARRAY(time_ignited),
    ARRAY(piece),
    ARRAY(source_vertex),
    ARRAY(sheet),
    ARRAY(water),
};
static const SurfaceArray triangle_array = ARRAY(triangles);

enum { VERTEX_ARRAYS = sizeof vertex_arrays / sizeof *vertex_arrays };

static void arrays_release(Memory *memory, SingeSurface *surface, const SurfaceArray *array, uint32_t count) {
    memory_free(memory, (char *)surface + array->offset, count, array->element_size);
}

static bool obtain(Memory *memory, SingeSurface *surface, const SurfaceArray *array, uint32_t count) {
    void *block = memory_new(memory, count, array->element_size);
    memcpy((char *)surface + array->offset, &block, sizeof block);
    return block != NULL;
}

void singe_surface_release(SingeSurface *surface, size_t struct_size) {
    if (!surface || struct_size < sizeof *surface) return;
    Memory memory = memory_make(surface->allocator);
    for (int i = 0; i < VERTEX_ARRAYS; i++)
        arrays_release(&memory, surface, &vertex_arrays[i], surface->vertex_capacity);
    arrays_release(&memory, surface, &triangle_array, surface->triangle_capacity);
    memset(surface, 0, struct_size);
}

void surface_clear(SingeSurface *surface) {
    SingeAllocator allocator = surface->allocator;
    singe_surface_free(surface);
    surface->allocator = allocator;
}

static SingeResult arrays_fail(SingeSurface *surface, SingeResult code, const char *message, SingeError *error) {
    surface_clear(surface);
    return error_set(error, code, "surface", -1, "%s", message);
}

static SingeResult arrays_reserve(SingeSurface *surface, const SurfaceArray *arrays, int array_count,
                                  uint32_t *capacity, uint64_t count, SingeError *error) {
    if (count > INT32_MAX) return arrays_fail(surface, SINGE_ERROR_LIMIT, "the surface has too many elements", error);
    if (count <= *capacity) return SINGE_OK;

    Memory memory = memory_make(surface->allocator);
    for (int i = 0; i < array_count; i++) arrays_release(&memory, surface, &arrays[i], *capacity);
    *capacity = (uint32_t)(count + count / 4); // a burning sheet's surface grows a little in most frames
    for (int i = 0; i < array_count; i++)
        if (!obtain(&memory, surface, &arrays[i], *capacity))
            return arrays_fail(surface, SINGE_ERROR_MEMORY, "out of memory for the surface", error);
    return SINGE_OK;
}

SingeResult surface_reserve_triangles(SingeSurface *surface, uint64_t count, SingeError *error) {
    return arrays_reserve(surface, &triangle_array, 1, &surface->triangle_capacity, count, error);
}

SingeResult surface_reserve_vertices(SingeSurface *surface, uint64_t count, SingeError *error) {
    return arrays_reserve(surface, vertex_arrays, VERTEX_ARRAYS, &surface->vertex_capacity, count, error);
}

SingeResult surface_grow_vertices(SingeSurface *surface, uint64_t count, SingeError *error) {
    if (count > INT32_MAX) return arrays_fail(surface, SINGE_ERROR_LIMIT, "the surface has too many elements", error);
    if (count <= surface->vertex_capacity) return SINGE_OK;

    Memory memory = memory_make(surface->allocator);
    SingeSurface grown = {.vertex_capacity = (uint32_t)(count + count / 4), .allocator = surface->allocator};
    bool good = true;

    // copy into larger arrays
    for (int i = 0; i < VERTEX_ARRAYS && good; i++) {
        const SurfaceArray *array = &vertex_arrays[i];
        void *from, *to;
        good = obtain(&memory, &grown, array, grown.vertex_capacity);
        memcpy(&from, (char *)surface + array->offset, sizeof from);
        memcpy(&to, (char *)&grown + array->offset, sizeof to);
        if (good && from) memcpy(to, from, surface->vertex_count * array->element_size);
    }

    for (int i = 0; i < VERTEX_ARRAYS; i++) { // frees the old ones, or on failure the new ones
        const SurfaceArray *array = &vertex_arrays[i];
        void *to;
        memcpy(&to, (char *)&grown + array->offset, sizeof to);
        arrays_release(&memory, good ? surface : &grown, array,
                       good ? surface->vertex_capacity : grown.vertex_capacity);
        if (good) memcpy((char *)surface + array->offset, &to, sizeof to);
    }

    if (!good) return arrays_fail(surface, SINGE_ERROR_MEMORY, "out of memory for the surface", error);
    surface->vertex_capacity = grown.vertex_capacity;
    return SINGE_OK;
}

void surface_copy_vertex(SingeSurface *surface, uint32_t from, uint32_t to) {
    for (int i = 0; i < VERTEX_ARRAYS; i++) {
        char *array;
        memcpy(&array, (char *)surface + vertex_arrays[i].offset, sizeof array);
        memcpy(array + to * vertex_arrays[i].element_size, array + from * vertex_arrays[i].element_size,
               vertex_arrays[i].element_size);
    }
}

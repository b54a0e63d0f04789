#include "common/store.h"

#include "common/allocator.h"
#include "common/printable.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool store_bytes(size_t count, size_t element_size, size_t *bytes) {
    if (element_size && count > SIZE_MAX / 2 / element_size) return false;
    *bytes = count * element_size;
    if (*bytes == 0) *bytes = 1;
    return true;
}

void *store_new(SingeAllocator allocator, size_t count, size_t element_size) {
    size_t bytes;
    return store_bytes(count, element_size, &bytes) ? allocator_resize(allocator, NULL, 0, bytes) : NULL;
}

void store_free(SingeAllocator allocator, void *array, size_t count, size_t element_size) {
    size_t bytes;
    if (array && store_bytes(count, element_size, &bytes)) allocator_resize(allocator, array, bytes, 0);
}

static bool store_set(SingeAllocator allocator, void *array_pointer, size_t *capacity, size_t count,
                      size_t element_size) {
    void *old, *moved;
    memcpy(&old, array_pointer, sizeof old);
    size_t old_bytes = 0, bytes;
    if (!store_bytes(count, element_size, &bytes)) return false;
    if (old && !store_bytes(*capacity, element_size, &old_bytes)) return false;

    moved = allocator_resize(allocator, old, old_bytes, bytes);
    if (!moved) return false;
    memcpy(array_pointer, &moved, sizeof moved);
    *capacity = count;
    return true;
}

bool store_grow(SingeAllocator allocator, void *array_pointer, size_t *capacity, size_t count, size_t element_size) {
    if (count <= *capacity) return true;
    size_t larger = *capacity > SIZE_MAX / 4 ? count : 2 * *capacity;
    if (larger < count) larger = count;
    if (larger < 16) larger = 16;
    return store_set(allocator, array_pointer, capacity, larger, element_size);
}

bool store_trim(SingeAllocator allocator, void *array_pointer, size_t *capacity, size_t count, size_t element_size) {
    return store_set(allocator, array_pointer, capacity, count, element_size);
}

void attributes_free(SingeAllocator allocator, SingeAttribute *attributes, uint32_t attribute_count, size_t count) {
    for (uint32_t i = 0; i < attribute_count; i++) {
        const SingeAttribute *attribute = &attributes[i];
        if (attribute->name) store_free(allocator, (void *)attribute->name, strlen(attribute->name) + 1, 1);
        store_free(allocator, (void *)attribute->values, count, sizeof *attribute->values);
    }
    store_free(allocator, attributes, attribute_count, sizeof *attributes);
}

SingeResult refuse(SingeError *error, SingeResult code, const char *stage, int64_t element, const char *format, ...) {
    if (!error) return code;
    memset(error, 0, sizeof *error);
    error->code = code;
    error->element = element;
    snprintf(error->stage, sizeof error->stage, "%s", stage);

    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    printable_trim(error->message);
    return code;
}

SingeResult refuse_memory(SingeError *error, const char *stage, const char *name) {
    return refuse(error, SINGE_ERROR_MEMORY, stage, -1, "%s: out of memory", short_name(name));
}

const char *short_name(const char *name) {
    size_t length = strlen(name);
    name += length > 200 ? length - 200 : 0;
    while (((unsigned char)*name & 0xc0) == 0x80) name++; // not within a character
    return name;
}

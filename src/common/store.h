// Memory from the caller's hook, and messages about files, for what lies outside libsinge: the makers of meshes, and the
// readers and writers of the program. They link a copy of their own, since a shared libsinge hides its inside.
#pragma once

#include "common/error.h"
#include "singe/material.h"

/// An uninitialised array; NULL when out of memory or if its size overflows. At least one byte is allocated, so NULL
/// always means failure; free it with the same count.
void *store_new(SingeAllocator allocator, size_t count, size_t element_size);
void store_free(SingeAllocator allocator, void *array, size_t count, size_t element_size);

/// Grows *array (of *capacity elements) to hold `count` elements, at least doubling it. False when out of memory.
bool store_grow(SingeAllocator allocator, void *array_pointer, size_t *capacity, size_t count, size_t element_size);

/// Shrinks an array to `count` elements, as allocated by store_new. False when out of memory.
bool store_trim(SingeAllocator allocator, void *array_pointer, size_t *capacity, size_t count, size_t element_size);

/// Frees the names and the values, [count] each, and the array.
void attributes_free(SingeAllocator allocator, SingeAttribute *attributes, uint32_t attribute_count, size_t count);

/// Fills *error (may be NULL) and returns `code`: error_set of libsinge for names of files, whose last character may be
/// cut off in the middle.
SingeResult refuse(SingeError *error, SingeResult code, const char *stage, int64_t element, const char *format, ...)
    SINGE_PRINTF(5, 6);
SingeResult refuse_memory(SingeError *error, const char *stage, const char *name);

/// The end of a path, short enough to leave room for the reason in a message.
const char *short_name(const char *name);

/// Whether a struct of the public headers can have this size in some version. All begin with a size_t, so their sizes
/// are multiples of its size; none has come near 64 KiB.
static inline bool struct_size_is_possible(size_t size) {
    return size > sizeof size && size % sizeof size == 0 && size <= 65536;
}

/// The message where it cannot; `defaults` is the function that sets it.
#define STRUCT_SIZE_UNKNOWN(defaults) "unknown struct_size; start from " #defaults "()"

static inline uint32_t load_u32_little(const uint8_t *p) {
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}
static inline void store_u32_little(uint8_t *p, uint32_t value) {
    p[0] = (uint8_t)value;
    p[1] = (uint8_t)(value >> 8);
    p[2] = (uint8_t)(value >> 16);
    p[3] = (uint8_t)(value >> 24);
}

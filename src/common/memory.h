// Memory through the caller's hook, counted.
#pragma once

#include "singe/base.h"

typedef struct Memory {
    SingeAllocator hook;
    size_t held; ///< bytes now allocated
} Memory;

/// A Memory on the hook, or on libc where the hook is zeroed.
Memory memory_make(SingeAllocator hook);

/// `count` zeroed elements; NULL when out of memory or when the size overflows. A count of 0 gives a
/// block that can be freed.
void *memory_new(Memory *memory, size_t count, size_t element_size);

/// Resizes an array that came from memory_new; new elements are not initialised. Returns false and
/// leaves it as it was when out of memory.
bool memory_grow(Memory *memory, void *array_pointer, size_t old_count, size_t new_count, size_t element_size);

/// Frees an array of `count` elements and sets the pointer to NULL. NULL is allowed.
void memory_free(Memory *memory, void *array_pointer, size_t count, size_t element_size);

#define NEW(memory, array, count) ((array) = memory_new((memory), (count), sizeof *(array)))
#define FREE(memory, array, count) memory_free((memory), (void *)&(array), (count), sizeof *(array))

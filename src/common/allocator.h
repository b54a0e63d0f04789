// The caller's memory hook, or libc's allocator if there is none. Inline, so that programs next to libsinge can use it,
// too, though a shared library hides its names.
#pragma once

#include "singe/base.h"

#include <stdlib.h>

/// A hook on libc's allocator.
static inline void *allocator_libc(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context, (void)old_size;
    if (new_size) return realloc(block, new_size);
    free(block);
    return NULL;
}

/// The hook, or libc's for a zeroed one.
static inline SingeAllocator allocator_or_libc(SingeAllocator hook) {
    return hook.resize ? hook : (SingeAllocator){allocator_libc, NULL};
}

/// As SingeAllocator.resize; freeing NULL calls nothing.
static inline void *allocator_resize(SingeAllocator hook, void *block, size_t old_size, size_t new_size) {
    if (!block && !new_size) return NULL;
    hook = allocator_or_libc(hook);
    return hook.resize(hook.context, block, block ? old_size : 0, new_size);
}

#include "common/memory.h"

#include "common/allocator.h"

#include <string.h>

Memory memory_make(SingeAllocator hook) { return (Memory){allocator_or_libc(hook), 0}; }

/// Bytes of `count` elements, at least 1; 0 when the product overflows.
static size_t memory_bytes(size_t count, size_t element_size) {
    if (count == 0 || element_size == 0) return 1;
    return count > SIZE_MAX / element_size ? 0 : count * element_size;
}

void *memory_new(Memory *memory, size_t count, size_t element_size) {
    size_t size = memory_bytes(count, element_size);
    void *block = size ? memory->hook.resize(memory->hook.context, NULL, 0, size) : NULL;
    if (!block) return NULL;
    memory->held += size;
    return memset(block, 0, size);
}

bool memory_grow(Memory *memory, void *array_pointer, size_t old_count, size_t new_count, size_t element_size) {
    void *block;
    memcpy(&block, array_pointer, sizeof block);
    size_t old_size = block ? memory_bytes(old_count, element_size) : 0,
           new_size = memory_bytes(new_count, element_size);
    void *grown = new_size ? memory->hook.resize(memory->hook.context, block, old_size, new_size) : NULL;
    if (!grown) return false;

    memory->held += new_size - old_size;
    memcpy(array_pointer, &grown, sizeof grown);
    return true;
}

void memory_free(Memory *memory, void *array_pointer, size_t count, size_t element_size) {
    void *block;
    memcpy(&block, array_pointer, sizeof block);
    if (!block) return;
    size_t size = memory_bytes(count, element_size);
    memory->hook.resize(memory->hook.context, block, size, 0);
    memory->held -= size;
    block = NULL;
    memcpy(array_pointer, &block, sizeof block);
}

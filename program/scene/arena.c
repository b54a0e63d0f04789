#include "scene/arena.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { ARENA_BLOCK = 16384 };

typedef struct Block {
    struct Block *next;
    size_t used, size;
    max_align_t bytes[];
} Block;

struct SceneArena {
    Block *blocks;
    int failed;
};

SceneArena *arena_create(void) { return calloc(1, sizeof(SceneArena)); }

void arena_destroy(SceneArena *arena) {
    if (!arena) return;
    while (arena->blocks) {
        Block *next = arena->blocks->next;
        free(arena->blocks);
        arena->blocks = next;
    }

    free(arena);
}

void *arena_new(SceneArena *arena, size_t count, size_t element_size) {
    size_t align = sizeof(max_align_t);
    if (element_size && count > (SIZE_MAX / 4) / element_size) {
        arena->failed = 1;
        return NULL;
    }

    size_t size = (count * element_size + align - 1) / align * align;
    Block *block = arena->blocks;
    if (!block || block->size - block->used < size) {
        size_t room = size > ARENA_BLOCK ? size : ARENA_BLOCK;
        block = calloc(1, sizeof *block + room);
        if (!block) {
            arena->failed = 1;
            return NULL;
        }

        block->size = room;
        block->next = arena->blocks;
        arena->blocks = block;
    }

    void *result = (char *)block->bytes + block->used;
    block->used += size;
    return result;
}

void arena_fail(SceneArena *arena) { arena->failed = 1; }

char *arena_text(SceneArena *arena, const char *text, size_t length) {
    char *copy = arena_new(arena, length + 1, 1);
    if (copy && length) memcpy(copy, text, length);
    return copy;
}

int arena_failed(const SceneArena *arena) { return arena->failed; }

// The memory of a scene: blocks that are freed together.
#pragma once

#include <stddef.h>

typedef struct SceneArena SceneArena;

/// NULL when out of memory.
SceneArena *arena_create(void);
void arena_destroy(SceneArena *arena);

/// Zeroed bytes that live as long as the arena; NULL when out of memory, which `arena_failed` remembers.
void *arena_new(SceneArena *arena, size_t count, size_t element_size);

/// A zero-terminated copy.
char *arena_text(SceneArena *arena, const char *text, size_t length);

/// Records that an allocation failed elsewhere.
void arena_fail(SceneArena *arena);
int arena_failed(const SceneArena *arena);

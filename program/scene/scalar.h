// The text of a single YAML value, unescaped.
#ifndef SCENE_SCALAR_H
#define SCENE_SCALAR_H

#include <libfyaml.h>

#include "scene/arena.h"

/// The text of a scalar token (NULL is an empty one) of the input `bytes`, zero-terminated, in the arena; it may
/// contain zeros, so *length is its length. NULL when out of memory.
char *scalar_text(SceneArena *arena, struct fy_token *token, const char *bytes, size_t size, size_t *length);

#endif

// The built-in materials: the files of materials/, embedded unchanged by scripts/packaging/cmake/embed.cmake.
#pragma once

#include <stddef.h>

typedef struct SceneBuiltin {
    const char *name; ///< the file's, without its ending
    const char *bytes;
    size_t size;
} SceneBuiltin;

/// Sorted by name; a row of zeros follows the last.
extern const SceneBuiltin scene_builtins[];

// The materials that the program brings along: the files of materials/, embedded as they are by cmake/embed.cmake.
#ifndef SCENE_BUILTIN_H
#define SCENE_BUILTIN_H

#include <stddef.h>

typedef struct SceneBuiltin {
    const char *name; ///< the file's, without its ending
    const char *bytes;
    size_t size;
} SceneBuiltin;

/// In the order of their names; a row of zeros behind the last.
extern const SceneBuiltin scene_builtins[];

#endif

#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 // realpath
#endif

#include "formats/path_inside.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/// Whether a path has a part "..".
static bool goes_up(const char *path) {
    for (const char *part = path;;) {
        size_t length = strcspn(part, "/\\");
        if (length == 2 && part[0] == '.' && part[1] == '.') return true;
        if (!part[length]) return false;
        part += length + 1;
    }
}

/// Whether the path with links resolved is in the folder or below.
static bool leads_inside(const char *folder, const char *path) {
    char *real_folder = realpath(folder, NULL), *real = realpath(path, NULL);
    size_t length = real_folder ? strlen(real_folder) : 0;
    if (length == 1) length = 0; // "/"
    bool inside = real_folder && real && strncmp(real, real_folder, length) == 0 && real[length] == '/';
    free(real_folder);
    free(real);
    return inside;
}

bool path_is_inside(const char *name, const char *path) {
    const char *slash = strrchr(name, '/');
    size_t length = slash ? (size_t)(slash - name) + 1 : 0;
    const char *inside = path + length;
    if (strncmp(path, name, length) != 0 || *inside == '/' || *inside == 0 || goes_up(inside)) return false;
    char *folder = length ? strndup(name, length) : strdup(".");
    bool good = folder && leads_inside(folder, path);
    free(folder);
    return good;
}

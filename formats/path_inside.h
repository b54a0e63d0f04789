// Files that a file refers to.
#ifndef FORMATS_PATH_INSIDE_H
#define FORMATS_PATH_INSIDE_H

#include <stdbool.h>

/// Whether `path` is that of something in the folder of the file `name` or below, said without "..", also by way of
/// links. False without memory, too.
bool path_is_inside(const char *name, const char *path);

#endif

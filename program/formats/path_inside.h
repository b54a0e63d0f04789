// Checks paths that a file refers to.
#ifndef FORMATS_PATH_INSIDE_H
#define FORMATS_PATH_INSIDE_H

#include <stdbool.h>

/// Whether `path` is in the folder of the file `name` or below, contains no "..", and leads there through links, too.
/// False when out of memory.
bool path_is_inside(const char *name, const char *path);

#endif

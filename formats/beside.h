// Files that a file refers to.
#ifndef FORMATS_BESIDE_H
#define FORMATS_BESIDE_H

#include <stdbool.h>

/// Whether `path` is that of something in the folder of the file `name` or below, said without "..", also by way of
/// links. False without memory, too.
bool beside_is(const char *name, const char *path);

#endif

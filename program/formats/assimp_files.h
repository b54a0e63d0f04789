// The files that assimp may open: the file to read, which is in memory, and regular files in its folder or below.
#ifndef FORMATS_ASSIMP_FILES_H
#define FORMATS_ASSIMP_FILES_H

#include <assimp/cfileio.h>

#include "formats/formats.h"

typedef struct Source {
    const char *name; ///< of the file to read; paths in it are relative to its folder
    const uint8_t *bytes;
    size_t size;
    size_t beside_size;  ///< of the other files that were opened
    const char *refused; ///< the end of a sentence about the first refused file, or NULL
} Source;

/// assimp's file callbacks. They refer to `source`.
struct aiFileIO assimp_files(Source *source);

#endif

// The files that assimp may open: the one it is to read, which is in memory, and plain files in its folder or below.
#ifndef FORMATS_ASSIMP_FILES_H
#define FORMATS_ASSIMP_FILES_H

#include <assimp/cfileio.h>

#include "formats/formats.h"

typedef struct Source {
    const char *name; ///< of the file to read; what it names beside itself is looked for from its folder
    const uint8_t *bytes;
    size_t size;
    size_t beside_size;  ///< of the other files that were opened
    const char *refused; ///< the end of a sentence about the first file that was not given, or NULL
} Source;

/// What assimp calls for files. It points at `source`.
struct aiFileIO assimp_files(Source *source);

#endif

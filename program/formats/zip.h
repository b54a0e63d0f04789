// An archive of uncompressed files, each aligned to 64 bytes, as USDZ requires.
#ifndef FORMATS_ZIP_H
#define FORMATS_ZIP_H

#include "formats/sink.h"

typedef struct Zip {
    Sink sink, directory;
    uint32_t count;
    bool too_large; ///< more than archives without extensions hold: 4 GiB, 65535 files
} Zip;

void zip_begin(Zip *zip, SingeAllocator allocator);
/// Adds a file; the bytes are copied.
void zip_add(Zip *zip, const char *name, const void *bytes, size_t size);
/// Writes the archive, whole or not at all, and frees it.
SINGE_NODISCARD SingeResult zip_write(Zip *zip, const char *path, SingeError *error);
void zip_free(Zip *zip);

#endif

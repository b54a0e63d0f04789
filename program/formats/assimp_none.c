// A build without assimp: FBX and similar formats are refused.
#include "formats/formats.h"
#include "common/store.h"

#include <string.h>

bool assimp_available(void) { return false; }

SingeResult assimp_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                        Polygons *polygons, SingeError *error) {
    (void)bytes, (void)size, (void)allocator;
    memset(polygons, 0, sizeof *polygons);
    return refuse(error, SINGE_ERROR_STATE, "mesh", -1,
                  "%s: this singe was built without assimp; it reads OBJ, PLY, STL, OFF and glTF 2", short_name(name));
}

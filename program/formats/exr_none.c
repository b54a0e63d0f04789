// A build without OpenEXR: no EXR is written.
#include "formats/formats.h"
#include "common/store.h"

bool exr_available(void) { return false; }

SingeResult exr_write(const char *path, int width, int height, const ExrChannel *channels, int count,
                      SingeError *error) {
    (void)width, (void)height, (void)channels, (void)count;
    return refuse(error, SINGE_ERROR_STATE, "exr", -1, "%s: this singe was built without EXR", short_name(path));
}

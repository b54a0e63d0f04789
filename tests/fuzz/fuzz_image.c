#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Image image;
    SingeError error;
    if (image_read("fuzz.png", data, size, (SingeAllocator){0}, &image, &error) == SINGE_OK) {
        SingeTexture picture;
        demand(image.width > 0 && image.height > 0 && image.rgb);
        if ((int64_t)image.width * image.height < 1 << 20 &&
            !image_luminance(&image, (SingeAllocator){0}, &picture, &error)) {
            for (int i = 0; i < picture.width * picture.height; i++)
                demand(picture.values[i] >= 0 && picture.values[i] <= 1);
            free((void *)picture.values);
        }
    } else demand(error.code && error.message[0] && !image.rgb);

    image_free(&image);
    return 0;
}

#include "formats/codec.h"
#include "common/store.h"

#include <string.h>

SingeResult image_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Image *image,
                       SingeError *error) {
    memset(image, 0, sizeof *image);
    if (size == 0) return refuse(error, SINGE_ERROR_FORMAT, "image", -1, "%s: is empty", short_name(name));
    if (size >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0)
        return png_read(name, bytes, size, allocator, image, error);
    if (size >= 3 && memcmp(bytes, "\xff\xd8\xff", 3) == 0)
        return jpeg_read(name, bytes, size, allocator, image, error);
    return refuse(error, SINGE_ERROR_FORMAT, "image", -1, "%s: neither a PNG nor a JPEG picture", short_name(name));
}

// ---- size only

static int be16(const uint8_t *p) { return p[0] << 8 | p[1]; }

/// The frame header of a JPEG (ITU T.81, B.2.2) follows segments of stated lengths.
static bool jpeg_size(const uint8_t *bytes, size_t size, int *width, int *height) {
    for (size_t at = 2; at + 9 < size && bytes[at] == 0xff;) {
        const uint8_t marker = bytes[at + 1];
        if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) {
            *height = be16(bytes + at + 5);
            *width = be16(bytes + at + 7);
            return true;
        }
        at += marker == 0xff ? 1 : 2 + (size_t)be16(bytes + at + 2);
    }
    return false;
}

bool image_size(const char *path, int *width, int *height) {
    enum { HEAD = 65536 };
    uint8_t head[HEAD];
    const size_t size = file_read_head(path, head, sizeof head);
    *width = *height = 0;
    if (size >= 24 && memcmp(head, "\x89PNG\r\n\x1a\n", 8) == 0) {
        if (head[16] || head[17] || head[20] || head[21]) return false; // larger than the reader accepts
        *width = be16(head + 18);
        *height = be16(head + 22);
        return true;
    }
    return size >= 3 && memcmp(head, "\xff\xd8\xff", 3) == 0 && jpeg_size(head, size, width, height);
}

void image_free(Image *image) {
    store_free(image->allocator, image->rgb, (size_t)image->width * (size_t)image->height, 3);
    memset(image, 0, sizeof *image);
}

// Luma of Rec. 709 on the encoded values, Y = (2126 R + 7152 G + 722 B) / (10000 * 255): integers up to the last
// division, so that white is exactly 1.
SingeResult image_luminance(const Image *image, SingeAllocator allocator, SingeTexture *picture, SingeError *error) {
    memset(picture, 0, sizeof *picture);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    float *values = store_new(allocator, pixels, sizeof *values);
    if (!values) return refuse(error, SINGE_ERROR_MEMORY, "image", -1, "out of memory for a picture's luminance");
    const uint8_t *p = image->rgb;
    for (size_t i = 0; i < pixels; i++, p += 3)
        values[i] = (float)(2126 * p[0] + 7152 * p[1] + 722 * p[2]) / 2550000.0f;
    *picture = (SingeTexture){image->width, image->height, values};
    return SINGE_OK;
}

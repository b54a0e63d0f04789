// The picture codecs behind image_read.
#ifndef FORMATS_CODEC_H
#define FORMATS_CODEC_H

#include "formats/formats.h"

enum { IMAGE_SIDE_LIMIT = 16384 };

SINGE_NODISCARD SingeResult png_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                     Image *image, SingeError *error);
SINGE_NODISCARD SingeResult jpeg_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                      Image *image, SingeError *error);

#endif

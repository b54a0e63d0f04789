// Triangles of uv on a square picture, and values spread beyond what they cover.
#ifndef FORMATS_UV_RASTER_H
#define FORMATS_UV_RASTER_H

#include "formats/formats.h"

/// Called for each pixel whose centre lies in a triangle, with the weights of the triangle's corners.
typedef void UvPixel(void *context, size_t pixel, const float weight[3]);

/// Draws one triangle on size × size pixels, rows from the top: v = 1 is the first row's upper side. Pixels beyond the
/// picture are left out.
void uv_triangle(int size, const float uv[3][2], UvPixel *draw, void *context);

enum { UV_NONE = UINT32_MAX };

/// For each pixel that is not covered but within `reach` pixels (by sides) of one that is, which one: the nearest, by
/// the order of the search where several are. A covered pixel is its own, and the others have UV_NONE. `queue` has room
/// for size * size.
void uv_spread(int size, int reach, const uint8_t *covered, uint32_t *nearest, uint32_t *queue);

#endif
